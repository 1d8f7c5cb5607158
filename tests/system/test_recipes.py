"""Recipes as an outsider uses them: put, checked, run, watched, cancelled, and the report read again after a restart.

In: the real program with the demo drives. Out: judgements on axes, registers, events and reports.
"""
import copy
import json
import pathlib
import time

import jsonschema

import harness
from harness import until

THERE_AND_BACK = {
    "description": "to the middle and back",
    "parameters": {"distance": {"type": "number", "default": 5, "min": 0, "max": 40}, "who": {"type": "axis", "default": "feeder"}},
    "steps": [
        {"set_parameter": {"axis": "${who}", "parameter": "AC", "value": 1000000}},
        {"enable": {"axis": "${who}"}},
        {"if": {"condition": {"axis": "${who}", "point": "fault", "is": True},
                "then": [{"command": {"axis": "${who}", "command": "reset_fault"}}], "else": [{"message": "moving ${who} by ${distance}"}]}},
        {"repeat": {"times": 2, "steps": [
            {"command": {"axis": "${who}", "command": "move_relative", "position": "${distance}", "velocity": 40, "acceleration": 400, "deceleration": 400, "wait_s": 20}}]}},
        {"wait_for": {"axis": "${who}", "point": "moving", "is": False, "timeout_s": 5}},
        {"check": {"axis": "${who}", "point": "position", "is": 10, "tolerance": 0.01, "text": "twice the distance"}, "comment": "the end"},
        {"read_parameter": {"axis": "${who}", "parameter": "AC"}},
        {"disable": {"axis": "${who}"}},
    ],
}


# Each command has members of its own; a name is the path's.
ALONE = ("/steps/5/command", "/steps/4/home", "/name", "/parameters/d/default")


def ended(gateway, name, n, seconds=30):
    return until(lambda: (r := gateway.get(f"/recipes/{name}/runs/{n}"))["state"] not in ("running", "stopping") and r, seconds, f"the end of {name} run {n}")


def step(report, pointer):
    return next(s for s in report["steps"] if s["pointer"] == pointer)


def test_a_recipe_moves_an_axis_and_reports_each_step(folder):
    with harness.Gateway(folder) as g:
        g.send("PUT", "/recipes/there-and-back", THERE_AND_BACK, 201)
        shown = g.get("/recipes/there-and-back")
        assert shown["steps"] == THERE_AND_BACK["steps"] and shown["name"] == "there-and-back"
        plan = g.send("POST", "/recipes/there-and-back/run", {"dry_run": True})
        assert plan["axes"] == ["feeder"] and plan["arguments"] == {"distance": 5, "who": "feeder"} and plan["steps"] == 11, plan
        assert g.axis()["state"] != "operation_enabled", "a dry run does nothing"
        status, started, head = g.request("POST", "/api/v1/recipes/there-and-back/run", {})
        assert status == 202 and head["Location"] == "/api/v1/recipes/there-and-back/runs/1", (status, head)
        r = ended(g, "there-and-back", 1)
        assert r["state"] == "done", r
        assert all(s["state"] == "done" for s in r["steps"] if s["pointer"] != "/steps/2/if/then/0"), r["steps"]
        assert step(r, "/steps/2/if/then/0")["state"] == "not_run" and step(r, "/steps/2")["text"] == "else"
        assert step(r, "/steps/2/if/else/0")["text"] == "moving feeder by 5"
        assert step(r, "/steps/3/repeat/steps/0")["times"] == 2
        assert step(r, "/steps/6")["value"] == 400 * 3200, step(r, "/steps/6")
        assert step(r, "/steps/5")["comment"] == "the end"
        assert abs(g.axis()["position"] - 10) < 0.02 and g.axis()["state"] != "operation_enabled"

        def recipe_texts():
            return [e["text"] for e in g.get("/events?limit=200") if e["kind"] == "recipe"]
        until(lambda: "recipe there-and-back run 1 done" in recipe_texts(), 5, "the event of the end")
        texts = recipe_texts()
        assert any(t.startswith("recipe there-and-back run 1 started with distance = 5") for t in texts) and "moving feeder by 5" in texts, texts
        writes = [e for e in g.get("/events?limit=200") if e["kind"] == "write"]
        assert writes and "recipe there-and-back by" in writes[-1]["who"], writes
    with harness.Gateway(folder, None) as g:
        assert g.get("/recipes")[0]["name"] == "there-and-back"
        assert g.get("/recipes/there-and-back/runs/1")["state"] == "done", "reports outlive the program"
        g.send("POST", "/recipes/there-and-back/run", {"arguments": {"distance": 0}}, 202)
        r = ended(g, "there-and-back", 2)
        assert [x["n"] for x in g.get("/recipes/there-and-back/runs")] == [2, 1]
        assert g.request("DELETE", "/api/v1/recipes/there-and-back")[0] == 204
        for n in (1, 2):
            until(lambda: g.request("GET", f"/api/v1/recipes/there-and-back/runs/{n}")[0] == 404, 5, f"report {n} goes with its recipe")


