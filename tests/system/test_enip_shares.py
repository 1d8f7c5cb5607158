"""EtherNet/IP between several clients: what one stranger can take from the others, who is connected, and what a change of the site leaves alone.
In: the real program, originators of plain sockets from several addresses of the loopback. Out: answers to Forward_Open, lists, events.
"""
import socket
import struct
import time

from harness import until
from test_enip import Originator, statusword
from test_enip_messages import device, image


class From(Originator):
    """An originator with an address of its own."""

    def __init__(self, own, host, port, io_port):
        self.host, self.io_port, self.session = host, io_port, 0
        self.tcp = socket.create_connection((host, port), timeout=5, source_address=(own, 0))
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.bind((own, 0))
        self.udp.settimeout(1)
        self.session = struct.unpack("<I", self.order(0x65, struct.pack("<HH", 1, 0))[4:8])[0]

    def heartbeat(self, serial, rpi_us=5000, multiplier=7):
        path = bytes([0x20, 0x04, 0x24, 199, 0x2C, 198, 0x2C, 101])
        sockaddr = struct.pack(">HHI8x", 2, self.udp.getsockname()[1], 0)
        data = struct.pack("<BBIIHHIB3xIHIHBB", 10, 14, 0, 0x7000 + serial, serial, 0x4242, 99, multiplier, rpi_us, 0x4800 | 2, 100000, 0x4800 | 34, 1, len(path) // 2) + path
        return self.ask(0x54, bytes([0x20, 6, 0x24, 1]), data, struct.pack("<HH", 0x8001, 16) + sockaddr, 1)[:2]


def test_no_time_out_of_days_and_nobody_keeps_a_place_for_nothing(folder):
    with device(folder) as (g, at), From("127.0.0.9", *at) as stranger:
        assert stranger.heartbeat(1, 0xFFFFFFFF) == (1, (0x0111,)), "25 days"
        assert stranger.heartbeat(1, 60_000_000, 7) == (1, (0x0111,))
        taken = 0
        while taken < 200 and stranger.heartbeat(taken + 1)[0] == 0:
            taken += 1
        assert taken == 96, "a quarter is left for owners"
        with From("127.0.0.1", *at) as plc:
            assert plc.open(151, 101, serial=1000) == (0, ())
            assert plc.heartbeat(1001)[0] == 0, "one that never sent anything gives way to another address"
        stranger.tcp.close()
        until(lambda: not [c for c in g.get("/connections") if c["kind"] == "input_only"], 14, "what was never used is given back")


def test_sessions_of_one_address_leave_room_for_a_controller(folder):
    with device(folder) as (g, at):
        crowd = [From("127.0.0.9", *at) for _ in range(256)]
        try:
            for s in crowd:
                try:
                    s.order(0x04, b"")  # each of them is busy
                except (OSError, AssertionError):
                    pass
            with From("127.0.0.1", *at) as plc:
                assert plc.get(1, 1, 7) == b"\x08axisgate"
                assert plc.open(151, 101) == (0, ())
        finally:
            for s in crowd:
                s.tcp.close()
                s.udp.close()


def test_connections_are_listed_and_closed(folder):
    with device(folder) as (g, at), Originator(*at) as o, g.modbus() as m:
        assert o.open(151, 101) == (0, ())
        o.start(output=bytearray(image(0, mode=1)))
        for word, state in ((6, 0x21), (7, 0x23), (15, 0x27)):
            o.output = bytearray(image(word))
            until(lambda: statusword(o.inputs()) & 0x6F == state, what=f"state {state:#x}")
        o.output = bytearray(image(15, speed=3200))
        until(lambda: g.axis("feeder")["moving"], what="the motion")
        m.read(0, 1)
        listed = {c["kind"]: c for c in g.get("/connections")}
        assert set(listed) == {"session", "exclusive_owner", "modbus_tcp"}, listed
        owner = listed["exclusive_owner"]
        assert owner["axes"] == ["feeder"] and owner["commands"] and owner["peer"].startswith("127.0.0.1:") and owner["door"] == "enip", owner
        status, answer, _ = g.request("DELETE", f"/api/v1/connections/{owner['id']}")
        assert status == 204, answer
        until(lambda: not g.axis("feeder")["moving"], 4, "its loss")
        assert g.axis("feeder")["fail_safe_cause"] == "enip_closed"
        status, answer, _ = g.request("DELETE", f"/api/v1/connections/{owner['id']}")
        assert status == 404, answer
        status, answer, _ = g.request("DELETE", f"/api/v1/connections/{listed['modbus_tcp']['id']}")
        assert status == 204, answer
        assert m.socket.recv(1) == b"", "the Modbus client was closed"
        assert g.request("DELETE", f"/api/v1/connections/{listed['session']['id']}")[0] == 204
        assert o.tcp.recv(1) == b""
        assert len(g.get("/events?kind=connection")) == 3
        o.stop()


def test_a_mapping_of_another_axis_stops_nothing(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        revision = o.get(1, 1, 4)
        assert o.open(151, 101) == (0, ())
        o.start(output=bytearray(image(0, mode=1)))
        for word, state in ((6, 0x21), (7, 0x23), (15, 0x27)):
            o.output = bytearray(image(word))
            until(lambda: statusword(o.inputs()) & 0x6F == state, what=f"state {state:#x}")
        o.output = bytearray(image(15, speed=320))
        until(lambda: g.axis("feeder")["moving"], what="the motion")
        consistency = o.get(1, 1, 9)
        # What a change would close is said before it is applied: of another axis' limits nothing, of this axis' number its owner.
        site = g.get("/site")
        site["axes"][1]["position_max"] = 49
        assert g.send("POST", "/site/stage", site)["closes"] == []
        site["axes"][0]["number"] = 9
        closes = g.send("POST", "/site/stage", site)["closes"]
        assert [(c["kind"], c["axes"]) for c in closes] == [("exclusive_owner", ["feeder"])], closes
        assert [c["id"] for c in g.get("/site/stage")["closes"]] == [closes[0]["id"]] and closes[0]["id"] in {c["id"] for c in g.get("/connections")}
        g.send("DELETE", "/site/stage", None, 204)
        g.send("POST", "/mappings", {"unit": 9, "address": 0, "axis": "slide", "point": "position", "type": "i32"}, 201)
        time.sleep(0.3)
        assert g.axis("feeder")["moving"] and g.axis("feeder")["fail_safe_cause"] is None, g.axis("feeder")
        assert o.get(1, 1, 4) == revision, "the revision is the device's"
        assert o.get(1, 1, 9) != consistency, "the layout's hash is attribute 9"
        until(lambda: statusword(o.inputs()) & 0x6F == 0x27, what="its data go on")
        key = bytes([0x34, 4]) + struct.pack("<HHHBB", 0xFFFF, 0x0C, 1, revision[0], revision[1])
        o.stop()
        until(lambda: not g.axis("feeder")["moving"], 4, "the loss")
        assert o.open(151, 101, serial=5, path_head=key) == (0, ()), "the keyed reopen"
