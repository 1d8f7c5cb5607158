"""The electronic data sheet, read as an engineering tool reads it and held against what the adapter says.

In: GET /api/v1/eds of a site with two axes, and of a program without a site. Out: every assembly, connection and parameter of the sheet is
asked of the device; the sheet of the empty site is schema/axisgate.eds, byte for byte.
"""
import pathlib
import struct

from harness import Gateway
from test_enip import Originator, device

DEFAULT = pathlib.Path(__file__).resolve().parents[2] / "schema/axisgate.eds"


def entries(text):
    """{section: {key: [field, ...]}}: quoted texts keep what is in them, comments begin with $."""
    sections, section, key, field, fields, quoted = {}, None, None, "", [], False
    for line in text.split("\r\n"):
        if not quoted and line.startswith("$"):
            continue
        if not quoted and line.startswith("["):
            section = sections.setdefault(line[1:line.index("]")], {})
            continue
        for c in line:
            if c == '"':
                quoted = not quoted
            elif quoted or c not in "=,;":
                field += c
            elif c == "=":
                key, field = field.strip(), ""
            else:
                fields.append(field.strip())
                field = ""
                if c == ";":
                    assert key not in section, f"{key} is there twice"
                    section[key], fields = fields, []
    assert not quoted and not fields and not field.strip(), "the sheet ends within an entry"
    return sections


def sheet_of(g):
    status, sheet, _ = g.request("GET", "/api/v1/eds")
    assert status == 200, sheet
    return sheet if isinstance(sheet, bytes) else sheet.encode()


def path_of(text):
    return bytes(int(b, 16) for b in text.split())


def number(data):
    return int.from_bytes(data, "little")


def read(o, path):
    status, _, data = o.ask(0x0E, path)
    assert status == 0, (path.hex(" "), status)
    return data


def opened(o, path, to_device, from_device, serial):
    """Large_Forward_Open, class 1, point to point, and its end: (status, extended)."""
    data = struct.pack("<BBIIHHIB3x", 10, 14, 0, 0x7000 + serial, serial, 0x4242, 99, 5)
    for size in (to_device, from_device):
        data += struct.pack("<II", 10000, 0x48000000 | size)
    data += bytes([1, len(path) // 2]) + path
    manager = bytes([0x20, 6, 0x24, 1])
    status, extended, _ = o.ask(0x5B, manager, data)
    if status == 0:
        close = struct.pack("<BBHHIBB", 10, 14, serial, 0x4242, 99, len(path) // 2, 0) + path
        assert o.ask(0x4E, manager, close)[0] == 0, path.hex(" ")
    return status, extended


def test_every_line_of_the_sheet_is_what_the_adapter_says(folder):
    with device(folder) as (g, at), Originator(*at) as o:
        sheet = entries(sheet_of(g).decode("ascii"))
        assemblies = {k: v for k, v in sheet["Assembly"].items() if k.startswith("Assem")}
        # As CONTRACT has them: all axes, each axis, the heartbeats and the configuration.
        assert sorted(int(k[5:]) for k in assemblies) == [100, 101, 102, 150, 151, 152, 197, 198, 199], list(assemblies)
        for key, fields in assemblies.items():
            instance, size = int(key[5:]), int(fields[2])
            assert path_of(fields[1]) == bytes([0x20, 4, 0x24, instance, 0x30, 3]), fields
            assert number(o.get(4, instance, 4)) == size, key
            assert len(read(o, path_of(fields[1]))) == size, key

        manager = sheet["Connection Manager"]
        kinds = {}
        for key, fields in manager.items():
            if not key.startswith("Connection"):
                continue
            trigger, parameters = int(fields[0], 16), int(fields[1], 16)
            kind = trigger >> 24 & 7  # listen only, input only, exclusive owner
            kinds[kind] = kinds.get(kind, 0) + 1
            header = 4 if parameters >> 8 & 7 == 4 else 0
            consumed, produced = int(fields[3]), int(fields[6])
            assert assemblies[fields[4]][2] == fields[3] and assemblies[fields[7]][2] == fields[6], key
            status, extended = opened(o, path_of(fields[-1]), consumed + 2 + header, produced + 2, len(kinds) * 100 + kinds[kind])
            expected = (1, (0x0119,)) if kind == 1 else (0, ())  # who only listens needs somebody who does more
            assert (status, extended) == expected, (key, fields, status, extended)
            wrong = opened(o, path_of(fields[-1]), consumed + 4 + header, produced + 2, 9)
            if kind == 4:
                assert wrong == (1, (0x0127, consumed + 2 + header)), (key, wrong)
        assert kinds == {1: 3, 2: 3, 4: 3}, kinds

        count = number(read(o, bytes([0x20, 0x0F, 0x24, 0, 0x30, 2])))
        assert int(sheet["ParamClass"]["MaxInst"][0]) == count
        assert int(sheet["ParamClass"]["Descriptor"][0], 16) == number(read(o, bytes([0x20, 0x0F, 0x24, 0, 0x30, 8])))
        parameters = {int(k[5:]): v for k, v in sheet["Params"].items() if k.startswith("Param")}
        assert sorted(parameters) == list(range(1, count + 1))
        for instance, p in parameters.items():
            def attribute(n):
                return o.get(0x0F, instance, n)
            assert path_of(p[2]) == read_path(instance), p
            assert number(attribute(4)) == int(p[3], 16), (p, attribute(4))
            assert number(attribute(5)) == int(p[4], 16) and number(attribute(6)) == int(p[5]), p
            name = attribute(7)[1:].decode("latin-1")
            assert name[:16] in p[6] or "?" in p[6], (name, p[6])
            for n, field in ((10, 9), (11, 10), (12, 11)):
                value = attribute(n)
                kind = int(p[4], 16)
                if kind == 0xDA:
                    continue
                if kind in (0xCA, 0xCB):
                    assert abs(struct.unpack("<f" if kind == 0xCA else "<d", value)[0] - float(p[field])) <= 1e-6 * abs(float(p[field])), (instance, n, p)
                else:
                    signed = kind in (0xC2, 0xC3, 0xC4, 0xC5)
                    assert int.from_bytes(value, "little", signed=signed) == int(p[field]), (instance, n, p)


def read_path(instance):
    """The value of a parameter, in the shortest form."""
    head = bytes([0x24, instance]) if instance < 256 else bytes([0x25, 0]) + struct.pack("<H", instance)
    return bytes([0x20, 0x0F]) + head + bytes([0x30, 1])


def test_the_default_sheet_is_that_of_a_program_without_a_site(folder):
    with Gateway(folder, None) as g:
        served = sheet_of(g)
        host, port = g.word("enip").rsplit(":", 1)
        assert served == DEFAULT.read_bytes(), "write what GET /api/v1/eds of a program without a site answers to schema/axisgate.eds"
        sheet = entries(served.decode("ascii"))
        with Originator(host, int(port), 2222) as o:
            assert tuple(o.get(1, 1, 4)) == (int(sheet["Device"]["MajRev"][0]), int(sheet["Device"]["MinRev"][0]))
            for key, field in (("VendCode", 1), ("ProdType", 2), ("ProdCode", 3)):
                assert number(o.get(1, 1, field)) == int(sheet["Device"][key][0])
            assert not any(k.startswith("Connection") for k in sheet["Connection Manager"]), "there is no axis to connect to"
            status, extended = o.open(150, 100)
            assert (status, extended) == (1, (0x0110,)), "an output without an axis"
