"""A host of a UIM342 behind the maker's converter, written from the UIM342 manual and public programs for the converter alone.

    uim342_host.py PLACE NODE      PLACE: the path of a terminal, or HOST:PORT

It shares no code with the gateway or its twins. The forms of acknowledgements, the errors, point to point with its notification, a jog, a stop in
flight, OG, messages without acknowledgement and with a wrong check. Whether a report keeps bit 7 of the control word is left open. One line for each
check.
"""
import struct
import sys
import time

from line import Checks, crc16, HostLine

check = Checks("a UIM342 host")
line, NODE = HostLine(sys.argv[1]), int(sys.argv[2])
PP, IE, ML, ER, MS, MO, BG, ST, AC, DC, SD, JV, SP, PR, PA, OG, DV, RT = (
    0x01, 0x07, 0x0B, 0x0F, 0x11, 0x15, 0x16, 0x17, 0x19, 0x1A, 0x1C, 0x1D, 0x1E, 0x1F, 0x20, 0x21, 0x2E, 0x5A)
notified = []


def send(word, data=b"", wrong=0):
    body = bytes([NODE, word, len(data)]) + data + bytes(9 - len(data))
    line.send(b"\xAA" + body + struct.pack("<H", crc16(body) ^ wrong) + b"\xCC")


def whole(got):
    return 16 if len(got) >= 16 else 0


def receive(seconds=2.0):
    """(control word, data) of the next message that is no notification."""
    end = time.monotonic() + seconds
    while True:
        m = line.until(whole, max(0.0, end - time.monotonic()))
        while m[0] != 0xAA or m[15] != 0xCC or struct.unpack("<H", m[13:15])[0] != crc16(m[1:13]):
            m = m[1:] + line.until(lambda got: 1 if got else 0, max(0.0, end - time.monotonic()))
        if m[1] == NODE and m[2] == RT:
            notified.append(m[4:4 + m[3]])
        elif m[1] == NODE:
            return m[2], m[4:4 + m[3]]


def ask(word, data=b""):
    for left in (2, 1, 0):
        send(word | 0x80, data)
        try:
            return receive()
        except TimeoutError:
            if left == 0 or word in (BG, PR):
                raise
    return None


def i32(number):
    return struct.pack("<i", number)


def status():
    """(driver on, stationary, in position, speed, position)"""
    _, m = ask(MS, b"\0")
    _, n = ask(MS, b"\x01")
    return m[1] >> 2 & 1, m[2] & 1, m[2] >> 1 & 1, int.from_bytes(n[1:4], "little", signed=True), struct.unpack("<i", n[4:])[0]


def up():
    try:
        send(ML | 0x80)
        return receive(1.0)[0] == ML
    except TimeoutError:
        line.forget()
        return False


def judge():
    check.until("it answers, when it has booted", up, 30)
    line.forget()
    word, data = ask(ML)
    check("ML has eight bytes, the model first", word == ML and len(data) == 8 and data[0] in (0x20, 0x21, 0x22), data.hex(" "))
    check("the node ID is its own", ask(PP, b"\x07") == (PP, bytes([7, NODE])))
    check("MO=0 is repeated", ask(MO, b"\0") == (MO, b"\0"))
    word, data = ask(BG)
    check("BG without power: error 3Eh, reported with its control word", word == ER and data[1] == 0x3E and data[2] & 0x7F == BG, data.hex(" "))
    word, data = ask(PP, b"\x63")
    check("an index that is not there: 34h, with the index", word == ER and data[1] == 0x34 and data[3] == 0x63, data.hex(" "))
    check("a value that is not allowed: 33h", ask(MO, b"\x07")[1][1] == 0x33)
    check("an unknown control word: 32h", ask(0x7D)[1][1] == 0x32)
    ask(ER, b"\0\0")
    check("the errors are cleared", ask(ER, b"\0")[1][1] == 0)
    ask(MS, b"\0\0")

    check("AC, DC and SD are repeated", ask(SD, i32(800000))[0] == SD and ask(AC, i32(100000)) == (AC, i32(100000)) and ask(DC, i32(100000))[0] == DC)
    check("SD below DC: 3Ch", ask(SD, i32(50000))[1][1] == 0x3C)
    ask(IE, b"\x08\x01\0")
    check("MO=1", ask(MO, b"\x01") == (MO, b"\x01"))
    check("OG", ask(OG) == (OG, b"") and status()[4] == 0)
    check("PA answers as DV[4]", ask(PA, i32(20000)) == (DV, b"\x04" + i32(20000)))
    check("SP as DV[2]", ask(SP, i32(40000)) == (DV, b"\x02" + i32(40000)))
    check("nothing moves before BG", status()[1] == 1 and status()[4] == 0)
    notified.clear()
    check("BG answers four zeros", ask(BG) == (BG, bytes(4)))
    check.until("the position is reached, and the flags say so", lambda: status()[1:] == (1, 1, 0, 20000))
    check.until("its end is notified, with the position", lambda: any(n == b"\x29\0\0\0" + i32(20000) for n in notified) or not status())
    check("PR answers as DV[3]", ask(PR, i32(-5000)) == (DV, b"\x03" + i32(-5000)))
    ask(BG)
    check.until("a relative motion", lambda: status()[1:] == (1, 1, 0, 15000))

    check("JV answers as DV[2]", ask(JV, i32(30000)) == (DV, b"\x02" + i32(30000)))
    ask(BG)
    check.until("a jog", lambda: status()[4] > 18000)
    check("OG in motion: 41h", ask(OG)[1][1] == 0x41)
    check("ST is repeated", ask(ST) == (ST, b""))
    check.until("and stops it", lambda: (s := status())[1] == 1 and s[3] == 0)
    place = status()[4]
    ask(PA, i32(place + 400000))
    ask(SP, i32(40000))
    ask(BG)
    check.until("a long motion", lambda: status()[4] > place + 2000)
    ask(ST)
    check.until("is stopped in flight", lambda: (s := status())[1] == 1 and s[3] == 0)
    check("out of position", place < status()[4] < place + 400000 and status()[2] == 0)

    send(MO, b"\0")
    check("without bit 7 no acknowledgement", line.silent(0.3))
    check("but it was done", status()[0] == 0)
    send(MO | 0x80, b"\x01", wrong=0x0101)
    check("a wrong check is not answered", line.silent(0.3))
    check("nor carried out", status()[0] == 0)


try:
    judge()
except (TimeoutError, ValueError, IndexError) as fault:
    check("it came to its end", False, repr(fault))
sys.exit(check.code)
