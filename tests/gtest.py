#!/usr/bin/env python3
"""Runs tests of GoogleTest programs, some dozens in a process and two processes at a time: a process for each test would cost more than the tests.

In: programs; --only and --but, what the names of tests must and must not contain (regular expressions). Out: what failed, with its output,
and as the last line "N passed, N failed". A process that ends before its tests do, or with a complaint after them, is a failure; so is a
test that skips itself. Each process has a time limit.
"""
import argparse
import concurrent.futures
import os
import re
import subprocess
import sys

TESTS_PER_PROCESS, LIMIT_S = 120, 300
ENDED = re.compile(r"\[\s*(OK|FAILED|SKIPPED)\s*\] (\S+?)(?:, where .*)? \(\d+ ms\)$", re.M)


def tests_of(program):
    listed = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    suite = ""
    for line in listed.splitlines():
        name = line.split("#")[0].rstrip()
        if line.startswith("  "):
            yield suite + name.strip()
        elif name.endswith("."):
            suite = name


def run(program, names):
    """Which passed, and what is to be said of the others."""
    try:
        done = subprocess.run([program, "--gtest_color=no", "--gtest_filter=" + ":".join(names)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              stdin=subprocess.DEVNULL, timeout=LIMIT_S, check=False)
        output, code = done.stdout, done.returncode
    except subprocess.TimeoutExpired as e:
        output, code = e.stdout or b"", f"none within {LIMIT_S} s"
    text = output.decode(errors="replace")
    ends = {m.group(2): m for m in ENDED.finditer(text)}
    passed = [n for n in names if n in ends and ends[n].group(1) == "OK"]
    failed = {}
    for n in names:
        if n in passed:
            continue
        begun = text.find(f"[ RUN      ] {n}\n")
        if n in ends:
            failed[n] = text[max(begun, 0):ends[n].end()]
        else:
            failed[n] = f"{n} did not end; code of the process: {code}\n" + (text[begun:][-20000:] if begun >= 0 else "")
    if code != 0 and not failed:
        failed[f"{os.path.basename(program)} after {names[-1]}"] = f"code {code}\n" + text[-20000:]
    return len(passed), failed


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--but", default="(?!)")
    arguments.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    arguments.add_argument("programs", nargs="+")
    a = arguments.parse_args()
    work = []
    for program in a.programs:
        program = os.path.abspath(program)
        names = [n for n in tests_of(program) if re.search(a.only, n) and not re.search(a.but, n) and ".DISABLED_" not in n]
        # Not one stretch after another: what takes long stands together in a program.
        pieces = -(-len(names) // TESTS_PER_PROCESS)
        work += [(program, names[i::pieces]) for i in range(pieces)]
    passed, failed = 0, {}
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for ok, bad in pool.map(lambda w: run(*w), work):
            passed += ok
            failed.update(bad)
            for name, why in bad.items():
                print(f"--- {name}\n{why}", flush=True)
    for name in failed:
        print(f"failed: {name}")
    print(f"{passed} passed, {len(failed)} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
