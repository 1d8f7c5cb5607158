"""Who may command: leases over HTTP and Modbus, take over, expiry, stops by others; the locks of the Modbus door."""
import copy
import socket

from harness import DEMO, Gateway, Modbus, ModbusException, until
from test_users import first


def client(gateway, method, path, body=None, name=None):
    s, answer, _ = gateway.request(method, "/api/v1" + path, body, {"X-Client": name} if name else None)
    return s, answer


class From(Modbus):
    """A Modbus client of another host of the loopback network."""

    def __init__(self, port, address):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20, source_address=(address, 0))
        self.transaction = 0


def code_of(call):
    try:
        call()
    except ModbusException as e:
        return e.code
    return 0


def test_a_lease_refuses_others_by_name_but_never_a_stop(gateway):
    assert gateway.get("/axes/feeder/authority")["holder"] == ""
    s, a = client(gateway, "PUT", "/axes/feeder/authority", {"ttl_s": 60}, "panel")
    assert s == 200 and a["holder"] == "127.0.0.1 panel" and a["door"] == "http" and 55 < a["expires_in_s"] <= 60, a
    s, a = client(gateway, "POST", "/axes/feeder/commands?wait=5", {"command": "enable"}, "panel")
    assert s == 200, a
    s, a = client(gateway, "POST", "/axes/feeder/commands", {"command": "move_relative", "position": 1}, "script")
    assert s == 409 and a["reason"] == "authority" and "127.0.0.1 panel" in a["detail"], a
    with gateway.modbus() as m:
        assert m.read(17, 1)[0] == 3
        assert code_of(lambda: m.write32(34, 3200)) == 6
        assert code_of(lambda: m.write1(32, 0x0F)) == 6
        assert code_of(lambda: m.write1(32, 0x02)) == 0, "a quick stop of another client"
    s, a = client(gateway, "POST", "/axes/feeder/commands?wait=5", {"command": "halt"}, "script")
    assert s == 200, a
    s, a = client(gateway, "PUT", "/axes/feeder/authority", {}, "script")
    assert s == 409 and "127.0.0.1 panel" in a["detail"], a
    s, a = client(gateway, "DELETE", "/axes/feeder/authority", None, "script")
    assert s == 409, a
    s, a = client(gateway, "PUT", "/axes/feeder/authority", {"take_over": True, "ttl_s": 1}, "script")
    assert s == 200 and a["holder"] == "127.0.0.1 script", a
    until(lambda: gateway.get("/axes/feeder/authority")["holder"] == "", 5, "the lease expires")
    assert gateway.get("/axes/feeder/authority")["door"] == "none"
    s, a = client(gateway, "PUT", "/axes/feeder/authority", {}, "panel")
    s, a = client(gateway, "POST", "/axes/feeder/authority/hand-over", {"to": "modbus 127.0.0.9"}, "panel")
    assert s == 200 and a["door"] == "modbus" and a["holder"] == "127.0.0.9", a
    listed = gateway.get("/authority")["clients"]
    assert {"http 127.0.0.1 panel", "http 127.0.0.1 script"} <= {c["client"] for c in listed}, listed
    s, a = client(gateway, "PUT", "/axes/feeder/authority", {"take_over": True}, "panel")
    assert s == 200, a
    s, a = client(gateway, "POST", "/axes/feeder/authority/hand-over", {"to": "http 127.0.0.1"}, "panel")  # a user, or a host: any client of it
    assert s == 200 and a["holder"] == "127.0.0.1", a
    s, a = client(gateway, "POST", "/axes/feeder/commands?wait=5", {"command": "enable"}, "script")
    assert s == 200 and gateway.get("/axes/feeder/authority")["holder"] == "127.0.0.1 script", a
    s, a = client(gateway, "POST", "/axes/feeder/commands", {"command": "home"}, "panel")
    assert s == 409 and "script" in a["detail"], a
    texts = until(lambda: [t for t in [[e["text"] for e in gateway.get("/events") if e["kind"] == "authority"]] if any("handed over" in x for x in t)], 5, "events")[0]
    for word in ("held by", "taken over", "expired", "handed over"):
        assert any(word in t for t in texts), (word, texts)


