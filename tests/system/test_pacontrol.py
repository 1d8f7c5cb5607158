"""PA-CONTROL from outside: the manual's frames over a pseudo-terminal, byte for byte; four axes of the demo site; decoding a recording."""
import json
import pathlib
import struct
import termios
import time

from harness import Gateway, Port, Process, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def printed_frames():
    """(request, reply) of the cases of chapter 3.4 that need no state but the registers set before them."""
    pairs, request, section = [], None, False
    for line in (TOP / "adapters/pacontrol/vectors.txt").read_text().splitlines():
        if line.startswith("# Frames that the manual prints byte for byte"):
            section = True
        elif section and line.startswith("# ---"):
            break
        words = line.split()
        if not section or not words:
            continue
        if words[0] == "case":
            name, state, request = words[1], False, None
        elif words[0] == "state":
            state = True
        elif words[0] == ">":
            side = "request"
        elif words[0] in ("<", "<~", "poll>"):
            side = "reply" if words[0] == "<" else "other"
        elif words[0] == "bytes":
            data = bytes.fromhex("".join(words[1:]))
            if side == "request":
                request = data
            elif side == "reply" and request and not state and request[2:4] in (b"09", b"19"):
                pairs.append((name, request, data))
                request = None
    return pairs


def whole(got):
    return got.endswith(b"\x04")


def framed(text):
    """A request with its check: the exclusive or of the text's bytes, decimal."""
    check = 0
    for b in text.encode():
        check ^= b
    return b"\x01\x02" + text.encode() + b"\x03" + str(check).encode() + b"\x04"


def text_of(reply):
    assert reply.startswith(b"\x01\x02") and reply.endswith(b"\x04"), reply
    text, check = reply[2:-1].split(b"\x03")
    value = 3
    for b in text:
        value ^= b
    assert int(check) == value, reply
    return text.decode()


def test_the_manuals_frames_over_a_pseudo_terminal(folder):
    pairs = printed_frames()
    assert len(pairs) >= 2, pairs
    with Process("twin", "pacontrol", "--line", f"pty:{folder / 'com1'}"):
        with Port(folder / "com1", termios.CS7) as port:
            for name, request, reply in pairs:
                assert port.ask(request, whole) == reply, name
            # the sequence of chapter 3.4: into ONLINE, move axis 2, poll until the end of processing
            assert text_of(port.ask(framed("0603;0;0;0"), whole)) == "0;1;31;0;0;0"
            first = text_of(port.ask(framed("0A87;2;1;552.0"), whole)).split(";")
            assert first[:5] == ["0", "0", "31", "0", "1"], first
            positions = [float(first[5])]
            for _ in range(200):
                answer = text_of(port.ask(b"\x04", whole)).split(";")
                positions.append(float(answer[5]))
                if answer[1] == "1":
                    break
                time.sleep(0.05)
            assert answer[1] == "1" and answer[5] == "552.0000", answer
            assert positions == sorted(positions) and len(set(positions)) > 5, positions
            assert text_of(port.ask(framed("1900;5;0;0").replace(b"\x036\x04", b"\x039\x04"), whole)).startswith("16;"), "a wrong check is told"
            assert text_of(port.ask(b"\x01\x02190" + framed("1906;5;0;0"), whole)) == "0;1;31;0;0;12345", "a frame inside a frame begins anew"


def test_four_axes_of_the_demo_site(folder):
    site = json.loads((TOP / "deploy/examples/demo-site.json").read_text())
    with Gateway(folder, site) as g:
        for axis in ("portal.x", "portal.y"):
            assert g.command(axis, {"command": "enable"})["result"] == "done"
        assert g.command("portal.x", {"command": "home"}, wait=40)["result"] == "done"
        for axis, target in (("portal.x", 30), ("portal.y", -20)):
            assert g.command(axis, {"command": "move_absolute", "position": target, "velocity": 20, "acceleration": 100, "deceleration": 100}, wait=0)["result"] == "accepted"
        until(lambda: g.axis("portal.x")["moving"] and g.axis("portal.y")["moving"], 5, "both move at once")
        until(lambda: g.axis("portal.x")["target_reached"] and g.axis("portal.y")["target_reached"], 15, "both are there")
        with g.modbus() as m:
            for number, position in ((2, 30000), (3, -20000), (4, 0), (5, 0)):
                base = (number - 1) * 64
                until(lambda: m.read32(base + 2) == position, 5, f"axis {number}")
                assert m.read(base + 9, 1)[0] & 0x07 == 3, "online and simulated"
                assert m.read(base + 15, 1)[0] == 3, "the family's number"
        for point, value in (("O[3]", True), ("R[1]", 640.5), ("N[17]", -7)):
            assert g.send("PUT", f"/axes/portal.x/parameters/{point.replace('[', '%5B').replace(']', '%5D')}", {"value": value})["result"] == "done"
            until(lambda: g.get(f"/axes/portal.z/parameters/{point.replace('[', '%5B').replace(']', '%5D')}")["value"] == value, 5, f"{point} is the drive's, not one axis'")
        refused = g.send("PUT", "/axes/portal.x/parameters/AP%5B1%5D", {"value": 100}, 409)
        assert "home position" in refused["detail"], refused
        # a program is started from home position: the last axis gives the control back
        for axis in ("portal.x", "portal.y"):
            assert g.command(axis, {"command": "disable"})["result"] == "done"
        status, answer, _ = g.request("POST", "/api/v1/axes/portal.x/actions", {"name": "automatic.start"})
        assert status == 200, answer
        # the recording is readable
        recording = g.get("/lines/com1/trace?limit=200")
        code, out, err = run("decode", "pacontrol", "--format", "trace", stdin=json.dumps(recording))
        assert code == 0, err
        lines = out.splitlines()
        assert len(lines) > 20 and any("190C" in x for x in lines) and not any("unknown" in x for x in lines), out[:1000]
