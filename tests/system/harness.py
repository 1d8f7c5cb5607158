"""Starts the real program in a folder of its own and talks to it as an outsider would.

In: the program's path. Out: Gateway and Twin objects, an API client, a Modbus client of plain sockets. Never leaves a process behind.
"""
import termios
import select
import http.client
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import time

PROGRAM = None
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "deploy/examples"
DEMO = {
    "lines": [{"name": "can0", "uri": "twin", "family": "uim342", "bitrate": 1000000}],
    "drives": [{"name": "feeder", "line": "can0", "address": 5, "presence": "auto"}, {"name": "slide", "line": "can0", "address": 6, "presence": "twin"}],
    "axes": [{"name": "feeder", "drive": "feeder", "channel": 1, "number": 1, "unit": "mm", "increments_per_unit": 3200},
             {"name": "slide", "drive": "slide", "channel": 1, "number": 2, "unit": "mm", "increments_per_unit": 100, "position_min": -50, "position_max": 50}],
    "mappings": [{"id": "m1", "unit": 2, "table": "holding_registers", "address": 0, "axis": "feeder", "point": "position", "type": "i32"}],
}


def until(condition, seconds=10.0, what="condition"):
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"{what}: not within {seconds} s")
        time.sleep(0.02)


def run(*arguments, stdin=None, check=None, env=None):
    """The program, run to its end: (code, standard output, standard error)."""
    p = subprocess.run([PROGRAM, *arguments], input=stdin, capture_output=True, text=True, timeout=60, env={**os.environ, **(env or {})})
    if check is not None:
        assert p.returncode == check, f"{arguments}: code {p.returncode}: {p.stdout}{p.stderr}"
    return p.returncode, p.stdout, p.stderr


class Process:
    def __init__(self, *arguments, limit=20, program=None, env=None):
        self.log = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([program or PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=self.log, text=True, env={**os.environ, **(env or {})})
        self.ready = ""
        self.code = ""  # of the first sign-in, if it was printed
        os.set_blocking(self.process.stdout.fileno(), False)

        def said_ready():
            if self.process.poll() is not None:
                raise AssertionError(f"{arguments[0]} ended with {self.process.returncode}: {self.errors()}")
            line = self.process.stdout.readline()
            if line.startswith("first sign-in: code "):
                self.code = line.split()[3]
            if line.startswith("ready"):
                self.ready = line.strip()
            return self.ready
        until(said_ready, limit, f"ready of {arguments[0]}")

    def word(self, key):
        for w in self.ready.replace(";", " ").split():
            if w.startswith(key + "="):
                return w[len(key) + 1:]
        raise AssertionError(f"no {key}= in: {self.ready}")

    def errors(self):
        self.log.seek(0)
        return self.log.read()

    def stop(self, sig=signal.SIGTERM):
        if self.process.poll() is None:
            self.process.send_signal(sig)
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
                raise AssertionError("the program did not end when it was asked to")
        return self.process.returncode

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.log.close()


def alone(test):
    """Marks a test that compares instants of several programs: it runs when all others have ended."""
    test.alone = True
    return test


class Folder:
    def __enter__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="axisgate-test-"))
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)


