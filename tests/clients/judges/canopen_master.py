"""A CiA 402 master written from CiA 301 and CiA 402 alone, over SocketCAN by python-can; it shares no code with the gateway or its twins.

    canopen_master.py INTERFACE NODE=NAME...

By SDO alone, one drive after the other: brings it into operation, moves it to a place and by a speed, halts it, stops it quickly and switches it
off. It waits for each state as long as a patient master does, so that a late drive passes too. One line for each check.
"""
import struct
import sys
import time

import can

PATIENCE = 20


def check(text, good, more=""):
    print(f"{'pass' if good else 'FAIL'}: a master, {NAME}: {text}" + ("" if good else f" ({more})"), flush=True)
    return good


def ask(data):
    bus.send(can.Message(arbitration_id=0x600 + NODE, data=data, is_extended_id=False))
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        m = bus.recv(1)
        if m is not None and m.arbitration_id == 0x580 + NODE and len(m.data) == 8 and (m.data[0] == 0x80 or m.data[1:4] == data[1:4]):
            return bytes(m.data)
    raise TimeoutError("no answer to " + data.hex())


def read(index, sub=0, form="i"):
    a = ask(struct.pack("<BHBI", 0x40, index, sub, 0))
    if a[0] == 0x80:
        raise ValueError(f"{index:04X}: {struct.unpack('<I', a[4:])[0]:08X}h")
    return struct.unpack("<" + form, a[4:4 + struct.calcsize("<" + form)])[0]


def write(index, sub, form, number):
    raw = struct.pack("<" + form, number)
    a = ask(struct.pack("<BHB", 0x23 | (4 - len(raw)) << 2, index, sub) + raw.ljust(4, b"\0"))
    if a[0] != 0x60:
        raise ValueError(f"{index:04X} = {number}: {struct.unpack('<I', a[4:])[0]:08X}h")


def until(condition):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def control(word):
    write(0x6040, 0, "H", word)


def status():
    return read(0x6041, 0, "H")


def mode(number):
    write(0x6060, 0, "b", number)
    return until(lambda: read(0x6061, 0, "b") == number)


def set_point(target):
    write(0x607A, 0, "i", target)
    control(0x1F)
    taken = until(lambda: status() & 0x1000)
    control(0x0F)
    return taken


def judge():
    # A drive that boots does not answer yet.
    end = time.monotonic() + PATIENCE
    up = False
    while not up and time.monotonic() < end:
        bus.send(can.Message(arbitration_id=0x600 + NODE, data=struct.pack("<BHBI", 0x40, 0x1000, 0, 0), is_extended_id=False))
        m = bus.recv(1)
        up = m is not None and m.arbitration_id == 0x580 + NODE
    check("it answers", up)
    while bus.recv(0.6) is not None:
        pass
    bus.send(can.Message(arbitration_id=0, data=[1, NODE], is_extended_id=False))
    time.sleep(0.05)
    control(0x80)
    control(0x06)
    check("ready to switch on", until(lambda: status() & 0x6F == 0x21), hex(status()))
    control(0x07)
    check("switched on", until(lambda: status() & 0x6F == 0x23), hex(status()))
    check("profile position is shown", mode(1))
    for index, number in ((0x6081, 20000), (0x6083, 100000), (0x6084, 100000)):
        write(index, 0, "I", number)
    control(0x0F)
    check("operation enabled", until(lambda: status() & 0x6F == 0x27), hex(status()))
    begin = read(0x6064)
    check("a set-point is acknowledged", set_point(begin + 5000), hex(status()))
    check("and reached", until(lambda: abs(read(0x6064) - begin - 5000) <= 60 and status() & 0x400), f"{read(0x6064) - begin} of 5000")
    check("profile velocity is shown", mode(3))
    write(0x60FF, 0, "i", 5000)
    check("it turns", until(lambda: read(0x6064) > begin + 8000), str(read(0x6064) - begin))
    control(0x10F)
    place = [0, 1]

    def rests():
        place[:] = [place[1], read(0x6064)]
        time.sleep(0.1)
        return abs(place[0] - place[1]) <= 4

    check("a halt ends it", until(rests))
    write(0x60FF, 0, "i", 0)
    control(0x0F)
    control(0x0B)
    check("quick stop", until(lambda: status() & 0x6F in (0x07, 0x40)), hex(status()))
    control(0x00)
    check("switch on disabled", until(lambda: status() & 0x4F == 0x40), hex(status()))


for drive in sys.argv[2:]:
    number, NAME = drive.split("=")
    NODE = int(number)
    bus = can.Bus(interface="socketcan", channel=sys.argv[1], can_filters=[{"can_id": 0x580 + NODE, "can_mask": 0x7FF, "extended": False}])
    try:
        judge()
    except (TimeoutError, ValueError) as fault:
        check("it came to its end", False, fault)
    bus.shutdown()
