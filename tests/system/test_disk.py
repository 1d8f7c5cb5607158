"""A disk that is full, that cannot be written, that holds a newer program's database, and a program that is killed while it writes.

In: the program; root's rights, for a file system of a few megabytes in a mount namespace of its own. Out: judgements on what is answered and what
is found again. AXISGATE_KILLS (10): how often it is killed with -9 under the load of writes; 200 take some five minutes.
"""
import contextlib
import ctypes
import http.client
import json
import os
import random
import signal
import sqlite3
import subprocess
import threading
import time

from harness import DEMO, Gateway, run, until

LIBC = ctypes.CDLL(None, use_errno=True)
CLONE_NEWNS = 0x00020000


@contextlib.contextmanager
def small_disk(place, size):
    """A file system of `size` bytes at `place`, which nobody sees but this process and what it starts."""
    assert LIBC.unshare(CLONE_NEWNS) == 0, os.strerror(ctypes.get_errno())
    subprocess.run(["mount", "--make-rprivate", "/"], check=True)
    place.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size},mode=0750", "none", place], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", place], check=True)


def fill(file):
    """To the last byte."""
    with open(file, "wb", buffering=0) as f:
        for n in (65536, 4096, 1):
            with contextlib.suppress(OSError):
                while f.write(b"\0" * n) == n:
                    pass


def write(g, value):
    return g.request("PUT", "/api/v1/axes/feeder/parameters/AC", {"value": value})


def test_a_full_disk_refuses_in_words_and_loses_nothing(folder):
    data = folder / "data"
    with small_disk(data, 8 << 20):
        with Gateway(folder) as g:
            assert write(g, 20001)[0] == 200
            fill(data / "ballast")
            acked = 20001
            for value in range(20002, 20400):  # what the log of the database has room for is still taken
                status, answer, _ = write(g, value)
                if status != 200:
                    break
                acked = value
            assert status == 507 and answer["reason"] == "not_stored" and "full" in answer["detail"] and "Free" in answer["detail"], (status, answer)
            assert g.get("/axes/feeder/parameters/AC")["stored"] == acked, "what was refused is not shown as stored"
            # Machines go on: who commands is not made to wait for a disk.
            assert g.command("slide", {"command": "enable"})["result"] == "done"
            assert g.command("slide", {"command": "move_absolute", "position": 3, "velocity": 30})["result"] == "done"
            code, _, err = run("backup", str(data / "copy.tar"), "--data", str(data))
            assert code == 1 and ("full" in err or "No space left" in err) and not (data / "copy.tar").exists(), err
            assert not [p.name for p in data.iterdir() if ".part" in p.name]
            run("backup", str(folder / "copy.tar"), "--data", str(data), check=0)
            (data / "ballast").unlink()
            until(lambda: write(g, 30001)[0] == 200, 5, "it is taken again")
            os.kill(g.process.pid, signal.SIGKILL)
            g.process.wait()
        fill(data / "ballast")
        # A start on a full disk: it serves, or says what is the matter; it never makes the database worse.
        try:
            with Gateway(folder, None) as g:
                assert g.get("/axes/feeder/parameters/AC")["stored"] == 30001
        except AssertionError as e:
            assert "full" in str(e) or "No space left" in str(e), e
        code, _, err = run("restore", str(folder / "copy.tar"), "--data", str(data))
        assert code == 1 and ("nothing was replaced" in err or "No space left" in err), (code, err)
        (data / "ballast").unlink()
        with Gateway(folder, None) as g:
            assert g.get("/axes/feeder/parameters/AC")["stored"] == 30001
            assert g.stop() == 0
        assert sqlite3.connect(data / "axisgate.db").execute("pragma integrity_check").fetchone()[0] == "ok"


