#!/usr/bin/env python3
"""Mutants: small changes to the rooms that decide what moves. A change that no test sees is a hole in the tests.

In: the lists *.toml beside this file, and a build whose test programs are up to date. Out: one line per mutant, killed by which test or
survived, and as the last line "N passed, N failed". The checkout is never written to: the changed file is put into BUILD/mutants, compiled
there alone with the options of its room, and linked in front of the room's library. Each mutant's tests have a time limit.
"""
import argparse
import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import resource
import shlex
import subprocess
import sys
import threading
import time
import tomllib

TOP = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
LIMIT_S = 300  # of one program with one mutant; who needs longer hangs, which is a way to die
KERNEL = "axis"  # the room in which nothing may survive
SURVIVORS_MOST = 0.05  # of the mutants of the other rooms
MEMBERS = {"name", "file", "old", "new", "tests", "quick", "survives"}


def read_lists():
    """The mutants in the order of the files, and what is wrong with the lists."""
    mutants, faults = [], []
    for path in sorted(HERE.glob("*.toml")):
        document = tomllib.loads(path.read_text(encoding="utf-8"))
        for m in document["mutant"]:
            m["tests"] = m.get("tests", document["tests"])
            m["room"] = pathlib.PurePosixPath(m["file"]).parts[1]
            mutants.append(m)
    for name in sorted({m["name"] for m in mutants if sum(n["name"] == m["name"] for n in mutants) > 1}):
        faults.append(f"{name}: two mutants have this name")
    for m in mutants:
        unknown = set(m) - MEMBERS - {"room"}
        if unknown:
            faults.append(f"{m['name']}: a mutant has no member {', '.join(sorted(unknown))}")
        if m["room"] == KERNEL and "survives" in m:
            faults.append(f"{m['name']}: nothing in gateway/{KERNEL} may survive; write the test")
        path = TOP / m["file"]
        found = path.read_text(encoding="utf-8").count(m["old"]) if path.is_file() else 0
        if found != 1:
            faults.append(f"{m['name']}: no longer applies: its text occurs {found} times in {m['file']}; write it anew")
    return mutants, faults


