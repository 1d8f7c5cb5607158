"""Compiles the sources that a newcomer copies one by one: without unity files and without precompiled headers, which hide missing includes.

In: the example family, the drive kit, the test of a third door. Out: the first error of each source that does not compile by itself.
A header that is not complete in itself is found by the source that includes it first.
"""
import concurrent.futures
import os
import pathlib
import subprocess
import tempfile

COPIED = ("adapters/example", "gateway/drive", "tests/unit/runtime/third_door_test.cpp")
FLAGS = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-DAXISGATE_VERSION=\"\"", "-DAXISGATE_SOURCE_DIR=\"\""]
LIMIT_S = 600


def sources_of(top, copied=COPIED):
    """Fuzz targets are made by the fuzzer's own compiler, and are left out."""
    found = []
    for name in copied:
        place = pathlib.Path(top) / name
        found += [place] if place.is_file() else sorted(p for p in place.rglob("*.cpp") if "fuzz" not in p.parts)
    return found


def faults_of(top, paths, compiler="clang++-14"):
    def of(path):
        said = subprocess.run([compiler, *FLAGS, f"-I{top}", "-x", "c++", str(path)], capture_output=True, text=True, timeout=LIMIT_S)
        if said.returncode == 0:
            return None
        errors = [line for line in said.stderr.splitlines() if "error:" in line]
        return (errors or [f"{path}: {said.stderr[:200]}"])[0].removeprefix(f"{top}/")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [fault for fault in pool.map(of, paths) if fault]


def holds(top):
    """True if the rule finds a missing include and a hidden name."""
    with tempfile.TemporaryDirectory() as folder:
        probes = {"missing.cpp": "std::string s;\n", "shadow.cpp": "int f(int x) { { int x = 1; return x; } }\n", "good.cpp": "#include <string>\nstd::string s;\n"}
        for name, text in probes.items():
            (pathlib.Path(folder) / name).write_text(text, encoding="utf-8")
        found = faults_of(top, [pathlib.Path(folder) / name for name in probes])
    return len(found) == 2 and "missing.cpp" in found[0] and "shadow.cpp" in found[1]
