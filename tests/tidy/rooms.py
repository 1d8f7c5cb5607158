#!/usr/bin/env python3
"""Keeps the rooms apart: reads every #include and every head comment, and the habits that no compiler checks.

In: the source tree. Out: one line per fault, one per rule, then "N passed, N failed" of rules. Never changes a file.
"""
import concurrent.futures
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import alone
import classes
import functions
import matrix

TOP = pathlib.Path(__file__).resolve().parents[2]
# arpa/inet.h is none: it makes addresses of texts, and opens nothing.
SYSTEM_EDGES = ("boost/asio", "boost/beast", "sys/", "linux/", "netinet/", "termios", "unistd", "fcntl", "pthread", "thread", "mutex",
                "condition_variable", "future", "spdlog", "fstream", "filesystem", "iostream", "sqlite3", "modbus", "toml", "CLI")

# Who may include whom, beside itself and core. No arrow runs up.
ROOMS = {
    "core": (),
    "site": ("core",),
    "wire": ("core",),
    "axis": ("core", "site"),
    "protocols/canopen": ("core",),
    "protocols/cip": ("core",),
    "protocols/mirror": ("core",),
    "drive": ("core",),
    "engine": ("core", "site", "axis", "wire"),
    "registers": ("core", "site", "axis", "engine/door.hpp"),
    "services": ("core", "site", "axis", "registers", "engine", "protocols/canopen"),
    "lines": ("core", "wire"),
    "store": ("core", "site"),
    "doors/modbus": ("core", "site", "axis", "registers", "engine", "lines/poller.hpp", "lines/spare_descriptor.hpp"),
    "doors/enip": ("core", "site", "axis", "registers", "engine", "protocols/cip", "lines/poller.hpp", "lines/spare_descriptor.hpp"),
    "doors/dds": ("core", "site", "axis", "services", "protocols/mirror"),
    "doors/http": ("core", "site", "axis", "registers", "services", "engine", "wire", "lines/spare_descriptor.hpp"),
}
PURE = ("core", "site", "wire", "axis", "protocols/canopen", "protocols/cip", "protocols/mirror", "drive", "engine", "registers", "services", "adapter", "twin")


# What a family's files are called, so that who knows one family knows all: see CONTRIBUTING. A role that a family does not need is absent.
ROLES = ("family", "wire", "decoder", "adapter", "drive", "start", "polls", "feedback", "power", "motion", "homing", "stop", "parameters", "native", "actions", "demand")
ROLE_PAGES = {"README.md", "ERRATA.md", "vectors.txt", "stands_on.txt"}
ROLE_FOLDERS = {"twin", "tests", "fuzz"}


def role_faults(family, names):
    """Files and folders of a family that are no role."""
    # A role that would be over 500 lines has parts: wire_instructions.cpp beside wire.cpp.
    for name in names:
        if name not in ROLE_FOLDERS | ROLE_PAGES and not re.fullmatch(f"({'|'.join(ROLES)})(_[a-z0-9]+)?\\.[ch]pp", name):
            yield f"adapters/{family}/{name}: no role of a family has this name: {', '.join(ROLES)}"


def stands_on(family):
    """The family whose adapter's and twin's files this one may include, as its own folder says; None: it stands alone."""
    says = TOP / "adapters" / family / "stands_on.txt"
    return says.read_text(encoding="utf-8").strip() if says.is_file() else None


