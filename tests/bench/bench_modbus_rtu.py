#!/usr/bin/env python3
"""Modbus RTU benchmark: how much of a serial line at 115200 bit/s 8E1 a master gets that asks as fast as the silences allow.

In: the program's path. Out: per kind of request the ratio of what the wire allows to what was measured, against its limit. The line is a
pseudo-terminal, and this program keeps the pace of a wire on it, both ways.
"""
import json
import os
import pathlib
import select
import statistics
import struct
import sys
import tempfile
import time
import tty

from bench_program import Program, site

BAUD, BITS, SILENCE = 115200, 11, 0.00175
LIMIT, ROUNDS = 0.95, 200


def crc(data):
    value = 0xFFFF
    for b in data:
        value ^= b
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return struct.pack("<H", value)


def wait_until(instant):
    while time.perf_counter() < instant:
        pass


def transaction(fd, request, size):
    """From the request to the end of the silence behind its answer. Bytes take the time that they take on a wire: the last one of the request
    arrives when all have crossed, and the answer has crossed no earlier than its bytes take from its first."""
    byte = BITS / BAUD
    begun = time.perf_counter()
    wait_until(begun + len(request) * byte)
    os.write(fd, request)
    got, first = b"", None
    while len(got) < size:
        if not select.select([fd], [], [], 2)[0]:
            raise SystemExit(f"bench_modbus_rtu: no answer to {request.hex()}: {got.hex()}")
        first = first or time.perf_counter()
        got += os.read(fd, 512)
    if crc(got[:-2]) != got[-2:]:
        raise SystemExit(f"bench_modbus_rtu: {got.hex()}")
    wait_until(max(time.perf_counter(), first + size * byte) + SILENCE)
    return time.perf_counter() - begun


def measure(fd, name, pdu, size, limit):
    body = b"\x01" + pdu
    request = body + crc(body)
    ideal = (len(request) + size) * BITS / BAUD + 2 * SILENCE
    times = [transaction(fd, request, size) for _ in range(ROUNDS)]
    mean = statistics.fmean(times)
    ratio = ideal / mean
    if limit is None:
        print(f"    {name:<34} ratio {ratio:10.3f}  (no limit)  the wire {ideal * 1000:.3f} ms, measured {mean * 1000:.3f} ms", flush=True)
        return True
    kept = ratio >= limit
    print(f"    {name:<34} ratio {ratio:10.3f}  limit >= {limit}  {'kept' if kept else 'NOT KEPT':<8}  the wire {ideal * 1000:.3f} ms, measured {mean * 1000:.3f} ms", flush=True)
    return kept


def main():
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        folder = pathlib.Path(name)
        (folder / "site.json").write_text(json.dumps(site()))
        fd, far = os.openpty()
        tty.setraw(fd)
        tty.setraw(far)
        program = Program(sys.argv[1], folder, "--site", str(folder / "site.json"), "--set", "enip.bind=off", "--set", f"modbus_rtu.port={os.ttyname(far)}",
                          "--set", f"modbus_rtu.baud={BAUD}", "--set", "modbus_rtu.format=8E1")
        try:
            time.sleep(0.3)
            transaction(fd, b"\x01\x03\x00\x00\x00\x01" + crc(b"\x01\x03\x00\x00\x00\x01"), 7)
            good = measure(fd, "RTU, 125 registers, of the wire", b"\x03\x00\x00\x00\x7d", 255, LIMIT)
            good = measure(fd, "RTU, 64 registers, of the wire", b"\x03\x00\x00\x00\x40", 133, LIMIT) and good
            measure(fd, "RTU, 1 register, of the wire", b"\x03\x00\x00\x00\x01", 7, None)
        finally:
            program.stop()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
