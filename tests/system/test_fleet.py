# Several gateways of one DDS domain on the loopback interface: they find each other, and what they tell of it.
# In: the program, twice, with DDS. Out: doors, the ready line, events. Never another network than this machine's own.
import json
import random
import time

from harness import DEMO, Folder, Gateway, until
from test_openapi import Client, check, operation


def member(folder, domain, name, *more):
    return Gateway(folder, DEMO, "--set", "dds.enabled=true", "--set", f"dds.domain={domain}", "--set", f"dds.name={name}", *more)


def told(gateway, word):
    return [e for e in gateway.get("/events?limit=500") if e["kind"] == "fleet" and word in e["text"]]


def test_dds_is_off_unless_it_is_switched_on(gateway):
    assert "dds=" not in gateway.ready, gateway.ready
    assert not [d for d in gateway.get("/about")["doors"] if d["name"] == "dds"]


def test_two_gateways_with_one_name_find_each_other_and_say_so(folder):
    domain = random.randint(100, 200)
    with Folder() as other, Folder() as far, member(folder, domain, "hall") as a, member(other, domain, "hall") as b, \
            member(far, domain, "hall", "--set", "dds.partition=elsewhere") as c:
        assert a.word("dds") == f"hall@plant:{domain}%lo", a.ready
        assert [d["address"] for d in a.get("/about")["doors"] if d["name"] == "dds"] == [f"hall@plant:{domain}%lo"]
        until(lambda: told(a, "called hall as well"), 15, "the first hears of the second")
        until(lambda: told(b, "called hall as well"), 15, "the second hears of the first")
        assert f"http://{b.word('http')}/" in told(a, "called hall")[0]["text"], told(a, "called hall")
        time.sleep(1)
        assert not told(c, "called hall"), "another partition is another plant"
        assert len(told(a, "called hall")) == 1, "told once, and not of the other partition's"
        assert b.stop() == 0
        # It ended in order; another one with the name is told anew.
        with Folder() as again, member(again, domain, "hall"):
            until(lambda: len(told(a, "called hall")) == 2, 15, "the third")


def test_an_interface_that_is_not_there_is_said_at_the_start(folder):
    """It may come later: the door waits for it, and the rest of the gateway serves."""
    with member(folder, 99, "hall", "--set", "dds.interface=nosuch9") as g:
        assert "the dds door waits" in g.errors() and "nosuch9" in g.errors() and "[dds] interface" in g.errors(), g.errors()
        status, answer = g.request("GET", "/readyz")[:2]
        assert status == 503 and any("the dds door waits" in m and "nosuch9" in m for m in answer["missing"]), answer
        assert g.stop() == 0


def test_one_gateway_shows_the_fleet_and_moves_an_axis_of_another(folder):
    domain = random.randint(20, 90)
    with Folder() as other, Folder() as third, member(folder, domain, "hall-1") as a, member(other, domain, "hall-2") as b, member(third, domain, "hall-3") as c:
        def fleet(g):
            return {x["gateway"]: x for x in g.get("/fleet")["gateways"]}
        for g in (a, b, c):
            until(lambda: all(len(x["axes"]) == 2 and all(y["online"] for y in x["axes"]) for x in fleet(g).values()) and len(fleet(g)) == 3, 20, "all see all")
        assert [n for n, x in fleet(a).items() if x["here"]] == ["hall-1"] and fleet(a)["hall-2"]["page"] == f"http://{b.word('http')}/"
        path = "/fleet/hall-2/axes/feeder/commands"
        assert a.send("POST", path + "?wait=10", {"command": "enable"})["result"] == "done"
        moved = a.send("POST", path + "?wait=20", {"command": "move_absolute", "position": 7, "velocity": 30, "acceleration": 200, "deceleration": 200})
        assert moved["result"] == "done" and moved["axis"] == "hall-2/feeder", moved
        assert b.axis("feeder")["position"] == 7 and a.axis("feeder")["position"] == 0 and c.axis("feeder")["position"] == 0
        until(lambda: fleet(c)["hall-2"]["axes"][0]["position"] == 7, 5, "the third sees it")
        authority = b.axis("feeder")
        assert "dds" in str(b.get("/axes/feeder/authority") if "authority" not in authority else authority["authority"]), authority
        status, refused, _ = a.request("POST", "/api/v1" + path, {"command": "move_absolute", "position": 1e300})
        assert status == 422, (status, refused)
        assert a.request("POST", "/api/v1/fleet/hall-9/axes/feeder/commands", {"command": "enable"})[0] == 404
        client = Client(a, 30)
        assert check(operation("getFleet"), client.request("GET", "/api/v1/fleet"), "the fleet") == 200
        assert check(operation("commandFleetAxis"), client.request("POST", "/api/v1" + path, json.dumps({"command": "halt"}).encode()), "a command") == 200
        # Here it goes the way of every command.
        assert a.send("POST", "/fleet/hall-1/axes/slide/commands?wait=10", {"command": "enable"})["result"] == "done"
        b.process.kill()
        until(lambda: not fleet(a)["hall-2"]["alive"], 10, "its loss within its lease")
        status, gone, _ = a.request("POST", "/api/v1" + path, {"command": "enable"})
        assert status in (404, 409, 503, 504), (status, gone)


def test_without_dds_there_is_no_fleet(gateway):
    assert gateway.get("/fleet") == {"enabled": False, "gateways": []}
