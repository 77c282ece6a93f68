"""The line between armctl and a strict controller: real sockets and pseudo-terminals, with a planned fault for each operation.

A controller has `is_change(message)` (does this request change something?) and `handle(message)` (the answer, or None). The
line counts what armctl sent, apart from what the controller applied: a fault of the line can double or lose a request.
"""

import asyncio
import fcntl
import os
import pty
import random
import socket
import struct
import termios
import tty

# The faults of a line that carries one request and one answer at a time.
DATAGRAM_FAULTS = ["none", "lose request", "lose answer", "double request", "double answer", "reorder", "delay", "cut",
                   "flood", "wrong peer", "wrong peer only", "kill client", "kill holder"]
STREAM_FAULTS = ["none", "lose request", "lose answer", "double answer", "delay", "cut", "flood", "reset before",
                 "reset after", "kill client", "kill holder"]
TERMINAL_FAULTS = [fault for fault in STREAM_FAULTS if not fault.startswith("reset")]
# Faults that the client must overcome without an error, if they happen once.
HARMLESS = {"none", "double request", "double answer", "reorder", "flood", "wrong peer"}


class Plan:
    """The fault of one operation: its kind, the request that it meets, and whether it stays until the end."""

    def __init__(self, kind="none", on_change=False, index=0, stays=False, seed=0):
        self.kind, self.on_change, self.index, self.stays = kind, on_change, index, stays
        self.random = random.Random(seed)
        self.hits = 0
        self.seen = 0

    def meets(self, is_change):
        """Whether the fault happens to this request."""
        due = is_change if self.on_change else self.seen >= self.index
        self.seen += 1
        if self.kind == "none" or not due or (self.hits and not self.stays):
            return False
        self.hits += 1
        return True

    def __repr__(self):
        where = "the change" if self.on_change else "request %d" % self.index
        return "%s at %s%s" % (self.kind, where, ", until the end" if self.stays else "")


class Line:
    def __init__(self, controller, timeout):
        self.controller, self.timeout = controller, timeout
        self.plan = Plan()
        self.sent, self.last_answer = [], (None, b"")
        self.on_kill = lambda: None
        self.operation, self.ordered = 0, False
        self.late_until = 0.0

    def arm(self, plan, on_kill):
        """Begins an operation with this plan."""
        self.operation += 1
        self.plan, self.on_kill, self.sent = plan, on_kill, []
        self.ordered = False

    def receive(self, message, peer):
        """A whole message of the client. `peer` sends: send(bytes), send_forged(bytes), reset()."""
        is_change = self.controller.is_change(message)
        self.ordered = self.ordered or self.controller.is_order(message)
        if is_change:
            self.sent.append(message)
        kind = self.plan.kind if self.plan.meets(is_change) else "none"
        chance = self.plan.random
        if kind == "lose request":
            return
        if kind == "reset before":
            return peer.reset()
        if kind.startswith("kill"):
            self.on_kill()
            if chance.random() < 0.5:
                return
        answer = self.controller.handle(message)
        if kind == "double request":
            again = self.controller.handle(message, doubled=True)
            answer, late = again, answer
            if late is not None:
                peer.send(late)
        if kind == "reset after":
            return peer.reset()
        if answer is None or kind == "lose answer":
            return
        (client, previous), self.last_answer = self.last_answer, (peer.client(), answer)
        if kind == "reorder" and client == peer.client():
            peer.send(previous)
        if kind == "cut":
            return peer.send(answer[:chance.randrange(0, len(answer))])
        loop = asyncio.get_running_loop()
        if kind == "delay":
            self.late_until = loop.time() + self.timeout * (1.1 + chance.random())
        if kind == "delay" or peer.is_stream and loop.time() < self.late_until:
            # A stream keeps its order: what follows a late answer is late, too.
            loop.call_at(self.late_until, peer.send, answer)
            return
        if kind == "flood":
            for _ in range(chance.choice([1, 20, 200])):
                peer.send(self.controller.garbage(chance, answer))
        if kind.startswith("wrong peer"):
            for forged in self.controller.forgeries(message, answer):
                peer.send_forged(forged)
            if kind == "wrong peer only":
                return
        peer.send(answer)
        if kind == "double answer":
            peer.send(answer)


