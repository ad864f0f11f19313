"""What canmatrix makes of a candump log by a .dbc, both read by programs of others: a line a frame, its name and
signals; frames that the .dbc does not have are named so. Usage: decode_log.py DBC LOG"""

import sys

import can
import canmatrix.formats

matrix = next(iter(canmatrix.formats.loadp(sys.argv[1]).values()))
for message in can.CanutilsLogReader(sys.argv[2]):
    if message.is_remote_frame:
        continue
    frame = matrix.frame_by_id(canmatrix.ArbitrationId(message.arbitration_id))
    if frame is None:
        print("unknown", hex(message.arbitration_id))
        continue
    # A parameter's question is sent without the value it asks for.
    data = bytes(message.data).ljust(frame.size, b"\0")
    values = matrix.decode(canmatrix.ArbitrationId(message.arbitration_id), data)
    print(frame.name, *(f"{name} {float(signal.phys_value)!r}" for name, signal in values.items()))
