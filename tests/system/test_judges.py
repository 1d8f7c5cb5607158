"""Drives and hosts that were written from the makers' manuals alone (tests/clients/judges), on lines of bytes: the gateway brings each of those
drives into motion, and each of those hosts moves a twin. In: the real program, python3. Out: what the gateway shows, the checks that the hosts print.
"""
import contextlib
import pathlib
import subprocess
import tempfile

from harness import Gateway, Process, until
from test_enip import device

JUDGES = pathlib.Path(__file__).resolve().parents[1] / "clients/judges"
PYTHON = ["/usr/bin/python3", "-u", "-B"]


@contextlib.contextmanager
def drive(name, *switches):
    """A judge that is a drive; gives the URI of its line. What it printed stands in the fault of a test."""
    with tempfile.TemporaryFile("w+") as log:
        process = subprocess.Popen([*PYTHON, str(JUDGES / f"{name}.py"), *switches], stdout=log, stderr=subprocess.STDOUT)

        def said():
            log.seek(0)
            return log.read()

        def ready():
            assert process.poll() is None, said()
            return next((line.split()[1] for line in said().splitlines(True) if line.startswith("ready ") and line.endswith("\n")), None)
        try:
            yield until(ready, 15, f"ready of {name}")
            assert process.poll() is None, said()
        except BaseException:
            print(f"---- {name} {' '.join(switches)}: {said()[-2000:]}")
            raise
        finally:
            process.kill()
            process.wait()


def host(name, *arguments):
    p = subprocess.run([*PYTHON, str(JUDGES / f"{name}.py"), *map(str, arguments)], capture_output=True, text=True, timeout=60)
    print(p.stdout)
    assert p.returncode == 0 and "pass: " in p.stdout and "FAIL: " not in p.stdout, p.stdout + p.stderr


def site(family, uri, address=None, line=None, drive=None, axis=None):
    # A judge is a process beside many others: its answers may be late by what the machine does meanwhile.
    return {"lines": [{"name": "wire", "uri": uri, "family": family, "timing": {"reply_timeout_ms": 1000}, **(line or {})}],
            "drives": [{"name": "judge", "line": "wire", "presence": "device", **({} if address is None else {"address": address}), **(drive or {})}],
            "axes": [{"name": "judge", "drive": "judge", "number": 1, **(axis or {})}], "mappings": []}


def done(g, body, wait=30):
    answer = g.command("judge", body, wait)
    assert answer["result"] == "done", (body, answer)


def state(g):
    return g.axis("judge")


def in_motion(g, reference, near, far, speed, ramp, close=0):
    try:
        moved(g, reference, near, far, speed, ramp, close)
    except BaseException:
        print(f"---- {state(g)}\n" + "\n".join(f"{e['kind']} {e['text']}" for e in g.get("/events?limit=12")))
        raise


def moved(g, reference, near, far, speed, ramp, close):
    """Enable, `reference`, a move to `near`, one towards `far` that is stopped in flight, disable: by what the drive shows."""
    until(lambda: state(g)["online"] and not state(g)["simulated"], 20, "the drive is found")
    assert not state(g)["moving"] and state(g)["state"] != "operation_enabled", state(g)
    done(g, {"command": "enable"})
    until(lambda: state(g)["state"] == "operation_enabled", 10, "enabled")
    done(g, reference)
    move = {"command": "move_absolute", "velocity": speed, "acceleration": ramp, "deceleration": ramp}
    done(g, {**move, "position": near})
    until(lambda: abs(state(g)["position_increments"] - near) <= close and state(g)["target_reached"], 10, f"at {near}")
    start = state(g)["position_increments"]
    way = 1 if far > near else -1
    assert g.command("judge", {**move, "position": far}, 0)["result"] in ("accepted", "done")
    until(lambda: (state(g)["position_increments"] - start) * way > abs(far - near) / 20, 10, "the long move")
    done(g, {"command": "halt"})
    until(lambda: not state(g)["moving"], 10, "the stop")
    place = state(g)["position_increments"]
    assert min(near, far) < place < max(near, far) and place != start, (place, near, far)
    done(g, {"command": "disable"})
    until(lambda: state(g)["state"] != "operation_enabled", 10, "disabled")
    assert not state(g)["moving"] and abs(state(g)["position_increments"] - place) <= max(close, abs(far - near) / 10), (state(g), place)


LINMOT = (("--line", "tcp"),
          ("--line", "tcp", "--answer-ms", "0..60", "--chunk", "3", "--count", "5", "--old-state-ms", "120", "--homing-ms", "700", "--test-ms", "900"),
          ("--line", "tcp", "--old-state-ms", "300", "--no-ram"),
          ("--line", "pty", "--noise", "0.2", "--drop", "17", "--forced", "--no-ram", "--boot-ms", "500"))


