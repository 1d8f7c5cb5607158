#!/usr/bin/env python3
"""A program over EtherNet/IP with explicit messages: it enables axes, homes them, moves each to its positions, and switches them off, one by one.

    enip_program.py [AXIS ...]      feeder, spindle, lift of plc-site.json; all three without arguments

It uses three messages, each to an assembly (class 04h) and its data (attribute 3), as a PLC does with its message instruction:

    Get_Attribute_Single (0Eh)  class 04h  instance 100 + n  attribute 3    32 bytes from axis n: registers 0 to 15 of the standard map
    Get_Attribute_Single (0Eh)  class 04h  instance 150 + n  attribute 3    32 bytes: the values that were written last
    Set_Attribute_Single (10h)  class 04h  instance 150 + n  attribute 3    32 bytes to axis n: registers 32 to 47; answered when the drive has answered

Values are little endian. Real drives differ, so the program copes with late answers, drives that are in another state than expected, and drives that
trip: what is not done is tried again. It ends with code 0 if each axis has stood at each of its positions with power, and is switched off.

Environment: AXISGATE_ENIP is ADDRESS:PORT of the gateway (default 127.0.0.1:44818). AXISGATE_TIME_SCALE says how many times as fast as the clock of
this computer the gateway's time passes (default 1); all times below are times of the gateway. Try it against many drives, without any:

    axisgate rehearse --site plc-site.json --program 'python3 enip_program.py feeder lift' --specimens 1..20 --time-scale 10
"""
import os
import socket
import struct
import sys
import time

SCALE = float(os.environ.get("AXISGATE_TIME_SCALE", "1"))

# --- the axes of plc-site.json; lengths are increments
#         number  homing methods  positions                speed  ramp    window
AXES = {
    "feeder": (1, (35,),          (6400, 16000, 3200, 0),   32000, 160000, 160),
    "spindle": (2, (35, 37),      (2000, 5000, 1000, 0),    10000, 50000, 50),
    "lift": (3, (33, 35),         (10240, 25600, 5120, 0),  51200, 256000, 256),
}

# --- CiA 402
DISABLE_VOLTAGE, SHUTDOWN, SWITCH_ON, ENABLE, START, FAULT_RESET, HALT = 0x00, 0x06, 0x07, 0x0F, 0x1F, 0x80, 0x10F   # control word
READY, SWITCHED_ON, OPERATION_ENABLED, QUICK_STOP = 0x21, 0x23, 0x27, 0x07                                           # status word & 6Fh
FAULT, TARGET_REACHED, HOMING_DONE, HOMING_ERROR, REFERENCED = 0x08, 0x400, 0x1000, 0x2000, 0x8000                   # bits of the status word
POSITIONING, HOMING = 1, 6                                                                                           # modes of operation
ONLINE, STALE, MOVING = 0x01, 0x04, 0x10                                                                             # bits of the flags (register 9)

CYCLE_S = 0.05        # between two looks at an axis
ATTEMPTS = 8          # of one step, before the axis is given up
FAST_ATTEMPTS = 2     # of a motion; each further one has half of the speed and a quarter of the ramp
STEP_LIMIT_S = 60.0   # of one attempt at a motion
STATE_LIMIT_S = 20.0  # for the drive to show a state, or to accept a write
ONLINE_LIMIT_S = 120.0
# General statuses of an answer that another attempt may overcome: no resource now, a connection that is lost, a held axis, a wrong state, a refusal of the drive.
TRY_AGAIN = {0x02, 0x07, 0x0C, 0x10, 0x1F}


class Refused(Exception):
    """The gateway has answered with a status; `reason` is the word behind it (register 20), or 0."""

    def __init__(self, status, reason):
        super().__init__(f"general status {status:02X}h, reason {reason}")
        self.status = status


class NotReached(Exception):
    """An attempt at a step has failed: the drive is in fault, or away, or too late."""


def now():
    return time.monotonic() * SCALE


def pause(seconds):
    time.sleep(seconds / SCALE)


