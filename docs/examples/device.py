#!/usr/bin/env python3
"""A haptic device: docs/wire_protocol.md over the loopback, with a simulated hand that presses and withdraws.

    ./device.py mine & palpate device-test loopback:mine
    ./device.py mine & palpate run config/scenes/ellipsoid_mallet.toml --device loopback:mine --duration 4

On a bus the very same frames go through the kernel. In place of the first three lines of main():
    bus = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
    bus.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FD_FRAMES, 1)
    bus.bind(("can0",))
"""
import binascii
import contextlib
import math
import socket
import struct
import sys
import time

NODE, VERSION = 1, 2
CALIBRATED, ENABLED, LET_GO, CUT = 1, 2, 16, 32  # flags of a status
FRAME = struct.Struct("=IBBxx64s")  # struct canfd_frame of linux/can.h: identifier, length, flags, data
FORCE_MAX_N, MASS_KG, DAMPING_NS_PER_M, HAND_N_PER_M = 8.5, 0.2, 10.0, 800.0


def checksum(identifier, payload):
    return binascii.crc_hqx(struct.pack("<H", identifier) + payload, 0xFFFF)


class Device:
    def __init__(self, bus):
        self.bus, self.ticks, self.felt_N = bus, 0, 0.0
        self.heard, self.echo, self.old, self.old_run, self.silent_ms = False, 0, 0, 0, 0
        self.enabled = self.let_go = True  # zero force until enable goes from 0 to 1
        self.wanted_N, self.force_N = [0.0] * 3, [0.0] * 3
        self.position_m, self.velocity = [-0.010, 0.090, 0.0], [0.0] * 3
        bus.setblocking(False)

    def take(self, frame):
        """One frame that arrived; a command that is valid and new is obeyed."""
        if len(frame) != FRAME.size:
            return
        identifier, length, _, data = FRAME.unpack(frame)
        number, _, flags, x, y, z, seal = struct.unpack("<3H3h6xH", data[:20])  # three motors: torque is skipped
        if identifier != 0x100 + NODE or length != 20 or seal != checksum(identifier, data[:18]):
            return
        # Twice, or late: dropped; but four that follow one another are of a controller that has started again.
        if self.heard and (self.echo - number) & 0xFFFF <= 0x3FFF:
            self.old_run = self.old_run + 1 if number == (self.old + 1) & 0xFFFF else 1
            self.old = number
            if self.old_run < 4:
                return
        self.heard, self.echo, self.old_run, self.silent_ms = True, number, 0, 0
        self.let_go = self.let_go and not (flags & 1 and not self.enabled)
        self.enabled, self.wanted_N = bool(flags & 1), [x / 1000, y / 1000, z / 1000]

    def step(self):
        """One millisecond: commands, motors, hand, status. Raises ConnectionError when the controller has gone."""
        with contextlib.suppress(BlockingIOError):
            while frame := self.bus.recv(FRAME.size):
                self.take(frame)
            raise ConnectionResetError
        self.silent_ms += 1
        if self.silent_ms > 20:
            self.enabled = self.let_go = True
        on = self.enabled and not self.let_go
        cut = min(1.0, FORCE_MAX_N / max(math.hypot(*self.wanted_N), 1e-9)) if on else 0.0
        change = [cut * wanted - force for wanted, force in zip(self.wanted_N, self.force_N)]
        share = min(1.0, 0.1 * FORCE_MAX_N / max(math.hypot(*change), 1e-9))  # a slope, not a step
        self.force_N = [force + share * more for force, more in zip(self.force_N, change)]
        self.felt_N = max(self.felt_N, math.hypot(*self.force_N))
        self.move()
        self.send(CALIBRATED | (ENABLED if on else 0) | (LET_GO if self.let_go else 0) | (CUT if on and cut < 1 else 0))

    def move(self):
        """The hand aims 28 mm down and up again every 2 s, and pulls the handle there like a spring."""
        aim_m = (-0.010, 0.076 + 0.014 * math.cos(math.pi * self.ticks * 1e-3), 0.0)
        for i in range(3):
            pull_N = HAND_N_PER_M * (aim_m[i] - self.position_m[i]) - DAMPING_NS_PER_M * self.velocity[i]
            self.velocity[i] += 1e-3 * (pull_N + self.force_N[i]) / MASS_KG
            self.position_m[i] += 1e-3 * self.velocity[i]

    def send(self, flags):
        place = b"".join(round(p * 1e7).to_bytes(3, "little", signed=True) for p in self.position_m)
        self.ticks += 1
        body = struct.pack("<3H2BI9s4hB", self.ticks & 0xFFFF, self.echo, flags, 0, 0,
                           self.ticks * 1000 & 0xFFFFFFFF, place, 32767, 0, 0, 0, VERSION)  # the handle never turns
        body += struct.pack("<H", checksum(0x180 + NODE, body))
        with contextlib.suppress(OSError):  # what nobody takes is dropped, never sent later
            self.bus.send(FRAME.pack(0x180 + NODE, len(body), 1, body))


def main(name):
    bus = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    while bus.connect_ex("\0" + name):  # the controller listens
        time.sleep(0.01)
    device, due_ns = Device(bus), time.monotonic_ns() // 1_000_000 * 1_000_000 + 750_000  # the loop ticks at 250,000
    with contextlib.suppress(ConnectionError):
        while True:
            device.step()
            due_ns += 1_000_000
            time.sleep(max(0, due_ns - time.monotonic_ns()) * 1e-9)
    print(f"the controller has gone; the hand felt at most {device.felt_N:.2f} N in {device.ticks / 1000:.1f} s")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "palpate")
