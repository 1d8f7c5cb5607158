# Loss of command from outside: the matrix over REST, a drive that could not be reached, the gateway's own end, and a rehearsal of all
# cells of a site with drives of several families. In: the program with its twins. Out: answers, axis states, a report without gaps.
import json
import pathlib
import time

from harness import Gateway, until

SITE = {
    "lines": [{"name": "can0", "uri": "twin", "family": "uim342"}, {"name": "rs", "uri": "twin", "family": "linmot"},
              {"name": "m", "uri": "twin", "family": "mcode"}, {"name": "pa", "uri": "twin", "family": "pacontrol"}],
    "drives": [{"name": "lift", "line": "can0", "address": 5}, {"name": "press", "line": "rs", "address": 17}, {"name": "table", "line": "m"}, {"name": "arm", "line": "pa"}],
    "axes": [{"name": n, "drive": n, "number": i + 1, "unit": "mm", "increments_per_unit": 100, "velocity_max": 50, "acceleration_max": 500}
             for i, n in enumerate(("lift", "press", "table", "arm"))],
    "mappings": [],
}
CAUSES = ["modbus_closed", "modbus_silent", "set_points_silent", "lease_ended", "enip_closed", "enip_timed_out", "enip_idle", "line_lost",
          "gateway_ends", "dds_deadline", "enip_session_closed", "enip_silent", "motion_unowned"]


def test_the_matrix_is_read_and_changed_axis_by_axis(folder):
    with Gateway(folder, SITE) as g:
        matrix = g.get("/fail_safe")
        assert [c["cause"] for c in matrix["causes"]] == CAUSES
        assert [c["number"] for c in matrix["causes"]] == list(range(1, 14))
        status, row, _ = g.request("PUT", "/api/v1/fail_safe/lift", {"line_lost": "disable", "watchdog_ms": 700})
        assert status == 200, row
        assert g.get("/fail_safe/lift")["fail_safe"]["line_lost"] == "disable"
        assert g.get("/fail_safe/lift")["watchdog_ms_in_force"] == 700
        assert g.get("/axes/lift")["fail_safe"] == {"line_lost": "disable", "watchdog_ms": 700}
        status, row, _ = g.request("PUT", "/api/v1/fail_safe/lift", {})
        assert status == 200 and g.get("/fail_safe/lift")["fail_safe"]["line_lost"] is None


def test_a_drive_that_could_not_be_reached_is_stopped_when_it_answers_again(folder):
    with Gateway(folder, SITE) as g:
        until(lambda: g.axis("lift")["online"], 10, "online")
        assert g.command("lift", {"command": "enable"})["result"] == "done"
        assert g.command("lift", {"command": "move_velocity", "velocity": 10})["result"] == "done"
        status, answer, _ = g.request("PUT", "/api/v1/drives/lift/hand", {"silent": True})
        assert status == 200, answer
        until(lambda: not g.axis("lift")["online"], 10, "silent")
        g.request("PUT", "/api/v1/drives/lift/hand", {"silent": False})
        until(lambda: g.axis("lift")["online"] and not g.axis("lift")["moving"], 10, "halted")
        axis = g.axis("lift")
        assert axis["fail_safe_cause"] == "line_lost" and axis["state"] == "operation_enabled", axis


def test_a_lease_that_expires_ends_a_velocity_move(folder):
    site = dict(SITE, axes=[dict(a, authority_mode="lease") for a in SITE["axes"]])
    with Gateway(folder, site, "--set", "authority.lease_s=2") as g:
        until(lambda: g.axis("table")["online"], 10, "online")
        status, answer, _ = g.request("PUT", "/api/v1/axes/table/authority", {"ttl_s": 2})
        assert status == 200, answer
        assert g.command("table", {"command": "enable"})["result"] == "done"
        assert g.command("table", {"command": "move_velocity", "velocity": 10})["result"] == "done"
        until(lambda: g.axis("table")["fail_safe_cause"] == "lease_ended", 40, "its lease ends")
        until(lambda: not g.axis("table")["moving"], 5, "halted")


def test_a_rehearsal_leaves_no_cell_without_a_figure(folder):
    with Gateway(folder, SITE) as g:
        before = {n: g.axis(n)["position_increments"] for n in ("lift", "press", "table", "arm")}
        g.request("PUT", "/api/v1/fail_safe/press", {"modbus_closed": "nothing"})
        status, state, _ = g.request("POST", "/api/v1/fail_safe/rehearsal", {})
        assert status == 202 and state["state"] == "running" and state["total"] == 57, state
        assert g.request("POST", "/api/v1/fail_safe/rehearsal", {})[0] == 409
        until(lambda: g.get("/fail_safe/rehearsal")["state"] == "done", 60, "the rehearsal's end")
        report = g.get("/fail_safe/rehearsal")["report"]
        cells = {(c["axis"], c["cause"]): c for c in report["cells"]}
        assert set(cells) == {(a, c) for a in before for c in CAUSES + ["gateway_gone", "gateway_restarts"] if c != "set_points_silent" or a == "press"}
        assert report["without_set_points"] == ["lift", "table", "arm"]
        assert report["without_figures"] == 0, [c for c in report["cells"] if c["text"].startswith("no figures")]
        for cell in report["cells"]:
            assert cell["standstill_ms"] is not None or cell["cause"] == "gateway_gone", cell
        assert cells["press", "modbus_closed"]["taken"] == "nothing" and cells["press", "modbus_closed"]["motion"] == "position"
        assert cells["lift", "modbus_silent"]["noticed_ms"] >= 5000 and cells["lift", "enip_silent"]["noticed_ms"] >= 5000
        assert cells["lift", "enip_timed_out"]["noticed_ms"] < 5
        for (axis, cause), cell in cells.items():
            really = {"gateway_gone": None, "gateway_restarts": "motion_unowned"}.get(cause, cause)
            assert cell["ended_by"] == ("target" if (axis, cause) == ("press", "modbus_closed") else really), cell
            assert cell["moved_again"] is (None if cause in ("gateway_gone", "lease_ended", "set_points_silent", "dds_deadline") else False), cell
        time.sleep(0.2)
        assert before == {n: g.axis(n)["position_increments"] for n in before}, "nothing real has moved"
        assert g.get("/events?kind=rehearsal")
    with Gateway(folder, None) as g:
        assert g.get("/fail_safe/rehearsal")["report"] == report, "it is kept"