def test_what_a_client_held_is_free_when_it_may_not_command_any_more(folder):
    with Gateway(folder, DEMO) as g:
        def ask(method, path, body=None, headers=None):
            s, answer, head = g.request(method, "/api/v1" + path, body, headers)
            return s, answer, head

        anna = first(g)
        assert ask("POST", "/users", {"name": "bert", "role": "operator", "password": "another-long-sentence-2"}, anna)[0] == 201
        s, session, head = ask("POST", "/session", {"user": "bert", "password": "another-long-sentence-2"})
        bert = {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"]}
        tokens = {}
        for name in ("night", "day"):
            s, made, _ = ask("POST", "/tokens", {"name": name, "role": "operator"}, bert)
            assert s == 201, made
            tokens[name] = made
        night, day = ({"Authorization": "Bearer " + tokens[n]["token"]} for n in ("night", "day"))

        def holder():
            with g.modbus() as m:
                return ask("GET", "/axes/feeder/authority", None, anna)[1]["holder"], m.read(17, 1)[0]

        # A token is a client of its own: beside its owner's page and his other tokens.
        assert ask("PUT", "/axes/feeder/authority", {"ttl_s": 3600}, night)[0] == 200
        assert holder() == ("bert night", 3)
        for other in (day, bert, anna):
            s, answer, _ = ask("POST", "/axes/feeder/commands", {"command": "enable"}, other)
            assert s == 409 and "bert night" in answer["detail"], answer
        assert ask("DELETE", "/tokens/" + tokens["night"]["id"], None, bert)[0] == 204
        until(lambda: holder() == ("", 0), 5, "the token's lease ends with it")

        for end in (("PATCH", "/users/bert", {"role": "viewer"}), ("PATCH", "/users/bert", {"role": "operator", "enabled": False}), ("DELETE", "/users/bert", None)):
            ask("PATCH", "/users/bert", {"role": "operator", "enabled": True}, anna)
            s, session, head = ask("POST", "/session", {"user": "bert", "password": "another-long-sentence-2"})
            assert s in (200, 201), session
            mine = {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"], "X-Client": "page-1"}
            s, answer, _ = ask("PUT", "/axes/feeder/authority", {"ttl_s": 3600}, mine)
            assert s == 200 and holder() == ("bert page-1", 3), answer
            assert ask(end[0], end[1], end[2], anna)[0] in (200, 204)
            until(lambda: holder() == ("", 0), 5, f"the lease ends: {end}")
        assert any("released by http bert page-1" in e["text"] and e["who"].startswith("anna") for e in ask("GET", "/events?kind=authority", None, anna)[1])


def test_in_lease_mode_a_command_takes_the_axis(folder):
    site = copy.deepcopy(DEMO)
    site["axes"][0]["authority_mode"] = "lease"
    with Gateway(folder, site, "--set", "authority.lease_s=2") as g:
        one, two = From(g.modbus_port, "127.0.0.2"), From(g.modbus_port, "127.0.0.3")
        with one, two:
            one.write1(32, 0x06)
            one.write1(32, 0x07)
            one.write1(32, 0x0F)
            assert g.get("/axes/feeder/authority")["holder"] == "127.0.0.2"
            assert code_of(lambda: two.write1(32, 0x0F)) == 6
            s, a = client(g, "POST", "/axes/feeder/commands", {"command": "enable"})
            assert s == 409 and "modbus 127.0.0.2" in a["detail"], a
            holds = {c["peer"].split(":")[0]: c["holds"] for c in g.get("/modbus")["connections"]}
            assert holds == {"127.0.0.2": ["feeder"], "127.0.0.3": []}, holds
            assert code_of(lambda: two.write1(32, 0x00)) == 0, "everybody may switch it off"
        until(lambda: g.get("/axes/feeder/authority")["holder"] == "", 5, "the lease of the client that is gone")


def test_two_programs_of_one_host_are_one_client_and_both_are_shown(folder):
    site = copy.deepcopy(DEMO)
    site["axes"][0]["authority_mode"] = "lease"
    with Gateway(folder, site, "--set", "authority.lease_s=30") as g:
        free = g.get("/axes/feeder/authority")
        assert (free["holder"], free["holder_text"], free["connections"]) == ("", "nobody", []), free
        with From(g.modbus_port, "127.0.0.2") as one, From(g.modbus_port, "127.0.0.2") as two, From(g.modbus_port, "127.0.0.3") as other:
            for word in (0x00, 0x04, 0x06, 0x07, 0x0F):
                one.write1(32, word)
            assert code_of(lambda: two.write1(33, 1)) == 0, "the same address is the same client"
            assert code_of(lambda: other.write1(32, 0x0F)) == 6
            peers = sorted("%s:%d" % x.socket.getsockname() for x in (one, two))
            for a in (g.get("/axes/feeder/authority"), next(a for a in g.get("/authority")["axes"] if a["axis"] == "feeder")):
                assert a["holder"] == "127.0.0.2" and sorted(a["connections"]) == peers, a
                assert a["holder_text"].startswith("modbus 127.0.0.2: one client with 2 connections, ") and all(p in a["holder_text"] for p in peers), a
            slide = next(a for a in g.get("/authority")["axes"] if a["axis"] == "slide")
            assert slide["connections"] == [] and slide["holder_text"] == "nobody", slide
        # The panel comes back from another port and still has its axis.
        with From(g.modbus_port, "127.0.0.2") as again:
            assert code_of(lambda: again.write1(32, 0x0F)) == 0
            a = until(lambda: [x for x in [g.get("/axes/feeder/authority")] if len(x["connections"]) == 1], 5, "one connection")[0]
            assert a["holder_text"] == "modbus 127.0.0.2, connected from %s:%d" % again.socket.getsockname(), a


def test_a_read_only_door_still_stops(folder):
    with Gateway(folder, DEMO) as g:
        g.command("feeder", {"command": "enable"})
        g.command("feeder", {"command": "move_velocity", "velocity": 1, "acceleration": 20}, wait=0)
        g.send("PATCH", "/modbus", {"read_only": True})
        with g.modbus() as m:
            for word in (0x06, 0x0F, 0x1F, 0x80, 0x10F, 0x12):
                assert code_of(lambda: m.write1(32, word)) == 1, hex(word)
            assert code_of(lambda: m.write(32, [2, 1])) == 1 and code_of(lambda: m.write(34, [0, 0])) == 1 and code_of(lambda: m.write1(33, 2)) == 1
            assert code_of(lambda: m.write1(0, 2, unit=2)) == 1, "a user map is no standard map"
            assert g.axis()["state"] == "operation_enabled"
            assert code_of(lambda: m.write1(32, 0x02)) == 0
            until(lambda: not g.axis()["moving"], 10, "the quick stop")
            assert code_of(lambda: m.write(32, [0])) == 1 and g.axis()["state"] == "quick_stop_active", "without its voltage an axis may fall"
            assert code_of(lambda: m.write(32, [0x0B])) == 0, "function 16 takes a quick stop, too"
            assert code_of(lambda: m.write1(32, 0x0F)) == 1


def test_modbus_locks(folder):
    locks = ("--set", "modbus.allow=127.0.0.1,10.0.0.0/8", "--set", "modbus.functions=3,6,16")
    with Gateway(folder, DEMO, *locks) as g:
        with g.modbus() as m:
            assert code_of(lambda: m.read(0, 1)) == 0
            assert g.get("/modbus")["allow"] == ["127.0.0.1", "10.0.0.0/8"]
            g.send("PATCH", "/modbus", {"read_only": True})
            assert code_of(lambda: m.write1(33, 1)) == 1
            assert code_of(lambda: m.read(0, 1)) == 0
        try:
            with From(g.modbus_port, "127.0.0.2") as other:
                other.read(0, 1)
            raise AssertionError("a peer that is not allowed was served")
        except OSError:
            pass
        g.stop()
    with Gateway(folder, None, *locks) as g:
        assert g.get("/modbus")["read_only"] is True, "the switch is kept"
