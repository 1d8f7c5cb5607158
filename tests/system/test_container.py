"""The container file and `deploy/run --use`, as far as they can be judged without a container engine and without a network.

In: deploy/container/Containerfile, the package's files, the program. Out: judgements; a copy of the tree's deploy folder in the test's own.
"""
import http.client
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import socket
import struct
import subprocess
import time

import harness
from harness import Process, run, until
from netns import Plant
from test_enip import Originator, statusword

TOP = pathlib.Path(__file__).resolve().parents[2]
KNOWN = {"FROM", "COPY", "RUN", "USER", "VOLUME", "STOPSIGNAL", "HEALTHCHECK", "ENTRYPOINT", "CMD"}


def instructions(text):
    """As an engine reads them: comments and empty lines aside, continued lines joined."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    joined = re.sub(r"\\\n", " ", "\n".join(lines))
    return [tuple(line.strip().split(None, 1)) for line in joined.splitlines()]


def test_the_container_file_is_sound():
    text = (TOP / "deploy/container/Containerfile").read_text()
    all_of = instructions(text)
    names = [name for name, _ in all_of]
    of = {name: rest for name, rest in all_of}
    assert set(names) <= KNOWN, "what is not understood here is not judged"
    assert all(names.count(n) == 1 for n in names), names
    release = "bookworm"
    assert re.fullmatch(rf"docker\.io/library/debian:{release}(-slim)?", of["FROM"]), of["FROM"]
    assert names[0] == "FROM" and names.index("USER") > names.index("RUN"), "root is for the installation alone"
    # The package, as deploy/package names it, and nothing else of the tree.
    source, target = shlex.split(of["COPY"])
    assert source == "axisgate_*.deb" and target == "/tmp/" and "build/package/axisgate_*.deb" in (TOP / "deploy/package").read_text().replace("$out", "build/package")
    # What it runs as is the user that the package makes, and nobody with a number of 0.
    user = of["USER"]
    assert re.search(rf"^u {user} ", (TOP / "systemd/axisgate.sysusers").read_text(), re.M) and user not in ("root", "0"), user
    # Installed are the package and the tool for its user; what the package depends on comes with it, by the same list as on a host.
    commands = [shlex.split(c) for c in of["RUN"].split("&&")]
    installed = [w for c in commands if c[:2] == ["apt-get", "install"] for w in c[2:] if not w.startswith("-")]
    assert installed == ["systemd-standalone-sysusers", "/tmp/axisgate_*.deb"], installed
    known = subprocess.run(["apt-cache", "show", "--no-all-versions", installed[0]], capture_output=True, text=True)
    if known.returncode == 0:  # where the lists of packages are there
        assert f"Package: {installed[0]}" in known.stdout
    assert any(c[0] == "rm" and "/var/lib/apt/lists/*" in c for c in commands), "no lists in the image"
    # Its folders are those of the unit, with its rights.
    unit = (TOP / "systemd/axisgate.service").read_text()
    places = {f"/var/lib/{unit.split('StateDirectory=')[1].split()[0]}": unit.split("StateDirectoryMode=")[1].split()[0],
              f"/run/{unit.split('RuntimeDirectory=')[1].split()[0]}": unit.split("RuntimeDirectoryMode=")[1].split()[0]}
    made = {c[-1]: (c[c.index("-o") + 1], c[c.index("-m") + 1]) for c in commands if c[0] == "install"}
    assert made == {place: (user, mode) for place, mode in places.items()}, made
    assert json.loads(of["VOLUME"]) == ["/var/lib/axisgate"] == [re.search(r'^dir = "([^"]+)"', (TOP / "systemd/axisgate.toml").read_text(), re.M).group(1)]
    # It starts as the unit starts it, and its signal is the one that brings axes to rest.
    assert json.loads(of["ENTRYPOINT"]) + json.loads(of["CMD"]) == shlex.split(unit.split("ExecStart=")[1].splitlines()[0])
    assert of["STOPSIGNAL"] == "SIGTERM"
    # No port is opened to others by the image: the package's configuration stays on loopback, and no environment changes it.
    toml = (TOP / "systemd/axisgate.toml").read_text()
    assert "ENV" not in names and "EXPOSE" not in names and all(b.startswith(("127.0.0.1:", "off")) for b in re.findall(r'^bind = "([^"]+)"', toml, re.M))
    # What is installed where: each path that an instruction names is one that the package brings.
    brought = {f"/{target}/{name}" for name, target in (line.split() for line in (TOP / "deploy/debian/install").read_text().splitlines())}
    health = json.loads(of["HEALTHCHECK"].split("CMD", 1)[1])
    for command in (health, json.loads(of["ENTRYPOINT"]) + json.loads(of["CMD"])):
        assert [w for w in command if w.startswith("/")] and {w for w in command if w.startswith("/")} <= brought, (command, brought)
        assert command[0] == "/usr/bin/axisgate"
    # And what the comments tell people to type has the folders, too.
    assert "--read-only" in text and "--tmpfs /run/axisgate" in text and "--cap-drop all" in text and "axisgate:/var/lib/axisgate" in text


def test_health_is_asked_as_the_container_asks_it(folder):
    """With TLS, without, and of a gateway that is not there; with a root that cannot be written but for its folders."""
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        port = s.getsockname()[1]
    toml = folder / "axisgate.toml"
    for tls in ("off", "self_signed"):
        toml.write_text(f'[data]\ndir = "{folder}/data"\n[http]\nbind = "0.0.0.0:{port}"\ntls = "{tls}"\nallowed_hosts = ["box"]\n[modbus]\nbind = "off"\n[enip]\nbind = "off"\n[users]\nlocal_role = "none"\n')  # noqa: E501
        code, _, err = run("health", "--config", str(toml))
        assert code == 1 and "not well" in err and str(port) in err, err
        with Process("serve", "--config", str(toml)) as g:
            code, out, err = run("health", "--config", str(toml))
            assert code == 0 and '"status":"ok"' in out, (tls, out, err)
            os.kill(g.process.pid, signal.SIGSTOP)
            assert run("health", "--config", str(toml))[0] == 1, "it stands"
            os.kill(g.process.pid, signal.SIGCONT)
            assert g.stop() == 0
    code, _, err = run("health", "--set", "http.bind=off")
    assert code == 1 and "no HTTP door" in err, err


def test_it_serves_as_nobody_on_a_root_that_nobody_can_write(folder):
    """What `--read-only`, `USER` and `--cap-drop all` are to the program: two folders to write in, no right beyond a user's."""
    (folder / "data").mkdir()
    (folder / "run").mkdir()
    folder.chmod(0o755)
    program, harness.PROGRAM = harness.PROGRAM, "unshare"
    script = """mount --make-rprivate / && mount -t tmpfs -o mode=0700,uid=65534,gid=65534 none "$1/data" && mount -t tmpfs -o uid=65534,gid=65534 none "$1/run" && cd / || exit 3
        for place in / /tmp /src "$(df --output=target "$2" | tail -n 1)"; do if mountpoint -q "$place"; then mount -o remount,bind,ro "$place" || exit 3; fi; done
        exec setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all --no-new-privs "$2" serve --data "$1/data" --site "$1/site.json" \
            --set http.bind=127.0.0.1:0 --set http.tls=self_signed --set modbus.bind=127.0.0.1:0 --set enip.bind=off --set "lines.pty_dir=$1/run"
    """
    (folder / "site.json").write_text(json.dumps(harness.DEMO))
    try:
        with Process("--mount", "sh", "-c", script, "sh", str(folder), program) as g:
            status = pathlib.Path(f"/proc/{g.process.pid}/status").read_text()
            assert re.search(r"^Uid:\s+65534\s+65534", status, re.M) and re.search(r"^CapEff:\s+0+$", status, re.M) and re.search(r"^CapBnd:\s+0+$", status, re.M), status
            inside = pathlib.Path(f"/proc/{g.process.pid}/root{folder}")
            assert {"axisgate.db", "http-key.pem"} <= {p.name for p in (inside / "data").iterdir()}
            mounts = pathlib.Path(f"/proc/{g.process.pid}/mounts").read_text()
            assert re.search(r"^\S+ / \S+ ro,", mounts, re.M), mounts
            assert g.stop() == 0
    finally:
        harness.PROGRAM = program


