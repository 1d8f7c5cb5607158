#!/usr/bin/env python3
"""HTTP benchmark of the real program: eight of its axes move while a load generator asks for one, beside a bare Beast server.

In: the program and bench_http. Out: what bench_http prints; exit 1 if a limit is not kept. The program's thread for HTTP gets processor 0, as
the bare server does, and the load generator processor 1. Never touches anything but the loopback and a folder of its own.
"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench_modbus_program import address, moving_program  # noqa: E402

AXES = 8


def main():
    program, load = (str(pathlib.Path(a).resolve()) for a in sys.argv[1:3])
    print(f"the real program, {AXES} axes moving", flush=True)
    with moving_program(program, AXES) as p:
        for task in pathlib.Path(f"/proc/{p.process.pid}/task").iterdir():
            if (task / "comm").read_text().strip() == "axisgate-warm":
                os.sched_setaffinity(int(task.name), {0})
        return subprocess.run([load, address(p, "http"), str(p.process.pid), "a1", *sys.argv[3:]], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
