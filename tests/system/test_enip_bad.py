"""What an EtherNet/IP owner does not notice: sessions that are never finished, data that are not its own; and what ends it: another mapping.

In: the real program, one owner that moves an axis. Out: no time-out of the owner, drops that are counted by their cause, a close with its cause.
"""
import re
import resource
import socket
import struct
import time

from harness import until
from test_enip import Originator, device, statusword


def metric(g, name):
    text = g.request("GET", "/metrics")[1].decode()
    return int(re.search(rf"^axisgate_enip_{name} (\d+)$", text, re.M).group(1))


def enable(o):
    for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
        o.write(word)
        until(lambda: statusword(o.inputs()) & 0x6F == state, what=f"state {state:#x}")


def test_ten_thousand_half_open_sessions_do_not_stop_the_owner(folder):
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    at_a_time = min(1000, (hard if hard != resource.RLIM_INFINITY else 4096) - 200)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, at_a_time + 200), hard))
    with device(folder) as (g, at), Originator(*at) as o:
        assert o.open(151, 101) == (0, ())
        o.start()
        enable(o)
        g.traffic.expect_pieces(b"\x65")
        begun, opened, o.longest_s = time.monotonic(), 0, 0.0
        while opened < 10_000:
            crowd = []
            for n in range(at_a_time):
                s = socket.socket()
                s.setblocking(False)
                s.connect_ex(at[:2])
                crowd.append(s)
                if n % 50 == 0:
                    o.inputs()
            for n, s in enumerate(crowd):
                if n % 3:
                    try:  # a piece of a header, or an order without a session
                        s.send(b"\x65" if n % 3 == 1 else struct.pack("<HHII8sI", 0x6F, 0, 0, 0, b"nobody  ", 0))
                    except OSError:
                        pass
            opened += len(crowd)
            for s in crowd:
                s.close()
        assert 0 < o.longest_s < 0.5, f"{o.longest_s:.3f} s without data"
        assert statusword(o.inputs()) & 0x6F == 0x27
        target = struct.unpack("<i", o.inputs()[4:8])[0] + 320
        o.write(0x0F, 1, target, 3200)
        time.sleep(0.05)
        o.write(0x1F, 1, target, 3200)
        until(lambda: struct.unpack("<i", o.inputs()[4:8])[0] == target, what="the target")
        assert metric(g, "connection_timeouts_total") == 0
        assert metric(g, "sessions_total") > 1000, "they did come"
        print(f"{opened} sessions in {time.monotonic() - begun:.1f} s, {metric(g, 'sessions_evicted_total')} gave way, longest {1000 * o.longest_s:.0f} ms between inputs")


def test_data_of_others_old_ones_and_wrong_sizes_are_dropped_and_counted(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        host, _, io_port = at
        assert o.open(151, 101, rpi_us=100_000) == (0, ())

        def send(sequence, word, size=32, connection=None, source=None):
            body = struct.pack("<HIH", sequence & 0xFFFF, 1, word) + bytes(size - 2)
            frame = struct.pack("<HHHIIHH", 2, 0x8002, 8, o.id if connection is None else connection, sequence, 0xB1, len(body)) + body
            (source or o.udp).sendto(frame, (host, io_port))
        names = ("received_total", "from_wrong_address_total", "stale_total", "wrong_size_total", "unknown_total")

        def counts():
            return [metric(g, "implicit_" + n) for n in names]
        send(10, 0)
        until(lambda: counts() == [1, 0, 0, 0, 0], what="the first datagram")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.2", 0))
            send(11, 0x06, source=other)
            until(lambda: counts() == [1, 1, 0, 0, 0], what="one of another address")
        send(10, 0x06)
        send(9, 0x06)
        send(0x8000000A, 0x06)  # half way round is behind
        until(lambda: counts() == [1, 1, 3, 0, 0], what="three old ones")
        send(12, 0x06, size=31)
        send(12, 0x06, size=33)
        until(lambda: counts() == [1, 1, 3, 2, 0], what="two of a wrong size")
        send(12, 0x06, connection=o.id ^ 0x10000)
        g.traffic.expect_bad(b"\x02")
        o.udp.sendto(b"\x02", (host, io_port))
        until(lambda: counts() == [1, 1, 3, 2, 2], what="two of no connection")
        commands = metric(g, "commands_total")
        assert commands == 1, "the first image is handed on whole; none of the others was a command"
        send(12, 0x06)
        until(lambda: metric(g, "commands_total") == 2, what="the owner's own")


def test_another_number_of_its_axis_closes_an_open_connection_and_says_why(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        assert o.open(151, 101) == (0, ())
        o.start()
        enable(o)
        o.write(0x0F, 3, 0, 3200)
        time.sleep(0.1)
        struct.pack_into("<i", o.output, 20, 3200)
        until(lambda: g.get("/axes/feeder")["moving"], what="the motion")
        g.send("PATCH", "/axes/feeder", {"number": 7}, 200)
        until(lambda: "closed by the gateway: the site was changed" in str(g.get("/events?limit=50")), what="the cause")
        until(lambda: not g.get("/axes/feeder")["moving"], what="the stop")
        until(lambda: metric(g, "implicit_unknown_total") > 0, what="data for a connection that is no more")
        o.stop()
        assert metric(g, "connection_timeouts_total") == 0, "it was closed and not lost"
        o.udp.setblocking(False)
        time.sleep(0.1)
        while True:
            try:
                o.udp.recv(2048)
            except BlockingIOError:
                break
        time.sleep(0.1)
        try:
            assert not o.udp.recv(2048), "the device goes on sending"
        except BlockingIOError:
            pass
        assert o.open(157, 107, serial=2) == (0, ()), "a new one by the new number"
        with Originator(*at) as second:
            # A key of a device that this one is not: its revision is the device's own, whatever its site.
            key = struct.pack("<BBHHHBB", 0x34, 4, 0xFFFF, 0x0C, 1, 78, 172)
            assert second.open(152, 102, serial=3, path_head=key) == (1, (0x0116,))
