"""Backup of a whole gateway as one file: what it holds, that a fresh host becomes the same gateway within a minute, and what is wrong with a file.

In: the program. Out: judgements on files, on answers of the restored gateway beside those of the first one, on what is left after a refusal.
"""
import hashlib
import io
import json
import pathlib
import re
import shutil
import sqlite3
import stat
import subprocess
import tarfile
import time

import harness
from harness import DEMO, EXAMPLES, Gateway, run
from openapi import Description
from test_tls import OWN, SecureGateway

TOP = pathlib.Path(__file__).resolve().parents[2]
API = Description((TOP / "schema/openapi.yaml").read_text())
SECRET = "four words nobody guesses"
# Of what two gateways answer, what cannot be the same: when, on which port, and what the line's load is just now.
OF_THE_MOMENT = re.compile(r"^(now|at|age_ms|uptime_s|last_sign_in_at|load|bind|doors|queued|counters|frames_.*|bytes_.*)$")
NOT_COMPARED = {"/metrics", "/api/v1/stream", "/api/v1/events", "/api/v1/backup", "/api/v1/lines/{line}/trace", "/api/v1/recorder/trends", "/api/v1/recorder/steps", "/api/v1/recorder/recordings",
                "/api/v1/recorder/recordings/{recording}", "/api/v1/session", "/api/v1/eds", "/api/v1/fleet", "/readyz"}


def sign_in(g, path, **body):
    status, session, headers = g.request("POST", "/api/v1" + path, body)
    assert status == 200, session
    return {"Cookie": headers["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"]}


def furnish(g):
    """A gateway with something of everything in it."""
    admin = sign_in(g, "/session/first", code=g.code, user="anna", password="correct-horse-9")

    def ask(method, path, body, status):
        s, answer, _ = g.request(method, "/api/v1" + path, body, admin)
        assert s == status, (path, s, answer)
    ask("POST", "/users", {"name": "ben", "password": "another-horse-7", "role": "operator"}, 201)
    ask("POST", "/tokens", {"name": "nightly", "role": "administrator"}, 201)
    ask("PUT", "/recipes/warm-up", {"steps": [{"wait_s": 0.1}]}, 201)
    ask("POST", "/axes/feeder/snapshots", {"name": "good", "from": "stored"}, 201)
    ask("PUT", "/axes/feeder/parameters/AC", {"value": 23456}, 200)
    ask("POST", "/mappings", {"id": "mine", "unit": 3, "table": "holding_registers", "address": 7, "axis": "feeder", "point": "position", "type": "i32"}, 201)
    return admin


def bare(value):
    if isinstance(value, dict):
        return {k: bare(v) for k, v in value.items() if not OF_THE_MOMENT.search(k)}
    return [bare(v) for v in value] if isinstance(value, list) else value


def all_gets(g, admin):
    names = {"family": [f["name"] for f in g.get("/families")], "line": [x["name"] for x in g.get("/lines")], "drive": [x["name"] for x in g.get("/drives")],
             "axis": [x["name"] for x in g.get("/axes")], "user": ["anna", "ben"], "recipe": ["warm-up"], "mapping": ["mine"], "snapshot": ["1"], "revision": ["1", "2"],
             "parameter": ["AC"], "unit": ["1"], "description": [d["name"] for d in g.get("/descriptions")], "run": ["1"]}
    answers = {}
    for path, item in API.document["paths"].items():
        if "get" not in item or path in NOT_COMPARED:
            continue
        targets = [path]
        for name in re.findall(r"\{(\w+)\}", path):
            targets = [t.replace("{" + name + "}", value) for t in targets for value in names.get(name, [])]
        for t in targets:
            status, body, _ = g.request("GET", t, None, admin)
            answers[t] = status, bare(body)
    return answers


def refused(g, data, head):
    status, answer, _ = g.request("PUT", "/api/v1/backup", data, {**head, "Content-Type": "application/octet-stream"})
    assert status == 422, (status, answer)
    assert "restore-" not in str(answer) and "/data" not in str(answer), answer
    return answer["faults"][0]["text"] if "faults" in answer else str(answer)


