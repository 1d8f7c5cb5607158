#!/usr/bin/env python3
"""CiA 402 benchmark of the real program: the beat of the SYNC on simulated buses, and what axes at rest cost.

In: the program's path. Out: per figure the ratio, the limit it is measured against, and both figures; the bus load beside it; code 1 if a limit is
not kept. A bus of 1 Mbit/s has no room for the PDOs of 32 axes in 2 ms: they are 355 bits of each axis and 55 of the SYNC, 11.4 ms, and half of the
bus is for others. Beside it a bare beat of the same period and rank says what the machine does to one. Measured are the most axes that fit 2 ms,
found by asking for one more, and 32 axes at the shortest cycle that fits. All move.
"""
import calendar
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench_modbus_program import address, command, moving  # noqa: E402
from bench_program import Program, say  # noqa: E402

P99_US, P9999_US, REST_PERCENT = 200, 1000, 3
LOG_FRAMES = 250000  # more than a run's
SYNC_BITS, AXIS_BITS = 55, 125 + 135 + 95  # at most: docs/handbook/family-cia402.md


def shortest_ms(axes):
    """Of a bus of 1 Mbit/s, half of which is for others."""
    return max(1, math.ceil(2 * (SYNC_BITS + AXIS_BITS * axes) / 1000))


def site(axes, lines, poll_period_ms):
    per_line = (axes + lines - 1) // lines
    names = [f"a{i + 1}" for i in range(axes)]
    return {"lines": [{"name": f"can{i}", "uri": "twin", "family": "cia402", "bitrate": 1000000, "manners": {"poll_period_ms": poll_period_ms}} for i in range(lines)],
            "drives": [{"name": n, "line": f"can{i // per_line}", "address": 1 + i % per_line} for i, n in enumerate(names)],
            "axes": [{"name": n, "drive": n, "number": i + 1, "unit": "mm", "increments_per_unit": 100} for i, n in enumerate(names)], "mappings": []}


def get(program, path):
    with urllib.request.urlopen(f"http://{address(program, 'http')}/api/v1{path}", timeout=10) as answer:
        return answer.read()


def online(program):
    return sum(bool(a["online"]) for a in json.loads(get(program, "/axes")))


def started(program, folder, axes, lines, poll_period_ms):
    (folder / "site.json").write_text(json.dumps(site(axes, lines, poll_period_ms)))
    p = Program(program, folder, "--site", str(folder / "site.json"), "--set", f"limits.trace_frames={LOG_FRAMES}")
    end = time.monotonic() + 20
    while online(p) != axes:
        if time.monotonic() > end:
            p.stop()
            raise SystemExit(f"bench_cia402: {online(p)} of {axes} drives are there after 20 s")
        time.sleep(0.1)
    return p


def microseconds(text):
    whole, _, part = text.rstrip("Z").partition(".")
    return calendar.timegm(time.strptime(whole, "%Y-%m-%dT%H:%M:%S")) * 10**6 + float("0." + (part or "0")) * 1e6


def beats(program, seconds):
    """Instants of the SYNCs on can0 in microseconds, and how many frames of the log were overwritten before they were read. The log holds all
    of them and is read at the end: a reader beside it would be measured, too."""
    at, missed, since = [], 0, json.loads(get(program, "/lines/can0/trace?format=json&limit=1"))["next"]
    time.sleep(seconds)
    while True:
        trace = json.loads(get(program, f"/lines/can0/trace?format=json&since={since}&limit=65536"))
        missed, since = missed + trace["missed"], trace["next"]
        at += [microseconds(f["at"]) for f in trace["frames"] if f["id"] == 0x80 and not f["data"]]
        if len(trace["frames"]) < 65536:
            return at, missed


def jitter(program, axes, poll_period_ms, seconds):
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        p = started(program, pathlib.Path(name), axes, 1, poll_period_ms)
        try:
            for i in range(axes):
                command(p, f"a{i + 1}", {"command": "enable"})
                command(p, f"a{i + 1}", {"command": "move_velocity", "velocity": 10 + i})
            time.sleep(0.5)
            if moving(p) != axes:
                raise SystemExit("bench_cia402: the axes do not move")
            with subprocess.Popen([sys.executable, str(pathlib.Path(__file__).with_name("bare_beat.py")), str(max(poll_period_ms, shortest_ms(axes))), str(seconds)], stdout=subprocess.PIPE) as bare:
                at, missed = beats(p, seconds)
                beside = json.loads(bare.communicate(timeout=seconds + 10)[0])
            load = json.loads(get(p, "/lines/can0"))["status"]["load"]
            if moving(p) != axes:
                raise SystemExit("bench_cia402: the axes do not move any more")
        finally:
            p.stop()
    gaps = sorted(b - a for a, b in zip(at, at[1:]))
    if len(gaps) < 100:
        raise SystemExit(f"bench_cia402: {len(gaps)} SYNCs were seen")
    if missed:
        raise SystemExit(f"bench_cia402: {missed} frames were overwritten before they were read")
    cycle = round(gaps[len(gaps) // 2] / 1000)  # whole milliseconds
    off = sorted(abs(g - cycle * 1000) for g in gaps)
    print(f"    {axes} axes, asked for {poll_period_ms} ms: a SYNC each {cycle} ms, {len(gaps)} of them, longest gap {gaps[-1] / 1000:.2f} ms, bus load {100 * load:.0f} %", flush=True)
    kept = say(f"{axes} axes: beat off by, p99", off[int(0.99 * (len(off) - 1))], P99_US, "us")
    kept &= say(f"{axes} axes: beat off by, p99.99", off[int(0.9999 * (len(off) - 1))], P9999_US, "us")
    print(f"    a bare beat beside it: p99 {beside['p99_us']:.0f} us, p99.99 {beside['p9999_us']:.0f} us, longest {beside['longest_us'] / 1000:.2f} ms", flush=True)
    return kept & say(f"{axes} axes: bus load", 100 * load, 80, "%"), cycle


def rest(program, axes):
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        p = started(program, pathlib.Path(name), axes, 2, 20)
        try:
            time.sleep(2.5)
            before = p.processor_s()
            time.sleep(4)
            return say(f"processor with {axes} axes at rest", 25 * (p.processor_s() - before), REST_PERCENT, "%")
        finally:
            p.stop()


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    print("the real program with simulated CiA 402 drives at 1 Mbit/s", flush=True)
    most = max(n for n in range(1, 33) if shortest_ms(n) <= 2)
    few, cycle = jitter(program, most, 2, 21)
    kept = few & say(f"{most} axes: cycle", cycle, 2, "ms")
    _, longer = jitter(program, most + 1, 2, 4)
    print(f"    {most} axes are the most at 2 ms: with {most + 1} it is {longer} ms", flush=True)
    many, cycle = jitter(program, 32, 2, 24)
    kept &= many & (longer > 2) & say(f"32 axes: cycle, of {shortest_ms(32)} ms that fit", cycle, shortest_ms(32), "ms")
    kept &= rest(program, 64)
    print("all limits kept" if kept else "NOT all limits kept")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
