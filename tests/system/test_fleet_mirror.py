"""An HMI at one gateway and axes of others in its registers: three gateways in networks of their own, mbpoll and plain sockets at the first.

In: the program; root's rights for namespaces. Out: nothing beside the test's folder. Never asks hall-2 for what hall-1 should show.
"""
import copy
import re
import signal
import time

from harness import DEMO, until
from test_fleet_network import complete, fleet, member, plant_of
from test_round import pair

BASE = 19 * 64  # registers of axis 20


def mirroring(*addresses, uri="dds"):
    """The demo site with these axes of others as its own from number 20 on."""
    site = copy.deepcopy(DEMO)
    site["lines"].append({"name": "plant", "uri": uri, "family": "remote"})
    for n, address in enumerate(addresses, 20):
        name = address.replace("/", ".")
        site["drives"].append({"name": name, "line": "plant", "address": address, "presence": "device"})
        site["axes"].append({"name": name, "drive": name, "number": n, "unit": "mm", "increments_per_unit": 3200})
    return site


def mirrored(g, name="hall-2.feeder"):
    return g.axis(name)


def up(g, name="hall-2.feeder", limit=20):
    until(lambda: mirrored(g, name)["online"] and not mirrored(g, name)["stale"], limit, f"{name} is seen")


def test_an_hmi_at_one_gateway_reads_and_moves_an_axis_of_another(folder):
    with plant_of(mirroring("hall-2/feeder", "hall-3/feeder"), DEMO, DEMO) as (plant, g):
        complete(plant, g)
        with plant.places[0].inside():
            up(g[0])
            up(g[0], "hall-3.feeder")
            seen = mirrored(g[0])
            assert seen["simulated"] and seen["presence"] == "device" and seen["state"] == "switch_on_disabled", seen
            code, text = g[0].mbpoll("-t", "4", "-r", str(BASE + 9), "-c", "1")
            assert code == 0 and int(re.search(r"\]:\s*(\d+)", text).group(1)) & 0b111 == 0b011, text  # online, simulated, not stale
            # Enable and position by registers, as an HMI does.
            for word in (0x06, 0x07, 0x0F):
                code, text = g[0].mbpoll("-t", "4", "-r", str(BASE + 32), values=[word])
                assert code == 0, text
            with g[0].modbus() as m:
                m.write(BASE + 32, [0x1F, 1, *pair(16000), *pair(20000), *pair(100000), *pair(100000)])
                until(lambda: m.read(BASE, 1)[0] & 0x400, 20, "target reached")
            code, text = g[0].mbpoll("-t", "4:int", "-r", str(BASE + 2), "-c", "1")
            assert "16000" in text, text
            assert g[0].axis("feeder")["position"] == 0, "its own feeder stood"
            assert g[0].get("/axes/hall-2.feeder/parameters/UNIT")["value"] == "mm"
            # Until it is done, over HTTP; what the other one refuses comes back as refused.
            assert g[0].command("hall-2.feeder", {"command": "move_absolute", "position": 1, "velocity": 30, "acceleration": 200, "deceleration": 200})["result"] == "done"
            status, refused, _ = g[0].request("POST", "/api/v1/axes/hall-2.feeder/commands?wait=10", {"command": "home", "method": 99})
            assert status in (409, 422) and refused["result"] == "refused" and "99" in refused["detail"], (status, refused)
            assert g[0].command("hall-2.feeder", {"command": "quick_stop"})["result"] == "done"
            assert mirrored(g[0])["state"] == "quick_stop_active"
            assert g[0].command("hall-2.feeder", {"command": "disable"})["result"] == "done"
            assert mirrored(g[0], "hall-3.feeder")["state"] == "switch_on_disabled", "the third's stood"
        with plant.places[1].inside():
            there = g[1].axis("feeder")
            assert there["position"] == 1 and there["state"] == "switch_on_disabled", there
            assert "hall-1 mirror" in str(g[1].get("/events?limit=200")), "who it was is written down there"
        with plant.places[2].inside():
            assert "remote" in [a["family"] for a in fleet(plant, g, 2)["hall-1"]["axes"]], fleet(plant, g, 2)["hall-1"]
            assert g[2].axis("feeder")["position"] == 0


