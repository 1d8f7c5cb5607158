"""The dissectors of deploy/wireshark in tshark: every golden frame of the families, what was cut up, what is strange, and traces of a running gateway.

In: vectors, the program's `decode` and traces. Out: named fields, held against the words of `decode`.
"""
import json
import re

import captures
import harness
from captures import dissect, messages, vectors, write
from test_documents import DEMO

SCRIPTS = {"uim342": "uimessage", "mcode": "mcode", "pacontrol": "pacontrol", "linmot": "linrs"}


def decoded(family, packets, folder):
    """The sentences of `axisgate decode`, one per message."""
    path = folder / f"{family}.hex"
    path.write_text("".join(f"{'>' if to_drive else '<'} {data.hex(' ')}\n" for to_drive, data in packets))
    return harness.run("decode", family, str(path), "--format", "hex", check=0)[1].splitlines()


def dissected(family, packets, folder):
    path = folder / f"{family}.pcapng"
    write(path, captures.USER0, packets)
    return dissect(path)


def pairs(family, folder):
    packets = vectors(family)
    assert len(packets) > 20, family
    made = messages(dissected(family, packets, folder), SCRIPTS[family])
    told = [s for s in decoded(family, packets, folder) if "  unknown: " not in s or family == "mcode"]
    assert len(made) == len(told), (len(made), len(told))
    return list(zip(made, told))


def test_the_names_are_those_of_the_catalogues(folder):
    captures.make_names(folder)
    names = (folder / "axisgate_names.lua").read_text()
    for family in ("uim342", "pacontrol", "linmot"):
        errors = json.loads((captures.TOP / f"schema/families/{family}.json").read_text())["errors"]
        assert len(errors) > 10, family
        for e in (e for e in errors if e["kind"] != "notification"):
            assert json.dumps(e["text"], ensure_ascii=False) in names, (family, e["text"])


def instruction_agrees(m, told):
    name, index, form, value = m["uim342.instruction"], m["uim342.index"], m["uim342.form"], m["uim342.value"]
    if name is None:
        assert "unknown control word" in told or "not an answer" in told, told
        return
    asked = name + (f"[{index}]" if index is not None and name != "RT" else "")
    if form == "answer" and m.number("uim342.error"):
        assert f"0x{m.number('uim342.error'):02X}" in told, (told, m.fields)
        assert name == "RT" or m["uim342.error.about"] in told, (told, m.fields)
    elif name != "RT" and "length that the manual does not have" not in told:
        assert re.search(rf"\b{re.escape(asked)}(?![\w\[])", told), (asked, told)
    if form == "set" and value is not None and name not in ("IL", "TG") and "length" not in told:
        assert f"{asked}={value}" in told, (told, m.fields)
    if form == "answer" and value is not None and " = " in told and name not in ("IL", "TG", "DI"):
        assert f"{asked} = {value}" in told, (told, m.fields)
    if m["uim342.status.on"] is not None:
        assert ("driver on" in told) == (m["uim342.status.on"] in ("1", "True")), (told, m.fields)
        assert ("stationary" in told) == (m["uim342.status.stationary"] in ("1", "True")), (told, m.fields)
    if m["uim342.speed"] is not None:
        assert f"speed {m['uim342.speed']}, position {m['uim342.position']}" in told, told


def test_uimessage_says_what_decode_says(folder):
    for m, told in pairs("uim342", folder):
        assert {"ID to d8": "CRC good, ID to d8", "AA to d8": "CRC good, AA to d8", "nothing": "no CRC"}[m["uimessage.check.covers"]] in told, (told, m.fields)
        assert re.search(rf"(to|from) {'all' if m['uimessage.id'] == '0' else m['uimessage.id']}  ", told), (told, m.fields)
        instruction_agrees(m, told)


def test_simplecan_says_what_decode_says(folder):
    frames = list(captures.can_vectors())
    assert len(frames) > 400
    path = folder / "can.pcapng"
    write(path, captures.SOCKETCAN, [(d, captures.can_packet(i, data)) for d, i, data in frames])
    made = dissect(path)
    log = folder / "can.log"
    log.write_text("".join(f"(1.{n:06d}) can0 {i:08X}#{data.hex()}\n" for n, (_, i, data) in enumerate(frames)))
    told = harness.run("decode", "uim342", str(log), check=0)[1].splitlines()
    assert len(made) == len(told) == len(frames)
    for packet, said in zip(made, told):
        (m,) = [x for x in packet if x.protocol == "simplecan"]
        words = {0: "all", 4: "host"}
        a, b = m.number("simplecan.producer"), m.number("simplecan.consumer")
        assert f"{words.get(a, a)} -> {words.get(b, b)}  " in said, (said, m.fields)
        instruction_agrees(m, said)


