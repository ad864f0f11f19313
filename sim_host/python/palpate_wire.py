"""The open haptic node's wire protocol (docs/wire_protocol.md) for devices in Python: codec, buses and a node that keeps
every rule. Standard library only; nothing else of Palpate but palpate.dbc, whose signals it packs. python-can is used
where an address asks for it.

    node = Node(open_bus("loopback:mine"), force_max_N=8.5)
    while True:                                   # once a millisecond
        force_N, torque_Nm = node.receive()       # to the motors
        node.send(position_m, orientation)        # from the encoders

Lengths are in m, forces in N, torques in N m, all in the device's frame; orientations are w, x, y, z, handle to device.
"""

from __future__ import annotations

import binascii
import contextlib
import errno
import math
import os
import re
import socket
import struct
import time
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

VERSION = 2
ENABLE = 1  # flag of a command
CALIBRATED, ENABLED, STOP_PRESSED, ERROR, LET_GO, CUT = 1, 2, 4, 8, 16, 32  # flags of a status

Frame = Tuple[int, bytes]  # identifier, payload: 8 bytes or less are classic CAN
Vector = Sequence[float]


class WireError(ValueError):
    """An address, a table or a value that cannot be used; the text says which and what to do."""


class Signal(NamedTuple):
    """Where a number lies in a payload: ``start`` in bits, bit 0 the lowest of byte 0."""
    start: int
    bits: int
    signed: bool
    unit: float

    def counts(self, value: float) -> int:
        """The nearest number of units; at the end of the range what is beyond it; 0 for what is no number."""
        low, high = (-(1 << self.bits - 1), (1 << self.bits - 1) - 1) if self.signed else (0, (1 << self.bits) - 1)
        return max(low, min(high, round(value / self.unit))) if math.isfinite(value) else 0


class Message:
    """One row of the table: packs numbers by name into a payload and back."""

    def __init__(self, name: str, identifier: int, length: int) -> None:
        self.name, self.identifier, self.length = name, identifier, length
        self.signals: Dict[str, Signal] = {}

    def encode(self, node: int, values: Dict[str, float]) -> Frame:
        """The frame of node 1 to 15. Signals without a value are 0; an unknown name is a KeyError."""
        packed = 0
        for name, value in values.items():
            signal = self.signals[name]
            packed |= (signal.counts(value) & (1 << signal.bits) - 1) << signal.start
        payload = packed.to_bytes(self.length, "little")
        body = payload[:-self._seal_bytes()]
        return self.identifier + node, body + self._seal(node, body)

    def decode(self, node: int, frame: Frame) -> Optional[Dict[str, float]]:
        """The numbers of a frame by name; None when it is another message or node, of another length or spoilt."""
        identifier, payload = frame
        if identifier != self.identifier + node or len(payload) != self.length:
            return None
        body = payload[:-self._seal_bytes()]
        if payload[len(body):] != self._seal(node, body):
            return None
        packed = int.from_bytes(payload, "little")
        values: Dict[str, float] = {}
        for name, signal in self.signals.items():
            count = packed >> signal.start & (1 << signal.bits) - 1
            if signal.signed and count >> signal.bits - 1:
                count -= 1 << signal.bits
            values[name] = count if signal.unit == 1 else count * signal.unit
        return values

    def most(self, name: str) -> float:
        """The largest magnitude that this signal carries in both directions."""
        signal = self.signals[name]
        return ((1 << signal.bits - 1) - 1) * signal.unit

    def _seal_bytes(self) -> int:
        return self.signals["Checksum"].bits // 8

    def _seal(self, node: int, body: bytes) -> bytes:
        covered = struct.pack("<H", self.identifier + node) + body
        if self._seal_bytes() == 2:
            return struct.pack("<H", binascii.crc_hqx(covered, 0xFFFF))  # CRC-16/CCITT-FALSE
        return bytes([crc8_autosar(covered)])


def crc8_autosar(data: bytes) -> int:
    """CRC-8/AUTOSAR: polynomial 0x2F, begins with 0xFF, inverted at the end."""
    crc = 0xFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ 0x2F) & 0xFF if crc & 0x80 else crc << 1
    return crc ^ 0xFF