class EtherNetIp:
    """One session of messages. It is opened anew with the next message after a connection that broke."""

    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        self.address, self.limit = (host, int(port)), max(2.0, 20.0 / SCALE)
        self.tcp, self.session = None, 0

    def read(self, count):
        data = b""
        while len(data) < count:
            more = self.tcp.recv(count - len(data))
            if not more:
                raise ConnectionError("the gateway has closed the session")
            data += more
        return data

    def packet(self, command, data):
        """One packet of the encapsulation and its answer: 24 bytes of header, then data."""
        self.tcp.sendall(struct.pack("<HHII8xI", command, len(data), self.session, 0, 0) + data)
        _, length, session, status = struct.unpack("<HHII12x", self.read(24))
        data = self.read(length)
        if status:
            raise ConnectionError(f"status {status:04X}h of the encapsulation")
        return session, data

    def message(self, service, instance, data=b""):
        """One message to attribute 3 of an assembly: SendRRData (6Fh) with a null address and an unconnected message (B2h)."""
        class_4, attribute_3 = b"\x20\x04", b"\x30\x03"
        to = b"\x24" + bytes([instance]) if instance < 256 else b"\x25\x00" + struct.pack("<H", instance)
        path = class_4 + to + attribute_3
        request = bytes([service, len(path) // 2]) + path + data
        try:
            if self.tcp is None:
                self.tcp = socket.create_connection(self.address, timeout=self.limit)
                self.tcp.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self.session = 0
                self.session, _ = self.packet(0x65, struct.pack("<HH", 1, 0))   # RegisterSession
            answer = self.packet(0x6F, struct.pack("<IHHHHHH", 0, 0, 2, 0, 0, 0xB2, len(request)) + request)[1][16:]
        except OSError:
            if self.tcp is not None:
                self.tcp.close()
            self.tcp = None
            raise
        status, words = answer[2], answer[3]
        if status:
            raise Refused(status, struct.unpack_from("<H", answer, 4)[0] if words else 0)
        return answer[4 + 2 * words:]

    def get(self, instance):
        return self.message(0x0E, instance)

    def set(self, instance, data):
        self.message(0x10, instance, data)


class Axis:
    def __init__(self, door, name):
        self.door, self.name = door, name
        number, self.methods, self.positions, self.speed, self.ramp, self.window = AXES[name]
        self.input, self.output = (100 + number, 150 + number) if number <= 40 else (1000 + number, 2000 + number)
        self.attempt, self.refused = 1, ""
        self.status = self.position = self.flags = 0
        # What this program writes: registers 32 to 47.
        self.control = self.mode = self.target = self.velocity = self.acceleration = self.deceleration = self.method = 0

    # --- the two assemblies
    def look(self):
        """Reads the axis. A look without an answer is repeated for a while."""
        for silent in range(ATTEMPTS, -1, -1):
            try:
                data = self.door.get(self.input)
                break
            except OSError:
                if not silent:
                    raise
                pause(0.2)
        self.status, _, self.position = struct.unpack_from("<Hhi", data, 0)
        self.flags, = struct.unpack_from("<H", data, 18)

    def begin(self):
        """Takes over the values that stand in the output, so that the first write changes its own values only."""
        data = self.door.get(self.output)
        self.control, self.mode, self.target, self.velocity, self.acceleration, self.deceleration, _, self.method = struct.unpack_from("<HhiIIIih", data, 0)

    def write(self, **values):
        """Writes the output with these values changed, until it is accepted."""
        for name, value in values.items():
            setattr(self, name, value)
        data = struct.pack("<HhiIIIih6x", self.control, self.mode, self.target, self.velocity, self.acceleration, self.deceleration, 0, self.method)
        end = now() + STATE_LIMIT_S
        while True:
            try:
                return self.door.set(self.output, data)
            except Refused as refusal:
                self.refused = f"the write was refused: {refusal}"
                if refusal.status not in TRY_AGAIN or now() > end or self.status & FAULT:
                    raise NotReached(self.refused)
            except OSError as error:   # it is not known whether it was carried out: it is written again in the next session
                self.refused = f"the write had no answer: {error}"
                if now() > end:
                    raise NotReached(self.refused)
            pause(0.1)
            self.look()

    def wait(self, holds, limit, what):
        """Until `holds` is true. A drive that trips or goes away meanwhile ends the attempt."""
        end = now() + limit
        while True:
            self.look()
            if holds():
                return
            if now() > end or not self.online() or self.status & FAULT and what != "the fault to go":
                raise NotReached(f"waited for {what}")
            pause(CYCLE_S)

    def online(self):
        return bool(self.flags & ONLINE) and not self.flags & STALE

    def state(self):
        return self.status & 0x6F

    # --- the steps
    def enable(self):
        """From whatever state the drive shows to operation enabled."""
        end = now() + ONLINE_LIMIT_S
        self.look()
        while not self.online():
            if now() > end:
                raise NotReached("the drive is not online")
            pause(1.0)
            self.look()
        if self.status & FAULT:
            self.write(control=DISABLE_VOLTAGE)
            self.write(control=FAULT_RESET)    # acts with the rising edge of its bit
            self.wait(lambda: not self.status & FAULT, STATE_LIMIT_S, "the fault to go")
        if self.state() == QUICK_STOP:
            self.write(control=DISABLE_VOLTAGE)
            self.look()
        for word, reached in ((SHUTDOWN, (READY, SWITCHED_ON, OPERATION_ENABLED)), (SWITCH_ON, (SWITCHED_ON, OPERATION_ENABLED)),
                              (ENABLE, (OPERATION_ENABLED,))):
            if self.state() not in reached:
                self.write(control=word)
                self.wait(lambda: self.state() in reached, STATE_LIMIT_S, f"the state after control word {word:02X}h")

    def home(self):
        # The last method is for a drive that has refused the others.
        method = self.methods[min((self.attempt - 1) // FAST_ATTEMPTS, len(self.methods) - 1)]
        self.write(control=ENABLE, mode=HOMING, method=method)
        self.write(control=START)
        ended = HOMING_DONE | TARGET_REACHED
        self.wait(lambda: self.status & HOMING_ERROR or self.status & ended == ended and not self.flags & MOVING, STEP_LIMIT_S, "the end of the homing")
        self.write(control=ENABLE)
        if self.status & HOMING_ERROR or not self.status & REFERENCED:
            raise NotReached("the homing has failed")

    def move(self, target):
        slower = max(0, self.attempt - FAST_ATTEMPTS)
        ramp = self.ramp >> 2 * slower
        self.write(control=ENABLE, mode=POSITIONING, velocity=self.speed >> slower, acceleration=ramp, deceleration=ramp)
        self.write(control=START, target=target)
        try:
            self.wait(lambda: self.status & TARGET_REACHED and not self.flags & MOVING and self.near(target), STEP_LIMIT_S, f"position {target}")
        except NotReached:
            if self.flags & MOVING:
                self.write(control=HALT)
            raise
        self.write(control=ENABLE)
        pause(0.5)   # it must be there, with power, half a second later, too
        self.look()
        if self.state() != OPERATION_ENABLED or not self.near(target):
            raise NotReached(f"it did not stay at {target}")

    def near(self, target):
        return abs(self.position - target) <= self.window

    def disable(self):
        self.write(control=DISABLE_VOLTAGE)
        self.wait(lambda: self.state() not in (OPERATION_ENABLED, SWITCHED_ON, QUICK_STOP) and not self.flags & MOVING, STATE_LIMIT_S, "the power to go")

    def carry_out(self, step, work, with_power=True):
        """Tries a step until it succeeds. A drive that has tripped or was switched off is enabled again before."""
        why = ""
        for self.attempt in range(1, ATTEMPTS + 1):
            try:
                if with_power:
                    self.enable()
                return work()
            except (NotReached, Refused, OSError) as failure:
                why = str(failure)
            pause(0.5 * self.attempt)
        print(f"step: {self.name}: {step}, attempt {self.attempt}")
        print(f"{self.name}: {why}; status word {self.status:04X}h, position {self.position}, flags {self.flags:03X}h")
        sys.exit(1)

    def run(self):
        self.carry_out("begin", self.begin, with_power=False)
        self.carry_out("enable", lambda: None)
        self.carry_out("home", self.home)
        for target in self.positions:
            self.carry_out(f"move to {target}", lambda: self.move(target))
        self.carry_out("disable", self.disable, with_power=False)


def main():
    names = sys.argv[1:] or list(AXES)
    if unknown := [name for name in names if name not in AXES]:
        print(f"there is no axis {unknown[0]}; there are {', '.join(AXES)}")
        return 2
    begun = now()
    door = EtherNetIp(os.environ.get("AXISGATE_ENIP", "127.0.0.1:44818"))
    for name in names:
        Axis(door, name).run()
    print(f"{len(names)} axes have stood at all their positions after {now() - begun:.1f} s and are switched off")
    return 0


if __name__ == "__main__":
    sys.exit(main())
