"""A strict EtherNet/IP adapter with two 48-byte assemblies, written from the standard for the campaign. It shares nothing with armctl.

`Images` is the part that all cyclic buses share: it has the faults of a line that repeats images all the time.
"""

import asyncio
import socket
import struct

from line import Plan
from yrcx import to_bytes, to_words

SIZE = 48
CYCLIC_FAULTS = ["none", "lose some", "lose long", "double", "reorder", "delay some", "delay past", "delay long", "cut",
                 "flood", "wrong peer", "reset", "kill client", "kill holder"]
CYCLIC_HARMLESS = {"none", "lose some", "double", "reorder", "delay some", "cut", "flood", "wrong peer", "reset"}
# Packets both ways: few are less than the timeout of a connection (64 one way), many are more.
PACKETS = {"some": 3, "past": 200, "long": 300}
# Seconds by which a packet is late. "past" is longer than the time limit of the command, and shorter than the timeout of the
# connection: the end of the command arrives when the client has given up, and perhaps sends the next command.
LATE = {"delay some": 0.08, "delay past": 1.1, "delay long": 3.0}
LONGEST = 3.0  # seconds after which also a long fault ends


class Images:
    """The images of a controller, with the planned fault. The fault begins when the controller sees a command."""

    def __init__(self, controller):
        self.controller = controller
        self.plan, self.on_kill = Plan(), lambda: None
        self.sent, self.ordered = [], False
        self.packets_left, self.until, self.held = 0, 0.0, None
        self.on_reset = lambda: None
        controller.on_command = self.command_begins

    def arm(self, plan, on_kill):
        self.plan, self.on_kill = plan, on_kill
        self.sent, self.ordered, self.packets_left, self.held = [], False, 0, None

    def command_begins(self, is_change):
        if is_change:
            self.sent.append(tuple(self.controller.command))
            self.ordered = True
        if not self.plan.meets(is_change):
            return
        kind = self.plan.kind
        if kind.startswith("kill"):
            self.on_kill()
        elif kind == "reset":
            asyncio.get_running_loop().call_soon(self.on_reset)  # after this image
        else:
            self.packets_left = PACKETS.get(kind.split(" ")[-1], PACKETS["some"])
            self.until = asyncio.get_running_loop().time() + LONGEST

    def fault(self):
        """The fault of this packet."""
        if not self.packets_left or asyncio.get_running_loop().time() > self.until:
            return "none"
        self.packets_left -= 1
        return self.plan.kind