class Build:
    """How a build compiles a file of a room and links a test program, learnt from what its generator wrote."""

    def __init__(self, build):
        self.build = build.resolve()
        self.work = self.build / "mutants"
        self.work.mkdir(exist_ok=True)
        self.units = {}  # target: its (command, source)
        for entry in json.loads((self.build / "compile_commands.json").read_text(encoding="utf-8")):
            command = shlex.split(entry["command"])
            target = re.search(r"CMakeFiles/([^/]+)\.dir/", command[command.index("-o") + 1])
            if target and entry["file"].endswith((".cpp", ".cxx")):
                self.units.setdefault(target[1], []).append((command, entry["file"]))
        self.links = {}
        self.lock = threading.Lock()

    def run(self, command, log):
        done = subprocess.run(command, cwd=self.build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
        log.append(done.stdout)
        return done.returncode == 0

    def compile(self, target, source, into, overlay, log):
        """Compiles one file with the options of a target. What lies in the folder `overlay` is found before the checkout's."""
        command = list(self.units[target][0][0])
        del command[command.index("-c"):]
        for option, values in (("-o", 2), ("-MF", 2), ("-MT", 2), ("-MD", 1)):
            if option in command:
                at = command.index(option)
                del command[at:at + values]
        compiler = next(i for i, word in enumerate(command) if re.search(r"(g|clang)\+\+(-\d+)?$|/c\+\+$", word)) + 1
        command[compiler:compiler] = [f"-I{overlay}"] if overlay else []
        # A change may leave a name unused, which is no reason to refuse it.
        command += ["-w", "-MD", "-MF", f"{into}.d", "-o", str(into), "-c", str(source)]
        return self.run(command, log)

    def link_of(self, program):
        with self.lock:
            if program not in self.links:
                said = subprocess.run(["ninja", "-C", str(self.build), "-t", "commands", program], capture_output=True, text=True, check=True).stdout
                words = shlex.split(said.strip().splitlines()[-1])
                self.links[program] = [w for w in words if w not in (":", "&&")]
            return self.links[program]

    def link(self, program, room, objects, own, into, log):
        """Links a program with `objects` in front of its room's files, each of which is a member of its own of a library. `own`: what
        stands for the program's own files, if it is not as the build has it."""
        command = list(self.link_of(program))
        command[command.index("-o") + 1] = str(into)
        library = f"libaxisgate_{room}.a"
        command = [str(self.work / room / library) if w == library else w for w in command]
        first = next(i for i, w in enumerate(command) if w.endswith(".o"))
        if own:
            command = [w for w in command if not (w.endswith(".o") and f"CMakeFiles/{program}.dir/" in w)]
        command[first:first] = [*map(str, objects), *map(str, own or [])]
        return self.run(command, log)

    def base(self, room, pool):
        """The room's files one by one, as they are. In the build's own library they may have been compiled together."""
        folder = self.work / room
        folder.mkdir(exist_ok=True)
        sources = sources_of(room)
        log = []
        good = list(pool.map(lambda s: self.compile(f"axisgate_{room}", s, folder / (s.stem + ".o"), None, log), sources))
        library = folder / f"libaxisgate_{room}.a"
        library.unlink(missing_ok=True)
        if not all(good) or not self.run(["ar", "qcs", str(library), *(str(folder / (s.stem + ".o")) for s in sources)], log):
            raise SystemExit(f"gateway/{room} does not compile without a mutant:\n" + "".join(log)[-4000:])


def sources_of(room):
    return sorted(TOP.glob(f"gateway/{room}/**/*.cpp"))


def limits():
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000_000, 50_000_000))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run_tests(program, only, log):
    """None if all is well, else by what the mutant died."""
    command = [str(program), "--gtest_color=no", "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + only]
    surroundings = dict(os.environ, ASAN_OPTIONS="hard_rss_limit_mb=2000:detect_leaks=0:symbolize=0", UBSAN_OPTIONS="symbolize=0")
    with open(f"{program}.log", "w+b") as out:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, env=surroundings, cwd=TOP, preexec_fn=limits)
        try:
            code = child.wait(LIMIT_S)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            return f"did not end within {LIMIT_S} s"
        out.seek(0)
        text = out.read().decode(errors="replace")
    log.append(text[-4000:])
    failed = re.search(r"\[  FAILED  \] ([^ ,\n]+)", text)
    if failed:
        return failed[1]
    if code == 0 and not re.search(r"\[  PASSED  \] [1-9]\d* test", text):
        return None if "0 tests" not in text else "no test has such a name"
    return None if code == 0 else f"a crash (code {code})"