def test_a_disk_that_cannot_be_written_is_said(folder):
    data = folder / "data"

    def remount(how):
        subprocess.run(["mount", "-o", f"remount,{how}", data], check=True)
    with small_disk(data, 8 << 20):
        with Gateway(folder) as g:
            assert write(g, 20001)[0] == 200
            assert g.stop() == 0
        remount("ro")
        code, _, err = run("serve", "--data", str(data), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=off", "--set", "enip.bind=off")
        assert code == 1 and str(data) in err and ("Read-only" in err or "cannot be written" in err), err
        run("backup", str(folder / "copy.tar"), "--data", str(data), check=0)
        code, _, err = run("restore", str(folder / "copy.tar"), "--data", str(data))
        assert code == 1 and "Read-only" in err, err
        remount("rw")
        with Gateway(folder, None) as g:
            assert g.get("/axes/feeder/parameters/AC")["stored"] == 20001
            assert g.stop() == 0


def test_a_database_of_a_newer_program_is_left_as_it_is(folder):
    data = folder / "data"
    with Gateway(folder) as g:
        assert g.stop() == 0
    with contextlib.closing(sqlite3.connect(data / "axisgate.db")) as c:
        c.execute("pragma user_version=99")
        c.commit()
    before = (data / "axisgate.db").read_bytes()
    code, _, err = run("serve", "--data", str(data), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=off", "--set", "enip.bind=off")
    assert code == 1 and "version 99" in err and "Install the newer axisgate" in err, err
    assert (data / "axisgate.db").read_bytes() == before
    run("backup", str(folder / "copy.tar"), "--data", str(data), check=0)
    code, _, err = run("restore", str(folder / "copy.tar"), "--data", str(folder / "other"))
    assert code == 1 and "version 99" in err and not (folder / "other/axisgate.db").exists(), err


def test_no_acknowledged_write_is_lost_by_a_kill(folder):
    """Four writers, each with a parameter of its own and a value that grows; the gateway is killed at any moment of that, again and again."""
    kills = int(os.environ.get("AXISGATE_KILLS", "10"))
    moments = random.Random(11)
    places = [(axis, parameter) for axis in ("feeder", "slide") for parameter in ("AC", "DC")]
    acknowledged, asked, value = {p: [] for p in places}, {p: 0 for p in places}, {p: 10000 for p in places}

    def writer(g, place):
        connection = http.client.HTTPConnection(g.http[0], int(g.http[1]), timeout=10)
        with contextlib.suppress(OSError, http.client.HTTPException, ValueError):
            while True:
                value[place] += 1
                asked[place] += 1
                connection.request("PUT", f"/api/v1/axes/{place[0]}/parameters/{place[1]}", json.dumps({"value": value[place]}), {"Content-Type": "application/json"})
                answer = connection.getresponse()
                told = json.loads(answer.read())
                if answer.status == 200 and told["result"] == "done":
                    acknowledged[place].append(value[place])
        connection.close()
    begun = time.monotonic()
    for n in range(kills + 1):
        with Gateway(folder, DEMO if n == 0 else None) as g:
            for axis, parameter in places:
                if not acknowledged[axis, parameter]:
                    continue
                stored = g.get(f"/axes/{axis}/parameters/{parameter}")["stored"]
                assert acknowledged[axis, parameter][-1] <= stored <= value[axis, parameter], f"after kill {n}: {axis} {parameter}: {stored}, acknowledged {acknowledged[axis, parameter][-1]}"
            with contextlib.closing(sqlite3.connect(folder / "data/axisgate.db")) as c:
                assert c.execute("pragma integrity_check").fetchone()[0] == "ok", f"after kill {n}"
                kept = {p: set() for p in places}
                for axis, parameter, v in c.execute("select a.name, w.parameter, w.value from parameter_write w join axis a on a.id = w.axis_id"):
                    kept[axis, parameter].add(v)
            lost = {p: sorted(set(acknowledged[p]) - kept[p]) for p in places}
            assert not any(lost.values()), f"after kill {n}: {lost}"
            if n == kills:
                assert g.stop() == 0
                break
            writers = [threading.Thread(target=writer, args=(g, p)) for p in places]
            for t in writers:
                t.start()
            time.sleep(moments.uniform(0.02, 0.6))
            os.kill(g.process.pid, signal.SIGKILL)
            g.process.wait()
            for t in writers:
                t.join()
    total = sum(map(len, acknowledged.values()))
    assert total >= 4 * kills, f"{total} writes were acknowledged: the load was none"
    print(f"{kills} kills, {total} acknowledged writes of {sum(asked.values())}, none lost, {time.monotonic() - begun:.0f} s")
