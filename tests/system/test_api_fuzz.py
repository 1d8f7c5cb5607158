"""Malformed and boundary values in path, query and body of every operation of schema/openapi.yaml: never a 5xx, never a hang.

Seeded; ends after a bounded time. 503, 504 and 507 with a reason are answers of a gateway that says why it cannot; nothing else above 499 is.
"""
import json
import random
import time

from test_openapi import API, Client

LIMIT_S = 25
WORDS = ["", "0", "-1", "1", "999999999999999999999", "NaN", "1e999", "%00", "%ff", "..", "%2e%2e%2f", "a" * 300, "%F0%9F%A6%8A", "'", "feeder", "true", "null", "[]", "{}", "1;2"]
VALUES = [None, True, 0, -1, 2 ** 63, 1e308, "", "x" * 2000, "\u0000", [], {}, [[]], {"": None}, [None] * 50, "feeder", {"name": {"name": []}}]
BODIES = [b"", b"{", b"[]", b"null", b"1", b'"x"', b"\xff\xfe", b'{"a":' * 200, b"[" * 5000, b'{"name":"x","name":"y"}', b"x" * 4000, b"parameter,value\n\"AC", b"a;b\n;;;;\n\n"]
STOPS = {"openStream"}
NAMES = ["feeder", "can0", "AC", "1", "m1", "uim342", "ben", "warm-up"]


def property_names(schema):
    schema = API.resolve(schema)
    out = list(schema.get("properties", {}))
    for part in schema.get("allOf", []) + schema.get("anyOf", []):
        out += property_names(part)
    return out


def value_of(rng, parameter):
    """A value of the query: at or beside a bound, one that is good, or a word that is none."""
    schema = API.resolve(parameter["schema"])
    bounds = [schema[k] + d for k in ("minimum", "maximum") if k in schema for d in (-1, 0, 1)]
    good = list(schema.get("enum", [])) + [schema[k] for k in ("default", "example") if k in schema]
    return rng.choice(WORDS if rng.random() < 0.4 or not bounds + good else bounds + good)


def test_no_request_breaks_the_api(gateway):
    rng = random.Random(20260102)
    # Two who may do everything: a session, and a program's token, which needs no CSRF header; so no operation is only asked by who may not.
    session = Client(gateway, 35).sign_in(gateway)
    made = session.request("POST", "/api/v1/tokens", json.dumps({"name": "fuzz", "role": "administrator", "expires_in_s": 3600}).encode())
    assert made[0] == 201, made
    session.request("POST", "/api/v1/users", json.dumps({"name": "ben", "password": "a-long-sentence-1", "role": "viewer"}).encode())
    token = Client(gateway, 35)
    token.more = {"Authorization": "Bearer " + json.loads(made[2])["token"]}
    end, asked, slowest = time.monotonic() + LIMIT_S, 0, 0.0
    operations = [o for o in API.operations if o.id not in STOPS]
    met, let_in = set(), set()
    while time.monotonic() < end and asked < 6000:
        o = operations[asked % len(operations)]
        asked += 1
        target = o.path
        for name in o.names():
            target = target.replace("{" + name + "}", rng.choice(WORDS if rng.random() < 0.4 else NAMES) or "%20")
        query = "&".join(f"{p['name']}={value_of(rng, p)}" for p in o.query() if rng.random() < 0.5)
        if rng.random() < 0.05:
            query += "&" + rng.choice(["nonsense=1", "", "=", "%", "dry_run=1", "a" * 3000 + "=1", "wait=1&wait=2"])
        body, headers = None, {}
        described = API.document["paths"][o.path][o.method.lower()].get("requestBody")
        if described:
            media, form = rng.choice(list(described["content"].items()))
            headers["Content-Type"] = media if rng.random() < 0.95 else "text/x"
            if rng.random() < 0.4:
                body = rng.choice(BODIES)
            else:
                names = property_names(form["schema"]) or ["x"]
                body = json.dumps({n: rng.choice(VALUES) for n in names if rng.random() < 0.7}).encode()
        if rng.random() < 0.2:
            headers["If-Match"] = rng.choice(["*", "\"0\"", "x", "\"" + "9" * 40 + "\""])
        # Who signs out is somebody else: the session is needed to the end.
        client = Client(gateway, 35) if o.id == "signOut" else rng.choice((session, token))
        begun = time.monotonic()
        answer = client.request(o.method, target + ("?" + query if query else ""), body, headers)
        slowest = max(slowest, time.monotonic() - begun)
        what = f"{o.id}: {o.method} {target}?{query} {headers} {body!r:.300}"
        assert answer is not None, f"closed without an answer: {what}"
        met.add(o.id)
        if answer[0] not in (401, 403):
            let_in.add(o.id)
        if answer[0] >= 500:
            assert answer[0] in (503, 504, 507) and (o.id == "getReady" or json.loads(answer[2])["reason"]), f"{answer[0]}: {what}: {answer[2][:300]!r}"
    assert met == {o.id for o in operations}, "every operation was asked"
    assert not (met - let_in - {"signOut"}), f"nobody ever came to {sorted(met - let_in)}"
    assert slowest < 31, slowest
    assert gateway.request("GET", "/healthz")[0] == 200
