"""A Lexium MDrive that speaks MCode, written from the maker's programming and software reference alone, on a pseudo-terminal or TCP.

    mcode_drive.py [--names ab] [the switches of line.py] [--execute-ms N] [--deaf-ms N] [--em N] [--ck N] [--loud-global]
                   [--old-firmware] [--settle-ms N] [--data-first]

It shares no code with the gateway or its twins. Without --names it is one drive in single mode; with them each letter is a drive in party mode on
the same line. The switches are the choices that the reference leaves to a drive. It knows the immediate language: PR, assignments, MA, MR, SL, HM,
E, S, IP, FD, ESC and the checksum. Prints one line for each change of DE and for each motion.
"""
import time

from line import DriveLine, arguments
from shaft import Shaft

parser = arguments(__doc__)
parser.add_argument("--names", default="", help="a letter for each drive of a party line; none: one drive in single mode")
parser.add_argument("--execute-ms", type=float, default=2, help="command execution time")
parser.add_argument("--deaf-ms", type=float, default=0, help="a drive hears nothing from its terminator until so long behind its answer")
parser.add_argument("--em", type=int, default=0)
parser.add_argument("--ck", type=int, default=0)
parser.add_argument("--loud-global", action="store_true", help="DG=0: global commands are answered, too")
parser.add_argument("--old-firmware", action="store_true", help="before 6.0.01: no AJ, AT, AV, BE, BL, BM, DJ, DT, LS")
parser.add_argument("--settle-ms", type=int, default=1000, help="MT and HT together: MV and MP stay 1 for so long behind the last step")
parser.add_argument("--data-first", action="store_true", help="the data of PR come before the CR LF that ends a command, not behind it")
args = parser.parse_args()

ACK, NAK = b"\x06", b"\x15"
# Name: value, least, most. What has no range is read only.
RANGES = {"A": (1000000, 66, 1100000000), "D": (1000000, 66, 1100000000), "VI": (1000, 1, 5000000), "VM": (768000, 1, 2560000), "DE": (1, 0, 1),
          "P": (0, -2147483647, 2147483647), "C1": (0, -2147483647, 2147483647), "C2": (0, -2147483647, 2147483647), "EM": (args.em, 0, 3),
          "CK": (args.ck, 0, 2), "PY": (1 if args.names else 0, 0, 1), "DG": (0 if args.loud_global else 1, 0, 1), "QD": (0, 0, 1),
          "ES": (1, 0, 3), "CE": (1, 0, 2), "BD": (96, 11, 96), "MS": (256, 1, 256), "RC": (25, 1, 100), "HC": (5, 0, 100), "HT": (500, 0, 65535),
          "MT": (500, 0, 65535), "EE": (0, 0, 1), "AS": (0, 0, 3), "LM": (1, 1, 6), "RD": (0, 0, 1), "JE": (0, 0, 1), "PM": (0, 0, 1),
          "SM": (0, 0, 1), "SF": (15, 0, 65000), "DB": (1, 0, 65000), "WT": (80, 0, 84), "R1": (0, -2147483647, 2147483647),
          "R2": (0, -2147483647, 2147483647), "R3": (0, -2147483647, 2147483647), "R4": (0, -2147483647, 2147483647), "NE": (0, 0, 1),
          "ST": (0, 0, 0), "LK": (0, 0, 1), "RA": (0, 0, 1), "O1": (0, 0, 1), "O2": (0, 0, 1), "O3": (0, 0, 1)}
NEWER = {"AJ": (0, 0, 127), "DJ": (0, 0, 127), "AT": (1, 1, 3), "DT": (1, 1, 3), "BE": (0, 0, 1), "BL": (0, -2147483647, 2147483647), "BM": (0, 0, 1)}
if not args.old_firmware:
    RANGES.update(NEWER)


def checksum(data):
    return ((-sum(data)) & 0x7F) | 0x80


def split(text, separator=","):
    """The fields of a list, quotes respected."""
    fields, quoted = [""], False
    for c in text:
        quoted ^= c == '"'
        if c == separator and not quoted:
            fields.append("")
        else:
            fields[-1] += c
    return [f.strip() for f in fields]


class Fault(Exception):
    pass