def test_run_takes_a_built_program_or_package(folder):
    """deploy/run --use in a tree that has nothing to build with: neither the page nor a compiler is asked for."""
    shutil.copytree(TOP / "deploy", folder / "deploy", ignore=shutil.ignore_patterns("node_modules"))
    program = folder / "axisgate"
    shutil.copy(harness.PROGRAM, program)
    env = {**os.environ, "AXISGATE_HTTP_BIND": "127.0.0.1:0", "AXISGATE_MODBUS_BIND": "127.0.0.1:0", "AXISGATE_ENIP_BIND": "off"}

    def use(*arguments):
        return subprocess.run([folder / "deploy/run", *arguments], cwd=folder, env=env, capture_output=True, text=True, timeout=60)
    root = folder / "pack"
    for name in ("DEBIAN", "usr/bin"):
        (root / name).mkdir(parents=True)
    shutil.copy(program, root / "usr/bin/axisgate")
    (root / "DEBIAN/control").write_text("Package: axisgate\nVersion: 0.0.1\nArchitecture: amd64\nMaintainer: x <x@axisgate.example>\nDescription: x\n")
    package = folder / "axisgate_0.0.1_amd64.deb"
    subprocess.run(["dpkg-deb", "-Zgzip", "-z1", "--build", "--root-owner-group", root, package], check=True, capture_output=True)
    empty = folder / "empty.deb"
    empty.write_bytes(b"no package")
    (folder / "text").write_text("no program")
    for wrong in ("nothing-there", empty, folder / "text", ""):
        p = use("--use", str(wrong))
        assert p.returncode == 1 and "deploy:" in p.stderr, (wrong, p)
    for given in (program, package):
        built = use("--build-only", "--use", str(given))
        assert built.returncode == 0 and "built: " in built.stdout, built
        with subprocess.Popen([folder / "deploy/run", "--use", given, "--set", "dds.enabled=false"], cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as p:
            try:
                lines = []
                for line in p.stdout:
                    lines.append(line)
                    if line.startswith("ready"):
                        break
                said = "".join(lines)
                ready = re.search(r"http=(127\.0\.0\.1):(\d+)", said)
                assert ready, said
                c = http.client.HTTPConnection(ready[1], int(ready[2]), timeout=10)
                c.request("GET", "/api/v1/axes")
                assert len(json.loads(c.getresponse().read())) == 11, "the demo site"
                c.close()
            finally:
                p.terminate()
                p.wait(20)
        until(lambda: not [x for x in (folder / "var").rglob("*-wal")], 10, "it ended in order")
    assert not (folder / "build/release").exists(), "nothing was built"


def test_run_starts_a_fleet_whose_printed_lines_move_an_axis_of_another(folder):
    """deploy/run --fleet 3 in a network of its own, since its ports are fixed: the curl lines that it prints are run as they stand."""
    shutil.copytree(TOP / "deploy", folder / "deploy", ignore=shutil.ignore_patterns("node_modules"))

    def curl(line):
        p = subprocess.run(["bash", "-c", line.replace("curl -s", "curl -s --max-time 10 --fail-with-body")], capture_output=True, text=True)
        return json.loads(p.stdout) if p.returncode == 0 else {"code": p.returncode, "said": p.stdout}
    with Plant(1).places[0].inside(), subprocess.Popen([folder / "deploy/run", "--use", harness.PROGRAM, "--fleet", "3"], cwd=folder,
                                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as p:
        try:
            lines, ready = [], 0
            for line in p.stdout:
                lines.append(line.strip())
                ready += line.startswith("ready")
                if ready == 3 and "".join(lines).count("Ctrl-C"):
                    break
            show, enable, move, mirror = [line for line in lines if line.startswith("curl ")]
            until(lambda: sorted(x["gateway"] for x in curl(show)["gateways"] if x["alive"] and x["axes"]) == ["hall-1", "hall-2", "hall-3"], 30, "one page, three gateways")
            assert curl(enable).get("result") == "done", lines
            begun = curl("curl -s http://127.0.0.1:8082/api/v1/axes/feeder")["position"]
            assert "result" in curl(move)
            until(lambda: curl("curl -s http://127.0.0.1:8082/api/v1/axes/feeder")["position"] > begun + 1, 20, "an axis of hall-2 moves")
            until(lambda: curl(mirror).get("position", 0) > begun + 1, 20, "and hall-1 shows it as its own")
        finally:
            p.terminate()
            p.stdout.read()
            p.wait(30)


def test_run_prints_an_ethernet_ip_address_that_a_scanner_finds_and_moves_an_axis_by(folder):
    """deploy/run in a network of its own: the address that it prints is browsed, and held by a class 1 connection that moves the demo's axis."""
    shutil.copytree(TOP / "deploy", folder / "deploy", ignore=shutil.ignore_patterns("node_modules"))
    with Plant(1).places[0].inside(), subprocess.Popen([folder / "deploy/run", "--use", harness.PROGRAM, "--set", "dds.enabled=false"], cwd=folder,
                                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as p:
        try:
            printed = None
            for line in p.stdout:
                printed = printed or re.search(r"EtherNet/IP +(\d+\.\d+\.\d+\.\d+):(\d+), TCP and UDP, implicit data on UDP (\d+)", line)
                if line.startswith("ready"):
                    break
            assert printed, "deploy/run prints no EtherNet/IP address"
            with Originator(printed[1], int(printed[2]), int(printed[3])) as o:
                assert o.get(1, 1, 7) == b"\x08axisgate"
                assert struct.unpack("<H", o.get(4, 101, 4))[0] == 32
                assert o.open(151, 101) == (0, ())
                o.start()
                for word, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
                    o.write(word)
                    until(lambda: statusword(o.inputs()) & 0x6F == state, 10, f"state {state:#x}")
                target = struct.unpack("<i", o.inputs()[4:8])[0] + 3200
                o.write(0x0F, 1, target, 3200)
                time.sleep(0.05)
                o.write(0x1F, 1, target, 3200)
                until(lambda: struct.unpack("<i", o.inputs()[4:8])[0] == target, 10, "the target")
        finally:
            p.terminate()
            p.stdout.read()
            p.wait(30)
