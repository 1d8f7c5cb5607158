"""Capture files of golden frames, what tshark makes of a capture with the dissectors of deploy/wireshark, and captures of a test's own traffic.

In: adapters/*/vectors.txt; runs of bytes, CAN frames, TCP payloads. Out: pcapng files as the gateway's own traces are; per packet the messages, with fields and words.
"""
import contextlib
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree

TOP = pathlib.Path(__file__).resolve().parents[2]
DISSECTORS = TOP / "deploy/wireshark"
USER0, SOCKETCAN, RAW_IP = 147, 227, 101
PROTOCOLS = {"uimessage", "simplecan", "uim342", "mcode", "pacontrol", "linrs", "axisgate_line"}


def block(kind, body):
    size = len(body) + 12
    return struct.pack("<II", kind, size) + body + struct.pack("<I", size)


def write(path, link_type, packets):
    """packets: (to_drive or None, bytes)"""
    out = block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1)) + block(1, struct.pack("<HHI", link_type, 0, 0))
    for n, (to_drive, data) in enumerate(packets):
        padded = data + bytes(-len(data) % 4)
        flags = b"" if to_drive is None else struct.pack("<HHIHH", 2, 4, 2 if to_drive else 1, 0, 0)
        out += block(6, struct.pack("<IIIII", 0, 0, n * 1000, len(data), len(data)) + padded + flags)
    pathlib.Path(path).write_bytes(out)


def can_packet(identifier, data):
    return struct.pack(">IB3x", identifier | 0x80000000, len(data)) + data


def tcp_packets(port, payloads):
    """A connection to `port`: (to_drive, bytes) as segments in order, without options and checksums."""
    numbers, packets = {True: 1, False: 1}, []
    for to_drive, data in payloads:
        ports = (40000, port) if to_drive else (port, 40000)
        tcp = struct.pack(">HHIIBBHHH", *ports, numbers[to_drive], numbers[not to_drive], 5 << 4, 0x18, 8192, 0, 0) + data
        ip = struct.pack(">BBHHHBBHII", 0x45, 0, 20 + len(tcp), 0, 0, 64, 6, 0, *((1, 2) if to_drive else (2, 1)))
        numbers[to_drive] += len(data)
        packets.append((None, ip + tcp))
    return packets


def lines_of(family):
    for line in (TOP / f"adapters/{family}/vectors.txt").read_text().splitlines():
        word, _, rest = line.partition(" ")
        yield word, rest


def octets(text):
    return bytes.fromhex(text.split("#")[0])


def vectors(family):
    """(to_drive, bytes) of every golden message on a line of bytes."""
    messages, typed = [], False
    for word, rest in lines_of(family):
        if family == "uim342" and re.fullmatch(r"(uim|plain|uim13|stream)[<>]", word):
            messages.append((word.endswith(">"), octets(rest)))
        elif family == "linmot" and word in "<>" and word:
            messages.append((word == ">", octets(rest)))
        elif family == "pacontrol":
            if word in (">", "<", "<~"):
                to_drive = word == ">"
            elif word == "bytes" or word == "printed":
                messages.append((to_drive, bytes(int(b, 16) for b in re.findall(r"\b[0-9A-F]{2}\b", re.split(r" (?=check|other|text)|#", rest)[0]))))
            elif word == "poll>":
                messages.append((True, b"\x04"))
        elif family == "mcode":
            if word in ("bytes", "transcript", "program"):
                typed = word != "bytes"
            elif word in (">", "<") and typed:
                messages.append((word == ">", rest.encode() + (b"\r" if word == ">" else b"\r\n")))
            elif word == "|":
                messages.append((True, rest.encode() + b"\r"))
            elif word in (">", "<") and rest != "none":
                messages.append((word == ">", octets(rest)))
    return messages


def can_vectors():
    """(to_drive, identifier, data) of every golden CAN frame."""
    for word, rest in lines_of("uim342"):
        if word in ("can>", "can<"):
            identifier, *data = rest.split("#")[0].split()
            yield word == "can>", int(identifier, 16), bytes(int(b.replace("xx", "00"), 16) for b in data)


def make_names(*folder):
    subprocess.run([sys.executable, DISSECTORS / "names.py", *folder], check=True)


def scripts():
    # By name, as Wireshark does with its folder of plug-ins.
    make_names()
    return [f"-Xlua_script:{p}" for p in sorted(DISSECTORS.glob("*.lua"))]


class Message:
    def __init__(self, proto):
        self.protocol = proto.get("name")
        self.words = proto.get("showname", "").partition(", ")[2]
        self.fields = {}
        for f in proto.iter("field"):
            self.fields.setdefault(f.get("name"), f.get("show"))
        self.faults = [n for n in self.fields if n.startswith(("_ws.malformed", "_ws.lua"))]

    def __getitem__(self, name):
        return self.fields.get(name)

    def number(self, name):
        value = self.fields.get(name)
        return None if value is None else int(value, 0)


