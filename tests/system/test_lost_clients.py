# Lost clients: what becomes of an axis when the Modbus client that moves it closes its connection, or stays connected and asks nothing; and
# when the site itself lets go of it. In: the program with some sites, raw Modbus. Out: axis states, register 22, events, metrics.
import re
import time

from harness import Gateway, ModbusException, Process, until

SITE = {
    "lines": [{"name": "can0", "uri": "twin", "family": "uim342"}],
    "drives": [{"name": n, "line": "can0", "address": a, "presence": "twin"} for n, a in (("one", 5), ("two", 6))],
    "axes": [
        {"name": "one", "drive": "one", "number": 1, "position_min": -100000, "position_max": 100000},
        {"name": "two", "drive": "two", "number": 2, "fail_safe": {"modbus_closed": "quick_stop", "modbus_silent": "disable", "watchdog_ms": 500}},
    ],
    "mappings": [],
}


def enable(m, axis, mode):
    base = (axis - 1) * 64
    m.write1(base + 33, mode)
    for register, value in ((36, 3000), (38, 20000), (40, 20000)):
        m.write32(base + register, value)
    for word in (0x06, 0x07, 0x0F):
        m.write1(base + 32, word)


def test_a_closed_connection_halts_a_velocity_move(folder):
    with Gateway(folder, SITE) as gateway:
        with gateway.modbus() as m:
            enable(m, 1, 3)
            m.write32(42, 2000)
            until(lambda: gateway.axis("one")["moving"], 5, "moving")
        until(lambda: not gateway.axis("one")["moving"], 3, "halted")
        axis = gateway.axis("one")
        assert axis["state"] == "operation_enabled" and axis["fail_safe_cause"] == "modbus_closed", axis
        with gateway.modbus() as m:
            assert m.read(22, 1) == [1] and m.read(9, 1)[0] & 0x100
            m.write32(42, 0)
            m.write32(42, 1000)
            until(lambda: gateway.axis("one")["moving"], 5, "moving again")
            assert m.read(22, 1) == [0], "the next command ends it"
            m.write1(32, 0)
        events = gateway.get("/events?kind=fail_safe")
        assert len(events) == 1 and events[0]["axis"] == "one" and "127.0.0.1" in events[0]["text"], events
        # Reports are made every 100 ms.
        until(lambda: 'axisgate_fail_safe_total{cause="modbus_closed"} 1' in gateway.request("GET", "/metrics")[1].decode(), 2, "the count of fail-safe actions")


def test_a_move_to_a_target_goes_on_and_the_site_can_choose(folder):
    with Gateway(folder, SITE) as gateway:
        with gateway.modbus() as m:
            enable(m, 1, 1)
            enable(m, 2, 1)
            for base in (0, 64):
                m.write32(base + 34, 6000)
                m.write1(base + 32, 0x1F)
        until(lambda: gateway.axis("one")["position_increments"] == 6000, 10, "the target is reached without the client")
        two = gateway.axis("two")
        assert two["state"] == "quick_stop_active" and two["position_increments"] < 6000, two


def test_a_silent_connection_is_a_lost_client(folder):
    with Gateway(folder, SITE) as gateway, gateway.modbus() as m:
        enable(m, 2, 3)
        m.write32(64 + 42, 2000)
        for _ in range(10):  # whoever asks is there
            time.sleep(0.2)
            m.read(64 + 14, 1)
        assert gateway.axis("two")["moving"]
        until(lambda: gateway.axis("two")["state"] == "switch_on_disabled", 3, "switched off")
        assert gateway.axis("two")["fail_safe_cause"] == "modbus_silent"


def test_a_stop_of_another_client_is_latched_by_its_name(folder):
    with Gateway(folder, SITE) as gateway, gateway.modbus() as m:
        enable(m, 1, 3)
        m.write32(42, 2000)
        until(lambda: gateway.axis("one")["moving"], 5, "moving")
        axis = gateway.axis("one")
        assert (axis["stop_latch"], axis["stop_latch_by"], axis["stop_latch_text"]) == (0, None, None), axis
        assert gateway.command("one", {"command": "halt"})["result"] in ("accepted", "done")
        axis = gateway.axis("one")
        assert (axis["stop_latch"], axis["stop_latch_by"]) == (5, "http 127.0.0.1"), axis
        assert axis["stop_latch_text"].startswith("http 127.0.0.1 has stopped it: "), axis
        assert m.read(23, 1) == [5]
        m.write32(42, 0)
        m.write32(42, 1000)  # its own words have changed
        until(lambda: gateway.axis("one")["moving"], 5, "moving again")
        axis = gateway.axis("one")
        assert (axis["stop_latch"], axis["stop_latch_by"], axis["stop_latch_text"]) == (0, None, None), axis


def test_what_waits_keeps_the_limits_and_a_velocity_is_needed(folder):
    with Gateway(folder, SITE) as gateway, gateway.modbus() as m:

        def code(f):
            try:
                f()
            except ModbusException as e:
                return e.code
            return 0

        m.write1(33, 1)
        for word in (0x06, 0x07, 0x0F):
            m.write1(32, word)
        m.write32(34, 500)
        assert code(lambda: m.write1(32, 0x1F)) == 3, "no velocity was written"
        m.write1(32, 0x0F)
        m.write32(36, 20000)
        m.write32(34, 50000)
        m.write1(32, 0x1F)
        m.write1(32, 0x0F)
        m.write32(34, 100001)
        assert code(lambda: m.write1(32, 0x1F)) == 3, "beyond the limit, while another motion runs"
        m.write1(32, 0x0F)
        assert code(lambda: m.write32(36, 0)) == 0
        m.write32(34, 40000)
        assert code(lambda: m.write1(32, 0x1F)) == 3, "0 is no velocity"
        assert m.read32(34) == 40000, "register 34 reads what was written"
        until(lambda: gateway.axis("one")["position_increments"] == 50000, 10, "the first target")


def test_a_target_written_before_enabling_is_moved_to(folder):
    with Gateway(folder, SITE) as gateway, gateway.modbus() as m:
        m.write1(33, 1)
        m.write32(36, 20000)
        m.write32(34, 3000)
        for word in (0x06, 0x07, 0x0F):
            m.write1(32, word)
        assert m.read32(34) == 3000
        time.sleep(0.3)
        assert gateway.axis("one")["position_increments"] == 0, "nothing moves because it was enabled"
        m.write1(32, 0x1F)
        until(lambda: gateway.axis("one")["position_increments"] == 3000, 5, "the written target")


def test_what_a_site_change_takes_away_is_stopped_first(folder):
    with Process("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0") as far:
        port = int(re.search(r"127\.0\.0\.1:(\d+)", far.ready).group(1))
        site = {"lines": [{"name": "a", "uri": f"tcp:127.0.0.1:{port}", "family": "mcode"}],
                "drives": [{"name": "a", "line": "a", "address": "!", "presence": "device"}],
                "axes": [{"name": "a", "drive": "a", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}
        with Gateway(folder, site) as g:
            until(lambda: g.axis("a")["online"], 10, "the drive serves")
            assert g.command("a", {"command": "enable"})["result"] == "done"
            assert g.command("a", {"command": "move_velocity", "velocity": 40})["result"] == "done"
            assert g.axis("a")["moving"]
            s, answer, _ = g.request("DELETE", "/api/v1/lines/a?cascade=1")
            assert s == 204, (s, answer)
            texts = [e["text"] for e in g.get("/events?kind=site")]
            assert any("the axis is stopped" in t for t in texts), texts
            assert not g.get("/events?severity=alarm"), "it was seen to stand"
