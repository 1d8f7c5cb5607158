"""A LinMot drive on LinRS, written from the maker's user manual of the motion control software and from public pages of the LinRS manual alone.

    linmot_drive.py [--id N] [the switches of line.py] [--boot-ms N] [--test-ms N] [--count N] [--old-state-ms N] [--homing-ms N] [--drop N]
                    [--others N] [--locked] [--forced] [--no-ram]

It shares no code with the gateway or its twins. The switches are the choices that the documents leave to a drive. It moves by the interpolator's
commands 010xh, 011xh, 012xh, 017xh and 020xh, homes by bit 11 or by 009xh, and prints one line for each change of its state.
"""
import struct
import time

from line import DriveLine, arguments
from shaft import Shaft

parser = arguments(__doc__)
parser.add_argument("--id", type=int, default=0x11)
parser.add_argument("--boot-ms", type=int, default=0, help="silent for so long after the start")
parser.add_argument("--test-ms", type=int, default=300, help="how long the hardware tests of state 5 take")
parser.add_argument("--count", type=int, default=0, help="the count of motion commands after the start")
parser.add_argument("--old-state-ms", type=float, default=0, help="answers show status word and StateVar of so long ago")
parser.add_argument("--homing-ms", type=int, default=0, help="state 9 shows its end so much later than the slider stands")
parser.add_argument("--drop", type=int, default=0, help="every Nth request is not answered")
parser.add_argument("--others", type=int, default=0, help="every Nth answer is preceded by a telegram of another drive")
parser.add_argument("--forced", action="store_true", help="a parameter forces bits 1 to 3 of the control word")
parser.add_argument("--no-ram", action="store_true", help="message 03h is not answered")
args = parser.parse_args()

# RAM values by their UPID; velocities in 1e-6 m/s, accelerations in 1e-5 m/s2, positions in 0.1 um.
RAM = {0x14BE: 100000, 0x14BF: 100000, 0x14C0: 100000, 0x146E: -2000000, 0x146F: 4000000, 0x13C7: 0, 0x13CA: 0}
HOME_FROM = 34567  # where the slider stands when the drive starts, from its mechanical zero
QUICK = 5e7        # 0.1 um/s2


