"""The round: an HMI reads the moving position over Modbus while HTTP commands the axis."""
import json
import re
import signal
import struct
import time

from harness import DEMO, Gateway, ModbusException, until


def test_mbpoll_sees_the_position_change_while_http_moves_the_axis(gateway):
    assert gateway.command("feeder", {"command": "enable"})["result"] == "done"
    answer = gateway.command("feeder", {"command": "move_absolute", "position": 5, "velocity": 2, "acceleration": 20, "deceleration": 20}, wait=0)
    assert answer["result"] == "accepted"
    seen = []
    for _ in range(12):
        code, text = gateway.mbpoll("-t", "4:int", "-r", "2", "-c", "1")
        assert code == 0, text
        seen.append(int(re.search(r"\[2\]:\s*(-?\d+)", text).group(1)))
        time.sleep(0.1)
    assert len(set(seen)) > 4, f"the position does not move: {seen}"
    assert seen == sorted(seen), seen
    until(lambda: gateway.axis()["target_reached"], 10, "target reached")
    assert gateway.axis()["position_increments"] == 16000
    code, text = gateway.mbpoll("-t", "4:int", "-r", "2", "-c", "1")
    assert "16000" in text, text


def test_plc_enables_moves_and_halts_by_registers(gateway):
    with gateway.modbus() as m:
        assert m.read(0, 1)[0] & 0x4F == 0x40
        m.write1(33, 1)
        for word in (0x06, 0x07, 0x0F):
            m.write1(32, word)
        assert m.read(0, 1)[0] & 0x6F == 0x27, "operation enabled when the write is answered"
        # target, speed, acceleration, deceleration and the control word's edge in one request
        m.write(32, [0x1F, 1, *pair(-9600), *pair(20000), *pair(100000), *pair(100000)])
        assert m.read(0, 1)[0] & 0x1000, "set-point acknowledged"
        until(lambda: m.read(0, 1)[0] & 0x400, 10, "target reached")
        assert m.read32(2) == -9600
        assert m.read(16, 1)[0] == 1 and m.read(17, 1)[0] == 1
        m.write1(32, 0x0F)
        # velocity mode, halt by bit 8, and on
        m.write1(33, 3)
        m.write32(42, 12000)
        until(lambda: abs(m.read32(4) - 12000) < 200, 5, "speed")
        m.write1(32, 0x10F)
        until(lambda: m.read32(4) == 0, 5, "halted")
        m.write1(32, 0x0F)
        until(lambda: m.read32(4) > 5000, 5, "goes on")
        m.write1(32, 0x02)
        until(lambda: m.read32(4) == 0, 5, "quick stop")
        assert m.read(0, 1)[0] & 0x6F == 0x07


def pair(v):
    return [(v >> 16) & 0xFFFF, v & 0xFFFF]


def test_registers_say_simulated_online_and_fresh(gateway):
    with gateway.modbus() as m:
        block = m.read(0, 64)
        assert block[9] & 0b111 == 0b011, "online, simulated, not stale"
        assert block[0] & 0x100 and not block[0] & 0x4000
        assert block[15] == 1
        assert (block[12] << 16 | block[13]) < 1000
        assert m.read(64, 64)[9] & 1
        assert m.read(0, 64, unit=0) and m.read(0, 64, unit=255) and m.read(0, 64, function=4)
        revision = block[18] << 16 | block[19]
        assert revision != 0


def test_exceptions_tell_what_is_wrong(gateway):
    def code(f):
        try:
            f()
        except ModbusException as e:
            return e.code
        return 0
    with gateway.modbus() as m:
        assert code(lambda: m.pdu(b"\x63")) == 1
        assert code(lambda: m.write1(0, 1)) == 2
        assert code(lambda: m.write1(35, 1)) == 3, "half of a 32-bit value"
        assert code(lambda: m.write1(33, 77)) == 3
        assert code(lambda: m.read(0, 126)) == 3
        assert code(lambda: m.read(0, 0)) == 3
        assert code(lambda: m.read(64 * 9, 2)) == 0x0A, "axis not configured"
        assert code(lambda: m.read(0, 1, unit=9)) == 0x0A
        m.write1(33, 1)
        assert code(lambda: m.write1(32, 0x1F)) == 4, "a set-point for an axis that is not enabled"
        # slide has software limits of 50 mm at 100 increments each
        m.write1(64 + 33, 1)
        for word in (6, 7, 15):
            m.write1(64 + 32, word)
        m.write32(64 + 34, 5001)
        assert code(lambda: m.write1(64 + 32, 0x1F)) == 3
        assert m.read(0, 1)