def test_a_cancelled_run_halts_what_it_has_set_in_motion(gateway):
    recipe = {"steps": [{"enable": {"axis": "feeder"}}, {"command": {"axis": "feeder", "command": "move_velocity", "velocity": 5, "acceleration": 100}},
                        {"wait_for": {"axis": "feeder", "point": "position", "at_least": 100000, "timeout_s": 600}}]}
    gateway.send("PUT", "/recipes/run-away", recipe, 201)
    gateway.send("POST", "/recipes/run-away/run", {}, 202)
    until(lambda: gateway.axis()["moving"], 10, "motion")
    status, p, _ = gateway.request("POST", "/api/v1/recipes/run-away/run", {})
    assert status == 409 and p["reason"] == "running", p
    other = {"steps": [{"command": {"axis": "feeder", "command": "halt"}}]}
    gateway.send("PUT", "/recipes/other", other, 201)
    status, p, _ = gateway.request("POST", "/api/v1/recipes/other/run", {})
    assert status == 409 and "feeder" in p["detail"] and "run-away" in p["detail"], p
    gateway.send("POST", "/recipes/run-away/runs/1/cancel", None, 202)
    r = ended(gateway, "run-away", 1)
    assert r["state"] == "cancelled" and r["stops"] == [{"axis": "feeder", "stopped": True, "left_alone": False, "text": r["stops"][0]["text"]}], r
    assert r["at_step"] == "/steps/2" and "cancelled by" in r["text"]
    until(lambda: not gateway.axis()["moving"], 10, "rest")
    assert gateway.axis()["state"] == "operation_enabled", "halted, not switched off"
    gateway.send("POST", "/recipes/run-away/runs/1/cancel", None, 409)
    gateway.send("POST", "/recipes/other/run", {}, 202)


MOVE = {"axis": "feeder", "command": "move_absolute", "position": 500, "velocity": 5, "acceleration": 100}


def as_client(gateway, name, method, path, body, wanted):
    status, answer, _ = gateway.request(method, "/api/v1" + path, body, {"X-Client": name})
    assert status == wanted, f"{name}: {method} {path}: {status} {answer}"
    return answer


