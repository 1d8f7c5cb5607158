"""A CiA 402 drive written from CiA 301 and CiA 402 alone, over SocketCAN by python-can; it shares no code with the gateway or its twins.

    canopen_drive.py INTERFACE NODE [--mode-shown-ms N] [--sample-ms N] [--acknowledge-ms N] [--sdo-ms N] [--boot-ms N]
                     [--pdo free|preop|fixed|none] [--missing 6062,606C,6502]

The switches are the choices that the standards leave to a drive. Profile position, profile velocity, homing by method 35 or 37; the shaft
follows trapezoidal ramps. Prints "ready" when it has booted, and one line for each change of its state or mode.
"""
import argparse
import math
import struct
import time

import can

ARGS = argparse.ArgumentParser()
ARGS.add_argument("interface")
ARGS.add_argument("node", type=int)
for name in ("mode-shown-ms", "sample-ms", "acknowledge-ms", "sdo-ms", "boot-ms"):
    ARGS.add_argument("--" + name, type=int, default=0)
ARGS.add_argument("--pdo", choices=("free", "preop", "fixed", "none"), default="free")
ARGS.add_argument("--missing", default="")
args = ARGS.parse_args()
NODE = args.node
NAME = b"a servo drive of another make"

# Index and subindex: format of struct, access, value. The dictionary of a small drive.
OBJECTS = {
    (0x1000, 0): ["I", "r", 0x00020192], (0x1001, 0): ["B", "r", 0], (0x1008, 0): ["s", "r", NAME], (0x1014, 0): ["I", "rw", 0x80 + NODE],
    (0x1016, 0): ["B", "r", 1], (0x1016, 1): ["I", "rw", 0], (0x1017, 0): ["H", "rw", 0],
    (0x1018, 0): ["B", "r", 4], (0x1018, 1): ["I", "r", 0x1AB], (0x1018, 2): ["I", "r", 0x77], (0x1018, 3): ["I", "r", 0x10002],
    (0x1018, 4): ["I", "r", 4711],
    (0x603F, 0): ["H", "r", 0], (0x6040, 0): ["H", "rw", 0], (0x6041, 0): ["H", "r", 0], (0x605A, 0): ["h", "rw", 2], (0x605C, 0): ["h", "rw", 1],
    (0x605D, 0): ["h", "rw", 1], (0x6060, 0): ["b", "rw", 0], (0x6061, 0): ["b", "r", 0], (0x6062, 0): ["i", "r", 0], (0x6064, 0): ["i", "r", 0],
    (0x6065, 0): ["I", "rw", 10000], (0x6067, 0): ["I", "rw", 10], (0x606B, 0): ["i", "r", 0], (0x606C, 0): ["i", "r", 0],
    (0x6077, 0): ["h", "r", 0], (0x6078, 0): ["h", "r", 0], (0x607A, 0): ["i", "rw", 0], (0x607C, 0): ["i", "rw", 0],
    (0x607D, 0): ["B", "r", 2], (0x607D, 1): ["i", "rw", -2**31], (0x607D, 2): ["i", "rw", 2**31 - 1], (0x607F, 0): ["I", "rw", 1000000],
    (0x6081, 0): ["I", "rw", 1000], (0x6083, 0): ["I", "rw", 20000], (0x6084, 0): ["I", "rw", 20000], (0x6085, 0): ["I", "rw", 100000],
    (0x6098, 0): ["b", "rw", 35], (0x6099, 0): ["B", "r", 2], (0x6099, 1): ["I", "rw", 1000], (0x6099, 2): ["I", "rw", 500],
    (0x609A, 0): ["I", "rw", 20000], (0x60C2, 0): ["B", "r", 2], (0x60C2, 1): ["B", "rw", 10], (0x60C2, 2): ["b", "rw", -3],
    (0x60F4, 0): ["i", "r", 0], (0x60FD, 0): ["I", "r", 0], (0x60FF, 0): ["i", "rw", 0], (0x6502, 0): ["I", "r", 0x25]}
