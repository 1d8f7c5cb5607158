# Silence: what a controller, a script and the tester's hand see of a drive that does not answer, and of a search for the zero.
# In: the program with the demo-like site of the harness, raw Modbus, REST. Out: exceptions, results, states.
import concurrent.futures
import time

from harness import Gateway, ModbusException, until


def offset(axis, register):
    return (axis - 1) * 64 + register


def exception(modbus, address, value):
    try:
        modbus.write1(address, value)
    except ModbusException as e:
        return e.code
    return None


def test_registers_say_that_a_stop_was_not_heard(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 3}, wait=0)
    until(lambda: gateway.axis()["moving"], 5, "moving")
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": True})
    until(lambda: not gateway.axis()["online"], 10, "offline")
    axis = gateway.axis()
    assert axis["stale"] and axis["position"] is not None and axis["age_ms"] > 0, axis
    # Reports are made every 100 ms.
    until(lambda: gateway.get("/drives/feeder")["status"]["retry_pause_ms"] > 0, 2, "the growing pause is shown")
    status = gateway.get("/drives/feeder")["status"]
    assert status["silent_exchanges"] > 0 and status["simulated"] and not status["online"], status
    with gateway.modbus() as m:
        for word in (0x06, 0x07, 0x0F, 0x1F, 0x0B, 0x00):
            assert exception(m, offset(axis["number"], 32), word) == 0x0B, hex(word)
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": False})
    until(lambda: gateway.axis()["online"], 15, "online again")
    time.sleep(0.3)
    axis = gateway.axis()
    assert not axis["moving"], "it heard the stop although nobody heard its answer"
    assert axis["state"] == "switch_on_disabled", axis


def test_what_a_drive_has_refused_is_no_fault_after_a_silence(gateway):
    s, body, _ = gateway.request("PUT", "/api/v1/axes/feeder/parameters/SD", {"value": 1})
    assert s == 409, (s, body)
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": True})
    until(lambda: not gateway.axis()["online"], 10, "offline")
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": False})
    until(lambda: gateway.axis()["online"], 15, "online again")
    time.sleep(0.3)
    assert gateway.axis()["state"] == "switch_on_disabled", gateway.axis()
    assert gateway.command("feeder", {"command": "enable"})["result"] == "done"


HOMING = {
    "lines": [{"name": "can0", "uri": "twin", "family": "uim342"}],
    "drives": [{"name": "h", "line": "can0", "address": 5, "presence": "twin", "options": {"home_input": 1, "home_velocity": 3200, "home_timeout_s": 2}}],
    "axes": [{"name": "h", "drive": "h", "number": 1, "unit": "mm", "increments_per_unit": 3200}],
    "mappings": [],
}


def test_a_search_for_the_switch_is_done_when_it_is_done(folder):
    with Gateway(folder, HOMING) as gateway, concurrent.futures.ThreadPoolExecutor(1) as other:
        gateway.command("h", {"command": "enable"})
        # Each method from the side on which one edge is enough, and those that must first go to the other side of the switch.
        for method, levels in ((17, "10"), (18, "10"), (19, "10"), (20, "01"), (21, "10"), (22, "01"), (17, "010"), (20, "101")):
            gateway.send("PATCH", "/drives/h/hand", {"inputs": int(levels[0])})
            until(lambda: not gateway.axis("h")["moving"], 5, "at rest")
            time.sleep(0.2)
            answer = other.submit(gateway.request, "POST", "/api/v1/axes/h/commands?wait=10", {"command": "home", "method": method})
            for level in levels[1:]:
                until(lambda: gateway.axis("h")["moving"] or answer.done(), 3, "searching")
                time.sleep(0.4)
                gateway.send("PATCH", "/drives/h/hand", {"inputs": int(level)})
            status, body, _ = answer.result(15)
            assert status == 200 and body["result"] == "done", (method, levels, status, body)
            axis = gateway.axis("h")
            assert axis["referenced"] and not axis["moving"], (method, axis)
        gateway.send("PATCH", "/drives/h/hand", {"inputs": 1})
        status, body, _ = gateway.request("POST", "/api/v1/axes/h/commands?wait=10", {"command": "home", "method": 17})
        assert status == 409 and "not found within 2 s" in body["detail"], (status, body)
