"""EtherNet/IP controllers that command by messages, and those that own an axis: what becomes of the axis when they are gone, what they are answered, and
whom the axis obeys meanwhile. In: the real program, an originator of plain sockets. Out: answers, axis states, register 22, events.
"""
import contextlib
import socket
import struct
import time

from harness import DEMO, Gateway, ModbusException, until
from test_enip import Originator, statusword

WATCHDOG_MS = 600
ASSEMBLY = bytes([0x20, 4, 0x24])


@contextlib.contextmanager
def device(folder, site=DEMO, *more):
    folder.mkdir(exist_ok=True)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        io_port = s.getsockname()[1]
    with Gateway(folder, site, "--set", f"enip.io_port={io_port}", "--set", f"modbus.watchdog_ms={WATCHDOG_MS}", *more) as g:
        host, port = g.word("enip").rsplit(":", 1)
        until(lambda: g.axis("feeder")["online"], 10, "online")
        yield g, (host, int(port), io_port)


def image(word, mode=3, speed=0, target=0, velocity=3200):
    return struct.pack("<HhiIIIih", word, mode, target, velocity, 32000, 32000, speed, 0) + bytes(6)


def write(o, data, instance=151):
    """(general status, extended words)"""
    return o.ask(0x10, ASSEMBLY + bytes([instance, 0x30, 3]), data)[:2]