def test_pacontrol_says_what_decode_says(folder):
    seen = set()
    for m, told in pairs("pacontrol", folder):
        if m["pacontrol.poll"] is not None:
            assert "poll: asks" in told, told
            continue
        form = m["pacontrol.check.form"]
        seen.add(form)
        assert re.search({"good": r"check \d+ good\]", "not used": "not used", "as for the other direction": "as for the other direction", "wrong": "wrong,"}[form], told), (told, m.fields)
        if m["pacontrol.command"] is not None:
            assert f"  {m.number('pacontrol.command'):04X} " in told, (told, m.fields)
            assert m["pacontrol.command.name"] in told, (told, m.fields)
        elif m["pacontrol.status"] is not None:
            assert f"operating status {m['pacontrol.status']} " in told and f", {m['pacontrol.data']};" in told, (told, m.fields)
            assert (m["pacontrol.quit"] != "0") == ("command error " + m["pacontrol.quit"] in told), (told, m.fields)
            assert m["pacontrol.error"] == "0" or f"E{m['pacontrol.error']}" in told, (told, m.fields)
        else:
            raise AssertionError(f"neither request nor answer: {told}")
    assert {"good", "wrong", "as for the other direction"} <= seen, seen


def test_mcode_says_what_decode_says(folder):
    for m, told in pairs("mcode", folder):
        sentence = told[3:]
        if m["mcode.checksum"] is not None:
            good = m["mcode.checksum.good"] in ("1", "True")
            assert f" [checksum {m.number('mcode.checksum'):02X} {'good' if good else 'wrong'}]" in sentence, (told, m.fields)
        # The file begins in each direction once: a dissector does not know where, and says nothing of it.
        bare = re.sub(r" \[checksum .. (good|wrong)\]|  \(not ended\)|  \(first in the recording: perhaps only the end of a line\)"
                      r"|  unknown: bytes that are no MCode", "", sentence)
        if m["mcode.control"] is not None:
            assert bare.startswith(m["mcode.control"]), (told, m.words)
        elif m["mcode.prompt.error"] is not None:
            assert bare.startswith("prompt ?") == (m["mcode.prompt.error"] in ("1", "True")), (told, m.fields)
        else:
            assert bare == m.words.replace(" [checksum wrong]", ""), (told, m.words)


def test_linrs_says_what_decode_says(folder):
    seen = set()
    for m, told in pairs("linmot", folder):
        assert f"ID {m['linrs.id']}  " in told, told
        for name, form in (("linrs.motion.name", "{}"), ("linrs.state.text", "  {}"), ("linrs.upid.name", "({})"), ("linrs.bits", "{}"), ("linrs.error", "({})"), ("linrs.count", "count {}")):
            if m[name] is not None:
                seen.add(name)
                assert form.format(m[name]) in told, (name, told, m.fields)
        if m["linrs.position"] is not None:
            assert f"position {int(m['linrs.position']) / 10000:.4f} mm" in told, (told, m.fields)
    assert {"linrs.motion.name", "linrs.state.text", "linrs.bits", "linrs.count"} <= seen, seen


def test_what_was_cut_into_pieces_is_put_together(folder):
    for family, protocol in SCRIPTS.items():
        whole = [(d, b) for d, b in vectors(family)][:120]
        pieces = [(d, b[k:k + 5]) for d, b in whole for k in range(0, len(b), 5)]
        a, b = (messages(dissected(family, p, folder), protocol) for p in (whole, pieces))
        assert len(a) > 20 and [m.words for m in a] == [m.words for m in b], family


def test_over_tcp_segments_are_put_together(folder):
    for family, port in (("uim342", 8888), ("mcode", 503)):
        whole = vectors(family)[:60]
        if family == "uim342":
            whole = [(d, b) for d, b in whole if len(b) == 16]
        else:
            whole = [(d, b) for d, b in whole if b[-1:] in b"\r\n"]
        pieces = [(d, b[k:k + 6]) for d, b in whole for k in range(0, len(b), 6)]
        path = folder / "tcp.pcapng"
        write(path, captures.RAW_IP, captures.tcp_packets(port, pieces))
        over_tcp = [m.words for m in messages(dissect(path, "-o", "tcp.desegment_tcp_streams:TRUE"), SCRIPTS[family])]
        on_a_line = [m.words for m in messages(dissected(family, whole, folder), SCRIPTS[family])]
        assert len(over_tcp) > 20 and over_tcp == on_a_line, (family, len(over_tcp), len(on_a_line))


