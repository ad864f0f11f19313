#!/usr/bin/env python3
"""A haptic device on palpate_wire: the kit has the protocol's rules, this file has the handle. A simulated hand presses
and withdraws; on a device of one's own motors and encoders take the place of move().

    ./device_kit.py loopback:mine & palpate device-test loopback:mine
    ./device_kit.py can:can0                     # SocketCAN; python-can:slcan:/dev/ttyACM0 and the like: python-can
"""
import contextlib
import math
import sys
import time

from palpate_wire import Node, WireError, open_bus

MASS_KG, DAMPING_NS_PER_M, HAND_N_PER_M = 0.2, 10.0, 800.0


class Device:
    def __init__(self, bus):
        self.node, self.ticks, self.felt_N = Node(bus, force_max_N=8.5), 0, 0.0
        self.position_m, self.velocity = [-0.010, 0.090, 0.0], [0.0] * 3

    def step(self):
        """One millisecond. Raises ConnectionError when the controller has gone."""
        force_N, _ = self.node.receive()
        self.felt_N = max(self.felt_N, math.hypot(*force_N))
        self.move(force_N)
        self.node.send(self.position_m)

    def move(self, force_N):
        """The hand aims 28 mm down and up again every 2 s, and pulls the handle there like a spring."""
        aim_m = (-0.010, 0.076 + 0.014 * math.cos(math.pi * self.ticks * 1e-3), 0.0)
        self.ticks += 1
        for i in range(3):
            pull_N = HAND_N_PER_M * (aim_m[i] - self.position_m[i]) - DAMPING_NS_PER_M * self.velocity[i]
            self.velocity[i] += 1e-3 * (pull_N + force_N[i]) / MASS_KG
            self.position_m[i] += 1e-3 * self.velocity[i]


def main(where):
    device, due_ns = Device(open_bus(where)), time.monotonic_ns() // 1_000_000 * 1_000_000 + 750_000
    with contextlib.suppress(ConnectionError, KeyboardInterrupt):
        while True:
            device.step()
            due_ns += 1_000_000
            time.sleep(max(0, due_ns - time.monotonic_ns()) * 1e-9)
    print(f"over; the hand felt at most {device.felt_N:.2f} N in {device.ticks / 1000:.1f} s")


if __name__ == "__main__":
    try:
        main(sys.argv[1] if len(sys.argv) > 1 else "loopback:palpate")
    except WireError as error:
        sys.exit(f"device_kit.py: {error}")