class Class3:
    """A connection of explicit messages of an originator's session."""

    def __init__(self, o, serial=7):
        path = bytes([0x20, 2, 0x24, 1])
        data = struct.pack("<BBIIHHIB3xIHIHBB", 10, 14, 0, 0x9000, serial, 0x4242, 99, 2, 1000000, 0x4200 | 500, 1000000, 0x4200 | 500, 0xA3, 2) + path
        status, extended, answer = o.ask(0x54, bytes([0x20, 6, 0x24, 1]), data)
        assert status == 0, (status, extended)
        self.o, self.id, self.count = o, struct.unpack("<I", answer[:4])[0], 0

    def ask(self, service, path, data=b""):
        self.count += 1
        message = struct.pack("<H", self.count) + bytes([service, len(path) // 2]) + path + data
        answer = self.o.order(0x70, struct.pack("<IHHHHIHH", 0, 0, 2, 0xA1, 4, self.id, 0xB1, len(message)) + message)
        body = answer[46:]
        return body[2], struct.unpack(f"<{body[3]}H", body[4:4 + 2 * body[3]]), body[4 + 2 * body[3]:]


def by_assembly(g, o):
    for word in (6, 7, 15):
        assert write(o, image(word)) == (0, ())
        until(lambda: statusword(o.get(4, 101, 3)) & 0x6F == {6: 0x21, 7: 0x23, 15: 0x27}[word], what=f"word {word}")
    assert write(o, image(15, speed=3200)) == (0, ())


def by_connected_messages(g, o):
    by_assembly(g, type("Over", (), {"ask": staticmethod(Class3(o).ask), "get": o.get})())


def by_classes_of_a_lexium(g, o):
    g.send("PUT", "/profiles/50", {"language": "lexium", "axes": [{"axis": "feeder", "velocity": 50, "acceleration": 500}], "object_instance": 1})

    def put(name, value):
        rows = next(p for p in g.get("/profiles")["languages"] if p["language"] == "lexium")["registers"]
        row = next(r for r in rows if r["name"] == name)
        klass, attribute = row["object"]["class"], row["object"]["attribute"]
        size = {"u16": "<H", "i16": "<h", "u32": "<I", "i32": "<i"}[row["type"]]
        assert o.ask(0x10, bytes([0x20, klass, 0x24, 1, 0x30, attribute]), struct.pack(size, value))[0] == 0, (name, value)
    put("DE", 1)
    put("SL", 3200)


WAYS = (by_assembly, by_connected_messages, by_classes_of_a_lexium)


def stands_for(g, cause):
    until(lambda: not g.axis("feeder")["moving"], 4, f"the stop of {cause}")
    axis = g.axis("feeder")
    assert axis["fail_safe_cause"] == cause, axis
    events = g.get("/events?kind=fail_safe")
    assert len(events) == 1 and "ethernet_ip 127.0.0.1" in events[0]["text"], events
    with g.modbus() as m:
        assert m.read(22, 1) == [{"enip_session_closed": 11, "enip_silent": 12}[cause]]


def test_a_session_that_ends_ends_what_was_commanded_by_it(folder):
    for way in WAYS:
        with device(folder / way.__name__) as (g, at):
            with Originator(*at) as o, Originator(*at) as other:
                way(g, o)
                until(lambda: g.axis("feeder")["moving"], what=f"{way.__name__}: the motion")
                other.get(1, 1, 7)  # another session of the same address has nothing to do with it
                o.tcp.close()
                stands_for(g, "enip_session_closed")


def test_a_session_that_goes_on_without_a_word_is_a_lost_client(folder):
    for way in WAYS:
        with device(folder / way.__name__) as (g, at), Originator(*at) as o:
            way(g, o)
            until(lambda: g.axis("feeder")["moving"], what="the motion")
            end = time.monotonic() + 2 * WATCHDOG_MS / 1000
            while time.monotonic() < end:  # whoever asks is there
                o.get(4, 101, 3)
                time.sleep(0.1)
            assert g.axis("feeder")["moving"], "it was there all the time"
            stands_for(g, "enip_silent")


def test_a_command_and_goodbye_in_one_breath(folder):
    with device(folder) as (g, at):
        with Originator(*at) as o:
            for word in (6, 7, 15):
                assert write(o, image(word)) == (0, ())
                until(lambda: statusword(o.get(4, 101, 3)) & 0x6F == {6: 0x21, 7: 0x23, 15: 0x27}[word], what=f"word {word}")
            data = image(15, speed=3200)
            message = bytes([0x10, 3]) + ASSEMBLY + bytes([151, 0x30, 3]) + data
            body = struct.pack("<IHHHHHH", 0, 0, 2, 0, 0, 0xB2, len(message)) + message
            o.tcp.sendall(struct.pack("<HHII8sI", 0x6F, len(body), o.session, 0, b"originat", 0) + body)
            o.tcp.shutdown(socket.SHUT_RDWR)
            o.tcp.close()
        until(lambda: g.get("/events?kind=fail_safe") or g.axis("feeder")["moving"], 5, "the command was taken")
        until(lambda: not g.axis("feeder")["moving"], 4, "the stop")
        time.sleep(0.5)
        assert not g.axis("feeder")["moving"], g.axis("feeder")


def test_a_written_output_is_answered_by_what_became_of_it(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        for word in (6, 7, 15):
            assert write(o, image(word, mode=1)) == (0, ())
            until(lambda: statusword(o.get(4, 101, 3)) & 0x6F == {6: 0x21, 7: 0x23, 15: 0x27}[word], what=f"word {word}")
        assert write(o, image(15, mode=99))[0] == 0x09, "a mode that no drive has"
        assert write(o, image(31, mode=1, target=3200, velocity=0))[0] == 0x09, "a set-point without a speed"
        assert write(o, image(15, mode=1)) == (0, ())
        g.send("PUT", "/axes/feeder/authority", {"ttl_s": 30})
        status, extended = write(o, image(31, mode=1, target=3200))
        assert status == 0x0C and len(extended) == 1, (status, extended)
        assert write(o, image(0, mode=1)) == (0, ()), "a stop always"
        until(lambda: g.axis("feeder")["state"] == "switch_on_disabled", what="switched off")
        assert g.axis("feeder")["position_increments"] == 0
        s, _, answer = o.ask(0x0A, bytes([0x20, 2, 0x24, 1]), struct.pack("<HH", 1, 4) + bytes([0x10, 3]) + ASSEMBLY + bytes([151, 0x30, 3]) + image(31, mode=1, target=3200))
        assert s == 0x1E and answer[6] == 0x0C, "the same in a Multiple_Service_Packet"


def test_zeros_of_an_owner_switch_off_what_was_on(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        assert g.command("feeder", {"command": "enable"})["result"] == "done"
        assert o.open(151, 101) == (0, ())
        o.start()
        until(lambda: g.axis("feeder")["state"] == "switch_on_disabled", 4, "the zeros of the first image")
        o.run = 0
        time.sleep(0.1)
        assert g.command("feeder", {"command": "enable"})["result"] == "done"
        o.run = 1
        until(lambda: g.axis("feeder")["state"] == "switch_on_disabled", 4, "the zeros after idle")


def test_an_owner_in_run_mode_holds_its_axis(folder):
    with device(folder) as (g, at), Originator(*at) as o, g.modbus() as m:
        assert o.open(151, 101) == (0, ())
        o.start(output=bytearray(image(0, mode=1)))
        until(lambda: m.read(17, 1) == [2], 4, "register 17: EtherNet/IP")
        assert g.get("/axes/feeder/authority")["holder"].endswith("assembly 151"), g.get("/axes/feeder/authority")
        s, answer, _ = g.request("POST", "/api/v1/axes/feeder/commands", {"command": "enable"})
        assert s == 409 or answer.get("result") == "refused", (s, answer)
        s, answer, _ = g.request("PUT", "/api/v1/axes/feeder/authority", {"ttl_s": 5})
        assert s == 409, (s, answer)
        try:
            m.write1(32, 6)
            raise AssertionError("Modbus commands beside the owner")
        except ModbusException:
            pass
        for word, state in ((6, 0x21), (7, 0x23), (15, 0x27)):
            o.output = bytearray(image(word))
            until(lambda: statusword(o.inputs()) & 0x6F == state, what=f"state {state:#x}")
        o.output = bytearray(image(15, speed=3200))
        until(lambda: g.axis("feeder")["moving"], what="the motion")
        assert g.command("feeder", {"command": "halt"})["result"] in ("done", "accepted"), "a stop of others"
        until(lambda: not g.axis("feeder")["moving"], what="the stop")
        o.run = 0
        until(lambda: m.read(17, 1) != [2] or g.get("/axes/feeder/authority")["holder"] == "", 4, "idle lets go")
        assert g.command("feeder", {"command": "disable"})["result"] == "done"
        assert g.command("feeder", {"command": "enable"})["result"] == "done", "free again"
