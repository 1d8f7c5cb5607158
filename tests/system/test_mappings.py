"""Own maps: what the page or a script puts at an address, a Modbus client reads there, in every type and word order; and writes it."""
import struct

from harness import DEMO, Gateway, ModbusException, until


def registers(data):
    return list(struct.unpack(f">{len(data) // 2}H", data))


def swapped(words):
    return list(reversed(words))


def add(gateway, **entry):
    return gateway.send("POST", "/mappings", entry, 201)


def test_every_type_and_word_order_shows_what_was_promised(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_absolute", "position": 3, "velocity": 20, "acceleration": 100, "deceleration": 100})
    position = gateway.axis()["position_increments"]
    assert position == 9600
    forms = {"i16": ">h", "u16": ">H", "i32": ">i", "u32": ">I", "i64": ">q", "u64": ">Q", "f32": ">f", "f64": ">d"}
    address, expected = 0, {}
    for kind, form in forms.items():
        for order in ("high_first", "low_first"):
            add(gateway, unit=7, table="holding_registers", address=address, axis="feeder", point="position", type=kind, word_order=order)
            words = registers(struct.pack(form, position))
            expected[address] = words if order == "high_first" else swapped(words)
            address += len(words)
    add(gateway, unit=7, table="input_registers", address=5, axis="feeder", point="position_units", type="f32")
    add(gateway, unit=7, table="input_registers", address=7, axis="feeder", point="position", type="i16", scale=0.1, offset=-60)
    add(gateway, unit=7, table="discrete_inputs", address=9, axis="feeder", point="online")
    add(gateway, unit=7, table="discrete_inputs", address=10, axis="feeder", point="fault")
    with gateway.modbus() as m:
        for at, words in expected.items():
            assert m.read(at, len(words), unit=7) == words, at
        assert m.read(0, address, unit=7) == [w for words in expected.values() for w in words], "all in one request"
        assert m.read(5, 3, unit=7, function=4) == registers(struct.pack(">f", 3.0)) + [900]
        assert m.pdu(struct.pack(">BHH", 2, 9, 2), unit=7) == b"\x02\x01\x01"
    code, text = gateway.mbpoll("-a", "7", "-t", "4:int", "-B", "-0", "-r", "4", "-c", "1")
    assert code == 0 and "9600" in text, text


def test_a_parameter_is_read_and_written_behind_an_address(gateway):
    add(gateway, id="acceleration", unit=8, address=100, axis="feeder", point="AC", type="u32", word_order="low_first")
    with gateway.modbus() as m:
        def value():
            try:
                low, high = m.read(100, 2, unit=8)
                return high << 16 | low
            except ModbusException as e:
                assert e.code == 6, "not known yet"
                return None
        until(lambda: value() == gateway.get("/axes/feeder/parameters/AC")["value"], 5, "the parameter's value")
        m.write(100, [34567, 0], unit=8)
        assert gateway.get("/axes/feeder/parameters/AC")["value"] == 34567, "answered when the drive has it"
        until(lambda: value() == 34567, 5, "read back")
        gateway.send("PUT", "/axes/feeder/parameters/AC", {"value": 45678})
        until(lambda: value() == 45678, 5, "what another door wrote")
        try:
            m.write(100, [0, 0], unit=8)
            assert False, "0 is out of range"
        except ModbusException as e:
            assert e.code == 3
        try:
            m.write(100, [1], unit=8)
            assert False, "half of a value"
        except ModbusException as e:
            assert e.code == 3


def test_the_map_is_the_sites_and_its_revision_is_shown(gateway):
    with gateway.modbus() as m:
        before = m.read32(18, signed=False)
        entry = add(gateway, unit=9, address=0, axis="feeder", point="statusword", type="u16")
        assert m.read32(18, signed=False) != before
        assert m.read(0, 1, unit=9) == m.read(0, 1)
        refused = gateway.send("POST", "/mappings", {"unit": 9, "address": 0, "axis": "feeder", "point": "flags", "type": "u16"}, 409)
        assert entry["id"] in refused["detail"]
        gateway.request("DELETE", f"/api/v1/mappings/{entry['id']}")
        try:
            m.read(0, 1, unit=9)
            assert False, "the unit is gone"
        except ModbusException as e:
            assert e.code == 0x0A
        assert m.read32(18, signed=False) == before


def test_a_template_reads_like_the_standard_map_and_the_audit_says_what_changed(gateway):
    made = gateway.send("POST", "/mappings/template", {"template": "standard_map", "axis": "slide", "unit": 2}, 201)["mappings"]
    assert made[0]["address"] == 64 and gateway.get("/mappings/next-free?unit=2&words=64")["address"] == 128
    with gateway.modbus() as m:
        own, standard = m.read(64, 20, unit=2), m.read(64, 20)
        quiet = [i for i in range(20) if i not in (12, 13, 14)]  # the age and the heartbeat count on between the two reads
        assert [own[i] for i in quiet] == [standard[i] for i in quiet] and own[15] == 1, (own, standard)
        assert 0 <= standard[14] - own[14] <= 1 and own[14] > 0
        assert m.read(64 + 32, 13, unit=2) == m.read(64 + 32, 13)
    gateway.send("PUT", "/mappings/m1", {"unit": 2, "table": "holding_registers", "address": 8, "axis": "feeder", "point": "position", "type": "i32"})
    said = [e["text"] for e in gateway.get("/events?kind=site")][-1]
    assert "mapping m1 (unit 2 holding_registers 0, feeder.position): address 0 -> 8" in said, said
    gateway.send("DELETE", "/mappings/m1", None, 204)
    assert "mapping m1 (unit 2 holding_registers 8, feeder.position): removed" in [e["text"] for e in gateway.get("/events?kind=site")][-1]


def exception_of(ask):
    try:
        ask()
    except ModbusException as e:
        return e.code
    return None


def test_gaps_read_zero_unless_the_unit_refuses_them_and_the_event_names_the_address(folder):
    with Gateway(folder, DEMO) as gateway:
        add(gateway, id="gap-a", unit=11, address=10, axis="feeder", point="statusword", type="u16")
        add(gateway, id="gap-b", unit=11, address=14, axis="feeder", point="position", type="i32")
        with gateway.modbus() as m:
            block = m.read(0, 40, unit=11)
            assert [i for i, w in enumerate(block) if w and i not in (10, 14, 15)] == [] and block[10] != 0, block
            assert exception_of(lambda: m.read(20, 4, unit=11)) == 2, "nothing that can be read is touched"
            assert exception_of(lambda: m.write(11, [1], unit=11)) == 2
            gateway.send("PUT", "/mappings/units/11", {"gaps": "refuse"})
            assert exception_of(lambda: m.read(10, 2, unit=11)) == 2 and m.read(10, 1, unit=11)
            text = until(lambda: [e["text"] for e in gateway.get("/events?kind=refused") if "holding registers 10..11" in e["text"]], 5, "the event")[-1]
            assert "nothing is mapped at address 11" in text and "exception 2" in text, text
            site = gateway.get("/site")
            assert site["modbus_units"] == [{"unit": 11, "gaps": "refuse"}]
            gateway.send("PUT", "/mappings/units/11", {"gaps": None})
            assert "modbus_units" not in gateway.get("/site") and len(m.read(10, 2, unit=11)) == 2
        assert gateway.send("DELETE", "/mappings?unit=11", None)["removed"] == ["gap-a", "gap-b"]


def test_a_refusal_leaves_its_sentence_and_a_number_in_the_axis_block(folder):
    with Gateway(folder, DEMO) as gateway:
        with gateway.modbus() as m:
            before = m.read(21, 1)[0]
            gateway.command("feeder", {"command": "disable"})
            assert exception_of(lambda: m.write(33, [9])) is not None, "there is no mode 9"
            reason, count = m.read(20, 2)
            assert reason != 0 and count == before + 1
            event = until(lambda: [e for e in gateway.get("/events?kind=refused&axis=feeder") if "register 33 = 9" in e["text"]], 5, "the event")[-1]
            assert event["door"] == "modbus" and event["who"].startswith("127.0.0.1:") and event["severity"] == "warning", event


def test_a_number_beyond_single_precision_is_no_value_of_an_f32_parameter(folder):
    """By a user mapping, as an f64 that the register holds; and by the parameter channel's float form, where infinity is the nearest to it."""
    site = {"lines": [{"name": "com1", "uri": "twin", "family": "pacontrol"}], "drives": [{"name": "portal", "line": "com1", "address": "com1", "presence": "twin"}],
            "axes": [{"name": "x", "drive": "portal", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}
    with Gateway(folder, site) as gateway:
        until(lambda: gateway.axis("x")["online"], 10, "the twin serves")
        add(gateway, unit=9, address=0, axis="x", point="R[1]", type="f64", access="read_write")
        selector = gateway.get("/axes/x/parameters/R%5B1%5D")["selector"]
        assert next(p for p in gateway.get("/families/pacontrol/parameters") if p["id"] == "R")["type"] == "f32"
        with gateway.modbus() as m:
            def channel(request, single):
                m.write32(48, selector | 1 << 31)
                m.write(52, registers(struct.pack(">f", single)))
                m.write1(50, request)
                until(lambda: m.read(51, 1)[0] in (2, 3), 10, "the channel's answer")
                return m.read(51, 1)[0], struct.unpack(">f", struct.pack(">HH", *m.read(52, 2)))[0], m.read(54, 1)[0]
            m.write(0, registers(struct.pack(">d", 2.5)), unit=9)
            assert gateway.get("/axes/x/parameters/R%5B1%5D")["value"] == 2.5
            for beyond in (1e300, -1e300, 3.5e38):
                assert exception_of(lambda v=beyond: m.write(0, registers(struct.pack(">d", v)), unit=9)) == 3, beyond
            assert channel(1, 0.0)[:2] == (2, 2.5), "nothing of it has reached the drive"
            assert channel(2, 7.25)[:2] == (2, 7.25)
            state, _, reason = channel(2, float("inf"))
            assert (state, reason) == (3, 1), "refused as out of range, with the drive untouched"
            assert gateway.get("/axes/x/parameters/R%5B1%5D")["value"] == 7.25
