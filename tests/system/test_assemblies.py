"""Assemblies of a site's own and of profiles, from outside: made and refused over HTTP, read and renewed by a controller, in the data sheet;
a change while a connection is open closes it with its cause. In: the real program. Out: bytes on the wire.
"""
import struct
import time

from harness import until
from test_enip import Originator, device

MANAGER = bytes([0x20, 6, 0x24, 1])
CONFIGURATION = bytes([0x20, 4, 0x24, 199])


class Mapped(Originator):
    """An originator whose assemblies have any size and any instance."""

    def open_pair(self, output, given, sizes, serial=1, rpi_us=5000):
        def point(n):
            return bytes([0x2C, n]) if n < 256 else struct.pack("<BBH", 0x2D, 0, n)
        path = CONFIGURATION + point(output) + point(given)
        sockaddr = struct.pack(">HHI8x", 2, self.udp.getsockname()[1], 0)
        data = struct.pack("<BBIIHHIB3xIHIHBB", 10, 14, 0, 0x7000 + serial, serial, 0x4242, 99, 5, rpi_us, 0x4800 | sizes[0] + 6, rpi_us, 0x4800 | sizes[1] + 2, 1, len(path) // 2) + path
        status, extended, answer = self.ask(0x54, MANAGER, data, struct.pack("<HH", 0x8001, 16) + sockaddr, 1)
        if status == 0:
            self.id = struct.unpack("<I", answer[:4])[0]
        self.size = sizes[1]
        return status, extended

    def inputs(self):
        self.udp.setblocking(False)
        newest, end = None, time.monotonic() + 2
        while time.monotonic() < end:
            try:
                newest = self.udp.recv(2048)
            except BlockingIOError:
                if newest:
                    break
                time.sleep(0.002)
        assert newest and struct.unpack("<HH", newest[14:18]) == (0xB1, self.size + 2), newest
        return newest[20:]


def map_points(g):
    points = [("controlword", 0, "u16"), ("mode", 1, "i16"), ("target_position", 2, "i32"), ("profile_velocity", 4, "u32"), ("profile_acceleration", 6, "u32"),
              ("profile_deceleration", 8, "u32"), ("AC", 10, "u32"), ("statusword", 20, "u16"), ("position", 21, "i32"), ("AC", 23, "u32")]
    for point, address, kind in points:
        g.send("POST", "/mappings", {"unit": 40, "address": address, "axis": "feeder", "point": point, "type": kind}, 201)


def test_a_mapped_pair_moves_an_axis_writes_a_parameter_and_is_closed_by_a_change(folder):
    with device(folder) as (g, at):
        map_points(g)
        g.send("PUT", "/assemblies/300", {"direction": "input", "unit": 40, "address": 20, "registers": 5, "comment": "feeder as the press sees it"})
        g.send("PUT", "/assemblies/310", {"direction": "output", "unit": 40, "registers": 12})
        listed = {a["instance"]: a for a in g.get("/assemblies")["assemblies"]}
        assert [(v["offset"], v["bytes"], v["name"]) for v in listed[300]["values"]] == [(0, 2, "statusword"), (2, 4, "position"), (6, 4, "AC")]
        assert listed[310]["bytes"] == 24 and listed[310]["partner"] == 300 and listed[310]["axes"] == ["feeder"]
        sheet = g.request("GET", "/api/v1/eds")[1]
        sheet = sheet.decode() if isinstance(sheet, bytes) else sheet
        assert "Assem300 = " in sheet and "feeder as the press sees it" in sheet and "Assem310 = " in sheet, sheet[-3000:]
        with Mapped(*at) as o:
            assert o.open_pair(310, 300, (24, 10)) == (0, ())
            o.start(output=bytearray(24))

            def write(word, position=0, velocity=0, ac=0):
                struct.pack_into("<HhiIIII", o.output, 0, word, 1, position, velocity, velocity * 10, velocity * 10, ac)

            def seen():
                return struct.unpack("<HiI", o.inputs())
            for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
                write(word)
                until(lambda: seen()[0] & 0x6F == state, what=f"state {state:#x}")
            target = seen()[1] + 3200
            write(0x0F, target, 3200, 12345)
            until(lambda: seen()[2] == 12345, what="the parameter")
            assert g.get("/axes/feeder/parameters/AC")["value"] == 12345
            assert seen()[1] != target, "a target alone moves nothing"
            write(0x1F, target, 3200, 12345)
            until(lambda: seen()[1] == target, what="the target")
            assert [e for e in g.get("/events?axis=feeder&limit=100") if "AC" in e["text"] and e["door"] == "ethernet_ip"], "who wrote is known"
            with Originator(*at) as second:
                assert second.open(151, 101, serial=2) == (1, (0x0106,)), "one owner of an axis, however it is mapped"
            g.send("PUT", "/assemblies/300", {"direction": "input", "unit": 40, "address": 20, "registers": 3})
            until(lambda: "closed by the gateway: the site was changed" in str(g.get("/events?limit=50")), what="the cause")
            o.stop()
            assert o.open_pair(310, 300, (24, 10), serial=3) == (1, (0x0128, 8)), "and the right size is said"
            assert o.open_pair(310, 300, (24, 6), serial=4) == (0, ())


def test_what_is_wrong_is_refused_with_its_place(folder):
    with device(folder) as (g, _):
        map_points(g)

        def put(instance, code, **entry):
            return str(g.send("PUT", f"/assemblies/{instance}", {"direction": "input", "unit": 40, "address": 20, "registers": 5, **entry}, code))
        assert "taken by axis number 1 to the originator" in put(101, 409)
        assert "taken by the configuration" in put(199, 409)
        assert "cuts mapping" in put(300, 422, registers=2)
        assert "nothing is mapped" in put(300, 422, unit=41)
        assert "nothing to write" in put(300, 422, direction="output", registers=3)
        put(0, 404)
        put(300, 200)
        g.send("PUT", "/profiles/50", {"language": "linmot", "axes": [{"axis": "feeder"}], "input_assembly": 300}, 409)
        mappings = [m["id"] for m in g.get("/mappings") if m["address"] >= 20]
        for m in mappings[:-1]:
            g.send("DELETE", f"/mappings/{m}", None, 204)
        assert "assembly 300 has nothing to show" in str(g.send("DELETE", f"/mappings/{mappings[-1]}", None, 422))
        site = g.get("/site")
        assert site["assemblies"] == [{"instance": 300, "direction": "input", "unit": 40, "table": "holding_registers", "address": 20, "registers": 5}]
        g.send("DELETE", "/assemblies/300", None, 204)
        dry = g.send("PUT", "/site?dry_run=1", site)
        assert "assembly 300: not set ->" in str(dry), dry
        g.send("PUT", "/site", site)
        assert g.get("/assemblies/300")["registers"] == 5


def test_a_lexium_is_spoken_to_by_its_classes_and_a_pa_control_by_its_image(folder):
    with device(folder) as (g, at):
        g.send("PUT", "/profiles/50", {"language": "lexium", "axes": [{"axis": "feeder", "velocity": 50, "acceleration": 500}], "object_instance": 1})
        g.send("PUT", "/profiles/51", {"language": "pacontrol", "axes": [{"axis": "slide", "velocity": 50, "acceleration": 500}], "input_assembly": 211, "output_assembly": 311})
        told = g.get("/profiles")["profiles"]
        assert [(p["unit"], p.get("object_instance"), p.get("output_assembly")) for p in told] == [(50, 1, None), (51, None, 311)]
        with Mapped(*at) as o:
            def path(class_id, attribute):
                return bytes([0x20, class_id, 0x24, 1, 0x30, attribute])

            def get(class_id, attribute):
                status, _, data = o.ask(0x0E, path(class_id, attribute))
                return (status, int.from_bytes(data, "little", signed=True))

            def put(class_id, attribute, value, size=4):
                return o.ask(0x10, path(class_id, attribute), value.to_bytes(size, "little", signed=True))[0]
            assert put(0x64, 3, 1, 2) == 0, "DE"
            until(lambda: get(0x64, 3) == (0, 1), what="power")
            start = get(0x68, 3)[1]
            assert put(0x66, 7, start + 16000) == 0, "MA"
            until(lambda: get(0x68, 3) == (0, start + 16000), what="P")
            assert g.get("/axes/feeder")["position_increments"] == start + 16000
            assert put(0x67, 16, 1, 2) == 0x14, "O1: nothing of the kind"
            assert get(0x65, 3) == (0, 37), "ER"
            assert get(0x66, 7)[0] == 0x2C and put(0x66, 7, 1, 2) == 0x13 and get(0x66, 99)[0] == 0x14

            size = 28
            assert o.open_pair(311, 211, (size, size), serial=5) == (0, ())
            o.start(output=bytearray(size))
            toggle = 0

            def command(code, parameter=0, data=b"\0\0\0\0"):
                nonlocal toggle
                toggle ^= 0x8000
                o.output[0:8] = data + struct.pack(">HH", parameter, code | toggle)
                image = until(lambda: (i := o.inputs()) and (w := struct.unpack(">H", i[6:8])[0]) & 0x8000 == toggle and w & 0x6000 and i, 20, f"end of {code:04X}")
                word = struct.unpack(">H", image[6:8])[0]
                return (word & 0x1FFF if word & 0x4000 else 0), image
            time.sleep(0.05)
            assert command(0x0A94, 1, struct.pack(">f", 1))[0] == 0x14, "only in ONLINE"
            for code in (0x0603, 0x0A97, 0x0A83, 0x0A85):
                assert command(code, 1 if code > 0x0700 else 0)[0] == 0, hex(code)
            error, image = command(0x0A87, 1, struct.pack(">f", 12.5))
            assert error == 0 and struct.unpack(">f", image[:4])[0] == 12.5, image
            assert abs(g.get("/axes/slide")["position"] - 12.5) < 0.02
            o.stop()
