"""schema/site.schema.json against the program: what the schema refuses the program refuses too, and what only the program can see is named.

In: the schema, the example site, broken and randomly changed sites. Out: agreement in both directions. The program is asked by
`axisgate check` and by PUT /api/v1/site?dry_run=1, which change nothing.
"""
import copy
import json
import pathlib
import random
import re

import jsonschema

import harness
import openapi
from harness import run

TOP = pathlib.Path(__file__).resolve().parents[2]
SCHEMA = json.loads((TOP / "schema/site.schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)

FULL = {
    "lines": [
        {"name": "can0", "uri": "twin", "family": "uim342", "bitrate": 500000, "options": {"crc": "12", "window": 8, "x": True},
         "timing": {"reply_timeout_ms": 20, "poll_period_ms": 10, "pause_ms": 0, "stale_after_ms": 500, "retries": 2, "silent_limit": 3,
                     "retry_pause_min_ms": 100, "retry_pause_max_ms": 2000}},
        {"name": "tcp0", "uri": "tcp:192.0.2.10:8888", "family": "uim342"},
        {"name": "ser.0", "uri": "serial:/dev/ttyS1?baud=57600&format=8N1&rs485=auto&rts_after_ms=2", "family": "uim342"}],
    "drives": [
        {"name": "feeder", "line": "can0", "address": 5, "presence": "auto", "options": {"model": "342S"}},
        {"name": "slide", "line": "can0", "address": "6", "presence": "twin"},
        {"name": "remote", "line": "tcp0", "presence": "device"}],
    "axes": [
        {"name": "feeder", "drive": "feeder", "channel": 1, "number": 1, "unit": "mm", "increments_per_unit": 3200.5, "position_min": -10, "position_max": 10.5,
         "velocity_max": 100, "acceleration_max": 1000},
        {"name": "slide", "drive": "slide", "number": 1024},
        {"name": "remote", "drive": "remote", "number": 3, "unit": ""}],
    "mappings": [],
}

# Faults that need more than one place of the document, or the family: no schema can see them.
RELATIONS = re.compile("|".join((
    "there is no (line|drive|family)", "is taken$", "two drives on", "is there twice", "is used by two lines", "a twin line has no", "does not speak on",
    "the longest pause is shorter", "position_max must be above", r"a \w+ has \d+ channel", "^drive [^:]*: ", "is longer than", "square brackets",
    "is not a port", "is said twice", "baud is a number", "is a number of milliseconds", "for RS-485 alone", "both need the RTS", "carries one, by which it is set up")))


def broken():
    """(what, document, pointer): each wrong in one place, by itself."""
    def one(what, change, pointer):
        d = copy.deepcopy(FULL)
        change(d)
        return what, d, pointer

    def put(path, value):
        def change(d):
            *way, last = path
            for k in way:
                d = d[k]
            d[last] = value
        return change

    def drop(*path):
        def change(d):
            *way, last = path
            for k in way:
                d = d[k]
            del d[last]
        return change

    yield "the root is no object", [], ""
    yield "the root is null", None, ""
    for list_name in ("lines", "drives", "axes", "mappings"):
        yield one(f"{list_name} is an object", put((list_name,), {}), f"/{list_name}")
    yield one("an unknown member of the root", put(("axis",), []), "/axis")
    yield one("a line is a text", put(("lines", 1), "can1"), "/lines/1")
    for path, value in (
            (("lines", 0, "speed"), 1), (("lines", 0, "name"), ""), (("lines", 0, "name"), "a b"), (("lines", 0, "name"), "n" * 65), (("lines", 1, "name"), 7),
            (("lines", 1, "uri"), "nonsense"), (("lines", 1, "uri"), ""), (("lines", 1, "uri"), "can:"), (("lines", 1, "uri"), "can:a/b"),
            (("lines", 1, "uri"), "can:interface_0123456"), (("lines", 1, "uri"), "can:.."), (("lines", 1, "uri"), "twin:x"), (("lines", 1, "uri"), "tcp:host"),
            (("lines", 1, "uri"), "tcp:::1:80"), (("lines", 1, "uri"), "tcp:[::1]"), (("lines", 1, "uri"), "tcp:h:80?x=1"), (("lines", 2, "uri"), "serial:ttyS1"),
            (("lines", 2, "uri"), "serial:/dev/ttyS1?speed=9600"), (("lines", 2, "uri"), "serial:/dev/ttyS1?format=9N1"), (("lines", 2, "uri"), "serial:/dev/ttyS1?"),
            (("lines", 2, "uri"), "pty:"), (("lines", 2, "uri"), "pty:/tmp/"), (("lines", 2, "uri"), "pty:/tmp/x?mode=raw"), (("lines", 2, "uri"), "pty:/tmp/x?format=7N1"),
            (("lines", 2, "uri"), "pty:/tmp/x?baud=fast"), (("lines", 2, "uri"), 5), (("lines", 0, "family"), ""), (("lines", 0, "family"), 1),
            (("drives", 0, "family"), ""), (("drives", 0, "family"), 1),
            (("lines", 0, "bitrate"), -1), (("lines", 0, "bitrate"), 1.5), (("lines", 0, "bitrate"), "1000000"), (("lines", 0, "bitrate"), 100000001),
            (("lines", 0, "options"), []), (("lines", 0, "options", "x"), None), (("lines", 0, "options", "x"), {}), (("lines", 0, "timing"), []),
            (("lines", 0, "timing", "patience_ms"), 1), (("lines", 0, "timing", "reply_timeout_ms"), 60001), (("lines", 0, "timing", "retries"), -2),
            (("lines", 0, "timing", "retries"), 21), (("lines", 0, "timing", "silent_limit"), 0), (("lines", 0, "timing", "retry_pause_min_ms"), 0),
            (("lines", 0, "timing", "stale_after_ms"), "1"),
            (("drives", 0, "adress"), 5), (("drives", 0, "address"), 5.5), (("drives", 0, "address"), True), (("drives", 0, "address"), [5]), (("drives", 0, "address"), ""),
            (("drives", 0, "presence"), "real"), (("drives", 0, "presence"), 1), (("drives", 0, "line"), ""), (("drives", 0, "line"), 0), (("drives", 0, "options"), "x"),
            (("axes", 0, "number"), 0), (("axes", 0, "number"), 1025), (("axes", 0, "number"), "1"), (("axes", 0, "number"), None), (("axes", 0, "channel"), 0),
            (("axes", 0, "channel"), 257), (("axes", 0, "unit"), 1), (("axes", 0, "increments_per_unit"), 0), (("axes", 0, "increments_per_unit"), -1),
            (("axes", 0, "increments_per_unit"), "1"), (("axes", 0, "position_min"), "1"), (("axes", 0, "velocity_max"), 0), (("axes", 0, "acceleration_max"), -5),
            (("mappings",), [1]), (("mappings",), [{}, "x"]), (("axes", 0, "scale"), 1), (("axes", 0, "drive"), ""), (("axes", 0, "name"), "ä")):
        yield one(f"{'/'.join(map(str, path))} = {json.dumps(value)}", put(path, value), "/" + "/".join(map(str, path)))
    for path in (("lines", 1, "name"), ("lines", 1, "uri"), ("drives", 2, "name"), ("drives", 2, "line"), ("axes", 2, "name"), ("axes", 2, "drive"),
                 ("axes", 2, "number")):
        yield one(f"{'/'.join(map(str, path))} is missing", drop(*path), "/" + "/".join(map(str, path)))


def test_the_schema_is_one_and_its_examples_fit():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    for example in SCHEMA["examples"]:
        VALIDATOR.validate(example)

    def walk(node, path):
        if isinstance(node, dict):
            if node.get("type") == "object" or "object" in (node.get("type") if isinstance(node.get("type"), list) else []):
                assert "additionalProperties" in node or path.endswith("items"), f"{path}: says nothing about unknown members"
            if "/properties/" in path and path.count("/properties/") and path.rsplit("/", 1)[0].endswith("/properties"):
                assert "description" in node or "$ref" in node, f"{path}: has no description"
            for k, v in node.items():
                if k != "examples":
                    walk(v, f"{path}/{k}")
        elif isinstance(node, list):
            for i, v in enumerate(node):
                walk(v, f"{path}/{i}")
    walk(SCHEMA, "")
    uris = jsonschema.Draft202012Validator({"$ref": "#/$defs/line_uri", "$defs": SCHEMA["$defs"]})
    for uri in SCHEMA["$defs"]["line_uri"]["examples"]:
        uris.validate(uri)


def test_the_description_of_the_api_names_the_same_members():
    api = openapi.Description((TOP / "schema/openapi.yaml").read_text())
    for mine, theirs in (("line", "LineSpec"), ("drive", "DriveSpec"), ("axis", "AxisSpec"), ("timing", "LineTiming")):
        names, _ = api.members({"$ref": f"#/components/schemas/{theirs}"})
        assert set(SCHEMA["$defs"][mine]["properties"]) == names, f"{mine}: the site's schema and openapi.yaml differ: {sorted(set(SCHEMA['$defs'][mine]['properties']) ^ names)}"
        own = SCHEMA["$defs"][mine]["properties"]
        for name in names if mine == "timing" else ():
            other = api.document["components"]["schemas"]["LineTiming"]["properties"][name]
            assert (own[name]["minimum"], own[name]["maximum"]) == (other["minimum"], other["maximum"]), name


def test_the_examples_and_the_site_in_force_fit(gateway, folder):
    for path in sorted((TOP / "deploy/examples").glob("*.json")):
        VALIDATOR.validate(json.loads(path.read_text()))
        run("check", "--site", str(path), check=0)
    VALIDATOR.validate(gateway.get("/site"))
    file = folder / "full.json"
    file.write_text(json.dumps(FULL))
    VALIDATOR.validate(FULL)
    run("check", "--site", str(file), check=0)
    assert gateway.send("PUT", "/site", FULL)["valid"]
    exported = gateway.get("/site")
    VALIDATOR.validate(exported)
    assert gateway.send("PUT", "/site?dry_run=1", exported)["differences"] == [], "what was exported is what is in force"


def test_broken_documents_are_refused_by_both(gateway, folder):
    count = 0
    for what, document, pointer in broken():
        assert not VALIDATOR.is_valid(document), f"the schema takes: {what}"
        if isinstance(document, dict):
            answer = gateway.send("PUT", "/site?dry_run=1", document)
            assert not answer["valid"], f"the gateway takes: {what}"
            assert any(f["pointer"].startswith(pointer) for f in answer["faults"]), f"{what}: {answer['faults']}"
            assert all(f["text"] and f["remedy"] for f in answer["faults"]), what
        else:
            status, _, _ = gateway.request("PUT", "/api/v1/site?dry_run=1", json.dumps(document), {"Content-Type": "application/json"})
            assert status == 400, f"the gateway takes: {what}: {status}"
        if count % 8 == 0:
            file = folder / "broken.json"
            file.write_text(json.dumps(document))
            code, _, err = run("check", "--site", str(file))
            assert code == 2 and "broken.json:1" in err, f"axisgate check takes: {what}: {code} {err}"
        count += 1
    assert count > 60
    assert gateway.get("/site")["lines"] == harness.DEMO["lines"], "a dry run changes nothing"


def test_what_a_name_begins_with_is_said_by_both_schemas_and_the_gateway(gateway, folder):
    """Of axes a letter or digit; of lines and drives all but the two names that no path can have. A file with one is read with a warning."""
    api = openapi.Description((TOP / "schema/openapi.yaml").read_text())
    for entry, place, names in (("AxisFields", ("axes", 2), {".": False, "..": False, "-x": False, "_x": False, ".x": False, "x": True, "9x": True, "x-_.": True}),
                                ("DriveFields", ("drives", 2), {".": False, "..": False, "...": True, "-x": True, "_x": True}),
                                ("LineFields", ("lines", 2), {".": False, "..": False, "...": True, "-x": True, "_x": True})):
        node = api.resolve(api.document["components"]["schemas"][entry]["properties"]["name"])
        for name, good in names.items():
            d = copy.deepcopy(FULL)
            d[place[0]][place[1]]["name"] = name
            if place[0] == "drives":
                d["axes"][2]["drive"] = name
            assert VALIDATOR.is_valid(d) == good, (place, name)
            assert bool(re.search(node["pattern"], name)) == good, (entry, name)
            answer = gateway.send("PUT", "/site?dry_run=1", d)
            assert answer["valid"] == good, (place, name, answer)
            if not good:
                assert any(f["pointer"] == f"/{place[0]}/{place[1]}/name" for f in answer["faults"]), answer
    file = folder / "old.json"
    d["lines"][2]["name"] = FULL["lines"][2]["name"]
    d["axes"][2]["name"] = "_x"
    file.write_text(json.dumps(d))
    assert "cannot be asked for by its name" in run("check", "--site", str(file), check=0)[2]


def test_a_family_is_named_by_the_line_or_by_each_of_its_drives(gateway):
    """What the schema cannot say: it hangs on the line's kind and on other entries."""
    def faults(change):
        d = copy.deepcopy(FULL)
        change(d)
        VALIDATOR.validate(d)
        return [f["pointer"] for f in gateway.send("PUT", "/site?dry_run=1", d)["faults"]]

    def of(kind):
        return next(i for i, line in enumerate(FULL["lines"]) if line["uri"].startswith(kind))

    def bare(line, named):
        def change(d):
            family = d["lines"][line].pop("family")
            for drive in d["drives"]:
                if named and drive["line"] == d["lines"][line]["name"]:
                    drive["family"] = family
        return change
    can, serial = of("twin"), of("serial:")  # embedded drives of a family on CAN
    mine = [f"/drives/{i}/family" for i, d in enumerate(FULL["drives"]) if d["line"] == FULL["lines"][can]["name"]]
    assert faults(bare(can, named=True)) == []
    assert mine and set(mine) <= set(faults(bare(can, named=False)))
    assert f"/lines/{serial}/family" in faults(bare(serial, named=True))


def test_schema_and_gateway_agree_on_changed_documents(gateway):
    dice = random.Random(342)
    odd = [None, True, False, 0, 1, -1, 5, 6, 1.5, 1e300, 2**31, 2**53, 65, 1024, 1025, "", "a", "5", "feeder", "can0", "twin", "auto", "device", "uim342", "x" * 70, "ä", "a b",
           [], [1], {}, {"a": 1}, "tcp:h:1", "serial:/dev/ttyS9", "can:can9", "can:a b", "pty:x", "pty:x?baud=9600&format=7N1", "pty:x?baud=1"]
    agreed = {True: 0, False: 0}
    seen_relations = 0
    for turn in range(600):
        d = copy.deepcopy(FULL)
        for _ in range(dice.choice((1, 1, 1, 2))):
            places = []

            def collect(node):
                for k in (node if isinstance(node, dict) else range(len(node))):
                    places.append((node, k))
                    if isinstance(node[k], (dict, list)):
                        collect(node[k])
            collect(d)
            node, key = dice.choice(places)
            how = dice.random()
            if how < 0.2:
                del node[key]
            elif how < 0.3 and isinstance(node, dict):
                node[dice.choice(("name", "unit", "address", "number", "uri", "options", "manners", "timing", "zzz"))] = dice.choice(odd)
            else:
                node[key] = dice.choice(odd)
        s, answer, _ = gateway.request("PUT", "/api/v1/site?dry_run=1", d)
        fits = VALIDATOR.is_valid(d)
        assert s == 200, f"turn {turn}: {s} {answer}"
        if not fits:
            assert not answer["valid"], f"turn {turn}: the schema refuses what the gateway takes: {[e.message for e in VALIDATOR.iter_errors(d)]}"
        elif not answer["valid"]:
            others = [f for f in answer["faults"] if not RELATIONS.search(f["text"])]
            assert not others, f"turn {turn}: the schema takes what the gateway refuses: {others}"
            seen_relations += 1
            continue
        agreed[fits] += 1
    assert agreed[True] > 40 and agreed[False] > 200 and seen_relations > 40, (agreed, seen_relations)
