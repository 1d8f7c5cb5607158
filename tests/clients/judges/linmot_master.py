"""A LinRS master written from the maker's user manual and from public pages of the LinRS manual alone; it shares no code with the gateway or its twins.

    linmot_master.py PLACE ID      PLACE: the path of a terminal, or HOST:PORT

Leaves the locked state, switches on, homes, moves absolutely and by an increment, stops in flight, is ignored with an old count, and switches off. It
waits for each state as long as a patient master does. One line for each check.
"""
import struct
import sys

from line import Checks, HostLine

check = Checks("a LinRS master")
line, ident = HostLine(sys.argv[1]), int(sys.argv[2])


def whole(got):
    """Length of the first telegram by its length byte alone: 04h may stand inside the data."""
    return got[2] + 4 if len(got) >= 3 and len(got) >= got[2] + 4 else 0


def ask(sub, main, data=b""):
    """(sub ID of the answer, data); a request without an answer is sent again, as it may be on a line with losses."""
    for left in (3, 2, 1, 0):
        line.send(bytes([1, ident, len(data) + 3, 2, sub, main]) + data + b"\x04")
        try:
            t = line.until(whole, 1.0)
        except TimeoutError:
            line.forget()
            if left == 0:
                raise
            continue
        if t[0] != 1 or t[1] != ident or t[3] != 2 or t[-1] != 4 or t[5] != 0:
            raise ValueError("no telegram of this drive: " + t.hex(" "))
        return t[4], t[6:-1]
    return None


class Seen:
    """A default response."""

    def __init__(self, data):
        self.comm, self.status, var, self.position = struct.unpack_from("<BHHi", data)
        self.state, self.sub = var >> 8, var & 0xFF
        self.count, self.moving, self.there = var & 15, bool(var & 0x20), bool(var & 0x40)


def look():
    return Seen(ask(1, 0)[1])


def control(word):
    return Seen(ask(0, 1, struct.pack("<H", word))[1])


def command(code, form="", *values, count=None):
    """The next motion command; the count follows the one that the drive shows."""
    count = (look().count + 1) & 15 if count is None else count
    seen = Seen(ask(0, 2, struct.pack("<H" + form, code << 4 | count, *values))[1])
    return count, seen


def state(number):
    return lambda: look().state == number


def answers():
    try:
        return look()
    except TimeoutError:
        return None


def judge():
    check.until("it answers, when it has booted", answers, 30)
    control(0x0000)
    check.until("it leaves the locked state", lambda: look().state in (1, 2))
    control(0x003E)
    check.until("ready to switch on", state(2))
    control(0x003F)
    check.until("operation enabled after its tests", state(8))
    begin = look()
    check("status word and StateVar say the same", begin.status & 0x37 == 0x37 and not begin.moving, hex(begin.status))
    control(0x083F)
    check.until("homing ends with 090Fh", lambda: (s := look()).state == 9 and s.sub == 0x0F)
    control(0x003F)
    check.until("and bit 11 taken back leads to state 8, homed", lambda: (s := look()).state == 8 and s.status & 0x800)

    count, seen = command(0x010, "iIII", 250000, 200000, 500000, 500000)
    check("the count of a command comes back", seen.count == count or look().count == count, f"{seen.count} for {count}")
    check.until("it moves to 25 mm", lambda: (s := look()).there and not s.moving and abs(s.position - 250000) <= 50)
    place = look().position
    command(0x010, "iIII", 0, 200000, 500000, 500000, count=look().count)
    check("a command with the old count is not executed", not any(abs(look().position - place) > 50 for _ in range(5)), look().position)
    command(0x011, "iIII", -50000, 200000, 500000, 500000)
    check.until("by an increment of -5 mm", lambda: (s := look()).there and not s.moving and abs(s.position - 200000) <= 50)

    command(0x010, "iIII", 1000000, 10000, 500000, 500000)
    check.until("a long move begins", lambda: look().position > 205000)
    command(0x017, "I", 2000000)
    check.until("VAI Stop ends it", lambda: not look().moving)
    check("in flight", 200000 < look().position < 900000, look().position)
    check("the axis is still controlled", look().state == 8)

    place = look().position
    command(0x010, "iIII", 0, 10000, 500000, 500000)
    check.until("another move begins", lambda: look().position < place - 2000)
    control(0x002F)
    check.until("/Abort leads to state 12", state(12))
    check.until("where it stands", lambda: look().status & 0x2000 == 0)
    control(0x003F)
    check.until("and back to 8, at rest", lambda: (s := look()).state == 8 and not s.moving)

    command(0x002, "Hi", 0x14BE, 123456)
    sub, data = ask(0, 3, struct.pack("<H", 0x14BE))
    check("a RAM value is written and read", len(data) == 13 and struct.unpack("<i", data[9:])[0] == 123456, data.hex(" "))
    control(0x003E)
    check.until("switched off: ready to switch on", state(2))


try:
    judge()
except (TimeoutError, ValueError) as fault:
    check("it came to its end", False, fault)
sys.exit(check.code)
