"""A strict DeviceNet slave (group 2 only server, 48-byte images) behind an SLCAN adapter, written from public descriptions for
the campaign. It shares nothing with armctl.

The adapter is a TCP port that accepts one client. The slave uses `Images` for the planned faults. A fault applies to the
frames of one image. Because the text of an adapter is a stream, everything after a late frame is late, too.
"""

import asyncio
import socket
import struct

from line import Stall
from yrcx import to_bytes, to_words

SIZE, MAC, VENDOR, SERIAL = 48, 5, 636, 0x00C0FFEE
NAME = b"YRCX (strict)"
ANSWER, REQUEST, POLL, UNCONNECTED, DUPLICATE = 0x42B, 0x42C, 0x42D, 0x42E, 0x42F
POLL_ANSWER = 0x3C0 + MAC
LINE = 32  # longest line of an adapter
# Seconds of a stall. "past" is longer than the time limit of the command, and shorter than the watchdog of the connection.
LATE = {"delay some": 0.08, "delay past": 0.7, "delay long": 3.0}
FAULTS = ["none", "lose some", "lose long", "double", "reorder", "delay some", "delay past", "delay long", "cut", "flood",
          "wrong peer", "reset",
          "bus off", "kill client", "kill holder"]
HARMLESS = {"none", "lose some", "double", "reorder", "delay some", "cut", "flood", "wrong peer"}


