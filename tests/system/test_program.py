"""The program's own commands, the store's promises, and configuration faults."""
import csv
import io
import json
import os
import re
import signal
import socket
import sqlite3
import time

import harness
from harness import Gateway, Process, run, until


def test_version_help_and_wrong_usage():
    assert run("version", check=0)[1].startswith("axisgate ")
    text = run("help", check=0)[1]
    for word in ("serve", "twin", "families", "catalogue", "specimen", "rehearse", "decode", "compare", "check", "backup", "restore", "health", "bundle", "pki", "version"):
        assert word in text
    for arguments in ((), ("nonsense",), ("serve", "--nonsense"), ("catalogue",), ("catalogue", "nobody"), ("decode", "nobody"), ("compare", "uim342"),
                      ("compare", "uim342", "/nowhere"), ("twin", "uim342"),
                      ("twin", "uim342", "--line", "twin"), ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--address", "4"),
                      ("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0", "--option", "produkt=LMM"),
                      ("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0", "--option", "product=LMX"),
                      ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--option", "boot_ms=-1")):
        code, out, err = run(*arguments)
        assert code == 2, (arguments, code, err)
        assert err.strip() and not out.strip(), (arguments, out, err)


def test_families_and_catalogue():
    names = [f["name"] for f in json.loads(run("families", "--format", "json", check=0)[1])]
    assert "uim342" in names
    assert "uim342" in run("families", check=0)[1]
    parameters = json.loads(run("catalogue", "uim342", "parameters", "--format", "json", check=0)[1])
    wanted = {"id", "name", "group", "type", "unit", "min", "max", "default", "access", "storage", "description"}
    assert len(parameters) >= 93
    for p in parameters:
        assert set(p) == wanted | {"addressing", "live", "allowed", "fields", "meanings", "alternate", "choice", "first", "count", "selector"}, p
        assert p["access"] in ("R", "W", "RW")
    rows = list(csv.reader(io.StringIO(run("catalogue", "uim342", "parameters", "--format", "csv", check=0)[1])))
    assert rows[0][0] == "id" and len(rows) == len(parameters) + 1
    assert any(r[0] == "PP[7]" for r in rows)
    bit_rate = next(r for r in rows if r[0] == "PP[5]")
    assert bit_rate[rows[0].index("allowed")].startswith("0 = 1000 kbit/s, 1 = 800 kbit/s"), bit_rate
    loop = next(p for p in parameters if p["id"] == "IC[6]")
    assert loop["allowed"] == [{"value": 0, "meaning": "open loop"}, {"value": 1, "meaning": "closed loop"}] and loop["choice"] == ["storage"]
    errors = json.loads(run("catalogue", "uim342", "errors", "--format", "json", check=0)[1])
    assert {e["code"] for e in errors} >= {50, 51, 52, 60, 61, 62, 63, 65}
    assert json.loads(run("catalogue", "uim342", "commands", "--format", "json", check=0)[1])


def test_every_error_of_every_family_says_what_to_do():
    names = [f["name"] for f in json.loads(run("families", "--format", "json", check=0)[1])]
    assert len(names) >= 6
    for name in names:
        errors = json.loads(run("catalogue", name, "errors", "--format", "json", check=0)[1])
        assert errors, name
        silent = [e["code"] for e in errors if len((e["remedy"] or "").split()) < 2]
        assert not silent, f"{name}: no remedy for {silent}"


def test_decode_reads_three_forms_and_says_what_it_cannot(folder):
    text = run("decode", "uim342", stdin="(1.5) can0 04280095#01\n(1.6) can0 05200015#01\n(1.7) can0 0428FFFF#\n", check=0)[1].splitlines()
    assert len(text) == 3 and "MO" in text[0] and "MO" in text[1] and "unknown" in text[2].lower(), text
    text = run("decode", "uim342", "--format", "hex", stdin="> AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 95 CC\n", check=0)[1]
    assert "MO" in text
    bad = run("decode", "uim342", "--format", "hex", stdin="> AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 96 CC\n")[1]
    assert "CRC" in bad or "check" in bad.lower(), bad
    assert run("decode", "uim342", stdin="this is no frame\n")[0] == 1
    with Gateway(folder) as g:
        trace = g.request("GET", "/api/v1/lines/can0/trace?limit=50")[1]
        assert run("decode", "uim342", "--format", "trace", stdin=json.dumps(trace), check=0)[1].count("\n") > 5
        log = g.request("GET", "/api/v1/lines/can0/trace?format=candump&limit=50")[1].decode()
        assert run("decode", "uim342", stdin=log, check=0)[1].count("\n") > 5
        assert g.request("GET", "/api/v1/lines/can0/trace?format=pcapng")[1][:4] == b"\x0a\x0d\x0d\x0a"


def test_check_names_every_fault_with_file_line_and_remedy(folder):
    toml = folder / "axisgate.toml"
    toml.write_text("[http]\nbind = \"nowhere\"\n[modbus]\nword_order = \"middle\"\nspeed = 3\n[nonsense]\nx = 1\n")
    site = folder / "site.json"
    site.write_text('{\n "lines": [\n  {"name": "can0", "uri": "can:can0", "family": "uim342"}],\n "drives": [\n  {"name": "a", "line": "can0", "address": 4},\n'
                    '  {"name": "b", "line": "nowhere", "address": 6}],\n "axes": [\n  {"name": "x", "drive": "a", "number": 0}]\n}\n')
    code, out, err = run("check", "--config", str(toml), "--site", str(site))
    assert code == 2
    for part in ("axisgate.toml:2", "axisgate.toml:4", "axisgate.toml:5", "axisgate.toml:6", "site.json:5", "site.json:6", "site.json:8"):
        assert part in err, f"{part} is missing in:\n{err}"
    assert all(";" in line for line in err.splitlines()), "each with a way to mend it"
    code, _, again = run("serve", "--config", str(toml), "--data", str(folder / "d"))
    assert code == 2 and "axisgate.toml:2" in again
    site.write_text('{"lines": [,]}')
    code, _, err = run("check", "--site", str(site))
    assert code == 2 and "site.json:1" in err
    site.write_text(json.dumps(harness.DEMO))
    assert run("check", "--site", str(site), check=0)
    odd = json.loads(json.dumps(harness.DEMO))
    odd["drives"][0]["options"] = {"modell": "342S"}
    site.write_text(json.dumps(odd))
    _, _, err = run("check", "--site", str(site), check=0)
    assert "warning" in err and "modell" in err and "home_input" in err, err  # usable; but somebody meant something else


def test_check_finds_what_serve_would_refuse_or_lose(folder):
    toml = folder / "axisgate.toml"
    for text, wanted in (("[modbus_rtu]\nport = \"can:can0\"\n", ["axisgate.toml:2", "carries bytes"]),
                         ("[modbus_rtu]\nformat = \"7E1\"\nunit = 248\nbaud = 1\n",
                          ["axisgate.toml:2", "8 data bits", "axisgate.toml:3", "247", "axisgate.toml:4"]),
                          ("[dds]\nenabled = true\npartition = \"*\"\nname = \"\"\n", ["axisgate.toml:3", "axisgate.toml:4", "63 letters"]),
                         ("[log]\nfile = \"/proc/none/x.log\"\n", ["log.file", "cannot open the log file"]), (f"[log]\nfile = \"{folder}\"\n", ["folder"]),
                         ("[data]\ndir = 7\n[log]\nfile = 3\n[modbus_rtu]\nport = 5\n", ["axisgate.toml:2", "axisgate.toml:4", "axisgate.toml:6"])):
        toml.write_text(text)
        code, out, err = run("check", "--config", str(toml))
        assert code == 2 and not out and all(w in err for w in wanted), (text, code, out, err)
        assert all(";" in line for line in err.splitlines()), err
        code, _, again = run("serve", "--config", str(toml), *([] if "dir = 7" in text else ["--data", str(folder / "d")]))
        assert code == 2 and again == err, (text, again, err)
    toml.write_text(f"[runtime]\nhot_cpu = 999\n[log]\nfile = \"{folder / 'new.log'}\"\n")
    code, out, err = run("check", "--config", str(toml))
    assert code == 0 and "no faults found" in out and "warning: runtime.hot_cpu" in err, (code, out, err)
    assert not (folder / "new.log").exists(), "a check leaves nothing behind"
    code, out, err = run("check", "--config", str(folder / "none.toml"))
    assert code == 2 and not out and "none.toml" in err, (code, out, err)
    code, out, err = run("bogus")
    assert code == 2 and "bogus" in err and "serve" in err and not out, (code, out, err)


def test_environment_and_set_override(folder):
    code, _, err = run("check", "--set", "http.bind=nowhere")
    assert code == 2 and "--set http.bind" in err
    code, _, err = run("check", env={"AXISGATE_MODBUS_WORD_ORDER": "sideways"})
    assert code == 2 and "AXISGATE_MODBUS_WORD_ORDER" in err
    with Gateway(folder, harness.DEMO, "--set", "modbus.word_order=low_first") as g, g.modbus() as m:
        block = m.read(0, 20)
        high_first = g.get("/about")
        assert high_first
        age = block[13] << 16 | block[12]
        assert age < 5000


def test_twin_answers_uimessage_frames_over_tcp(folder):
    state = folder / "memory.json"
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--state", str(state)) as t:
        port = int(re.search(r"127\.0\.0\.1:(\d+)", t.ready).group(1))
        with socket.create_connection(("127.0.0.1", port), timeout=5) as s:
            def ask(text):
                s.sendall(bytes.fromhex(text))
                data = b""
                while len(data) < 16:
                    data += s.recv(16 - len(data))
                return data.hex(" ").upper()
            assert ask("AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 95 CC") == "AA 05 15 01 01 00 00 00 00 00 00 00 00 71 57 CC"
            assert ask("00 FF AA 05 A1 00 00 00 00 00 00 00 00 00 00 6E F0 CC") == "AA 05 21 00 00 00 00 00 00 00 00 00 00 C7 32 CC"
        # MO=0, then AC=5000 goes to EEPROM and into the file
        with socket.create_connection(("127.0.0.1", port), timeout=5) as s:
            s.sendall(bytes.fromhex("AD 05 95 01 00 00 00 00 00 00 00 00 00 00 00 CC" "AD 05 99 04 88 13 00 00 00 00 00 00 00 00 00 CC"))
            until(lambda: state.exists() and "5000" in state.read_text(), 5, "the memory file")


def test_twin_hand_over_http_and_time_scale():
    import http.client
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--hand", "127.0.0.1:0", "--time-scale", "20") as t:
        host, port = t.word("hand").rsplit(":", 1)
        c = http.client.HTTPConnection(host, int(port), timeout=5)
        c.request("GET", "/hand")
        r = c.getresponse()
        assert r.status == 200 and "stall" in r.read().decode()
        c.request("PATCH", "/hand", body=json.dumps({"inputs": 3}), headers={"Content-Type": "application/json"})
        r = c.getresponse()
        assert r.status == 200, r.read()
        r.read()
        c.request("PATCH", "/hand", body=json.dumps({"nonsense": 3}), headers={"Content-Type": "application/json"})
        r = c.getresponse()
        assert 400 <= r.status < 500 and "nonsense" in r.read().decode()
        line = int(re.search(r"127\.0\.0\.1:(\d+)", t.ready).group(1))
        with socket.create_connection(("127.0.0.1", line), timeout=5) as s:
            def ask(cw, data=b""):
                s.sendall(bytes([0xAD, 5, cw, len(data)]) + data.ljust(8, b"\0") + b"\0\0\0\xCC")
                got = b""
                while len(got) < 16:
                    got += s.recv(16 - len(got))
                return got
            ask(0x95, b"\1")
            ask(0x9D, (10000).to_bytes(4, "little"))
            ask(0x96)
            begun = time.monotonic()
            time.sleep(0.3)
            d = ask(0x91, b"\1")
            position = int.from_bytes(d[8:12], "little", signed=True)
            assert position > 10000 * 20 * 0.3 * 0.4, f"{position} after {time.monotonic() - begun:.2f} s at 20 times the speed"


def test_acknowledged_writes_survive_kill_minus_nine(folder):
    done = {}
    with Gateway(folder) as g:
        for i in range(25):
            value = 20000 + i
            answer = g.send("PUT", "/axes/feeder/parameters/AC", {"value": value})
            assert answer["result"] == "done", answer
            done["AC"] = value
        g.send("PUT", "/axes/slide/parameters/DC", {"value": 31000})
        os.kill(g.process.pid, signal.SIGKILL)
        g.process.wait()
    with Gateway(folder, None) as g:
        p = g.get("/axes/feeder/parameters/AC")
        assert p["stored"] == done["AC"], p
        assert p["value"] == done["AC"], "the twin's EEPROM is kept as well"
        assert g.get("/axes/slide/parameters/DC")["stored"] == 31000
        assert g.get("/site")["axes"][0]["name"] == "feeder"
        events = json.dumps(g.get("/events?limit=200"))
        assert "20024" in events and "127.0.0.1" in events, "who wrote what, from where"


def test_second_gateway_on_the_same_data_is_refused(folder):
    with Gateway(folder):
        code, _, err = run("serve", "--data", str(folder / "data"), "--set", "http.bind=off", "--set", "modbus.bind=off")
        assert code == 1 and str(folder / "data") in err, err


def test_backup_and_restore(folder):
    copy = folder / "copy.tar"
    with Gateway(folder) as g:
        g.send("PUT", "/axes/feeder/parameters/AC", {"value": 4321})
        run("backup", str(copy), "--data", str(folder / "data"), check=0)
        g.send("PUT", "/axes/feeder/parameters/AC", {"value": 1234})
        code, _, err = run("restore", str(copy), "--data", str(folder / "data"))
        assert code == 1 and err, "not while it runs"
        g.stop()
    run("restore", str(copy), "--data", str(folder / "data"), check=0)
    with Gateway(folder, None) as g:
        assert g.get("/axes/feeder/parameters/AC")["stored"] == 4321
    assert sqlite3.connect(folder / "data/axisgate.db").execute("pragma integrity_check").fetchone()[0] == "ok"


def test_restart_keeps_the_site_and_starts_quickly(folder):
    with Gateway(folder) as g:
        assert g.stop() == 0
    with Gateway(folder, None) as g:
        assert [a["name"] for a in (lambda x: x["axes"] if isinstance(x, dict) else x)(g.get("/axes"))] == ["feeder", "slide"]


def test_health_ready_metrics(gateway):
    assert gateway.request("GET", "/healthz")[0] == 200
    assert gateway.request("GET", "/readyz")[0] == 200
    gateway.send("PATCH", "/drives/slide/hand", {"silent": True})
    until(lambda: gateway.request("GET", "/readyz")[0] == 503, 10, "not ready")
    s, text, headers = gateway.request("GET", "/metrics")
    text = text.decode()
    assert s == 200 and headers["Content-Type"].startswith("text/plain")
    names = set()
    for line in text.splitlines():
        if line.startswith("# TYPE "):
            name = line.split()[2]
            assert name not in names, f"{name} twice"
            names.add(name)
        elif line and not line.startswith("#"):
            assert re.match(r'^(axisgate|process)_[a-z0-9_]+(\{([a-z_]+="[^"]*",?)*\})? -?[0-9.e+-]+$', line), line
    assert {"axisgate_build_info", "axisgate_line_exchanges_total", "axisgate_modbus_requests_total"} <= names
