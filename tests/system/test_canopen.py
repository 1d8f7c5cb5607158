"""The frames of a CANopen line as an independent dissector reads them, and as the gateway's own decoder does.

In: the real program with a servo and a MACS behind one line, tshark. Out: no frame that tshark cannot read; both name the same objects.
"""
import pathlib
import re
import subprocess
import time

from harness import Gateway, run, until

SITE = {
    "lines": [{"name": "can0", "uri": "twin", "family": "cia402", "bitrate": 1000000}],
    "drives": [{"name": "lift", "line": "can0", "address": 5, "presence": "twin"}, {"name": "macs", "line": "can0", "family": "aposs", "address": 12, "presence": "twin"}],
    "axes": [{"name": "lift", "drive": "lift", "channel": 1, "number": 1}, {"name": "master", "drive": "macs", "channel": 1, "number": 2},
             {"name": "slave", "drive": "macs", "channel": 2, "number": 3}],
}


def dissected(path):
    # A CAN frame in a capture says nothing of the protocol on top: every identifier is told to be CANopen.
    command = ["tshark", "-r", str(path), "-d", "can.subdissector,canopen", "-T", "fields", "-E", "separator=|"]
    fields = ["can.id", "canopen.function_code", "canopen.node_id", "canopen.sdo.main_idx", "canopen.sdo.sub_idx", "canopen.nmt_ctrl.cd", "canopen.em.err_code", "_ws.malformed"]
    for f in fields:
        command += ["-e", f]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return [dict(zip(fields, line.split("|"))) for line in out.splitlines()]


def test_a_dissector_reads_every_frame_as_we_do(folder):
    with Gateway(folder, SITE) as g:
        for axis in ("lift", "master", "slave"):
            until(lambda: g.axis(axis)["online"], 10, axis)
            assert g.command(axis, {"command": "enable"})["result"] == "done"
            assert g.command(axis, {"command": "move_absolute", "position": 2000, "velocity": 10000})["result"] == "done"
        g.get("/axes/slave/parameters/VELMAX")
        g.send("PUT", "/drives/lift/hand", {"inject_error": 0x2310})
        until(lambda: g.axis("lift")["fault"], 10, "the fault")
        g.send("PUT", "/drives/lift/hand", {"inject_error": 0})
        g.command("lift", {"command": "reset_fault"})
        status, data, _ = g.request("GET", "/api/v1/lines/can0/trace?format=pcapng")
        assert status == 200
        path = pathlib.Path(folder) / "line.pcapng"
        path.write_bytes(data)
        log = g.request("GET", "/api/v1/lines/can0/trace?format=candump")[1].decode()
    text = run("decode", "cia402", "--format", "candump", stdin=log, check=0)[1]
    frames = dissected(path)
    assert len(frames) > 300
    assert [f for f in frames if f["_ws.malformed"]] == []
    seen = {f["canopen.function_code"] for f in frames}
    # NMT, SYNC or EMCY, TPDO 1 to 4, SDO both ways, error control, by their function codes.
    assert {"0x00", "0x01", "0x03", "0x05", "0x07", "0x09", "0x0b", "0x0c", "0x0e"} <= {f"0x{int(c, 0):02x}" for c in seen if c}, seen
    assert any(f["canopen.em.err_code"] and int(f["canopen.em.err_code"], 0) == 0x2310 for f in frames), "the emergency"
    objects = {(int(f["canopen.node_id"], 0), int(f["canopen.sdo.main_idx"], 0), int(f["canopen.sdo.sub_idx"], 0)) for f in frames if f["canopen.sdo.main_idx"]}
    named = re.findall(r"node (\d+): (?:read|write|written|refusal of|abort of) ([0-9A-F]{4})h:([0-9A-F]{2})", text)
    ours = {(int(node), int(index, 16), int(sub, 16)) for node, index, sub in named}
    assert {(5, 0x6040, 0), (12, 0x6840, 0), (12, 0x2301, 2)} <= objects, sorted(objects)
    assert objects == ours, sorted(objects ^ ours)


SHARED = {
    "lines": [{"name": "can0", "uri": "twin", "family": "cia402", "bitrate": 1000000}],
    "drives": [{"name": "feeder", "line": "can0", "family": "uim342", "address": 5, "presence": "twin"}, {"name": "macs", "line": "can0", "family": "aposs", "address": 12, "presence": "twin"},
               {"name": "lift", "line": "can0", "address": 20, "presence": "twin"}, {"name": "turn", "line": "can0", "address": 21, "presence": "twin"}],
    "axes": [{"name": "feeder", "drive": "feeder", "number": 1}, {"name": "master", "drive": "macs", "channel": 1, "number": 2}, {"name": "slave", "drive": "macs", "channel": 2, "number": 3},
             {"name": "lift", "drive": "lift", "number": 4}, {"name": "turn", "drive": "turn", "number": 5}],
}


def test_a_drive_that_goes_and_comes_disturbs_no_other_of_its_line(folder):
    """A UIM342, a MACS and two generic drives: NMT, SYNC and back-off of one are nobody else's."""
    others = ("feeder", "master", "slave", "turn")
    with Gateway(folder, SHARED) as g:
        for axis in (*others, "lift"):
            until(lambda: g.axis(axis)["online"], 10, axis)
            assert g.command(axis, {"command": "enable"})["result"] == "done"
            assert g.command(axis, {"command": "move_velocity", "velocity": 1000})["result"] == "done"
        since = g.get("/lines/can0/trace?format=json&limit=1")["next"]
        g.send("PATCH", "/drives/lift/hand", {"power": False})
        until(lambda: not g.axis("lift")["online"], 10, "it is gone")
        asked, begin = [], time.monotonic()
        while time.monotonic() < begin + 4:  # while it is asked again and again
            asked.append(all(g.axis(a)["online"] and g.axis(a)["moving"] and not g.axis(a)["stale"] for a in others))
            time.sleep(0.1)
        g.send("PATCH", "/drives/lift/hand", {"power": True})
        until(lambda: g.axis("lift")["online"], 20, "it is back")
        assert not g.axis("lift")["moving"], "nothing moves because it came back"
        assert all(asked), asked
        assert all(g.axis(a)["moving"] for a in others)
        trace = g.get(f"/lines/can0/trace?format=json&since={since}&limit=65536")
        frames = [f for f in trace["frames"] if not f.get("extended")]
        nmt = [f["data"] for f in frames if f["id"] == 0]
        assert nmt, "the drive that came back was started"
        assert {int(d[2:4], 16) for d in nmt} == {20}, nmt
        told = {f["id"] for f in frames}
        assert {0x80, 0x180 + 12, 0x180 + 21, 0x700 + 20} <= told, sorted(told)
        syncs = [f for f in frames if f["id"] == 0x80 and not f["data"]]
        assert len(syncs) > 100, len(syncs)
        status = g.get("/lines/can0")["status"]
        assert 0 < status["load"] < 0.8, status
        for axis in others:
            assert g.command(axis, {"command": "halt"})["result"] == "done"
