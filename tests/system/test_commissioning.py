"""deploy/examples/commissioning.sh as it stands: an empty gateway, curl and jq, and in the end an axis that has moved.

In: the real program without a site. Out: judgements on what the script says, leaves behind, and refuses.
"""
import os
import pathlib
import shutil
import subprocess

import harness

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "deploy/examples/commissioning.sh"


def run(g):
    return subprocess.run([str(SCRIPT), f"http://{g.http[0]}:{g.http[1]}"], capture_output=True, text=True, timeout=120, env={k: v for k, v in os.environ.items() if k != "AXISGATE_MODBUS"})


def test_from_an_empty_site_to_a_mapped_moving_axis(folder):
    assert shutil.which("jq") and shutil.which("curl"), "deploy/packages/test.txt names them"
    with harness.Gateway(folder, None) as g:
        p = run(g)
        assert p.returncode == 0, p.stdout + p.stderr
        assert "done\tcheck\t/steps/4" in p.stdout and "Switched off" in p.stdout, p.stdout
        assert abs(g.axis()["position"] - 40) < 0.1 and g.axis()["state"] != "operation_enabled"
        assert {m["point"] for m in g.get("/mappings")} == {"position_units", "AC"}
        assert g.get("/recipes/first-motion/runs/1")["state"] == "done"
        if shutil.which("mbpoll"):
            assert any(line.startswith("[0]") and abs(float(line.split()[1]) - 40) < 0.1 for line in p.stdout.splitlines()), p.stdout
        p = run(g)
        assert p.returncode == 1 and "not empty" in p.stderr, "it touches no site that is in use"