class Stall:
    """Holds everything for a time, and then passes it on in order."""

    def __init__(self):
        self.waiting = []

    def hold(self, seconds):
        if not self.waiting:
            asyncio.get_running_loop().call_later(seconds, self.end)
            self.waiting.append((lambda: None, ()))

    def end(self):
        waiting, self.waiting = self.waiting, []
        for call, words in waiting:
            call(*words)

    def pass_on(self, call, *words):
        if self.waiting:
            self.waiting.append((call, words))
        else:
            call(*words)


class UdpPort(asyncio.DatagramProtocol):
    """A port of a controller. Each datagram is a message."""

    def __init__(self, line, handle_kind):
        self.line, self.kind = line, handle_kind

    @classmethod
    async def open(cls, line, kind, port=0):
        loop = asyncio.get_running_loop()
        transport, port = await loop.create_datagram_endpoint(lambda: cls(line, kind), ("127.0.0.1", port))
        port.forger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        port.forger.bind(("127.0.0.1", 0))
        return port

    def connection_made(self, transport):
        self.transport = transport
        self.number = transport.get_extra_info("sockname")[1]

    def datagram_received(self, data, address):
        self.line.receive((self.kind, data), UdpPeer(self, address))

    def error_received(self, error):
        pass  # the client has gone


class UdpPeer:
    is_stream = False

    def client(self):
        return self.address

    def __init__(self, port, address):
        self.port, self.address = port, address

    def send(self, data):
        # A delayed answer can be due after the end of its controller.
        if not self.port.transport.is_closing():
            self.port.transport.sendto(data, self.address)

    def send_forged(self, data):
        self.port.forger.sendto(data, self.address)

    def reset(self):
        pass


class Lines:
    """Cuts a stream of bytes into the lines of a controller, and passes them on."""

    def __init__(self, line, peer):
        self.line, self.peer, self.pending = line, peer, b""

    def feed(self, data):
        self.pending += data
        while True:
            ends = [place for place in (self.pending.find(b"\r"), self.pending.find(b"\n")) if place >= 0]
            if not ends:
                return
            message, self.pending = self.pending[:min(ends)], self.pending[min(ends) + 1:]
            if message:
                self.line.receive(message, self.peer)


class TcpPort:
    """A serial device server: the bytes of the controller belong to the newest client."""

    @classmethod
    async def open(cls, line, splitter=Lines):
        port = cls()
        port.line, port.splitter, port.clients = line, splitter, 0
        port.server = await asyncio.start_server(port.serve, "127.0.0.1", 0)
        port.number = port.server.sockets[0].getsockname()[1]
        return port

    async def serve(self, reader, writer):
        peer = TcpPeer(writer)
        splitter = self.splitter(self.line, peer)
        try:
            while data := await reader.read(4096):
                splitter.feed(data)
        except (asyncio.CancelledError, OSError):
            pass
        writer.close()


class TcpPeer:
    is_stream = True

    def client(self):
        return self

    def __init__(self, writer):
        self.writer = writer

    def send(self, data):
        if not self.writer.is_closing():
            self.writer.write(data)

    send_forged = send

    def reset(self):
        sock = self.writer.get_extra_info("socket")
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.writer.transport.abort()


class Terminal:
    """A pseudo-terminal. It has no connections: a late answer arrives at whoever listens."""

    is_stream = True

    def client(self):
        return self

    def __init__(self, line, splitter=Lines):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.path = os.ttyname(self.slave)
        self.splitter = splitter(line, self)
        asyncio.get_running_loop().add_reader(self.master, self.readable)

    def readable(self):
        try:
            self.splitter.feed(os.read(self.master, 65536))
        except BlockingIOError:
            pass

    def send(self, data):
        try:
            os.write(self.master, data)
        except OSError:
            pass  # nobody reads

    send_forged = send

    def reset(self):
        pass

    def release(self):
        """The flag of exclusive use ends with the last user of a port. Here, this process also uses the port."""
        fcntl.ioctl(self.slave, termios.TIOCNXCL)

    def close(self):
        asyncio.get_running_loop().remove_reader(self.master)
        os.close(self.master)
        os.close(self.slave)
