"""Finds and runs every test_* function of the test_*.py files beside it; each gets what it names: `folder`, `gateway`.

In: the program, and parts of names. Out: one line per test, then "N passed, N failed".
"""
import importlib
import inspect
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


def main():
    harness.PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    passed = failed = 0
    for path in sorted(HERE.glob("test_*.py")):
        module = importlib.import_module(path.stem)
        for name, function in inspect.getmembers(module, inspect.isfunction):
            full = f"{path.stem}.{name}"
            if not name.startswith("test_") or function.__module__ != path.stem:
                continue
            if len(sys.argv) > 2 and not any(part in full for part in sys.argv[2:]):
                continue
            begun = time.monotonic()
            try:
                call(function)
                passed += 1
                print(f"pass: {full} ({time.monotonic() - begun:.1f} s)", flush=True)
            except BaseException as e:  # noqa: BLE001
                if isinstance(e, KeyboardInterrupt):
                    raise
                failed += 1
                print(f"FAIL: {full}", flush=True)
                traceback.print_exc(file=sys.stdout)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