class Drive:
    def __init__(self, line):
        self.line, self.shaft, self.buffer = line, Shaft(HOME_FROM), b""
        self.state, self.sub, self.since = 0, 0, time.monotonic()
        self.word, self.interface, self.count, self.homed = 0, 0, args.count & 15, False
        self.deaf_until, self.history, self.requests, self.answers = time.monotonic() + args.boot_ms / 1000, [], 0, 0
        self.last_target, self.stopped, self.shown_pos, self.last_header = float(HOME_FROM), False, 0.0, 0
        self.origin_done, self.stood_since = False, None

    # --- the state machine

    def enter(self, state, sub=0):
        if state != self.state:
            print("state", state, flush=True)
            self.state, self.since = state, time.monotonic()
        self.sub = sub

    def bit(self, n):
        return self.word >> n & 1

    def step(self, now):
        self.shaft.step(now)
        before, self.word = self.word, self.interface | (0x0E if args.forced else 0)
        rising = self.word & ~before
        if self.stopped:
            self.state = self.sub = 0
        elif self.state >= 8 and not self.bit(0):
            self.shaft.hold()
            self.enter(2)
        elif self.state >= 2 and self.state != 4 and not self.bit(1):
            self.shaft.hold()
            self.enter(1)
        else:
            self.follow(now, rising)
        self.history.append((now, self.status_word(), self.state_var()))
        while len(self.history) > 1 and self.history[1][0] <= now - args.old_state_ms / 1000:
            self.history.pop(0)

    def follow(self, now, rising):
        s = self.state
        if s == 0 and not self.bit(0):
            self.enter(1)
        elif s == 1 and self.bit(1) and self.bit(2):
            self.enter(2)
        elif s == 2 and self.bit(0):
            self.enter(5)
        elif s == 4 and rising & 0x80:
            self.enter(0)
        elif s == 5 and now - self.since >= args.test_ms / 1000:
            self.enter(6)
        elif s == 6 and not self.bit(0):
            self.enter(2)
        elif s == 6 and self.bit(3):
            self.enter(8)
        elif s >= 8 and not self.bit(3):
            self.shaft.hold()
            self.enter(6)
        elif s >= 8 and s != 14 and not self.bit(2):
            self.shaft.brake(QUICK)
            self.enter(14)
        elif s == 14 and self.shaft.rests:
            self.enter(1)
        elif s == 8:
            self.operate()
        elif s == 9:
            self.home(now)
        elif s == 12 and self.bit(4) or s == 13 and self.bit(5):
            self.enter(8)

    def operate(self):
        if not self.bit(4):
            self.shaft.brake(QUICK)
            self.enter(12)
        elif not self.bit(5):
            self.shaft.brake(QUICK)
            self.enter(13)
        elif self.bit(11):
            self.homed, self.origin_done, self.stood_since = False, False, None
            self.shaft.move(0, 500000, 1e7, 1e7)
            self.enter(9)

    def home(self, now):
        if not self.bit(11):
            self.shaft.brake(QUICK)
            self.enter(8)
        elif self.shaft.rests:
            self.stood_since = self.stood_since or now
            if now - self.stood_since >= args.homing_ms / 1000:
                self.homed = True
                self.enter(9, 0x0F)

    # --- the words

    def moving(self):
        return self.state in (8, 9, 12, 13, 14) and not self.shaft.rests

    def status_word(self):
        if self.stopped:
            return 0
        w = (self.state >= 8) | self.bit(0) << 1 | self.bit(3) << 2 | (self.state in (3, 4)) << 3 | self.bit(1) << 4 | self.bit(2) << 5
        w |= (self.state == 0) << 6 | (not self.homed) << 7 | (self.state == 9) << 9 | self.homed << 11
        return w | (self.state >= 8 and not self.moving()) << 10 | self.moving() << 13

    def state_var(self):
        if self.state != 8:
            return self.state << 8 | self.sub
        return 8 << 8 | self.count | self.moving() << 5 | (not self.moving()) << 6 | self.homed << 7

    # --- motion commands

    def command(self, data, now):
        header = struct.unpack_from("<H", data)[0]
        code, count = header >> 4, header & 15
        if count == self.count and header != 0:
            return
        self.count, self.last_header = count, header
        if code == 0x001 and len(data) >= 4:
            self.interface = struct.unpack_from("<H", data, 2)[0]
        elif code == 0x002 and len(data) >= 8:
            upid, value = struct.unpack_from("<Hi", data, 2)
            RAM[upid] = value
        elif code == 0x009 and len(data) >= 6:
            self.shaft.set(struct.unpack_from("<i", data, 2)[0])
            self.homed = True
        elif code != 0 and self.state == 6:
            self.enter(4, 0x86)
        elif code in (0x010, 0x011, 0x012, 0x013) and self.state == 8 and len(data) >= 18:
            place, speed, up, down = struct.unpack_from("<iIII", data, 2)
            self.go(code & 15, place, speed, up, down)
        elif code in (0x020, 0x021, 0x022) and self.state == 8 and len(data) >= 6:
            self.go(code & 15, struct.unpack_from("<i", data, 2)[0], RAM[0x14BE], RAM[0x14BF], RAM[0x14C0])
        elif code == 0x017 and self.state == 8 and len(data) >= 6:
            self.shaft.brake(max(1, struct.unpack_from("<I", data, 2)[0]) * 100.0)

    def go(self, kind, place, speed, up, down):
        if kind == 1:
            place += self.shaft.position
        elif kind == 2:
            place += self.last_target
        place = max(RAM[0x146E], min(RAM[0x146F], place))
        self.last_target = place
        # 1e-6 m/s are 10 increments of 0.1 um a second; 1e-5 m/s2 are 100.
        self.shaft.move(place, speed * 10.0, max(1, up) * 100.0, max(1, down) * 100.0)

    # --- telegrams

    def heard(self, data, now):
        self.buffer += data
        while True:
            at = self.buffer.find(1)
            if at < 0:
                self.buffer = b""
                return
            self.buffer = self.buffer[at:]
            if len(self.buffer) < 4:
                return
            size = self.buffer[2]
            if not 2 <= size <= 63 or self.buffer[3] != 2:
                self.buffer = self.buffer[1:]
                continue
            if len(self.buffer) < size + 4:
                return
            telegram, rest = self.buffer[:size + 4], self.buffer[size + 4:]
            if telegram[-1] != 4:
                self.buffer = self.buffer[1:]
                continue
            self.buffer = rest
            if telegram[1] == args.id and now >= self.deaf_until:
                self.request(telegram[4], telegram[5], telegram[6:-1], now)

    def say(self, sub, body):
        self.answers += 1
        frame = bytes([1, args.id, len(body) + 3, 2, sub, 0]) + body + b"\x04"
        if args.others and self.answers % args.others == 0:
            other = bytes([1, args.id ^ 0x40, 12, 2, 0, 0, 0]) + struct.pack("<HHi", 0x40B4, 0x0200, 4711) + b"\x04"
            frame = other + frame
        self.line.say(frame)

    def words(self):
        status, var = self.history[0][1:] if self.history else (self.status_word(), self.state_var())
        return struct.pack("<HHi", status, var, round(self.shaft.position))

    def request(self, sub, main, data, now):
        self.requests += 1
        if args.drop and self.requests % args.drop == 0:
            return
        if main == 0 and sub == 1:
            self.say(0, b"\0" + self.words())
        elif main == 1 and len(data) >= 2:
            self.interface = struct.unpack_from("<H", data)[0]
            self.step(now)
            self.say(0, b"\0" + self.words())
        elif main == 2 and len(data) >= 2:
            self.command(data, now)
            self.step(now)
            self.say(0, b"\0" + self.words())
        elif main == 3 and sub == 0 and len(data) >= 2 and not args.no_ram:
            upid = struct.unpack_from("<H", data)[0]
            known = {0x1B8D: round(self.shaft.position), 0x1B93: 120, 0x1DB0: self.last_header, **RAM}
            self.say(0, bytes([0 if upid in known else 0xC0]) + self.words() + struct.pack("<i", known.get(upid, 0)))
        elif main == 5 and len(data) >= 2:
            self.parameter(sub, data)
        elif main == 6:
            self.software(sub)
        elif main == 7 and sub == 2:
            self.say(0x72, struct.pack("<BHH", 0, 0, 0))

    def parameter(self, sub, data):
        upid = struct.unpack_from("<H", data)[0]
        if upid not in RAM:
            self.say(0x50 + sub, struct.pack("<BHi", 0xC0, upid, 0))
        elif sub == 0:
            self.say(0x50, struct.pack("<BHi", 0, upid, RAM[upid]))
        elif sub == 3:
            self.say(0x53, struct.pack("<BHi", 0, upid, 0x010F))
        elif sub == 4:
            self.say(0x54, struct.pack("<BHi", 0, upid, 6))
        else:
            self.say(0x50 + sub, struct.pack("<BHi", 0xC3, upid, 0))

    def software(self, sub):
        if sub == 3:
            self.stopped = True
            self.shaft.hold()
            self.step(time.monotonic())
            self.say(0, b"\0" + self.words())
        elif sub == 4:
            self.stopped, self.state = False, 0
            self.say(0x60, b"\0")
        elif sub in (1, 2):
            self.say(0, b"\0" + self.words())
            self.state = self.sub = self.interface = 0
            self.homed, self.count = False, args.count & 15


line = DriveLine(args)
drive = Drive(line)
line.serve(drive.heard, drive.step)
