"""Few descriptors: crowds of silent clients at each door, and that a stop over HTTP gets through all the same.

In: the program under a soft and a hard limit of open files of its own. Out: what it says of its limits, stops that work.
"""
import contextlib
import resource
import socket

import harness
from harness import DEMO, Gateway


class Limited(Gateway):
    """A gateway that was started with few descriptors."""

    def __init__(self, folder, soft, hard, *more):
        with_limit = folder / "limited"
        with_limit.write_text(f"#!/bin/sh -e\nulimit -Sn {soft}\nulimit -Hn {hard}\nexec {harness.PROGRAM} \"$@\"\n")
        with_limit.chmod(0o755)
        program, harness.PROGRAM = harness.PROGRAM, str(with_limit)
        try:
            super().__init__(folder, DEMO, *more)
        finally:
            harness.PROGRAM = program


@contextlib.contextmanager
def crowd(address, n, first=2):
    """Silent clients, as from several machines: so many that no share of one address is the bound."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, max(soft, n + 300)), hard))
    clients = []
    try:
        for i in range(n):
            s = socket.socket()
            s.settimeout(5)
            s.bind((f"127.0.0.{first + i % 8}", 0))
            try:
                s.connect(address)
                clients.append(s)
            except OSError:
                s.close()
        yield clients
    finally:
        for s in clients:
            s.close()
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def stops(g):
    done = 0
    for _ in range(5):
        with contextlib.suppress(OSError):
            status, body, _ = g.request("POST", "/api/v1/axes/feeder/commands", {"command": "quick_stop"})
            done += status == 200
    return done


def test_1100_silent_modbus_clients_leave_http_its_stops(folder):
    with Limited(folder, 1024, 1024) as g:
        limits = f"/proc/{g.process.pid}/limits"
        assert "1024" in [x for x in open(limits) if x.startswith("Max open files")][0].split()
        told = [x for x in g.errors().splitlines() if "1024 open files" in x]
        assert told and "[modbus] max_connections is 426 instead of 1024" in told[0], g.errors()
        g.command("feeder", {"command": "enable"})
        with crowd(("127.0.0.1", g.modbus_port), 1100):
            assert stops(g) == 5
            text = g.request("GET", "/metrics")[1].decode()
            assert int([x for x in text.splitlines() if x.startswith("axisgate_modbus_connections ")][0].split()[1]) <= 426


def test_silent_clients_at_every_door_leave_http_its_stops(folder):
    with Limited(folder, 400, 400) as g:
        g.command("feeder", {"command": "enable"})
        enip = g.word("enip").rsplit(":", 1)
        with crowd(("127.0.0.1", g.modbus_port), 150), crowd((enip[0], int(enip[1])), 300, 12), crowd((g.http[0], int(g.http[1])), 150, 22):
            assert stops(g) == 5


def test_a_soft_limit_is_raised_to_the_hard_one(folder):
    with Limited(folder, 256, 4096) as g:
        line = [x for x in open(f"/proc/{g.process.pid}/limits") if x.startswith("Max open files")][0].split()
        assert line[3:5] == ["4096", "4096"], line
        assert "open files" not in g.errors(), g.errors()
