"""Finds and runs every test_* function of the test_*.py files beside it; each gets what it names: `folder`, `gateway`.

In: the program, and parts of names; AXISGATE_SYSTEM_WORKERS (4): how many tests at a time, since they mostly wait. Each has its own folder,
and every port is one that was free. Tests that are marked `alone` run behind the others, one by one. Out: one line per test, then "N passed, N failed".
"""
import concurrent.futures
import contextlib
import importlib
import inspect
import io
import multiprocessing
import os
import pathlib
import sys
import time
import traceback

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True
import harness  # noqa: E402


def call(function):
    wanted = inspect.signature(function).parameters
    with harness.Folder() as folder:
        if "gateway" in wanted:
            with harness.Gateway(folder) as gateway:
                arguments = {"gateway": gateway}
                if "folder" in wanted:
                    arguments["folder"] = folder
                try:
                    function(**arguments)
                except BaseException:
                    print("---- what the gateway logged last\n" + "\n".join(gateway.errors().splitlines()[-15:]))
                    raise
                assert gateway.process.poll() in (None, 0), f"the gateway ended with {gateway.process.returncode}"
        else:
            function(**({"folder": folder} if "folder" in wanted else {}))


def attempt(stem, name):
    """One test, in a process of the pool: whether it passed, and what there is to say."""
    begun, said = time.monotonic(), io.StringIO()
    with contextlib.redirect_stdout(said):
        try:
            call(getattr(importlib.import_module(stem), name))
            return True, f"{said.getvalue()}pass: {stem}.{name} ({time.monotonic() - begun:.1f} s)"
        except Exception:  # noqa: BLE001
            return False, f"{said.getvalue()}FAIL: {stem}.{name}\n{traceback.format_exc()}"


def attempts(tests, workers):
    """The results of `attempt`, as they come."""
    with concurrent.futures.ProcessPoolExecutor(workers, multiprocessing.get_context("fork")) as pool:
        running = {pool.submit(attempt, *test): test for test in tests}
        for ended in concurrent.futures.as_completed(running):
            try:
                yield ended.result()
            except concurrent.futures.process.BrokenProcessPool as e:
                yield False, "FAIL: {}.{}: {}".format(*running[ended], e)


def main():
    harness.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    wanted, alone = [], []
    for path in sorted(HERE.glob("test_*.py")):
        module = importlib.import_module(path.stem)
        for name, function in inspect.getmembers(module, inspect.isfunction):
            if not name.startswith("test_") or function.__module__ != path.stem:
                continue
            if len(sys.argv) <= 2 or any(part in f"{path.stem}.{name}" for part in sys.argv[2:]):
                (alone if getattr(function, "alone", False) else wanted).append((path.stem, name))
    passed = failed = 0
    for tests, workers in ((wanted, int(os.environ.get("AXISGATE_SYSTEM_WORKERS", "4"))), (alone, 1)):
        for good, text in attempts(tests, workers):
            passed += good
            failed += not good
            print(text, flush=True)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