def test_parameter_channel_reads_writes_and_refuses(gateway):
    ids = [p["id"] for p in gateway.get("/families/uim342/parameters")]
    ac = ids.index("AC")
    with gateway.modbus() as m:
        def channel(request, value=0):
            m.write(48, [ac >> 16, ac & 0xFFFF])
            m.write(52, pair(value))
            m.write1(50, request)
            until(lambda: m.read(51, 1)[0] in (2, 3), 5, "the channel's answer")
            return m.read(51, 1)[0], m.read32(52), m.read(54, 1)[0]
        state, before, _ = channel(1)
        assert state == 2 and before > 0
        assert channel(2, 12345)[0] == 2
        assert channel(1)[:2] == (2, 12345)
        state, _, error = channel(2, 0)
        assert state == 3 and error != 0
    assert gateway.get("/axes/feeder/parameters/AC")["value"] == 12345


def test_quick_stop_by_http_ends_a_move_that_somebody_waits_for(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_absolute", "position": 500, "velocity": 10, "acceleration": 50, "deceleration": 50}, wait=0)
    until(lambda: gateway.axis()["moving"], 5, "moving")
    assert gateway.command("feeder", {"command": "quick_stop"})["result"] == "done"
    a = gateway.axis()
    assert not a["moving"] and a["state"] == "quick_stop_active" and a["position"] < 100


def test_refusals_carry_reason_and_range(gateway):
    s, body, headers = gateway.request("POST", "/api/v1/axes/slide/commands", {"command": "move_absolute", "position": 10, "velocity": 1})
    assert s == 409 and headers["Content-Type"].startswith("application/problem+json"), (s, body)
    assert body["result"] == "refused" and "enable" in body["detail"]
    gateway.command("slide", {"command": "enable"})
    s, body, _ = gateway.request("POST", "/api/v1/axes/slide/commands", {"command": "move_absolute", "position": 51, "velocity": 1})
    assert s == 422 and "50" in body["detail"], (s, body)
    s, body, _ = gateway.request("PUT", "/api/v1/axes/feeder/parameters/MT%5B1%5D", {"value": 81})
    assert s == 422 and "5..80" in body["detail"], (s, body)
    s, body, _ = gateway.request("GET", "/api/v1/axes/nobody")
    assert s == 404 and body["status"] == 404


def test_who_has_commanded_finds_it_among_the_events_at_once(gateway):
    """Events share their way to the disk; who asks for them has them all the same, in order and without gaps."""
    last = gateway.get("/events?limit=1")[-1]["id"]
    for i in range(20):
        gateway.command("slide", {"command": "disable"})
        new = gateway.get(f"/events?since={last}")
        assert [e for e in new if e["kind"] == "command" and e["axis"] == "slide"], (i, new)
        assert [e["id"] for e in new] == list(range(last + 1, last + 1 + len(new))), new
        last = new[-1]["id"]


def test_a_stall_by_the_hand_becomes_a_fault_that_can_be_reset(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 3}, wait=0)
    until(lambda: gateway.axis()["moving"], 5, "moving")
    gateway.send("PATCH", "/drives/feeder/hand", {"stall": True})
    until(lambda: gateway.axis()["state"] in ("fault", "fault_reaction_active"), 10, "fault")
    until(lambda: "stall" in json.dumps(gateway.get("/events?axis=feeder&severity=alarm")).lower(), 5, "the alarm among the events")
    gateway.send("PATCH", "/drives/feeder/hand", {"stall": False})
    gateway.command("feeder", {"command": "reset_fault"})
    assert gateway.axis()["state"] == "switch_on_disabled"
    assert gateway.command("feeder", {"command": "enable"})["result"] == "done"