def test_a_spare_box_becomes_the_same_gateway_within_a_minute(folder):
    """With nothing but the file, the passphrase and the program: configuration, certificates and database."""
    site = json.loads((EXAMPLES / "demo-site.json").read_text())
    (folder / "etc").mkdir()
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj", "/CN=localhost", "-addext",
                    "subjectAltName=DNS:localhost,IP:127.0.0.1", "-days", "30", "-keyout", folder / "etc/key.pem", "-out", folder / "etc/cert.pem"], check=True, capture_output=True)
    toml = folder / "etc/axisgate.toml"
    data = folder / "etc/data"
    text = f"""[data]
dir = "{data}"
[http]
tls_cert = "{folder}/etc/cert.pem"
tls_key = "{folder}/etc/key.pem"
[authority]
lease_s = 41
[modbus]
bind = "127.0.0.1:0"
[enip]
bind = "off"
"""
    toml.write_text(text)
    (folder / "passphrase").write_text(SECRET + "\n")
    plain = ["--set", "http.tls_cert=", "--set", "http.tls_key="]  # so that the answers can be compared without TLS

    def start(site=None):
        more = ["--config", str(toml), *plain]
        g = Gateway.__new__(Gateway)
        if site is not None:
            (folder / "site.json").write_text(json.dumps(site))
            for d in {d["description"] for d in site.get("drives", ()) if "description" in d}:
                shutil.copy(EXAMPLES / d, folder)
            more += ["--site", str(folder / "site.json")]
        harness.Process.__init__(g, "serve", *more, "--set", "http.bind=127.0.0.1:0")
        g.http = g.word("http").rsplit(":", 1)
        return g
    with start(site) as g:
        admin = furnish(g)
        sealed = folder / "box.sealed"
        _, said, _ = run("backup", str(sealed), "--config", str(toml), "--passphrase-file", str(folder / "passphrase"), check=0)
        assert str(sealed) in said and "recordings" in said, said
        assert stat.S_IMODE(sealed.stat().st_mode) == 0o600
        for word in (SECRET.encode(), b"PRIVATE KEY", b"SQLite", b"feeder", b"anna"):
            assert word not in sealed.read_bytes(), word
        assert g.stop() == 0
    with start() as g:
        admin = sign_in(g, "/session", user="anna", password="correct-horse-9")
        first = all_gets(g, admin)
        assert g.stop() == 0
    shutil.move(folder / "etc", folder / "broken")  # the box is gone
    begun = time.monotonic()
    (folder / "etc").mkdir()
    toml.write_text(f'# as the package brings it\n[data]\ndir = "{data}"\n')
    args = ("restore", str(sealed), "--config", str(toml), "--with-config")
    code, said, err = run(*args)
    assert code == 1 and "sealed" in err and "--passphrase-file" in err and toml.read_text().startswith("# as"), (said, err)
    code, said, err = run(*args, "--passphrase-file", "-", stdin="four words somebody guesses\n")
    assert code == 1 and "passphrase is wrong" in err and "nothing was replaced" in err, err
    assert sorted(p.name for p in (folder / "etc").iterdir()) == ["axisgate.toml", "data"] and not list(data.iterdir()), "no partial restore"
    _, said, _ = run(*args, "--passphrase-file", str(folder / "passphrase"), check=0)
    assert SECRET not in said
    with start() as g:
        admin = sign_in(g, "/session", user="anna", password="correct-horse-9")
        took = time.monotonic() - begun
        second = all_gets(g, admin)
        assert g.stop() == 0
    assert took < 60, f"{took:.0f} s until somebody could sign in"
    print(f"{took:.1f} s from the file to a gateway that lets its users in; {len(first)} answers compared")
    assert toml.read_text() == text and (folder / "etc/axisgate.toml.replaced-1").read_text().startswith("# as")
    for name in ("cert.pem", "key.pem"):
        assert (folder / "etc" / name).read_bytes() == (folder / "broken" / name).read_bytes(), name
    assert stat.S_IMODE((folder / "etc/key.pem").stat().st_mode) == 0o600
    assert first.keys() == second.keys() and len(first) > 150, len(first)
    assert sum(status == 200 for status, _ in first.values()) > 120, {t: s for t, (s, _) in first.items() if s != 200}
    different = {t: (first[t], second[t]) for t in first if first[t] != second[t]}
    assert not different, json.dumps(different, indent=1, default=str)[:3000]


