"""The appliance around the program: its unit and configuration file, what it tells the service manager, and the upgrade that waits for it."""
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time
import tomllib

import harness
from harness import Gateway, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]
CONFIGURATION = TOP / "systemd/axisgate.toml"


def test_the_configuration_file_has_every_key_and_no_other():
    text = CONFIGURATION.read_text()
    assert run("check", "--config", str(CONFIGURATION), check=0)[1].strip() == "no faults found"
    known = set()
    _, _, sections = run("check", "--set", "nothing.at=all")
    for section in re.findall(r"\[(\w+)\]", sections):
        _, _, names = run("check", "--set", f"{section}.nothing=1")
        known |= {f"{section}.{name.strip()}" for name in names.split("keys:")[1].split(",")}
    assert len(known) > 30, known
    written, section = set(), ""
    for line in text.splitlines():
        if m := re.fullmatch(r"\[(\w+)\]", line):
            section = m.group(1)
        elif m := re.match(r"#?(\w+) = \S.*#? ?", line):
            written.add(f"{section}.{m.group(1)}")
            assert "#" in line[1:], f"not explained: {line}"
    assert written == known, written ^ known
    assert tomllib.loads(text)["users"]["local_role"] == "none"
    assert all("127.0.0.1" in tomllib.loads(text)[door]["bind"] for door in ("http", "modbus", "enip")), "loopback until somebody decides"


def test_the_unit_is_sound_and_hardened():
    if not shutil.which("systemd-analyze"):
        raise AssertionError("systemd-analyze is missing: it is part of Debian's systemd")
    said = subprocess.run(["systemd-analyze", "security", "--offline=yes", str(TOP / "systemd/axisgate.service")], capture_output=True, text=True).stdout
    level = float(re.search(r"exposure level for axisgate.service: ([\d.]+)", said).group(1))
    assert level <= 2.0, said
    with tempfile.TemporaryDirectory() as folder:
        unit = pathlib.Path(folder) / "axisgate.service"
        text = (TOP / "systemd/axisgate.service").read_text()
        unit.write_text(text.replace("/usr/bin/axisgate", harness.PROGRAM).replace("Documentation=", "#"))
        said = subprocess.run(["systemd-analyze", "verify", "--man=no", str(unit)], capture_output=True, text=True)
        assert said.returncode == 0 and not said.stderr.strip(), said.stderr


