"""Networks of a test's own: namespaces with one interface each on a bridge, which can be cut off and joined again.

In: the rights of root. Out: a way to start and ask programs inside. Never touches a network that it did not make: all of it is in namespaces
without a name, gone with the last of their files.
"""
import contextlib
import ctypes
import os
import subprocess
import threading

LIBC = ctypes.CDLL(None, use_errno=True)
CLONE_NEWNET = 0x40000000


def checked(value):
    if value != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


class Namespace:
    def __init__(self):
        made = []

        def make():  # a thread of its own goes there, and is left behind
            checked(LIBC.unshare(CLONE_NEWNET))
            made.append(os.open(f"/proc/self/task/{threading.get_native_id()}/ns/net", os.O_RDONLY | os.O_CLOEXEC))
        t = threading.Thread(target=make)
        t.start()
        t.join()
        self.fd = made[0]
        with self.inside():
            ip("link", "set", "lo", "up")

    @contextlib.contextmanager
    def inside(self):
        """Sockets that are opened and programs that are started by this thread are in it."""
        home = os.open("/proc/thread-self/ns/net", os.O_RDONLY | os.O_CLOEXEC)
        try:
            checked(LIBC.setns(self.fd, CLONE_NEWNET))
            yield self
        finally:
            checked(LIBC.setns(home, CLONE_NEWNET))
            os.close(home)


class Plant:
    """A bridge, and places at it: each has the interface `plant`."""

    def __init__(self, places):
        self.switch = Namespace()
        self.places = [Namespace() for _ in range(places)]
        with self.switch.inside():
            ip("link", "add", "bridge", "type", "bridge", "mcast_snooping", "0")
            ip("link", "set", "bridge", "up")
            for n, place in enumerate(self.places):
                ip("link", "add", f"port{n}", "type", "veth", "peer", "name", "plant", "netns", f"/proc/{os.getpid()}/fd/{place.fd}")
                ip("link", "set", f"port{n}", "master", "bridge", "up")
        for n, place in enumerate(self.places):
            with place.inside():
                ip("addr", "add", f"10.77.0.{n + 1}/24", "dev", "plant")
                ip("link", "set", "plant", "up")

    def cut(self, n):
        """Nothing comes through, and nobody is told: the cable's light stays on."""
        with self.switch.inside():
            ip("link", "set", f"port{n}", "nomaster")

    def join(self, n):
        with self.switch.inside():
            ip("link", "set", f"port{n}", "master", "bridge")
