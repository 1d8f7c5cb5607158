#!/usr/bin/env python3
"""EtherNet/IP benchmark of the real program: explicit messages, 32 connections of implicit data beside Modbus, an owner that falls silent.

In: the program and bench_enip. Out: what bench_enip prints; exit 1 if a limit is not kept. For explicit messages the program has processor 0, as
the plain echo has while the program is stopped (SIGSTOP), and the load generator processor 1. Never touches anything but the loopback and a folder of its own.
"""
import json
import pathlib
import socket
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench_modbus_program import address, moving_program, site  # noqa: E402
from bench_program import Program  # noqa: E402


def settings():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        port = s.getsockname()[1]
    return port, ["--set", "enip.bind=127.0.0.1:0", "--set", f"enip.io_port={port}"]


def main():
    program, bench = (str(pathlib.Path(a).resolve()) for a in sys.argv[1:3])
    worst = 0
    _, more = settings()
    print("the real program, 8 axes moving: Get_Attribute_Single of an assembly of 32 bytes", flush=True)
    with moving_program(program, 8, *more, cpu=0) as p:
        worst = max(worst, subprocess.run([bench, "explicit", address(p, "enip"), str(p.process.pid)], check=False).returncode)
    print("an output assembly's datagram to the frame on the drive's line (TCP)", flush=True)
    worst = max(worst, subprocess.run([bench, "output", program], check=False).returncode)
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        folder = pathlib.Path(name)
        (folder / "site.json").write_text(json.dumps(site(32)))
        io_port, more = settings()
        p = Program(program, folder, "--site", str(folder / "site.json"), *more)
        try:
            io = f"127.0.0.1:{io_port}"
            print("32 connections at 2 ms, Modbus at its peak for half of the time", flush=True)
            worst = max(worst, subprocess.run([bench, "jitter", address(p, "enip"), io, address(p, "modbus")], check=False).returncode)
        finally:
            p.stop()
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        folder = pathlib.Path(name)
        (folder / "site.json").write_text(json.dumps(site(1)))
        io_port, more = settings()
        p = Program(program, folder, "--site", str(folder / "site.json"), *more)
        try:
            print("an owner at 10 ms, time-out 40 ms, falls silent while its axis moves", flush=True)
            worst = max(worst, subprocess.run([bench, "lost", address(p, "enip"), f"127.0.0.1:{io_port}"], check=False).returncode)
        finally:
            p.stop()
    return worst


if __name__ == "__main__":
    sys.exit(main())
