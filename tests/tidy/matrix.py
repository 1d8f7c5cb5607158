"""The statements of a family's manual (adapters/<family>/twin/matrix.json): every entry has its fields, and every test that it names exists.

The handbook's chapters are made from these files (web/scripts/matrix.mjs), so that no reader takes a gap of a twin for the drive.
"""
import json
import re

# Families whose drive is no maker's: one carries axes of other gateways, the other is invented.
WITHOUT_MANUAL = {"remote", "example"}
KINDS = ("as_printed", "choice", "not_modelled")
FIELDS = {"number", "statement", "source", "kind", "note", "tests"}


def folder_of(program, families):
    """Where the sources of a test program are, as in cmake/AxisgateBuild.cmake: the folder and a pattern that a file's name must have."""
    name = program.removeprefix("test_")
    if name.removesuffix("_twin") in families:
        return f"adapters/{name.removesuffix('_twin')}/tests", r"twin" if name.endswith("_twin") else r"(?!twin)"
    return ("tests/conformance" if name == "conformance" else f"tests/unit/{name}"), ""


def tests_of(top, program, families):
    """Suite.Name of every test in the sources of a program."""
    folder, pattern = folder_of(program, families)
    found = set()
    for path in (top / folder).glob("*.cpp"):
        if re.match(pattern, path.name):
            found |= {f"{suite}.{name}" for suite, name in re.findall(r"^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+),\s*(\w+)\s*\)", path.read_text(encoding="utf-8"), re.M)}
    return found


def faults_of(data, exists):
    """What is wrong with the statements of one family. `exists` takes a program and a test."""
    numbers, sections = set(), data.get("sections", {})
    if not data.get("manual") or not data.get("statements"):
        yield "has no manual or no statements"
    for s in data.get("statements", ()):
        at = f"statement {s.get('number', '?')}"
        if set(s) - FIELDS:
            yield f"{at}: unknown field {min(set(s) - FIELDS)}"
        for field in ("number", "statement", "source", "kind"):
            if not s.get(field):
                yield f"{at}: {field} is missing"
        if s.get("number") in numbers:
            yield f"{at}: the number is used twice"
        numbers.add(s.get("number"))
        if not re.fullmatch(r"\d+(\.\d+)+", s.get("number", "")) or s["number"].split(".")[0] not in sections:
            yield f"{at}: the number does not begin with that of a section"
        if s.get("kind") not in KINDS:
            yield f"{at}: kind is one of {', '.join(KINDS)}"
        if s.get("kind") in ("choice", "not_modelled") and not s.get("note"):
            yield f"{at}: the note is missing (why the choice was made, or what the twin does instead)"
        if s.get("kind") != "not_modelled" and not s.get("tests"):
            yield f"{at}: no test shows it"
        for test in s.get("tests", ()):
            program, _, name = test.partition(": ")
            if not exists(program, name):
                yield f"{at}: there is no test {test}"


def faults(top, families):
    """Faults of all families' files, one line each."""
    cache = {}

    def exists(program, name):
        if program not in cache:
            cache[program] = tests_of(top, program, families)
        return name in cache[program]
    for family in sorted(set(families) - WITHOUT_MANUAL):
        path = top / "adapters" / family / "twin/matrix.json"
        if not path.is_file():
            yield f"adapters/{family}/twin/matrix.json is missing: the statements of the manual and what the twin does"
            continue
        yield from (f"adapters/{family}/twin/matrix.json: {what}" for what in faults_of(json.loads(path.read_text(encoding="utf-8")), exists))
        for page in ("README.md", "twin/matrix.json"):
            if page not in (top / f"docs/handbook/family-{family}.md").read_text(encoding="utf-8"):
                yield f"docs/handbook/family-{family}.md does not link to {page} of the family"


def holds():
    """Whether each rule still finds what it is for."""
    good = {"number": "1.1", "statement": "x", "source": "p. 1", "kind": "as_printed", "tests": ["test_x: A.B"]}

    def found(*statements):
        return len(list(faults_of({"manual": "m", "sections": {"1": "s"}, "statements": statements}, lambda program, name: (program, name) == ("test_x", "A.B"))))
    wrong = ({"kind": "maybe"}, {"kind": "choice"}, {"tests": []}, {"tests": ["test_x: A.C"]}, {"source": ""}, {"number": "2.1"}, {"number": "1"}, {"when": "now"},
             {"kind": "not_modelled", "tests": []})
    return found(good) == 0 and found(good, good) == 1 and all(found({**good, **change}) == 1 for change in wrong) and list(faults_of({}, None)) != []
