"""A CAN bus for programs of a computer whose kernel has none (a container, a virtual machine): user_can.c as a library that the programs load first.

In: a folder, a C compiler. Out: the environment with which a program finds the bus, and its line URI. Where the kernel has vcan, that is the better bus.
"""
import os
import pathlib
import selectors
import socket
import subprocess
import threading

SOURCE = pathlib.Path(__file__).resolve().with_suffix(".c")
FRAME = 16     # bytes of struct can_frame
ECHO_AT = 6    # its reserved byte: 1 in the frame that its sender gets back
URI = "can:lo"


class UserCan:
    """One bus. Frames are delivered in one order, those that a full socket does not take are lost, as on a bus whose listener is too slow."""

    def __init__(self, folder):
        self.path, library = str(folder / "bus"), folder / "user_can.so"
        if not library.exists():
            subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(SOURCE), "-ldl"], check=True)
        self.env = {"LD_PRELOAD": str(library), "AXISGATE_USER_CAN": self.path}
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.listener.bind(self.path)
        self.listener.listen(64)
        self.lost, self.ended = 0, False
        self.selector = selectors.DefaultSelector()
        self.selector.register(self.listener, selectors.EVENT_READ)
        self.wake, self.woken = socket.socketpair()
        self.selector.register(self.woken, selectors.EVENT_READ)
        self.nodes = set()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.ended:
            for key, _ in self.selector.select():
                if key.fileobj is self.listener:
                    node = self.listener.accept()[0]
                    node.setblocking(False)
                    self.nodes.add(node)
                    self.selector.register(node, selectors.EVENT_READ)
                elif key.fileobj is not self.woken:
                    self.read(key.fileobj)

    def read(self, node):
        try:
            frame = node.recv(64)
        except BlockingIOError:
            return
        except OSError:
            frame = b""
        if len(frame) != FRAME:
            self.selector.unregister(node)
            self.nodes.discard(node)
            node.close()
            return
        for other in self.nodes - {node}:
            self.give(other, frame)
        self.give(node, frame[:ECHO_AT] + b"\1" + frame[ECHO_AT + 1:])

    def give(self, node, frame):
        try:
            node.send(frame)
        except OSError:
            self.lost += 1

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.ended = True
        self.wake.send(b"x")
        self.thread.join()
        for s in (*self.nodes, self.listener, self.wake, self.woken):
            s.close()
        os.unlink(self.path)
