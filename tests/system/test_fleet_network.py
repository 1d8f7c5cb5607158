"""A fleet in networks of its own: state spreads, a cable is cut and joined, a gateway is killed and comes back, clocks are hours apart, and
whatever happens a command is carried out once.

In: the program; root's rights for namespaces; a C compiler for the clock. Out: nothing beside the test's folder.
AXISGATE_FLEET_KILLS (2): how often the gateway is killed; with 50, 1,000 commands are given, some three minutes.
"""
import contextlib
import os
import random
import re
import signal
import subprocess
import threading
import time

from harness import DEMO, Folder, Gateway, Process, until
from netns import Plant

FAR = {"lines": [{"name": "a", "uri": "tcp:127.0.0.1:PORT", "family": "mcode"}],
       "drives": [{"name": "a", "line": "a", "address": "!", "presence": "device"}],
       "axes": [{"name": "a", "drive": "a", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}


def member(folder, name, site=DEMO):
    return Gateway(folder, site, "--set", "dds.enabled=true", "--set", "dds.domain=7", "--set", f"dds.name={name}", "--set", "dds.interface=plant")


@contextlib.contextmanager
def plant_of(*sites):
    """A gateway hall-1, hall-2 ... at each place, with these sites."""
    with contextlib.ExitStack() as stack:
        plant = Plant(len(sites))
        gateways = []
        for n, site in enumerate(sites):
            folder = stack.enter_context(Folder())
            with plant.places[n].inside():
                gateways.append(stack.enter_context(member(folder, f"hall-{n + 1}", site)))
            gateways[-1].folder = folder
        yield plant, gateways


def fleet(plant, gateways, n):
    with plant.places[n].inside():
        return {x["gateway"]: x for x in gateways[n].get("/fleet")["gateways"] if x["alive"]}


def complete(plant, gateways):
    until(lambda: all(len(f := fleet(plant, gateways, n)) == len(gateways) and all(x["axes"] for x in f.values()) for n in range(len(gateways))), 60, "all see all")


def events(g, word):
    return [e["text"] for e in g.get("/events?limit=500") if e["kind"] == "fleet" and word in e["text"]]


def test_a_cable_is_cut_and_joined_again(folder):
    with plant_of(DEMO, DEMO, DEMO) as (plant, g):
        complete(plant, g)
        to_third = "/fleet/hall-3/axes/feeder/commands"
        with plant.places[0].inside():
            assert g[0].send("POST", to_third + "?wait=10", {"command": "enable"})["result"] == "done"
        begun = time.monotonic()
        plant.cut(2)
        until(lambda: "hall-3" not in fleet(plant, g, 0) and "hall-3" not in fleet(plant, g, 1), 10, "its loss is told")
        assert time.monotonic() - begun < 5, "within its lease of 2 s, and as long as its last word waited"
        until(lambda: set(fleet(plant, g, 2)) == {"hall-3"}, 10, "it misses the others")
        with plant.places[0].inside():
            status, answer, _ = g[0].request("POST", "/api/v1" + to_third, {"command": "move_relative", "position": 1})
            assert status == 503 and "hall-3 is gone" in answer["detail"], (status, answer)
        with plant.places[2].inside():
            assert g[2].command("feeder", {"command": "move_relative", "position": 1, "velocity": 30})["result"] == "done", "its own commands go on"
        plant.join(2)
        complete(plant, g)
        with plant.places[0].inside():
            assert g[0].send("POST", to_third + "?wait=20", {"command": "move_relative", "position": 1, "velocity": 30})["result"] == "done"
            assert len(events(g[0], "hall-3 is gone")) == 1 and len(events(g[0], "hall-3 is in the domain")) == 2, events(g[0], "hall-3")
        with plant.places[2].inside():
            assert g[2].axis("feeder")["position"] == 2


def test_a_cut_in_the_middle_of_a_command_makes_no_second_one(folder):
    with plant_of(DEMO, DEMO) as (plant, g):
        complete(plant, g)
        answers = []

        def ask():
            with plant.places[0].inside():
                answers.append(g[0].request("POST", "/api/v1/fleet/hall-2/axes/feeder/commands?wait=30", {"command": "move_relative", "position": 20, "velocity": 10}))
        with plant.places[0].inside():
            assert g[0].send("POST", "/fleet/hall-2/axes/feeder/commands?wait=10", {"command": "enable"})["result"] == "done"
        asking = threading.Thread(target=ask)
        asking.start()
        time.sleep(0.5)
        plant.cut(1)
        time.sleep(1)  # less than the lease: the command is sent again and again, into nothing
        plant.join(1)
        asking.join(40)
        assert answers and answers[0][0] == 200 and answers[0][1]["result"] == "done", answers
        with plant.places[1].inside():
            assert g[1].axis("feeder")["position"] == 20, "once"


def test_clocks_that_are_hours_apart_change_nothing(folder):
    """The lifespan of a command is a time that passes, not one on a clock."""
    shim = folder / "clock.c"
    shim.write_text("""#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
static long ahead(void) { const char *s = getenv("CLOCK_AHEAD_S"); return s ? atol(s) : 0; }
int clock_gettime(clockid_t c, struct timespec *t) {
  int r = syscall(SYS_clock_gettime, c, t);
  if (c == CLOCK_REALTIME && r == 0) t->tv_sec += ahead();
  return r;
}
int gettimeofday(struct timeval *restrict t, void *restrict z) {
  struct timespec s; (void)z; clock_gettime(CLOCK_REALTIME, &s); t->tv_sec = s.tv_sec; t->tv_usec = s.tv_nsec / 1000; return 0;
}
/* Who waits until a time of this clock waits in the kernel by the true one. */
int pthread_cond_timedwait(pthread_cond_t *restrict c, pthread_mutex_t *restrict m, const struct timespec *restrict t) {
  static int (*real)(pthread_cond_t *, pthread_mutex_t *, const struct timespec *);
  struct timespec now, until = *t;
  if (!real) real = dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
  long left = t->tv_sec - (now.tv_sec + ahead());
  if (-1800 < left && left < 1800) until.tv_sec -= ahead();
  return real(c, m, &until);
}
time_t time(time_t *t) { struct timespec s; clock_gettime(CLOCK_REALTIME, &s); if (t) *t = s.tv_sec; return s.tv_sec; }
""")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", str(folder / "clock.so"), str(shim)], check=True)
    with contextlib.ExitStack() as stack:
        plant, g = Plant(3), []
        for n, ahead in enumerate((0, 3 * 3600, -5 * 3600)):
            where = stack.enter_context(Folder())
            os.environ.update(LD_PRELOAD=str(folder / "clock.so"), CLOCK_AHEAD_S=str(ahead))
            try:
                with plant.places[n].inside():
                    g.append(stack.enter_context(member(where, f"hall-{n + 1}")))
            finally:
                del os.environ["LD_PRELOAD"], os.environ["CLOCK_AHEAD_S"]
        complete(plant, g)
        seen = fleet(plant, g, 0)
        assert abs(seen["hall-2"]["clock_ahead_ms"] - 3 * 3_600_000) < 5000 and abs(seen["hall-3"]["clock_ahead_ms"] + 5 * 3_600_000) < 5000, seen
        for x in seen.values():
            assert all(a["age_ms"] < 5000 for a in x["axes"]), x
        for n in range(3):
            with plant.places[n].inside():
                for other in {1, 2, 3} - {n + 1}:
                    path = f"/fleet/hall-{other}/axes/{'feeder' if n else 'slide'}/commands?wait=20"
                    assert g[n].send("POST", path, {"command": "enable"})["result"] == "done"
                    assert g[n].send("POST", path, {"command": "move_relative", "position": 1, "velocity": 30})["result"] == "done", (n, other)


def test_a_gateway_is_killed_and_comes_back_and_each_command_is_carried_out_once(folder):
    """The drive stands by itself and counts: after each command it is where it was, or one step further, as the answer says."""
    kills = int(os.environ.get("AXISGATE_FLEET_KILLS", "2"))
    commands = 20 * kills
    plant = Plant(2)
    with contextlib.ExitStack() as stack:
        with plant.places[1].inside():
            far = stack.enter_context(Process("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0"))
        port = re.search(r"127\.0\.0\.1:(\d+)", far.ready).group(1)
        site = {**FAR, "lines": [{**FAR["lines"][0], "uri": f"tcp:127.0.0.1:{port}"}]}
        with plant.places[0].inside():
            one = stack.enter_context(member(folder, "hall-1"))
        where = stack.enter_context(Folder())
        life = contextlib.ExitStack()
        stack.callback(life.close)

        def start():
            with plant.places[1].inside():
                two = life.enter_context(member(where, "hall-2", site))
                until(lambda: two.axis("a")["online"], 20, "the drive is found")
            until(lambda: any(a["online"] for x in fleet(plant, [one], 0).values() if x["gateway"] == "hall-2" for a in x["axes"]), 20, "hall-1 sees it")
            return two

        def send(body):
            with plant.places[0].inside():
                status, answer, _ = one.request("POST", "/api/v1/fleet/hall-2/axes/a/commands?wait=20", body)
                return status, answer

        def position():
            with plant.places[1].inside():
                until(lambda: (x := two.axis("a"))["online"] and not x["moving"], 20, "it stands")
                return round(two.axis("a")["position"])

        def enable():
            until(lambda: send({"command": "enable"})[0] == 200, 20, "it is enabled")

        two = start()
        enable()
        place, done, unknown, refused, killed = position(), 0, 0, 0, 0
        shuffled = random.Random(7)
        for n in range(commands):
            killer = None
            if n % 20 == 10:
                killer = threading.Timer(shuffled.uniform(0, 0.08), two.process.send_signal, [signal.SIGKILL])
                killer.start()
            status, answer = send({"command": "move_relative", "position": 1, "velocity": 50, "acceleration": 2000, "deceleration": 2000})
            if killer:
                killer.join()
                life.close()
                killed += 1
                two = start()
            now = position()
            if status == 200:
                assert now == place + 1, f"command {n} was answered {answer['result']}, and the drive went from {place} to {now}"
                done += 1
            elif answer.get("result") == "failed":
                assert now in (place, place + 1), f"command {n}: {answer}: from {place} to {now}"
                unknown += 1
            else:
                assert now == place, f"command {n} was refused, {answer}: from {place} to {now}"
                refused += 1
            place = now
            if killer:
                enable()
        assert killed == kills and done + unknown + refused == commands, (done, unknown, refused, killed)
        assert done >= commands - kills, f"{done} done, {unknown} unknown, {refused} refused: only what a kill met is not done"
        print(f"{commands} commands, {kills} kills: {done} done, {unknown} of which nobody knew, {refused} refused; each once at most")
