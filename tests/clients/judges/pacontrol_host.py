"""A host of a PA-CONTROL, written from the maker's manual of the interfaces alone; it shares no code with the gateway or its twins.

    pacontrol_host.py PLACE      PLACE: the path of a terminal, or HOST:PORT

Elements, the sum of a frame, the mode gate, ONLINE, power, reference, 0A87 with its polls, 0A94 and a stop in flight, 0A86, the way home. One line for
each check.
"""
import sys

from line import Checks, HostLine

check = Checks("a PA-CONTROL host")
line = HostLine(sys.argv[1])


def xor(data):
    value = 0
    for b in data:
        value ^= b
    return value


class Reply:
    def __init__(self, frame):
        if not frame.startswith(b"\x01\x02") or frame.count(b"\x03") != 1:
            raise ValueError(f"no reply: {frame!r}")
        text, total = frame[2:-1].split(b"\x03")
        self.fields = text.decode().split(";")
        self.quit, self.done, self.status, self.error = (int(f) for f in self.fields[:4])
        self.kind, self.data = self.fields[4:6]
        self.summed = int(total) == xor(text + b"\x03")
        if int(total) not in (0, xor(text + b"\x03")):
            raise ValueError(f"wrong sum: {frame!r}")


def whole(got):
    return got.find(b"\x04") + 1


def ask(code, parameter=0, data="0", kind=0, total=None, seconds=5.0):
    text = f"{code};{parameter};{kind};{data}".encode()
    line.send(b"\x01\x02" + text + b"\x03" + str(xor(text) if total is None else total).encode() + b"\x04")
    return Reply(line.until(whole, seconds))


def poll():
    line.send(b"\x04")
    return Reply(line.until(whole))


def read(code, parameter=0):
    r = ask(code, parameter)
    return float(r.data) if r.quit == 0 else None


def repeated(*command):
    """Whether a command is accepted; a control that is busy refuses it for a while."""
    return lambda: ask(*command).quit == 0


def up():
    try:
        return ask("190B", seconds=1.0).quit == 0
    except (TimeoutError, ValueError):
        line.forget()
        return False


def judge():
    check.until("it answers, when it has booted", up, 30)
    check.until("in home position", lambda: ask("190B").status == 1)
    r = ask("0906", 5, "12345")
    check("N5 = 12345 is echoed", (r.quit, r.done, r.kind, r.data) == (0, 1, "0", "12345"), r.fields)
    check("and read", read("1906", 5) == 12345)
    check("R1 as a real number of seven digits", ask("0907", 1, "640.0", 1).data == "640.0000")
    check("without a sum: 0", ask("1906", 5, total=0).quit == 0)
    check("a wrong sum: 10h", ask("1906", 5, total=xor(b"1906;5;0;0") ^ 0x55).quit == 0x10)
    check("an unknown command: 13h", ask("1999").quit == 0x13)
    check("an element that is not there: 26h", ask("1906", 1025).quit == 0x26)
    check("a move outside ONLINE: 14h", ask("0A87", 1, "5.0", 1).quit == 0x14)
    r = ask("1800", 1 << 8 | 6)
    check("an axis parameter in home position", r.quit == 0 and float(r.data) > 0, r.fields)

    check.until("ONLINE begins", repeated("0603"))
    check.until("status 31", lambda: ask("190B").status == 31)
    check("axis parameters are closed now: 14h", ask("1800", 1 << 8 | 6).quit == 0x14)
    check("an axis that is not there: 20h", ask("1910", 17).quit == 0x20)
    ask("0A97", 1)
    check("a reference without a run", ask("0A83", 1).quit == 0)
    check("the flag is set", read("1934", 51) == 1)
    check("the actual position is set", ask("0A86", 1, "10.0", 1).quit == 0)
    check.until("and shown", lambda: abs(read("190C", 1) - 10) < 0.001)
    check("a speed", ask("0A8D", 1, "60.0", 1).quit == 0)

    begun = None

    def begins():
        nonlocal begun
        begun = ask("0A87", 1, "40.0", 1)
        return begun.quit == 0

    check.until("0A87 is accepted", begins)
    check("at once, with its start position", begun.done == 0 and abs(float(begun.data) - 10) < 1.0, begun.fields)
    places = []

    def polled():
        r = poll()
        places.append(float(r.data))
        return r.done == 1

    check.until("polls until the end of processing", polled)
    check("with a position that grows towards the target", places == sorted(places) and len(set(places)) > 1 and places[-1] <= 40.01, places[-3:])
    check.until("and is it", lambda: abs(read("190C", 1) - 40) < 0.01)

    check.until("0A94 is done at once", lambda: (r := ask("0A94", 1, "100.0", 1)).quit == 0 and r.done == 1)
    check.until("and moves", lambda: read("190C", 1) > 44)
    r = ask("0A93", 1)
    while r.done == 0:
        r = poll()
    check("0A93 ends at standstill", r.quit == 0 and 44 < float(r.data) < 99, r.fields)
    check.until("it stands there", lambda: read("1911") == 0)
    place = read("190C", 1)
    check.until("a relative move", repeated("0A95", 1, "-5.0", 1))
    check.until("by so much", lambda: abs(read("190C", 1) - place + 5) < 0.01 and read("1911") == 0)
    check("a target outside the traverse area: 41h", ask("0A94", 1, "9000000.0", 1).quit == 0x41)
    ask("0A98", 1)
    check.until("home position", repeated("0A81"))
    check.until("status 1", lambda: ask("190B").status == 1)


try:
    judge()
except (TimeoutError, ValueError, TypeError) as fault:
    check("it came to its end", False, repr(fault))
sys.exit(check.code)
