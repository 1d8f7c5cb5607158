"""The lines of the judges: a pseudo-terminal or a TCP port for a drive, a way to either for a host. It knows no protocol.

A drive's line has the freedoms that every serial line leaves open, as switches: answers that are late by a drawn time, that come in pieces, and noise
in front of them. `ready URI` is printed when the line is there; the URI is as a gateway wants it.
"""
import argparse
import os
import pty
import random
import select
import socket
import termios
import time
import tty


def arguments(words):
    """A parser with the switches that all drives have. `words`: the docstring of the judge."""
    parser = argparse.ArgumentParser(description=words.splitlines()[0])
    parser.add_argument("--line", choices=("pty", "tcp"), default="pty")
    parser.add_argument("--answer-ms", default="0", help="time before each answer: N, or A..B to draw from")
    parser.add_argument("--chunk", type=int, default=0, help="answers come in pieces of so many bytes; 0: whole")
    parser.add_argument("--chunk-gap-ms", type=float, default=3, help="time between two pieces")
    parser.add_argument("--noise", type=float, default=0, help="share of answers with a byte of noise in front of them, 0 to 1")
    parser.add_argument("--seed", type=int, default=1)
    return parser


class DriveLine:
    """What a drive hears and says. `serve` runs for ever: it calls `heard(bytes, now)` and, at least every few milliseconds, `tick(now)`."""

    def __init__(self, args, noise=b"\xff"):
        self.args, self.random, self.noise = args, random.Random(args.seed), noise
        low, _, high = args.answer_ms.partition("..")
        self.late = float(low) / 1000, float(high or low) / 1000
        self.waiting, self.free_at = [], 0.0
        self.listener = self.port = self.kept = None
        if args.line == "pty":
            self.port, self.kept = pty.openpty()
            tty.setraw(self.kept)
            os.set_blocking(self.port, False)
            self.uri = "serial:" + os.ttyname(self.kept)
        else:
            self.listener = socket.create_server(("127.0.0.1", 0))
            self.uri = "tcp:127.0.0.1:%d" % self.listener.getsockname()[1]

    def ready(self):
        print("ready", self.uri, flush=True)

    def say(self, data, after_s=0.0, at_once=False):
        """Sends `data` behind everything that was said before. `at_once`: echoes and the like, which no freedom delays."""
        now = time.monotonic()
        due = max(self.free_at, now + after_s + (0.0 if at_once else self.random.uniform(*self.late)))
        if not at_once and self.noise and self.random.random() < self.args.noise:
            data = self.noise + data
        size = self.args.chunk if self.args.chunk and not at_once else len(data)
        for at in range(0, len(data), max(1, size)):
            self.waiting.append((due, data[at:at + size]))
            due += self.args.chunk_gap_ms / 1000 if at + size < len(data) else 0.0
        self.free_at = due
        self._send(now)

    def _send(self, now):
        while self.waiting and self.waiting[0][0] <= now:
            data = self.waiting.pop(0)[1]
            try:
                if self.args.line == "pty":
                    os.write(self.port, data)
                elif self.port is not None:
                    self.port.sendall(data)
            except OSError:
                pass  # nobody is there: a drive does not know

    def _heard(self, source):
        if source is self.listener:
            if self.port is not None:
                self.port.close()
            self.port, _ = self.listener.accept()
            self.port.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return b""
        try:
            data = os.read(self.port, 4096) if self.args.line == "pty" else self.port.recv(4096)
        except OSError:
            data = b""
        if not data and self.args.line == "tcp":
            self.port.close()
            self.port = None
        return data

    def serve(self, heard, tick, period_s=0.004):
        self.ready()
        while True:
            now = time.monotonic()
            wait = min([period_s] + [max(0.0, due - now) for due, _ in self.waiting[:1]])
            sources = [s for s in (self.listener, self.port) if s is not None]
            for source in select.select(sources, [], [], wait)[0]:
                data = self._heard(source)
                if data:
                    tick(time.monotonic())
                    heard(data, time.monotonic())
            now = time.monotonic()
            tick(now)
            self._send(now)


class HostLine:
    """A host's way to a drive: the path of a terminal, or HOST:PORT."""

    def __init__(self, place):
        self.got = b""
        if place.startswith("/"):
            self.fd = os.open(place, os.O_RDWR | os.O_NOCTTY)
            tty.setraw(self.fd, termios.TCSANOW)
        else:
            host, port = place.rsplit(":", 1)
            self.socket = socket.create_connection((host, int(port)), timeout=5)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.fd = self.socket.fileno()

    def send(self, data):
        os.write(self.fd, data)

    def until(self, whole, seconds=5.0):
        """Reads until `whole(bytes)` gives how many bytes make an answer (0: not yet); those bytes. TimeoutError says what came instead."""
        end = time.monotonic() + seconds
        while True:
            size = whole(self.got)
            if size:
                answer, self.got = self.got[:size], self.got[size:]
                return answer
            left = end - time.monotonic()
            if left <= 0:
                raise TimeoutError(f"no whole answer within {seconds} s, but {self.got!r}")
            if select.select([self.fd], [], [], left)[0]:
                self.got += os.read(self.fd, 4096)

    def silent(self, seconds):
        """Whether nothing comes for so long."""
        return not self.got and not select.select([self.fd], [], [], seconds)[0]

    def forget(self):
        while select.select([self.fd], [], [], 0.05)[0]:
            os.read(self.fd, 4096)
        self.got = b""


class Checks:
    """One line for each check of a host, "pass: ..." or "FAIL: ..."; `code` is the exit code."""

    def __init__(self, who):
        self.who, self.failed = who, 0

    def __call__(self, text, good, more=""):
        self.failed += not good
        print(f"{'pass' if good else 'FAIL'}: {self.who}: {text}" + ("" if good else f" ({more})"), flush=True)
        return good

    def until(self, text, condition, seconds=15.0):
        """The first value of `condition()` that is true; a check that fails without one."""
        end, value = time.monotonic() + seconds, None
        while time.monotonic() < end:
            value = condition()
            if value:
                break
        self(text, bool(value), f"not within {seconds} s")
        return value

    @property
    def code(self):
        return 1 if self.failed else 0


def crc16(data):
    """The cyclic redundancy check of Modbus and of UIMessage: A001h, from FFFFh."""
    value = 0xFFFF
    for b in data:
        value ^= b
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return value
