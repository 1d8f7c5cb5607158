"""Makers' descriptions from outside: an EDS file is posted, a drive names it, its parameters are read over HTTP and Modbus, a DCF comes back.

In: the real program. Out: judgements on documents, registers, files. Never sleeps longer than it waits.
"""
import configparser
import json
import pathlib

from harness import Gateway, ModbusException, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]
EDS = TOP / "adapters/cia402/tests/eds"
EMPTY = {"lines": [{"name": "can0", "uri": "twin", "family": "cia402"}], "drives": [], "axes": []}


def post(gateway, name, data, status=201):
    got, answer, _ = gateway.request("POST", f"/api/v1/descriptions?name={name}", data, {"Content-Type": "application/octet-stream"})
    assert got == status, f"{got}: {answer}"
    return answer


def add_lift(gateway, description="plain.eds"):
    gateway.send("POST", "/drives", {"name": "lift", "line": "can0", "address": 12, "presence": "twin", "description": description}, 201)
    gateway.send("POST", "/axes", {"name": "lift", "drive": "lift", "number": 1, "unit": "mm", "increments_per_unit": 1000}, 201)
    until(lambda: gateway.axis("lift")["online"], 10, "the drive")


def test_a_drive_is_what_its_file_says(folder):
    text = (EDS / "plain.eds").read_bytes()
    with Gateway(folder, EMPTY) as gateway:
        facts = post(gateway, "plain.eds", text)
        assert facts["commissioning"] is None and {f["name"] for f in gateway.get("/families") if f["takes_description"]} == {"cia402"}
        assert facts["vendor"] == "Example Motion" and facts["revision_number"] == 0x30000 and facts["used_by"] == [], facts
        assert facts["pdos"][1] == {"direction": "receive", "number": 2, "mapped": [{"object": "6040h", "name": "Controlword", "bits": 16}, {"object": "607Ah", "name": "Target position", "bits": 32}]}
        assert gateway.request("GET", "/api/v1/descriptions/plain.eds?format=eds")[1] == text
        objects = {o["object"]: o for o in gateway.get("/descriptions/plain.eds/objects")}
        assert len(objects) == facts["entries"] and gateway.request("GET", "/api/v1/descriptions/plane.eds/objects")[0] == 404
        gain = objects["2010h:01"]
        assert gain["low"] == "1" and gain["high"] == "5000" and gain["default"] == "350" and gain["type"] == "UNSIGNED16" and gain["line"] > 0, gain
        status, refused, _ = gateway.request("POST", "/api/v1/drives", {"name": "lift", "line": "can0", "address": 12, "description": "plane.eds"})
        assert status == 422 and "plane.eds" in refused["detail"] and "plain.eds" in refused["faults"][0]["remedy"], refused
        add_lift(gateway)
        rows = {p["id"]: p for p in gateway.get("/axes/lift/parameters")}
        assert rows["2010h:01"]["name"] == "velocity_loop_gain_proportional" and rows["2010h:01"]["max"] == 5000, rows["2010h:01"]
        assert rows["6081h"]["max"] == 250000 and "6072h" not in rows
        # The model is built from the file: the value is the file's default, not the built-in dictionary's.
        assert gateway.get("/axes/lift/parameters/2010h:01")["value"] == 350
        assert gateway.get("/axes/lift/parameters/2040h")["value"].replace(" ", "").upper() == "0102FF"
        gateway.send("PUT", "/axes/lift/parameters/2010h:01", {"value": 410})
        assert gateway.get("/axes/lift/parameters/velocity_loop_gain_proportional")["value"] == 410
        status, refused, _ = gateway.request("PUT", "/api/v1/axes/lift/parameters/2010h:01", {"value": 5001})
        assert status == 422 and "1..5000" in refused["detail"], refused
        assert gateway.get("/drives/lift/hand")["unmodelled"] > 0
        # The same parameter through a mapped register, and what is stored by the drive's own name.
        gateway.send("POST", "/mappings", {"unit": 2, "address": 10, "axis": "lift", "point": "2010h:01", "type": "u16"}, 201)
        with gateway.modbus() as m:
            def shown():
                try:
                    return m.read(10, 1, unit=2) == [410]
                except ModbusException as e:
                    assert e.code == 6, e  # busy: its value is asked for just now
                    return False
            until(shown, 10, "the register")
        status, refused, _ = gateway.request("DELETE", "/api/v1/descriptions/plain.eds")
        assert status == 409 and refused["used_by"] == ["lift"], refused
        # It moves.
        gateway.command("lift", {"command": "enable"})
        gateway.command("lift", {"command": "move_absolute", "position": 2, "velocity": 20, "acceleration": 90})
        until(lambda: gateway.axis("lift")["target_reached"], 20, "arrival")
    with Gateway(folder, None) as gateway:
        assert gateway.get("/drives/lift")["description"] == "plain.eds", "the site finds its description after a restart"
        until(lambda: gateway.axis("lift")["online"], 10, "the drive")
        assert gateway.get("/axes/lift/parameters/2010h:01")["value"] == 350, "in the RAM of the model, which nobody has told to store it"
        status, refused, _ = gateway.request("PATCH", "/api/v1/drives/lift", {"description": None})
        assert status == 422 and "has no point 2010h:01" in refused["detail"], refused
        gateway.request("DELETE", "/api/v1/mappings?all=1")
        gateway.send("PATCH", "/drives/lift", {"description": None})
        until(lambda: gateway.axis("lift")["online"], 10, "the drive")
        assert "2010h:01" not in {p["id"] for p in gateway.get("/axes/lift/parameters")}
        assert gateway.request("DELETE", "/api/v1/descriptions/plain.eds")[0] == 204
        assert gateway.get("/descriptions") == []


