"""An EtherNet/IP client of plain messages, in the forms that the documentation of pycomm3 (1.2) gives its generic messages and its discovery.

    enip_client.py HOST PORT AXES      AXES: output and input assembly of an axis, as in 151:101

It shares no code with the gateway or its twins, nor with pycomm3. A call can be a bare message; a bare message with the empty route "00 00" behind
it, which is what pycomm3 sends when nobody has said route_path=False; an Unconnected Send with an empty route or with that of a slot; a message of a
connection that a Large Forward Open has opened. It reads Identity, reads and writes assemblies, and moves an axis by them. One line for each check.
"""
import os
import socket
import struct
import sys

from line import Checks

check = Checks("an EtherNet/IP client")
HOST, PORT = sys.argv[1], int(sys.argv[2])
OUTPUT, INPUT = (int(n) for n in sys.argv[3].split(":"))
CONTEXT = b"_pycomm_"
GET_ALL, GET, SET = 0x01, 0x0E, 0x10
EMPTY_ROUTE = b"\0\0"


def path(class_id, instance, attribute=None):
    """A padded path of logical segments, each as short as its number allows, with its length in words in front."""
    out = b""
    for kind, number in ((0x20, class_id), (0x24, instance), (0x30, attribute)):
        if number is not None:
            out += bytes([kind, number]) if number < 256 else bytes([kind | 1, 0]) + struct.pack("<H", number)
    return bytes([len(out) // 2]) + out


class Answer:
    def __init__(self, message):
        self.service, _, self.status, words = message[:4]
        self.more, self.data = message[4:4 + 2 * words], message[4 + 2 * words:]


class Session:
    def __init__(self):
        self.tcp = socket.create_connection((HOST, PORT), timeout=5)
        self.handle, self.connection, self.count = 0, None, 0

    def exact(self, n):
        data = b""
        while len(data) < n:
            part = self.tcp.recv(n - len(data))
            if not part:
                raise ValueError("the session was closed")
            data += part
        return data

    def order(self, command, data=b"", handle=None):
        """(status, session handle, data)"""
        head = struct.pack("<HHII8sI", command, len(data), self.handle if handle is None else handle, 0, CONTEXT, 0)
        self.tcp.sendall(head + data)
        got, size, session, status, context, _ = struct.unpack("<HHII8sI", self.exact(24))
        body = self.exact(size)
        if (got, context) != (command, CONTEXT):
            raise ValueError(f"answer {got:#x} {context!r} to {command:#x}")
        return status, session, body

    def rr(self, message):
        status, _, body = self.order(0x6F, struct.pack("<IHHHHHH", 0, 10, 2, 0, 0, 0xB2, len(message)) + message)
        if status:
            raise ValueError(f"encapsulation status {status:#x}")
        return Answer(body[16:])

    def unit(self, message):
        self.count += 1
        message = struct.pack("<H", self.count) + message
        _, _, body = self.order(0x70, struct.pack("<IHHHHIHH", 0, 10, 2, 0xA1, 4, self.connection, 0xB1, len(message)) + message)
        return Answer(body[22:])

    # The forms of a call: service, path, data.
    def bare(self, *parts):
        return self.rr(b"".join(parts))

    def by_default(self, *parts):
        return self.rr(b"".join(parts) + EMPTY_ROUTE)

    def wrapped(self, *parts, route=EMPTY_ROUTE):
        message = b"".join(parts)
        pad = b"\0" if len(message) % 2 else b""
        return self.rr(b"\x52" + path(6, 1) + b"\x0a\x05" + struct.pack("<H", len(message)) + message + pad + route)

    def to_slot(self, *parts):
        return self.wrapped(*parts, route=b"\x01\x00\x01\x00")

    def connected(self, *parts):
        return self.unit(b"".join(parts))

    def open(self):
        """A Large Forward Open of 4000 bytes to the message router."""
        parameters = 0x42000000 | 4000
        data = struct.pack("<BBIIHHIB3xIIIIBB", 10, 5, 0, 0x51A2B3C4, 0x1234, 0x1009, int.from_bytes(os.urandom(4), "little"), 7, 2113537, parameters,
                           2113537, parameters, 0xA3, 2)
        answer = self.rr(b"\x5b" + path(6, 1) + data + path(2, 1)[1:])
        if answer.status == 0:
            self.connection = struct.unpack("<I", answer.data[:4])[0]
        return answer


def identity_in(body):
    """(vendor, device type, product code, revision, serial number, name) of the first item of a List Identity."""
    items, kind, _ = struct.unpack_from("<HHH", body)
    if items < 1 or kind != 0x0C:
        raise ValueError(f"no identity: {body!r}")
    vendor, device, product, major, minor, _, serial, size = struct.unpack_from("<HHHBBHIB", body, 6 + 2 + 16)
    return vendor, device, product, (major, minor), serial, body[6 + 2 + 16 + 15:][:size]


def identity(s):
    request = struct.pack("<HHII8sI", 0x63, 0, 0, 0, b"\0" * 8, 0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp:
        udp.settimeout(5)
        udp.sendto(request, (HOST, PORT))
        found = identity_in(udp.recv(4096)[24:])
    check("found by a List Identity over UDP", found[5] == b"axisgate", found)
    check("the same over TCP, in the session", identity_in(s.order(0x63)[2]) == found)
    single = [s.bare(bytes([GET]), path(1, 1, n)).data for n in range(1, 8)]
    vendor, device, product = (struct.unpack("<H", single[n])[0] for n in range(3))
    check("Identity attribute by attribute", (vendor, device, product, tuple(single[3]), struct.unpack("<I", single[5])[0], single[6][1:]) == found, single)
    everything = s.bare(bytes([GET_ALL]), path(1, 1))
    check("Get_Attributes_All has them in their order", everything.service == 0x81 and everything.data[:len(b"".join(single[:4]))] == b"".join(single[:4])
          and everything.data.endswith(single[6]), everything.data)
    for name in ("wrapped", "to_slot"):
        answer = getattr(s, name)(bytes([GET_ALL]), path(1, 1))
        check(f"the same in the form {name}", answer.status == 0 and answer.data.endswith(single[6]), f"{answer.status:#x} {answer.more.hex()}")
    check("an empty route behind a bare message is data: 0x15", s.by_default(bytes([GET_ALL]), path(1, 1)).status == 0x15)
    away = s.wrapped(bytes([GET_ALL]), path(1, 1), route=b"\x01\x00\x01\x05")
    check("a module that is not there: 1, 0x0312", away.status == 1 and away.more == b"\x12\x03", f"{away.status:#x} {away.more.hex()}")
    check("the class' revision", len(s.bare(bytes([GET]), path(1, 0, 1)).data) == 2)
    check("an attribute that is not there: 0x14", s.bare(bytes([GET]), path(1, 1, 99)).status == 0x14)
    check("a class that is not there: 5", s.bare(bytes([GET]), path(0x99, 1, 1)).status == 5)
    check("another session's handle: 0x64", s.order(0x6F, b"\0" * 16, s.handle ^ 0x55)[0] == 0x64)


def image(word, target=0):
    """Registers of an output assembly: control word, mode 1, target, velocity, acceleration, deceleration."""
    return struct.pack("<HhiIII", word, 1, target, 64000, 320000, 320000) + bytes(12)


def motion(s):
    def seen():
        data = s.bare(bytes([GET]), path(4, INPUT, 3)).data
        return struct.unpack_from("<H", data)[0], struct.unpack_from("<i", data, 4)[0]

    def write(form, word, target=0):
        return getattr(s, form)(bytes([SET]), path(4, OUTPUT, 3), image(word, target)).status

    check("the size of an assembly", struct.unpack("<H", s.bare(bytes([GET]), path(4, INPUT, 4)).data)[0] == 32)
    check("a write that is too short: 0x13", s.bare(bytes([SET]), path(4, OUTPUT, 3), image(0)[:31]).status == 0x13)
    check("and one that is too long, as by an empty route behind the data: 0x15", write("by_default", 0) == 0x15)
    forms = ("bare", "wrapped", "connected")
    for number, (word, wanted) in enumerate(((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27))):
        check(f"control word {word:#x} in the form {forms[number]}", write(forms[number], word) == 0)
        check.until("and its state", lambda: seen()[0] & 0x6F == wanted)
    begin = seen()[1]
    check("a set-point by a message of the connection", write("connected", 0x1F, begin + 16000) == 0)
    check.until("is reached", lambda: seen()[1] == begin + 16000)
    write("bare", 0x0F)
    check("a far one by an Unconnected Send", write("wrapped", 0x1F, begin + 3200000) == 0)
    check.until("begins", lambda: seen()[1] > begin + 17000)
    check("a halt by a bare message", write("bare", 0x010F) == 0)
    places = [0, 1]

    def rests():
        places[:] = [places[1], seen()[1]]
        return places[0] == places[1]

    check.until("ends it", rests)
    check("in flight", begin + 16000 < seen()[1] < begin + 3200000)
    check("off", write("to_slot", 0x06) == 0)
    check.until("and its state", lambda: seen()[0] & 0x6F in (0x21, 0x40))


def judge():
    s = Session()
    status, s.handle, body = s.order(0x65, b"\x01\0\0\0")
    check("a session is registered", status == 0 and s.handle != 0 and body == b"\x01\0\0\0", body)
    identity(s)
    opened = s.open()
    check("a Large Forward Open of 4000 bytes", opened.status == 0, f"{opened.status:#x} {opened.more.hex()}")
    check("a message over it", s.connected(bytes([GET]), path(1, 1, 7)).data == b"\x08axisgate")
    motion(s)
    s.tcp.sendall(struct.pack("<HHII8sI", 0x66, 0, s.handle, 0, CONTEXT, 0))
    try:
        ended = s.tcp.recv(1) == b""
    except ConnectionError:
        ended = True
    check("the session ends when it is unregistered", ended)


try:
    judge()
except (OSError, ValueError, IndexError, struct.error) as fault:
    check("it came to its end", False, repr(fault))
sys.exit(check.code)
