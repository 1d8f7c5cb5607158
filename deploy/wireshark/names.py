#!/usr/bin/env python3
"""Writes axisgate_names.lua from the catalogues: what the dissectors call commands, parameters, states and errors.

In: schema/families/*.json, a folder (default: this one). Out: the Lua file in that folder; it is not kept in the sources.
"""
import json
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
FAMILIES = HERE.parents[1] / "schema/families"
HEAD = """-- Made by names.py from schema/families: what commands, parameters, states and errors are called.
-- In: nothing. Out: the table axisgate_names.
"""


def catalogue(name):
    return json.loads((FAMILIES / f"{name}.json").read_text())


def texts(entries, key, value):
    return {e[key]: e[value] for e in entries}


def tables():
    uim, mcode, pa, lin = (catalogue(n) for n in ("uim342", "mcode", "pacontrol", "linmot"))
    return {
        "uim342": {kind + "s": texts([e for e in uim["errors"] if e["kind"] == kind], "code", "text") for kind in ("error", "alarm")},
        "mcode": {"words": {c["id"]: c["name"] for c in mcode["commands"] + mcode["parameters"] if c["id"].isalnum()}},
        "pacontrol": {
            "commands": {int(c["code"], 16): c["name"] for c in pa["commands"] if c["kind"] == "command_code"},
            "quits": texts([e for e in pa["errors"] if e["kind"] == "command"], "code", "text"),
            "errors": texts([e for e in pa["errors"] if e["kind"] != "command"], "code", "text"),
            "states": texts(pa["operating_states"], "code", "title"),
        },
        "linmot": {
            "motions": {c["wire"]["header"]: c["name"] for c in lin["commands"] if c["kind"] == "motion_command"},
            "parameters": {p["wire"]["upid"]: p["name"] for p in lin["parameters"] if "upid" in p["wire"] and not p["wire"]["rom"]},
            "states": texts(lin["states"], "code", "name"),
            "errors": texts(lin["errors"], "code", "text"),
            "status_bits": texts(lin["status_bits"], "bit", "name"),
            "control_bits": texts(lin["control_bits"], "bit", "name"),
        },
    }


def lua(value, depth):
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    pad = "    " * depth
    return "{\n" + "".join(f"{pad}    [{json.dumps(k)}] = {lua(v, depth + 1)},\n" for k, v in sorted(value.items(), key=lambda i: i[0])) + pad + "}"


def main():
    text = HEAD + "_G.axisgate_names = " + lua(tables(), 0) + "\n"
    target = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE) / "axisgate_names.lua"
    if target.exists() and target.read_text() == text:
        return
    new = target.with_suffix(f".{os.getpid()}")
    new.write_text(text)
    new.replace(target)  # a reader sees the old file or the new one, never a part of it


if __name__ == "__main__":
    main()
