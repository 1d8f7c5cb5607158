"""Modbus RTU from outside: mbpoll and libmodbus over a pseudo-terminal; a shared line with garbage, strangers and echoes; a port that comes late.

In: the real program. Out: judgements on bytes, registers, events, metrics. Never sleeps longer than a line's silence or an answer's absence.
"""
import ctypes
import ctypes.util
import os
import pathlib
import select
import struct
import subprocess
import time
import tty

from harness import DEMO, Gateway, until

BAUD = "115200"
SETTINGS = ["--set", f"modbus_rtu.baud={BAUD}", "--set", "modbus_rtu.format=8N1"]


def crc(data):
    value = 0xFFFF
    for b in data:
        value ^= b
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return struct.pack("<H", value)


def sealed(address, pdu):
    body = bytes([address]) + pdu
    return body + crc(body)


READING = bytes.fromhex("030000000A")


class Wire:
    """The master's end of a line: a pseudo-terminal whose other end has the name of a port. What is plugged in can be pulled out."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.fd = None

    def plug(self):
        self.fd, far = os.openpty()
        tty.setraw(self.fd)
        tty.setraw(far)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(far))
        self.far = far
        return self

    def pull(self):
        for fd in (self.far, self.fd):
            os.close(fd)
        self.path.unlink(missing_ok=True)
        self.fd = None

    def read(self, seconds, enough=1 << 16):
        got, end = b"", time.monotonic() + seconds
        while len(got) < enough and (left := end - time.monotonic()) > 0:
            if select.select([self.fd], [], [], left)[0]:
                got += os.read(self.fd, 512)
        return got

    def say(self, data):
        os.write(self.fd, data)

    def ask(self, address, pdu, size):
        """An answer of `size` bytes in all, its checksum judged; after the silence that a master keeps."""
        time.sleep(0.004)
        self.say(sealed(address, pdu))
        got = self.read(5, size)
        assert len(got) == size and crc(got[:-2]) == got[-2:], (pdu.hex(), got.hex())
        return got

    def __enter__(self):
        return self.plug()

    def __exit__(self, *_):
        if self.fd is not None:
            self.pull()


def rtu_gateway(folder, port, *more, site=DEMO):
    return Gateway(folder, site, "--set", f"modbus_rtu.port={port}", *SETTINGS, *more)


def metric(gateway, name):
    for line in gateway.request("GET", "/metrics")[1].decode().splitlines():
        if line.startswith(name + " "):
            return float(line.split()[1])
    raise AssertionError(f"no {name}")


def test_mbpoll_reads_and_writes_over_a_serial_line(folder):
    port = folder / "rtu"
    with rtu_gateway(folder, f"pty:{port}", "--set", "lines.pty_dir=/nowhere") as g:
        def mbpoll(*arguments, address="1"):
            p = subprocess.run(["mbpoll", "-m", "rtu", "-b", BAUD, "-P", "none", "-B", "-0", "-1", "-q", "-o", "1", "-a", address, *arguments[:-1], str(port), *arguments[-1]],
                               capture_output=True, text=True, timeout=30)
            return p.returncode, p.stdout + p.stderr
        assert g.word("modbus_rtu") == f"pty:{port}"
        assert {"name": "modbus_rtu", "address": f"pty:{port}"} in g.get("/about")["doors"]
        code, out = mbpoll("-t", "4", "-r", "0", "-c", "20", [])
        assert code == 0 and "[15]:" in out, out
        code, out = mbpoll("-t", "3", "-r", "0", "-c", "20", [])
        assert code == 0 and "[19]:" in out, out
        code, out = mbpoll("-t", "0", "-r", "0", "-c", "32", [])
        assert code == 0 and "[31]:" in out, out
        # The axis of the twin is brought to life and moves, as over TCP.
        for register, value in ((33, 1), (32, 6), (32, 7), (32, 15)):
            code, out = mbpoll("-t", "4", "-r", str(register), [str(value)])
            assert code == 0 and "Written 1" in out, (register, out)
        code, out = mbpoll("-t", "4:int", "-r", "34", ["6400", "3200"])
        assert code == 0 and "Written 2" in out, out
        code, out = mbpoll("-t", "4", "-r", "32", ["31"])
        assert code == 0 and "Written 1" in out, out
        until(lambda: g.get("/axes/feeder")["position_increments"] == 6400, 20, "the motion")
        # The site's unit 2 stands under its number; nobody answers for 9.
        code, out = mbpoll("-t", "4:int", "-r", "0", "-c", "1", [], address="2")
        assert code == 0 and "6400" in out, out
        code, out = mbpoll("-t", "4", "-r", "0", "-c", "1", [], address="9")
        assert code != 0 and "timed out" in out, out
        code, out = mbpoll("-t", "4", "-r", "0", ["1"])
        assert "Illegal data address" in out, out
        report = g.get("/modbus")
        mine = [c for c in report["connections"] if c["peer"] == f"pty:{port}"]
        assert len(mine) == 1 and mine[0]["requests"] >= 9 and mine[0]["writes"] >= 6 and mine[0]["exceptions"] == 1, report
        assert metric(g, "axisgate_modbus_rtu_foreign_frames_total") >= 1 and metric(g, "axisgate_modbus_rtu_bad_frames_total") == 0


class LibModbus:
    def __init__(self, port, address):
        self.lib = ctypes.CDLL(ctypes.util.find_library("modbus") or "libmodbus.so.5", use_errno=True)
        self.lib.modbus_new_rtu.restype = ctypes.c_void_p
        self.lib.modbus_new_rtu.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_char, ctypes.c_int, ctypes.c_int]
        self.lib.modbus_strerror.restype = ctypes.c_char_p
        self.c = ctypes.c_void_p(self.lib.modbus_new_rtu(str(port).encode(), int(BAUD), b"N", 8, 1))
        self.lib.modbus_set_response_timeout(self.c, 3, 0)
        assert self.lib.modbus_set_slave(self.c, address) == 0 and self.lib.modbus_connect(self.c) == 0

    def call(self, name, *arguments):
        ctypes.set_errno(0)
        n = getattr(self.lib, "modbus_" + name)(self.c, *arguments)
        return n if n >= 0 else self.lib.modbus_strerror(ctypes.get_errno()).decode()

    def read(self, address, count, name="read_registers"):
        out = (ctypes.c_uint16 * count)()
        n = self.call(name, address, count, out)
        return list(out) if n == count else n

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lib.modbus_close(self.c)
        self.lib.modbus_free(self.c)


def test_libmodbus_is_served_as_over_tcp(folder):
    port = folder / "rtu"
    with rtu_gateway(folder, f"pty:{port}?baud={BAUD}&format=8N1", "--set", "modbus_rtu.unit=17") as g, g.modbus() as tcp, LibModbus(port, 17) as rtu:
        over_rtu, over_tcp = rtu.read(0, 125), tcp.read(0, 125)
        changes = {12, 13, 14, 76, 77, 78}  # ages and heartbeats
        assert [v for i, v in enumerate(over_rtu) if i not in changes] == [v for i, v in enumerate(over_tcp) if i not in changes]
        assert rtu.read(0, 20, "read_input_registers")[1:12] == over_rtu[1:12]
        bits = (ctypes.c_uint8 * 64)()
        assert rtu.call("read_bits", 0, 64, bits) == 64 and rtu.call("read_input_bits", 0, 64, bits) == 64
        assert sum(bits[i] << i for i in range(16)) == rtu.read(9, 1)[0]
        values = (ctypes.c_uint16 * 2)(0x0001, 0x86A0)
        assert rtu.call("write_registers", 36, 2, values) == 2 and rtu.read(36, 2) == [1, 0x86A0]
        assert rtu.call("write_register", 44, 35) == 1 and rtu.read(44, 1) == [35]
        assert rtu.call("write_register", 44, 35) == 1 and rtu.call("write_register", 44, 35) == 1, "the same again is no echo here"
        assert rtu.call("mask_write_register", 44, 0xFFF0, 0x0001) == 1 and rtu.read(44, 1) == [33]
        into = (ctypes.c_uint16 * 1)()
        assert rtu.call("write_and_read_registers", 44, 1, (ctypes.c_uint16 * 1)(37), 44, 1, into) == 1 and into[0] == 37
        assert "Illegal data address" in rtu.call("write_register", 0, 1)
        assert "Illegal data value" in rtu.call("write_register", 34, 1), "half of a value"
        who = (ctypes.c_uint8 * 256)()
        n = rtu.call("report_slave_id", 256, who)
        assert n > 2 and b"axisgate" in bytes(who)[:n]
        for _ in range(50):
            assert rtu.read(18, 2) == over_rtu[18:20]
        assert metric(g, "axisgate_modbus_rtu_up") == 1 and metric(g, "axisgate_modbus_rtu_bad_frames_total") == 0


def test_garbage_strangers_and_broadcasts_on_a_shared_line(folder):
    with Wire(folder / "tty") as wire, rtu_gateway(folder, folder / "tty") as g:
        until(lambda: metric(g, "axisgate_modbus_rtu_up") == 1, 10, "the port")
        good = wire.ask(1, READING, 25)
        silent = [sealed(1, READING)[:-1] + b"\x00",                      # wrong checksum
                  sealed(1, READING)[:5],                                # half a frame
                  sealed(1, READING)[5:],                                # and its other half, too late
                  b"\x01", b"\x00" * 3, bytes(range(256)) * 3,           # noise, and more than a frame can hold
                  sealed(7, READING), sealed(7, b"\x03\x14" + bytes(20)),  # another slave's request and its answer
                  sealed(255, READING), sealed(248, READING),            # no slave has these
                  sealed(0, READING), sealed(0, b"\x63"),                # broadcasts that ask
                  sealed(1, READING) + sealed(1, READING)]               # two requests without a silence between them
        for data in silent:
            wire.say(data)
            assert wire.read(0.08) == b"", data.hex()
            assert wire.ask(1, READING, 25)[:9] == good[:9], data.hex()
        # A broadcast is carried out, and nobody answers it.
        wire.say(sealed(0, bytes.fromhex("06002C0023")))
        assert wire.read(0.3) == b""
        assert wire.ask(1, bytes.fromhex("03002C0001"), 7)[3:5] == b"\x00\x23"
        wire.say(sealed(0, bytes.fromhex("10002400020400000BB8")))
        assert wire.read(0.3) == b""
        assert wire.ask(1, bytes.fromhex("0300240002"), 9)[3:7] == b"\x00\x00\x0b\xb8"
        # In pieces, as a slow or busy adapter hands them on.
        data = sealed(1, READING)
        for i in range(0, len(data), 2):
            wire.say(data[i:i + 2])
        assert len(wire.read(2, 25)) == 25
        assert metric(g, "axisgate_modbus_rtu_foreign_frames_total") == 4 and metric(g, "axisgate_modbus_rtu_overlong_frames_total") == 1
        assert metric(g, "axisgate_modbus_rtu_broadcasts_total") == 4 and metric(g, "axisgate_modbus_rtu_bad_frames_total") >= 5


def test_what_the_port_gives_back_is_not_asked_again(folder):
    with Wire(folder / "tty") as wire, rtu_gateway(folder, folder / "tty") as g:
        until(lambda: metric(g, "axisgate_modbus_rtu_up") == 1, 10, "the port")
        for pdu, size in ((READING, 25), (bytes.fromhex("06002C0023"), 8), (READING, 25), (bytes.fromhex("0800001234"), 8)):
            for _ in range(3):
                answer = wire.ask(1, pdu, size)
                wire.say(answer)  # the two-wire port's own receiver
                assert wire.read(0.1) == b"", pdu.hex()
        assert metric(g, "axisgate_modbus_rtu_echoes_total") == 12 and metric(g, "axisgate_modbus_rtu_requests_total") == 12


def test_two_gateways_on_one_line(folder):
    (folder / "a").mkdir()
    (folder / "b").mkdir()
    moved = {**DEMO, "axes": [{**DEMO["axes"][1], "number": 1, "drive": "slide"}], "mappings": []}
    with Wire(folder / "tty1") as one, Wire(folder / "tty2") as two, rtu_gateway(folder / "a", folder / "tty1") as a, \
            rtu_gateway(folder / "b", folder / "tty2", "--set", "modbus_rtu.unit=3", site=moved) as b:
        for g in (a, b):
            until(lambda g=g: metric(g, "axisgate_modbus_rtu_up") == 1, 10, "the port")

        def ask(address, pdu, size):
            """Both hear the master, and each the other's answer."""
            time.sleep(0.004)
            for w in (one, two):
                w.say(sealed(address, pdu))
            asked, other = (one, two) if address == 1 else (two, one)
            got = asked.read(5, size)
            other.say(got)
            assert len(got) == size and got[0] == address, got.hex()
            assert other.read(0.05) == b"", "the other one is silent"
            return got
        for _ in range(5):
            ask(1, READING, 25)
            ask(3, READING, 25)
        ask(1, bytes.fromhex("06002C0021"), 8)
        ask(3, bytes.fromhex("06002C0022"), 8)
        assert ask(1, bytes.fromhex("03002C0001"), 7)[4] == 0x21 and ask(3, bytes.fromhex("03002C0001"), 7)[4] == 0x22
        for w in (one, two):
            w.say(sealed(0, bytes.fromhex("06002C0023")))
        assert one.read(0.2) == b"" and two.read(0.05) == b""
        assert ask(1, bytes.fromhex("03002C0001"), 7)[4] == 0x23 and ask(3, bytes.fromhex("03002C0001"), 7)[4] == 0x23