def read_dbc(path: Path) -> Dict[str, Message]:
    """Messages by name. Understands what palpate.dbc has: little-endian signals without an offset; node 1's frames."""
    messages: Dict[str, Message] = {}
    message = None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if head := re.match(r"BO_ (\d+) (\w+): (\d+) ", line):
            message = messages[head[2]] = Message(head[2], int(head[1]) - 1, int(head[3]))
        elif line.startswith(" SG_ "):
            row = re.match(r" SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(([^,]+),0\)", line)
            if row is None or message is None:
                raise WireError(f"{path}, line {number}: not a signal this protocol has: {line.strip()}")
            message.signals[row[1]] = Signal(int(row[2]), int(row[3]), row[4] == "-", float(row[5]))
    wanted = {"Command", "ClassicForce", "ClassicTorque", "Status", "ClassicPosition", "ClassicOrientation"}
    if missing := wanted - set(messages):
        raise WireError(f"{path}: has no message {', '.join(sorted(missing))}: take the palpate.dbc of your palpate")
    return messages


def find_dbc() -> Path:
    """palpate.dbc beside this file, in the sources, or as it is installed."""
    here = Path(__file__).resolve().parent
    places = [here / place for place in ("palpate.dbc", "../../docs/palpate.dbc", "../../../share/palpate/palpate.dbc")]
    for place in places:
        if place.exists():
            return place
    raise WireError("palpate.dbc is in none of " + ", ".join(map(str, places)) + ": copy it beside palpate_wire.py")


class SocketBus:
    """Frames through a socket, in the layouts of linux/can.h: SocketCAN, or the loopback's local socket."""

    FD, CLASSIC = struct.Struct("=IBBxx64s"), struct.Struct("=IBxxx8s")

    def __init__(self, connected: socket.socket, fd: bool = True) -> None:
        self.socket, self.fd = connected, fd
        connected.setblocking(False)

    def receive(self) -> List[Frame]:
        """All that arrived. Raises ConnectionError when the other side has gone."""
        frames: List[Frame] = []
        with contextlib.suppress(BlockingIOError):
            while data := self.socket.recv(self.FD.size):
                if len(data) == (self.FD if self.fd else self.CLASSIC).size:
                    identifier, length = struct.unpack_from("=IB", data)
                    frames.append((identifier, data[8:8 + min(length, len(data) - 8)]))
            raise ConnectionResetError("the controller has gone")
        return frames

    def send(self, frame: Frame) -> None:
        """What nobody takes is dropped, never sent later."""
        identifier, payload = frame
        data = (self.FD.pack(identifier, len(payload), 1, payload) if self.fd
                else self.CLASSIC.pack(identifier, len(payload), payload))
        with contextlib.suppress(OSError):
            self.socket.send(data)


class HidBus:
    """Frames in the reports of a USB gadget, /dev/hidgN: 64 bytes, of which the first three are length and identifier."""

    REPORT_BYTES, HEADER = 64, struct.Struct("<BH")

    def __init__(self, descriptor: int, fd: bool = True) -> None:
        self.descriptor, self.fd = descriptor, fd
        os.set_blocking(descriptor, False)

    def receive(self) -> List[Frame]:
        """All that arrived. Raises ConnectionError when the cable was pulled, or the host has gone."""
        frames: List[Frame] = []
        try:
            while report := os.read(self.descriptor, self.REPORT_BYTES):
                length, identifier = self.HEADER.unpack_from(report + bytes(self.HEADER.size))
                if len(report) == self.REPORT_BYTES and length <= self.REPORT_BYTES - self.HEADER.size:
                    frames.append((identifier, report[self.HEADER.size:self.HEADER.size + length]))
        except BlockingIOError:
            return frames
        except OSError as error:
            raise ConnectionResetError(f"the USB host has gone: {error.strerror}") from error
        raise ConnectionResetError("the USB host has gone")

    def send(self, frame: Frame) -> None:
        identifier, payload = frame
        report = self.HEADER.pack(len(payload), identifier) + payload
        with contextlib.suppress(OSError):
            os.write(self.descriptor, report.ljust(self.REPORT_BYTES, b"\0"))


class PythonCanBus:
    """Frames through python-can: every adapter it knows."""

    def __init__(self, bus: Any, fd: bool = True) -> None:
        import can  # here: whoever has another bus does not need it
        self.can, self.bus, self.fd = can, bus, fd

    def receive(self) -> List[Frame]:
        frames: List[Frame] = []
        while (message := self.bus.recv(timeout=0)) is not None:
            if message.is_fd == self.fd and not (message.is_error_frame or message.is_remote_frame or
                                                 message.is_extended_id):
                frames.append((message.arbitration_id, bytes(message.data)))
        return frames

    def send(self, frame: Frame) -> None:
        identifier, payload = frame
        message = self.can.Message(arbitration_id=identifier, data=payload, is_extended_id=False, is_fd=self.fd,
                                   bitrate_switch=self.fd)
        with contextlib.suppress(self.can.CanError):
            self.bus.send(message, timeout=0)


