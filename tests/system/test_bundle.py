"""`axisgate bundle`: what is in it, as the handbook lists it, and that nothing of it opens a door.

In: the real program, docs/handbook/metrics-and-support.md. Out: judgements on the archive. Looks for every secret that the test has given or been told.
"""
import io
import json
import pathlib
import re
import sqlite3
import stat
import tarfile

import harness
from harness import Gateway, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]
PASSWORD = "a long sentence of mine 42"


def members(path):
    with tarfile.open(path) as tar:
        for m in tar.getmembers():
            assert m.isfile() and m.mode == 0o600 and not m.uname and m.uid == 0, m.name
            assert m.name.startswith("axisgate-bundle/") and ".." not in m.name
        return {m.name.removeprefix("axisgate-bundle/"): tar.extractfile(m).read() for m in tar.getmembers()}


def listed():
    text = (TOP / "docs/handbook/metrics-and-support.md").read_text()
    return set(re.findall(r"^\| `([a-z]+\.[a-zA-Z]+)` \|", text.split("## Support bundle")[1], re.M)) | {"README.txt"}


def secrets_of(data):
    """Every text of the database that is a hash, a digest or a key, and what is in the files that only their owner may read."""
    found = set()
    for db in data.glob("axisgate.db"):
        for kind, text in sqlite3.connect(f"file:{db}?mode=ro", uri=True).execute("select kind, text from document where kind not in ('setting', 'recipe', 'stage')"):
            found |= set(re.findall(r"[A-Za-z0-9+/=_$-]{32,}", text))
    for path in data.rglob("*"):
        if path.is_file() and path.suffix in (".pem", ".key"):
            found |= set(re.findall(r"[A-Za-z0-9+/]{40,}", path.read_text(errors="replace")))
    return found


def test_the_bundle_of_a_running_gateway(folder):
    toml = folder / "axisgate.toml"
    log = folder / "axisgate.log"
    toml.write_text(f"[log]\nfile = \"{log}\"\n[modbus]\nwatchdog_ms = 1234\n")
    with Gateway(folder, harness.DEMO, "--config", str(toml)) as g:
        code = g.code
        assert code, "the first start shows a code"
        s, body, head = g.request("POST", "/api/v1/session/first", {"code": code, "user": "anna", "password": PASSWORD})
        assert s in (200, 201), (s, body)
        cookie = next(v for k, v in head.items() if k.lower() == "set-cookie").split(";")[0]
        session = cookie.split("=", 1)[1]
        s, token, _ = g.request("POST", "/api/v1/tokens", {"name": "script", "role": "operator"}, {"Cookie": cookie, "X-CSRF-Token": body["csrf"]})
        assert s in (200, 201), (s, token)
        g.send("PUT", "/axes/feeder/parameters/AC", {"value": 4321})
        with open(log, "a") as f:
            f.write(f"first sign-in: code {code}\nAuthorization: Bearer {token['token']}\npassword={PASSWORD.replace(' ', '_')}\n")
        out = folder / "bundle.tar"
        _, said, _ = run("bundle", str(out), "--config", str(toml), "--data", str(folder / "data"), "--set", "http.bind=" + ":".join(g.http), check=0)
        assert said.strip() == str(out)
        assert stat.S_IMODE(out.stat().st_mode) & 0o007 == 0, "not for everybody"
        files = members(out)
        assert set(files) == listed(), set(files) ^ listed()
        whole = b"\n".join(files.values())
        known = {code, PASSWORD, PASSWORD.replace(" ", "_"), session, token["token"]} | secrets_of(folder / "data")
        assert len(known) >= 7, "the test knows what to look for"
        for secret in known:
            assert secret.encode() not in whole, secret
        assert b"PRIVATE KEY" not in whole and b"$argon2" not in whole
        # And it helps.
        assert b"watchdog_ms = 1234" in files["axisgate.toml"] and b"http.bind" in files["axisgate.toml"]
        assert json.loads(files["site.json"])["axes"][0]["name"] == "feeder"
        assert json.loads(files["about.json"])["name"] == "axisgate" and json.loads(files["axes.json"])
        assert b"axisgate_build_info" in files["metrics.txt"] and b"integrity check found nothing" in files["database.txt"]
        assert re.search(rb"feeder,AC,4321,", files["parameters.csv"])
        events = [json.loads(line) for line in files["events.jsonl"].splitlines()]
        assert any(e["kind"] == "access" for e in events) and len({e["id"] for e in events}) == len(events)
        assert b"axisgate " in files["version.txt"] and b"(removed)" in files["axisgate.log"]
        for name in files:
            assert name.encode() in files["README.txt"] or name == "README.txt", name


def test_the_bundle_of_a_gateway_that_does_not_run_or_never_ran(folder):
    out = folder / "b.tar"
    run("bundle", str(out), "--data", str(folder / "none"), "--set", "http.bind=127.0.0.1:1", check=0)
    files = members(out)
    assert {"README.txt", "version.txt", "machine.txt", "axisgate.toml"} == set(files), set(files)
    text = files["README.txt"].decode()
    assert "database.txt" in text and "metrics.txt" in text and "refused" in text.lower(), text
    code, _, err = run("bundle", str(folder / "no" / "such" / "b.tar"), "--data", str(folder / "none"))
    assert code == 1 and "no/such" in err, (code, err)
    broken = folder / "broken.toml"
    broken.write_text("[http]\nbind = 7\npassword = \"abc\"\n")
    code, _, err = run("bundle", str(out), "--config", str(broken), "--data", str(folder / "none"))
    assert code == 0 and "broken.toml:2" in err, (code, err)
    assert b"bind = 7" in members(out)["axisgate.toml"] and b"abc" not in members(out)["axisgate.toml"], "a wrong configuration is what help is asked for"


def test_a_gateway_that_asks_for_a_sign_in_is_asked_nothing(folder):
    with Gateway(folder, harness.DEMO, "--set", "users.local_role=none") as g:
        out = folder / "b.tar"

        def made():  # the site of a first start is stored behind its being ready, its events behind that
            run("bundle", str(out), "--data", str(folder / "data"), "--set", "http.bind=" + ":".join(g.http), check=0)
            files = members(out)
            return "site.json" in files and files.get("events.jsonl")
        until(made, 20, "the site and its first events are stored")
        files = members(out)
    assert "axes.json" not in files and "asks for a sign-in" in files["README.txt"].decode()
    assert "site.json" in files and io.BytesIO(files["events.jsonl"]).readline()
