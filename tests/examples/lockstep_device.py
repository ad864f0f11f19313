#!/usr/bin/env python3
"""A device of docs/examples in the controller's virtual time (hal/loop/lockstep.h), started as palpate-device is.

Usage: lockstep_device.py device | device_kit | device_kit_classic | device_kit_usb --device-fd N --turn-fd N
"""
import os
import socket
import struct
import sys

sys.dont_write_bytecode = True  # beside the example
root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
sys.path[:0] = [os.path.join(root, "docs/examples"), os.path.join(root, "sim_host/python")]

PERIOD_NS = 1_000_000


def descriptor(option):
    return socket.socket(fileno=int(sys.argv[sys.argv.index(option) + 1]))


def device_on(bus):
    if sys.argv[1] == "device":
        from device import Device
        return Device(bus)
    from device_kit import Device
    from palpate_wire import HidBus, SocketBus
    if sys.argv[1] == "device_kit_usb":
        return Device(HidBus(bus.detach()))
    return Device(SocketBus(bus, fd=sys.argv[1] == "device_kit"))


device, turns, due_ns = device_on(descriptor("--device-fd")), descriptor("--turn-fd"), PERIOD_NS
try:
    while turn := turns.recv(8):
        while due_ns <= struct.unpack("=q", turn)[0]:
            device.step()
            due_ns += PERIOD_NS
        turns.send(struct.pack("=q", due_ns))
except ConnectionError:
    pass
