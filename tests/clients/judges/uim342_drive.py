"""UIM342 drives behind the maker's converter of serial or Ethernet to CAN, written from the UIM342 manual and public programs for the converter alone.

    uim342_drive.py [--nodes 5,6] [the switches of line.py] [--crc 12|13|none] [--drop N] [--flags-late-ms N] [--chatter-ms N] [--rt-first]
                    [--microsteps N] [--reserved N]

It shares no code with the gateway or its twins. Messages of 16 bytes as chapter 2.6 has them; the switches are the choices that the manual leaves to
a drive or a converter. Jog and point to point, ST, OG, errors and their history, notifications. Prints one line for each start and each MO.
"""
import struct
import time

from line import arguments, crc16, DriveLine
from shaft import Shaft

parser = arguments(__doc__)
parser.add_argument("--nodes", default="5")
parser.add_argument("--crc", choices=("12", "13", "none"), default="12", help="bytes under the check: public programs say 12, the manual 13")
parser.add_argument("--drop", type=int, default=0, help="every Nth reading is not answered")
parser.add_argument("--flags-late-ms", type=float, default=0, help="MS[0] shows STOP and PAIF as they were so long ago")
parser.add_argument("--chatter-ms", type=float, default=0, help="an input edge is notified so often, as IE[0] = 1 has it")
parser.add_argument("--rt-first", action="store_true", help="the end of a motion is notified though nobody has asked for it in this session")
parser.add_argument("--microsteps", type=int, default=16)
parser.add_argument("--reserved", type=int, default=0, help="value of the bytes behind the data, which nobody describes")
args = parser.parse_args()


def message(node, word, data):
    body = bytes([node, word, len(data)]) + data + bytes([args.reserved]) * (9 - len(data))
    if args.crc == "none":
        return b"\xAD" + body + b"\0\0\xCC"
    return b"\xAA" + body + struct.pack("<H", crc16(body if args.crc == "12" else b"\xAA" + body)) + b"\xCC"


class Error(Exception):
    pass