def room(path):
    parts = path.relative_to(TOP).parts
    if parts[0] == "adapters":
        if len(parts) > 3:
            return "twin" if parts[2] == "twin" else "test"
        name = parts[-1]
        return "twin" if name.startswith("twin") else "adapter"
    if parts[0] == "gateway":
        if parts[1] == "main.cpp":
            return "main"
        return "/".join(parts[1:3]) if parts[1] in ("doors", "protocols") else parts[1]
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
        if r in ROOMS:
            other = room(TOP / included)
            if other != r and other not in ROOMS[r] and included.removeprefix("gateway/") not in ROOMS[r]:
                return f"{r} includes itself and {', '.join(ROOMS[r]) or 'nothing else'}"
            return None
        if r == "adapter":
            if included == "gateway/axis/demand.hpp" or folder == "gateway/drive" or folder.startswith("gateway/protocols/"):
                return None
            if folder == own + "/twin" and rel.name == "family.cpp":
                return None
            base_family = stands_on(own.split("/")[1])
            if base_family and folder == f"adapters/{base_family}":
                return None
            if folder != own:
                return "a family includes core, drive, protocols, the axis' demand and itself alone"
            base = pathlib.PurePosixPath(included).name
            if base.startswith("twin") and rel.name != "family.cpp":
                return "only family.cpp may name the twin"
            return None
        if r == "twin":
            if folder.startswith("gateway/protocols/"):
                return None
            base_family = stands_on(own.split("/")[1])
            if base_family and folder == f"adapters/{base_family}/twin":
                return None
            if folder != own or not (own.endswith("/twin") or pathlib.PurePosixPath(included).name.startswith("twin")):
                return "a twin is a second reading: it includes core, protocols and twin files alone"
            return None
        return "this folder is no room"
    if r in PURE:
        for edge in SYSTEM_EDGES:
            if included == edge or included.startswith(edge) and (edge.endswith("/") or included[len(edge):len(edge) + 1] in ("", ".", "/", "+")):
                return "a pure room has no socket, clock, thread, file or log"
    if r == "store" and included.startswith("boost/asio"):
        return "the store does not know Asio"
    return None


# JSON is read and written at the edges: a request, the store, a document. What crosses rooms is a value.
WITHOUT_JSON = re.compile(r"gateway/(doors/dds/|services/command_wish\.|services/ports/fleet\."
                          r"|services/recipes/recipe(_claims|_point|_run|_steps|_words)?\.[ch]pp)")

RULES = {
    "rooms": "who includes whom",
    "json": "wishes and what is waited for are values, no JSON",
    "time": "a pure room takes time as an argument",
    "open": "nothing is left open or skipped",
    "head": "a file opens with a comment that says what it is; a source that only carries out its header opens with that",
    "once": "a header has #pragma once",
    "length": "a file is one thing",
    "classes": f"a class has at most {classes.LIMIT} functions",
    "functions": f"a function has at most {functions.LINES} lines and {functions.BRANCHES} branches",
    "families": "a family is a folder and a page of data",
    "roles": "a family's files are called by their roles",
    "errata": "a family lists the errata that it speaks of",
    "matrix": "a family tells what its twin does of each statement of the manual, and which test shows it",
    "format": "sources look as clang-format writes them",
    "alone": "the sources that a newcomer copies compile one by one",
    "python": "flake8 finds nothing in a Python file",
}


def faults_of(path, text):
    """What is wrong with one file: (rule, what)."""
    rel, lines, pure = path.relative_to(TOP), text.split("\n"), room(path) in PURE
    for n, line in enumerate(lines, 1):
        m = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        why = m and may_include(path, m.group(1))
        if why:
            yield "rooms", f"{rel}:{n}: includes {m.group(1)}: {why}"
        if WITHOUT_JSON.match(str(rel)) and re.search(r"<boost/json|\bjson::|/json_read\.hpp|/command_reader\.hpp", line):
            yield "json", f"{rel}:{n}: {RULES['json']}"
        if pure and re.search(r"\b(system_clock|steady_clock|high_resolution_clock|sleep_for|this_thread)\b", line):
            yield "time", f"{rel}:{n}: {RULES['time']}"
        if re.search(r"\b(TODO|FIXME|XXX|HACK|GTEST_SKIP|DISABLED_)\b", line) or "DISABLED_" in line:
            yield "open", f"{rel}:{n}: {RULES['open']}"
    carries_out = path.suffix == ".cpp" and lines[0].startswith(f'#include "{rel.parent}/')
    if not lines[0].startswith("// ") and not carries_out:
        yield "head", f"{rel}:1: {RULES['head']}"
    for line in itertools.takewhile(lambda x: x.startswith("//"), lines):
        if re.search(r"\bsee (the header|[a-z_0-9]+\.hpp)\b", line):
            yield "head", f"{rel}: says where to look instead of what it is: {line}"
    if path.suffix == ".hpp" and "#pragma once" not in text:
        yield "once", f"{rel}: no #pragma once"
    if len(lines) > 900:
        yield "length", f"{rel}: {len(lines)} lines: it is two things"


