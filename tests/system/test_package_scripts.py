"""The package's scripts and its unit, without a package: what dpkg calls on its way back from a refused upgrade touches nothing, and systemd never gives up."""
import os
import pathlib
import socket
import subprocess

from harness import Gateway, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def post_installation(*arguments):
    """The script with a word in the place of what debhelper puts there: the restart of the service is part of that."""
    text = (TOP / "deploy/debian/postinst").read_text()
    assert "#DEBHELPER#" in text
    return subprocess.run(["sh", "-c", text.replace("#DEBHELPER#", "echo restarted"), "postinst", *arguments], capture_output=True, text=True, timeout=20)


def test_a_refused_upgrade_does_not_start_the_gateway_anew():
    for way_back in (("abort-upgrade", "0.2.0"), ("abort-remove",), ("abort-remove", "in-favour", "other", "1"), ("abort-deconfigure", "in-favour", "x", "1")):
        done = post_installation(*way_back)
        assert done.returncode == 0 and done.stdout == "", (way_back, done)
    done = post_installation("configure", "0.1.0")
    assert done.returncode == 0 and done.stdout == "restarted\n", done


def test_the_unit_has_no_limit_of_starts():
    unit = (TOP / "systemd/axisgate.service").read_text()
    head = unit[unit.index("\n[Unit]") : unit.index("\n[Service]")]
    assert "\nStartLimitIntervalSec=0\n" in head
    assert "\nRestart=on-failure\n" in unit


def package(folder, version, scripts):
    """A package of the real scripts and nothing else. In the place of debhelper's mark stands what dh_installsystemd puts there, without its asking whether
    systemd runs: the restart on each way into the script."""
    mark = {"postinst": 'if [ "$1" = configure ] || [ "$1" = abort-upgrade ] || [ "$1" = abort-deconfigure ] || [ "$1" = abort-remove ]; then systemctl restart axisgate.service; fi'}
    tree = folder / f"tree-{version}"
    (tree / "DEBIAN").mkdir(parents=True)
    (tree / "DEBIAN/control").write_text(f"Package: axisgate\nVersion: {version}\nArchitecture: all\nMaintainer: nobody <nobody@example.org>\nDescription: the scripts\n")
    for name, text in scripts.items():
        (tree / "DEBIAN" / name).write_text(text.replace("#DEBHELPER#", mark.get(name, "")))
        (tree / "DEBIAN" / name).chmod(0o755)
    deb = folder / f"axisgate-{version}.deb"
    subprocess.run(["dpkg-deb", "--root-owner-group", "-b", str(tree), str(deb)], check=True, capture_output=True, timeout=60)
    return deb


class Host:
    """A machine's dpkg in a folder, and a `systemctl` that tells the gateway's own word of its state and, asked to restart it, ends its process."""

    def __init__(self, folder):
        self.root, self.bin = folder / "root", folder / "bin"
        for d in ("var/lib/dpkg/updates", "var/lib/dpkg/info", "var/lib/dpkg/triggers"):
            (self.root / d).mkdir(parents=True)
        for f in ("status", "available"):
            (self.root / "var/lib/dpkg" / f).touch()
        self.bin.mkdir()
        self.status, self.asked, self.pid = folder / "status", folder / "asked", folder / "pid"
        self.asked.touch()
        systemctl = self.bin / "systemctl"
        systemctl.write_text(f'#!/bin/sh\nif [ "$1" = show ]; then cat {self.status}; exit 0; fi\necho "$*" >>{self.asked}\n[ ! -e {self.pid} ] || kill -TERM $(cat {self.pid})\n')
        systemctl.chmod(0o755)

    def dpkg(self, *arguments, **more):
        env = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}", "AXISGATE_WAIT_S": "1", **more}
        return subprocess.run(["dpkg", f"--root={self.root}", "--force-script-chrootless", "--force-bad-path", "--log=/dev/null",
                               *map(str, arguments)], capture_output=True, text=True, timeout=120, env=env)

    def version(self):
        return subprocess.run(["dpkg-query", f"--admindir={self.root}/var/lib/dpkg", "-W", "-f=${Version} ${db:Status-Abbrev}", "axisgate"], capture_output=True, text=True).stdout.strip()


def test_dpkg_refuses_an_upgrade_while_an_axis_moves_and_touches_nothing(folder):
    scripts = {name: (TOP / "deploy/debian" / name).read_text() for name in ("preinst", "postinst", "postrm")}
    host = Host(folder)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(folder / "notify"))
        manager.setblocking(False)
        os.environ["NOTIFY_SOCKET"] = str(folder / "notify")
        try:
            g = Gateway(folder)
        finally:
            del os.environ["NOTIFY_SOCKET"]
        with g:
            told = []

            def says(word):
                """What the gateway has told its service manager last, as systemctl shows it."""
                try:
                    while True:
                        told.extend(x[7:] for x in manager.recv(4096).decode().split("\n") if x.startswith("STATUS="))
                except BlockingIOError:
                    pass
                host.status.write_text(told[-1] + "\n" if told else "")
                return told and told[-1].endswith(word)
            first = host.dpkg("-i", package(folder, "0.1.0", scripts))
            assert first.returncode == 0 and host.version() == "0.1.0 ii", (first, host.version())
            host.asked.write_text("")
            host.pid.write_text(str(g.process.pid))
            g.command("feeder", {"command": "enable"})
            g.command("feeder", {"command": "move_velocity", "velocity": 1, "acceleration": 20}, wait=0)
            until(lambda: says(" 1 moving"), 10, "the word that an axis moves")
            newer = package(folder, "0.2.0", scripts)
            refused = host.dpkg("-i", newer)
            assert refused.returncode != 0 and "axes are still moving" in refused.stderr, refused
            assert host.version() == "0.1.0 ii", "the package is as it was"
            assert host.asked.read_text() == "", "nothing was asked of the service manager"
            assert g.process.poll() is None and g.axis("feeder")["moving"], "the same process, and its axis moves on"
            # At rest it goes through, and the service is started anew: this copy's end is that.
            g.command("feeder", {"command": "quick_stop"})
            until(lambda: says(" 0 moving"), 10, "the word of rest")
            done = host.dpkg("-i", newer)
            assert done.returncode == 0 and host.version() == "0.2.0 ii", (done, host.version())
            assert "restart axisgate.service" in host.asked.read_text()
            until(lambda: g.process.poll() is not None, 10, "its end by the restart")