class Manager:
    """The socket of a service manager, read all the time as one does: the kernel keeps no more than ten words for it."""

    def __init__(self, folder, reads=True):
        self.path = str(folder / "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.told = []
        if reads:
            self.begin_to_read()

    def begin_to_read(self):
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        while True:
            self.told += [(time.monotonic(), line) for line in self.socket.recv(4096).decode().splitlines()]

    def read(self):
        return list(self.told)

    def last(self, kind):
        return next((text for _, text in reversed(self.read()) if text.startswith(kind)), "")


def test_the_manager_is_told_when_it_is_ready_what_moves_and_that_it_lives():
    with tempfile.TemporaryDirectory() as name:
        manager = Manager(pathlib.Path(name))
        os.environ.update(NOTIFY_SOCKET=manager.path, WATCHDOG_USEC="1000000")
        try:
            with harness.Folder() as data, Gateway(data) as g:
                until(lambda: manager.last("READY=1"), 5, "READY")
                until(lambda: manager.last("STATUS=") == "STATUS=2 axes, 2 online, 0 moving", 5, "status")
                g.command("feeder", {"command": "enable"})
                g.command("feeder", {"command": "move_absolute", "position": 30, "velocity": 5}, wait=0)
                until(lambda: manager.last("STATUS=") == "STATUS=2 axes, 2 online, 1 moving", 5, "it moves")
                g.command("feeder", {"command": "quick_stop"})
                until(lambda: manager.last("STATUS=").endswith(" 0 moving"), 5, "it stands")
                fed = [t for t, text in manager.read() if text == "WATCHDOG=1"]
                assert len(fed) > 2 and max(b - a for a, b in zip(fed, fed[1:])) < 1.0, "within half of its time"
                os.kill(g.process.pid, 19)
                time.sleep(0.5)  # what it said before has come
                before = len([1 for _, text in manager.read() if text == "WATCHDOG=1"])
                time.sleep(1.2)
                assert len([1 for _, text in manager.read() if text == "WATCHDOG=1"]) == before
                os.kill(g.process.pid, 18)
                assert g.stop() == 0
        finally:
            del os.environ["NOTIFY_SOCKET"], os.environ["WATCHDOG_USEC"]
        until(lambda: manager.last("STOPPING=1"), 5, "STOPPING")


def test_a_manager_that_is_busy_while_the_gateway_starts_is_told_that_it_is_ready():
    with tempfile.TemporaryDirectory() as name:
        manager = Manager(pathlib.Path(name), reads=False)
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as others:  # other services fill its queue
            others.setblocking(False)
            for _ in range(100):
                try:
                    others.sendto(b"STATUS=of another", manager.path)
                except BlockingIOError:
                    break
            else:
                raise AssertionError("its queue has no end")
        os.environ.update(NOTIFY_SOCKET=manager.path, WATCHDOG_USEC="1000000")
        try:
            with harness.Folder() as data, Gateway(data) as g:
                assert not manager.read(), "it reads nothing yet"
                manager.begin_to_read()
                until(lambda: manager.last("READY=1"), 5, "READY")
                until(lambda: manager.last("STATUS=2") == "STATUS=2 axes, 2 online, 0 moving", 5, "status")
                assert g.stop() == 0
        finally:
            del os.environ["NOTIFY_SOCKET"], os.environ["WATCHDOG_USEC"]


def test_an_upgrade_waits_until_no_axis_moves():
    script = (TOP / "deploy/debian/preinst").read_text().replace("#DEBHELPER#", "")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "preinst").write_text(script)
        status = folder / "status"
        (folder / "systemctl").write_text(f"#!/bin/sh\ncat {status}\n")
        (folder / "systemctl").chmod(0o755)

        def preinst(*arguments, **more):
            return subprocess.run(["sh", str(folder / "preinst"), *arguments], capture_output=True, text=True, env={"PATH": f"{folder}:{os.environ['PATH']}", "AXISGATE_WAIT_S": "1", **more})
        status.write_text("3 axes, 3 online, 2 moving\n")
        said = preinst("upgrade", "0.1.0")
        assert said.returncode == 1 and "still moving" in said.stderr and "AXISGATE_FORCE=1" in said.stderr, said
        assert preinst("upgrade", "0.1.0", AXISGATE_FORCE="1").returncode == 0
        assert preinst("install").returncode == 0
        status.write_text("12 axes, 3 online, 0 moving\n")
        assert preinst("upgrade", "0.1.0").returncode == 0
        status.write_text("\n")
        assert preinst("upgrade", "0.1.0").returncode == 0, "it does not run"
        waiting = subprocess.Popen(["sh", str(folder / "preinst"), "upgrade", "0.1.0"], env={"PATH": f"{folder}:{os.environ['PATH']}"}, stderr=subprocess.PIPE, text=True)
        status.write_text("3 axes, 3 online, 1 moving\n")
        time.sleep(0.3)
        status.write_text("3 axes, 3 online, 0 moving\n")
        assert waiting.wait(10) == 0


def test_the_threads_have_the_ranks_that_the_system_grants(folder):
    """Drives before HTTP, HTTP before all others, the database never: policy 2 is SCHED_RR, 0 the normal one (proc(5))."""
    granted = os.fork()
    if granted == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(2))
        except PermissionError:
            os._exit(1)
        os._exit(0)
    ranks = os.waitstatus_to_exitcode(os.waitpid(granted, 0)[1]) == 0
    with Gateway(folder) as g:
        def rank(name):
            for task in pathlib.Path(f"/proc/{g.process.pid}/task").iterdir():
                if (task / "comm").read_text().strip() == name:
                    fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
                    return int(fields[37]), int(fields[38])  # rt_priority, policy
            return None
        http = (1, 2) if ranks and len(os.sched_getaffinity(0)) > 1 else (0, 0)
        until(lambda: rank("axisgate-warm") == http, 5, "the rank of the thread that serves HTTP")
        assert rank("axisgate-hot") == ((2, 2) if ranks else (0, 0)), rank("axisgate-hot")
        assert rank("axisgate-cold") == (0, 0), rank("axisgate-cold")