def test_a_snapshot_is_a_dcf(folder):
    with Gateway(folder, EMPTY) as gateway:
        post(gateway, "plain.eds", (EDS / "plain.eds").read_bytes())
        add_lift(gateway)
        gateway.send("PUT", "/axes/lift/parameters/2010h:01", {"value": 411})
        gateway.send("POST", "/axes/lift/snapshots", {"name": "as built"}, 201)
        status, dcf, headers = gateway.request("GET", "/api/v1/axes/lift/snapshots/1?format=dcf")
        assert status == 200 and headers["Content-Type"].startswith("text/plain") and "lift-1.dcf" in headers["Content-Disposition"], headers
        read = configparser.ConfigParser(interpolation=None, strict=True)
        read.read_string(dcf.decode())
        assert int(read["2010sub1"]["ParameterValue"], 0) == 411
        assert int(read["DeviceComissioning"]["NodeID"], 0) == 12
        assert "ParameterValue" not in read["6041"], "what can only be read sets nothing up"
        # It is a description itself: a second drive begins with the values of the first.
        post(gateway, "lift.dcf", dcf)
        gateway.send("POST", "/drives", {"name": "copy", "line": "can0", "address": 13, "presence": "twin", "description": "lift.dcf"}, 201)
        gateway.send("POST", "/axes", {"name": "copy", "drive": "copy", "number": 2}, 201)
        until(lambda: gateway.axis("copy")["online"], 10, "the second drive")
        assert gateway.get("/axes/copy/parameters/2010h:01")["value"] == 411
        gateway.send("PATCH", "/drives/lift", {"description": None})
        assert gateway.request("GET", "/api/v1/axes/lift/snapshots/1?format=dcf")[0] == 409


def test_odd_rows_are_told_with_their_line_and_files_of_others_refused(folder):
    good = (EDS / "plain.eds").read_text()
    with Gateway(folder, EMPTY) as gateway:
        cases = {
            "an unknown type": (good.replace("DataType=0x0006", "DataType=0x0FFF", 1), "0x0FFF"),
            "limits that cross": (good.replace("LowLimit=1\nHighLimit=5000", "LowLimit=5001\nHighLimit=5000"), "above its HighLimit"),
            "a value of another type": (good.replace("DefaultValue=350", "DefaultValue=fast"), "fast"),
            "a section twice": (good + "\n[6040]\nParameterName=x\n", "6040"),
        }
        for n, (what, (text, word)) in enumerate(cases.items()):
            assert text != good, what
            told = post(gateway, f"odd{n}.eds", text.encode())["warnings"]
            assert word in told[0]["text"] and told[0]["line"] > 0, (what, told)
            gateway.send("DELETE", f"/descriptions/odd{n}.eds", None, 204)
        refused = post(gateway, "a.eds", good.replace("0x00020192", "0x00020191").encode(), 422)
        assert "401" in refused["faults"][0]["text"] and "line " in refused["faults"][0]["text"], refused
        many = "".join(f"[s{n}]\na=1\n" for n in range(70_000))
        assert len(many) < 1 << 20 and "sections" in str(post(gateway, "a.eds", many.encode(), 422))
        assert gateway.request("POST", "/api/v1/descriptions?name=a.eds", b";" * (2 << 20), {"Content-Type": "text/plain"})[0] == 413
        assert gateway.get("/descriptions") == []


def test_a_description_may_lie_beside_the_site_file(folder):
    site = {**EMPTY, "drives": [{"name": "lift", "line": "can0", "address": 12, "presence": "twin", "description": "own.eds"}],
            "axes": [{"name": "lift", "drive": "lift", "channel": 1, "number": 1}]}
    (folder / "site.json").write_text(json.dumps(site))
    check = ("check", "--site", str(folder / "site.json"))
    code, _, said = run(*check)
    assert code != 0 and "own.eds" in said and "site.json:1:" in said, said
    good = (EDS / "plain.eds").read_text()
    (folder / "own.eds").write_text(good.replace("0x00020192", "0x00020191"))
    code, _, said = run(*check)
    assert code != 0 and "own.eds:" in said and "401" in said, said
    (folder / "own.eds").write_text(good)
    assert run(*check, check=0)[1].strip() == "no faults found"
    with Gateway(folder, site) as gateway:
        assert gateway.get("/descriptions/own.eds")["name"] == "own.eds"
        until(lambda: gateway.axis("lift")["online"], 10, "the drive")
        assert gateway.stop() == 0
    (folder / "own.eds").unlink()
    with Gateway(folder, None) as gateway:
        assert gateway.get("/drives/lift")["description"] == "own.eds", "it was kept"


def test_another_drive_than_the_described_one_is_told(folder):
    other = (EDS / "plain.eds").read_text()
    with Gateway(folder, EMPTY) as gateway:
        post(gateway, "plain.eds", other.encode())
        # The object says one number and the head of the file another: the model answers by the object.
        post(gateway, "other.eds", other.replace("ProductNumber=0x00002001", "ProductNumber=0x00002009").encode())
        add_lift(gateway, "other.eds")
        events = until(lambda: [e for e in gateway.get("/events?axis=lift") if e["kind"] == "identity"], 10, "the event")
        assert "product 2001h, not 2009h" in events[0]["text"] and "other.eds" in events[0]["text"], events
        gateway.command("lift", {"command": "enable"})
        gateway.send("PATCH", "/drives/lift", {"description": "plain.eds"})
        until(lambda: gateway.axis("lift")["online"], 10, "the drive")