def dissect(path, *arguments):
    """One list of messages for each packet; any fault of a script, and anything malformed, is an error."""
    p = subprocess.run(["tshark", *scripts(), *arguments, "-r", str(path), "-T", "pdml"], capture_output=True, text=True, timeout=120,
                       env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": str(pathlib.Path(path).parent), "LC_ALL": "C.UTF-8"})
    assert p.returncode == 0 and "lua" not in p.stderr.lower(), p.stderr
    assert "_ws.malformed" not in p.stdout and "Lua Error" not in p.stdout, re.findall(r".*(?:_ws.malformed|Lua Error).*", p.stdout)[:3]
    packets = []
    for packet in xml.etree.ElementTree.fromstring(p.stdout).iter("packet"):
        packets.append([Message(x) for x in packet.iter("proto") if x.get("name") in PROTOCOLS])
    return packets


def messages(packets, protocol):
    return [m for p in packets for m in p if m.protocol == protocol]


class Traffic:
    """What went over EtherNet/IP during a block. `hostile`: frames that the test itself has made wrong, each by its first bytes in hex."""

    def __init__(self):
        self.hostile = {}
        self.pieces = set()

    def expect_pieces(self, piece):
        """Sessions of the test end behind this piece of a frame. The dissector waits for the rest without a word, or names it, when it has seen a session from the same port before: both are right."""
        self.pieces.add(piece.hex())

    def expect_bad(self, head, count=1):
        """`count` datagrams to the device that begin so are no frames on purpose; another number of them is a failure."""
        self.hostile[head.hex()] = self.hostile.get(head.hex(), 0) + count


@contextlib.contextmanager
def judged(path, port, io_port):
    """Captures the loopback's frames of these ports; behind the block each must be one that tshark knows, without a warning."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as marker:
        marker.bind(("127.0.0.1", 0))
        end = marker.getsockname()[1]
        dump = subprocess.Popen(["dumpcap", "-q", "-i", "lo", "-B", "64", "-w", str(path), "-f", f"port {port} or port {io_port} or udp port {end}"], stderr=subprocess.PIPE)
        try:
            for line in dump.stderr:
                if line.startswith(b"File:"):
                    break
            traffic = Traffic()
            yield traffic
            mark, deadline = os.urandom(16), time.monotonic() + 1
            marker.sendto(mark, marker.getsockname())  # behind everything else: when it is in the file, all is
            while mark not in path.read_bytes() and time.monotonic() < deadline:
                time.sleep(0.1)
        finally:
            dump.terminate()
            dump.wait(5)
            dump.stderr.close()
        # What dumpcap had not written yet it writes at its end.
        assert mark in path.read_bytes(), "the capture has not come to its end"
    judge(path, port, io_port, traffic)


def judge(path, port, io_port, traffic):
    fields = ["frame.number", "tcp.dstport", "udp.dstport", "udp.payload", "tcp.payload", "_ws.expert.message"]
    # A reset is no frame of ours: what TCP itself has to say has no layer of EtherNet/IP above it.
    of_device = f"(tcp.port == {port} || udp.port == {port} || udp.port == {io_port})"
    bad = of_device + " && (_ws.malformed || ((enip || cip || cipcm || cipio) && _ws.expert.severity >= 0x600000))"
    p = subprocess.run(["tshark", "-r", str(path), "-d", f"tcp.port=={port},enip", "-d", f"udp.port=={port},enip", "-d", f"udp.port=={io_port},cipio", "-Y", bad, "-T", "fields", "-E", "separator=|",
                        *[x for f in fields for x in ("-e", f)]], capture_output=True, text=True, timeout=300)
    assert p.returncode == 0, p.stderr
    left = dict(traffic.hostile)
    for line in p.stdout.splitlines():
        number, tcp_to, to, udp, tcp, words = line.split("|", 5)
        if tcp_to == str(port) and tcp in traffic.pieces:
            continue
        head = next((h for h, n in left.items() if n > 0 and to == str(io_port) and udp.startswith(h)), None)
        assert head, f"frame {number} of {path.name}: {words or 'malformed'}: {udp or tcp}"
        left[head] -= 1
    assert not any(left.values()), f"named as wrong, but tshark knows them: {left}"


if __name__ == "__main__":  # FILE PORT IO_PORT: judged by itself, with nothing wrong on purpose
    capture = pathlib.Path(sys.argv[1])
    counted = subprocess.run(["tshark", "-r", str(capture), "-Y", f"tcp.port == {sys.argv[2]} || udp.port == {sys.argv[3]}"],
                             capture_output=True, text=True, timeout=300, check=True).stdout.count("\n")
    assert counted > 100, f"only {counted} frames in {capture}"
    judge(capture, int(sys.argv[2]), int(sys.argv[3]), Traffic())
