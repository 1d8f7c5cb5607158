"""MCode from outside: a party line on a pseudo-terminal, driven as by hand; a program that curl stores and starts on the demo's drives."""
import json
import pathlib
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
