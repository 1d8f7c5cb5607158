"""The recorder from outside: trends while an axis moves, a recording that `axisgate replay` plays without a difference, files that are not to be trusted, a full disk.

In: the real program with simulated drives. Out: judgements.
"""
import pathlib
import time

import harness
from harness import until


def replay(path):
    code, told, wrong = harness.run("replay", str(path))
    return code, told + wrong


def move_a_little(gateway):
    gateway.command("slide", {"command": "enable"})
    gateway.command("slide", {"command": "move_relative", "position": 5, "velocity": 20, "acceleration": 200, "deceleration": 200})
    gateway.command("slide", {"command": "disable"})


def test_trends_show_what_moved(gateway):
    move_a_little(gateway)
    axis = until(lambda: next((a for a in gateway.get("/recorder/trends?axes=slide&points=position,velocity,state&columns=5000")["axes"]
                               if len(a["at"]) > 5 and a["rate_hz"] > 0), None), 10, "rows, and their rate")
    position = axis["points"]["position"]
    low, high = position.get("values") or position["low"], position.get("values") or position["high"]
    assert max(v for v in high if v is not None) - min(v for v in low if v is not None) > 4
    assert "operation_enabled" in axis["points"]["state"]["values"]
    status, text, _ = gateway.request("GET", "/api/v1/recorder/trends?axes=slide", None, {"Accept": "text/csv"})
    assert status == 200 and text.startswith(b"time,axis,unit,position_low"), text[:200]


def test_a_recording_is_played_again_without_a_difference(gateway, folder):
    move_a_little(gateway)
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": True})
    until(lambda: not gateway.axis("feeder")["online"], 10, "silence")
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": False})
    until(lambda: gateway.axis("feeder")["online"], 10, "its return")
    made = gateway.send("POST", "/recorder/recordings", {"name": "crash", "why": "test"}, 201)
    assert made["replayable"] and made["bytes"] > 1000, made
    end = gateway.get("/recorder/recordings/crash/playback?columns=500")
    slide = next(a for a in end["axes"] if a["name"] == "slide")
    assert abs(slide["position"] - gateway.axis("slide")["position"]) < 0.01 and slide["state"] == "switch_on_disabled", slide
    assert end["frames"] and any(f["decoded"] for f in end["frames"]) and any("disable" in h["text"] for h in end["happened"]), end["frames"][-1]
    high = max(v for a in end["curves"] if a["axis"] == "slide" for v in (a["points"]["position"].get("high") or a["points"]["position"]["values"]))
    begin = int(next(a for a in end["curves"] if a["axis"] == "slide")["at"][0]) + 5
    early = gateway.get(f"/recorder/recordings/crash/playback?at={begin}&frames=0")
    before = next(a for a in early["axes"] if a["name"] == "slide")["position"]
    assert high - before > 4 and early["frames"] == [], (high, before)
    words = next(r for r in end["registers"] if r["axis"] == "slide")["words"]
    shown = (words[2] << 16 | words[3]) - (1 << 32 if words[2] & 0x8000 else 0)
    assert abs(shown / slide["increments_per_unit"] - slide["position"]) < 0.01, (words, slide)
    file = folder / "data" / "recordings" / "crash.axr"
    code, told = replay(file)
    assert code == 0 and " 0 differences" in told, told
    whole = file.read_bytes()
    wrong = file.with_name("wrong.axr")
    for name, data in (("cut off", whole[:-100]), ("altered", whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:]), ("version 2", whole[:8] + b"\x02" + whole[9:]), ("no recording", b"nothing")):
        wrong.write_bytes(data)
        code, told = replay(wrong)
        assert code != 0 and name in told, (name, told)


def test_an_alarm_freezes_by_itself(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 1, "acceleration": 20}, wait=0)
    gateway.send("PATCH", "/drives/feeder/hand", {"stall": True})
    made = until(lambda: gateway.get("/recorder/recordings")["recordings"], 15, "a recording")[0]
    assert made["automatic"] and made["name"].startswith("alarm-") and made["why"].startswith("fault feeder"), made


def test_a_full_disk_stops_recording_and_nothing_else(folder):
    with harness.Gateway(folder) as g:
        recordings = folder / "data" / "recordings"
        recordings.write_text("a file stands where the folder should be")
        status, said, _ = g.request("POST", "/api/v1/recorder/recordings", {"name": "crash"})
        assert status == 507 and said["reason"] == "not_stored", (status, said)
        assert g.get("/recorder/recordings")["disk_fault"]
        move_a_little(g)
        recordings.unlink()
        g.send("POST", "/recorder/recordings", {"name": "crash"}, 201)
        assert g.get("/recorder/recordings")["disk_fault"] is None


