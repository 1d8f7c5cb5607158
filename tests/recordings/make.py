#!/usr/bin/env python3
"""Makes the recordings of this folder anew: small worlds with a fault each, recorded by the real program on simulated drives.

In: the program's path, and which ones (all). Out: NAME.axr here. To be run when a recording does not do the same any more for a good reason: the
version of the format has changed, or what an adapter, a twin or the engine does. `tests/system/test_recorder.py` replays all of them.
    tests/recordings/make.py build/release/axisgate [NAME...]
"""
import os
import pathlib
import shutil
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "system"))


def one_drive(family, address, per_unit=100, **more):
    return {"lines": [{"name": "line", "uri": "twin", "family": family, **more}], "drives": [{"name": "feeder", "line": "line", "address": address}],
            "axes": [{"name": "feeder", "drive": "feeder", "number": 1, "unit": "mm", "increments_per_unit": per_unit}], "mappings": []}


def stalled(g, until):
    """A carriage hits its stop while it moves: the drive loses its steps and reports a fault; it is reset."""
    g.command("feeder", {"command": "enable"})
    g.command("feeder", {"command": "move_velocity", "velocity": 1, "acceleration": 20}, wait=0)
    time.sleep(0.3)
    g.send("PATCH", "/drives/feeder/hand", {"stall": True})
    until(lambda: g.axis()["fault"], 10, "the fault")
    g.send("PATCH", "/drives/feeder/hand", {"stall": False})
    g.command("feeder", {"command": "reset_fault"})


def silent(g, until):
    """A cable comes loose while the axis moves, and is put back."""
    g.command("feeder", {"command": "enable"})
    g.command("feeder", {"command": "move_velocity", "velocity": 5, "acceleration": 50}, wait=0)
    time.sleep(0.3)
    g.send("PATCH", "/drives/feeder/hand", {"silent": True})
    until(lambda: not g.axis()["online"], 10, "silence")
    time.sleep(0.5)
    g.send("PATCH", "/drives/feeder/hand", {"silent": False})
    until(lambda: g.axis()["online"], 15, "its return")
    time.sleep(0.3)


def power_lost(g, until):
    """The drive's power goes while it holds a position; what waits for it is answered."""
    g.command("feeder", {"command": "enable"})
    g.command("feeder", {"command": "move_relative", "position": 2, "velocity": 10, "acceleration": 100, "deceleration": 100})
    g.send("PATCH", "/drives/feeder/hand", {"power": False})
    until(lambda: not g.axis()["online"], 10, "silence")
    g.send("PATCH", "/drives/feeder/hand", {"power": True})
    until(lambda: g.axis()["online"], 20, "its return")
    time.sleep(0.3)


WORLDS = {"uim342-stalled": (one_drive("uim342", 5), stalled), "cia402-power-lost": (one_drive("cia402", 5, 1000), power_lost), "linmot-cable-loose": (one_drive("linmot", 17, 10000), silent)}


def main(program, names):
    os.environ["AXISGATE"] = program
    import harness  # noqa: PLC0415  looks for the program when it is read
    harness.PROGRAM = pathlib.Path(program).resolve()
    for name in names or WORLDS:
        site, play = WORLDS[name]
        folder = pathlib.Path(tempfile.mkdtemp(prefix="axisgate-recording-"))
        try:
            with harness.Gateway(folder, site) as g:
                harness.until(lambda: g.axis()["online"], 15, "the drive")
                play(g, harness.until)
                g.send("POST", "/recorder/recordings", {"name": name, "why": play.__doc__}, 201)
            shutil.copy(folder / "data" / "recordings" / f"{name}.axr", HERE / f"{name}.axr")
            print(f"{name}.axr: {(HERE / f'{name}.axr').stat().st_size} bytes")
        finally:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