def test_linmot_drives_of_the_manual_are_moved(folder):
    for n, switches in enumerate(LINMOT):
        with drive("linmot_drive", *switches) as uri, Gateway(make(folder, n), site("linmot", uri, 17, {"timing": {"reply_timeout_ms": 400}})) as g:
            in_motion(g, {"command": "home"}, 300000, 3000000, 1000000, 10000000, 5)


def make(folder, n):
    place = folder / str(n)
    place.mkdir()
    return place


def test_a_linmot_master_of_the_manual_moves_the_twin(folder):
    for specimen in ("0", "strict"):
        with Process("twin", "linmot", "--line", f"pty:{folder / specimen}", "--address", "17", "--specimen", specimen):
            host("linmot_master", folder / specimen, 17)


MCODE = (("--line", "pty", "--answer-ms", "0..40", "--chunk", "5"),
         ("--line", "tcp", "--old-firmware", "--deaf-ms", "5", "--data-first", "--execute-ms", "20", "--settle-ms", "250"),
         ("--line", "pty", "--names", "B", "--answer-ms", "10..60", "--loud-global"))


def test_mcode_drives_of_the_reference_are_moved(folder):
    for n, switches in enumerate(MCODE):
        name = switches[switches.index("--names") + 1] if "--names" in switches else "!"
        with drive("mcode_drive", *switches) as uri, Gateway(make(folder, n), site("mcode", uri, name)) as g:
            in_motion(g, {"command": "set_position", "position": 0}, 51200, -600000, 300000, 1000000)


def test_an_mcode_host_of_the_reference_moves_the_twin(folder):
    for specimen in ("0", "sparse"):
        with Process("twin", "mcode", "--line", f"pty:{folder / specimen}", "--address", "!", "--specimen", specimen):
            host("mcode_host", folder / specimen, "single")
    with Process("twin", "mcode", "--line", f"pty:{folder / 'party'}", "--address", "a", "--address", "b"):
        host("mcode_host", folder / "party", "party")


PACONTROL = (("--line", "pty", "--answer-ms", "5..40", "--chunk", "4", "--position-ms", "50"),
             ("--line", "tcp", "--check", "etx", "--state-late-ms", "150", "--axis-late-ms", "150", "--power-ms", "400", "--silent-poll"),
             ("--line", "tcp", "--zero-reply", "--no-stop-multi", "--ep", "--axes", "1", "--answer-ms", "0..90"))


def test_controls_of_the_pacontrol_manual_are_moved(folder):
    for n, switches in enumerate(PACONTROL):
        with drive("pacontrol_drive", *switches) as uri, Gateway(make(folder, n), site("pacontrol", uri, "com1", axis={"channel": 1})) as g:
            in_motion(g, {"command": "home"}, 30000, 400000, 150000, 800000, 1)


def test_a_pacontrol_host_of_the_manual_moves_the_twin(folder):
    for specimen in ("0",):
        with Process("twin", "pacontrol", "--line", f"pty:{folder / specimen}", "--specimen", specimen):
            host("pacontrol_host", folder / specimen)


UIM342 = ((("--line", "tcp"), {}),
          (("--line", "tcp", "--crc", "13", "--answer-ms", "0..60", "--chunk", "7", "--flags-late-ms", "120", "--chatter-ms", "20", "--reserved", "85"), {"crc": "auto"}),
          (("--line", "pty", "--crc", "none", "--noise", "0.1", "--drop", "13", "--chatter-ms", "40", "--rt-first", "--microsteps", "32"), {"crc": "none"}))


def test_uim342_drives_of_the_manual_are_moved(folder):
    for n, (switches, options) in enumerate(UIM342):
        with drive("uim342_drive", *switches) as uri, Gateway(make(folder, n), site("uim342", uri, 5, {"options": options})) as g:
            in_motion(g, {"command": "home"}, 20000, -600000, 100000, 400000)  # six seconds: a reading that is lost costs one


def test_a_uim342_host_of_the_manual_moves_the_twin(folder):
    for specimen in ("0", "old"):
        with Process("twin", "uim342", "--line", f"pty:{folder / specimen}", "--address", "5", "--specimen", specimen):
            host("uim342_host", folder / specimen, 5)


def test_a_client_of_plain_ethernet_ip_messages(folder):
    with device(folder) as (g, at):
        until(lambda: g.axis()["online"], 10, "online")
        host("enip_client", *at[:2], "151:101")