class Slave:
    """The adapter, the bus and the slave."""

    @classmethod
    async def open(cls, images):
        slave = cls()
        slave.images, slave.controller, slave.wrong = images, images.controller, images.controller.wrong
        slave.writer, slave.is_open, slave.rate = None, False, None
        slave.stall, slave.off_until = Stall(), 0.0
        slave.owner, slave.choice = None, 0
        slave.forget()
        slave.server = await asyncio.start_server(slave.serve, "127.0.0.1", 0)
        slave.number = slave.server.sockets[0].getsockname()[1]
        images.on_reset = slave.reset
        return slave

    def close(self):
        self.release()
        if self.writer is not None:
            self.writer.close()
        self.server.close()

    def reset(self):
        """The adapter loses its client."""
        if self.writer is not None:
            self.writer.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            self.writer.transport.abort()

    # The adapter.

    async def serve(self, reader, writer):
        if self.writer is not None:
            self.writer.close()
        self.writer, self.is_open, pending = writer, False, b""
        try:
            while data := await reader.read(4096):
                pending += data
                *lines, pending = pending.split(b"\r")
                for line in lines:
                    self.line(line)
                if len(pending) > LINE:
                    self.wrong.append("a line of %d characters" % len(pending))
                    break
        except (asyncio.CancelledError, OSError):
            pass
        if self.writer is writer:
            self.writer, self.is_open = None, False
        writer.close()

    def line(self, line):
        kind = line[:1]
        if kind == b"t":
            return self.transmit(line)
        if not line or kind == b"C":
            self.is_open = self.is_open and not line
            return self.text(b"\r" if line else b"")
        if kind == b"V":
            return self.text(b"V1013\r")
        if kind == b"F":
            return self.text(b"FA4\r" if self.is_off() else b"F00\r")
        if kind == b"S" and not self.is_open and len(line) == 2 and 0x30 <= line[1] <= 0x38:
            self.rate = line
            return self.text(b"\r")
        if line == b"O" and not self.is_open and self.rate is not None:
            self.is_open = True
            return self.text(b"\r")
        self.wrong.append("a line that the adapter refuses: %r" % line)
        self.text(b"\a")

    def transmit(self, line):
        try:
            name, size, data = int(line[1:4], 16), int(line[4:5], 16), bytes.fromhex(line[5:].decode())
        except ValueError:
            name, size, data = 0x800, 0, b""
        if name > 0x7EF or size > 8 or len(data) != size:
            self.wrong.append("not a frame: %r" % line)
            return self.text(b"\a")
        if not self.is_open or self.is_off():
            return self.text(b"\a")
        self.text(b"z\r")
        self.take(name, data)

    def is_off(self):
        return asyncio.get_running_loop().time() < self.off_until

    def text(self, text):
        """Sends text to the client, in order."""
        self.stall.pass_on(self.write, self.writer, text)

    def write(self, writer, text):
        if writer is not None and not writer.is_closing():
            writer.write(text)

    def frame(self, name, data):
        if self.is_open and not self.is_off():
            self.text(b"t%03X%d%s\r" % (name, len(data), data.hex().upper().encode()))

    # The slave.

    def take(self, name, data):
        if name == DUPLICATE:
            if len(data) != 7:
                self.wrong.append("a duplicate check of %d bytes" % len(data))
            elif not data[0] & 0x80:
                self.frame(DUPLICATE, struct.pack("<BHI", 0x80, VENDOR, SERIAL))
        elif name == UNCONNECTED or name == REQUEST:
            self.message(name, data)
        elif name == POLL:
            self.poll(data)
        elif name == ANSWER or name == POLL_ANSWER or 0x340 <= name < 0x400 and name & 0x3F == MAC:
            self.wrong.append("a frame in the name of the slave: %03X" % name)

    def forget(self):
        """No connection exists."""
        self.owner, self.choice, self.polling, self.period = None, 0, 0, 0
        self.parts, self.expected, self.acknowledge, self.waits = b"", None, None, None
        self.outgoing, self.request = [], b""
        self.watchdog = getattr(self, "watchdog", None)
        self.message_watchdog = getattr(self, "message_watchdog", None)
        for timer in (self.watchdog, self.message_watchdog):
            if timer is not None:
                timer.cancel()
        self.watchdog = self.message_watchdog = None
        self.image = to_bytes([0] * 24)

    def release(self):
        if self.polling == 3:
            self.controller.lost()
        self.forget()

    def message(self, name, data):
        """A frame of an explicit message."""
        if len(data) < 2:
            self.wrong.append("an explicit message of %d bytes" % len(data))
            return
        head, peer = data[0], data[0] & 0x3F
        if name == REQUEST:
            if self.owner != peer or not self.choice & 1:
                return  # the explicit connection does not exist
            self.feed_message_watchdog()
        if head & 0x80:
            return self.fragment(name, head, data)
        self.outgoing = []
        self.execute(name, head, data[1:])

    def fragment(self, name, head, data):
        kind, count = data[1] & 0xC0, data[1] & 0x3F
        if kind == 0xC0:
            if self.outgoing and count == self.acknowledge and data[2:3] == b"\0":
                self.outgoing.pop(0)
                self.next_fragment(head)
            return
        if name == UNCONNECTED:
            self.wrong.append("a fragment without a connection")
            return
        if kind == 0:
            self.request, self.waits = b"", 0
        if self.waits is None or count not in (self.waits, self.waits - 1):
            self.wrong.append("fragment %d, expected %s" % (count, self.waits))
            return
        if count == self.waits:
            self.request += data[2:]
            self.waits += 1
        self.frame(ANSWER, bytes([head, 0xC0 | count, 0]))
        if kind == 0x80:
            self.waits = None
            self.execute(name, head & 0x7F, self.request)

    def reply(self, head, body):
        """An answer: in one frame, or in fragments that wait for their acknowledges."""
        if len(body) <= 7:
            return self.frame(ANSWER, bytes([head]) + body)
        parts = [body[at:at + 6] for at in range(0, len(body), 6)]
        last = len(parts) - 1
        self.outgoing = [bytes([head | 0x80, (0 if at == 0 else 0x80 if at == last else 0x40) | at & 0x3F]) + part
                         for at, part in enumerate(parts)]
        self.next_fragment(head | 0x80)

    def next_fragment(self, head):
        if self.outgoing:
            self.acknowledge = self.outgoing[0][1] & 0x3F
            self.frame(ANSWER, self.outgoing[0])
            asyncio.get_running_loop().call_later(1.0, self.repeat_fragment, self.outgoing[0])

    def repeat_fragment(self, part):
        if self.outgoing and self.outgoing[0] is part:
            self.outgoing = []
            self.frame(ANSWER, part)

    def execute(self, name, head, body):
        service, peer = body[0], head & 0x3F
        if service & 0x80 or len(body) < 3:
            self.wrong.append("not a request: %s" % body.hex())
            return
        if name == UNCONNECTED and service not in (0x4B, 0x4C):
            self.wrong.append("service %02X without a connection" % service)
            return self.refuse(head, 0x08, 3)
        kind, instance, rest = body[1], body[2], body[3:]
        if service == 0x4B:
            return self.allocate(head, kind, instance, rest)
        if service == 0x4C:
            if (kind, instance) != (3, 1) or len(rest) != 1:
                self.wrong.append("a release: %s" % body.hex())
                return self.refuse(head, 0x20, 2)
            if self.owner != peer:
                return self.refuse(head, 0x0C, 1)
            if not rest[0] & self.choice:
                return self.refuse(head, 0x0B, 2)
            self.reply(head, b"\xCC")
            left = self.choice & ~rest[0]
            return self.release() if left & 2 == 0 else None
        if service == 0x0E and len(body) == 4:
            value = self.value(kind, instance, rest[0])
            return self.refuse(head, 0x14) if value is None else self.reply(head, b"\x8E" + value)
        if service == 0x10 and (kind, instance, rest[:1]) == (5, 2, b"\x09") and len(rest) == 3 and self.choice & 2:
            wanted = struct.unpack_from("<H", rest, 1)[0]
            self.period = (wanted + 9) // 10 * 10
            if self.period == 0:
                self.wrong.append("a poll connection without a watchdog")
            if self.polling == 1:
                self.polling = 3
                self.image = to_bytes(self.controller.image([0] * 16 + [0x41] + [0] * 7))
                self.feed_watchdog(max(10.0, 0.004 * self.period))
            return self.reply(head, b"\x90" + struct.pack("<H", self.period))
        self.refuse(head, 0x08)

    def refuse(self, head, general, additional=0xFF):
        self.reply(head, bytes([0x94, general, additional]))

    def allocate(self, head, kind, instance, rest):
        peer = head & 0x3F
        if (kind, instance) != (3, 1) or len(rest) != 2 or rest[1] != peer or not rest[0] & 3:
            self.wrong.append("an allocation: %s" % rest.hex())
            return self.refuse(head, 0x20, 2)
        if self.owner not in (None, peer):
            return self.refuse(head, 0x0C, 1)
        if rest[0] & self.choice:
            return self.refuse(head, 0x0B, 2)
        self.owner, self.choice = peer, self.choice | rest[0]
        if self.choice & 2:
            self.polling = 1
        self.feed_message_watchdog()
        self.reply(head, b"\xCB\0")

    def value(self, kind, instance, attribute):
        if kind == 1 and instance == 1:
            return {1: struct.pack("<H", VENDOR), 2: b"\0\0", 3: b"\1\0", 4: b"\1\1", 5: b"\0\0", 6: struct.pack("<I", SERIAL),
                    7: bytes([len(NAME)]) + NAME}.get(attribute)
        if kind == 3 and instance == 1:
            return {1: bytes([MAC]), 2: b"\2", 5: bytes([self.choice, 0xFF if self.owner is None else self.owner])}.get(attribute)
        if kind == 5 and instance == 2 and self.choice & 2:
            return {1: bytes([self.polling]), 7: struct.pack("<H", SIZE), 8: struct.pack("<H", SIZE),
                    9: struct.pack("<H", self.period), 12: b"\0"}.get(attribute)
        return None

    def feed_message_watchdog(self):
        if self.message_watchdog is not None:
            self.message_watchdog.cancel()
        self.message_watchdog = asyncio.get_running_loop().call_later(10.0, self.message_timeout)

    def message_timeout(self):
        """The explicit connection dies. The poll connection can live on without it."""
        self.choice &= ~1
        if self.polling != 3:
            self.forget()

    def feed_watchdog(self, seconds):
        if self.watchdog is not None:
            self.watchdog.cancel()
        self.watchdog = asyncio.get_running_loop().call_later(seconds, self.timeout)

    def timeout(self):
        """The poll connection times out: the controller stops. The explicit connection lives on."""
        self.polling = 4
        self.controller.lost()

    # Images.

    def poll(self, data):
        if self.polling != 3:
            self.parts, self.expected = b"", None
            return
        self.feed_watchdog(0.004 * self.period)
        if not data:
            self.wrong.append("an idle poll")
            return self.produce()
        kind, count = data[0] & 0xC0, data[0] & 0x3F
        if kind == 0:
            self.parts, self.expected = b"", 0
        if count != self.expected:
            self.expected = None
            return
        self.parts, self.expected = self.parts + data[1:], count + 1
        if kind != 0x80:
            return
        self.expected = None
        if len(self.parts) != SIZE:
            self.wrong.append("an image of %d bytes" % len(self.parts))
            return
        kind = self.images.fault()
        if kind.startswith("lose") or kind == "cut":
            return  # a frame of the image did not arrive
        self.image = to_bytes(self.controller.image(to_words(self.parts)))
        if kind == "double":
            self.image = to_bytes(self.controller.image(to_words(self.parts)))
        self.produce()

    def produce(self):
        frames = [bytes([(0 if at == 0 else 0x80 if at == 6 else 0x40) | at]) + self.image[7 * at:7 * at + 7] for at in range(7)]
        kind, chance = self.images.fault(), self.images.plan.random
        loop = asyncio.get_running_loop()
        at = chance.randrange(7)
        if kind == "lose long":
            return
        if kind == "lose some":
            frames.pop(at)
        elif kind == "double":
            frames.insert(at, frames[at])
        elif kind == "reorder":
            frames[at], frames[at - 1] = frames[at - 1], frames[at]
        elif kind.startswith("delay"):
            self.stall.hold(LATE[kind])
            self.images.packets_left = 0
        elif kind == "bus off":
            self.off_until = loop.time() + 2.0
            self.images.packets_left = 0
        elif kind == "flood":
            self.flood(chance)
        elif kind == "wrong peer":
            # Node 6 has other data, and other masters have other slaves.
            forged = to_bytes([0x0200] + [0x1234] * 15 + [0] * 8)
            for part in range(7):
                self.frame(0x3C6, frames[part][:1] + forged[7 * part:7 * part + 7])
                self.frame(0x433, bytes([0x00, 0x8E, 0x99]))
                self.frame(0x435, frames[part][:1] + forged[7 * part:7 * part + 7])
        for frame in frames:
            if kind == "cut" and chance.random() < 0.3:
                self.text(b"t%03X%d%s\r" % (POLL_ANSWER, len(frame), frame.hex().upper().encode()[:chance.randrange(2 * len(frame))]))
            else:
                self.frame(POLL_ANSWER, frame)

    def flood(self, chance):
        for _ in range(60):
            name = chance.randrange(0x7F0)
            if name not in (ANSWER, REQUEST, POLL, UNCONNECTED, DUPLICATE, POLL_ANSWER, 0x407):
                self.frame(name, bytes(chance.randrange(256) for _ in range(chance.randrange(9))))
            noise = bytes(chance.randrange(32, 127) for _ in range(chance.randrange(20)))
            if not noise.startswith((b"t", b"F", b"V")):
                self.text(noise + b"\r")
