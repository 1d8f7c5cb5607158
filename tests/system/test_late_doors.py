"""Doors whose address or interface is late, and a DDS interface that goes away: the program in a network namespace of its own.

In: a pair of veth interfaces. Out: doors that wait, say so, and open when their address has come; an end within its time-out."""
import random
import socket
import subprocess
import time
import urllib.error
import urllib.request

import harness

PAIR = "ip link set lo up && ip link add door0 type veth peer name door1 && ip link set door1 up"


def enter(script, folder, limit=60):
    return subprocess.run(["unshare", "--net", "sh", "-ec", f"{PAIR}\n{script}"], cwd=folder, capture_output=True, text=True, timeout=limit)


def test_a_late_address_is_waited_for_and_served(folder):
    done = enter(f"""
        {harness.PROGRAM} serve --data {folder}/data --set http.bind=127.0.0.1:8080 --set modbus.bind=10.9.8.7:1502 --set enip.bind=10.9.8.7:44818 >out 2>err &
        gateway=$!
        for i in $(seq 100); do grep -q '^ready' out && break; sleep 0.1; done
        grep '^ready' out
        curl -s http://127.0.0.1:8080/readyz
        ip addr add 10.9.8.7/24 dev door0 && ip link set door0 up
        for i in $(seq 100); do [ "$(curl -s -o /dev/null -w '%{{http_code}}' http://127.0.0.1:8080/readyz)" = 200 ] && break; sleep 0.1; done
        curl -s http://127.0.0.1:8080/api/v1/about
        kill $gateway; wait $gateway
    """, folder)
    assert done.returncode == 0, (done, (folder / "err").read_text())
    ready, rest = done.stdout.split("\n", 1)
    assert "http=127.0.0.1:8080" in ready and "the Modbus door waits" in ready and "the EtherNet/IP door waits" in ready, ready
    assert "the Modbus door waits" in rest.split("}")[0], rest
    assert "10.9.8.7:1502" in rest and "10.9.8.7:44818" in rest, rest


def test_a_wrong_address_still_ends_the_start(folder):
    done = enter(f"{harness.PROGRAM} serve --data {folder}/data --set modbus.bind=somewhere:1502 || echo ended $?", folder)
    assert "ended" in done.stdout, done


def test_a_gateway_ends_while_its_dds_interface_is_down(folder):
    begun = time.monotonic()
    done = enter(f"""
        ip addr add 10.9.8.7/24 dev door0 && ip link set door0 up
        {harness.PROGRAM} serve --data {folder}/data --set http.bind=127.0.0.1:8080 --set dds.enabled=true --set dds.interface=door0 >out 2>err &
        gateway=$!
        for i in $(seq 100); do grep -q '^ready' out && break; sleep 0.1; done
        ip link set door0 down
        kill $gateway
        for i in $(seq 100); do kill -0 $gateway 2>/dev/null || break; sleep 0.1; done
        if kill -0 $gateway 2>/dev/null; then kill -KILL $gateway; echo stays; exit 1; fi
        wait $gateway
    """, folder)
    assert done.returncode == 0, (done, (folder / "err").read_text()[-2000:])
    assert time.monotonic() - begun < 50


def taken_port(kind):
    """A socket that has a port for itself. Below the ports that a system gives to connections, so that none of those takes it when it is given back."""
    for port in random.sample(range(20000, 30000), 100):
        other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM if kind == socket.SOCK_STREAM else socket.SOCK_STREAM)
        taken = socket.socket(socket.AF_INET, kind)
        try:
            with other:
                other.bind(("127.0.0.1", port))
                taken.bind(("127.0.0.1", port))
            if kind == socket.SOCK_STREAM:
                taken.listen()
            return taken
        except OSError:
            taken.close()
    raise AssertionError("a hundred ports are all taken")


def test_a_taken_port_is_waited_for_and_told(folder):
    """Each of the three doors in turn: another program has its port at the start, and gives it back."""
    for door, told, key in (("http", "the http door waits", "http.bind"), ("modbus", "the Modbus door waits", "modbus.bind"), ("enip", "the EtherNet/IP door waits", "enip.bind")):
        with taken_port(socket.SOCK_STREAM) as taken:
            address = "127.0.0.1:%d" % taken.getsockname()[1]
            binds = {"http.bind": "127.0.0.1:0", "modbus.bind": "127.0.0.1:0", "enip.bind": "127.0.0.1:0", key: address}
            more = [x for k, v in binds.items() for x in ("--set", f"{k}={v}")]
            with harness.Process("serve", "--data", str(folder / door), *more) as g:
                assert told in g.ready and f"{door}={address}" not in g.ready, g.ready
                assert told in g.errors() and address in g.errors(), g.errors()
                if door != "http":  # the others serve meanwhile, and say what is missing
                    host, port = g.word("http").rsplit(":", 1)
                    with urllib.request.urlopen(f"http://{host}:{port}/healthz", timeout=10) as r:
                        assert r.status == 200
                    try:
                        urllib.request.urlopen(f"http://{host}:{port}/readyz", timeout=10)
                        raise AssertionError("it says that all is well")
                    except urllib.error.HTTPError as e:
                        assert e.code == 503 and told in e.read().decode()
                taken.close()
                at = address.rsplit(":", 1)

                def listens():
                    try:
                        socket.create_connection((at[0], int(at[1])), timeout=2).close()
                        return True
                    except OSError:
                        return False
                harness.until(listens, 10, f"the {door} door")
                harness.until(lambda: f"the {'Modbus' if door == 'modbus' else 'EtherNet/IP' if door == 'enip' else door} door is open now" in g.errors(), 5, "the word of it")
                assert g.stop() == 0


def test_a_taken_udp_port_of_ethernet_ip_is_waited_for(folder):
    with taken_port(socket.SOCK_DGRAM) as taken:
        port = taken.getsockname()[1]
        with harness.Process("serve", "--data", str(folder / "data"), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=127.0.0.1:0", "--set", f"enip.bind=127.0.0.1:{port}") as g:
            assert "the EtherNet/IP door waits" in g.ready, g.ready
            taken.close()
            harness.until(lambda: "the EtherNet/IP door is open now" in g.errors(), 10, "the door")
            assert g.stop() == 0
