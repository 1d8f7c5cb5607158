#!/usr/bin/env python3
"""Program benchmark: from the start of the real program to `ready`, and its memory with 64 axes.

In: the program's path. Out: per figure the ratio, the limit it is measured against, and both figures; code 1 if a limit is not kept.
"""
import json
import os
import pathlib
import select
import signal
import statistics
import subprocess
import sys
import tempfile
import time

READY_MS, MEMORY_MB, REST_PERCENT, AXES = 300, 60, 3, 64


def site():
    lines = [{"name": f"can{i}", "uri": "twin", "family": "uim342", "bitrate": 1000000} for i in range(2)]
    drives = [{"name": f"a{i + 1}", "line": f"can{i // 32}", "address": 11 + i % 32, "presence": "auto"} for i in range(AXES)]
    axes = [{"name": f"a{i + 1}", "drive": f"a{i + 1}", "number": i + 1, "unit": "mm", "increments_per_unit": 100} for i in range(AXES)]
    return {"lines": lines, "drives": drives, "axes": axes, "mappings": []}


class Program:
    def __init__(self, program, folder, *more):
        arguments = [program, "serve", "--data", str(folder / "data"), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=127.0.0.1:0", "--set", "log.level=warning", *more]
        begun = time.monotonic()
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=self.log)
        said = b""
        while not ((b"\n" + said).rfind(b"\nready") >= 0 and said.endswith(b"\n")):
            if not select.select([self.process.stdout], [], [], max(0.0, begun + 10 - time.monotonic()))[0]:
                raise SystemExit("bench_program: not ready within 10 s")
            part = os.read(self.process.stdout.fileno(), 4096)
            if not part:
                raise SystemExit(f"bench_program: the program ended: {said.decode()}")
            said += part
        self.said = said[(b"\n" + said).rfind(b"\nready"):].decode()  # a new data directory tells its first sign-in before
        self.took_ms = (time.monotonic() - begun) * 1000

    def memory_mb(self, key):
        for line in pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith(key + ":"):
                return int(line.split()[1]) / 1024
        raise SystemExit(f"bench_program: /proc has no {key}")

    def processor_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(10)
        finally:
            self.process.kill()
            self.process.wait()
            self.process.stdout.close()

    def warnings(self):
        self.log.seek(0)
        return self.log.read().decode().splitlines()


def say(what, ours, limit, unit):
    kept = ours <= limit
    ratio = ours / limit if limit else float(ours)
    print(f"    {what:<36} ratio {ratio:8.3f}  limit <= {1 if limit else 0}  {'kept' if kept else 'NOT KEPT':<8}  axisgate {ours:.1f} {unit}, limit {limit} {unit}", flush=True)
    return kept


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    kept = True
    print(f"the real program with {AXES} axes", flush=True)
    with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as name:
        folder = pathlib.Path(name)
        (folder / "site.json").write_text(json.dumps(site()))
        first, again = [], []
        for i in range(5):
            with tempfile.TemporaryDirectory(prefix="axisgate-bench-") as empty:
                p = Program(program, pathlib.Path(empty), "--site", str(folder / "site.json"))
                first.append(p.took_ms)
                p.stop()
        p = Program(program, folder, "--site", str(folder / "site.json"))
        p.stop()
        for i in range(5):
            p = Program(program, folder)
            again.append(p.took_ms)
            if i < 4:
                p.stop()
        kept &= say("start to ready, new data (median)", statistics.median(first), READY_MS, "ms")
        kept &= say("start to ready, old data (median)", statistics.median(again), READY_MS, "ms")
        time.sleep(2.5)  # a second after the last drive was found all is at rest
        before = p.processor_s()
        time.sleep(4)
        used = (p.processor_s() - before) / 4
        kept &= say("resident memory", p.memory_mb("VmRSS"), MEMORY_MB, "MB")
        kept &= say("processor with all axes at rest", used * 100, REST_PERCENT, "%")
        print(f"    {'highest memory so far':<36} {p.memory_mb('VmHWM'):.1f} MB", flush=True)
        p.stop()
        silent = sum(" is silent: " in line for line in p.warnings())
        kept &= say("drives taken for silent at the start", silent, 0, "")
    print("all limits kept" if kept else "NOT all limits kept")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
