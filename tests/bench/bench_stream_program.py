#!/usr/bin/env python3
"""Stream benchmark of the real program: 32 of its axes move, a hundred clients watch them at 20 Hz and the rest as the page does.

In: the program and bench_stream. Out: what bench_stream prints; exit 1 if a limit is not kept. Processor time is the whole program's, as
/proc tells it, lines and twins included. Never touches anything but the loopback and a folder of its own.
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench_modbus_program import address, moving_program  # noqa: E402

CLIENTS, AXES, PERIOD_MS, SECONDS = 100, 32, 50, 20


def main():
    program, crowd = (str(pathlib.Path(a).resolve()) for a in sys.argv[1:3])
    seconds = sys.argv[3] if len(sys.argv) > 3 else str(SECONDS)
    print(f"the real program, {AXES} axes moving, {CLIENTS} clients, {1000 // PERIOD_MS} Hz, {seconds} s", flush=True)
    with moving_program(program, AXES) as p:
        return subprocess.run([crowd, address(p, "http"), str(p.process.pid), str(CLIENTS), str(AXES), str(PERIOD_MS), seconds], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