def test_strange_bytes_are_told_and_what_follows_is_found(folder):
    for family, protocol in SCRIPTS.items():
        good = [p for p in vectors(family) if len(p[1]) > 6][:6]
        noise = bytes([0xFF, 0x7F, 0xFE]) if family != "mcode" else bytes([0xFF, 0xFE, 0x0D])
        made = dissected(family, good + [(good[-1][0], noise)] + good, folder)
        found = messages(made, protocol)
        assert len(found) >= 12, (family, len(found))
        assert [m.words for m in found][-3:] == [m.words for m in messages(dissected(family, good, folder), protocol)][-3:], family
        if family != "mcode":
            assert any("axisgate_line.strange" in m.fields for m in messages(made, "axisgate_line")), family


def every_form():
    """By family: frames that are whole and say what no drive says: each kind of message with each length of data, too short and too long."""
    data = bytes(range(0xF8, 0x100)) + bytes(range(60))
    codes = [*range(0x00, 0x40), 0x5A, 0x7E, 0x7F]
    uim = [(d, cw | (0x80 if d else 0), data[:n]) for d in (True, False) for cw in codes for n in range(9)]
    linrs = [(d, bytes([1, 17, n + 3, 2, sub, main]) + data[:n] + b"\x04") for d in (True, False) for main in range(10)
             for sub in (0, 1, 0x50, 0x55, 0x60, 0x71, 0x84) for n in (0, 1, 2, 3, 6, 7, 8, 9, 13, 60)]
    texts = ["", ";", ";;;;;", "1900", "1900;5", "ZZZZ;1;0;0", "1900;99999999999;0;0", "1900;5;2;0", "0;1;31;0;0", "999999;1;99999;99999;1;x", "0;2;1;0;0;0", "1900;5;0;" + "9" * 100]
    frames = [b"\x01\x02" + t.encode() + b"\x03" + check + b"\x04" for t in texts for check in (b"", b"0", b"999")]
    return {
        "uim342": [(d, bytes([0xAD, 5, cw, len(b)]) + b.ljust(8, b"\0") + bytes(3) + b"\xcc") for d, cw, b in uim],
        "can": [(d, captures.can_packet((4 << 24 | 5 << 19 if d else 5 << 24 | 4 << 19) | cw, b)) for d, cw, b in uim],
        "linmot": linrs,
        "pacontrol": [(d, f) for d in (True, False) for f in frames],
        "mcode": [(d, before + bytes([n]) + after) for d in (True, False) for n in range(256) for before, after in ((b"", b"\r"), (b"a", b"\n"), (b"aPR ", b"\r\n"))],
    }


def test_whole_frames_that_say_what_no_drive_says_are_no_error_of_a_script(folder):
    for family, packets in every_form().items():
        path = folder / f"{family}.pcapng"
        write(path, captures.SOCKETCAN if family == "can" else captures.USER0, packets)
        protocol = "simplecan" if family == "can" else SCRIPTS[family]
        made = dissect(path) if family == "can" else dissect(path, "-o", f"axisgate_line.family:{protocol}")
        assert len(messages(made, protocol)) >= len(packets) * 0.9, (family, len(packets))


def test_hostile_bytes_are_no_error_of_a_script(folder):
    # What fits no protocol, and what begins as each of them and goes on as none: by a fixed rule, so that a failure can be seen again.
    state, packets = 17, []
    for n in range(300):
        data = b""
        for _ in range(n % 40 + 1):
            state = (state * 1103515245 + 12345) & 0x7FFFFFFF
            data += bytes([state >> 16 & 0xFF])
        packets.append((bool(n & 1), (b"", b"\xaa\x05", b"\x01\x02", b"\x01\x11\x05\x02", b"a")[n % 5] + data))
    path = folder / "hostile.pcapng"
    write(path, captures.USER0, packets)
    for family in ("automatic", *SCRIPTS.values()):
        dissect(path, "-o", f"axisgate_line.family:{family}")


def test_traces_of_a_running_gateway(folder):
    with harness.Gateway(folder, DEMO) as g:
        for axis in ("feeder", "portal.x", "lift", "shuttle"):
            g.command(axis, {"command": "enable"})
        for line, protocol in (("com1", "pacontrol"), ("rs485", "mcode"), ("linrs", "linrs"), ("can0", "simplecan")):
            status, trace, _ = g.request("GET", f"/api/v1/lines/{line}/trace?format=pcapng")
            assert status == 200
            path = folder / f"{line}.pcapng"
            path.write_bytes(trace)
            packets = dissect(path)
            found = messages(packets, protocol)
            assert len(found) > 10, (line, len(found))
            strange = [p for p in packets if any("axisgate_line.strange" in m.fields for m in p)]
            assert len(strange) <= 1, (line, "more than the first packet, whose begin is not in the trace")
            if line != "can0":
                undecided = [p for p in packets if not any(m.protocol == protocol for m in p) and not any("axisgate_line.continued" in m.fields or m.words == "ends of lines alone" for m in p)]
                assert not undecided, (line, len(undecided))