def test_a_failing_run_leaves_motions_of_others_alone(gateway):
    """Held by another client; by an action that there is none of; by hand in the middle of its own move, with the same name."""
    gateway.command("feeder", {"command": "enable"})
    gateway.send("PUT", "/recipes/go", {"steps": [{"command": {**MOVE, "wait_s": 60}}]}, 201)
    gateway.send("PUT", "/recipes/odd", {"steps": [{"action": {"axis": "feeder", "name": "no_such_action"}}]}, 201)
    as_client(gateway, "otto", "PUT", "/axes/feeder/authority", {"ttl_s": 60}, 200)
    as_client(gateway, "otto", "POST", "/axes/feeder/commands?wait=1", {k: v for k, v in MOVE.items() if k != "axis"}, 200)
    until(lambda: gateway.axis()["moving"], 10, "otto's motion")
    as_client(gateway, "eva", "POST", "/recipes/go/run", {}, 202)
    r = ended(gateway, "go", 1)
    assert r["state"] == "failed" and "held by http" in r["text"] and r["stops"] == [], r
    as_client(gateway, "otto", "DELETE", "/axes/feeder/authority", None, 204)
    as_client(gateway, "eva", "POST", "/recipes/odd/run", {}, 202)
    r = ended(gateway, "odd", 1)
    assert r["state"] == "failed" and r["stops"] == [], r
    time.sleep(0.4)
    assert gateway.axis()["moving"], "otto's motion goes on"
    as_client(gateway, "eva", "POST", "/recipes/go/run", {}, 202)
    until(lambda: step(gateway.get("/recipes/go/runs/2"), "/steps/0")["state"] == "running", 5, "the step")
    time.sleep(0.3)
    as_client(gateway, "eva", "POST", "/axes/feeder/commands?wait=1", {"command": "move_velocity", "velocity": -6, "acceleration": 100}, 200)
    r = ended(gateway, "go", 2)
    assert r["state"] == "failed" and "interrupted" in r["text"], r
    assert len(r["stops"]) == 1 and r["stops"][0]["left_alone"] and not r["stops"][0]["stopped"], r
    time.sleep(0.4)
    until(lambda: gateway.axis()["velocity"] < -5.5, 10, "the speed of the motion by hand")
    gateway.command("feeder", {"command": "halt"})


