"""A host of Lexium MCode drives, written from the maker's programming and software reference alone; it shares no code with the gateway or its twins.

    mcode_host.py PLACE single|party      PLACE: the path of a terminal, or HOST:PORT

Single: prompt, echo modes, the error and its question mark, moves, a stop in flight by SL 0 and by ESC. Party (drives a and b): activation by the
first line feed, names, the global name, the checksum with ACK and NAK, the way out. One line for each check.
"""
import sys
import time

from line import Checks, HostLine

check = Checks("an MCode host")
line, MODE = HostLine(sys.argv[1]), sys.argv[2]
END = b"\r" if MODE == "single" else b"\n"


def checksum(data):
    """All characters added up, two's complement, with the highest bit set (7.1.2)."""
    return bytes([(-sum(data) & 0x7F) | 0x80])


def behind(*ends, lines=1):
    """An answer is whole when it ends so, with at least so many line feeds."""
    def whole(got):
        return len(got) if got.endswith(ends) and got.count(b"\n") >= lines else 0
    return whole


def ask(text, whole, seconds=5.0):
    line.send(text + END)
    return line.until(whole, seconds)


def number(got):
    """The last line of digits of an answer."""
    for row in reversed(got.replace(b"\r", b"\n").split(b"\n")):
        if row.lstrip(b"-").isdigit():
            return int(row)
    raise ValueError(f"no number in {got!r}")


def value(name, to=b""):
    """By EM=1 (7.1.1): CR LF and the data, which end with CR LF."""
    return number(ask(to + b"PR " + name, behind(b"\r\n", lines=2)))


def rests(to=b""):
    places = [value(b"P", to), value(b"P", to)]
    return places[0] == places[1] and value(b"V", to) == 0


def up():
    line.send(END)
    try:
        line.send(b"PR PN" + END)
        return b"LM" in line.until(behind(b">", b"?"), 1)
    except TimeoutError:
        return False


def single():
    check.until("it answers, when it has booted", up, 30)
    line.forget()
    # EM=0, the factory setting: echo, then the prompt.
    got = ask(b"A=1000000", behind(b">"))
    check("a command is echoed and ends with the prompt", got.startswith(b"A=1000000") and got.endswith(b"\r\n>"), got)
    got = ask(b"PR A", behind(b">"))
    check("PR gives the value", got.startswith(b"PR A") and b"1000000\r\n" in got, got)
    got = ask(b"A=1", behind(b">", b"?"))
    check("a value out of range: a question mark in place of the prompt", got.endswith(b"?"), got)
    got = ask(b"PR ER", behind(b">", b"?"))
    check("the code is 21", number(got[5:]) == 21, got)
    got = ask(b"PR ER", behind(b">"))
    check("and reading it has cleared it", number(got[5:]) == 0, got)
    got = ask(b"QQ9=1", behind(b">", b"?"))
    check("an unknown variable is an error", got.endswith(b"?"), got)
    ask(b"ER=0", behind(b">"))
    ask(b"EM=1", behind(b"\n", b">"))  # whether the old or the new mode ends it is not said
    line.forget()
    check("EM=1: CR LF alone", ask(b"VM=200000", behind(b"\n")) == b"\r\n")
    ask(b"P=0", behind(b"\n"))
    ask(b"MR 51200", behind(b"\n"))
    check.until("MR moves it a turn", lambda: value(b"P") == 51200)
    check.until("MV falls behind the settling time", lambda: value(b"MV") == 0)
    ask(b"MA 0", behind(b"\n"))
    check.until("MA moves it back", lambda: value(b"P") == 0 and value(b"MV") == 0)
    ask(b"SL 100000", behind(b"\n"))
    check.until("SL turns it", lambda: value(b"P") > 5000)
    ask(b"SL 0", behind(b"\n"))
    check.until("SL 0 stops it", rests)
    ask(b"MR 5120000", behind(b"\n"))
    begin = value(b"P")
    check.until("a long move begins", lambda: value(b"P") > begin + 5000)
    line.send(b"\x1b")
    line.forget()
    check.until("ESC stops it", rests)
    check("in flight", begin < value(b"P") < begin + 5120000)
    ask(b"DE=0", behind(b"\n"))
    ask(b"MR 100", behind(b"\n"))
    check("a move of a disabled drive: error 94", value(b"ER") == 94)
    line.send(b"EM=2\r")
    line.forget()
    line.send(b"A=900000\r")
    check("EM=2: silent", line.silent(0.2))
    check("but for PR", ask(b"PR A", behind(b"\n")) == b"900000\r\n")
    line.send(b"EM=3\r")
    line.forget()
    got = ask(b"A=800000", behind(b"\n"))
    check("EM=3: the command in one piece, and CR LF", got == b"A=800000\r\n", got)


def party():
    line.send(b"aPR P\n")
    time.sleep(0.2)
    line.forget()
    end = time.monotonic() + 30
    for name in (b"a", b"b"):
        while time.monotonic() < end:
            line.send(b"\n" + name + b"EM=1\n")
            try:
                line.until(behind(b"\n", b">"), 1)
                break
            except TimeoutError:
                continue
    line.forget()
    ask(b"aA=500000", behind(b"\n"))
    ask(b"bA=600000", behind(b"\n"))
    check("each has its own variables", (value(b"A", b"a"), value(b"A", b"b")) == (500000, 600000))
    line.send(b"cPR A\n")
    check("a name that nobody has: silence", line.silent(0.3))
    line.send(b"*P=0\n")
    check("a global command is not answered (DG=1)", line.silent(0.3))
    line.send(b"*MR 20000\n")
    check.until("and moves both", lambda: (value(b"P", b"a"), value(b"P", b"b")) == (20000, 20000))
    ask(b"bSL 50000", behind(b"\n"))
    check.until("one turns alone", lambda: value(b"P", b"b") > 30000)
    check("the other one stands", value(b"P", b"a") == 20000)
    line.send(b"*SL 0\n")
    check.until("the global stop", lambda: rests(b"b"))
    # Checksum mode, for a alone.
    ask(b"aCK=1", behind(b"\n", b"\x06"))
    line.forget()
    good = b"aA=700000"
    check("a correct checksum: ACK", ask(good + checksum(good), behind(b"\x06", lines=0)) == b"\x06")
    line.forget()
    bad = bytes([checksum(good)[0] ^ 1])
    check("a wrong one: NAK", ask(good + bad, behind(b"\x15", lines=0)) == b"\x15")
    read = b"aPR A"
    got = ask(read + checksum(read), behind(b"\n"))
    body = got.strip(b"\x06\r\n")
    check("and data with a checksum of their own", body[:-1] == b"700000" and sum(body) & 0x7F == 0, got)
    lower = b"aa=710000"
    check("small letters have another checksum", ask(lower + checksum(lower), behind(b"\x06", lines=0)) == b"\x06")


try:
    single() if MODE == "single" else party()
except (TimeoutError, ValueError) as fault:
    check("it came to its end", False, fault)
sys.exit(check.code)
