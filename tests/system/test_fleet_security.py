"""DDS Security: `axisgate pki` makes an authority and members; who has a certificate is seen, who has none sees and commands nothing.

In: the program, `openssl` as an independent reader. Out: folders of certificates, fleets. Never another network than this machine's own.
"""
import random
import subprocess
import time

from harness import DEMO, Folder, Gateway, run, until


def pki(folder, *names, more=(), check=0):
    return run("pki", str(folder / "pki"), *names, *more, check=check)


def member(folder, domain, name, *more):
    return Gateway(folder, DEMO, "--set", "dds.enabled=true", "--set", f"dds.domain={domain}", "--set", f"dds.name={name}", *more)


def fleet(gateway):
    return {x["gateway"]: x for x in gateway.get("/fleet")["gateways"]}


def test_the_certificate_tool_makes_what_openssl_understands(folder):
    _, said, _ = pki(folder, "hall-1", "hall-2", check=0)
    assert said.split() == [str(folder / "pki" / "hall-1"), str(folder / "pki" / "hall-2")], said
    ca = folder / "pki" / "ca-cert.pem"
    for name in ("hall-1", "hall-2"):
        d = folder / "pki" / name
        said = subprocess.run(["openssl", "verify", "-CAfile", str(ca), str(d / "cert.pem")], capture_output=True, text=True)
        assert said.returncode == 0, said.stderr
        assert (d / "key.pem").stat().st_mode & 0o77 == 0 and d.stat().st_mode & 0o77 == 0, "a key is its owner's alone"
        for document in ("governance.p7s", "permissions.p7s"):
            said = subprocess.run(["openssl", "smime", "-verify", "-text", "-CAfile", str(ca), "-in", str(d / document)], capture_output=True, text=True)
            assert said.returncode == 0 and "<dds" in said.stdout, said.stderr
        assert f"<subject_name>CN={name}</subject_name>" in said.stdout
    assert (folder / "pki" / "ca-key.pem").stat().st_mode & 0o77 == 0
    code, _, err = pki(folder, "hall-2", check=None)
    assert code == 1 and "is there already" in err, (code, err)
    pki(folder, "panel", more=("--role", "viewer"))
    said = subprocess.run(["openssl", "smime", "-verify", "-text", "-CAfile", str(ca), "-in", str(folder / "pki" / "panel" / "permissions.p7s")], capture_output=True, text=True).stdout
    assert "<publish>" not in said and "axisgate_AxisState" in said, said
    code, _, err = pki(folder, "../x", check=None)
    assert code == 1 and "letters, digits" in err, (code, err)
    code, _, err = run("pki", "/proc/nowhere", "a")
    assert code == 1 and err, (code, err)


def test_members_see_and_command_each_other_and_a_stranger_nothing(folder):
    domain = random.randint(100, 160)
    pki(folder, "hall-1", "hall-2")
    of = lambda name: ("--set", f"dds.security={folder / 'pki' / name}")
    # An authority of their own does not make them members either.
    with Folder() as f2, Folder() as f3, Folder() as f4, Folder() as elsewhere:
        pki(elsewhere, "hall-4")
        with member(folder, domain, "hall-1", *of("hall-1")) as a, member(f2, domain, "hall-2", *of("hall-2")) as b, member(f3, domain, "hall-3") as stranger, \
                member(f4, domain, "hall-4", "--set", f"dds.security={elsewhere / 'pki' / 'hall-4'}") as foreign:
            for g in (a, b):
                until(lambda: len(fleet(g)) == 2 and all(len(x["axes"]) == 2 for x in fleet(g).values()), 30, "members see each other")
            path = "/fleet/hall-2/axes/feeder/commands"
            assert a.send("POST", path + "?wait=10", {"command": "enable"})["result"] == "done"
            assert a.send("POST", path + "?wait=20", {"command": "move_absolute", "position": 3, "velocity": 30})["result"] == "done"
            assert b.axis("feeder")["position"] == 3
            time.sleep(2)
            assert set(fleet(a)) == set(fleet(b)) == {"hall-1", "hall-2"}
            assert set(fleet(stranger)) == {"hall-3"}, "who has no certificate sees nobody"
            assert set(fleet(foreign)) == {"hall-4"}, "nor does who has one of another authority"
            for g in (stranger, foreign):
                status, answer, _ = g.request("POST", "/api/v1" + path, {"command": "enable"})
                assert status == 404, (status, answer)


def test_what_is_wrong_with_certificates_is_said_at_the_start(folder):
    pki(folder, "hall-1")
    at = folder / "pki" / "hall-1"
    for spoil, words in ((lambda: (at / "permissions.p7s").write_text((at / "permissions.p7s").read_text().replace("CN=hall-1", "CN=hall-9")), "cannot be joined with the certificates"),
                         (lambda: (at / "key.pem").unlink(), "key.pem")):
        spoil()
        try:
            with member(folder, 99, "hall-1", "--set", f"dds.security={at}"):
                raise SystemError("it started")
        except AssertionError as e:
            assert words in str(e), e
