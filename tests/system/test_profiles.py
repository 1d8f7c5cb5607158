"""Profiles: a unit that speaks another device's language, from outside: a PA-CONTROL's recorded sequence drives another maker's axis, mbpoll
drives it as a Lexium, and the list of registers is told."""
import struct

from harness import Gateway, ModbusException, until
from test_demo import demo

FEEDER = {"axis": "feeder", "velocity": 50, "acceleration": 500}


def put(gateway, unit, language, axes, code=200, **more):
    return gateway.send("PUT", f"/profiles/{unit}", {"language": language, "axes": axes, **more}, code)


def real(value):
    return list(struct.unpack(">HH", struct.pack(">f", value)))


class PaControl:
    """The master of a PA-CONTROL: eight bytes out, eight bytes in, one toggle."""

    def __init__(self, modbus, unit):
        self.modbus, self.unit, self.sf = modbus, unit, 0

    def image(self):
        return self.modbus.read(0, 4, unit=self.unit, function=4)

    def start(self, code, parameter=0, data=(0, 0)):
        self.sf ^= 0x8000
        self.modbus.write(0, [*data, parameter, code | self.sf], unit=self.unit)

    def ask(self, code, parameter=0, data=(0, 0), seconds=20):
        self.start(code, parameter, data)
        last = until(lambda: (i := self.image())[3] & 0x8000 == self.sf and i[3] & 0x6000 and i, seconds, f"end of {code:04X}")
        return last[3] & 0x1FFF if last[3] & 0x4000 else 0, last


def test_a_recorded_sequence_of_a_pa_control_drives_another_makers_axis(gateway):
    put(gateway, 20, "pacontrol", [FEEDER, {"axis": "slide"}])
    with gateway.modbus() as m:
        pa = PaControl(m, 20)
        assert pa.image() == [0, 0, 0, 0]
        assert pa.ask(0x1700, 2) == (0, [0, 2, 1, 0xA000]), "two axes; home position"
        recorded = [  # code, parameter, data, error, operating status
            (0x0800, 0x0106, real(400), 0, 1),
            (0x0A94, 1, real(1), 0x14, 1),
            (0x0603, 0, (0, 0), 0, 31),
            (0x0A97, 1, (0, 0), 0, 31),
            (0x0A83, 1, (0, 0), 0, 31),
            (0x0A85, 1, (0, 0), 0, 31),
            (0x0A87, 1, real(12.5), 0, 31),
            (0x190C, 1, (0, 0), 0, 31),
            (0x0A89, 1, real(-2.5), 0, 31),
            (0x0A87, 3, real(1), 0x20, 31),
            (0x0A9A, 1, (0, 0), 0, 31),
            (0x0A98, 1, (0, 0), 0, 31),
            (0x0A81, 0, (0, 0), 0, 1),
        ]
        for code, parameter, data, error, status in recorded:
            got, image = pa.ask(code, parameter, data)
            assert got == error, f"{code:04X}: error {got:02X}, {[hex(w) for w in image]}"
            assert image[2] & 0xFF == status, f"{code:04X}: {image}"
            if code in (0x0A87, 0x190C) and not error:
                assert image[:2] == real(12.5), image
        axis = gateway.axis()
        assert abs(axis["position"] - 10) < 0.001 and axis["state"] != "operation_enabled", axis
    events = gateway.get("/events?axis=feeder")
    assert any("modbus" in str(e) for e in events), "who it was is known"


