"""palpate_wire: the codec by its table, the node by its rules, the buses by what goes through them. Grading by
`palpate device-test` is in tests/examples. Usage: test_wire.py ROOT"""

import itertools
import math
import os
import random
import re
import socket
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1])
sys.path.insert(0, str(ROOT / "sim_host/python"))
import can  # noqa: E402
import canmatrix.formats  # noqa: E402
import palpate_wire as wire  # noqa: E402

TABLE = wire.read_dbc(ROOT / "docs/palpate.dbc")


class Codec(unittest.TestCase):
    def test_checksums_have_their_published_check_values(self):
        self.assertEqual(wire.binascii.crc_hqx(b"123456789", 0xFFFF), 0x29B1)
        self.assertEqual(wire.crc8_autosar(b"123456789"), 0xDF)

    def test_every_message_comes_back_as_it_was_packed(self):
        draw = random.Random(1)
        for message in TABLE.values():
            for _ in range(50):
                counts = {name: draw.randrange(-(1 << s.bits - 1) if s.signed else 0, 1 << s.bits - s.signed)
                          for name, s in message.signals.items() if name != "Checksum"}
                values = {name: count * message.signals[name].unit for name, count in counts.items()}
                read = message.decode(7, message.encode(7, values))
                self.assertEqual({name: round(read[name] / message.signals[name].unit) for name in counts}, counts)

    def test_another_reader_of_the_table_sees_the_same_values(self):
        matrix = next(iter(canmatrix.formats.loadp(str(ROOT / "docs/palpate.dbc")).values()))
        self.assertEqual({frame.name for frame in matrix.frames}, set(TABLE))
        draw = random.Random(2)
        for message in TABLE.values():
            for _ in range(50):
                values = {name: draw.randrange(-(1 << s.bits - 1) if s.signed else 0, 1 << s.bits - s.signed) * s.unit
                          for name, s in message.signals.items() if name != "Checksum"}
                identifier, payload = message.encode(1, values)
                seen = matrix.decode(canmatrix.ArbitrationId(identifier), payload)
                for name, value in values.items():
                    self.assertAlmostEqual(float(seen[name].phys_value), value, delta=1e-9 * (1 + abs(value)))

    def test_no_single_bit_error_passes(self):
        for message in TABLE.values():
            identifier, payload = message.encode(3, {"Sequence": 5})
            for bit in range(8 * len(payload)):
                spoilt = bytearray(payload)
                spoilt[bit // 8] ^= 1 << bit % 8
                self.assertIsNone(message.decode(3, (identifier, bytes(spoilt))), f"{message.name}, bit {bit}")
            self.assertIsNone(message.decode(4, (identifier, payload)))
            for length in range(len(payload)):
                self.assertIsNone(message.decode(3, (identifier, payload[:length])))

    def test_what_is_beyond_a_field_is_its_end_and_no_number_is_zero(self):
        status = TABLE["Status"]
        for value, read_m in ((5.0, 0.8388607), (-5.0, -0.8388608), (math.nan, 0), (math.inf, 0)):
            self.assertAlmostEqual(status.decode(1, status.encode(1, {"PositionX": value}))["PositionX"], read_m, 9)

    def test_mistakes_are_told(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = Path(folder) / "broken.dbc"
            for text, words in (("", "has no message"), ("BO_ 257 Command: 20 C\n SG_ Sequence : 0|16@0+ (1,0)\n", "line 2"),
                                (" SG_ Sequence : 0|16@1+ (1,0)\n", "line 1")):
                broken.write_text(text)
                with self.assertRaisesRegex(wire.WireError, words):
                    wire.read_dbc(broken)
        for where in ("", "loopback", "can:", "usb:1", "python-can:slcan"):
            with self.assertRaisesRegex(wire.WireError, "no bus"):
                wire.open_bus(where)
        with self.assertRaisesRegex(wire.WireError, "no controller"):
            wire.open_bus("loopback:nobody-listens-here", wait_s=0)
        with self.assertRaisesRegex(wire.WireError, "can:nosuchbus"):
            wire.open_bus("can:nosuchbus")
        with self.assertRaisesRegex(wire.WireError, "node 16"):
            wire.Node(None, number=16)


class Wire:
    """A bus of lists, and the controller's end of it."""

    def __init__(self, fd):
        self.fd, self.to_node, self.from_node, self.number = fd, [], [], 0

    def receive(self):
        arrived, self.to_node = self.to_node, []
        return arrived

    def send(self, frame):
        self.from_node.append(frame)

    def command(self, force_N=(0, 0, 0), torque_Nm=(0, 0, 0), enable=True, number=None):
        self.number = (self.number + 1) % (65536 if self.fd else 256) if number is None else number
        force = dict(zip(("ForceX", "ForceY", "ForceZ"), force_N), Sequence=self.number)
        torque = dict(zip(("TorqueX", "TorqueY", "TorqueZ"), torque_Nm), Flags=int(enable))
        if self.fd:
            self.to_node.append(TABLE["Command"].encode(1, {**force, **torque}))
        else:
            self.to_node.append(TABLE["ClassicForce"].encode(1, force))
            self.to_node.append(TABLE["ClassicTorque"].encode(1, {**torque, "Sequence": self.number}))

    def status(self):
        frames, self.from_node = self.from_node, []
        messages = ("Status",) if self.fd else ("ClassicPosition", "ClassicOrientation")
        assert len(frames) == len(messages)
        said = [TABLE[name].decode(1, frame) for name, frame in zip(messages, frames)]
        assert None not in said
        return {**said[-1], **said[0]}


class Rules(unittest.TestCase):
    PROFILES = (True, False)

    def armed(self, fd, **more):
        bus = Wire(fd)
        node = wire.Node(bus, messages=TABLE, **more)
        for enable in (False, True):
            bus.command(enable=enable)
            node.receive()
        self.assertTrue(node.is_enabled)
        return bus, node

    def test_force_is_approached_by_a_tenth_of_the_limit_and_cut_at_it(self):
        for fd in self.PROFILES:
            bus, node = self.armed(fd, force_max_N=5, torque_max_Nm=0.1)
            before = 0.0
            for _ in range(20):
                bus.command((0, 20, 0), (0.05, 0, 0))
                force_N, torque_Nm = node.receive()
                self.assertLessEqual(force_N[1] - before, 0.5 + 1e-12)
                before = force_N[1]
                node.send((0, 0, 0))
                self.assertTrue(int(bus.status()["Flags"]) & wire.CUT)
            self.assertAlmostEqual(before, 5, 12)
            self.assertAlmostEqual(torque_Nm[0], 0.05, 12)

    def test_no_force_before_enable_goes_from_zero_to_one(self):
        for fd in self.PROFILES:
            bus = Wire(fd)
            node = wire.Node(bus, messages=TABLE)
            for _ in range(50):
                bus.command((1, 0, 0))
                self.assertEqual(node.receive()[0], [0, 0, 0])

    def test_silence_lets_go_after_20_ms_until_enabled_anew(self):
        for fd in self.PROFILES:
            bus, node = self.armed(fd)
            for _ in range(20):
                bus.command((1, 0, 0))
                node.receive()
            forces = [node.receive()[0][0] for _ in range(25)]
            self.assertEqual(forces[:20], [1.0] * 20)
            self.assertLess(forces[20], 1)
            self.assertEqual(forces[-1], 0)
            bus.command((1, 0, 0))
            self.assertEqual(node.receive()[0][0], 0)
            for enable in (False, True):
                bus.command((1, 0, 0), enable=enable)
                force_N = node.receive()[0]
            self.assertGreater(force_N[0], 0)

    def test_stop_and_error_cut_at_once(self):
        for name, value, flag in (("stop_pressed", True, wire.STOP_PRESSED), ("error", 9, wire.ERROR)):
            bus, node = self.armed(True)
            for _ in range(5):
                bus.command((3, 0, 0))
                self.assertGreater(node.receive()[0][0], 0)
            setattr(node, name, value)
            bus.command((3, 0, 0))
            self.assertEqual(node.receive()[0], [0, 0, 0])
            node.send((0, 0, 0))
            said = bus.status()
            self.assertTrue(int(said["Flags"]) & flag)
            self.assertEqual(said["ErrorCode"], node.error)

    def test_old_commands_are_refused_and_a_restart_is_followed(self):
        for fd in self.PROFILES:
            bus, node = self.armed(fd)
            bus.command((1, 0, 0), number=100)
            node.receive()
            obeyed = node.commands
            for number in (100, 99, 80):
                bus.command((2, 0, 0), number=number)
            node.receive()
            self.assertEqual(node.commands, obeyed)
            for number in (60, 61, 62, 63):
                bus.command((2, 0, 0), number=number)
            node.receive()
            self.assertEqual(node.commands, obeyed + 1)
            node.send((0, 0, 0))
            echo = bus.status()["CommandSequence" if fd else "CommandEcho"]
            self.assertEqual(echo, 63)

    def test_random_bytes_are_never_obeyed(self):
        draw = random.Random(2)
        for fd in self.PROFILES:
            bus, node = self.armed(fd)
            obeyed = node.commands
            for _ in range(3000):
                identifier = draw.choice((0x101, 0x111, 0x121, draw.randrange(2048)))
                bus.to_node.append((identifier, draw.randbytes(draw.choice((0, 7, 8, 20, 48, 64)))))
                node.receive()
            # A random payload passes with odds of 2^-8 (classic, and then two halves must agree) or 2^-16.
            self.assertLessEqual(node.commands - obeyed, 2)

    def test_orientation_comes_back_from_both_profiles(self):
        draw = random.Random(3)
        for fd, _ in itertools.product(self.PROFILES, range(100)):
            bus = Wire(fd)
            node = wire.Node(bus, messages=TABLE)
            turn = [draw.gauss(0, 1) for _ in range(4)]
            turn = [part / math.hypot(*turn) for part in turn]
            node.send((0.1, -0.2, 0.3), turn)
            said = bus.status()
            for axis, value in zip("XYZ", (0.1, -0.2, 0.3)):
                self.assertAlmostEqual(said["Position" + axis], value, 9)
            if fd:
                read = [said["Quaternion" + axis] for axis in "WXYZ"]
            else:
                read = [said["Component" + part] for part in "ABC"]
                read.insert(int(said["LargestComponent"]), math.sqrt(1 - sum(part * part for part in read)))
            # Half a step of 12 bits is 1.7e-4 in each of three, and twice their sum at most in the fourth: 1e-3 as an
            # angle, whose cosine is 1 - 5e-7.
            same = abs(sum(a * b for a, b in zip(turn, read))) / math.hypot(*read)
            self.assertGreater(same, 1 - 5e-7)


class Buses(unittest.TestCase):
    def test_a_socket_keeps_the_layouts_and_tells_when_the_other_side_has_gone(self):
        for fd in (True, False):
            near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            bus = wire.SocketBus(near, fd)
            payload = bytes(range(20 if fd else 8))
            bus.send((0x181, payload))
            data = far.recv(100)
            self.assertEqual(len(data), 72 if fd else 16)
            self.assertEqual(data[:8], bytes([0x81, 1, 0, 0, len(payload), int(fd), 0, 0]))
            self.assertEqual(data[8:8 + len(payload)], payload)
            far.send(data)
            far.send(data[:-1])  # not a frame
            self.assertEqual(bus.receive(), [(0x181, payload)])
            self.assertEqual(bus.receive(), [])
            far.close()
            with self.assertRaises(ConnectionError):
                bus.receive()
            near.close()

    def test_usb_reports_keep_the_layout_and_tell_when_the_host_has_gone(self):
        near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        bus = wire.HidBus(near.fileno())
        payload = bytes(range(1, 33))
        bus.send((0x181, payload))
        report = far.recv(100)
        self.assertEqual(report, b"\x20\x81\x01" + payload + bytes(29))
        far.send(report)
        far.send(report[:-1])  # not a report
        far.send(b"\x3e" + report[1:])  # longer than there is room for
        self.assertEqual(bus.receive(), [(0x181, payload)])
        self.assertEqual(bus.receive(), [])
        far.close()
        with self.assertRaises(ConnectionError):
            bus.receive()
        near.close()
        with self.assertRaisesRegex(wire.WireError, "gadget"):
            wire.open_bus("usb:/dev/hidg99")

    # The descriptor that the page gives is the one by which the laboratory's emulated USB runs.
    def test_the_page_has_the_laboratorys_report_descriptor(self):
        page = (ROOT / "docs/wire_protocol.md").read_text(encoding="utf-8")
        told = bytes.fromhex(re.search(r"```\n(06 00 FF [0-9A-F \n]+)```", page)[1])
        octal = re.search(r"printf '([\\0-7]+)' > functions/hid.0/report_desc", (ROOT / "tests/lab/guest_init").read_text())[1]
        self.assertEqual(told, bytes(int(digits, 8) for digits in octal.split("\\")[1:]))

    def test_python_can_carries_commands_and_statuses(self):
        for fd in (True, False):
            channel = f"palpate-{os.getpid()}-{fd}"
            controller = wire.PythonCanBus(can.Bus(interface="virtual", channel=channel), fd)
            mine = wire.PythonCanBus(can.Bus(interface="virtual", channel=channel), fd)
            node, commands = wire.Node(mine, messages=TABLE), Wire(fd)
            controller.bus.send(can.Message(arbitration_id=0x101, is_extended_id=True, data=b"12345678"))
            for enable in (False, True):
                commands.command((0.5, 0, 0), enable=enable)
                for frame in commands.receive():
                    controller.send(frame)
                force_N = node.receive()[0]
                node.send((0.01, 0.02, 0.03))
            self.assertEqual((node.commands, node.refused), (2, 0))
            self.assertAlmostEqual(force_N[0], 0.5, 12)
            commands.from_node = controller.receive()[-1 if fd else -2:]
            self.assertAlmostEqual(commands.status()["PositionZ"], 0.03, 9)
            controller.bus.shutdown()
            mine.bus.shutdown()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