# Each rule can fail: a file as it must not be, and the rule that has to find it.
PROBES = (("rooms", "gateway/engine/engine.cpp", "// x\n#include <boost/asio.hpp>\n"), ("rooms", "gateway/engine/engine.cpp", '// x\n#include "adapters/uim342/wire.hpp"\n'),
          ("rooms", "gateway/protocols/canopen/sdo.cpp", '// x\n#include "gateway/drive/polls.hpp"\n'), ("rooms", "gateway/protocols/canopen/sdo.cpp", "// x\n#include <thread>\n"),
          ("rooms", "adapters/uim342/twin.cpp", '// x\n#include "adapters/uim342/wire.hpp"\n'),
          ("rooms", "adapters/uim342/drive.cpp", '// x\n#include "adapters/cia402/drive.hpp"\n'), ("rooms", "adapters/aposs/drive.cpp", '// x\n#include "adapters/uim342/drive.hpp"\n'),
          ("time", "gateway/engine/engine.cpp", "// x\nsteady_clock::now();\n"),
          ("open", "gateway/runtime/hot.cpp", "// x\n// TO" "DO\n"), ("head", "gateway/runtime/hot.cpp", "#include <vector>\n"),
          ("head", "gateway/runtime/hot.cpp", '#include "gateway/core/ids.hpp"\n'), ("head", "gateway/runtime/hot.hpp", "#pragma once\n"),
          ("json", "gateway/services/recipes/recipe_run.cpp", "// x\n#include <boost/json/value.hpp>\n"), ("json", "gateway/doors/dds/fleet.cpp", "// x\nboost::json::object body;\n"),
          ("once", "gateway/runtime/hot.hpp", "// x\n"), ("length", "gateway/runtime/hot.cpp", "// x\n" * 901))


def misformatted(sources, tool=shutil.which("clang-format-14") or "clang-format"):
    """What clang-format would write otherwise, the first place of each file. The tool is Debian's 14: others write other breaks."""
    def of(batch):
        said = subprocess.run([tool, "--dry-run", "--Werror", *map(str, batch)], cwd=TOP, capture_output=True, text=True)
        places = [line.split(": error: ")[0] for line in said.stderr.splitlines() if ": error: " in line]
        return places if said.returncode == 0 or places else [f"clang-format failed: {said.stderr[:200]}"]
    version = subprocess.run([tool, "--version"], capture_output=True, text=True).stdout
    if " 14." not in version:
        return [f"clang-format 14 is wanted, not {version.strip()}"]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [place for places in pool.map(of, [sources[i:i + 40] for i in range(0, len(sources), 40)]) for place in places]
    first = {}
    for place in found:
        first.setdefault(place.split(":")[0], place)
    return [f"{place.removeprefix(str(TOP) + '/')}: run {tool} -i" for place in first.values()]


def said_by_flake8(paths):
    """What flake8 (Debian's: pycodestyle and pyflakes, with the file .flake8 in the root) finds in Python files, one line each."""
    if not shutil.which("flake8"):
        return ["flake8 is wanted: deploy/packages/test.txt names its package"]
    said = subprocess.run(["flake8", *map(str, paths)], cwd=TOP, capture_output=True, text=True)
    found = said.stdout.splitlines()
    return found if said.returncode == 0 or found else [f"flake8 failed: {said.stderr[:200]}"]


