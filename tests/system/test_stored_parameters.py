"""Parameters that were written through the gateway, and a drive that comes back with others: told, or written, as the site says.

In: the real program, a drive that forgets over a power cycle. Out: events, values. Never sleeps longer than it waits.
"""
import pathlib

from harness import Gateway, until

TOP = pathlib.Path(__file__).resolve().parents[2]

SITE = {
    "lines": [{"name": "can0", "uri": "twin", "family": "cia402", "bitrate": 1000000}],
    "drives": [{"name": n, "line": "can0", "address": a, "presence": "twin"} for n, a in (("told", 5), ("mended", 6), ("left", 7))],
    "axes": [{"name": "told", "drive": "told", "channel": 1, "number": 1, "stored_parameters": "compare"},
             {"name": "mended", "drive": "mended", "channel": 1, "number": 2, "stored_parameters": "write"}, {"name": "left", "drive": "left", "channel": 1, "number": 3}],
}


def test_a_drive_that_has_forgotten_is_told_and_mended_as_the_site_says(folder):
    with Gateway(folder, SITE) as g:
        def value(axis, parameter):
            return g.get(f"/axes/{axis}/parameters/{parameter}")["value"]

        def told(axis):
            return [e["text"] for e in g.get(f"/events?axis={axis}") if e["kind"] == "parameters"]

        for axis in ("told", "mended", "left"):
            until(lambda: g.axis(axis)["online"], 10, axis)
            for parameter, v in (("6081h", 12345), ("6083h", 50000), ("6085h", 77777)):  # 6083h is what the drive has anyway
                g.send("PUT", f"/axes/{axis}/parameters/{parameter}", {"value": v})
        assert told("told") == [] and told("mended") == []
        for axis in ("told", "mended", "left"):
            g.send("PUT", f"/drives/{axis}/hand", {"power": False})
            until(lambda: not g.axis(axis)["online"], 10, axis)
            g.send("PUT", f"/drives/{axis}/hand", {"power": True})
            until(lambda: g.axis(axis)["online"], 10, axis)
        text = until(lambda: told("told"), 10, "the difference is told")[0]
        assert text.startswith("2 of 3 stored parameters are others in the drive: ") and "6081h is 10000, stored is 12345" in text and "written" not in text, text
        until(lambda: any(t.startswith("2 of 2 stored parameters were written") for t in told("mended")), 10, "what was written is told")
        assert [value("mended", p) for p in ("6081h", "6083h", "6085h")] == [12345, 50000, 77777]
        assert [value("told", p) for p in ("6081h", "6085h")] == [10000, 200000], "told alone"
        assert told("left") == [] and value("left", "6081h") == 10000, "who is not asked to look does not look"
        # A site with another word is refused with the words that there are.
        status, refused, _ = g.request("PATCH", "/api/v1/axes/left", {"stored_parameters": "always"}, {"Content-Type": "application/merge-patch+json"})
        assert status == 422 and "ignore, compare or write" in str(refused), refused
        g.send("PATCH", "/axes/left", {"stored_parameters": "compare"})


def test_the_values_of_a_dcf_are_compared_and_written_as_the_site_says(folder):
    empty = {"lines": SITE["lines"], "drives": [], "axes": []}
    with Gateway(folder, empty) as g:
        dcf = (TOP / "adapters/cia402/tests/eds/by_tool.dcf").read_bytes()
        assert g.request("POST", "/api/v1/descriptions?name=machine.dcf", dcf, {"Content-Type": "text/plain"})[0] == 201
        assert g.get("/descriptions/machine.dcf")["commissioning"] == {"node": 12, "node_name": "lift", "bit_rate_kbit": 500}
        for n, rule in enumerate(("compare", "write")):
            g.send("POST", "/drives", {"name": rule, "line": "can0", "address": 5 + n, "presence": "twin", "description": "machine.dcf"}, 201)
            g.send("POST", "/axes", {"name": rule, "drive": rule, "number": 1 + n, "stored_parameters": rule}, 201)
            until(lambda: g.axis(rule)["online"], 10, rule)
            # Somebody has set another value in the drive, and stored it there.
            g.send("POST", f"/drives/{rule}/native", {"send": "6083:00=9999"})
            g.send("POST", f"/drives/{rule}/native", {"send": "1010:01=x73617665"})
            for power in (False, True):
                g.send("PUT", f"/drives/{rule}/hand", {"power": power})
                until(lambda: g.axis(rule)["online"] == power, 10, rule)

        # Each parameter shows the value of the file, whether or not the drive has it; those that the file excludes show none.
        listed = {p["id"]: p for p in g.get("/axes/compare/parameters")}
        assert listed["6083h"]["configured"] == 7000 and g.get("/axes/compare/parameters/6083h")["configured"] == 7000
        assert "configured" not in listed["1014h"] and "configured" not in g.get("/axes/compare/parameters/1014h")

        def told(axis):
            return [e["text"] for e in g.get(f"/events?axis={axis}") if e["kind"] == "parameters"]
        text = until(lambda: next((t for t in told("compare") if "9999" in t), None), 10, "the difference is told")
        assert "6083h is 9999, the DCF has 7000" in text and "written" not in text, text
        until(lambda: any("were written" in t and "refused" not in t for t in told("write")), 10, "what was written is told")
        assert g.get("/axes/write/parameters/6083h")["value"] == 7000 and g.get("/axes/compare/parameters/6083h")["value"] == 9999
        # A value that is written through the gateway is newer than the file.
        g.send("PUT", "/axes/write/parameters/6083h", {"value": 8000})
        for power in (False, True):
            g.send("PUT", "/drives/write/hand", {"power": power})
            until(lambda: g.axis("write")["online"] == power, 10, "write")
        until(lambda: g.get("/axes/write/parameters/6083h")["value"] == 8000, 10, "the newer value")
