"""MCode from outside: a party line on a pseudo-terminal, driven as by hand; a program that curl stores and starts on the demo's drives."""
import contextlib
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import time

from harness import Gateway, Port, Process, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def test_a_party_line_driven_by_hand(folder):
    with Process("twin", "mcode", "--line", f"pty:{folder / 'party'}", "--address", "a", "--address", "b"):
        with Port(folder / "party") as port:
            assert port.ask(b"aPR P\n") == b"", "silent until the first line feed"
            port.ask(b"\n")
            said = port.ask(b"aPR DN\n", lambda got: b">" in got)
            assert b'"a"' in said or b"\na" in said or b"a\r" in said, said
            port.ask(b"aEM=1\n")
            port.ask(b"bEM=1\n")
            assert b"0" in port.ask(b"aPR P\n", lambda got: got.endswith(b"\r\n"))
            port.ask(b"aP=1234\n")
            assert b"1234" in port.ask(b"aPR P\n", lambda got: b"1234" in got)
            assert b"1234" not in port.ask(b"bPR P\n"), "the other one has its own position"
            assert port.ask(b"cPR P\n") == b"", "nobody is called so"
            port.ask(b"aP=0\n")
            port.ask(b"aMR 51200\n")
            until(lambda: b"51200" in port.ask(b"aPR P\n", lambda got: got.endswith(b"\r\n")), 10, "the move's end")


def test_a_party_line_as_the_reference_describes_it(folder):
    """Activation, names, both shapes of answers, global commands, checksum, and the way out of party mode, byte by byte."""
    with Process("twin", "mcode", "--line", f"pty:{folder / 'party'}", "--address", "a", "--address", "b"):
        with Port(folder / "party") as port:
            def expect(sent, answer):
                got = port.ask(sent, (lambda had: len(had) >= len(answer)) if answer else None)
                assert got == answer, (sent, got, answer)
            expect(b"aPR P\n", b"")
            expect(b"\n", b"")
            expect(b"aA=5000\n", b"A=5000\r\n>")
            expect(b"aPR A\n", b"PR A\r\n5000\r\n>")
            expect(b"bPR A\n", b"PR A\r\n1000000\r\n>")
            expect(b"*A=6000\n", b"")
            expect(b"aEM=1\n", b"EM=1\r\n>")
            expect(b"bEM=2\n", b"EM=2\r\n>")
            expect(b"aPR A\n", b"\r\n6000\r\n")
            expect(b"bPR A\n", b"6000\r\n")
            expect(b"aCK=1\n", b"\r\n")
            expect(b"aPR P\x8d\n", b"\x060\xd0\r\n")
            expect(b"aPR P\x8c\n", b"\x15")
            expect(b"bMR 51200\n", b"")
            until(lambda: port.ask(b"bPR P,MV\n", lambda had: had.endswith(b"\r\n")) == b"512000\r\n", 10, "the move's end")


def test_the_rate_of_a_twin_is_its_own_after_a_restart(folder):
    with Process("twin", "mcode", "--line", f"pty:{folder / 'fast'}?baud=19200", "--address", "!"):
        with Port(folder / "fast") as port:
            end = lambda had: had.endswith(b">")
            assert port.ask(b"PR BD\r", end) == b"PR BD\r\n19\r\n>"
            assert port.ask(b"BD=96\r", end) == b"BD=96\r\n>"
            assert port.ask(b"S\r", end) == b"S\r\n>"
            assert port.ask(b"PR BD\r", end) == b"PR BD\r\n96\r\n>", "the old rate holds until the restart"
            port.ask(b"\x03")
            assert b"96" not in port.ask(b"PR BD\r"), "it speaks 9600 now, and the line 19200"


def test_a_writer_is_held_up_at_the_drives_pace(folder):
    """More than the terminal's buffers hold is not taken: the wire is slower than who writes."""
    with Process("twin", "mcode", "--line", f"pty:{folder / 'slow'}?baud=4800", "--address", "!"):
        with Port(folder / "slow") as port:
            assert port.ask(b"EM=2\r", lambda got: got.endswith(b"\n")).startswith(b"EM=2")
            os.set_blocking(port.fd, False)
            taken, most = 0, 1 << 20
            with contextlib.suppress(BlockingIOError):
                while taken < most:
                    taken += os.write(port.fd, b"' a comment of some length, which the drive reads and forgets\r" * 16)
            assert taken < most, "a megabyte within a moment, and the wire carries 480 bytes in a second"


