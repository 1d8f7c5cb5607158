"""EtherNet/IP from outside: a small originator of plain sockets browses the device, holds a class 1 connection and moves an axis by it.

In: the real program with the door switched on. Out: what an engineering tool and a controller see. tshark judges every frame of every test that uses
`device`: none is malformed or has a warning but those that the test has named.
"""
import contextlib
import re
import socket
import struct
import subprocess
import threading
import time

from captures import judged
from harness import DEMO, Gateway, until


SO_TIMESTAMPNS = 35


class Originator:
    """One session, and one class 1 connection if it is opened."""

    def __init__(self, host, port, io_port):
        self.host, self.io_port = host, io_port
        self.tcp = socket.create_connection((host, port), timeout=5)
        self.session = 0
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.udp.bind((host, 0))
        self.udp.settimeout(1)
        self.longest_s, self.last_s = 0.0, None  # between two images, by when they reached this machine's socket
        self.session = struct.unpack("<I", self.order(0x65, struct.pack("<HH", 1, 0))[4:8])[0]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.tcp.close()
        self.udp.close()

    def read(self, n):
        data = b""
        while len(data) < n:
            part = self.tcp.recv(n - len(data))
            assert part, "the device has closed the session"
            data += part
        return data

    def order(self, command, data):
        self.tcp.sendall(struct.pack("<HHII8sI", command, len(data), self.session, 0, b"originat", 0) + data)
        head = self.read(24)
        return head + self.read(struct.unpack("<H", head[2:4])[0])

    def ask(self, service, path, data=b"", items=b"", more=0):
        """(general status, extended words, data)"""
        message = bytes([service, len(path) // 2]) + path + data
        answer = self.order(0x6F, struct.pack("<IHHHHHH", 0, 0, 2 + more, 0, 0, 0xB2, len(message)) + message + items)
        assert struct.unpack("<I", answer[8:12])[0] == 0, answer
        size = struct.unpack("<H", answer[38:40])[0]
        body, self.items_behind = answer[40:40 + size], answer[40 + size:]
        words = body[3]
        return body[2], struct.unpack(f"<{words}H", body[4:4 + 2 * words]), body[4 + 2 * words:]

    def get(self, class_id, instance, attribute):
        status, _, data = self.ask(0x0E, bytes([0x20, class_id, 0x25, 0]) + struct.pack("<H", instance) + bytes([0x30, attribute]))
        assert status == 0, (class_id, instance, attribute, status)
        return data

    def open(self, output, given, serial=1, rpi_us=5000, path_head=b""):
        path = path_head + bytes([0x20, 0x04, 0x24, 199, 0x2C, output, 0x2C, given])
        sockaddr = struct.pack(">HHI8x", 2, self.udp.getsockname()[1], 0)
        data = struct.pack("<BBIIHHIB3xIHIHBB", 10, 14, 0, 0x7000 + serial, serial, 0x4242, 99, 5, rpi_us, 0x4800 | 38, rpi_us, 0x4800 | 34, 1, len(path) // 2) + path
        status, extended, answer = self.ask(0x54, bytes([0x20, 6, 0x24, 1]), data, struct.pack("<HH", 0x8001, 16) + sockaddr, 1)
        if status == 0:
            self.id = struct.unpack("<I", answer[:4])[0]
        return status, extended

    def start(self, rpi_s=0.005, output=None):
        """Renews `self.output` until stop(); `output` is the first image, zeros without it."""
        self.output, self.run, self.sending = output or bytearray(32), 1, True

        def go():
            n = 0
            while self.sending:
                n += 1
                data = struct.pack("<HI", n & 0xFFFF, self.run) + bytes(self.output)
                frame = struct.pack("<HHHIIHH", 2, 0x8002, 8, self.id, n, 0xB1, len(data)) + data
                self.udp.sendto(frame, (self.host, self.io_port))
                time.sleep(rpi_s)
        self.thread = threading.Thread(target=go)
        self.thread.start()

    def stop(self):
        if getattr(self, "sending", False):
            self.sending = False
            self.thread.join()

    def inputs(self):
        """The newest 32 bytes that the device has sent."""
        self.udp.setblocking(False)
        newest = None
        end = time.monotonic() + 2
        while time.monotonic() < end:
            try:
                newest, more, _, _ = self.udp.recvmsg(2048, 64)
                seconds, ns = struct.unpack("@qq", more[0][2])
                at_s = seconds + ns / 1e9
                self.longest_s = max(self.longest_s, at_s - (self.last_s or at_s))
                self.last_s = at_s
            except BlockingIOError:
                if newest:
                    break
                time.sleep(0.002)
        assert newest, "the device sends nothing"
        kind, size = struct.unpack("<HH", newest[14:18])
        assert kind == 0xB1 and size == 34, newest
        return newest[20:]

    def write(self, word, mode=1, position=0, velocity=0):
        struct.pack_into("<HhiIIIih", self.output, 0, word, mode, position, velocity, velocity * 10, velocity * 10, 0, 0)


@contextlib.contextmanager
def device(folder):
    """The gateway, and what an Originator needs to reach it."""
    # A free port for implicit data: others on this machine may have 2222.
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        io_port = s.getsockname()[1]
    with Gateway(folder, DEMO, "--set", "enip.bind=127.0.0.1:0", "--set", f"enip.io_port={io_port}") as g:
        host, port = g.word("enip").rsplit(":", 1)
        with judged(folder / f"enip-{port}.pcapng", int(port), io_port) as g.traffic:
            yield g, (host, int(port), io_port)


def statusword(inputs):
    return struct.unpack("<H", inputs[:2])[0]


def test_a_tool_browses_the_device(folder):
    with device(folder) as (_, at), Originator(*at) as o:
        assert o.get(1, 1, 7) == b"\x08axisgate"
        assert struct.unpack("<H", o.get(4, 101, 4))[0] == 32
        assert struct.unpack("<H", o.get(4, 100, 4))[0] == 64
        assert struct.unpack("<H", o.get(0x0F, 0, 2))[0] > 10
        name = o.get(0x0F, 1, 7)
        assert name[0] == len(name) - 1
        statuses = [o.ask(0x0E, bytes([0x20, 0x0F, 0x24, instance, 0x30, 1]))[0] for instance in range(1, 30)]
        assert 0 in statuses, f"no parameter's value came: {statuses}"
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as u:
            u.settimeout(2)
            u.sendto(struct.pack("<HHII8sI", 0x63, 0, 0, 0, b"whois   ", 0), at[:2])
            assert b"axisgate" in u.recv(1024)


def test_the_data_sheet_says_what_the_device_is(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        status, sheet, headers = g.request("GET", "/api/v1/eds")
        sheet = sheet.decode() if isinstance(sheet, bytes) else sheet
        assert status == 200 and "[Device]" in sheet and "[Assembly]" in sheet and "[Connection Manager]" in sheet, (status, sheet[:300])

        def number(key):
            return int(re.search(rf"{key} = (\d+);", sheet).group(1))
        assert number("VendCode") == struct.unpack("<H", o.get(1, 1, 1))[0]
        assert number("ProdCode") == struct.unpack("<H", o.get(1, 1, 3))[0]
        assert (number("MajRev"), number("MinRev")) == tuple(o.get(1, 1, 4))
        assert "Assem101" in sheet and "Assem151" in sheet and "feeder" in sheet, sheet[:2000]
        before = headers["Mapping-Revision"]
        g.send("POST", "/mappings", {"unit": 9, "address": 0, "axis": "feeder", "point": "position", "type": "i32"}, 201)
        status, other, headers = g.request("GET", "/api/v1/eds")
        assert headers["Mapping-Revision"] != before
    with Gateway(folder, None, "--set", "enip.bind=off") as g:
        assert g.request("GET", "/api/v1/eds")[0] == 404


def test_a_class_1_connection_moves_an_axis_and_its_loss_stops_it(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        assert o.open(151, 101) == (0, ())
        o.start()
        for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            o.write(word)
            until(lambda: statusword(o.inputs()) & 0x6F == state, what=f"state {state:#x}")
        target = struct.unpack("<i", o.inputs()[4:8])[0] + 3200
        o.write(0x0F, 1, target, 3200)
        time.sleep(0.05)
        o.write(0x1F, 1, target, 3200)
        until(lambda: struct.unpack("<i", o.inputs()[4:8])[0] == target, what="the target")
        assert g.get("/axes/feeder")["position_increments"] == target
        with Originator(*at) as second:
            assert second.open(151, 101, serial=2) == (1, (0x0106,)), "one owner of an axis"
        # A motion without an end ends with its owner.
        o.write(0x0F, 3, target, 3200)
        time.sleep(0.1)
        struct.pack_into("<i", o.output, 20, 3200)
        until(lambda: g.get("/axes/feeder")["moving"], what="the motion")
        o.stop()
        until(lambda: not g.get("/axes/feeder")["moving"], what="the stop")
        text = str(g.get("/events?limit=50"))
        assert "silent for its time-out" in text, text
        status, metrics, _ = g.request("GET", "/metrics")
        assert status == 200 and b"axisgate_enip_connection_timeouts_total 1" in metrics, metrics


def test_the_first_image_moves_nothing_at_the_start_and_after_idle(folder):
    def image(speed):
        return bytearray(struct.pack("<HhiIIIi8x", 0x0F, 3, 0, 3200, 32000, 32000, speed))

    def stands(g, what):
        end = time.monotonic() + 0.4
        while time.monotonic() < end:
            axis = g.get("/axes/feeder")
            assert not axis["moving"], f"{what}: {axis}"
    with device(folder) as (g, at), Originator(*at) as o:
        assert g.command("feeder", {"command": "enable"})["result"] == "done"
        assert o.open(151, 101) == (0, ())
        o.start(output=image(3200))
        until(lambda: struct.unpack("<h", o.inputs()[2:4])[0] == 3, what="mode 3: the image has come")
        stands(g, "the first image")
        o.output = image(1600)
        until(lambda: g.get("/axes/feeder")["moving"], what="another speed")
        o.run = 0
        until(lambda: not g.get("/axes/feeder")["moving"], what="the stop of idle")
        assert g.command("feeder", {"command": "enable"})["result"] == "done"
        until(lambda: statusword(o.inputs()) & 0x6F == 0x27, what="enabled again")
        o.run = 1
        stands(g, "the first image after idle")
        o.output = image(1700)
        until(lambda: g.get("/axes/feeder")["moving"], what="another speed after idle")


def test_every_frame_is_what_a_dissector_knows(folder):
    with device(folder) as (_, at):
        with Originator(*at) as o:
            for class_id in (1, 2, 6, 0xF5, 0xF6):
                o.ask(1, bytes([0x20, class_id, 0x24, 1]))
            o.get(0x0F, 1, 7)
            o.order(0x04, b"")
            o.order(0x63, b"")
            assert o.open(151, 101) == (0, ())
            assert o.open(151, 101, serial=2)[0] == 1
            o.ask(0x56, bytes([0x20, 6, 0x24, 1]), struct.pack("<H", 1))
            o.start()
            time.sleep(0.2)
            o.stop()
    _, port, io_port = at
    seen = subprocess.run(["tshark", "-r", str(folder / f"enip-{port}.pcapng"), "-d", f"tcp.port=={port},enip", "-d", f"udp.port=={io_port},cipio", "-V"],
                          capture_output=True, text=True, check=True).stdout
    assert "EtherNet/IP" in seen and "Forward Open" in seen, seen[-2000:]
    marks = subprocess.run(["tshark", "-r", str(folder / f"enip-{port}.pcapng"), "-T", "fields", "-e", "tcp.srcport", "-e", "udp.srcport", "-e", "ip.dsfield.dscp"],
                           capture_output=True, text=True, check=True).stdout
    marks = {tuple(line.split("\t")) for line in marks.splitlines()}
    assert (str(port), "", "27") in marks, f"answers have the mark of explicit messages: {marks}"
    assert ("", str(io_port), "47") in marks, f"inputs have that of scheduled data: {marks}"


def test_a_frame_that_is_none_is_found_by_the_dissector_too(folder):
    """The judge of all the other tests here can fail: a datagram that is cut off is found, unless the test names it."""
    cut = struct.pack("<HHHI", 2, 0x8002, 8, 1)

    def send(named):
        with device(folder) as (g, at), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            if named:
                g.traffic.expect_bad(cut, named)
            s.sendto(cut, (at[0], at[2]))
    for named, words in ((0, "frame 1 of"), (2, "named as wrong")):
        try:
            send(named)
        except AssertionError as e:
            assert words in str(e), e
        else:
            raise AssertionError(f"{named} are named and one is sent: that was not found")
    send(1)