def test_recordings_outlive_the_gateway_and_say_when_they_cannot_be_replayed(folder):
    with harness.Gateway(folder, harness.DEMO, "--set", "recorder.inputs_mb=0") as g:
        until(lambda: g.get("/recorder/recordings")["not_replayable"], 10, "the end of the inputs' memory")
        made = g.send("POST", "/recorder/recordings", {"name": "late"}, 201)
        assert not made["replayable"] and "inputs_mb" in made["not_replayable"], made
    file = folder / "data" / "recordings" / "late.axr"
    whole = file.read_bytes()
    wrong = {"cut off": whole[:-100], "was altered": whole[:-500] + bytes([whole[-500] ^ 1]) + whole[-499:], "version 2": whole[:8] + b"\x02" + whole[9:]}
    for i, data in enumerate(wrong.values()):
        file.with_name(f"wrong{i}.axr").write_bytes(data)
    with harness.Gateway(folder, None) as g:
        def listed():
            return {r["name"]: r for r in g.get("/recorder/recordings")["recordings"]}
        assert sorted(listed()) == ["late", "wrong0", "wrong1", "wrong2"]
        # Behind its beginning a file is read after the start.
        until(lambda: all(listed()[f"wrong{i}"]["fault"] for i in range(3)), 10, "what is damaged to be said")
        for i, words in enumerate(wrong):
            damaged = listed()[f"wrong{i}"]
            assert words in damaged["fault"] and not damaged["replayable"], damaged
            status, said, _ = g.request("GET", f"/api/v1/recorder/recordings/wrong{i}/playback")
            assert status == 409 and words in said["detail"], said
        assert listed()["late"]["fault"] is None and g.get("/recorder/recordings/late/playback")["axes"]
        code, told = replay(file)
        assert code != 0 and "not replayed" in told, told


def wait_for_capture(gateway, name, state="done"):
    return until(lambda: next((c for c in gateway.get("/recorder/captures")["captures"] if c["name"] == name and c["state"] == state
                               and (state != "done" or c["bytes"] > 0)), None), 20, f"{name} {state}")


def test_a_capture_triggers_by_a_level_at_a_kilohertz_and_is_kept(gateway, folder):
    gateway.command("slide", {"command": "enable"})
    before = gateway.axis("slide")["position"]
    wish = {"name": "before-tuning", "axes": ["slide"], "before_ms": 100, "after_ms": 400, "trigger": {"kind": "level", "level": before + 1}}
    made = gateway.send("POST", "/recorder/captures", wish, 201)
    assert made["state"] == "armed", made
    status, said, _ = gateway.request("POST", "/api/v1/recorder/captures", dict(wish, name="second"))
    assert status == 503 and "before-tuning" in said["detail"], (status, said)
    gateway.command("slide", {"command": "move_relative", "position": 5, "velocity": 20, "acceleration": 200, "deceleration": 200})
    info = wait_for_capture(gateway, "before-tuning")
    assert info["axes"][0]["rate_hz"] > 300, info
    whole = gateway.get("/recorder/captures/before-tuning")
    column = whole["columns"][0]
    assert min(column["seconds"]) < -0.05 and max(column["seconds"]) > 0.35, (min(column["seconds"]), max(column["seconds"]))
    behind = [p for s, p in zip(column["seconds"], column["position"]) if s >= 0]
    ahead = [p for s, p in zip(column["seconds"], column["position"]) if s < 0]
    assert max(ahead) < before + 1 <= behind[1] and max(behind) > before + 3, (before, max(ahead), behind[:2])
    status, text, _ = gateway.request("GET", "/api/v1/recorder/captures/before-tuning", None, {"Accept": "text/csv"})
    assert status == 200 and text.count(b"\r\n") == len(column["seconds"]) + 1, text[:200]
    assert gateway.send("PATCH", "/recorder/captures/before-tuning", {"name": "kept"})["name"] == "kept"
    file = folder / "data" / "captures" / "kept.axc"
    whole = file.read_bytes()
    file.write_bytes(whole[:-40])
    status, said, _ = gateway.request("GET", "/api/v1/recorder/captures/kept")
    assert status == 409 and "cut off" in said["detail"], said
    file.write_bytes(whole)