def test_lines_that_waited_on_the_wire_reach_the_drive_one_after_the_other(folder):
    """The twin's process stands still while a program writes on: to the drive each line comes at its time on the wire, and none is lost."""
    count, rate = 300, 38400
    line = b"IC Q1".ljust(59) + b"\r"  # 15 ms on the wire: longer than the drive needs for one
    with Process("twin", "mcode", "--line", f"pty:{folder / 'slow'}?baud={rate}", "--address", "!") as twin:
        with Port(folder / "slow") as port:
            # EM=2: nothing comes back, so nobody has to read meanwhile.
            assert port.ask(b"EM=2\r", lambda got: got.endswith(b"\n")).startswith(b"EM=2")
            port.ask(b"VA Q1=0\r")
            rest = line * count
            while rest:
                rest = rest[os.write(port.fd, rest[:2000]):]
                twin.process.send_signal(signal.SIGSTOP)
                time.sleep(0.3)
                twin.process.send_signal(signal.SIGCONT)
            got = port.ask(b"PR Q1,\" \",ER\r", lambda had: had.endswith(b"\r\n"), 30)
            assert got.split() == [str(count).encode(), b"0"], got


def test_a_program_that_prints_faster_than_the_line(folder):
    text = "x" * 50
    with Process("twin", "mcode", "--line", f"pty:{folder / 'chatty'}?baud=4800", "--address", "!"):
        with Port(folder / "chatty") as port:
            end = lambda had: had.endswith(b">")
            assert port.ask(b"PR BD\r", end) == b"PR BD\r\n48\r\n>"
            for line in ("PG 1", "LB AA", f'PR "{text}"', "BR AA", "E", "PG"):
                port.ask(line.encode() + b"\r", lambda had: b"\n" in had)
            first = port.ask(b"EX AA\r", lambda had: len(had) > 400)
            assert first.count(text.encode()) >= 3, first
            port.ask(b"\x1b", seconds=3)
            port.ask(b"\r", end, 3)
            assert b"66" in port.ask(b"PR ER\r", end), "transmit buffer full"


@contextlib.contextmanager
def witness(folder, name):
    """socat between the terminal `name` and a new one, `desk`. What crossed stands in the given lists when the witness has left."""
    seen = {">": b"", "<": b""}
    log = open(folder / "witness", "wb")
    process = subprocess.Popen(["socat", "-x", f"pty,raw,echo=0,link={folder / 'desk'}", f"{folder / name},raw,echo=0"], stderr=log)
    try:
        until(lambda: (folder / "desk").exists(), 5, "the witness' terminal")
        yield seen
    finally:
        # What was written last may still be on its way through the terminals: until a while nothing more crosses.
        size, since = -1, time.monotonic()
        end = since + 5
        while since + 0.3 > time.monotonic() < end:
            if (now := (folder / "witness").stat().st_size) != size:
                size, since = now, time.monotonic()
            time.sleep(0.02)
        process.terminate()
        process.wait(5)
        log.close()
        way = None
        for row in (folder / "witness").read_text().splitlines():
            if row[:1] in "<>":
                way = row[0]
            elif row.startswith(" "):
                seen[way] += bytes.fromhex(row)


def test_a_witness_on_the_line_sees_the_bytes(folder):
    """socat stands between the twin and the terminal and writes down every byte of both directions."""
    with Process("twin", "mcode", "--line", f"pty:{folder / 'line'}", "--address", "!"):
        until(lambda: (folder / "line").exists(), 5, "the twin's terminal")
        with witness(folder, "line") as seen, Port(folder / "desk") as port:
            end = lambda had: had.endswith(b">")
            assert port.ask(b"PR P\r", end) == b"PR P\r\n0\r\n>"
            assert port.ask(b"P=77\r", end) == b"P=77\r\n>"
            assert port.ask(b"PR P\r", end) == b"PR P\r\n77\r\n>"
    assert seen[">"] == b"PR P\rP=77\rPR P\r", seen
    assert seen["<"] == b"PR P\r\n0\r\n>P=77\r\n>PR P\r\n77\r\n>", seen