def test_a_motion_taken_over_by_another_holder_is_left_alone(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.send("PUT", "/recipes/away", {"steps": [{"command": {"axis": "feeder", "command": "move_velocity", "velocity": 5, "acceleration": 100}}, {"wait_s": 60}]}, 201)
    as_client(gateway, "eva", "POST", "/recipes/away/run", {}, 202)
    until(lambda: gateway.axis()["moving"], 10, "motion")
    as_client(gateway, "otto", "PUT", "/axes/feeder/authority", {"ttl_s": 60}, 200)
    gateway.send("POST", "/recipes/away/runs/1/cancel", None, 202)
    r = ended(gateway, "away", 1)
    assert r["state"] == "cancelled" and r["stops"][0]["left_alone"] and "otto" in r["stops"][0]["text"], r
    assert gateway.axis()["moving"]


def test_reports_outlive_the_program_however_it_ends(folder):
    slow = {"steps": [{"set_parameter": {"axis": "feeder", "parameter": "AC", "value": 1000000}}, {"repeat": {"times": 3, "steps": [{"wait_s": 60}]}}]}
    with harness.Gateway(folder) as g:
        g.send("PUT", "/recipes/slow", slow, 201)
        g.send("PUT", "/recipes/quick", {"steps": [{"wait_s": 0}]}, 201)
        for n in range(1, 24):
            g.send("POST", "/recipes/quick/run", {}, 202)
            ended(g, "quick", n)
            assert len(g.get("/recipes/quick/runs")) <= 20, n
        g.send("POST", "/recipes/slow/run", {}, 202)
        r = until(lambda: (r := g.get("/recipes/slow/runs/1"))["at_step"] == "/steps/1/repeat/steps/0" and r, 10, "the wait")
        assert r["at_label"] == "Step 2.1 (pass 1 of 3): wait_s 60" and step(r, "/steps/0")["label"] == "Step 1: set_parameter AC of feeder = 1000000", r
        time.sleep(1.5)
        g.process.kill()
        g.process.wait()
    for sig, n in ((harness.signal.SIGTERM, 2), (harness.signal.SIGKILL, 3)):
        with harness.Gateway(folder, None) as g:
            r = g.get(f"/recipes/slow/runs/{n - 1}")
            assert r["state"] == "interrupted" and "the gateway was restarted" in r["text"] and r["ended_at"], r
            assert step(r, "/steps/0")["state"] == "done" and step(r, "/steps/1/repeat/steps/0")["state"] == "interrupted", r
            until(lambda: any(e["kind"] == "recipe" and e["severity"] == "warning" and f"recipe slow run {n - 1} interrupted at" in e["text"] for e in g.get("/events?limit=200")), 5, "the event")
            assert [x["n"] for x in g.get("/recipes/quick/runs")] == list(range(23, 3, -1))
            assert g.get("/recipes")[1]["running"] is None
            assert g.send("POST", "/recipes/slow/run", {}, 202)["n"] == n
            until(lambda: g.get(f"/recipes/slow/runs/{n}")["at_step"] == "/steps/1/repeat/steps/0", 10, "the wait")
            time.sleep(1.2)
            g.process.send_signal(sig)
            g.process.wait(20)
    with harness.Gateway(folder, None) as g:
        assert [x["state"] for x in g.get("/recipes/slow/runs")] == ["interrupted"] * 3
        g.send("POST", "/recipes/quick/run", {}, 202)
        assert ended(g, "quick", 24)["state"] == "done"
        assert [x["n"] for x in g.get("/recipes/quick/runs")] == list(range(24, 4, -1))


def test_a_failed_check_stops_and_says_where_and_why(gateway):
    recipe = {"on_failure": "quick_stop", "steps": [
        {"enable": {"axis": "feeder"}}, {"command": {"axis": "feeder", "command": "move_velocity", "velocity": 5, "acceleration": 100}},
        {"repeat": {"times": 3, "steps": [{"check": {"axis": "feeder", "point": "position", "at_most": -1, "text": "behind the stop"}}]}}, {"disable": {"axis": "feeder"}}]}
    gateway.send("PUT", "/recipes/bad", recipe, 201)
    gateway.send("POST", "/recipes/bad/run", {}, 202)
    r = ended(gateway, "bad", 1)
    assert r["state"] == "failed" and r["at_step"] == "/steps/2/repeat/steps/0" and r["text"].startswith("behind the stop: feeder position at_most -1: it is"), r
    assert step(r, "/steps/3")["state"] == "not_run" and step(r, "/steps/2")["state"] == "failed"
    assert r["stops"][0]["stopped"], r
    until(lambda: gateway.axis()["state"] == "quick_stop_active" or not gateway.axis()["moving"], 10, "rest")
    assert any(e["severity"] == "warning" and e["kind"] == "recipe" and "failed at /steps/2/repeat/steps/0" in e["text"] for e in gateway.get("/events?limit=200"))


def test_registers_are_written_by_the_maps_own_rules(gateway):
    gateway.send("POST", "/mappings", {"id": "ac", "unit": 3, "address": 10, "axis": "feeder", "point": "AC", "type": "u32", "scale": 0.5, "access": "RW"}, 201)
    recipe = {"steps": [{"write_register": {"unit": 3, "address": 10, "type": "u32", "value": 30000}},
                        {"write_register": {"unit": 1, "address": 36, "type": "u32", "value": 77777}}]}
    gateway.send("PUT", "/recipes/registers", recipe, 201)
    gateway.send("POST", "/recipes/registers/run", {}, 202)
    r = ended(gateway, "registers", 1)
    assert r["state"] == "done", r
    assert gateway.get("/axes/feeder/parameters/AC")["value"] == 60000, "the scale of the mapping holds"
    with gateway.modbus() as m:
        assert m.read32(36, signed=False) == 77777
    for spoiled, pointer in (({"unit": 3, "address": 11, "value": 1}, "address"), ({"unit": 1, "address": 0, "value": 1}, "address"),
                             ({"unit": 3, "address": 10, "type": "i16", "value": 1}, "type"), ({"unit": 3, "address": 10, "value": -1}, "value")):
        gateway.send("PUT", "/recipes/registers", {"steps": [{"write_register": spoiled}]})
        p = gateway.send("POST", "/recipes/registers/run", {}, 422)
        assert p["faults"][0]["pointer"] == f"/steps/0/write_register/{pointer}", (spoiled, p)


def test_what_cannot_run_is_refused_before_anything_moves(gateway):
    recipe = {"parameters": {"n": {"type": "integer"}}, "steps": [
        {"enable": {"axis": "feeder"}}, {"set_parameter": {"axis": "nobody", "parameter": "AC", "value": 1}}, {"set_parameter": {"axis": "feeder", "parameter": "XX", "value": 1}},
        {"set_parameter": {"axis": "feeder", "parameter": "AC", "value": -1}}, {"command": {"axis": "feeder", "command": "move_absolute", "position": "${n}"}}]}
    gateway.send("PUT", "/recipes/wrong", recipe, 201)
    p = gateway.send("POST", "/recipes/wrong/run", {"arguments": {"n": 1}}, 422)
    assert [f["pointer"] for f in p["faults"]] == ["/steps/1/set_parameter/axis", "/steps/2/set_parameter/parameter", "/steps/3/set_parameter/value"], p
    p = gateway.send("POST", "/recipes/wrong/run", {}, 422)
    assert p["faults"][0]["pointer"] == "/arguments/n", p
    time.sleep(0.1)
    assert gateway.axis()["state"] != "operation_enabled"


def test_the_program_takes_what_the_schema_takes(gateway):
    """Spoiled one member at a time: what schema/recipe.schema.json takes, the program takes."""
    schema = json.loads((pathlib.Path(__file__).resolve().parents[2] / "schema/recipe.schema.json").read_text())
    validator = jsonschema.Draft202012Validator(schema)
    jsonschema.Draft202012Validator.check_schema(schema)
    whole = {"description": "x", "timeout_s": 10, "on_failure": "halt", "parameters": {"d": {"type": "number", "default": 1, "min": 0, "max": 2, "unit": "mm", "description": "y"}}, "steps": [
        {"set_parameter": {"axis": "a", "parameter": "AC", "value": 1}, "comment": "c"},
        {"read_parameter": {"axis": "a", "parameter": "AC"}}, {"enable": {"axis": "a", "wait_s": 1}}, {"disable": {"axis": "a"}},
        {"home": {"axis": "a", "method": 1, "wait_s": 5}}, {"command": {"axis": "a", "command": "move_absolute", "position": "${d}",
                                                                        "velocity": 1, "acceleration": 1, "deceleration": 1, "prepare": False, "wait_s": 1}},
        {"action": {"axis": "a", "name": "n", "argument": "x", "wait_s": 1}}, {"write_register": {"unit": 2, "address": 3, "type": "u16", "value": 4}},
        {"wait_for": {"axis": "a", "point": "state", "is": "fault", "timeout_s": 3}}, {"check": {"axis": "a", "parameter": "AC", "at_least": 2, "text": "t"}}, {"wait_s": 0.5},
        {"if": {"condition": {"axis": "a", "point": "position", "is": 1, "tolerance": 0.5}, "then": [{"wait_s": 1}], "else": [{"message": "m"}]}},
        {"repeat": {"times": 3, "until": {"axis": "a", "point": "moving", "is": False}, "steps": [{"wait_s": 1}]}}, {"message": "${d}"}]}
    spoiled = [whole]

    def walk(node, path):
        for key in list(node) if isinstance(node, dict) else range(len(node)):
            for change in ("without", None, [], {}, -5, "zzz", 10**6, True):
                copy_ = copy.deepcopy(whole)
                there = copy_
                for p in path:
                    there = there[p]
                if change == "without":
                    del there[key]
                else:
                    there[key] = change
                spoiled.append(copy_)
            if isinstance(node, dict):
                copy_ = copy.deepcopy(whole)
                there = copy_
                for p in path:
                    there = there[p]
                there["zzz"] = 1
                spoiled.append(copy_)
            if isinstance(node[key], (dict, list)):
                walk(node[key], [*path, key])
    walk(whole, [])
    disagree = []
    for d in spoiled:
        status, body, _ = gateway.request("PUT", "/api/v1/recipes/x?dry_run=1", d)
        assert status in (200, 422), (status, body)
        valid = validator.is_valid(d)
        if status == 422 and valid and json.dumps(d.get("parameters")) == json.dumps(whole["parameters"]):
            # Only what hangs on other values, which a schema cannot see, may be the program's alone.
            alone = [f for f in body["faults"] if not f["pointer"].startswith(ALONE)]
            if alone:
                disagree.append(("refused, though the schema takes it", alone[:1]))
    assert not disagree, f"{len(disagree)} of {len(spoiled)}: " + "\n".join(map(str, disagree[:20]))
