"""The package's scripts and its unit, without a package: what dpkg calls on its way back from a refused upgrade touches nothing, and systemd never gives up."""
import pathlib
import subprocess

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