class Unit:
    """One drive: its variables, its shaft, its error."""

    def __init__(self, name):
        self.values = {k: v[0] for k, v in RANGES.items()}
        self.name, self.shaft, self.error, self.moved_at, self.kind, self.homing = name, Shaft(), 0, -1e9, "MR", False
        self.moving = False

    def step(self, now):
        self.shaft.step(now)
        if not self.shaft.rests:
            self.moved_at = now
        moving = now - self.moved_at < (args.settle_ms / 1000 if self.kind != "SL" else 0.02)
        if moving != self.moving:
            print(self.name, "moves" if moving else "rests", round(self.shaft.position), flush=True)
        self.moving = moving

    # --- reading

    def read(self, name, now):
        shown = {"P": round(self.shaft.position), "C1": round(self.shaft.position), "V": round(self.shaft.velocity), "MV": int(self.moving),
                 "MP": int(self.moving and self.kind != "SL"), "EF": int(self.error != 0), "BY": 0, "LR": 0, "AF": 0, "LL": 0, "IN": 0,
                 "VC": int(not self.shaft.rests and abs(abs(self.shaft.velocity) - abs(self.shaft.speed)) > 100), "MD": self.kind, "IF": 0,
                 "DN": f'"{self.name}"', "PN": "LMDOM572", "SN": "123456789",
                 "VR": "LMDOM 5.009, Hw: 3.2" if args.old_firmware else "LMDOM 6.002, Hw: 3.2", "I1": 0, "I2": 0, "I3": 0, "I4": 0, "I5": 0,
                 "IT": "35,38", "VT": "0,0,24", "OF": 0, "OT": 0, "PC": 0, "UV": "", "IS": "\r\n".join(f"IS = {n}, 0, 0" for n in (1, 2, 3, 4)),
                 "OS": "OS = 1, 16, 1\r\nOS = 2, 16, 1\r\nOS = 3, 16, 1", "TE": 0, "AV": round(self.shaft.velocity)}
        if name == "ER":
            code, self.error = self.error, 0
            return str(code)
        if name in shown and not (args.old_firmware and name == "AV"):
            return str(shown[name])
        if name in self.values:
            return str(self.values[name])
        raise Fault(37 if name in ("LT", "LD", "LG", "CB", "MF", "MU", "TQ", "TS") else 35)

    def print_(self, text, now):
        end = "\r\n"
        if text.endswith(";"):
            text, end = text[:-1], ""
        out = ""
        for item in split(text):
            if item.startswith('"'):
                out += item.strip('"')
            elif item:
                out += self.read(item.upper(), now)
        return out + end

    # --- writing

    def write(self, name, text, now):
        if name == "DN":
            if len(text) != 3 or text[0] != '"' or not text[1].isalnum():
                raise Fault(21)
            self.name = text[1]
            return
        if name == "ER":
            self.error = 0
            return
        if name == "IS":
            return
        if name not in RANGES:
            try:
                self.read(name, now)
            except Fault:
                raise Fault(20) from None
            raise Fault(25)
        try:
            number = int(float(text))
        except ValueError:
            number = self.number(text, now)
        _, least, most = RANGES[name]
        if not least <= number <= most or name == "BD" and number not in (11, 19, 38, 48, 96):
            raise Fault(21)
        if name == "VI" and number >= self.values["VM"]:
            raise Fault(22)
        if name == "VM" and number <= self.values["VI"]:
            raise Fault(23)
        if name in ("P", "C1"):
            self.shaft.set(number)
            return
        if name == "DE" and number != self.values["DE"]:
            print(self.name, "DE", number, flush=True)
            if not number:
                self.shaft.hold()
        self.values[name] = number

    def number(self, text, now):
        sign, name = (-1, text[1:]) if text.startswith("-") else (1, text)
        try:
            return sign * int(self.read(name.strip().upper(), now))
        except ValueError:
            raise Fault(24) from None

    # --- motion

    def move(self, kind, fields, now):
        if not self.values["DE"]:
            raise Fault(94)
        try:
            number = int(fields[0])
        except ValueError:
            number = self.number(fields[0], now)
        if self.homing and not self.shaft.rests:
            raise Fault(85)
        self.kind, self.moved_at, self.homing = kind, now, False
        v = self.values
        if kind == "SL":
            if abs(number) > 5000000:
                raise Fault(77)
            if number and abs(number) < v["VI"]:
                raise Fault(97)
            self.shaft.turn(number, v["A"], v["D"])
        else:
            target = number if kind == "MA" else round(self.shaft.position) + number
            self.shaft.move(target, v["VM"], v["A"], v["D"])

    def statement(self, text, now):
        """The output of one command."""
        text = text.split("'")[0].strip()
        if not text:
            return ""
        word = text.split()[0].upper() if "=" not in text.split()[0] else ""
        rest = text[len(word):].strip()
        if word == "PR":
            return self.print_(rest, now)
        if word in ("MA", "MR", "SL"):
            self.move(word, split(rest), now)
        elif word == "HM":
            raise Fault(80)
        elif word == "E":
            self.shaft.brake(self.values["D"])
        elif word == "S":
            if self.moving and self.kind != "SL":
                raise Fault(73)
        elif word == "IP" and self.moving:
            raise Fault(74)
        elif word == "FD":
            self.values = {k: v[0] for k, v in RANGES.items()}
        elif word in ("PS", "RS", "CF", "CP", "L", "IP"):
            pass
        elif "=" in text:
            name, value = text.split("=", 1)
            self.write(name.strip().upper(), value.strip(), now)
        elif word and rest:
            self.write(word, rest, now)
        else:
            raise Fault(30)
        return ""