def test_a_backup_is_a_tar_that_others_unpack_and_check(folder):
    with SecureGateway(folder, *OWN) as g:
        copy = folder / "copy.tar"
        _, said, _ = run("backup", str(copy), "--data", str(folder / "data"), check=0)
        assert g.stop() == 0
    out = folder / "out"
    out.mkdir()
    subprocess.run(["tar", "-xf", copy], cwd=out, check=True)
    assert {p.name for p in out.iterdir()} == {"backup.json", "backup.sha256", "axisgate.db", "http-cert.pem", "http-key.pem"}
    subprocess.run(["sha256sum", "--check", "--strict", "--quiet", "backup.sha256"], cwd=out, check=True)
    contents = json.loads((out / "backup.json").read_text())
    assert contents["form"] == 1 and contents["members"][0] == {"name": "axisgate.db", "bytes": (out / "axisgate.db").stat().st_size}, contents
    assert [x["what"] for x in contents["left_out"]] == ["recordings", "axisgate.toml"], contents
    assert sqlite3.connect(out / "axisgate.db").execute("pragma integrity_check").fetchone()[0] == "ok"
    # The certificate of the gateway's own making goes along: browsers that trust it need not be asked again.
    spare = folder / "spare"
    run("restore", str(copy), "--data", str(spare), check=0)
    assert (spare / "http-key.pem").read_bytes() == (folder / "data/http-key.pem").read_bytes()
    assert stat.S_IMODE((spare / "http-key.pem").stat().st_mode) == 0o600
    assert sorted(p.name for p in spare.iterdir()) == ["axisgate.db", "axisgate.lock", "http-cert.pem", "http-key.pem", "restored.json"], "the next start tells of it"
    # A plain database, as older programs made it, is taken as well.
    run("restore", str(out / "axisgate.db"), "--data", str(folder / "older"), check=0)