def open_bus(where: str, fd: bool = True, wait_s: float = math.inf) -> Any:
    """The bus at ``loopback:NAME`` (waits for the controller, which listens), ``can:IFACE`` (SocketCAN),
    ``usb:/dev/hidgN`` (a USB gadget) or ``python-can:INTERFACE:CHANNEL``. ``fd``: CAN FD frames; False: classic ones."""
    kind, _, name = where.partition(":")
    if kind == "loopback" and name:
        return SocketBus(_loopback(name, wait_s), fd)
    if kind == "can" and name:
        return SocketBus(_socketcan(where, name, fd), fd)
    if kind == "usb" and "/" in name:
        try:
            return HidBus(os.open(name, os.O_RDWR | os.O_NONBLOCK), fd)
        except OSError as error:
            raise WireError(f"{where}: {error.strerror}: is the gadget set up? `ls /dev/hidg*`") from error
    if kind == "python-can" and ":" in name:
        try:
            import can
        except ImportError as error:
            raise WireError(f"{where}: python-can is missing: apt-get install python3-can") from error
        interface, _, channel = name.partition(":")
        return PythonCanBus(can.Bus(interface=interface, channel=channel, fd=fd), fd)
    raise WireError(f"'{where}' is no bus: loopback:NAME, can:IFACE, usb:/dev/hidgN or python-can:INTERFACE:CHANNEL")


def _socketcan(where: str, name: str, fd: bool) -> socket.socket:
    try:
        raw = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        if fd:
            raw.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FD_FRAMES, 1)
        raw.bind((name,))
        return raw
    except OSError as error:
        raise WireError(f"{where}: {error.strerror}: `ip link show type can` lists the interfaces") from error


def _loopback(name: str, wait_s: float) -> socket.socket:
    address = name if "/" in name else "\0" + name
    end_s = time.monotonic() + wait_s
    while True:
        local = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        wrong = local.connect_ex(address)
        if wrong == 0:
            return local
        local.close()
        if wrong not in (errno.ECONNREFUSED, errno.ENOENT, errno.EAGAIN) or time.monotonic() > end_s:
            raise WireError(f"loopback:{name}: no controller listens there")
        time.sleep(0.01)


