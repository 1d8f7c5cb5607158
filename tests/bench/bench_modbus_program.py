#!/usr/bin/env python3
"""Modbus benchmark of the real program: eight axes of it move while a load generator reads, beside a plain epoll server.

In: the program and bench_modbus. Out: what bench_modbus prints; exit 1 if a limit is not kept. The program gets processor 0, as the plain
server does, and the load generator processor 1. Never touches anything but the loopback and a folder of its own.
"""
import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench_program import Program  # noqa: E402

AXES = 8


def site(axes):
    lines = [{"name": f"can{i}", "uri": "twin", "family": "uim342", "bitrate": 1000000} for i in range((axes + 15) // 16)]
    drives = [{"name": f"a{i + 1}", "line": f"can{i // 16}", "address": 11 + i % 16} for i in range(axes)]
    axes = [{"name": f"a{i + 1}", "drive": f"a{i + 1}", "number": i + 1, "unit": "mm", "increments_per_unit": 100} for i in range(axes)]
    return {"lines": lines, "drives": drives, "axes": axes, "mappings": []}


def address(program, door):
    return next(word.split("=", 1)[1] for word in program.said.split() if word.startswith(door + "="))


def command(program, axis, body):
    request = urllib.request.Request(f"http://{address(program, 'http')}/api/v1/axes/{axis}/commands?wait=5", json.dumps(body).encode(), {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=10) as answer:
        return json.load(answer)


def moving(program):
    with urllib.request.urlopen(f"http://{address(program, 'http')}/api/v1/axes", timeout=10) as answer:
        return sum(bool(a["moving"]) for a in json.load(answer))


@contextlib.contextmanager
def moving_program(program, axes, *settings, cpu=None):
    """The program with so many axes, all moving now and still moving at the end, or there is no figure. `cpu`: all its threads there."""
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        folder = pathlib.Path(name)
        (folder / "site.json").write_text(json.dumps(site(axes)))
        p = Program(program, folder, "--site", str(folder / "site.json"), *settings)
        try:
            for thread in os.listdir(f"/proc/{p.process.pid}/task") if cpu is not None else []:
                os.sched_setaffinity(int(thread), {cpu})
            for i in range(axes):
                command(p, f"a{i + 1}", {"command": "enable"})
                command(p, f"a{i + 1}", {"command": "move_velocity", "velocity": 10 + i})
            time.sleep(0.3)
            if moving(p) != axes:
                raise SystemExit("bench: the axes do not move")
            yield p
            if moving(p) != axes:
                raise SystemExit("bench: the axes do not move any more")
        finally:
            p.stop()


def run(program, load, settings, arguments):
    with moving_program(program, AXES, *settings, cpu=0) as p:
        return subprocess.run([load, "--connect", address(p, "modbus"), *arguments], check=False).returncode == 0


def main():
    program, load = (str(pathlib.Path(a).resolve()) for a in sys.argv[1:3])
    print(f"the real program, {AXES} axes moving", flush=True)
    kept = run(program, load, [], ["--seconds", "1"])
    print(f"the real program, {AXES} axes moving, spin_us = 50", flush=True)
    kept &= run(program, load, ["--set", "runtime.spin_us=50"], ["--seconds", "1.5", "--point", "10x1x1", "--least-rate", "2.5", "--busy-load"])
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