class Wire:
    """All drives of the line: whose characters they are, the echo and what ends an answer."""

    def __init__(self, line):
        self.line, self.units = line, [Unit(n) for n in args.names or "!"]
        self.text, self.overrun, self.active, self.deaf_until, self.escape = b"", False, False, 0.0, None

    def step(self, now):
        for unit in self.units:
            unit.step(now)

    def heard(self, data, now):
        for byte in data:
            if now >= self.deaf_until:
                self.character(byte, now)

    def character(self, c, now):
        party = any(u.values["PY"] for u in self.units)
        if c in (0x1B, 0x05, 0x03):
            self.control(c, party, now)
        elif c == (0x0A if party else 0x0D):
            text, self.text = self.text, b""
            if party and not self.active:
                self.active = True
                return
            self.line_of(text, party, now)
        elif c not in (0x0A, 0x0D) and (self.active or not party):
            self.text = (self.text + bytes([c]))[-200:]
            for unit in self.units:
                if unit.values["EM"] == 0 and (not party or self.text[:1] == unit.name.encode() and len(self.text) > 1):
                    self.line.say(bytes([c]), at_once=True)

    def control(self, c, party, now):
        named, self.text = self.text[-1:], b""
        for unit in self.units:
            wants = {0: (0x05, False), 1: (0x1B, False), 2: (0x05, True), 3: (0x1B, True)}[unit.values["ES"]]
            if c == wants[0] and (not wants[1] or not party or named == unit.name.encode()):
                unit.shaft.hold()
            if c == 0x03 and (unit.values["CE"] == 1 or unit.values["CE"] == 2 and (not party or named == unit.name.encode())):
                unit.__init__(unit.name)

    def line_of(self, text, party, now):
        if not text:
            return
        for unit in self.units:
            whole, common = text, False
            if party:
                to, common = text[:1], text[:1] in b"*^"
                if to != unit.name.encode() and to != b"*" and not (to == b"^" and unit.values["QD"]):
                    continue
            quiet = common and unit.values["DG"]
            ck, em = unit.values["CK"], unit.values["EM"]
            if ck and (sum(whole) & 0x7F):
                if not quiet and em != 2:
                    self.answer(unit, NAK)
                continue
            command = (whole[1:] if party else whole)[:-1 if ck else None]
            out, good = "", True
            try:
                if len(command) > 64:
                    raise Fault(20)
                out = unit.statement(command.decode("latin-1"), now)
            except Fault as fault:
                unit.error, good = fault.args[0], False
            if not quiet:
                self.respond(unit, command, whole[-1:] if ck else b"", out, good, em, ck)

    def respond(self, unit, command, cs, out, good, em, ck):
        data = out.encode("latin-1")
        if ck and data:
            body = data[:-2] if data.endswith(b"\r\n") else data
            data = body + bytes([checksum(body)]) + data[len(body):]
        # The checksum takes the place of CR LF by ACK; a command that is refused is no transmission error.
        end = ACK if ck else b"\r\n"
        prompt = b">" if not unit.error else b"?"
        if em == 0:
            answer = (data + end if args.data_first and data else end + data) + prompt
        elif em == 1:
            answer = data + end if args.data_first and data and not ck else end + data
        elif em == 3:
            answer = command + cs + end + data
        else:
            answer = data
        self.answer(unit, answer)

    def answer(self, unit, data):
        if data:
            self.line.say(data, args.execute_ms / 1000)
        if args.deaf_ms:
            self.deaf_until = max(time.monotonic(), self.line.free_at) + args.deaf_ms / 1000


line = DriveLine(args, noise=b"")
wire = Wire(line)
line.serve(wire.heard, wire.step)
