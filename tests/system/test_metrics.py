"""/metrics from outside: every figure that the dashboard and the alert rules name is there, histograms are histograms, and they count what happens.

In: the real program, deploy/grafana, deploy/prometheus. Out: judgements on figures. Never sleeps longer than something takes to be counted.
"""
import json
import pathlib
import re

import yaml

from harness import DEMO, Gateway, Process, until

TOP = pathlib.Path(__file__).resolve().parents[2]
FAR_SITE = {
    "lines": [{"name": "bus", "uri": None, "family": "mcode"}],
    "drives": [{"name": "m", "line": "bus", "address": "!", "presence": "device"}],
    "axes": [{"name": "m", "drive": "m", "number": 1, "unit": "mm", "increments_per_unit": 100}],
    "mappings": [],
}


def figures(gateway):
    """{name: {labels: value}} and {name: type}, as Prometheus reads the page."""
    values, types = {}, {}
    for line in gateway.request("GET", "/metrics")[1].decode().splitlines():
        if line.startswith("# TYPE "):
            _, _, name, kind = line.split()
            assert name not in types, f"{name} twice"
            types[name] = kind
        elif line and not line.startswith("#"):
            m = re.fullmatch(r"([a-z_][a-z0-9_]*)(?:\{(.*)\})? (\S+)", line)
            assert m, line
            values.setdefault(m[1], {})[m[2] or ""] = float(m[3])
    return values, types


def names_in(expression):
    return set(re.findall(r"\b(?:axisgate|process)_[a-z0-9_]+", expression))


def dashboard():
    board = json.loads((TOP / "deploy/grafana/axisgate.json").read_text())
    panels = [p for p in board["panels"] if p["type"] != "row"]
    return board, panels


def test_dashboard_and_rules_name_only_what_is_there(folder):
    with Gateway(folder) as g0:  # without a serial port its figures are absent, and no alert comes of it
        values, _ = figures(g0)
        assert not [n for n in values if n.startswith("axisgate_modbus_rtu_")]
    (folder / "b").mkdir()
    board, panels = dashboard()
    rules = [r for group in yaml.safe_load((TOP / "deploy/prometheus/axisgate.rules.yml").read_text())["groups"] for r in group["rules"]]
    with Gateway(folder / "b", DEMO, "--set", f"modbus_rtu.port=pty:{folder / 'rtu'}") as g:
        g.command("feeder", {"command": "enable"})
        g.command("feeder", {"command": "move_velocity", "velocity": 1}, wait=0)
        until(lambda: "axisgate_axis_following_error" in figures(g)[0], 20, "an axis whose demand is known, since it moves")
        values, types = figures(g)  # /metrics itself was a request that HTTP can count
    known = set(values)
    for kind in ("histogram", "summary"):
        for name in [n for n, t in types.items() if t == kind]:
            assert {name + "_bucket", name + "_sum", name + "_count"} <= known, name
    assert len(panels) >= 25 and len(rules) >= 18
    for panel in panels:
        assert panel["title"] and panel["targets"], panel
        for target in panel["targets"]:
            used = names_in(target["expr"])
            assert used and used <= known, (panel["title"], used - known)
            assert '{instance=~"$instance"' in target["expr"], panel["title"]
            labels = set(re.findall(r"\{\{(\w+)\}\}", target["legendFormat"])) - {"instance"}
            for name in used:
                for label in labels:
                    assert all(f'{label}="' in have for have in values[name]), (panel["title"], name, label)
    ids = [p["id"] for p in board["panels"]]
    assert len(set(ids)) == len(ids)
    for rule in rules:
        used = names_in(rule["expr"])
        assert used and used <= known, (rule["alert"], used - known)
        assert rule["labels"]["severity"] in ("critical", "warning", "info") and rule["annotations"]["summary"] and rule["annotations"]["description"], rule
        said = rule["annotations"]["summary"] + rule["annotations"]["description"]
        for label in set(re.findall(r"\$labels\.(\w+)", said)):
            assert any(f'{label}="' in have for name in used for have in values[name]), (rule["alert"], label)
    assert len({r["alert"] for r in rules}) == len(rules)


def judge_histogram(values, name):
    buckets = [(float(re.search(r'le="([^"]+)"', labels)[1].replace("+Inf", "inf")), n) for labels, n in values[name + "_bucket"].items()]
    assert buckets == sorted(buckets) and buckets[-1][0] == float("inf"), name
    counts = [n for _, n in buckets]
    assert counts == sorted(counts) and counts[-1] == values[name + "_count"][""], (name, buckets)
    assert values[name + "_sum"][""] <= sum((n - before) * min(le, 1e6) for (le, n), before in zip(buckets, [0] + counts)), name
    return counts[-1]


def test_histograms_count_what_happens(folder):
    with Process("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0") as far:
        address = re.search(r"tcp-listen:(\S+?)(?:\s|$)", far.ready) or re.search(r"(127\.0\.0\.1:\d+)", far.ready)
        site = json.loads(json.dumps(FAR_SITE))
        site["lines"][0]["uri"] = "tcp:" + address[1]
        with Gateway(folder, site) as g, g.modbus() as m:
            until(lambda: g.get("/axes/m")["online"], 10, "the drive")
            before, types = figures(g)
            names = [n for n, t in types.items() if t == "histogram"]
            assert set(names) >= {"axisgate_hot_turn_seconds", "axisgate_hot_wake_delay_seconds", "axisgate_write_to_frame_seconds", "axisgate_store_batch_seconds",
                                  "axisgate_modbus_request_duration_seconds", "axisgate_http_request_duration_seconds"}, names
            for _ in range(20):
                m.read(0, 20)
            g.send("PUT", "/axes/m/parameters/VI", {"value": 1200})
            m.write1(32, 6)
            after, _ = figures(g)
            for name in names:
                was, now = judge_histogram(before, name), judge_histogram(after, name)
                assert now >= was, name

            def more(name):
                return after[name + "_count"][""] - before[name + "_count"][""]
            assert more("axisgate_modbus_request_duration_seconds") == 21
            assert more("axisgate_write_to_frame_seconds") >= 1, "the parameter's line left the gateway"
            assert more("axisgate_store_batch_seconds") >= 1 and more("axisgate_hot_turn_seconds") >= 20
            assert after["axisgate_write_to_frame_seconds_sum"][""] < 5
            assert 0 < after["axisgate_hot_turn_p999_seconds"][""] <= 10
            assert after["axisgate_drive_device_online"]['drive="m"'] == 1 and after["axisgate_drive_simulated"]['drive="m"'] == 0
            # What lines say of themselves is some 200 ms old at most.
            until(lambda: figures(g)[0]["axisgate_line_sent_bytes_total"]['line="bus"'] > before["axisgate_line_sent_bytes_total"]['line="bus"'], 5, "the line's bytes")
            assert set(after["axisgate_queue_full_total"].values()) == {0}
            # The process as the kernel sees it.
            status = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{g.process.pid}/status").read_text().splitlines())
            assert after["process_threads"][""] == int(status["Threads"])
            assert abs(after["process_resident_memory_bytes"][""] / 1024 / int(status["VmRSS"].split()[0]) - 1) < 0.2
            assert after["process_cpu_seconds_total"][""] > 0
            assert 5 < after["process_open_fds"][""] < after["process_max_fds"][""]
            began = pathlib.Path(f"/proc/{g.process.pid}").stat().st_mtime
            assert abs(after["process_start_time_seconds"][""] - began) < 120