class Drive:
    """One node. `answer(word, data)` is what goes back, `tell` a notification."""

    def __init__(self, node, tell):
        self.node, self.tell, self.shaft = node, tell, Shaft(0)
        self.values = {0x19: 100000, 0x1A: 100000, 0x1B: 0, 0x1C: 800000, 0x2D: 0}  # AC DC SS SD BL
        self.pp, self.ic, self.ie = {5: 0, 7: node, 8: 10}, {i: 0 for i in range(8)}, {0: int(args.chatter_ms > 0), 1: 0, 2: 0, 8: int(args.rt_first)}
        self.mt, self.qe = {0: args.microsteps, 1: 20, 2: 50, 3: 0}, {0: 1000, 1: 1000, 2: 17, 3: 1, 4: args.microsteps * 200}
        self.il, self.tg = {i: 0 for i in range(4)}, {i: 0 for i in range(3)}
        self.on, self.mode, self.jog, self.pulses_s, self.relative, self.absolute = 0, 0, 0, 10000, 0, 0
        self.by_relative, self.stopping, self.begin, self.arrived, self.trouble, self.history = False, False, 0.0, False, False, []
        self.group, self.past, self.running, self.chattered = 0, [], False, time.monotonic()
        self.ended = False

    def step(self, now):
        self.shaft.step(now)
        rests = self.shaft.rests
        if self.running and rests:
            self.running = self.stopping = False
            if self.mode == 1 and self.shaft.target is not None:
                self.arrived = True
                if self.ie[8]:
                    self.tell(self.node, 0x5A, b"\x29\0\0\0" + struct.pack("<i", round(self.shaft.position)))
        self.past.append((now, rests, self.arrived))
        while len(self.past) > 1 and self.past[1][0] <= now - args.flags_late_ms / 1000:
            self.past.pop(0)
        if args.chatter_ms and self.ie[0] and now - self.chattered >= args.chatter_ms / 1000:
            self.chattered = now
            self.tell(self.node, 0x5A, bytes([1 + len(self.past) % 2]))

    def fail(self, code, word, sub):
        self.trouble = True
        self.history.insert(0, bytes([code, word, sub]))
        return 0x0F, bytes([0, code, word, sub, 0, 0])

    def instruction(self, word, data):
        """(control word, data) of the acknowledgement, or nothing."""
        code, sub = word & 0x7F, data[0] if data else 0
        try:
            answer = self.carry_out(code, data)
        except Error as error:
            return self.fail(error.args[0], word, sub if code in self.indexed() else 0)
        return answer if word & 0x80 and code != 0x7E else None

    def indexed(self):
        return {0x01: self.pp, 0x06: self.ic, 0x07: self.ie, 0x10: self.mt, 0x3D: self.qe, 0x34: self.il, 0x35: self.tg}

    def carry_out(self, code, data):
        if code in self.indexed():
            return self.table(code, data)
        if code in self.values:
            return self.value(code, data)
        if code in (0x1D, 0x1E, 0x1F, 0x20):
            return self.motion_value(code, data)
        name = {0x0B: "model", 0x0C: "serial", 0x0F: "errors", 0x11: "status", 0x15: "motor", 0x16: "start", 0x17: "stop", 0x18: "select",
                0x21: "origin", 0x2E: "desired", 0x37: "inputs", 0x7E: "system"}.get(code)
        if name is None:
            raise Error(0x32)
        return getattr(self, name)(code, data)

    def table(self, code, data):
        store, wide = self.indexed()[code], code != 0x01
        if len(data) not in (1, 3 if wide else 2):
            raise Error(0x32)
        if data[0] not in store:
            raise Error(0x34)
        if len(data) > 1:
            store[data[0]] = int.from_bytes(data[1:], "little")
        return code, bytes([data[0]]) + store[data[0]].to_bytes(2 if wide else 1, "little")

    def value(self, code, data):
        if len(data) not in (0, 4):
            raise Error(0x32)
        if data:
            number = struct.unpack("<I", data)[0]
            if code == 0x1C and number < self.values[0x1A] or code == 0x1A and number > self.values[0x1C]:
                raise Error(0x3C)
            if code in (0x19, 0x1A) and not 1 <= number <= 65000000:
                raise Error(0x33)
            if not self.group:
                self.values[code] = number
            self.group = 0
        return code, struct.pack("<I", self.values[code])

    def motion_value(self, code, data):
        if len(data) not in (0, 2, 4):
            raise Error(0x32)
        if not data:
            now = {0x1D: self.shaft.velocity, 0x1E: self.shaft.velocity, 0x1F: self.shaft.position - self.begin, 0x20: self.shaft.position}
            return code, struct.pack("<i", round(now[code]))
        number, group, self.group = int.from_bytes(data, "little", signed=True), self.group, 0
        if not group:
            if code == 0x1D:
                self.jog, self.mode = number, 0
            elif code == 0x1E:
                self.pulses_s = abs(number)
            elif code == 0x1F:
                self.relative, self.mode, self.by_relative = number, 1, True
            else:
                self.absolute, self.mode, self.by_relative = number, 1, False
        which = {0x1D: 2, 0x1E: 2, 0x1F: 3, 0x20: 4}[code]
        return 0x2E, bytes([which]) + struct.pack("<i", number)

    def model(self, code, _):
        return code, bytes([0x22, 0x14, 0x13, 0, 0x05, 0x01, 0, 0])

    def serial(self, code, _):
        return code, struct.pack("<IHH", 4711, 1541, 2055)

    def errors(self, code, data):
        if len(data) not in (1, 2):
            raise Error(0x32)
        if data[0] not in (0, 6, 10, *range(11, 19)):
            raise Error(0x34)
        if len(data) == 2:
            self.history = []
        at = {0: 0, 6: 99, 10: 0}.get(data[0], data[0] - 10)
        return code, data[:1] + (self.history[at] if at < len(self.history) else bytes(3)) + bytes(2)

    def status(self, code, data):
        if len(data) not in (1, 2):
            raise Error(0x32)
        if data[0] > 1:
            raise Error(0x34)
        if data[0] == 1:
            return code, b"\x01" + round(self.shaft.velocity).to_bytes(3, "little", signed=True) + struct.pack("<i", round(self.shaft.position))
        if len(data) == 2:
            self.arrived = self.trouble = False
            self.past = [(0.0, self.shaft.rests, False)]
        _, rests, arrived = self.past[0] if self.past else (0, True, False)
        first = self.mode | self.on << 2 | 7 << 3
        return code, bytes([0, first, rests | arrived << 1 | self.trouble << 7, 0]) + struct.pack("<i", round(self.shaft.position - self.begin))

    def motor(self, code, data):
        if len(data) not in (0, 1):
            raise Error(0x32)
        if data:
            if data[0] > 1:
                raise Error(0x33)
            if data[0] != self.on:
                print(self.node, "MO", data[0], flush=True)
            self.on = data[0]
            if not self.on:
                self.shaft.hold()
                self.running = self.stopping = False
        return code, bytes([self.on])

    def start(self, code, data):
        if not self.on:
            raise Error(0x3E)
        if self.stopping and not self.shaft.rests:
            raise Error(0x3F)
        self.begin, self.arrived, self.running, self.stopping = self.shaft.position, False, True, False
        up, down = self.values[0x19], self.values[0x1A]
        if self.mode == 0:
            self.shaft.turn(self.jog, up, down)
        else:
            target = round(self.shaft.position) + self.relative if self.by_relative else self.absolute
            self.shaft.move(target, self.pulses_s, up, down)
        print(self.node, "BG", self.jog if self.mode == 0 else self.shaft.target, flush=True)
        return code, bytes(4)

    def stop(self, code, _):
        self.stopping = not self.shaft.rests
        self.shaft.brake(self.values[0x1C])
        return code, b""

    def select(self, code, data):
        if len(data) == 1 and (data[0] == 1 or data[0] > 7):
            raise Error(0x33)
        self.group = data[0] if data else 0
        return code, bytes([self.group])

    def origin(self, code, _):
        if not self.shaft.rests:
            raise Error(0x41)
        self.shaft.set(0.0)
        self.begin = 0.0
        return code, b""

    def desired(self, code, data):
        if len(data) != 1:
            raise Error(0x32)
        if data[0] > 4:
            raise Error(0x34)
        numbers = [self.mode, self.mt[1], self.jog if self.mode == 0 else self.pulses_s, self.relative, self.absolute]
        return code, data[:1] + struct.pack("<i", numbers[data[0]])

    def inputs(self, code, _):
        return code, bytes([7, 0, 0, 0])

    def system(self, _, data):
        if data[:1] == b"\x01":
            self.__init__(self.node, self.tell)