def test_the_gateway_on_a_serial_line_with_a_witness(folder):
    """Real terminals from end to end: the gateway's serial line, socat in between, two drives of a party line at the other end."""
    twin = f"pty:{folder / 'party'}?baud=115200"
    with Process("twin", "mcode", "--line", twin, "--address", "a", "--address", "b"):
        until(lambda: (folder / "party").exists(), 5, "the twins' terminal")
        with witness(folder, "party") as seen:
            site = {"lines": [{"name": "rs485", "uri": f"serial:{folder / 'desk'}?baud=115200", "family": "mcode", "bitrate": 115200}],
                    "drives": [{"name": n, "line": "rs485", "address": n, "presence": "device"} for n in "ab"],
                    "axes": [{"name": n, "drive": n, "number": i, "unit": "inc", "increments_per_unit": 1} for i, n in enumerate("ab", 1)]}
            with Gateway(folder, site) as g:
                for n in "ab":
                    until(lambda: g.axis(n)["online"] and not g.axis(n)["simulated"], 15, f"drive {n} answers")
                    assert g.command(n, {"command": "enable"})["result"] == "done"
                for n, way in (("a", 10240), ("b", -20480)):
                    move = {"command": "move_relative", "position": way, "velocity": 100000, "acceleration": 500000, "deceleration": 500000}
                    assert g.command(n, move)["result"] == "done"
                    until(lambda: g.axis(n)["position_increments"] == way, 5, f"axis {n} has arrived")
                native = g.send("POST", "/drives/b/native", {"send": "PR P"}, 200)
                assert "-20480" in native["reply"], native
                with g.modbus() as m:
                    assert m.read32(2) == 10240 and m.read32(64 + 2) == -20480
                trace = g.get("/lines/rs485/trace?limit=5000")
    lines = seen[">"].split(b"\n")
    assert {line[:1] for line in lines if line} <= {b"a", b"b", b"*", b"^"}, "each line names its drive"
    assert any(line.startswith(b"aM") and b"10240" in line for line in lines), lines[:60]
    assert any(line.startswith(b"bM") and b"-20480" in line for line in lines), lines[:60]
    assert seen["<"].count(b"-20480") >= 2 and b"10240" in seen["<"]
    # What the gateway wrote down is what crossed the wire.
    for to_drive, sign in ((True, ">"), (False, "<")):
        told = b"".join(bytes.fromhex(f["data"]) for f in trace["frames"] if f["to_drive"] == to_drive)
        assert len(told) > 200 and told in seen[sign], (sign, len(told), len(seen[sign]))


def test_a_program_is_stored_started_and_stopped_by_http(folder):
    site = json.loads((TOP / "deploy/examples/demo-site.json").read_text())
    with Gateway(folder, site) as g:
        def act(name, argument="", status=200):
            return g.send("POST", "/axes/turntable/actions", {"name": name, "argument": argument}, status)
        assert g.command("turntable", {"command": "enable"})["result"] == "done"
        faulty = act("program.download", "PG 100\nLB G1\nNONSENSE 5\nE\nPG\n", 422)
        assert "3" in faulty["detail"], faulty
        text = "PG 100\nLB G1\nMR 25600\nH\nH 100\nBR G1\nE\nPG\n"
        assert act("program.download", text)["result"] == "done"
        assert "MR 25600" in act("program.list")["text"]
        act("program.start", "G1")
        first = g.axis("turntable")["position_increments"]
        until(lambda: g.axis("turntable")["position_increments"] > first + 60000, 10, "the program moves the axis")
        assert g.command("turntable", {"command": "quick_stop"})["result"] == "done"
        rest = g.axis("turntable")["position_increments"]
        time.sleep(0.6)
        assert g.axis("turntable")["position_increments"] == rest, "the stop ended the program as well"
        with g.modbus() as m:
            assert m.read32((7 - 1) * 64 + 2) == rest and m.read((7 - 1) * 64 + 15, 1)[0] == 2
            assert m.read((6 - 1) * 64 + 9, 1)[0] & 0x07 == 3, "the other drive of the line is online and simulated"
        recording = g.get("/lines/rs485/trace?limit=300")
        code, out, err = run("decode", "mcode", "--format", "trace", stdin=json.dumps(recording))
        assert code == 0 and len(out.splitlines()) > 20, (out[:300], err)


