"""The lines of docs/http.md, README.md and every chapter of the handbook, run as they stand against the demo site; and no path of the API is without one.

In: the documents, the real program. Out: the first line that did not work, with what it said. Bounded: each line and each document has its time.
A block ```sh is run; a block ```console needs an installed machine, and holds nothing else. A line that ends in "# refused" must be refused.
"""
import contextlib
import json
import os
import pathlib
import re
import shlex
import subprocess

import harness
from harness import Gateway
from test_openapi import API

TOP = pathlib.Path(__file__).resolve().parents[2]
DEMO = json.loads((TOP / "deploy/examples/demo-site.json").read_text())
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.M | re.S)
# curl says with its exit code what the gateway refused; a line that hangs is ended.
PRELUDE = """curl() { command curl --fail-with-body --max-time 40 "$@"; }
refused() { ! curl "$@"; }
axisgate() { PROGRAM "$@"; }
head() { local n=10; case ${1:-} in -*) n=${1#-}; shift;; esac; awk -v n="$n" 'NR <= n' "$@"; }  # reads to the end: who writes is not cut off
mbpoll() { local said; said=$(command mbpoll "$@" 2>&1) || { echo "$said"; return 1; }; echo "$said"; ! grep -qi failed <<<"$said"; }
set -eo pipefail
"""
NOT_BY_CURL = {"/api/v1/stream"}  # a WebSocket


def blocks(name):
    return BLOCK.findall((TOP / name).read_text())


LIMIT_S = 400  # of a script that hangs; on a machine with other work the longest one has taken more than 100 s


def run_lines(text, folder):
    """Each line by itself is announced on standard error, so that the one that failed is known."""
    script = PRELUDE.replace("PROGRAM", quoted(str(harness.PROGRAM)))
    for line in whole_lines(text):
        if line.endswith("# refused"):
            line = line.replace("curl ", "refused ", 1)
        if line.strip() and not line.startswith("#"):
            script += f"printf '%s\\n' {quoted(line)} >&2\n{line}\n"
    path = folder / "lines.sh"
    path.write_text(script)
    with open(folder / "out", "w+") as out, open(folder / "err", "w+") as err:
        with subprocess.Popen(["bash", str(path)], cwd=folder, stdout=out, stderr=err, env={**os.environ, "HOME": str(folder), "LC_ALL": "C.UTF-8", "no_proxy": "*"}) as p:
            try:
                code = p.wait(LIMIT_S)
            except subprocess.TimeoutExpired:
                p.kill()
                code = f"not within {LIMIT_S} s"
    said, last = (folder / "out").read_text(), (folder / "err").read_text().splitlines()[-1:]
    assert code == 0, f"this line did not work ({code}): {last}\n{said[-600:]}"
    return said


def whole_lines(text):
    """Lines, or several where a quotation goes on."""
    held = ""
    for line in text.splitlines():
        held += line
        try:
            shlex.split(held, comments=True)
        except ValueError:
            held += "\n"
            continue
        yield held
        held = ""
    assert not held, f"a quotation that does not end: {held}"


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def paths_of(text):
    """The paths of the description that the lines of a text ask for."""
    asked = set(re.findall(r"\$(?:api|root)(/[^\s\"'|?)]*)", text))
    out = set()
    for path in API.document["paths"]:
        form = re.compile(re.sub(r"\\\{\w+\\\}", r"[^/]+", re.escape(path.removeprefix("/api/v1"))) + "$")
        if any(form.match(a) for a in asked):
            out.add(path)
    return out


def test_every_path_has_a_line(folder):
    text = "\n".join(blocks("docs/http.md"))
    missing = set(API.document["paths"]) - paths_of(text) - NOT_BY_CURL
    assert not missing, f"docs/http.md has no line for {sorted(missing)}"
    assert len(re.findall(r"\bcurl ", text)) > 100


def test_the_lines_of_the_page_work_in_their_order(folder):
    # In a domain of its own, because the fleet has lines, too.
    with Gateway(folder, DEMO, "--set", "dds.enabled=true", "--set", "dds.name=hall-1", "--set", f"dds.domain={os.getpid() % 90 + 100}") as g:
        text = "\n".join(blocks("docs/http.md"))
        text = re.sub(r"^root=.*$", f"root=http://{g.http[0]}:{g.http[1]}", text, count=1, flags=re.M)
        text, n = re.subn(r"^code=.*$", f"code={g.code}", text, count=1, flags=re.M)
        assert n == 1 and g.code
        out = run_lines(text, folder)
        assert "node_id" in out and "include_addressing" in out
        assert (folder / "backup.tar").read_bytes().startswith(b"backup.json") and (folder / "backup.sealed").read_bytes().startswith(b"AXISGATE-SEALED")
        assert g.get("/axes/feeder")["unit"] == "cm" and not g.axis()["moving"]
        assert g.request("GET", "/healthz")[0] == 200


