"""Queries of every operation of the description: names that it does not have, names that stand twice and values that are none are 400.

In: the description, the real program. Out: judgements; nothing is changed by any of these requests.
"""
import json

from harness import DEMO
from test_openapi import API, Client, RECIPE, check, quoted
from test_refusals import NAMES

BODIES = {"commandAxis": {"command": "halt"}, "actOnAxis": {"name": "nothing"}, "startMoves": {"axes": ["feeder"]}, "replaceSite": DEMO, "putRecipe": RECIPE,
          "importParameters": "parameter,value\nAC,20000\n", "addMappings": "unit,address,axis,point\n3,0,feeder,position\n", "replaceMappings": "unit,address,axis,point\n3,0,feeder,position\n",
          "addAssemblies": "instance,direction,unit,registers\n300,input,2,2\n", "replaceAssemblies": "instance,direction,unit,registers\n300,input,2,2\n"}
# Texts with a grammar of their own.
TEXTS = {"points": ["speed", "position,x"], "since": ["yesterday", "-1", "2020-13-45T00:00:00Z", ""], "with": ["moon", "", "snapshot", "Default"]}
# Texts that may be anything: what is not there is found nowhere, and that is no fault of the request.
FREE = {("listEvents", "axis"), ("listEvents", "kind"), ("listMappings", "axis"), ("removeMappings", "axis"), ("removeMappings", "ids"),
        ("listParameters", "group"), ("listParameters", "array"), ("addDescription", "name"), ("getTrends", "axes"), ("getRecordedSteps", "axes")}


def wrong_values(o, p):
    schema = API.resolve(p["schema"])
    if "enum" in schema:
        flag = set(map(str, schema["enum"])) >= {"0", "1"}
        return ["maybe", "2", "yes", "-1"] if flag else ["nonsense", "", str(schema["enum"][0]).upper() + "x"]
    if schema.get("type") == "integer":
        out = ["", "x", "1.5", "1e2", "0x10", "99999999999999999999", "+1", " 1"]
        return out + [str(schema[k] + d) for k, d in (("minimum", -1), ("maximum", 1)) if k in schema]
    if schema.get("type") == "number":
        return ["", "x", "nan", "inf", "1e400"] + [str(schema[k] + d) for k, d in (("minimum", -1), ("maximum", 1)) if k in schema]
    assert schema.get("type") == "string", (o.id, p)
    if p["name"] in TEXTS and (o.id, p["name"]) not in FREE:
        return TEXTS[p["name"]]
    assert (o.id, p["name"]) in FREE, f"{o.id}: which values of {p['name']} are wrong? Say so here"
    return []


def ask(client, o, query):
    target = o.path
    for name in o.names():
        target = target.replace("{" + name + "}", quoted("uim342" if name == "family" else NAMES[name]))
    body, headers = None, {}
    if o.request_media:
        headers["Content-Type"] = o.request_media[0]
        body = BODIES.get(o.id, {})
        body = body.encode() if isinstance(body, str) else json.dumps(body).encode()
    return client.request(o.method, target + "?" + query, body, headers)


def test_wrong_queries_are_refused_alike_everywhere(gateway):
    gateway.send("PUT", "/recipes/x", RECIPE, 201)
    gateway.send("POST", "/axes/feeder/snapshots", {"name": "one", "from": "stored"}, 201)
    before = gateway.get("/site")
    client = Client(gateway, 30).sign_in(gateway)
    names = values = 0
    for o in API.operations:
        if o.id == "openStream":
            continue
        own = [p["name"] for p in o.query()]
        queries = [("nonsense=1", 1)] + [(f"{n}=1", 1) for n in ("dry_run", "wait", "cascade", "limit", "state", "Dry_run") if n not in own]
        queries += [(f"{n}=1&{n}=1", 1) for n in own] + [(f"{p['name']}={quoted(v)}", 0) for p in o.query() for v in wrong_values(o, p)]
        for query, is_name in queries:
            answer = ask(client, o, query)
            what = f"{o.id}: {o.method} {o.path}?{query}"
            assert check(o, answer, what) == 400, f"{what}: {answer}"
            said = json.loads(answer[2])
            assert said["reason"] == "bad_request" and said["detail"], f"{what}: {said}"
            assert query.split("=")[0] in said["detail"], f"{what}: does not name it: {said['detail']}"
            names, values = names + is_name, values + (not is_name)
    assert names > 700 and values > 120, (names, values)
    assert gateway.get("/site") == before
    done = [e for e in gateway.get("/events?limit=1000") if "anna" in (e["who"] or "") and e["kind"] != "access"]
    assert not done, f"a refused request did something: {done[:3]}"


def test_good_values_of_queries_are_taken(gateway):
    """The other side: what the description allows is not refused."""
    gateway.send("POST", "/axes/feeder/snapshots", {"name": "one", "from": "stored"}, 201)
    client = Client(gateway, 30)
    for o in API.operations:
        if o.method != "GET" or o.id == "openStream":
            continue
        for p in o.query():
            schema = API.resolve(p["schema"])
            good = [str(v) for v in schema.get("enum", [])] or [str(schema[k]) for k in ("minimum", "default", "example") if k in schema]
            for v in good:
                answer = ask(client, o, f"{p['name']}={quoted(v)}")
                assert answer is not None and answer[0] != 400, f"{o.id}: {p['name']}={v}: {answer}"
