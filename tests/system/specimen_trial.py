#!/usr/bin/env python3
"""Tries a gateway from outside against specimens of CiA 402 drives, each on a CAN bus of its own, and says which step failed in which words.

    specimen_trial.py --program BIN [--twins BIN] [--specimens 1..60,slow] [--option NAME=VALUE ...] [--alone] [--watches] [--can IF] [--workers N]

In: the gateway's program; the program whose simulated drives are tried, if it is another one; the drives: seeds, ranges and names, or one drive with
the freedoms of --option; --alone: each freedom of each of these drives by itself, so that the one is found that matters. The bus is that of
user_can.py, or the interface of --can, on which one drive after the other is tried. Out: one line for each drive, `passed` or its failed steps,
with the words of the gateway. A drive that has failed is tried again, by itself, and a step has failed if it did both times: a computer that is
busy disturbs a drive, too. The exit code is 1 if one failed.

A step fails if the axis does not do it and if it does what was not asked: a command without an end, an axis that shows `moving` while it stands, a
drive that is not found again, a stop that is not answered, a stream that steps.
"""
import argparse
import concurrent.futures
import contextlib
import datetime
import json
import multiprocessing
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import harness  # noqa: E402
from test_openapi import WebSocket  # noqa: E402
from user_can import URI, UserCan  # noqa: E402

FAMILY, NODE = "cia402", "5"
FIND_S, MOVE_S, REST_S = 60.0, 45.0, 12.0   # bounds of a step: the slowest specimen needs half of them
CLOSE = 40                                  # increments: friction, play and noise of the weakest specimen, with a reserve
SPEED, RAMP = 10000, 20000                  # the motor of each specimen can follow this ramp
STREAM_SPEED, STREAM_RAMP = 8000, 30000
LATE_S = 0.06                               # by which one report of the place may be older than it says, on a busy computer
# How long a drive may take; a program that does not know these options is tried without them.
PATIENCE = {"mode_timeout_ms": "10000", "start_timeout_ms": "10000"}

# The drive's own watch of a stream counts the milliseconds of this computer, which is late by itself when it is busy: off without --watches.
WATCHES = ("sync_watch_periods", "target_watch_periods")


class Failed(Exception):
    """A step that was not done; the text says by what the gateway or the axis shows it."""


class OtherTool:
    """Another master of the bus: its own socket, NMT messages, and SDO writes."""

    def __init__(self, place, is_user_can):
        if is_user_can:
            self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            self.socket.connect(place)
        else:
            self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
            self.socket.bind((place,))
        self.socket.settimeout(2)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, identifier, data):
        self.socket.send(struct.pack("=IB3x8s", identifier, len(data), data))

    def nmt(self, command):
        self.send(0, bytes([command, int(NODE)]))
        time.sleep(0.1)

    def write(self, index, sub, value, size):
        """Whether the node has taken the value."""
        self.send(0x600 + int(NODE), struct.pack("<BHBI", {1: 0x2F, 4: 0x23}[size], index, sub, value))
        while True:
            identifier, data = struct.unpack("=I4x8s", self.socket.recv(16))
            if identifier == 0x580 + int(NODE) and struct.unpack_from("<HB", data, 1) == (index, sub):
                return data[0] == 0x60