def test_a_gateway_that_is_killed_takes_its_mirrored_axis_offline_and_nothing_moves_when_it_is_back(folder):
    with plant_of(mirroring("hall-2/feeder"), DEMO) as (plant, g):
        complete(plant, g)
        with plant.places[0].inside():
            up(g[0])
            g[0].command("hall-2.feeder", {"command": "enable"})
            g[0].command("hall-2.feeder", {"command": "move_absolute", "position": 40, "velocity": 5}, wait=0)
            until(lambda: mirrored(g[0])["moving"], 5, "it moves")
        g[1].process.send_signal(signal.SIGKILL)
        g[1].process.wait()
        begun = time.monotonic()
        with plant.places[0].inside():
            until(lambda: not mirrored(g[0])["online"], 10, "offline")
            assert time.monotonic() - begun < 4, "within the lease of 2 s, and as long as its last word waited"
            with g[0].modbus() as m:
                assert m.read(BASE + 9, 1)[0] & 0b101 == 0b100, "the registers say offline and stale"
            status, answer, _ = g[0].request("POST", "/api/v1/axes/hall-2.feeder/commands?wait=10", {"command": "enable"})
            assert status in (503, 504) and "hall-2" in str(answer), (status, answer)
        with plant.places[1].inside(), member(g[1].folder, "hall-2") as back:
            with plant.places[0].inside():
                up(g[0], limit=30)
            place = back.axis("feeder")["position"]
            time.sleep(3)
            now = back.axis("feeder")
            assert now["position"] == place and not now["moving"] and now["state"] == "switch_on_disabled", now
        with plant.places[0].inside():
            gone = [e["text"] for e in g[0].get("/events?limit=300") if "hall-2" in e["text"] and "gone" in e["text"]]
            assert gone, "why is told"


def test_a_velocity_move_through_a_mirror_ends_when_the_cable_is_cut(folder):
    with plant_of(mirroring("hall-2/feeder"), DEMO) as (plant, g):
        complete(plant, g)
        with plant.places[0].inside():
            up(g[0])
            g[0].command("hall-2.feeder", {"command": "enable"})
            g[0].command("hall-2.feeder", {"command": "move_velocity", "velocity": 3})
            time.sleep(5)
            assert mirrored(g[0])["moving"], "it is renewed from here for as long as it goes on"
        plant.cut(0)
        with plant.places[1].inside():
            begun = time.monotonic()
            until(lambda: not g[1].axis("feeder")["moving"], 8, "halted there")
            assert time.monotonic() - begun < 4, "2 s after the last renewal, and its ramp"
            assert g[1].axis("feeder")["state"] == "operation_enabled"
            place = g[1].axis("feeder")["position"]
        with plant.places[0].inside():
            until(lambda: not mirrored(g[0])["online"], 10, "offline here")
        plant.join(0)
        with plant.places[0].inside():
            up(g[0], limit=30)
        time.sleep(2)
        with plant.places[1].inside():
            assert g[1].axis("feeder")["position"] == place, "nothing goes on because the cable is joined"


def test_a_mirror_of_a_mirror_stays_offline_and_says_so(folder):
    with plant_of(mirroring("hall-2/feeder"), mirroring("hall-1/hall-2.feeder", "hall-2/feeder")) as (plant, g):
        with plant.places[0].inside():
            up(g[0])
        with plant.places[1].inside():
            def why(name):
                return g[1].get(f"/drives/{name}")["status"]["text"]
            until(lambda: "is a mirror itself" in why("hall-1.hall-2.feeder"), 20, "a circle is refused")
            assert "is an axis of this gateway" in why("hall-2.feeder"), why("hall-2.feeder")
            assert not g[1].axis("hall-1.hall-2.feeder")["online"] and not g[1].axis("hall-2.feeder")["online"]


def test_a_site_says_what_a_mirror_line_takes(gateway):
    wrong = mirroring("hall-2/feeder")
    wrong["drives"][-1]["presence"] = "auto"
    answer = gateway.send("PUT", "/site", wrong, 422)
    assert "an axis of another gateway is that axis, or nothing" in str(answer), answer
    wrong["drives"][-1].update(presence="device", address="feeder")
    assert "GATEWAY/AXIS" in str(gateway.send("PUT", "/site", wrong, 422))
    wrong = mirroring("hall-2/feeder")
    wrong["lines"][-1]["family"] = "uim342"
    assert "does not speak on dds" in str(gateway.send("PUT", "/site", wrong, 422))
    for uri in ("serial:/dev/ttyUSB0", "tcp:127.0.0.1:1", "can:can0"):
        assert "speaks on dds alone" in str(gateway.send("PUT", "/site", mirroring("hall-2/feeder", uri=uri), 422)), uri
    # Without [dds] it is a line that is down, and says why.
    gateway.send("PUT", "/site", mirroring("hall-2/feeder"))
    until(lambda: "in no fleet" in str(gateway.get("/lines")), 5, "why the line is down")
    assert not gateway.axis("hall-2.feeder")["online"]
