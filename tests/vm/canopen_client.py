"""An SDO client of its own, over SocketCAN by python-can, against the simulated CiA 402 drive: expedited, segmented, block, and what must be refused.

In: an interface, a node number. Out: "pass: ..." or "FAIL: ..." per check. Shares nothing with the gateway but CiA 301.
"""
import struct
import sys

import can

bus = can.Bus(interface="socketcan", channel=sys.argv[1])
node = int(sys.argv[2])


def check(text, good, more=""):
    print(f"{'pass' if good else 'FAIL'}: python-can: {text}" + ("" if good else f" ({more})"), flush=True)


def send(data):
    bus.send(can.Message(arbitration_id=0x600 + node, data=data, is_extended_id=False))


def answer(seconds=10):
    while True:
        m = bus.recv(seconds)
        if m is None:
            raise TimeoutError("no answer")
        if m.arbitration_id == 0x580 + node and len(m.data) == 8:
            return bytes(m.data)


def ask(data):
    send(data)
    return answer()


def head(command, index, sub, rest=b"\0\0\0\0"):
    return struct.pack("<BHB", command, index, sub) + rest


def abort_of(a):
    return struct.unpack("<I", a[4:])[0] if a[0] == 0x80 else 0


def read(index, sub=0):
    a = ask(head(0x40, index, sub))
    if a[0] & 2:
        return a[4:8 - (a[0] >> 2 & 3)] if a[0] & 1 else a[4:]
    size, data, toggle = struct.unpack("<I", a[4:])[0], b"", 0
    while True:
        a = ask(bytes([0x60 | toggle << 4, 0, 0, 0, 0, 0, 0, 0]))
        assert a[0] >> 5 == 0 and a[0] >> 4 & 1 == toggle, a.hex()
        data += a[1:8 - (a[0] >> 1 & 7)]
        if a[0] & 1:
            assert len(data) == size, (len(data), size)
            return data
        toggle ^= 1


def crc(data):
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021 if value & 0x8000 else value << 1) & 0xFFFF
    return value


def read_block(index, sub=0):
    a = ask(head(0xA4, index, sub, bytes([4, 0, 0, 0])))  # four segments a block, CRC
    assert a[0] >> 5 == 6 and a[0] & 1 == 0, a.hex()
    send(bytes([0xA3, 0, 0, 0, 0, 0, 0, 0]))
    data, count = b"", 0
    while True:
        a = answer()
        count += 1
        assert a[0] & 0x7F == count, a.hex()
        data += a[1:]
        if a[0] & 0x80 or count == 4:
            send(bytes([0xA2, count, 4, 0, 0, 0, 0, 0]))
            last, count = a[0] & 0x80, 0
            if last:
                break
    a = answer()
    assert a[0] & 0xE3 == 0xC1, a.hex()
    data = data[:len(data) - (a[0] >> 2 & 7)]
    assert struct.unpack("<H", a[1:3])[0] == crc(data), "CRC"
    send(bytes([0xA1, 0, 0, 0, 0, 0, 0, 0]))
    return data


check("device type by an expedited upload", struct.unpack("<I", read(0x1000))[0] & 0xFFFF == 402)
name = read(0x1008)
check("device name by a segmented upload", name == b"generic servo", name)
check("and by a block upload with its CRC", read_block(0x1008) == name)
a = ask(head(0x23, 0x6081, 0, struct.pack("<I", 12345)))
check("profile velocity is written", a[0] == 0x60, a.hex())
check("and read back", struct.unpack("<I", read(0x6081))[0] == 12345)
check("an object that is not there: 06020000h", abort_of(ask(head(0x40, 0x5500, 0))) == 0x06020000)
check("a subindex that is not there: 06090011h", abort_of(ask(head(0x40, 0x6041, 9))) == 0x06090011)
check("a write of what is only read: 06010002h", abort_of(ask(head(0x2B, 0x6041, 0))) == 0x06010002)
check("a value of a wrong length", abort_of(ask(head(0x2F, 0x6081, 0))) in (0x06070010, 0x06070012, 0x06070013))
ask(head(0x40, 0x1008, 0))
check("a wrong toggle bit: 05030000h", abort_of(ask(bytes([0x70, 0, 0, 0, 0, 0, 0, 0]))) == 0x05030000)
check("an unknown command: 05040001h", abort_of(ask(bytes([0xE0, 0, 0, 0, 0, 0, 0, 0]))) == 0x05040001)
check("and the server goes on", struct.unpack("<I", read(0x6081))[0] == 12345)
bus.shutdown()
