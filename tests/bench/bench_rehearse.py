"""bench_rehearse measures a thousand rehearsals of a recipe of twenty steps by the program itself, on all processors; the limit is a minute.

In: the program. Out: per family the time, its limit, and how many specimens passed. A specimen that fails early costs less, so the recipe waits for each
state of the drive, as a recipe for real drives does, and most specimens of each family must pass.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

DEMO = json.loads((pathlib.Path(__file__).resolve().parents[2] / "deploy/examples/demo-site.json").read_text())
AXES = {"uim342": "feeder", "mcode": "lift", "cia402": "spindle"}
COUNT, LIMIT_S = 1000, 60.0


def site_of(axis):
    axis = next(a for a in DEMO["axes"] if a["name"] == axis)
    drive = next(d for d in DEMO["drives"] if d["name"] == axis["drive"])
    line = next(x for x in DEMO["lines"] if x["name"] == drive["line"])
    line = {**line, "family": drive.get("family", line["family"])}
    return {"lines": [line], "drives": [{k: v for k, v in drive.items() if k not in ("description", "family")}], "axes": [axis], "mappings": []}


def recipe_of(axis, family):
    """Twenty steps: on, four moves with a wait and two checks each, and the present position becomes 0 before them, or off after them.

    A drive may need two seconds until its status shows that it is on. The counter of an incremental encoder begins anywhere; a CiA 402 drive needs
    another mode to set it, and does not count from before.
    """
    steps = [{"enable": {"axis": axis}}, {"wait_s": 2.5}, {"wait_for": {"axis": axis, "point": "state", "is": "operation_enabled", "timeout_s": 20}}]
    if family != "cia402":
        steps += [{"command": {"axis": axis, "command": "set_position", "position": 0}}]
    for position in (1, 3, 2, 4):
        steps += [{"command": {"axis": axis, "command": "move_absolute", "position": position, "velocity": 10, "wait_s": 60}},
                  {"wait_for": {"axis": axis, "point": "moving", "is": False, "timeout_s": 20}},
                  {"wait_s": 0.2},
                  {"check": {"axis": axis, "point": "position", "is": position, "tolerance": 0.5}}]
    return {"steps": steps if family != "cia402" else steps + [{"disable": {"axis": axis}}]}


def main(program):
    kept = True
    for family, axis in AXES.items():
        with tempfile.TemporaryDirectory() as folder:
            site, recipe = pathlib.Path(folder) / "site.json", pathlib.Path(folder) / "twenty.json"
            site.write_text(json.dumps(site_of(axis)))
            document = recipe_of(axis, family)
            assert len(document["steps"]) == 20, len(document["steps"])
            recipe.write_text(json.dumps(document))
            begun = time.monotonic()
            p = subprocess.run([program, "rehearse", "--site", str(site), "--recipe", str(recipe), "--specimens", f"1..{COUNT}", "--json"],
                               capture_output=True, text=True)
            took = time.monotonic() - begun
            if p.returncode not in (0, 1):
                print(p.stderr, file=sys.stderr)
                return 2
            passed = json.loads(p.stdout)["passed"]
            good = took <= LIMIT_S
            kept = kept and good
            name = f"{family}, {COUNT} rehearsals"
            print(f"    {name:<34} ratio {took / LIMIT_S:10.3f}  limit <= 1  {'kept' if good else 'NOT KEPT':<8}  used {took:.4g} s, limit {LIMIT_S:.4g} s; {passed} passed", flush=True)
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