class Converter:
    """The bytes of the host as messages, by the place of their bytes: no start byte is proof, since each may stand in the data."""

    def __init__(self, line):
        self.line, self.buffer, self.readings = line, b"", 0
        self.drives = [Drive(int(n), self.tell) for n in args.nodes.split(",")]

    def tell(self, node, word, data):
        self.line.say(message(node, word, data))

    def step(self, now):
        for drive in self.drives:
            drive.step(now)

    def heard(self, data, now):
        self.buffer += data
        while len(self.buffer) >= 16:
            m = self.buffer[:16]
            under = m[1:13] if args.crc == "12" else m[:13]
            good = m[0] == 0xAD or m[0] == 0xAA and struct.unpack("<H", m[13:15])[0] == crc16(under)
            if m[15] != 0xCC or not good or m[3] > 8:
                self.buffer = self.buffer[1:]
                continue
            self.buffer = self.buffer[16:]
            self.message(m[1], m[2], m[4:4 + m[3]])

    def message(self, to, word, data):
        for drive in self.drives:
            if to not in (drive.node, 0, drive.pp[8]):
                continue
            answer = drive.instruction(word, data)
            if word & 0x7F in (0x11, 0x2E, 0x0F, 0x19) and len(data) < 2:
                self.readings += 1
                if args.drop and self.readings % args.drop == 0:
                    continue
            if answer is not None:
                self.line.say(message(drive.node, *answer))


line = DriveLine(args)
converter = Converter(line)
line.serve(converter.heard, converter.step)