def test_captures_by_command_and_state_are_given_up_and_cancelled(folder):
    with harness.Gateway(folder, harness.DEMO) as g:
        g.command("slide", {"command": "enable"})
        g.send("POST", "/recorder/captures", {"name": "start", "axes": ["slide"], "after_ms": 200, "trigger": {"kind": "command"}}, 201)
        g.command("slide", {"command": "move_relative", "position": 2, "velocity": 20, "acceleration": 200, "deceleration": 200})
        assert wait_for_capture(g, "start")["trigger"] == {"kind": "command", "axis": "slide"}
        g.send("POST", "/recorder/captures", {"name": "never", "axes": ["slide"], "wait_ms": 300, "trigger": {"kind": "state", "state": "fault"}}, 201)
        assert "did not come within" in wait_for_capture(g, "never", "cancelled")["why"]
        g.send("POST", "/recorder/captures", {"name": "long", "axes": ["slide"], "trigger": {"kind": "state", "state": "fault"}}, 201)
        g.send("DELETE", "/recorder/captures/long", None, 204)
        g.send("POST", "/recorder/captures", {"name": "never", "axes": ["slide"], "after_ms": 100}, 201)  # a name that was given up is free
        wait_for_capture(g, "never")
    with harness.Gateway(folder, None) as g:
        assert sorted(c["name"] for c in g.get("/recorder/captures")["captures"]) == ["never", "start"]
        g.send("DELETE", "/recorder/captures/start", None, 204)
        assert [c["name"] for c in g.get("/recorder/captures")["captures"]] == ["never"]


def test_the_kept_recordings_do_the_same_again():
    kept = sorted((pathlib.Path(__file__).resolve().parents[1] / "recordings").glob("*.axr"))
    assert len(kept) >= 3, kept
    for file in kept:
        assert file.stat().st_size < 200_000, (file, file.stat().st_size)
        code, told = replay(file)
        assert code == 0 and " 0 differences" in told, f"{file.name}: {told}\nIf this is as it should be: tests/recordings/make.py build/release/axisgate"


def test_the_site_says_whose_trends_are_on_the_disk(folder):
    trends = folder / "data" / "trends"

    def told(g, axis):
        return [a for a in g.get(f"/recorder/trends?axes={axis}&points=position&columns=5000")["axes"] if a["at"]]

    def positions(g):
        return [v for a in told(g, "slide") for v in a["points"]["position"].get("values") or a["points"]["position"]["high"] if v is not None]

    def moved_and_ended(g):
        move_a_little(g)
        until(lambda: told(g, "slide") and told(g, "feeder"), 10, "rows of both")
        time.sleep(1)  # what was told a moment ago is on its way
        assert g.stop() == 0

    with harness.Gateway(folder, harness.DEMO) as g:
        moved_and_ended(g)
    assert not list(trends.glob("*")), "nobody has asked for it"
    with harness.Gateway(folder, None, "--set", "recorder.trend_disk_mb=0") as g:
        status, refused, _ = g.request("PATCH", "/api/v1/axes/slide", {"trend_on_disk": "yes"}, {"Content-Type": "application/merge-patch+json"})
        assert status == 422 and "must be true or false" in str(refused), refused
        g.send("PATCH", "/axes/slide", {"trend_on_disk": True})
        moved_and_ended(g)
    assert not list(trends.glob("*")), "the host keeps off its disk"
    with harness.Gateway(folder, None) as g:
        assert {a["name"]: a.get("trend_on_disk") for a in g.get("/site")["axes"]} == {"feeder": None, "slide": True}
        g.send("PATCH", "/axes/slide", {"trend_on_disk": False})
        g.send("PATCH", "/axes/slide", {"trend_on_disk": True})  # it counts in a gateway that runs
        moved_and_ended(g)
    kept = b"".join(p.read_bytes() for p in trends.glob("*.axt"))
    assert b"slide" in kept and b"feeder" not in kept
    with harness.Gateway(folder, None) as g:
        until(lambda: (v := positions(g)) and max(v) - min(v) > 4, 15, "what was before")


def test_trends_on_the_disk_outlive_the_gateway(folder):
    settings = ("--set", "recorder.trend_disk_mb=8")
    with harness.Gateway(folder, harness.DEMO, *settings) as g:
        move_a_little(g)
        until(lambda: g.get("/recorder/trends?axes=slide&points=position")["axes"][0]["at"], 10, "rows")
        time.sleep(1)  # what was told a moment ago is on its way
        assert g.stop() == 0
    files = list((folder / "data" / "trends").glob("*.axt"))
    assert files, "nothing was written at the end"
    with harness.Gateway(folder, None, *settings) as g:
        axis = until(lambda: next((a for a in g.get("/recorder/trends?axes=slide&points=position,state&columns=5000")["axes"] if len(a["at"]) > 5), None), 15, "what was before")
        position = axis["points"]["position"]
        values = [v for v in (position.get("values") or position["high"]) if v is not None]
        assert max(values) - min(values) > 4 and "operation_enabled" in axis["points"]["state"]["values"], axis
    (folder / "data" / "trends" / files[0].name).write_bytes(files[0].read_bytes()[:-50])
    with harness.Gateway(folder, None, *settings) as g:
        until(lambda: any("damaged" in e["text"] for e in g.get("/events?kind=recording&limit=100")), 10, "a word of it")
        move_a_little(g)