def forged(copy, change):
    """The archive anew with checksums that are right: what a newer program or somebody with a purpose would send."""
    members = {}
    with tarfile.open(copy) as t:
        for m in t:
            members[m.name] = t.extractfile(m).read()
    members.pop("backup.sha256")
    change(members)
    members["backup.sha256"] = "".join(f"{hashlib.sha256(b).hexdigest()}  {n}\n" for n, b in members.items()).encode()
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w", format=tarfile.USTAR_FORMAT, copybufsize=512) as t:
        for n, b in members.items():
            info = tarfile.TarInfo(n)
            info.size, info.mode = len(b), 0o600
            t.addfile(info, io.BytesIO(b))
    data = out.getvalue()
    size = sum(512 + (len(b) + 511) // 512 * 512 for b in members.values()) + 1024
    return data[:size]


def test_what_is_wrong_with_a_file_is_named_and_nothing_is_replaced(folder):
    copy, data = folder / "copy.tar", folder / "data"
    with Gateway(folder, DEMO) as g:
        admin = sign_in(g, "/session/first", code=g.code, user="anna", password="correct-horse-9")
        good = g.request("GET", "/api/v1/backup", None, admin)[2]
        status, good, headers = g.request("GET", "/api/v1/backup", None, admin)
        assert status == 200 and headers["Content-Disposition"].endswith('"axisgate-backup.tar"')
        copy.write_bytes(good)
        seal = {**admin, "X-Backup-Passphrase": "f%C3%B6ur%20words%20nobody%20guesses"}
        status, sealed, headers = g.request("GET", "/api/v1/backup", None, seal, seconds=130)
        assert status == 200, sealed
        assert sealed.startswith(b"AXISGATE-SEALED\n") and headers["Content-Disposition"].endswith('"axisgate-backup.sealed"')
        assert g.request("GET", "/api/v1/backup", None, {**admin, "X-Backup-Passphrase": "short"})[0] == 422
        assert g.request("GET", "/api/v1/backup", None, {**admin, "X-Backup-Passphrase": "%zz"})[0] == 422
        flipped = bytearray(good)
        flipped[len(good) // 2] ^= 1
        broken = bytearray(sealed)
        broken[len(sealed) // 2] ^= 1

        def newer_database(members):
            file = folder / "newer.db"
            file.write_bytes(members["axisgate.db"])
            c = sqlite3.connect(file)
            c.execute("pragma user_version=99")
            c.commit()
            c.close()
            members["axisgate.db"] = file.read_bytes()
            listed = json.loads(members["backup.json"])
            listed["members"][0]["bytes"] = len(members["axisgate.db"])
            members["backup.json"] = json.dumps(listed).encode()

        def newer_form(members):
            members["backup.json"] = members["backup.json"].replace(b'"form":1', b'"form":2')
        cases = {"axisgate.db in it is not what its checksum says": bytes(flipped), "cut short": good[:len(good) * 2 // 3], "sealed, and no passphrase": sealed,
                 "newer axisgate": forged(copy, newer_form), "written by a newer": forged(copy, newer_database), "no backup": b"PK\3\4" + b"x" * 5000}
        assert forged(copy, lambda m: None)[:100] == good[:100], "the forger knows the form"
        for words, file in cases.items():
            assert words in refused(g, file, admin), words
        assert "passphrase is wrong" in refused(g, sealed, {**admin, "X-Backup-Passphrase": "four%20words%20nobody%20guesses"})
        assert "altered" in refused(g, bytes(broken), seal)
        assert "cut short" in refused(g, sealed[:-1], seal) or "altered" in refused(g, sealed[:-1], seal)
        assert g.request("GET", "/api/v1/backup/pending", None, admin)[1]["waiting"] is False
        assert not [p.name for p in data.iterdir() if p.name.startswith(("restore", "backup"))]
        g.send("PATCH", "/axes/feeder", {"unit": "m"})
        status, answer, _ = g.request("PUT", "/api/v1/backup", sealed, {**seal, "Content-Type": "application/octet-stream"})
        assert status == 202 and answer["restart_needed"], answer
        assert SECRET.split()[0] not in g.errors() and "nobody" not in g.errors() + json.dumps(g.get("/events?limit=500")), "the passphrase stands in no log"
        assert any("sealed with a passphrase" in e["text"] for e in g.get("/events?limit=500"))
        assert g.stop() == 0
    with Gateway(folder, None) as g:
        assert g.axis()["unit"] == "mm", "taken, without its passphrase being asked again"
        assert g.stop() == 0
    before = {p.name: p.read_bytes() for p in data.iterdir()}
    for words, file in cases.items():
        copy.write_bytes(file)
        code, out, err = run("restore", str(copy), "--data", str(data))
        assert code == 1 and ("nothing was replaced" in err) and str(copy) in err, (words, out, err)
        assert {p.name: p.read_bytes() for p in data.iterdir() if p.name != "axisgate.lock"} == {k: v for k, v in before.items() if k != "axisgate.lock"}, words
    code, _, err = run("restore", str(folder / "nothing"), "--data", str(data))
    assert code == 1 and "nothing" in err
    code, _, err = run("backup", str(folder / "b"), "--data", str(data), "--passphrase-file", "-", stdin="short\n")
    assert code == 1 and "12 to 256" in err and not (folder / "b").exists(), err


def test_a_host_that_cannot_take_a_file_takes_nothing(folder):
    """The key's folder cannot be written: then the database is not replaced either."""
    (folder / "etc").mkdir()
    for name in ("cert.pem", "key.pem"):
        (folder / "etc" / name).write_text(f"-----BEGIN {name}-----\n-----END {name}-----\n")
    toml = folder / "axisgate.toml"
    toml.write_text(f'[http]\ntls_cert = "{folder}/etc/cert.pem"\ntls_key = "{folder}/etc/key.pem"\n')
    with Gateway(folder) as g:
        assert g.stop() == 0
    copy, data = folder / "copy.tar", folder / "data"
    run("backup", str(copy), "--data", str(data), "--config", str(toml), check=0)
    shutil.rmtree(folder / "etc")
    (folder / "etc").write_text("a file where the folder was")
    before = {p.name: p.read_bytes() for p in data.iterdir()}
    code, _, err = run("restore", str(copy), "--data", str(data), "--config", str(toml))
    assert code == 1 and "nothing was replaced" in err and "etc" in err, err
    assert {p.name: p.read_bytes() for p in data.iterdir()} == before
    # A host whose configuration names none is told which it did not take.
    _, out, _ = run("restore", str(copy), "--data", str(data), check=0)
    assert "not taken: tls-key.pem" in out and "not taken: axisgate.toml: --with-config" in out, out
    # A file that the configuration names and that is not there: no backup that would lack it.
    code, _, err = run("backup", str(folder / "b"), "--data", str(data), "--config", str(toml))
    assert code == 1 and "cert.pem" in err and not (folder / "b").exists(), err


def test_a_backup_alone_never_decides_where_root_writes(folder):
    """The configuration in a backup names a place elsewhere, or a certificate that is none: shown and refused; confirmed, it is taken."""
    etc, elsewhere, data = folder / "etc", folder / "elsewhere", folder / "etc/data"
    etc.mkdir(), elsewhere.mkdir()
    (etc / "keys").symlink_to(elsewhere)  # a name below the folder that leads out of it
    toml, copy, key, cert = etc / "axisgate.toml", folder / "copy.tar", elsewhere / "authorized_keys", etc / "keys/cert.pem"
    for file in (key, cert):
        file.write_text("-----BEGIN IT-----\n-----END IT-----\n")
    toml.write_text(f'[data]\ndir = "{data}"\n[http]\ntls_cert = "{cert}"\ntls_key = "{key}"\n')
    with Gateway(folder, None) as g:
        assert g.stop() == 0
    shutil.copytree(folder / "data", data)
    run("backup", str(copy), "--config", str(toml), check=0)
    toml.write_text(f'[data]\ndir = "{data}"\n')
    key.write_text("ssh-ed25519 of somebody")
    args = ("restore", str(copy), "--config", str(toml), "--with-config")
    code, out, err = run(*args)
    assert code == 1 and "nothing was replaced" in err and "--confirm-places" in err, (out, err)
    assert f"tls-key.pem -> {key}" in out and f"tls-cert.pem -> {cert}" in out, out
    assert key.read_text() == "ssh-ed25519 of somebody" and "tls_key" not in toml.read_text()
    code, out, err = run(*args, "--confirm-places")
    assert code == 0 and key.read_text().startswith("-----BEGIN IT"), (out, err)
    assert "whose token was taken back" in out, out
    key.write_text("ssh-ed25519 of somebody")
    run("backup", str(copy), "--config", str(toml), check=0)
    code, out, err = run(*args, "--confirm-places")
    assert code == 1 and "it is no PEM" in err and "nothing was replaced" in err, (out, err)


def test_the_start_after_a_restore_tells_who_and_which_revisions(folder):
    with Gateway(folder) as g:
        g.send("PATCH", "/axes/feeder", {"unit": "m"})
        assert g.stop() == 0
    copy, data = folder / "copy.db", folder / "data"
    run("backup", str(copy), "--data", str(data), check=0)
    with Gateway(folder, None) as g:
        g.send("PATCH", "/axes/feeder", {"unit": "cm"})
        assert g.stop() == 0
    run("restore", str(copy), "--data", str(data), check=0)
    with Gateway(folder, None) as g:
        told = [e for e in g.get("/events?limit=500") if e["kind"] == "restore"]
        assert len(told) == 1 and told[0]["who"].startswith("axisgate restore ") and told[0]["severity"] == "warning", told
        assert int(told[0]["old"]) == int(told[0]["new"]) + 1 and "whose token was taken back" in told[0]["text"], told
        assert g.stop() == 0
    with Gateway(folder, None) as g:
        assert len([e for e in g.get("/events?limit=500") if e["kind"] == "restore"]) == 1, "told once"
        assert g.stop() == 0
