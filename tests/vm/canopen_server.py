"""An SDO server of its own, over SocketCAN by python-can: a drive by CiA 402 that holds whatever is written, at rest, for the gateway to find.

In: an interface, a node number. Out: answers on the bus, until it is ended. Shares nothing with the gateway but CiA 301.
"""
import struct
import sys

import can

bus = can.Bus(interface="socketcan", channel=sys.argv[1])
node = int(sys.argv[2])
NAME = b"a drive of another make, by its long name"
# Index and subindex: value, and its size; 0: as the bytes have it.
objects = {(0x1000, 0): struct.pack("<I", 402), (0x1001, 0): b"\0", (0x1008, 0): NAME, (0x1017, 0): b"\0\0", (0x1018, 1): struct.pack("<I", 0x1AB), (0x1018, 2): struct.pack("<I", 0x77),
           (0x1018, 3): struct.pack("<I", 0x10002), (0x6040, 0): b"\0\0", (0x6041, 0): struct.pack("<H", 0x0240), (0x605A, 0): b"\x06\0", (0x6060, 0): b"\1", (0x6061, 0): b"\1",
           (0x6064, 0): struct.pack("<i", -4711), (0x606C, 0): bytes(4), (0x6062, 0): struct.pack("<i", -4711), (0x6081, 0): struct.pack("<I", 800), (0x6083, 0): struct.pack("<I", 900),
           (0x6084, 0): struct.pack("<I", 900), (0x6098, 0): b"\x25", (0x6502, 0): struct.pack("<I", 0x25), (0x603F, 0): b"\0\0"}
sending, toggle, started = b"", 0, False


def send(identifier, data):
    bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))


def abort(index, sub, code):
    send(0x580 + node, struct.pack("<BHBI", 0x80, index, sub, code))


def on_request(data):
    global sending, toggle
    command, index, sub = struct.unpack("<BHB", data[:4])
    if command >> 5 == 2:
        value = objects.get((index, sub))
        if value is None:
            return abort(index, sub, 0x06020000)
        if len(value) <= 4:
            return send(0x580 + node, struct.pack("<BHB", 0x43 | (4 - len(value)) << 2, index, sub) + value.ljust(4, b"\0"))
        sending, toggle = value, 0
        return send(0x580 + node, struct.pack("<BHBI", 0x41, index, sub, len(value)))
    if command >> 5 == 3:
        if command >> 4 & 1 != toggle:
            return abort(0, 0, 0x05030000)
        piece, sending = sending[:7], sending[7:]
        send(0x580 + node, bytes([toggle << 4 | (7 - len(piece)) << 1 | (0 if sending else 1)]) + piece.ljust(7, b"\0"))
        toggle ^= 1
        return None
    if command >> 5 == 1 and command & 2:
        size = 4 - (command >> 2 & 3) if command & 1 else 4
        if (index, sub) in ((0x1000, 0), (0x6041, 0), (0x6064, 0)):
            return abort(index, sub, 0x06010002)
        objects[index, sub] = bytes(data[4:4 + size])
        return send(0x580 + node, struct.pack("<BHBI", 0x60, index, sub, 0))
    return abort(index, sub, 0x05040001)


print("ready", flush=True)
send(0x700 + node, b"\0")
while True:
    m = bus.recv(1)
    if m is None or m.is_extended_id:
        continue
    if m.arbitration_id == 0x600 + node and len(m.data) == 8:
        on_request(bytes(m.data))
    elif m.arbitration_id == 0 and len(m.data) == 2 and m.data[1] in (0, node):
        started = m.data[0] == 1
    elif m.arbitration_id == 0x80 and started:
        send(0x180 + node, objects[0x6041, 0] + objects[0x6064, 0] + objects[0x6061, 0])
        send(0x280 + node, objects[0x606C, 0] + objects[0x6062, 0])