def test_user_variables_are_parameters_mapped_kept_and_told(folder):
    site = {"lines": [{"name": "rs485", "uri": "twin", "family": "mcode", "bitrate": 115200}],
            "drives": [{"name": "table", "line": "rs485", "address": "a", "presence": "twin", "options": {"variables": "Q1:mm,K2"}}],
            "axes": [{"name": "table", "drive": "table", "number": 1, "unit": "mm", "increments_per_unit": 1000}],
            "mappings": [{"unit": 2, "address": 0, "axis": "table", "point": "UV.Q1", "type": "i32"}]}
    with Gateway(folder, site) as g:
        until(lambda: g.axis("table")["online"], 15, "the drive")
        missing = g.send("PUT", "/axes/table/parameters/UV.Q1", {"value": 5}, 409)
        assert "has no user variable Q1 now" in missing["detail"], missing
        told = until(lambda: [e for e in g.get("/events?limit=200") if e["kind"] == "variables"], 10, "the event about what the drive lacks")
        assert "Q1, K2" in told[0]["text"], told
        for line in ("VA Q1=5", "VA K2=-3"):
            g.send("POST", "/drives/table/native", {"send": line})
        assert g.get("/axes/table/parameters/UV.Q1")["value"] == 5
        listed = {p["id"]: p for p in g.get("/axes/table/parameters")}
        assert listed["UV.Q1"]["unit"] == "mm" and listed["UV.K2"]["access"] == "RW", listed["UV.Q1"]
        assert not any(p["id"].startswith("UV.") for p in g.get("/families/mcode/parameters"))
        with g.modbus() as m:
            m.write(0, [0xFFFF, 0xFFD6], unit=2)
            assert "-42" in g.send("POST", "/drives/table/native", {"send": "PR Q1"})["reply"]

            def read():
                with contextlib.suppress(Exception):
                    return m.read32(0, unit=2)
            until(lambda: read() == -42, 5, "the register shows the variable")
            # The parameter channel of the standard map numbers it behind the family's own.
            selector = listed["UV.K2"]["selector"]
            m.write(48, [selector >> 16, selector & 0xFFFF, 1])
            until(lambda: m.read(51, 1) == [2], 5, "the channel has read it")
            assert m.read32(52) == -3
        n = g.send("POST", "/axes/table/snapshots", {"name": "with variables"}, 201)["n"]
        kept = {p["parameter"]: p["value"] for p in g.get(f"/axes/table/snapshots/{n}")["parameters"]}
        assert kept["UV.Q1"] == -42 and kept["UV.K2"] == -3, kept
        g.send("PUT", "/axes/table/parameters/UV.Q1", {"value": 1})
        g.send("POST", f"/axes/table/snapshots/{n}/restore", {"parameters": ["UV.Q1"], "include_live": True})
        until(lambda: "-42" in g.send("POST", "/drives/table/native", {"send": "PR Q1"})["reply"], 10, "the variable is back")
        wrong = g.send("PATCH", "/drives/table", {"options": {"variables": "VM"}}, 422)
        assert "VM is no user variable" in json.dumps(wrong), wrong
        wrong = g.send("PATCH", "/drives/table", {"options": {"variables": "K2"}}, 422)
        assert "no point UV.Q1" in json.dumps(wrong), "a mapping needs it: " + json.dumps(wrong)