def test_every_axis_of_the_demo_has_a_figure_for_every_cause(folder):
    demo = json.loads((pathlib.Path(__file__).resolve().parents[2] / "deploy/examples/demo-site.json").read_text())
    with Gateway(folder, demo) as g:
        names = [a["name"] for a in demo["axes"]]
        until(lambda: all(g.axis(n)["online"] for n in names), 20, "online")
        rows = {r["axis"]: r["drive_watchdog"] for r in g.get("/fail_safe")["axes"]}
        own = {n for n in names if rows[n]["available"]}
        assert own == {"spindle", "macs.master", "macs.slave"}, rows
        for n in own:
            until(lambda: g.get(f"/fail_safe/{n}")["drive_watchdog"]["state"] == "armed", 10, "armed")
            row = g.get(f"/fail_safe/{n}")["drive_watchdog"]
            assert (row["time_ms"], row["action"]) == (1000, "quick_stop"), row
        status, state, _ = g.request("POST", "/api/v1/fail_safe/rehearsal", {})
        assert status == 202, state
        until(lambda: g.get("/fail_safe/rehearsal")["state"] == "done", 120, "the rehearsal's end")
        report = g.get("/fail_safe/rehearsal")["report"]
        cells = {(c["axis"], c["cause"]): c for c in report["cells"]}
        streams = set(names) - set(report["without_set_points"])
        assert streams == {"shuttle", "spindle"}, report["without_set_points"]
        assert set(cells) == {(n, c) for n in names for c in CAUSES + ["gateway_gone", "gateway_restarts"] if c != "set_points_silent" or n in streams}
        assert report["without_figures"] == 0, [c for c in report["cells"] if c["text"].startswith("no figures")]
        for cell in report["cells"]:
            stops = cell["cause"] != "gateway_gone" or cell["axis"] in own
            assert (cell["reaction_ms"] is not None) == stops and (cell["standstill_ms"] is not None) == stops, cell
        for n in own:
            assert 900 <= cells[n, "gateway_gone"]["reaction_ms"] <= 1200, cells[n, "gateway_gone"]
        for cause in CAUSES:
            if cause not in ("modbus_silent", "enip_silent", "lease_ended", "line_lost", "set_points_silent", "motion_unowned"):
                assert cells["spindle", cause]["noticed_ms"] < 5, cells["spindle", cause]
        assert not [c for c in report["cells"] if c["moved_again"]], "an old image moves nothing"
        for n in names:  # a gateway that comes back after 3 s finds a drive that has stopped by itself, or stops it
            assert cells[n, "gateway_restarts"]["ended_by"] == ("drive" if n in own else "motion_unowned"), cells[n, "gateway_restarts"]


def test_the_limits_that_a_drive_keeps_by_itself_are_shown(folder):
    site = {"lines": [{"name": "can0", "uri": "twin", "family": "cia402"}, {"name": "m", "uri": "twin", "family": "mcode"}],
            "drives": [{"name": "spindle", "line": "can0", "address": 5}, {"name": "table", "line": "m"}],
            "axes": [{"name": n, "drive": n, "number": i + 1, "unit": "mm", "increments_per_unit": 100} for i, n in enumerate(("spindle", "table"))], "mappings": []}
    with Gateway(folder, site) as g:
        limits = lambda n: g.get(f"/fail_safe/{n}")["drive_limits"]
        until(lambda: g.axis("spindle")["online"], 10, "online")
        assert (limits("spindle")["available"], limits("spindle")["wanted"], limits("spindle")["state"]) == (True, False, None)
        assert limits("table")["available"] is False and limits("table")["description"]
        status, answer, _ = g.request("PATCH", "/api/v1/axes/spindle", {"position_min": -100, "position_max": 100})
        assert status == 200, answer
        until(lambda: limits("spindle")["state"] == "armed", 10, "written and acknowledged")
        assert limits("spindle")["wanted"] and limits("spindle")["refusal"] is None
        status, answer, _ = g.request("PATCH", "/api/v1/drives/spindle", {"options": {"drive_limits": "off"}})
        assert status == 200, answer
        until(lambda: limits("spindle")["state"] == "off", 10, "left alone")