def test_eight_axes_of_all_families_are_one_pa_control(folder):
    names = ["feeder", "portal.x", "lift", "turntable", "shuttle", "spindle", "macs.master", "macs.slave"]
    with Gateway(folder, demo()) as g, g.modbus() as m:
        site = g.get("/site")
        family = {d["name"]: d.get("family") or next(x["family"] for x in site["lines"] if x["name"] == d["line"]) for d in site["drives"]}
        drive = {a["name"]: a["drive"] for a in site["axes"]}
        assert len({family[drive[n]] for n in names}) == 6, "every family of the demo"
        put(g, 20, "pacontrol", [{"axis": n, "velocity": 20, "acceleration": 200} for n in names])
        until(lambda: all(g.axis(n)["online"] for n in names), 20, "all of them")
        pa = PaControl(m, 20)
        assert pa.ask(0x1700, 2) == (0, [0, 8, 1, 0xA000]), "eight axes; home position"
        assert pa.ask(0x0603)[0] == 0, "ONLINE"
        until(lambda: all(g.axis(n)["state"] == "operation_enabled" for n in names), 20, "all are on")
        for number, name in enumerate(names, 1):
            assert pa.ask(0x0A84, number, seconds=40)[0] == 0, f"{name}: reference run"
            before = g.axis(name)["position"]
            error, image = pa.ask(0x0A89, number, real(2.5))
            assert error == 0, f"{name}: {error:02X} {image}"
            until(lambda: abs(g.axis(name)["position"] - before - 2.5) < 0.02, 10, f"{name} has gone its way")
        assert pa.ask(0x0A89, 9, real(1))[0] == 0x20, "there is no ninth"


def test_mbpoll_drives_an_axis_as_a_lexium(gateway):
    put(gateway, 21, "lexium", [FEEDER])

    def poll(*arguments, values=()):
        code, text = gateway.mbpoll("-a", "21", *arguments, values=values)
        assert code == 0, text
        return text
    poll("-t", "4", "-r", "28", values=[1])
    until(lambda: "1" in poll("-t", "4", "-r", "28", "-c", "1").split("[28]:")[-1], 5, "DE")
    start = gateway.axis()["position_increments"]
    low, high = (start + 16000) & 0xFFFF, (start + 16000) >> 16 & 0xFFFF
    poll("-t", "4", "-r", "67", values=[low, high])
    until(lambda: gateway.axis()["position_increments"] == start + 16000, 10, "MA")
    with gateway.modbus() as m:
        until(lambda: m.read(74, 1, unit=21) == [0], 5, "MV")
        assert m.read(87, 2, unit=21) == [low, high], "P, low word first"
        try:
            m.write(75, [1], unit=21)
            raise AssertionError("an output that is not there was taken")
        except ModbusException as e:
            assert e.code == 4
        assert m.read(31, 3, unit=21)[0::2] == [1, 37], "EF and ER"


def test_profiles_are_told_changed_and_keep_to_their_units(gateway):
    pages = gateway.get("/profiles")
    assert [l["language"] for l in pages["languages"]] == ["cia402", "lexium", "pacontrol", "linmot"] and pages["profiles"] == []
    ma = next(r for l in pages["languages"] for r in l["registers"] if l["language"] == "lexium" and r["name"] == "MA")
    assert (ma["address"], ma["type"], ma["access"], ma["object"]) == (67, "i32", "W", {"class": 0x66, "attribute": 7})
    put(gateway, 2, "lexium", [FEEDER], 409)
    fault = put(gateway, 22, "lexium", [FEEDER, {"axis": "slide"}], 422)
    assert "axes must be a list of 1 to 1" in str(fault)
    put(gateway, 22, "klingon", [FEEDER], 422)
    put(gateway, 22, "cia402", [{"axis": "nobody"}], 422)
    assert put(gateway, 22, "linmot", [{"axis": "feeder"}])["unit"] == 22
    with gateway.modbus() as m:
        revision = m.read(18, 2)
        assert m.read(0, 2, unit=22, function=4)[0] == 0, "locked"
        gateway.send("POST", "/mappings", {"unit": 22, "table": "holding_registers", "address": 0, "axis": "feeder", "point": "position"}, 409)
        put(gateway, 22, "cia402", [{"axis": "slide"}])
        assert m.read(0, 8, unit=22) == m.read(64, 8, unit=1), "the block of axis 2"
        assert m.read(18, 2) != revision, "the meaning of registers has changed"
        assert gateway.get("/profiles/22")["language"] == "cia402"
        gateway.send("DELETE", "/profiles/22", None, 204)
        try:
            m.read(0, 1, unit=22)
            raise AssertionError("a unit without a map answered")
        except ModbusException as e:
            assert e.code == 0x0A
    gateway.send("DELETE", "/profiles/22", None, 404)
