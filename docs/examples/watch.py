#!/usr/bin/env python3
"""Watches a run while it goes on: one line each 0.1 s. Knows nothing of Palpate but where the schema lies.

palpate run SCENE --device loopback --telemetry ./run.telemetry & docs/examples/watch.py ./run.telemetry [SECONDS]
"""
import json, mmap, os, socket, struct, sys, time

with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as door:     # ask the controller for its memory
    door.connect(sys.argv[1])
    said, fds, _, _ = socket.recv_fds(door, 256, 1)
if not fds:
    sys.exit(said.decode() or "the controller gave nothing")
memory = mmap.mmap(fds[0], os.fstat(fds[0]).st_size, prot=mmap.PROT_READ)
magic, version, size, start = struct.unpack_from("<8sIIQ", memory)     # these places never change
schema = json.loads(memory[start:start + size])                        # all others are told here
ring, of_record = schema["ring"], schema["record"]
CODES = {"<f8": "d", "<f4": "f", "<u8": "Q", "<i8": "q", "<u4": "I", "<i4": "i"}


def values(part, data, base=0):
    """Every field of a part of the schema by name: a number, a list of numbers, or a text."""
    said = {}
    for field in part["fields"]:
        text, count = field["type"][0] == "S", (field["shape"] or [1])[0]
        code = field["type"][1:] + "s" if text else str(count) + CODES[field["type"]]
        got = struct.unpack_from("<" + code, data, base + field["offset"])
        said[field["name"]] = got[0].rstrip(b"\0").decode() if text else list(got) if field["shape"] else got[0]
    return said


def newest():
    """The newest record, or None: nothing yet, or it was overwritten while it was being copied."""
    number, = struct.unpack_from("<Q", memory, ring["newest"])
    slot = ring["slots"] + number % ring["capacity"] * ring["slot_bytes"]
    copy = memory[slot:slot + ring["slot_bytes"]]
    after, = struct.unpack_from("<Q", memory, slot + ring["sequence"])
    before, = struct.unpack_from("<Q", copy, ring["sequence"])
    return values(of_record, copy, ring["record"]) if number and before == after == number else None


header = values(schema["header"], memory)
print(header["scene_name"], "every", header["period_ns"], "ns, by", header["build_id"])
end = time.monotonic() + float(sys.argv[2] if len(sys.argv) > 2 else 1e9)
while time.monotonic() < end:
    if now := newest():
        print(now["tick"], schema["modes"][now["mode"]], "force", now["device_force_N"], "N")
    time.sleep(0.1)
