#!/usr/bin/env python3
"""A bare beat: a process that does nothing but wake up in a period, to see what the machine itself does to one.

In: the period in ms, how many seconds, as arguments. Out: one line of JSON: the instants between which it woke were off the period by
`p99_us`, `p9999_us`, at most by `longest_us`. It asks for the rank that the gateway's cyclic thread asks for, and says whether it has it.
"""
import ctypes
import json
import os
import sys
import time

TIMER_ABSTIME = 1


class TimeSpec(ctypes.Structure):
    _fields_ = [("seconds", ctypes.c_long), ("nanoseconds", ctypes.c_long)]


def main():
    period_ns, seconds = int(sys.argv[1]) * 1_000_000, float(sys.argv[2])
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
        real_time = True
    except OSError:
        real_time = False
    libc = ctypes.CDLL(None)
    due, woke = time.clock_gettime_ns(time.CLOCK_MONOTONIC), []
    for _ in range(int(seconds * 1e9 / period_ns)):
        due += period_ns
        libc.clock_nanosleep(time.CLOCK_MONOTONIC, TIMER_ABSTIME, ctypes.byref(TimeSpec(*divmod(due, 10**9))), None)
        woke.append(time.clock_gettime_ns(time.CLOCK_MONOTONIC))
    off = sorted(abs(b - a - period_ns) / 1000 for a, b in zip(woke, woke[1:]))
    print(json.dumps({"p99_us": off[int(0.99 * (len(off) - 1))], "p9999_us": off[int(0.9999 * (len(off) - 1))], "longest_us": off[-1], "real_time": real_time}))


if __name__ == "__main__":
    main()