def test_a_port_that_comes_late_and_is_pulled_out(folder):
    wire = Wire(folder / "tty")
    with rtu_gateway(folder, wire.path) as g:
        def said(text):
            return [e for e in g.get("/events?kind=modbus_rtu") if text in e["text"]]
        until(lambda: said("No such file"), 10, "word of the port that is not there")
        assert metric(g, "axisgate_modbus_rtu_up") == 0
        assert g.get("/about")["doors"], "the other doors serve"
        for turn in (1, 2):
            wire.plug()
            until(lambda: metric(g, "axisgate_modbus_rtu_up") == 1, 10, "the port")
            assert len(said("is open")) == turn
            wire.ask(1, bytes.fromhex("06002C0023"), 8)
            wire.pull()
            until(lambda: metric(g, "axisgate_modbus_rtu_up") == 0, 10, "the port pulled out")
        assert len(said("is shut")) == 3, [e["text"] for e in said("")]
        assert g.process.poll() is None


def test_a_master_that_moves_an_axis_and_falls_silent_or_is_pulled_out_is_lost(folder):
    wire = Wire(folder / "tty").plug()
    with rtu_gateway(folder, wire.path, "--set", "modbus.watchdog_ms=600") as g:
        until(lambda: metric(g, "axisgate_modbus_rtu_up") == 1, 10, "the port")

        def run():
            for word in ("060021" + "0003", "060020" + "0006", "060020" + "0007", "060020" + "000F"):
                wire.ask(1, bytes.fromhex(word), 8)
            wire.ask(1, bytes.fromhex("10002A000204" + "00002EE0"), 8)
            until(lambda: g.axis()["velocity"] > 1, 5, "speed")
        run()
        holder = g.get("/axes/feeder/authority")
        assert f"modbus {wire.path}"[:60] in str(holder), holder
        begun = time.monotonic()
        while time.monotonic() < begun + 1.2:  # any request keeps the master alive
            wire.ask(1, bytes.fromhex("03000E0001"), 7)
            time.sleep(0.1)
        assert g.axis()["moving"]
        until(lambda: not g.axis()["moving"], 5, "the watchdog's halt")
        assert [e for e in g.get("/events?kind=fail_safe") if e["axis"] == "feeder"]
        assert wire.ask(1, bytes.fromhex("0300160001"), 7)[4] == 2, "cause 2: silent"
        run()
        wire.pull()
        until(lambda: not g.axis()["moving"], 5, "the halt of a lost master")
        with g.modbus() as m:
            assert m.read(22, 1)[0] == 1, "cause 1: closed"
