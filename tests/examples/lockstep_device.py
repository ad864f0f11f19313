#!/usr/bin/env python3
"""docs/examples/device.py in the controller's virtual time (hal/loop/lockstep.h), started as palpate-device is."""
import os
import socket
import struct
import sys

sys.dont_write_bytecode = True  # beside the example
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../docs/examples"))
from device import Device  # noqa: E402

PERIOD_NS = 1_000_000


def descriptor(option):
    return socket.socket(fileno=int(sys.argv[sys.argv.index(option) + 1]))


device, turns, due_ns = Device(descriptor("--device-fd")), descriptor("--turn-fd"), PERIOD_NS
try:
    while turn := turns.recv(8):
        while due_ns <= struct.unpack("=q", turn)[0]:
            device.step()
            due_ns += PERIOD_NS
        turns.send(struct.pack("=q", due_ns))
except ConnectionError:
    pass