for n in range(4):
    OBJECTS[(0x1400 + n, 0)] = ["B", "r", 2]
    OBJECTS[(0x1400 + n, 1)] = ["I", "rw", (0x200 + 0x100 * n + NODE) | (0 if n == 0 else 0x80000000)]
    OBJECTS[(0x1400 + n, 2)] = ["B", "rw", 255]
    OBJECTS[(0x1800 + n, 0)] = ["B", "r", 5]
    OBJECTS[(0x1800 + n, 1)] = ["I", "rw", (0x180 + 0x100 * n + NODE) | (0 if n == 0 else 0x80000000)]
    OBJECTS[(0x1800 + n, 2)] = ["B", "rw", 1]
    OBJECTS[(0x1800 + n, 3)] = ["H", "rw", 0]
    OBJECTS[(0x1800 + n, 5)] = ["H", "rw", 0]
    for base, first in ((0x1600, 0x60400010), (0x1A00, 0x60410010)):
        OBJECTS[(base + n, 0)] = ["B", "rw", 1 if n == 0 else 0]
        for sub in range(1, 9):
            OBJECTS[(base + n, sub)] = ["I", "rw", first if n == 0 and sub == 1 else 0]
if args.pdo == "none":
    for index, sub in list(OBJECTS):
        if 0x1400 <= index < 0x1C00:
            del OBJECTS[(index, sub)]
for index in (int(x, 16) for x in args.missing.split(",") if x):
    for key in [k for k in OBJECTS if k[0] == index]:
        del OBJECTS[key]

# Only what concerns this node: frames of others would cost their time in a slow machine.
MINE = [0x000, 0x080, 0x600 + NODE] + [0x200 + 0x100 * n + NODE for n in range(4)]
bus = can.Bus(interface="socketcan", channel=args.interface, can_filters=[{"can_id": i, "can_mask": 0x7FF, "extended": False} for i in MINE])


def send(identifier, data):
    bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))


def value(index, sub=0, fallback=0):
    return OBJECTS[(index, sub)][2] if (index, sub) in OBJECTS else fallback


def show(index, number):
    if (index, 0) in OBJECTS:
        OBJECTS[(index, 0)][2] = number


class Shaft:
    """Trapezoidal ramps towards a target or a speed, in increments and seconds."""
    position = velocity = 0.0
    target = None       # a place; None: `speed` counts
    speed = 0.0
    profile = 0.0       # speed of a positioning
    ramp = 20000.0

    def step(self, seconds):
        wanted = self.speed
        if self.target is not None:
            way = self.target - self.position
            most = math.sqrt(2 * self.ramp * abs(way))
            wanted = math.copysign(min(self.profile, most), way)
            if abs(way) < 2 and abs(self.velocity) <= self.ramp * seconds * 2:
                self.position, self.velocity = float(self.target), 0.0
                return
        change = max(-self.ramp * seconds, min(self.ramp * seconds, wanted - self.velocity))
        self.velocity += change
        self.position += self.velocity * seconds

    def stop(self, ramp):
        self.target, self.speed, self.ramp = None, 0.0, float(max(1, ramp))