def test_a_program_is_edited_in_part(folder):
    site = {"lines": [{"name": "rs485", "uri": "twin", "family": "mcode", "bitrate": 19200}],
            "drives": [{"name": "table", "line": "rs485", "address": "a", "presence": "twin"}],
            "axes": [{"name": "table", "drive": "table", "number": 1, "unit": "mm", "increments_per_unit": 1000}]}
    with Gateway(folder, site) as g:
        until(lambda: g.axis("table")["online"], 15, "the drive")

        def act(name, argument="", status=200):
            return g.send("POST", "/axes/table/actions", {"name": name, "argument": argument}, status)
        act("program.download", "PG 1\nLB G1\nR1=1\nE\nLB K1\nR2=1\nRT\nPG\n")
        fault = act("program.edit", "K1\nLB K1\nNONSENSE\n", 422)
        assert "line 3" in fault["detail"] and "nothing was changed" in fault["detail"], fault
        assert act("program.edit", "K1\nLB K1\nR2=7\nR3=8\nRT\n")["result"] == "done"
        assert act("program.upload")["value"].split("\n")[:-1] == ["LB G1", "R1=1", "E", "LB K1", "R2=7", "R3=8", "RT"]


def test_the_hand_of_a_moving_twin_is_as_it_is_now(folder):
    """Nobody asks the drive over its line meanwhile."""
    with Process("twin", "mcode", "--line", f"pty:{folder / 'one'}", "--address", "!", "--hand", "127.0.0.1:0") as twin:
        with Port(folder / "one") as port:
            def place():
                host, at = twin.word("hand").rsplit(":", 1)
                c = http.client.HTTPConnection(host, int(at), timeout=5)
                c.request("GET", "/hand")
                return json.loads(c.getresponse().read())["position"]
            assert place() == 0
            port.ask(b"SL 51200\r", lambda got: got.endswith(b">"))
            first = until(lambda: place() or None, 5, "it has moved")
            until(lambda: place() > first, 5, "and moves on")


def over_ethernet(folder, twin_uri, scheme):
    with Process("twin", "mcode", "--line", twin_uri, "--option", "ethernet=true") as drive:
        if scheme == "tcp":
            port = re.search(r"127\.0\.0\.1:(\d+)", drive.ready).group(1)
        else:
            port = twin_uri.rsplit(":", 1)[1]
        site = {"lines": [{"name": "lan", "uri": f"{scheme}:127.0.0.1:{port}", "family": "mcode", "options": {"ethernet": "on"}}],
                "drives": [{"name": "lexium", "line": "lan", "address": "!", "presence": "device"}],
                "axes": [{"name": "lift", "drive": "lexium", "channel": 1, "number": 1, "unit": "mm", "increments_per_unit": 1000}]}
        with Gateway(folder, site) as g:
            until(lambda: g.axis("lift")["online"] and not g.axis("lift")["simulated"], 15, "the drive serves over " + scheme)
            assert g.command("lift", {"command": "enable"})["result"] == "done"
            move = {"command": "move_absolute", "position": 25.6, "velocity": 100, "acceleration": 1000, "deceleration": 1000}
            assert g.command("lift", move)["result"] == "done"
            assert g.axis("lift")["position_increments"] == 25600

            def act(name, argument="", status=200):
                return g.send("POST", "/axes/lift/actions", {"name": name, "argument": argument}, status)
            time.sleep(1.3)  # MV stays on for MT and HT, one second from the factory
            assert act("program.download", "PG 1\nLB G1\nMR 1000\nH\nE\nPG\n")["result"] == "done"
            assert "MR 1000" in act("program.list")["text"]
            g.command("lift", {"command": "move_velocity", "velocity": 50})
            until(lambda: g.axis("lift")["position_increments"] > 30000, 10, "it runs")
            assert g.command("lift", {"command": "quick_stop"})["result"] == "done"
            first = g.axis("lift")["position_increments"]
            time.sleep(0.4)
            assert g.axis("lift")["position_increments"] == first
            drive.stop()
            until(lambda: not g.axis("lift")["online"], 15, "the loss of the drive is seen over " + scheme)


def test_mcode_over_tcp_with_one_drive(folder):
    over_ethernet(folder, "tcp-listen:127.0.0.1:0", "tcp")


def test_mcode_over_udp_with_one_drive(folder):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        port = s.getsockname()[1]
    over_ethernet(folder, f"udp-listen:127.0.0.1:{port}", "udp")
