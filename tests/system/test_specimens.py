"""Specimens by the program itself: their words, twins of them on a line, and a recipe that is rehearsed against many."""
import json
import pathlib

import harness
from harness import Process, run


def test_every_family_tells_its_freedoms_and_its_specimens():
    for family in (f["name"] for f in json.loads(run("families", "--format", "json", check=0)[1])):
        told = json.loads(run("specimen", family, "--json", check=0)[1])
        assert told["family"] == family and told["named_specimens"] == ["slow", "sparse", "strict", "chatty", "weak", "old"], told
        freedoms = {f["name"]: f for f in told["freedoms"]}
        lines = run("specimen", family, check=0)[1].splitlines()
        assert lines[0].split()[0] == "freedom" and [line.split()[0] for line in lines[1:]] == list(freedoms), lines
        manual = json.loads(run("specimen", family, "0", "--json", check=0)[1])
        assert manual["values"] == {name: f["default"] for name, f in freedoms.items()} and manual["words"] == [], manual
        assert "as its manual shows it" in run("specimen", family, "0", check=0)[1]
        for specimen in ("17", "slow", "1000000000"):
            one = json.loads(run("specimen", family, specimen, "--json", check=0)[1])
            assert one == json.loads(run("specimen", family, specimen, "--json", check=0)[1]), "another drive at the second time"
            assert all(f["min"] <= one["values"][name] <= f["max"] for name, f in freedoms.items()), one
            differing = [name for name, f in freedoms.items() if one["values"][name] != f["default"]]
            assert [w.split()[0] for w in one["words"]] == differing, one
            assert len(run("specimen", family, specimen, check=0)[1].splitlines()) == 1 + len(differing)


def test_what_is_no_specimen_is_refused_with_what_would_be():
    for arguments in (("specimen", "uim342", "fast"), ("specimen", "uim342", "-1"), ("specimen", "uim342", "1000000001"), ("specimen", "nobody"),
                      ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "fast"),
                      ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "1", "--option", "specimen=2")):
        code, out, err = run(*arguments)
        assert code == 2 and err.strip() and not out.strip(), (arguments, code, out, err)
    assert "write a seed from 0" in run("specimen", "uim342", "fast")[2]


def test_a_twin_is_a_specimen():
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "17") as twin:
        assert twin.ready.startswith("ready uim342 addresses="), twin.ready
        assert twin.stop() == 0


def site_file(folder):
    path = pathlib.Path(folder) / "site.json"
    path.write_text(json.dumps(harness.DEMO))
    return str(path)


MOVES = {"parameters": {"way": {"type": "number", "default": 3}},
         "steps": [{"enable": {"axis": "feeder"}},
                   {"command": {"axis": "feeder", "command": "move_absolute", "position": "${way}", "velocity": 20, "wait_s": 30}},
                   {"check": {"axis": "feeder", "point": "position", "is": "${way}", "tolerance": 0.1}},
                   {"disable": {"axis": "feeder"}}]}


def test_a_recipe_is_rehearsed_against_specimens(folder):
    site, recipe = site_file(folder), pathlib.Path(folder) / "there.json"
    recipe.write_text(json.dumps(MOVES))
    order = ("rehearse", "--site", site, "--recipe", str(recipe))
    text = run(*order, "--specimens", "0", check=0)[1].splitlines()
    assert text[0].split()[:2] == ["specimen", "result"] and text[1].split()[:2] == ["0", "passed"] and text[-1] == "1 of 1 specimens passed", text
    code, out, err = run(*order, "--specimens", "0..5,slow", "--argument", "way=2", "--json")
    said = json.loads(out)
    assert [s["specimen"] for s in said["specimens"]] == ["0", "1", "2", "3", "4", "5", "slow"], said
    assert said["passed"] + said["failed"] == 7 and code == (1 if said["failed"] else 0), (code, err)
    assert all(s["passed"] or s["text"] for s in said["specimens"]), said
    again = json.loads(run(*order, "--specimens", "0..5,slow", "--argument", "way=2", "--json")[1])
    assert again == said, "virtual time depends on this computer"


def test_a_recipe_that_fails_names_the_step(folder):
    site, recipe = site_file(folder), pathlib.Path(folder) / "short.json"
    recipe.write_text(json.dumps({"steps": [{"enable": {"axis": "feeder"}},
                                            {"command": {"axis": "feeder", "command": "move_absolute", "position": 100, "velocity": 1, "wait_s": 1}}]}))
    code, out, _ = run("rehearse", "--site", site, "--recipe", str(recipe), "--specimens", "0,weak", "--family-specimen", "uim342=0", "--json")
    said = json.loads(out)
    assert code == 1 and said["failed"] == 2, said
    for one in said["specimens"]:
        assert one["pointer"] == "/steps/1" and one["step"].startswith("Step 2") and "not done within 1 s" in one["text"], one
    recipe.write_text(json.dumps({"steps": [{"enable": {"axis": "nobody"}}]}))
    code, out, err = run("rehearse", "--site", site, "--recipe", str(recipe))
    assert code == 2 and not out and "there is no axis nobody" in err and f"{recipe}:1" in err, (code, out, err)
    for more in (("--specimens", "3..1"), ("--family-specimen", "uim342"), ("--family-specimen", "nobody=1"), ("--argument", "x")):
        assert run("rehearse", "--site", site, "--recipe", str(recipe), *more)[0] == 2, more
    assert run("rehearse", "--site", site, "--recipe", str(pathlib.Path(folder) / "gone.json"))[0] == 2


def test_a_stored_recipe_is_rehearsed_while_the_gateway_runs(folder, gateway):
    gateway.send("PUT", "/recipes/there", MOVES, 201)
    data = str(folder / "data")
    out = run("rehearse", "--data", data, "--recipe", "there", "--specimens", "0", check=0)[1]
    assert "1 of 1 specimens passed" in out, out
    assert not gateway.axis()["moving"] and gateway.axis()["position"] == 0, "the rehearsal reached the gateway that runs"
    code, _, err = run("rehearse", "--data", data, "--recipe", "nobody")
    assert code == 2 and "no stored recipe nobody" in err, (code, err)
    assert gateway.get("/families/uim342/specimens/slow")["values"] == json.loads(run("specimen", "uim342", "slow", "--json", check=0)[1])["values"]