class Runner:
    def __init__(self, build, pool_size):
        self.build = build
        self.slots = list(range(pool_size))
        self.lock = threading.Lock()

    def at(self, mutant):
        """What became of a mutant: (state, by what or why, seconds). Without `old` it is none: the tests must pass."""
        with self.lock:
            slot = self.slots.pop()
        begun = time.monotonic()
        try:
            return (*self.play(mutant, self.build.work / f"slot{slot}"), time.monotonic() - begun)
        finally:
            with self.lock:
                self.slots.append(slot)

    def play(self, mutant, folder):
        room, log = mutant["room"], []
        changed = folder / mutant["file"]
        changed.parent.mkdir(parents=True, exist_ok=True)
        text = (TOP / mutant["file"]).read_text(encoding="utf-8")
        changed.write_text(text.replace(mutant["old"], mutant["new"]), encoding="utf-8")
        objects, own = [], {}
        try:
            good = True
            if changed.suffix == ".cpp":
                objects = [folder / "mutant.o"]
                good = self.build.compile(f"axisgate_{room}", changed, objects[0], None, log)
            else:
                # A header: all of the room that reads it, and the test programs themselves.
                for s in sources_of(room):
                    if mutant["file"] in pathlib.Path(f"{self.build.work / room / (s.stem + '.o')}.d").read_text(encoding="utf-8"):
                        objects.append(folder / (s.stem + ".o"))
                        good = good and self.build.compile(f"axisgate_{room}", s, objects[-1], folder, log)
                for program in {t.split(":", 1)[0] for t in mutant["tests"]}:
                    own[program] = []
                    for i, (_, source) in enumerate(self.build.units[program]):
                        own[program].append(folder / f"{program}{i}.o")
                        good = good and self.build.compile(program, source, own[program][-1], folder, log)
            if not good:
                return "did not build", "".join(log)[-2000:]
            for t in mutant["tests"]:
                program, only = t.split(":", 1)
                into = folder / program
                if not into.exists() and not self.build.link(program, room, objects, own.get(program), into, log):
                    return "did not build", "".join(log)[-2000:]
                by = run_tests(into, only, log)
                if by:
                    return "killed", f"{program} {by}"
            return "survived", ""
        finally:
            changed.unlink()
            for t in mutant["tests"]:
                (folder / t.split(":", 1)[0]).unlink(missing_ok=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("build", nargs="?", default="build/asan", help="the build whose programs and options are used")
    arguments.add_argument("--all", action="store_true", help="the whole list, not only the quick ones")
    arguments.add_argument("--only", default="", help="a regular expression for names or files")
    arguments.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    a = arguments.parse_args()
    mutants, faults = read_lists()
    everything = a.all or bool(a.only) or os.environ.get("AXISGATE_MUTANTS") == "all"
    for f in faults:
        print(f)
    chosen = [m for m in mutants if (everything or m.get("quick")) and re.search(a.only, m["name"] + " " + m["file"])
              and not any(f.startswith(m["name"] + ":") for f in faults)]
    if not chosen:
        print("0 passed, 1 failed")
        return 1
    build = Build(pathlib.Path(a.build))
    programs = sorted({t.split(":", 1)[0] for m in chosen for t in m["tests"]})
    with open(build.work / "build.log", "w", encoding="utf-8") as out:
        if subprocess.run(["cmake", "--build", str(build.build), "--target", *programs], stdout=out, stderr=subprocess.STDOUT, check=False).returncode:
            print(f"the test programs do not build: {out.name}\n0 passed, 1 failed")
            return 1
    passed, failed, survivors, reasons = 0, len(faults), [], []
    runner = Runner(build, a.jobs)
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for room in sorted({m["room"] for m in chosen}):
            build.base(room, pool)
        # A mutant that changes nothing must survive, or what dies below dies of something else.
        nothing = []
        for (room, tests), of in itertools.groupby(sorted(chosen, key=lambda m: (m["room"], m["tests"])), key=lambda m: (m["room"], m["tests"])):
            nothing.append({"name": f"nothing is changed in gateway/{room}", "file": f"gateway/{room}/{sources_of(room)[0].relative_to(TOP / 'gateway' / room)}",
                            "old": "\n", "new": "\n", "tests": tests, "room": room})
        for m, (state, why, seconds) in zip(nothing, pool.map(runner.at, nothing)):
            if state != "survived":
                print(f"FAIL {m['name']}: {state} {why} ({seconds:.0f} s)")
                failed += 1
        if failed == len(faults):
            for m, (state, why, seconds) in zip(chosen, pool.map(runner.at, chosen)):
                if state == "killed" and "survives" not in m:
                    passed += 1
                elif state == "survived" and m["room"] != KERNEL:
                    survivors.append(m["name"])
                    reasons += [f"{m['name']}: {m['survives']}"] if "survives" in m else []
                else:
                    failed += 1
                    if state == "killed":
                        why += "; it is listed as a survivor: take the reason out"
                print(f"{m['file'].removeprefix('gateway/'):32} {m['name']:72} {state} {'by ' if state == 'killed' else ''}{why} ({seconds:.0f} s)", flush=True)
    elsewhere = sum(m["room"] != KERNEL for m in chosen)
    if survivors:
        print(f"survived outside of gateway/{KERNEL}: {len(survivors)} of {elsewhere}: {'; '.join(survivors)}")
        for r in reasons:
            print(f"known survivor: {r}")
        failed += len(survivors) > SURVIVORS_MOST * elsewhere
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