def main():
    files = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=TOP, capture_output=True, text=True, check=True).stdout.split("\n")
    sources = [TOP / f for f in files if f.endswith((".cpp", ".hpp")) and (TOP / f).is_file()]
    faults = [f for path in sources for f in faults_of(path, path.read_text(encoding="utf-8"))]
    families = sorted(p.parent.name for p in (TOP / "adapters").glob("*/family.cpp"))
    for f in families:
        if stands_on(f) and (stands_on(f) not in families or stands_on(stands_on(f))):
            faults.append(("families", f"adapters/{f}/stands_on.txt: {stands_on(f)} is no family that stands alone"))
        faults += [("roles", what) for what in role_faults(f, [p.name for p in (TOP / "adapters" / f).iterdir()])]
        for need in (f"schema/families/{f}.json", f"adapters/{f}/README.md", f"adapters/{f}/vectors.txt", f"adapters/{f}/tests/facts.json"):
            if not (TOP / need).is_file():
                faults.append(("families", f"{need} is missing: {RULES['families']}"))
        # A family lists every erratum of its manual that it speaks of (`| E-04 |`, `**E-04**`).
        listed = {int(n) for page in (TOP / "adapters" / f).glob("*.md") for n in re.findall(r"^(?:[|*] *)?\**`?E-(\d+)\b", page.read_text(encoding="utf-8"), re.M)}
        for page in [p for p in (TOP / "adapters" / f).rglob("*") if p.is_file()] + [TOP / f"schema/families/{f}.json"]:
            missing = {int(n) for n in re.findall(r"\bE-(\d+)\b", page.read_text(encoding="utf-8", errors="replace"))} - listed
            if missing:
                faults.append(("errata", f"{page.relative_to(TOP)}: E-{min(missing):02} stands in no list of adapters/{f}/*.md"))
    faults += [("matrix", what) for what in matrix.faults(TOP, families)]
    if not matrix.holds():
        faults.append(("matrix", "the rule no longer finds what it is for"))
    headers = [p for p in sources if p.suffix == ".hpp" and p.relative_to(TOP).parts[0] in ("gateway", "adapters")]
    counted = [(str(p.relative_to(TOP)), *c) for p in headers for c in classes.functions_of(p.read_text(encoding="utf-8"))]
    faults += [("classes", what) for what in classes.faults_of(counted)]
    if not classes.holds():
        faults.append(("classes", "the rule no longer finds what it is for"))
    bodies = [p for p in sources if p.relative_to(TOP).parts[0] in ("gateway", "adapters")]
    measured = []
    for p in bodies:
        text = p.read_text(encoding="utf-8")
        measured += [(str(p.relative_to(TOP)), *f) for f in functions.functions_of(text)]
        faults += [("functions", f"{p.relative_to(TOP)}:{n}: tests/tidy/functions.py finds no function here") for n in functions.unread(text)]
    faults += [("functions", what) for what in functions.faults_of(measured)]
    if not functions.holds() or len(measured) < 5 * len(bodies):
        faults.append(("functions", "the rule no longer finds what it is for"))
    faults += [("format", what) for what in misformatted(sources)]
    with tempfile.NamedTemporaryFile("w", suffix=".cpp", dir=TOP / "tests/tidy") as probe:
        probe.write("int  x ;\n")
        probe.flush()
        if not misformatted([pathlib.Path(probe.name)]):
            faults.append(("format", "the rule no longer finds what it is for"))
    faults += [("alone", what) for what in alone.faults_of(TOP, alone.sources_of(TOP))]
    if not alone.holds(TOP) or len(alone.sources_of(TOP)) < 20:
        faults.append(("alone", "the rule no longer finds what it is for"))
    faults += [("python", what) for what in said_by_flake8([f for f in files if f.endswith(".py") and (TOP / f).is_file()])]
    with tempfile.NamedTemporaryFile("w", suffix=".py", dir=TOP / "tests/tidy") as probe:
        probe.write("import os\nx = unknown \n")
        probe.flush()
        if [line.split()[1] for line in said_by_flake8([probe.name])] != ["F401", "F821", "W291"]:
            faults.append(("python", "the rule no longer finds what it is for"))
    if len(sources) < 100 or not families:
        faults.append(("rooms", f"only {len(sources)} sources and {len(families)} families were found"))
    for rule, name, text in PROBES:
        if [r for r, _ in faults_of(TOP / name, text)] != [rule]:
            faults.append((rule, f"the rule no longer finds what it is for: {name}"))
    if not list(role_faults("x", ["adapter.cpp", "node.cpp"])) or list(role_faults("x", ["wire.hpp", "wire_framer.cpp", "twin"])):
        faults.append(("roles", "the rule no longer finds what it is for"))
    for _, what in faults:
        print(what)
    broken = {rule for rule, _ in faults}
    for rule, words in RULES.items():
        print(f"{'FAIL' if rule in broken else 'pass'}: {words} ({len(sources)} files)")
    print(f"{len(RULES) - len(broken)} passed, {len(broken)} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