class Drive:
    STATES = {"not ready": 0x0000, "switch on disabled": 0x0040, "ready": 0x0021, "switched on": 0x0023, "enabled": 0x0027, "quick stop": 0x0007,
              "fault": 0x0008}

    def __init__(self):
        self.state, self.word, self.shaft = "switch on disabled", 0, Shaft()
        self.mode, self.mode_due, self.acknowledged, self.acknowledge_due = 0, None, False, None
        self.homed, self.reached, self.sampled = False, False, 0.0
        self.shaft.stop(20000)

    def enter(self, state):
        if state != self.state:
            print("state", state, flush=True)
            self.state = state

    def on_control_word(self, now):
        word, before = value(0x6040), self.word
        self.word = word
        rising = word & ~before
        if self.state == "fault":
            if rising & 0x80:
                self.enter("switch on disabled")
            return
        if not word & 0x02:
            self.shaft.stop(value(0x6084, 0, 20000))
            self.enter("switch on disabled")
        elif not word & 0x04:
            if self.state == "enabled":
                self.shaft.stop(value(0x6085, 0, 100000))
                self.enter("quick stop")
            elif self.state != "quick stop":
                self.enter("switch on disabled")
        elif word & 0x0F == 0x06 and self.state != "quick stop":
            if self.state == "enabled":
                self.shaft.stop(value(0x6084, 0, 20000))
            self.enter("ready")
        elif word & 0x0F == 0x07 and self.state in ("ready", "switched on", "enabled"):
            if self.state == "enabled":
                self.shaft.stop(value(0x6084, 0, 20000))
            self.enter("switched on")
        elif word & 0x0F == 0x0F and self.state in ("ready", "switched on", "quick stop"):
            self.shaft.stop(value(0x6084, 0, 20000))
            self.enter("enabled")
        if self.state == "enabled":
            self.orders(rising, now)

    def orders(self, rising, now):
        if self.word & 0x100:
            self.shaft.stop(value(0x6084, 0, 20000))
        elif self.mode == 1 and rising & 0x10:
            target = value(0x607A)
            if self.word & 0x40:
                target += self.shaft.position if self.shaft.target is None else self.shaft.target
            self.shaft.target, self.shaft.profile = target, float(value(0x6081))
            self.shaft.ramp = float(max(1, value(0x6083)))
            self.acknowledge_due = now + args.acknowledge_ms / 1000
        elif self.mode == 6 and rising & 0x10:
            self.shaft.position = float(value(0x607C, 0, 0))
            self.shaft.stop(20000)
            self.homed = True
        if self.mode == 1 and not self.word & 0x10:
            self.acknowledged, self.acknowledge_due = False, None

    def step(self, now, seconds):
        if value(0x6060) != self.mode and self.mode_due is None:
            self.mode_due = now + args.mode_shown_ms / 1000
        if self.mode_due is not None and now >= self.mode_due:
            self.mode, self.mode_due = value(0x6060), None
            self.shaft.stop(value(0x6084, 0, 20000))
            self.homed = False
            print("mode", self.mode, flush=True)
        if now - self.sampled >= args.sample_ms / 1000:
            self.sampled = now
            self.on_control_word(now)
        if self.acknowledge_due is not None and now >= self.acknowledge_due:
            self.acknowledged, self.acknowledge_due = True, None
        if self.state == "enabled" and self.mode == 3 and not self.word & 0x100:
            self.shaft.target, self.shaft.speed = None, float(value(0x60FF))
            self.shaft.ramp = float(max(1, value(0x6083)))
        self.shaft.step(seconds)
        rest = self.shaft.velocity == 0
        if self.mode == 3:
            self.reached = rest if self.word & 0x100 else abs(self.shaft.velocity - value(0x60FF)) < 10
        else:
            self.reached = rest and (self.shaft.target is None or self.shaft.position == self.shaft.target)
        word = self.STATES[self.state] | 0x0200 | (0x0010 if self.state != "switch on disabled" else 0)
        if self.state not in ("quick stop", "fault"):
            word |= 0x0020 if self.state != "switch on disabled" else 0
        if self.reached:
            word |= 0x0400
        if self.mode == 1 and self.acknowledged or self.mode == 6 and self.homed or self.mode == 3 and rest:
            word |= 0x1000
        show(0x6041, word)
        show(0x6061, self.mode)
        show(0x6064, round(self.shaft.position))
        show(0x6062, round(self.shaft.position))
        show(0x606C, round(self.shaft.velocity))


