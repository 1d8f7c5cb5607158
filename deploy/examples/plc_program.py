#!/usr/bin/env python3
"""A PLC program over Modbus/TCP: it enables three axes, homes them, moves each to its positions, checks where they stand, and switches them off.

It is written as a PLC does it: one cycle reads the status of every axis, each axis has a state machine of its own, and every wait has a limit of time.
A drive may answer late, refuse a word while it is busy, trip, or be restarted: the program repeats a refused write, resets a fault, and does the step
again that was in progress, a limited number of times, more slowly each time, because a motor may be too weak for the ramp. A drive without an encoder
cannot search for an index: then the present place becomes zero. A node that another master has stopped is started by a stop. The program ends with
code 0 if every axis has stood at each of its positions, with power, and is switched off.

Environment: AXISGATE_MODBUS is ADDRESS:PORT of the gateway (default 127.0.0.1:1502). AXISGATE_TIME_SCALE says how many times as fast as the clock of
this computer the gateway's time passes (default 1); all times below are times of the gateway. Try it against many drives, without any:

    axisgate rehearse --site plc-site.json --program 'python3 plc_program.py' --specimens 1..100 --time-scale 10
"""
import os
import socket
import struct
import sys
import time

# Control words of CiA 402.
DISABLE_VOLTAGE, SHUTDOWN, SWITCH_ON, ENABLE, START, FAULT_RESET, HALT = 0x00, 0x06, 0x07, 0x0F, 0x1F, 0x80, 0x10F
# The state in the status word: its bits, and their value.
NOT_READY, DISABLED, READY, SWITCHED_ON, OPERATION_ENABLED, QUICK_STOP, FAULT = range(7)
STATES = ((0x4F, 0x40, DISABLED), (0x6F, 0x21, READY), (0x6F, 0x23, SWITCHED_ON), (0x6F, 0x27, OPERATION_ENABLED), (0x6F, 0x07, QUICK_STOP),
          (0x4F, 0x08, FAULT), (0x4F, 0x0F, FAULT))
ONLINE, STALE, MOVING = 0x01, 0x04, 0x10  # register 9
REFERENCED = 0x8000                       # status word
POSITIONING, HOMING = 1, 6                # modes of operation
# Exceptions that another attempt may overcome: a state that has not come yet, busy, a line that is down, no answer.
TRY_AGAIN = {4, 6, 10, 11}

CYCLE_S = 0.02
ATTEMPTS = 8          # of one step, before the axis is given up
FAST_ATTEMPTS = 2     # of a motion; each further one has half of the speed and a quarter of the ramp
STEP_LIMIT_S = 60.0   # of one attempt at a motion
STATE_LIMIT_S = 20.0  # for the drive to show a state
ONLINE_LIMIT_S = 120.0


class Refused(Exception):
    """The gateway has answered with an exception of Modbus."""

    def __init__(self, code):
        super().__init__(f"Modbus exception {code}")
        self.code = code


class Modbus:
    """One connection; a connection that broke is made again with the next request."""

    def __init__(self, address, scale):
        host, port = address.rsplit(":", 1)
        self.address, self.limit, self.socket, self.number = (host, int(port)), max(2.0, 20.0 / scale), None, 0

    def request(self, pdu):
        if self.socket is None:
            self.socket = socket.create_connection(self.address, timeout=self.limit)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.number = self.number % 65535 + 1
        try:
            self.socket.sendall(struct.pack(">HHHB", self.number, 0, len(pdu) + 1, 1) + pdu)
            length = struct.unpack(">HHH", self.read(6))[2]
            answer = self.read(length)[1:]
        except OSError:
            self.socket.close()
            self.socket = None
            raise
        if answer[0] & 0x80:
            raise Refused(answer[1])
        return answer

    def read(self, count):
        data = b""
        while len(data) < count:
            more = self.socket.recv(count - len(data))
            if not more:
                raise ConnectionError("the gateway has closed the connection")
            data += more
        return data

    def registers(self, address, count):
        return struct.unpack(f">{count}H", self.request(struct.pack(">BHH", 3, address, count))[2:])

    def write(self, address, *words):
        words = [w & 0xFFFF for w in words]
        self.request(struct.pack(f">BHHB{len(words)}H", 16, address, len(words), 2 * len(words), *words))


def words_of(value):
    return (value >> 16) & 0xFFFF, value & 0xFFFF


