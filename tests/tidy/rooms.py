#!/usr/bin/env python3
"""Keeps the rooms apart: reads every #include and every head comment, and the manners that no compiler checks.

In: the source tree. Out: one line per fault, then "N passed, N failed". Never changes a file.
"""
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
SYSTEM_EDGES = ("boost/asio", "boost/beast", "sys/", "linux/", "netinet/", "arpa/", "termios", "unistd", "fcntl", "pthread", "thread", "mutex",
                "condition_variable", "future", "spdlog", "fstream", "filesystem", "iostream", "sqlite3", "modbus", "toml", "CLI")


def room(path):
    parts = path.relative_to(TOP).parts
    if parts[0] == "adapters":
        if len(parts) > 3:
            return "test"
        name = parts[-1]
        return "twin" if name.startswith("twin") else "adapter"
    if parts[0] == "gateway":
        if parts[1] == "doors":
            return "door"
        if parts[1] == "main.cpp":
            return "main"
        return parts[1]
    return "test"


def may_include(path, included):
    """None, or why this include is not allowed."""
    r = room(path)
    rel = path.relative_to(TOP)
    own = str(rel.parent)
    if r in ("test", "main", "runtime"):
        return None
    if included.startswith(("gateway/", "adapters/", "tests/")):
        folder = str(pathlib.PurePosixPath(included).parent)
        if folder == "gateway/core":
            return None
        if r == "core":
            return "core includes core alone"
        if r == "adapter":
            if folder != own:
                return "a family includes core and itself alone"
            base = pathlib.PurePosixPath(included).name
            if base.startswith("twin") and rel.name != "family.cpp":
                return "only family.cpp may name the twin"
            return None
        if r == "twin":
            if folder != own or not pathlib.PurePosixPath(included).name.startswith("twin"):
                return "a twin is a second reading: it includes core and twin files alone"
            return None
        if folder != own:
            return "a room includes core and itself alone"
        return None
    if r in ("core", "adapter", "twin"):
        for edge in SYSTEM_EDGES:
            if included == edge or included.startswith(edge) and (edge.endswith("/") or included[len(edge):len(edge) + 1] in ("", ".", "/", "+")):
                return "a pure room has no socket, clock, thread, file or log"
    if r == "store" and included.startswith("boost/asio"):
        return "the store does not know Asio"
    return None


def main():
    files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=TOP, capture_output=True, text=True, check=True).stdout.split("\n")
    sources = [TOP / f for f in files if f.endswith((".cpp", ".hpp")) and (TOP / f).is_file()]
    faults, passed = [], 0
    for path in sources:
        rel = path.relative_to(TOP)
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        wrong = []
        for n, line in enumerate(lines, 1):
            m = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
            if m:
                why = may_include(path, m.group(1))
                if why:
                    wrong.append(f"{rel}:{n}: includes {m.group(1)}: {why}")
            if room(path) in ("core", "adapter", "twin") and re.search(r"\b(system_clock|steady_clock|high_resolution_clock|sleep_for|this_thread)\b", line):
                wrong.append(f"{rel}:{n}: a pure room takes time as an argument")
            if re.search(r"\b(TODO|FIXME|XXX|HACK|GTEST_SKIP|DISABLED_)\b", line) or "DISABLED_" in line:
                wrong.append(f"{rel}:{n}: nothing is left open or skipped")
        if not lines[0].startswith("// "):
            wrong.append(f"{rel}:1: a file opens with what it is, what comes in, what goes out, what it never does")
        if path.suffix == ".hpp" and "#pragma once" not in text:
            wrong.append(f"{rel}: no #pragma once")
        if len(lines) > 900:
            wrong.append(f"{rel}: {len(lines)} lines: it is two things")
        if wrong:
            faults += wrong
        else:
            passed += 1
    families = sorted(p.parent.name for p in (TOP / "adapters").glob("*/family.cpp"))
    for f in families:
        for need in (f"schema/families/{f}.json", f"adapters/{f}/README.md", f"adapters/{f}/vectors.txt", f"adapters/{f}/tests/facts.json"):
            if (TOP / need).is_file():
                passed += 1
            else:
                faults.append(f"{need} is missing: a family is a folder and a page of data")
    # A family that lists the errata of its manual (`| E-04 |`, `**E-04**`) lists every one that it speaks of.
    for f in families:
        listed = {int(n) for page in (TOP / "adapters" / f).glob("*.md") for n in re.findall(r"^(?:[|*] *)?\**`?E-(\d+)\b", page.read_text(encoding="utf-8"), re.M)}
        if not listed:
            continue
        pages = [p for p in (TOP / "adapters" / f).rglob("*") if p.is_file()] + [TOP / f"schema/families/{f}.json"]
        for page in pages:
            missing = {int(n) for n in re.findall(r"\bE-(\d+)\b", page.read_text(encoding="utf-8", errors="replace"))} - listed
            if missing:
                faults.append(f"{page.relative_to(TOP)}: E-{min(missing):02} stands in no list of adapters/{f}/*.md")
            else:
                passed += 1
    # The rule itself can fail: a core file that includes Asio must be found.
    probe = TOP / "gateway/core/engine.cpp"
    if may_include(probe, "boost/asio.hpp") and may_include(probe, "adapters/uim342/wire.hpp") and not may_include(probe, "vector"):
        passed += 1
    else:
        faults.append("the include rule no longer finds what it is for")
    for f in faults:
        print(f)
    print(f"{passed} passed, {len(faults)} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
