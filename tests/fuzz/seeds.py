"""Makes the seeds of the fuzz targets that follow from other files of the repository, so that they never lag behind them.

    tests/fuzz/seeds.py FOLDER      writes FOLDER/TARGET/NAME for every target that has some

In: adapters/*/vectors.txt, schema/openapi.yaml, schema/families, tests/unit/canopen/eds. Out: one small file per example: the frames of each family's vectors as bytes,
one request per operation of the API. What no other file says (recipes, tables, program text) is kept in seeds/ beside the target.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
MOST = 200  # of one target: a corpus that is read in a moment


def byte_lines(text):
    """Every run of hex pairs that a vectors file gives as it stands on the wire."""
    found = []
    for line in text.splitlines():
        words = re.split(r"\s+#", line)[0].split()
        pairs = [w for w in words[1:] if re.fullmatch(r"[0-9A-Fa-f]{2}", w)]
        if not line.startswith("#") and len(pairs) >= 2 and len(pairs) >= len(words) - 3:
            found.append(bytes.fromhex("".join(pairs)))
    return found


def text_lines(text):
    """Every line that a person or the gateway would type: `> TEXT`, `| TEXT`."""
    return [m.group(1).encode() + b"\r" for m in re.finditer(r"^[>|] (\S.*)$", text, re.M)]


def listings(text):
    """Programs: the `| LINE` lines of one case together."""
    cases = re.split(r"^program .*$", text, flags=re.M)[1:]
    return ["\n".join(re.findall(r"^\|(?:! \d+)? ?(.*)$", case, re.M)).encode() for case in cases]


def requests():
    """One request per operation: the method, the path with plausible names, and an empty body."""
    names = {"axis": "feeder", "drive": "feeder", "line": "can0", "family": "demo", "parameter": "AC", "mapping": "m1"}
    path, found = None, []
    for line in (TOP / "schema/openapi.yaml").read_text().splitlines():
        if m := re.fullmatch(r"  (/\S*):", line):
            path = re.sub(r"\{(\w+)\}", lambda k: names.get(k.group(1), "1"), m.group(1))
        elif path and (m := re.fullmatch(r"    (get|put|post|patch|delete):", line)):
            body = b"" if m.group(1) in ("get", "delete") else b"{}"
            found.append(b"\x00" + f"{m.group(1).upper()} {path}\n\n".encode() + body)
        elif re.match(r"\S", line):
            path = None
    return found


def main():
    out = pathlib.Path(sys.argv[1])
    seeds = {"http_request": requests()}
    for vectors in sorted(TOP.glob("adapters/*/vectors.txt")):
        family, text = vectors.parent.name, vectors.read_text()
        wire = byte_lines(text)
        for target in sorted((vectors.parent / "fuzz").glob("*.cpp")):
            # A target that takes numbers from its input in front of the bytes reads them at the end: both places get the frame.
            words = text_lines(text)
            seeds[target.stem] = [b + bytes(8) for b in wire] + words
            if target.stem == f"{family}_program":
                seeds[target.stem] = listings(text) + words
    seeds["canopen_eds"] = [p.read_bytes() for p in sorted((TOP / "tests/unit/canopen/eds").iterdir())]
    seeds["descriptions"] = [p.read_bytes() for folder in ("tests/unit/canopen/eds", "adapters/cia402/tests/eds") for p in sorted((TOP / folder).iterdir())]
    written = 0
    for target, list_ in seeds.items():
        folder = out / target
        folder.mkdir(parents=True, exist_ok=True)
        for n, data in enumerate(sorted(set(list_))[:: max(1, len(set(list_)) // MOST)]):
            (folder / f"from_text_{n}").write_bytes(data)
            written += 1
    assert written > 100, f"only {written} seeds: the vectors or the description are written differently"
    print(f"{written} seeds for {len(seeds)} targets")


if __name__ == "__main__":
    main()