class Bench:
    """One drive and the gateway that is tried with it."""

    def __init__(self, folder, plan, specimen, options, stack):
        self.folder, self.plan, self.stack = folder, plan, stack
        self.uri, self.env = (f"can:{plan.can}", {}) if plan.can else self.bus()
        arguments = ["twin", FAMILY, "--line", self.uri, "--address", NODE]
        arguments += [a for name, value in options.items() for a in ("--option", f"{name}={value}")]
        if specimen is not None:
            arguments += ["--specimen", specimen]
        if not plan.watches:
            arguments += [a for name in WATCHES if name not in options for a in ("--option", f"{name}=0")]
        stack.enter_context(harness.Process(*arguments, program=plan.twins, env=self.env))
        self.gateway = None

    def bus(self):
        bus = self.stack.enter_context(UserCan(self.folder))
        return URI, bus.env

    def other_tool(self):
        return OtherTool(self.plan.can or self.env["AXISGATE_USER_CAN"], not self.plan.can)

    def site(self, patience):
        return {"lines": [{"name": "can0", "uri": self.uri, "family": FAMILY, "bitrate": 1000000}],
                "drives": [{"name": "drive", "line": "can0", "address": int(NODE), "presence": "device", "options": patience}],
                "axes": [{"name": "axis", "drive": "drive", "number": 1}], "mappings": []}

    def start(self):
        if self.gateway is not None:
            self.gateway = harness.Gateway(self.folder, None, program=self.plan.program, env=self.env)
        else:
            try:
                self.gateway = harness.Gateway(self.folder, self.site(PATIENCE), program=self.plan.program, env=self.env)
            except AssertionError as error:
                if "mode_timeout_ms" not in str(error):
                    raise
                self.gateway = harness.Gateway(self.folder, self.site({}), program=self.plan.program, env=self.env)
        self.stack.callback(self.gateway.__exit__)

    def end(self, how):
        if how == signal.SIGTERM:
            self.gateway.stop()
        else:
            self.gateway.process.kill()
            self.gateway.process.wait()

    # --- what is seen and done over HTTP
    def axis(self):
        return self.gateway.axis("axis")

    def shown(self):
        a = self.axis()
        keys = ("online", "state", "mode", "moving", "position_increments", "velocity_increments")
        return ", ".join(f"{k}={a[k]}" for k in keys)

    def newest(self, count=2):
        """What the gateway tells of the drive: its connection, and the last warnings but that it does not know the options of PATIENCE."""
        told = [e for e in self.gateway.get("/events?limit=60") if e["severity"] != "info"]
        told = [f"{e['kind']}: {e['text'][:200]}" for e in told if "is no option here" not in e["text"]]
        return "; ".join([self.gateway.get("/drives/drive")["status"]["text"], *told[:count]])

    def ask(self, body, wait=MOVE_S):
        """The answer to a command as (status, result, words)."""
        status, answer, _ = self.gateway.request("POST", f"/api/v1/axes/axis/commands?wait={int(min(wait, 40))}", body, seconds=wait + 15)
        answer = answer if isinstance(answer, dict) else {}
        words = ": ".join(str(answer[k]) for k in ("reason", "text", "title", "detail") if answer.get(k))
        return status, answer.get("result", ""), words

    def do(self, body, wait=MOVE_S):
        status, result, words = self.ask(body, wait)
        if status == 409 and "nmt_start" in words:  # the refusal names the remedy
            self.start_node()
            status, result, words = self.ask(body, wait)
        if status not in (200, 202) or result != ("done" if wait else "accepted"):
            raise Failed(f"{body['command']} was answered with {status} {result} {words} ({self.shown()})")

    def start_node(self):
        self.gateway.request("POST", "/api/v1/axes/axis/actions", {"name": "nmt_start"})
        time.sleep(0.5)

    def until(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition(self.axis()):
            if time.monotonic() > end:
                raise Failed(f"{what}: not within {seconds:.0f} s ({self.shown()}; {self.newest()})")
            time.sleep(0.03)

    def at_rest(self, what="it comes to rest"):
        self.until(lambda a: not a["moving"], REST_S, what)


class Trial:
    """The steps, in their order. Each one leaves the axis at rest, or the next one says that it does not."""

    def __init__(self, bench, values):
        self.b, self.values = bench, values
        self.found_at = 0.0

    def steps(self):
        stopped = [("stop a node that another master stops", self.stopped_by_another)] if self.values.get("stopped_by_other_s") else []
        return [("find", self.find), ("enable", self.enable), *stopped, ("move to 3000", lambda: self.move(3000)), ("move to -2000", lambda: self.move(-2000)),
                ("velocity, halt in flight", self.velocity), ("move, halt in flight", self.halt_in_flight),
                ("move after a halt", lambda: self.move(0)), ("stream", self.stream), ("restart at rest", self.restart_at_rest),
                ("move after the restart", lambda: self.move(2000)), ("restart in motion", self.restart_in_motion),
                ("move after the restart in motion", self.move_again), ("restart behind another tool", self.restart_behind_a_tool),
                ("move after the other tool", lambda: self.move(1000))]

    def find(self):
        self.b.start()
        self.b.until(lambda a: a["online"] and not a["simulated"], FIND_S, "the drive is found")
        self.found_at = time.monotonic()

    def enable(self):
        # The gateway may stop the axis by itself, because nobody known moves it; its user tries again until that stop has been answered.
        end = time.monotonic() + 3
        while self.b.ask({"command": "enable"})[2].startswith("wrong_state") and time.monotonic() < end and not self.b.axis()["fault"]:
            time.sleep(0.2)
        self.b.do({"command": "enable"})
        self.b.until(lambda a: a["state"] == "operation_enabled", REST_S, "enabled")

    def move(self, target):
        self.b.do({"command": "move_absolute", "position": target, "velocity": SPEED, "acceleration": RAMP, "deceleration": RAMP})
        self.b.until(lambda a: not a["moving"] and abs(a["position_increments"] - target) <= CLOSE, REST_S, f"it stands at {target}")

    def turn(self):
        self.b.do({"command": "move_velocity", "velocity": 2000, "acceleration": RAMP, "deceleration": RAMP})
        before = self.b.axis()["position_increments"]
        self.b.until(lambda a: a["moving"] and a["position_increments"] > before + 200, REST_S, "it turns")

    def halt(self):
        self.b.do({"command": "halt"})
        self.b.at_rest("the halt")
        place = self.b.axis()["position_increments"]
        time.sleep(0.3)
        if abs(self.b.axis()["position_increments"] - place) > CLOSE:
            raise Failed(f"it moves after the halt ({self.b.shown()})")

    def velocity(self):
        self.turn()
        self.halt()

    def halt_in_flight(self):
        start = self.b.axis()["position_increments"]
        self.b.do({"command": "move_absolute", "position": start - 400000, "velocity": SPEED, "acceleration": RAMP, "deceleration": RAMP}, 0)
        self.b.until(lambda a: a["position_increments"] < start - 1000, REST_S + 10, "it moves")
        self.halt()

    def stopped_by_another(self):
        """It turns while the other master stops the node; the stop of our operator must reach it all the same. A node that was stopped at rest
        is started first, as the handbook says."""
        left = self.found_at + self.values["stopped_by_other_s"] + 1 - time.monotonic()
        if left < 2:
            time.sleep(max(0, left))
            self.b.start_node()
            return self.enable()
        self.turn()
        time.sleep(max(0.0, self.found_at + self.values["stopped_by_other_s"] + 1 - time.monotonic()))
        begun = time.monotonic()
        self.b.do({"command": "quick_stop"}, 20)
        self.b.until(lambda a: a["online"] and not a["moving"], REST_S, "the quick stop")
        if time.monotonic() - begun > 10:
            raise Failed(f"the quick stop took {time.monotonic() - begun:.0f} s")
        self.enable()

    def stream(self):
        """One target far away with a speed: the axis runs towards it, from its place and without a step."""
        if 8 not in self.b.axis()["modes"]:
            return
        feed = WebSocket(self.b.gateway, "/api/v1/stream")
        try:
            self.follow(feed, {"axis": "axis", "mode": "position", "value": self.b.axis()["position_increments"] + 1000000, "velocity": STREAM_SPEED,
                               "acceleration": STREAM_RAMP, "deceleration": STREAM_RAMP})
        finally:
            feed.close()
        self.b.at_rest("the end of the stream")

    def follow(self, feed, set_point):
        before, begun, running_since = self.b.axis(), time.monotonic(), None
        start = before["position_increments"]
        while running_since is None or time.monotonic() < running_since + 0.8:
            feed.send({"set_point": set_point})
            a = self.b.axis()
            way, passed = a["position_increments"] - before["position_increments"], seconds_of(a["at"]) - seconds_of(before["at"])
            if abs(way) > STREAM_SPEED * 1.2 * (max(passed, 0.0) + LATE_S) + 3 * CLOSE:
                raise Failed(f"the stream steps: {way} increments in {1000 * passed:.0f} ms at a speed of {STREAM_SPEED} ({self.b.shown()})")
            if a["position_increments"] > start + 300 and running_since is None:
                running_since = time.monotonic()
            refused = a["set_points"]["refused"]
            if refused and not a["set_points"]["streaming"] and a["set_points"]["reason"]:
                return self.told(a["set_points"]["reason"])
            if time.monotonic() > begun + 25:
                raise Failed(f"the stream does not begin ({self.b.shown()}, {a['set_points']}; {self.b.newest()})")
            before = a
            time.sleep(0.01)

    def told(self, reason):
        """A drive without PDOs cannot follow targets; one that has them must."""
        if self.values.get("pdo_setup", 0) < 3:
            raise Failed(f"the set-points are refused: {reason} ({self.b.newest()})")

    def found_again(self, how, meanwhile=lambda: None):
        self.b.end(how)
        meanwhile()
        self.b.start()
        self.b.until(lambda a: a["online"] and not a["simulated"], FIND_S, "the drive is found again")

    def restart_at_rest(self):
        self.found_again(signal.SIGTERM)
        self.enable()

    def restart_behind_a_tool(self):
        """While the gateway is away, the tool of the drive's maker takes the mapping of TPDO 1 away, and starts the node."""
        self.b.do({"command": "disable"}, 20)
        self.found_again(signal.SIGTERM, self.use_the_tool)
        self.enable()

    def use_the_tool(self):
        with self.b.other_tool() as tool:
            tool.nmt(0x80)
            if tool.write(0x1800, 1, 0xC0000180 + int(NODE), 4):
                tool.write(0x1A00, 0, 0, 1)
            tool.nmt(0x01)

    def restart_in_motion(self):
        self.turn()
        self.found_again(signal.SIGKILL)
        self.b.do({"command": "halt"}, 20)
        self.b.at_rest("the halt after the restart")

    def move_again(self):
        if self.b.axis()["fault"]:  # the drive has noticed that its master was gone
            self.b.do({"command": "reset_fault"}, 20)
        self.enable()
        self.move(0)

    def recover(self):
        """Brings the axis into a state in which the next step can be tried; says nothing. A node that is away is started by another tool."""
        if not self.b.axis()["online"]:
            with self.b.other_tool() as tool:
                tool.nmt(0x01)
            self.b.until(lambda a: a["online"], REST_S, "the drive is back")
        for command in ("halt", "reset_fault", "enable"):
            if command != "reset_fault" or self.b.axis()["fault"]:
                self.b.ask({"command": command}, 10)
            with contextlib.suppress(Failed):
                self.b.until(lambda a: not a["moving"], 5, "")


def seconds_of(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")[:26] + "+00:00").timestamp()


def values_of(twins, specimen, options):
    """The freedoms of a drive by number."""
    out = subprocess.run([twins, "specimen", FAMILY, specimen or "0", "--json"], capture_output=True, text=True, check=True).stdout
    return {**json.loads(out)["values"], **{name: int(value) for name, value in options.items()}}


def play(plan, name, specimen, options):
    """(name, seconds, [(step, words), ...]) of one drive."""
    begun, failures = time.monotonic(), []
    with harness.Folder() as folder, contextlib.ExitStack() as stack:
        values = values_of(plan.twins, specimen, options)
        bench = Bench(folder, plan, specimen, options, stack)
        trial = Trial(bench, values)
        for step, do in trial.steps():
            try:
                do()
            except (Failed, AssertionError, OSError, KeyError) as error:
                failures.append((step, str(error)[:500] or repr(error)))
                if step == "find" or len(failures) == plan.most:
                    break
                try:
                    trial.recover()
                except (Failed, AssertionError, OSError):
                    break
    return name, time.monotonic() - begun, failures


def drives_of(plan):
    """(name, specimen, options) of each drive that is to be tried."""
    if plan.option:
        return [(" ".join(plan.option), None, dict(o.split("=", 1) for o in plan.option))]
    names = []
    for part in plan.specimens.split(","):
        low, dots, high = part.partition("..")
        names += [str(n) for n in range(int(low), int(high) + 1)] if dots else [part]
    if not plan.alone:
        return [(n, n, {}) for n in names]
    usual = values_of(plan.twins, "0", {})
    drives = {f"{k}={v}": {k: str(v)} for n in names for k, v in values_of(plan.twins, n, {}).items() if v != usual[k]}
    return [(name, None, options) for name, options in sorted(drives.items())]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, help="the gateway that is tried")
    parser.add_argument("--twins", help="the program whose simulated drives are tried (default: --program)")
    parser.add_argument("--specimens", default="0,slow,sparse,strict,chatty,weak,old,1..20", help="seeds, ranges and names with commas")
    parser.add_argument("--option", action="append", metavar="NAME=VALUE", help="one drive with this freedom, instead of specimens; may be repeated")
    parser.add_argument("--alone", action="store_true", help="each freedom of these specimens by itself")
    parser.add_argument("--most", type=int, default=3, metavar="N", help="failed steps of a drive, before it is given up (default 3)")
    parser.add_argument("--watches", action="store_true", help="the drives watch their streams, for a computer that is not busy otherwise")
    parser.add_argument("--once", action="store_true", help="a drive that has failed is not tried a second time, by itself")
    parser.add_argument("--can", metavar="INTERFACE", help="a CAN interface of this computer, such as vcan0; without it, a bus between processes")
    parser.add_argument("--workers", type=int, default=max(2, os.cpu_count() or 2), help="drives at a time (1 with --can)")
    plan = parser.parse_args()
    plan.program = str(pathlib.Path(plan.program).resolve())
    plan.twins = str(pathlib.Path(plan.twins).resolve()) if plan.twins else plan.program
    return plan


def played(plan, drives, workers):
    """The results of `play`, as they come."""
    with concurrent.futures.ProcessPoolExecutor(1 if plan.can else workers, multiprocessing.get_context("fork")) as pool:
        for done in concurrent.futures.as_completed([pool.submit(play, plan, *d) for d in drives]):
            yield done.result()


def tried(plan, drives, workers):
    """The results of `play` with the steps that failed twice: a drive that has failed is played again, by itself."""
    again = {}
    for name, seconds, failures in played(plan, drives, workers):
        if failures and not plan.once:
            again[name] = dict(failures)
            print(f"{name}: to be repeated ({seconds:.0f} s): {failures}", flush=True)
        else:
            yield name, seconds, failures
    for name, seconds, failures in played(plan, [d for d in drives if d[0] in again], 1):
        yield name, seconds, [f for f in failures if f[0] in again[name]]


def main():
    plan = arguments()
    drives, failed = drives_of(plan), 0
    for name, seconds, failures in tried(plan, drives, plan.workers):
        failed += bool(failures)
        tell(name, seconds, failures)
    print(f"{len(drives) - failed} passed, {failed} failed")
    return 1 if failed else 0


def tell(name, seconds, failures):
    print(f"{name}: {'failed' if failures else 'passed'} ({seconds:.0f} s)", flush=True)
    for step, words in failures:
        print(f"    {step}: {words}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