class Node:
    """A device's end. Call ``receive()`` and ``send()`` once a period, in this order.

    Commands are checked, old and repeated ones refused; without a fresh one for 20 ms, and until enable goes from 0 to 1,
    the force is zero; it changes by a tenth of its limit a millisecond at most. The local contact model is not offered.
    """

    WATCHDOG_S, SLOPE_PER_MS = 0.020, 0.1

    def __init__(self, bus: Any, number: int = 1, force_max_N: float = 8.5, torque_max_Nm: float = 0.0,
                 period_s: float = 1e-3, messages: Optional[Dict[str, Message]] = None) -> None:
        if not 1 <= number <= 15:
            raise WireError(f"node {number}: 1 to 15")
        self.bus, self.number, self.period_s = bus, number, period_s
        self.messages = messages if messages is not None else read_dbc(find_dbc())
        self.most = (force_max_N, torque_max_Nm)
        self.error = 0
        """The device's own code; not 0: the motors are cut, and the controller is told."""
        self.stop_pressed = False
        """The emergency stop: cuts the motors at once."""
        self.calibrated = True
        self.commands = self.refused = 0
        """Commands obeyed; frames that were none, or old."""
        self._range = 1 << (16 if bus.fd else 8)
        self._heard = False
        self._echo = self._old = self._old_run = self._silent = self._sent = 0
        self._enabled = self._let_go = True  # zero force until enable goes from 0 to 1
        self._wanted: Tuple[List[float], List[float]] = ([0.0] * 3, [0.0] * 3)
        self._rendered: Tuple[List[float], List[float]] = ([0.0] * 3, [0.0] * 3)
        self._half: Optional[Dict[str, float]] = None
        self._cut = False

    @property
    def is_enabled(self) -> bool:
        """The controller has enabled the drives, and nothing holds them back."""
        return self._enabled and not self._let_go and not self.stop_pressed and self.error == 0

    def receive(self) -> Tuple[List[float], List[float]]:
        """All that arrived since the last call; what the motors render in this period: force and torque.

        Raises ConnectionError when the controller has gone, where a bus can tell: let go of the motors then."""
        self._silent += 1
        for frame in self.bus.receive():
            self._take(frame)
        if self._silent > round(self.WATCHDOG_S / self.period_s):
            self._enabled = self._let_go = True
        self._cut = False
        if self.stop_pressed or self.error != 0:
            self._rendered = ([0.0] * 3, [0.0] * 3)
        else:
            force, torque = (self._approach(part) for part in (0, 1))
            self._rendered = (force, torque)
        return list(self._rendered[0]), list(self._rendered[1])

    def send(self, position_m: Vector, orientation: Vector = (1.0, 0.0, 0.0, 0.0), buttons: int = 0,
             time_us: Optional[int] = None) -> None:
        """Where the handle is. ``time_us``: the device's clock; without it periods are counted."""
        self._sent += 1
        flags = ((CALIBRATED if self.calibrated else 0) | (ENABLED if self._enabled and not self._let_go else 0) |
                 (STOP_PRESSED if self.stop_pressed else 0) | (ERROR if self.error else 0) |
                 (LET_GO if self._let_go else 0) | (CUT if self._cut else 0))
        when_us = round(self._sent * self.period_s * 1e6) if time_us is None else time_us
        place = dict(zip(("PositionX", "PositionY", "PositionZ"), position_m))
        for frame in (self._status(place, orientation, flags, buttons, when_us) if self.bus.fd
                      else self._classic_status(place, orientation, flags, buttons)):
            self.bus.send(frame)

    def _take(self, frame: Frame) -> None:
        if self.bus.fd:
            command = self.messages["Command"].decode(self.number, frame)
            if command is None:
                self.refused += 1
                return
            return self._obey(command, command)
        half = self.messages["ClassicForce"].decode(self.number, frame)
        if half is not None:
            self._half = half
            return
        torque = self.messages["ClassicTorque"].decode(self.number, frame)
        if torque is None or self._half is None or torque["Sequence"] != self._half["Sequence"]:
            self.refused += 1
            return
        self._obey(self._half, torque)
        self._half = None

    def _obey(self, force: Dict[str, float], rest: Dict[str, float]) -> None:
        number = int(force["Sequence"])
        # Twice, or late: dropped; but four that follow one another are of a controller that has started again.
        if self._heard and (self._echo - number) % self._range < self._range // 4:
            self._old_run = self._old_run + 1 if number == (self._old + 1) % self._range else 1
            self._old = number
            if self._old_run < 4:
                self.refused += 1
                return
        self._heard, self._echo, self._old_run, self._silent = True, number, 0, 0
        enable = bool(int(rest["Flags"]) & ENABLE)
        self._let_go = self._let_go and not (enable and not self._enabled)
        self._enabled = enable
        self._wanted = ([force["Force" + axis] for axis in "XYZ"], [rest["Torque" + axis] for axis in "XYZ"])
        self.commands += 1

    def _approach(self, part: int) -> List[float]:
        """What is wanted within the limit of force (0) or torque (1), by the slope that a hand can bear."""
        most, wanted, now = self.most[part], self._wanted[part], self._rendered[part]
        size = math.hypot(*wanted)
        share = 0.0 if not self.is_enabled else 1.0 if size <= most else most / size
        self._cut = self._cut or 0 < share < 1
        change = [share * to - at for to, at in zip(wanted, now)]
        step = math.hypot(*change)
        slope = self.SLOPE_PER_MS * most * 1e3 * self.period_s
        keep = 1.0 if step <= slope else slope / step
        return [at + keep * more for at, more in zip(now, change)]

    def _status(self, place: Dict[str, float], orientation: Vector, flags: int, buttons: int,
                time_us: int) -> List[Frame]:
        turn = dict(zip(("QuaternionW", "QuaternionX", "QuaternionY", "QuaternionZ"), orientation))
        return [self.messages["Status"].encode(self.number, {
            **place, **turn, "Sequence": self._sent % self._range, "CommandSequence": self._echo, "Flags": flags,
            "Buttons": buttons, "ErrorCode": self.error, "DeviceTime": time_us % (1 << 32),
            "ProtocolVersion": VERSION})]

    def _classic_status(self, place: Dict[str, float], orientation: Vector, flags: int, buttons: int) -> List[Frame]:
        largest = max(range(4), key=lambda i: abs(orientation[i]))
        sign = math.copysign(1.0, orientation[largest])
        kept = [sign * part for i, part in enumerate(orientation) if i != largest]
        number = self._sent % self._range
        return [
            self.messages["ClassicPosition"].encode(self.number, {**place, "Sequence": number}),
            self.messages["ClassicOrientation"].encode(self.number, {
                **dict(zip(("ComponentA", "ComponentB", "ComponentC"), kept)), "Sequence": number % 16, "Flags": flags,
                "Buttons": buttons & 3, "CommandEcho": self._echo % 64, "LargestComponent": largest})]