def test_the_lines_of_the_readme_work_in_their_order(folder):
    with Gateway(folder, DEMO) as g:
        text = "\n".join(b for b in blocks("README.md") if "curl" in b)
        text = re.sub(r"^api=.*$", f"api=http://{g.http[0]}:{g.http[1]}/api/v1", text, count=1, flags=re.M)
        text = text.replace("-p 1502", f"-p {g.modbus_port}").replace("build/release/axisgate", str(harness.PROGRAM)).replace("K7QF-2M9D-XW3E-8HTR", g.code)
        run_lines(text, folder)
        assert g.request("GET", "/healthz")[0] == 200


HANDBOOK = sorted(p.stem for p in (TOP / "docs/handbook").glob("*.md"))
# What a block ```console may begin with: it changes the machine itself, or speaks of the installed service.
INSTALLED = re.compile(r"(sudo|apt|systemctl|journalctl|ip|podman|deploy/package)\b|axisgate .*/etc/axisgate")


def test_what_is_not_run_needs_an_installed_machine():
    for name in HANDBOOK:
        text = (TOP / f"docs/handbook/{name}.md").read_text()
        kinds = re.findall(r"^```(\w*)$", text, re.M)[::2]
        assert set(kinds) <= {"sh", "console", "toml", "json", "ini", "yaml"}, f"{name}: {kinds}"
        assert "sh" in kinds or "console" not in kinds, f"{name} has lines, and none of them is run"
        for line in "\n".join(re.findall(r"^```console\n(.*?)^```$", text, re.M | re.S)).splitlines():
            assert not line or INSTALLED.match(line), f"{name}: this line could be run: {line}"


def serial_ports(folder):
    """The two ends of a serial line, as the gateway and the panel find them."""
    ends = [folder / "ttyUSB0", folder / "ttyUSB1"]
    line = subprocess.Popen(["socat", *(f"pty,raw,echo=0,link={e}" for e in ends)])
    harness.until(lambda: all(e.exists() for e in ends), 5, "a pseudo-terminal")
    return line, ends


def run_chapter(name, folder):
    text = "\n".join(blocks(f"docs/handbook/{name}.md"))
    if name != "README":
        text = "\n".join(blocks("docs/handbook/README.md")) + text
    arguments = ["--set", "dds.enabled=true", "--set", f"dds.domain={os.getpid() % 90 + 100}"]
    with contextlib.ExitStack() as stack:
        if name == "door-modbus-rtu":
            line, (near, far) = serial_ports(folder)
            stack.callback(line.wait)
            stack.callback(line.terminate)
            arguments += ["--set", f"modbus_rtu.port={near}"]
            text = text.replace("/dev/ttyUSB1", str(far))
        g = stack.enter_context(Gateway(folder, DEMO, *arguments, "--set", "dds.name=hall-1"))
        if name == "fleet":
            (folder / "other").mkdir()
            stack.enter_context(Gateway(folder / "other", DEMO, *arguments, "--set", "dds.name=hall-2"))
            harness.until(lambda: len(g.get("/fleet")["gateways"]) == 2, 10, "the other gateway")
        text = text.replace("127.0.0.1:8080", f"{g.http[0]}:{g.http[1]}").replace("-p 1502", f"-p {g.modbus_port}")
        text = text.replace("/usr/share/axisgate/wireshark", f"{TOP}/deploy/wireshark")
        run_lines(f"code={g.code}\n" + text, folder)
        assert g.request("GET", "/healthz")[0] == 200


def chapter_test(name):
    def test(folder):
        run_chapter(name, folder)
    return test


for _name in HANDBOOK:
    if blocks(f"docs/handbook/{_name}.md"):
        globals()[f"test_the_lines_of_the_chapter_{_name.replace('-', '_')}"] = chapter_test(_name)


def test_the_papers_say_what_the_first_target_is_and_why_a_twin_waits():
    def says(name, *sentences):
        text = " ".join((TOP / name).read_text().split())
        missing = [s for s in sentences if s not in text]
        assert not missing, f"{name} does not say: {missing}"
    says("README.md", "Enabling takes the actual position as the first target, unless the same client has just written one",
         "A real drive that falls silent while it is powered is not replaced: it may still hold or turn, so its twin waits",
         "Mend the line or the drive, or disable the axis: then its twin takes over")
    says("docs/handbook/commanding.md", "A target that the same Modbus client wrote before it enabled, and has not used yet, stays: it is the target of its next set-point")
    says("docs/handbook/drives-and-twins.md", "With `auto` the twin of a real drive that falls silent while it is powered waits",
         "the drive's `status.text` and the page say so", "disable the axis (`disable`, or control word 0)")