class Axis:
    """One axis, by its number at the gateway. Lengths are increments."""

    def __init__(self, name, number, homing_methods, positions, speed, ramp, window):
        self.name, self.base, self.methods, self.speed, self.ramp, self.window = name, (number - 1) * 64, homing_methods, speed, ramp, window
        self.positions = list(positions)
        self.step, self.done, self.failure = "wait for the drive", False, ""
        self.tries, self.refused = 1, ""
        self.status = self.position = self.flags = self.unread = 0
        self.program = None

    # --- what the drive shows
    @property
    def state(self):
        return next((state for mask, value, state in STATES if self.status & mask == value), NOT_READY)

    @property
    def online(self):
        return bool(self.flags & ONLINE) and not self.flags & STALE

    @property
    def moving(self):
        return bool(self.flags & MOVING)

    def take(self, registers):
        self.status, high, low, self.flags = registers[0], registers[2], registers[3], registers[9]
        self.position = struct.unpack(">i", struct.pack(">HH", high, low))[0]


class Program:
    def __init__(self, modbus, scale, axes):
        self.modbus, self.scale, self.axes, self.began = modbus, scale, axes, time.monotonic()
        for axis in axes:
            axis.program = self.run_axis(axis)

    def now(self):
        return (time.monotonic() - self.began) * self.scale

    def run(self):
        while not all(axis.done or axis.failure for axis in self.axes):
            begun = time.monotonic()
            for axis in self.axes:
                if not axis.done and not axis.failure:
                    self.cycle(axis)
            time.sleep(max(0.0, CYCLE_S / self.scale - (time.monotonic() - begun)))
        return [axis for axis in self.axes if axis.failure]

    def cycle(self, axis):
        """Reads the axis and runs its program until it waits again."""
        try:
            axis.take(self.modbus.registers(axis.base, 24))
            axis.unread = 0
            next(axis.program)
        except StopIteration:
            axis.done = True
        except OSError as error:
            axis.unread += 1
            if axis.unread >= ATTEMPTS:
                axis.failure = f"no connection to the gateway: {error}"
        except GivenUp as error:
            axis.failure = str(error)

    # --- parts of a step: generators that yield once in each cycle
    def wait(self, axis, holds, limit):
        """True when `holds` is true; False when the limit has passed, or the drive shows a fault or is away meanwhile."""
        end = self.now() + limit
        while not holds():
            if self.now() > end or axis.state == FAULT or not axis.online:
                return False
            yield
        return True

    def pause(self, seconds):
        end = self.now() + seconds
        while self.now() < end:
            yield

    def write(self, axis, offset, *words):
        """Writes until it is accepted; False if it is refused for good or for too long."""
        end = self.now() + STATE_LIMIT_S
        while True:
            try:
                self.modbus.write(axis.base + offset, *words)
                return True
            except Refused as refusal:
                axis.refused = f"the write at {offset} was refused ({refusal})"
                if refusal.code not in TRY_AGAIN or self.now() > end or axis.state == FAULT:
                    return False
            except OSError as error:  # whether it was carried out is not known: it is written again on the next connection
                axis.refused = f"the write at {offset} had no answer ({error})"
                if self.now() > end:
                    return False
            yield from self.pause(0.1)

    def enable(self, axis):
        """From whatever state the drive shows to operation enabled."""
        online_end = self.now() + ONLINE_LIMIT_S
        while not axis.online:
            if self.now() > online_end:
                raise GivenUp("the drive is not online")
            # A stop is sent to a drive that does not answer, too, and starts a node that another master has stopped.
            try:
                self.modbus.write(axis.base + 32, DISABLE_VOLTAGE)
            except (Refused, OSError):
                pass
            yield from self.pause(2.0)
        if axis.state == FAULT:
            # The reset acts with the rising edge of its bit.
            yield from self.write(axis, 32, DISABLE_VOLTAGE)
            yield from self.write(axis, 32, FAULT_RESET)
            if not (yield from self.wait_state(axis, lambda: axis.state != FAULT)):
                return False
        if axis.state == QUICK_STOP:
            yield from self.write(axis, 32, DISABLE_VOLTAGE)
        for word, reached in ((SHUTDOWN, (READY, SWITCHED_ON, OPERATION_ENABLED)), (SWITCH_ON, (SWITCHED_ON, OPERATION_ENABLED)),
                              (ENABLE, (OPERATION_ENABLED,))):
            if axis.state in reached:
                continue
            if not (yield from self.write(axis, 32, word)):
                return False
            if not (yield from self.wait_state(axis, lambda: axis.state in reached)):
                return False
        return True

    def wait_state(self, axis, holds):
        """As wait(), for a state that may begin with a fault."""
        end = self.now() + STATE_LIMIT_S
        while not holds():
            if self.now() > end or not axis.online:
                return False
            yield
        return True

    def home(self, axis):
        # The last method is for a drive that has refused the others.
        method = axis.methods[min((axis.tries - 1) // FAST_ATTEMPTS, len(axis.methods) - 1)]
        if not (yield from self.write(axis, 33, HOMING)) or not (yield from self.write(axis, 44, method)):
            return False
        if not (yield from self.write(axis, 32, ENABLE)) or not (yield from self.write(axis, 32, START)):
            return False
        yield
        # Homing attained, target reached, no homing error, and it stands.
        good = yield from self.wait(axis, lambda: axis.status & 0x3400 == 0x1400 and not axis.moving or axis.status & 0x2000, STEP_LIMIT_S)
        yield from self.write(axis, 32, ENABLE)
        return good and not axis.status & 0x2000 and bool(axis.status & REFERENCED)

    def move(self, axis, target):
        if not (yield from self.write(axis, 33, POSITIONING)):
            return False
        slower = max(0, axis.tries - FAST_ATTEMPTS)
        speed, ramp = axis.speed >> slower, axis.ramp >> 2 * slower
        for offset, value in ((36, speed), (38, ramp), (40, ramp), (34, target)):
            if not (yield from self.write(axis, offset, *words_of(value))):
                return False
        if not (yield from self.write(axis, 32, ENABLE)) or not (yield from self.write(axis, 32, START)):
            return False
        yield

        def arrived():
            return axis.status & 0x400 and not axis.moving and abs(axis.position - target) <= axis.window
        good = yield from self.wait(axis, arrived, STEP_LIMIT_S)
        if not good and axis.moving:
            yield from self.write(axis, 32, HALT)
        yield from self.write(axis, 32, ENABLE)
        return good

    def move_and_stay(self, axis, target):
        """It must be there, with power, half a second later, too."""
        if not (yield from self.move(axis, target)):
            return False
        yield from self.pause(0.5)
        return axis.state == OPERATION_ENABLED and abs(axis.position - target) <= axis.window

    def disable(self, axis):
        yield from self.write(axis, 32, DISABLE_VOLTAGE)
        return (yield from self.wait_state(axis, lambda: axis.state in (DISABLED, READY, NOT_READY) and not axis.moving))

    def attempt(self, axis, step, work):
        """Does a step until it succeeds; a drive that has tripped or was switched off is enabled again before."""
        for axis.tries in range(1, ATTEMPTS + 1):
            axis.step = f"{step}, attempt {axis.tries}"
            axis.refused = ""
            if (yield from self.enable(axis)) and (yield from work()):
                return
            yield from self.pause(0.5 * axis.tries)
        shown = f"status word {axis.status:04X}h, position {axis.position}, flags {axis.flags:03X}h"
        raise GivenUp(f"not reached in {ATTEMPTS} attempts: {shown}{'; ' if axis.refused else ''}{axis.refused}")

    def run_axis(self, axis):
        yield from self.attempt(axis, "enable", lambda: self.nothing())
        yield from self.attempt(axis, "home", lambda: self.home(axis))
        for target in axis.positions:
            yield from self.attempt(axis, f"move to {target}", lambda: self.move_and_stay(axis, target))
        # Without power an axis may give way, so its place is not checked any more.
        for axis.tries in range(1, ATTEMPTS + 1):
            axis.step = f"disable, attempt {axis.tries}"
            if (yield from self.disable(axis)):
                return
            yield from self.pause(0.5)
        raise GivenUp(f"it cannot be switched off: status word {axis.status:04X}h")

    @staticmethod
    def nothing():
        yield
        return True


class GivenUp(Exception):
    """The axis does not reach its step."""


def axes():
    return [Axis("feeder", 1, (35,), (6400, 16000, 3200, 0), 32000, 160000, 160),
            Axis("spindle", 2, (35, 37), (2000, 5000, 1000, 0), 10000, 50000, 50),
            Axis("lift", 3, (33, 35), (10240, 25600, 5120, 0), 51200, 256000, 256)]


def main():
    scale = float(os.environ.get("AXISGATE_TIME_SCALE", "1"))
    modbus = Modbus(os.environ.get("AXISGATE_MODBUS", "127.0.0.1:1502"), scale)
    known = {axis.name: axis for axis in axes()}
    wanted = sys.argv[1:] or list(known)
    if unknown := [name for name in wanted if name not in known]:
        print(f"there is no axis {unknown[0]}; there are {', '.join(known)}")
        return 2
    chosen = [known[name] for name in wanted]
    program = Program(modbus, scale, chosen)
    failed = program.run()
    if failed:
        print("step: " + "; ".join(f"{axis.name}: {axis.step}" for axis in failed))
        print("; ".join(f"{axis.name}: {axis.failure}" for axis in failed))
        return 1
    print(f"{len(chosen)} axes have stood at all their positions after {program.now():.1f} s and are switched off")
    return 0


if __name__ == "__main__":
    sys.exit(main())