def test_silent_drive_is_stale_and_heals(gateway):
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": True})
    until(lambda: gateway.axis()["stale"] and not gateway.axis()["online"], 10, "stale")
    assert gateway.axis("slide")["online"] and not gateway.axis("slide")["stale"]
    s, body, _ = gateway.request("POST", "/api/v1/axes/feeder/commands", {"command": "enable"})
    assert s == 504, (s, body)
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": False})
    until(lambda: gateway.axis()["online"] and not gateway.axis()["stale"], 10, "healed")


def test_site_changes_without_restart(gateway):
    site = gateway.get("/site")
    site["drives"].append({"name": "third", "line": "can0", "address": 7, "presence": "twin"})
    site["axes"].append({"name": "third", "drive": "third", "number": 3, "unit": "deg", "increments_per_unit": 10})
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_absolute", "position": 6, "velocity": 2, "acceleration": 20, "deceleration": 20}, wait=0)
    dry = gateway.send("PUT", "/site?dry_run=1", site)
    assert "third" in json.dumps(dry)
    s, _, _ = gateway.request("GET", "/api/v1/axes/third")
    assert s == 404
    gateway.send("PUT", "/site", site)
    until(lambda: gateway.axis("third")["online"], 5, "the new axis")
    with gateway.modbus() as m:
        assert m.read(128, 16)[9] & 1
    until(lambda: gateway.axis()["target_reached"], 10, "the motion under way goes on")
    assert gateway.axis()["position_increments"] == 19200
    bad = gateway.get("/site")
    bad["axes"][0]["number"] = 3
    s, body, _ = gateway.request("PUT", "/api/v1/site", bad)
    assert s == 422 and "taken" in json.dumps(body), (s, body)


def test_a_real_line_is_served_by_the_twin_until_the_drive_is_there(folder):
    import harness
    site = json.loads(json.dumps(DEMO))
    with harness.Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--address", "5") as drive:
        port = re.search(r"127\.0\.0\.1:(\d+)", drive.ready).group(1)
        site["lines"][0]["uri"] = f"tcp:127.0.0.1:{port}"
        site["drives"] = site["drives"][:1]
        site["axes"] = site["axes"][:1]
        with Gateway(folder, site) as g:
            until(lambda: g.axis()["online"] and not g.axis()["simulated"], 10, "the device serves")
            assert g.command("feeder", {"command": "enable"})["result"] == "done"
            assert g.command("feeder", {"command": "move_absolute", "position": 1, "velocity": 5, "acceleration": 50, "deceleration": 50})["result"] == "done"
            g.command("feeder", {"command": "disable"})
            until(lambda: g.axis()["state"] == "switch_on_disabled", 5, "off")
            drive.stop()
            until(lambda: g.axis()["online"] and g.axis()["simulated"], 15, "the twin takes over")
            with harness.Process("twin", "uim342", "--line", f"tcp-listen:127.0.0.1:{port}", "--address", "5"):
                until(lambda: g.axis()["online"] and not g.axis()["simulated"], 20, "the device is handed back")
            events = g.get("/events")
            assert "presence" in json.dumps(events)


def test_hostile_modbus_bytes_harm_nobody(gateway):
    import os
    import socket
    with gateway.modbus() as good:
        for junk in (b"GET / HTTP/1.1\r\n\r\n", b"\x00" * 600, b"\xff" * 300, struct.pack(">HHH", 1, 0, 0xFFFF), struct.pack(">HHHB", 1, 0, 1, 1), os.urandom(4096)):
            s = socket.create_connection(("127.0.0.1", gateway.modbus_port))
            s.sendall(junk)
            assert good.read(0, 10)
            s.close()
        half = [socket.create_connection(("127.0.0.1", gateway.modbus_port)) for _ in range(100)]
        for h in half:
            h.sendall(b"\x00\x01\x00\x00")
        begun = time.monotonic()
        for _ in range(200):
            good.read(0, 10)
        assert time.monotonic() - begun < 5
        for h in half:
            h.close()


def test_stops_moving_axes_when_it_ends(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 3}, wait=0)
    until(lambda: gateway.axis()["moving"], 5, "moving")
    assert gateway.stop(signal.SIGTERM) == 0