class Gateway(Process):
    def __init__(self, folder, site=DEMO, *more, program=None, env=None):
        arguments = ["serve", "--data", str(folder / "data"), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=127.0.0.1:0", "--set", "enip.bind=127.0.0.1:0"]
        if site is not None:
            (folder / "site.json").write_text(json.dumps(site))
            for name in {d["description"] for d in site.get("drives", ()) if "description" in d}:
                if (EXAMPLES / name).exists():
                    shutil.copy(EXAMPLES / name, folder)
            arguments += ["--site", str(folder / "site.json")]
        super().__init__(*arguments, *more, program=program, env=env)
        self.http = self.word("http").rsplit(":", 1)
        self.modbus_port = int(self.word("modbus").rsplit(":", 1)[1])

    def request(self, method, path, body=None, headers=None, seconds=40):
        c = http.client.HTTPConnection(self.http[0], int(self.http[1]), timeout=seconds)
        try:
            head = dict(headers or {})
            if body is not None and not isinstance(body, (bytes, str)):
                body = json.dumps(body)
                head.setdefault("Content-Type", "application/json")
            c.request(method, path, body=body, headers=head)
            r = c.getresponse()
            data = r.read()
            kind = r.getheader("Content-Type", "")
            return r.status, (json.loads(data) if "json" in kind and data else data), dict(r.getheaders())
        finally:
            c.close()

    def get(self, path, status=200):
        s, body, _ = self.request("GET", "/api/v1" + path)
        assert s == status, f"GET {path}: {s} {body}"
        return body

    def send(self, method, path, body, status=200):
        s, answer, _ = self.request(method, "/api/v1" + path, body)
        assert s == status, f"{method} {path}: {s} {answer}"
        return answer

    def axis(self, name="feeder"):
        return self.get(f"/axes/{name}")

    def command(self, name, body, wait=20, status=200):
        return self.send("POST", f"/axes/{name}/commands" + (f"?wait={wait}" if wait else ""), body, status)

    def modbus(self):
        return Modbus(self.modbus_port)

    def mbpoll(self, *arguments, values=()):
        p = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(self.modbus_port), "-a", "1", "-B", "-0", "-1", "-q", *arguments, "127.0.0.1",
                            *map(str, values)], capture_output=True, text=True, timeout=20)
        return p.returncode, p.stdout + p.stderr


class ModbusException(Exception):
    def __init__(self, code):
        super().__init__(f"exception {code}")
        self.code = code


class Modbus:
    """A client of plain sockets, so that requests can be as wrong as a test wants them."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.transaction = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def exact(self, n):
        data = b""
        while len(data) < n:
            part = self.socket.recv(n - len(data))
            if not part:
                raise ConnectionError("closed")
            data += part
        return data

    def pdu(self, pdu, unit=1):
        self.transaction = (self.transaction + 1) & 0xFFFF
        self.socket.sendall(struct.pack(">HHHB", self.transaction, 0, len(pdu) + 1, unit) + pdu)
        t, p, n, u = struct.unpack(">HHHB", self.exact(7))
        answer = self.exact(n - 1)
        assert (t, p, u) == (self.transaction, 0, unit)
        if answer[0] & 0x80:
            raise ModbusException(answer[1])
        return answer

    def read(self, address, count, unit=1, function=3):
        a = self.pdu(struct.pack(">BHH", function, address, count), unit)
        assert a[1] == 2 * count
        return list(struct.unpack(f">{count}H", a[2:]))

    def read32(self, address, signed=True, unit=1):
        high, low = self.read(address, 2, unit)
        v = high << 16 | low
        return v - (1 << 32) if signed and v & 0x80000000 else v

    def write(self, address, values, unit=1):
        values = [v & 0xFFFF for v in values]
        self.pdu(struct.pack(f">BHHB{len(values)}H", 16, address, len(values), 2 * len(values), *values), unit)

    def write1(self, address, value, unit=1):
        self.pdu(struct.pack(">BHH", 6, address, value & 0xFFFF), unit)

    def write32(self, address, value):
        self.write(address, [(value >> 16) & 0xFFFF, value & 0xFFFF])


class Port:
    """A pseudo-terminal as a terminal program opens it: raw, 9600 bit/s."""

    def __init__(self, path, character_size=termios.CS8):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        mode = termios.tcgetattr(self.fd)
        mode[0] = mode[1] = mode[3] = 0
        mode[2] = character_size | termios.CREAD | termios.CLOCAL
        mode[4] = mode[5] = termios.B9600
        termios.tcsetattr(self.fd, termios.TCSANOW, mode)

    def ask(self, data, enough=None, seconds=5.0):
        """What comes until `enough` holds for it; without it, what comes in a third of a second."""
        os.write(self.fd, data)
        got, end = b"", time.monotonic() + (seconds if enough else 0.35)
        while time.monotonic() < end and not (enough and enough(got)):
            if select.select([self.fd], [], [], 0.05)[0]:
                got += os.read(self.fd, 256)
        return got

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.fd)