class Adapter(asyncio.DatagramProtocol):
    """One device: encapsulation over TCP, and one class 1 connection over UDP."""

    @classmethod
    async def open(cls, images):
        adapter = cls()
        adapter.images, adapter.controller = images, images.controller
        adapter.connection, adapter.sessions, adapter.writers = None, 0, set()
        adapter.server = await asyncio.start_server(adapter.serve, "127.0.0.1", 0)
        adapter.number = adapter.server.sockets[0].getsockname()[1]
        loop = asyncio.get_running_loop()
        adapter.udp, _ = await loop.create_datagram_endpoint(lambda: adapter, ("127.0.0.1", 0))
        adapter.forger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        adapter.forger.bind(("127.0.0.1", 0))
        adapter.forger.setblocking(False)
        adapter.wrong = images.controller.wrong
        images.on_reset = adapter.reset
        return adapter

    def close(self):
        self.drop()
        self.server.close()
        self.udp.close()
        self.forger.close()

    def reset(self):
        for writer in list(self.writers):
            writer.transport.abort()

    async def serve(self, reader, writer):
        self.writers.add(writer)
        try:
            while True:
                head = await reader.readexactly(24)
                command, length, session, status, context, options = struct.unpack("<HHII8sI", head)
                data = await reader.readexactly(length)
                if status or options:
                    self.wrong.append("status or options in a request: %s" % head.hex())
                reply = self.encapsulated(command, session, data, writer)
                if reply is not None:
                    session, status, body = reply
                    writer.write(struct.pack("<HHII8sI", command, len(body), session, status, context, 0) + body)
        except (asyncio.CancelledError, asyncio.IncompleteReadError, OSError):
            pass
        self.writers.discard(writer)
        writer.close()

    def encapsulated(self, command, session, data, writer):
        if command == 0x65:
            if data != b"\1\0\0\0":
                self.wrong.append("RegisterSession: %s" % data.hex())
            self.sessions += 1
            return self.sessions, 0, data
        if command == 0x66:
            writer.close()
            return None
        if command == 0x63:
            return session, 0, struct.pack("<H", 0)
        if command != 0x6F:
            return session, 1, b""
        if not 1 <= session <= self.sessions:
            self.wrong.append("a request without a session")
            return session, 0x64, b""
        interface, _, count = struct.unpack_from("<IHH", data)
        items, at = [], 8
        for _ in range(count):
            kind, length = struct.unpack_from("<HH", data, at)
            items.append((kind, data[at + 4:at + 4 + length]))
            at += 4 + length
        if interface or at != len(data) or [kind for kind, _ in items[:2]] != [0, 0xB2] or items[0][1]:
            self.wrong.append("SendRRData: %s" % data.hex())
            return session, 3, b""
        reply, extra = self.request(items[1][1], dict(items[2:]), writer)
        out = [(0, b""), (0xB2, reply), *extra]
        body = struct.pack("<IHH", 0, 0, len(out))
        return session, 0, body + b"".join(struct.pack("<HH", kind, len(item)) + item for kind, item in out)

    def request(self, data, sockets, writer):
        service, words = data[0], data[1]
        path, rest = data[2:2 + 2 * words], data[2 + 2 * words:]
        if service == 0x54 and path == bytes.fromhex("20062401"):
            return self.forward_open(rest, sockets, writer)
        if service == 0x4E and path == bytes.fromhex("20062401"):
            serial, vendor, originator = struct.unpack_from("<HHI", rest, 2)
            if self.connection is None or self.connection["id"] != (serial, vendor, originator):
                return struct.pack("<BBBBHHHIBB", 0xCE, 0, 1, 1, 0x107, serial, vendor, originator, 0, 0), []
            self.drop()
            return struct.pack("<BBBBHHIBB", 0xCE, 0, 0, 0, serial, vendor, originator, 0, 0), []
        if service == 0x0E and path[:4] == bytes.fromhex("20012401"):
            known = {1: struct.pack("<H", 636), 2: struct.pack("<H", 43), 3: struct.pack("<H", 5), 4: b"\1\1",
                     5: b"\0\0", 6: b"\1\0\0\0", 7: b"\x04YRCX"}
            value = known.get(path[5])
            return (bytes([0x8E, 0, 0, 0]) + value) if value else bytes([0x8E, 0, 0x14, 0]), []
        if service == 0x01 and path == bytes.fromhex("20012401"):
            return bytes([0x81, 0, 0, 0]) + struct.pack("<HHH2sHI", 636, 43, 5, b"\1\1", 0, 1) + b"\x04YRCX", []
        return bytes([service | 0x80, 0, 8, 0]), []

    def forward_open(self, data, sockets, writer):
        (priority, ticks, to_us, to_them, serial, vendor, originator, multiplier, r0, r1, r2, out_rpi, out_params, in_rpi,
         in_params, trigger, words) = struct.unpack_from("<BBIIHHIBBBBIHIHBB", data)
        path = data[36:]

        def refuse(extended):
            return struct.pack("<BBBBHHHIBB", 0xD4, 0, 1, 1, extended, serial, vendor, originator, 0, 0), []
        if to_us or r0 or r1 or r2 or len(path) != 2 * words:
            self.wrong.append("a malformed ForwardOpen: %s" % data.hex())
            return refuse(0x0315)
        if path != bytes.fromhex("200424012C962C64"):
            return refuse(0x0117)
        if out_params & 0x1FF != SIZE + 6 or in_params & 0x1FF != SIZE + 2 or trigger != 1 or multiplier > 7:
            self.wrong.append("sizes or trigger of a ForwardOpen: %s" % data.hex())
            return refuse(0x0127)
        name = (serial, vendor, originator)
        if self.connection is not None:
            if self.connection["id"][1:] != (vendor, originator):
                return refuse(0x0106)
            if self.connection["id"] == name:
                return refuse(0x0100)
            self.drop()
        port = struct.unpack_from(">H", sockets[0x8001], 2)[0] if 0x8001 in sockets else 2222
        self.connection = {
            "id": name, "to_us": 0x10000 + serial, "to_them": to_them, "period": in_rpi / 1e6,
            "timeout": out_rpi / 1e6 * (4 << multiplier), "sequence": None, "count": 0, "out": 0,
            "peer": (writer.get_extra_info("peername")[0], port)}
        self.watch(max(10.0, self.connection["timeout"]))  # until the first image
        self.image = to_bytes(self.controller.image([0] * 16 + [0x41] + [0] * 7))
        loop = asyncio.get_running_loop()
        self.connection["tick"] = loop.call_later(self.connection["period"], self.produce, self.connection)
        here = struct.pack(">HH4s8x", 2, self.udp.get_extra_info("sockname")[1], bytes([127, 0, 0, 1]))
        reply = struct.pack("<BBBBIIHHIIIBB", 0xD4, 0, 0, 0, 0x10000 + serial, to_them, *name, out_rpi, in_rpi, 0, 0)
        return reply, [(0x8000, here)]

    def watch(self, patience):
        connection = self.connection
        if connection.get("watch"):
            connection["watch"].cancel()
        connection["watch"] = asyncio.get_running_loop().call_later(patience, self.expire, connection)

    def expire(self, connection):
        if self.connection is connection:
            self.drop()

    def drop(self):
        """The connection ends: the controller stops."""
        if self.connection is not None:
            for timer in ("watch", "tick"):
                self.connection[timer].cancel()
            self.connection = None
            self.controller.lost()

    # Images.

    def datagram_received(self, data, address):
        kind = self.images.fault()
        if kind.startswith("lose") or kind == "cut" and len(data) < 20:
            return
        if kind.startswith("delay"):
            asyncio.get_running_loop().call_later(LATE[kind], self.consume, data)
            return
        if kind == "reorder":
            held, self.images.held = self.images.held, data
            if held is None:
                return
            self.consume(data)
            self.images.held = None
            data = held
        self.consume(data)
        if kind == "double":
            self.consume(data)

    def error_received(self, error):
        pass  # the client has gone

    def consume(self, data):
        connection = self.connection
        if connection is None or len(data) < 18:
            return
        count, kind, size, name, sequence = struct.unpack_from("<HHHII", data)
        if name != connection["to_us"]:
            return
        if (count, kind, size) != (2, 0x8002, 8) or data[14:16] != b"\xB1\0" or len(data) != 18 + SIZE + 6:
            self.wrong.append("a malformed image: %s" % data.hex())
            return
        if connection["sequence"] is not None and not 0 < (sequence - connection["sequence"]) & 0xFFFFFFFF < 1 << 31:
            return
        connection["sequence"] = sequence
        self.watch(connection["timeout"])
        header = struct.unpack_from("<I", data, 20)[0]
        if header & 1:
            self.image = to_bytes(self.controller.image(to_words(data[24:])))

    def produce(self, connection):
        if self.connection is not connection:
            return
        loop = asyncio.get_running_loop()
        connection["tick"] = loop.call_later(connection["period"], self.produce, connection)
        packet = self.packet(connection, self.image)
        kind = self.images.fault()
        chance = self.images.plan.random
        peer = connection["peer"]
        if kind.startswith("lose"):
            return
        if kind.startswith("delay"):
            loop.call_later(LATE[kind], self.send, packet, peer)
            return
        if kind == "cut":
            return self.send(packet[:chance.randrange(len(packet))], peer)
        if kind == "reorder":
            self.send(self.packet(connection, self.image), peer)
        if kind == "flood":
            for _ in range(100):
                other = bytearray(packet)
                other[chance.randrange(10)] ^= 1 + chance.randrange(255)
                self.send(bytes(other) if chance.randrange(2) else bytes(chance.randrange(256) for _ in range(40)), peer)
        if kind == "wrong peer":
            forged = bytearray(packet)
            forged[20:] = to_bytes([0x0200] + [0x1234] * 15 + [0] * 8)  # a normal end with other data
            forged[10:14] = struct.pack("<I", connection["out"] + 5)
            try:
                self.forger.sendto(bytes(forged), peer)
            except OSError:
                pass
        self.send(packet, peer)
        if kind == "double":
            self.send(packet, peer)

    def packet(self, connection, image):
        connection["out"] = connection["out"] + 1 & 0xFFFFFFFF
        return struct.pack("<HHHIIHHH", 2, 0x8002, 8, connection["to_them"], connection["out"], 0xB1, SIZE + 2,
                           connection["out"] & 0xFFFF) + image

    def send(self, data, peer):
        if not self.udp.is_closing():
            self.udp.sendto(data, peer)