class Node:
    def __init__(self):
        self.nmt, self.sending, self.toggle, self.waiting = "pre-operational", b"", 0, []
        self.last_beat, self.counts = 0.0, [0] * 4

    def abort(self, index, sub, code):
        send(0x580 + NODE, struct.pack("<BHBI", 0x80, index, sub, code))

    def may_map(self):
        return args.pdo == "free" or args.pdo == "preop" and self.nmt == "pre-operational"

    def write(self, index, sub, data):
        entry = OBJECTS.get((index, sub))
        if entry is None:
            return 0x06090011 if any(k[0] == index for k in OBJECTS) else 0x06020000
        if entry[1] != "rw":
            return 0x06010002
        if 0x1600 <= index < 0x1C00 and not 0x1800 <= index < 0x1A00 and not self.may_map():
            return 0x06010002 if args.pdo == "fixed" else 0x08000022
        if len(data) != struct.calcsize("<" + entry[0]):
            return 0x06070010
        entry[2] = struct.unpack("<" + entry[0], data)[0]
        return 0

    def request(self, data):
        command, index, sub = struct.unpack("<BHB", data[:4])
        if command >> 5 == 2:
            entry = OBJECTS.get((index, sub))
            if entry is None:
                return self.abort(index, sub, 0x06090011 if any(k[0] == index for k in OBJECTS) else 0x06020000)
            raw = entry[2] if entry[0] == "s" else struct.pack("<" + entry[0], entry[2])
            if len(raw) <= 4:
                return send(0x580 + NODE, struct.pack("<BHB", 0x43 | (4 - len(raw)) << 2, index, sub) + raw.ljust(4, b"\0"))
            self.sending, self.toggle = raw, 0
            return send(0x580 + NODE, struct.pack("<BHBI", 0x41, index, sub, len(raw)))
        if command >> 5 == 3:
            if command >> 4 & 1 != self.toggle:
                return self.abort(0, 0, 0x05030000)
            piece, self.sending = self.sending[:7], self.sending[7:]
            send(0x580 + NODE, bytes([self.toggle << 4 | (7 - len(piece)) << 1 | (0 if self.sending else 1)]) + piece.ljust(7, b"\0"))
            self.toggle ^= 1
            return None
        if command >> 5 == 1 and command & 2:
            size = 4 - (command >> 2 & 3) if command & 1 else 4
            code = self.write(index, sub, bytes(data[4:4 + size]))
            return self.abort(index, sub, code) if code else send(0x580 + NODE, struct.pack("<BHBI", 0x60, index, sub, 0))
        return self.abort(index, sub, 0x05040001)

    def mapped(self, base, n):
        for sub in range(1, value(base + n, 0) + 1):
            entry = value(base + n, sub)
            yield entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8

    def packed(self, n):
        out = b""
        for index, sub, size in self.mapped(0x1A00, n):
            out += (value(index, sub) & (1 << size * 8) - 1).to_bytes(size, "little")
        return out

    def on_frame(self, m, now):
        data = bytes(m.data)
        if m.arbitration_id == 0x600 + NODE and len(data) == 8 and self.nmt != "stopped":
            self.waiting.append((now + args.sdo_ms / 1000, data))
        elif m.arbitration_id == 0 and len(data) == 2 and data[1] in (0, NODE):
            self.nmt = {1: "operational", 2: "stopped", 0x80: "pre-operational"}.get(data[0], self.nmt)
            if data[0] in (0x81, 0x82):
                self.boot()
        elif m.arbitration_id == 0x80 and self.nmt == "operational" and args.pdo != "none":
            for n in range(4):
                kind = value(0x1800 + n, 2)
                self.counts[n] += 1
                if not value(0x1800 + n, 1) & 0x80000000 and 1 <= kind <= 240 and self.counts[n] >= kind:
                    self.counts[n] = 0
                    send(value(0x1800 + n, 1) & 0x7FF, self.packed(n))
        elif self.nmt == "operational" and args.pdo != "none":
            for n in range(4):
                if value(0x1400 + n, 1) == m.arbitration_id:
                    for index, sub, size in self.mapped(0x1600, n):
                        part, data = data[:size], data[size:]
                        if (index, sub) in OBJECTS and len(part) == size:
                            OBJECTS[(index, sub)][2] = struct.unpack("<" + OBJECTS[(index, sub)][0], part)[0]

    def boot(self):
        time.sleep(args.boot_ms / 1000)
        self.nmt = "pre-operational"
        send(0x700 + NODE, b"\0")

    def step(self, now):
        while self.waiting and self.waiting[0][0] <= now:
            self.request(self.waiting.pop(0)[1])
        beat = value(0x1017)
        if beat and now - self.last_beat >= beat / 1000:
            self.last_beat = now
            send(0x700 + NODE, bytes([{"operational": 5, "stopped": 4}.get(self.nmt, 0x7F)]))


node, drive = Node(), Drive()
node.boot()
print("ready", flush=True)
last = time.monotonic()
while True:
    message = bus.recv(0.01)
    moment = time.monotonic()
    drive.step(moment, moment - last)
    last = moment
    node.step(moment)
    if message is not None and not message.is_extended_id and not message.is_error_frame:
        node.on_frame(message, moment)
        drive.step(moment, 0.0)
