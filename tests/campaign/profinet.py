"""A strict PROFINET IO device with 48 bytes each way, written from public descriptions for the campaign. It shares nothing with
armctl.

Each device has its own virtual network card. The devices are in the network namespace of this process, and armctl runs in
another one. The device uses `Images` for the planned faults of cyclic frames.
"""

import asyncio
import os
import shutil
import socket
import struct
import subprocess
import sys
import uuid

from line import Stall
from yrcx import to_bytes, to_words

SIZE, PORT, ETHERTYPE, VENDOR, DEVICE = 48, 34964, 0x8892, 0xFFFF, 1
LAYOUT = "0:0x1,1:0x101:i48,2:0x102:o48"
MODULES = {0: (1, {1: 1, 0x8000: 0x8000, 0x8001: 0x8001}), 1: (0x101, {1: 1}), 2: (0x102, {1: 1})}
DATA = {(1, 1): (SIZE, 0), (2, 1): (0, SIZE)}  # bytes from and to the device
GOOD, VALID = 0x80, 0x15  # IOPS and IOCS; the bits primary, DataValid and run of a data status
INTERFACES = "DEA0000%d-6C97-11D1-8271-00A02442DF7D"
# Seconds of a stall. "past" is longer than the time limit of the command, and shorter than the watchdog of the connection.
LATE = {"delay some": 0.08, "delay past": 0.7, "delay long": 3.0}
FAULTS = ["none", "lose some", "lose long", "double", "reorder", "delay some", "delay past", "delay long", "cut", "flood",
          "wrong peer", "reset",
          "kill client", "kill holder"]
HARMLESS = {"none", "lose some", "double", "reorder", "delay some", "cut", "flood", "wrong peer"}
INSIDE = "CAMPAIGN_NAMESPACE"


def enter_namespace():
    """Starts this program again in a network namespace of its own. Returns False if the computer has none."""
    if os.environ.get(INSIDE):
        subprocess.run(["ip", "link", "set", "lo", "up"], check=True)  # for the other buses
        return True
    if any(shutil.which(tool) is None for tool in ("unshare", "nsenter", "ip")):
        return False
    if subprocess.run(["unshare", "-Urnm", "true"], stderr=subprocess.DEVNULL).returncode:
        return False
    os.environ[INSIDE] = "1"
    sys.stdout.flush()
    os.execvp("unshare", ["unshare", "-Urnm", sys.executable, *sys.argv])


class Namespace:
    """The namespace of armctl, with a card for each device."""

    shared = None

    def __init__(self):
        # The namespace ends with this process, which then closes the standard input.
        script = "mount -t sysfs none /sys && ip link set lo up && echo ready && exec cat"
        self.process = subprocess.Popen(["unshare", "-nm", "sh", "-c", script], stdout=subprocess.PIPE, stdin=subprocess.PIPE)
        if not self.process.stdout.readline():
            raise RuntimeError("no namespace for armctl")
        self.prefix = ["nsenter", "-t", str(self.process.pid), "-n", "-m"]
        self.cards = 0

    @classmethod
    def get(cls):
        if cls.shared is None:
            cls.shared = cls()
        return cls.shared

    def card(self):
        """A new pair of cards: the names of both ends, and the third byte of their addresses."""
        self.cards += 1
        number = self.cards
        near, far = "pd%d" % number, "pc%d" % number
        here, there = ["ip"], [*self.prefix, "ip"]
        for words in ([*here, "link", "add", near, "type", "veth", "peer", "name", far],
                      [*here, "link", "set", far, "netns", str(self.process.pid)],
                      [*here, "addr", "add", "10.79.%d.2/24" % number, "dev", near],
                      [*here, "link", "set", near, "up"],
                      [*there, "addr", "add", "10.79.%d.1/24" % number, "dev", far],
                      [*there, "link", "set", far, "up"]):
            subprocess.run(words, check=True)
        return near, far, number


class Device(asyncio.DatagramProtocol):
    @classmethod
    async def open(cls, images):
        device = cls()
        device.images, device.controller, device.wrong = images, images.controller, images.controller.wrong
        namespace = Namespace.get()
        device.prefix = namespace.prefix
        card, device.peer_card, number = namespace.card()
        device.name, device.address = "robot-%d" % number, socket.inet_aton("10.79.%d.2" % number)
        device.raw = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERTYPE))
        device.raw.bind((card, ETHERTYPE))
        device.raw.setblocking(False)
        device.mac = device.raw.getsockname()[4]
        device.ar, device.calls, device.stall = None, {}, Stall()
        loop = asyncio.get_running_loop()
        loop.add_reader(device.raw, device.readable)
        device.udp, _ = await loop.create_datagram_endpoint(lambda: device, (socket.inet_ntoa(device.address), PORT))
        images.on_reset = lambda: device.abort(0x0D)
        return device

    def close(self):
        self.drop()
        asyncio.get_running_loop().remove_reader(self.raw)
        self.raw.close()
        self.udp.close()

    # Ethernet.

    def readable(self):
        while True:
            try:
                frame = self.raw.recv(2000)
            except BlockingIOError:
                return
            target, source, kind = struct.unpack_from(">6s6sH", frame)
            if kind != ETHERTYPE or source == self.mac:
                continue
            name, data = struct.unpack_from(">H", frame, 14)[0], frame[16:]
            if name in (0xFEFE, 0xFEFD):
                self.dcp(name, source, data)
            elif target != self.mac:
                continue
            elif name in (0xFE01, 0xFC01):
                self.alarm(data)
            elif self.ar is not None and name == self.ar["out_frame"]:
                self.receive(source, data)

    def frame(self, target, name, data, tag=b"\x81\0\xC0\0", source=None):
        frame = target + (source or self.mac) + tag + struct.pack(">HH", ETHERTYPE, name) + data
        try:
            self.raw.send(frame.ljust(60 + len(tag), b"\0"))
        except OSError:
            pass

    def dcp(self, name, source, data):
        service, kind, xid, delay, length = struct.unpack_from(">BBIHH", data)
        if kind != 0:
            return
        blocks, rest = data[10:10 + length], []
        if service == 3:
            rest = [blocks[at:at + 2] for at in range(0, len(blocks), 2)]
        else:
            while len(blocks) >= 4:
                size = struct.unpack_from(">H", blocks, 2)[0]
                rest.append((blocks[:2], blocks[4:4 + size]))
                blocks = blocks[4 + size + size % 2:]
        values = {b"\2\2": self.name.encode(), b"\2\1": b"YRCX", b"\2\3": struct.pack(">HH", VENDOR, DEVICE), b"\2\4": b"\1\0",
                  b"\1\2": self.address + b"\xFF\xFF\xFF\0" + self.address}
        if service == 5 and name == 0xFEFE:
            for option, value in rest:
                if option != b"\xFF\xFF" and values.get(option) != value:
                    return
            answer = b"".join(self.dcp_block(option, value) for option, value in values.items())
            return self.frame(source, 0xFEFF, struct.pack(">BBIHH", 5, 1, xid, 0, len(answer)) + answer, b"")
        if service == 3 and name == 0xFEFD:
            answer = b"".join(self.dcp_block(option, values[option]) for option in rest if option in values)
            return self.frame(source, 0xFEFD, struct.pack(">BBIHH", 3, 1, xid, 0, len(answer)) + answer, b"")
        self.wrong.append("DCP service %d: %s" % (service, data.hex()))

    def dcp_block(self, option, value):
        info = b"\0\1" if option == b"\1\2" else b"\0\0"
        return option + struct.pack(">H", len(value) + 2) + info + value + b"\0" * (len(value) % 2)

    def alarm(self, data):
        """An RTA frame. The device sends no alarms, so only an error is expected."""
        target, source, kind = struct.unpack_from(">HHB", data)
        if kind & 15 == 4 and self.ar is not None and target == self.ar["reference"]:
            self.drop()

    def abort(self, reason):
        """Ends the relation from the side of the device."""
        if self.ar is not None:
            data = struct.pack(">HHBBHHH4B", self.ar["peer_reference"], self.ar["reference"], 0x14, 1, 0xFFFF, 0xFFFE, 4, 0xCF, 0x81,
                               0xFD, reason)
            self.frame(self.ar["mac"], 0xFE01, data, b"\x81\0\xA0\0")
            self.drop()

    def drop(self):
        if self.ar is not None:
            for timer in ("tick", "watchdog"):
                if self.ar[timer] is not None:
                    self.ar[timer].cancel()
            self.ar = None
            self.controller.lost()

    # Remote procedure calls.

    def datagram_received(self, data, address):
        if len(data) < 80 or data[0] != 4:
            return
        order = "<" if data[4] & 0x10 else ">"
        kind, interface = data[1], self.uuid(data[24:40], order)
        activity = data[40:56]
        sequence, operation, length = (struct.unpack_from(order + form, data, at)[0] for form, at in (("I", 64), ("H", 68), ("H", 74)))
        body = data[80:80 + length]
        if len(body) != length or length < 20:
            self.wrong.append("an RPC body of %d bytes, said %d" % (len(body), length))
            return
        first, arguments, most, offset, count = struct.unpack_from(order + "5I", body)
        blocks = body[20:]
        if kind == 2:
            return self.ready_answered(activity, first, blocks)
        if kind != 0:
            return
        if interface != uuid.UUID(INTERFACES % 1) or offset or arguments != count or count != len(blocks) or most < count:
            self.wrong.append("an RPC request: %s" % data[:100].hex())
            return
        call = (activity, sequence)
        if call not in self.calls:
            self.calls[call] = self.call(operation, blocks, address)
            if len(self.calls) > 50:
                self.calls.pop(next(iter(self.calls)))
        elif operation == 0:
            self.wrong.append("a Connect that is sent twice")
        status, answer = self.calls[call]
        head = bytes([4, 2, 0x28, 0]) + data[4:7] + b"\0" + data[8:56] + data[56:74]
        answer = struct.pack(order + "5I", status, len(answer), most, 0, len(answer)) + answer
        self.udp.sendto(head + struct.pack(order + "HHBB", len(answer), 0, 0, 0) + answer, address)

    def error_received(self, error):
        pass  # armctl has gone

    def uuid(self, data, order):
        return uuid.UUID(bytes=data) if order == ">" else uuid.UUID(bytes_le=data)

    def call(self, operation, data, address):
        """Status and blocks of an answer."""
        blocks = []
        while len(data) >= 6:
            kind, length, version = struct.unpack_from(">HHH", data)
            if version != 0x0100 or length < 2 or len(data) < 4 + length:
                self.wrong.append("block %04X of %d bytes" % (kind, length))
                return 0xDB814000, b""
            blocks.append((kind, data[6:4 + length]))
            data = data[4 + length:]
        if operation == 0:
            return self.connect(blocks, address)
        if operation == 1 and len(blocks) == 1 and blocks[0][0] == 0x0114:
            return self.release(blocks[0][1])
        if operation == 4 and len(blocks) == 1 and blocks[0][0] == 0x0110:
            return self.end_of_parameters(blocks[0][1])
        if operation in (2, 5):
            return 0xDE80B000, b""  # no such record
        self.wrong.append("operation %d with blocks %s" % (operation, ["%04X" % kind for kind, _ in blocks]))
        return 0xDB814001, b""

    def connect(self, blocks, address):
        kinds = [kind for kind, _ in blocks]
        if kinds[:1] != [0x0101] or kinds.count(0x0102) != 2 or kinds.count(0x0103) != 1 or 0x0104 not in kinds:
            self.wrong.append("Connect with blocks %s" % ["%04X" % kind for kind in kinds])
            return 0xDB814001, b""
        data = blocks[0][1]
        kind, name, key, mac, caller, properties, factor, protocol, length = struct.unpack_from(">H16sH6s16sIHHH", data)
        text = data[54 - 2:54 - 2 + length]
        if kind != 1 or not any(name) or mac[0] & 1 or properties & 0x1F != 0x11 or not 1 <= factor <= 1000 or protocol != ETHERTYPE or not text:
            self.wrong.append("ARBlockReq: %s" % data.hex())
            return 0xDB810104, b""
        if self.ar is not None:
            return 0xDB814004, b""
        ar = {"uuid": name, "key": key, "mac": mac, "caller": caller, "address": address, "tick": None, "watchdog": None,
              "reference": 7, "counter": None, "out": 0, "is_ready": False, "ready": None}
        expected = {}
        for kind, data in blocks:
            if kind == 0x0104 and not self.expect(data, expected):
                return 0xDB810304, b""
        for kind, data in blocks:
            if kind == 0x0102 and not self.communication(data, ar, expected):
                return 0xDB810204, b""
            if kind == 0x0103:
                fields = struct.unpack_from(">HHIHHHHHH", data)
                if fields[:2] != (1, ETHERTYPE) or not 1 <= fields[3] <= 100 or not 3 <= fields[4] <= 15 or not 200 <= fields[6] <= 1432 \
                        or fields[7:] != (0xC000, 0xA000):
                    self.wrong.append("AlarmCRBlockReq: %s" % data.hex())
                    return 0xDB810404, b""
                ar["peer_reference"] = fields[5]
        if not {"in_frame", "out_frame"} <= ar.keys():
            self.wrong.append("no pair of an input and an output relation")
            return 0xDB814002, b""
        self.ar = ar
        self.image = to_bytes(self.controller.image([0] * 16 + [0x41] + [0] * 7))
        self.feed_watchdog(ar, 20.0)
        loop = asyncio.get_running_loop()
        ar["due"] = loop.time() + ar["period"]
        ar["tick"] = loop.call_at(ar["due"], self.produce, ar)
        station = self.name.encode()
        padding = -len(station) % 4 + 2 & 3
        return 0, b"".join([
            self.block(0x8101, struct.pack(">H16sH6sH", 1, name, key, self.mac, ETHERTYPE)),
            self.block(0x8102, struct.pack(">HHH", 1, ar["in_reference"], ar["in_frame"])),
            self.block(0x8102, struct.pack(">HHH", 2, ar["out_reference"], ar["out_frame"])),
            self.block(0x8103, struct.pack(">HHH", 1, ar["reference"], 200)),
            self.block(0x8106, struct.pack(">H", len(station)) + station + b"\0" * padding)])

    def block(self, kind, data):
        return struct.pack(">HHH", kind, len(data) + 2, 0x0100) + data

    def expect(self, data, expected):
        """Modules that the controller expects must be there."""
        apis, at = struct.unpack_from(">H", data)[0], 2
        for _ in range(apis):
            api, slot, module, _, count = struct.unpack_from(">IHIHH", data, at)
            at += 14
            for _ in range(count):
                subslot, ident, properties = struct.unpack_from(">HIH", data, at)
                at += 8
                sizes = [0, 0]
                for _ in range(2 if properties & 3 == 3 else 1):
                    direction, size, iocs, iops = struct.unpack_from(">HHBB", data, at)
                    at += 6
                    sizes[direction - 1] = size
                    if (iocs, iops) != (1, 1):
                        self.wrong.append("lengths of IOCS and IOPS: %d %d" % (iocs, iops))
                if api or MODULES.get(slot, (0, {}))[0] != module or MODULES[slot][1].get(subslot) != ident \
                        or tuple(sizes) != DATA.get((slot, subslot), (0, 0)):
                    self.wrong.append("module %X, submodule %X in slot %d.%X with %s bytes" % (module, ident, slot, subslot, sizes))
                    return False
                expected[slot, subslot] = tuple(sizes)
        return at == len(data)

    def communication(self, data, ar, expected):
        """One IOCRBlockReq: where the data and the states are in the frames."""
        (kind, reference, protocol, properties, size, frame, clock, ratio, phase, sequence, offset, watchdog, hold, tag, mac, apis,
         api, count) = struct.unpack_from(">HHHIHHHHHHIHHH6sHIH", data)
        fits = (protocol, properties & 15, sequence, offset, tag, mac, apis, api) == (
            ETHERTYPE, 2, 0, 0xFFFFFFFF, 0xC000, bytes(6), 1, 0)
        if kind not in (1, 2) or not fits or not 40 <= size <= 1440 or clock != 32 or ratio not in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512) \
                or not 1 <= phase <= ratio or not 3 <= watchdog or watchdog * ratio > 1920 or hold < 3:
            self.wrong.append("IOCRBlockReq: %s" % data.hex())
            return False
        at = struct.calcsize(">HHHIHHHHHHIHHH6sHIH")
        objects = {}
        for _ in range(count):
            slot, subslot, place = struct.unpack_from(">HHH", data, at)
            objects[slot, subslot] = place
            at += 6
        states, count = {}, struct.unpack_from(">H", data, at)[0]
        at += 2
        for _ in range(count):
            slot, subslot, place = struct.unpack_from(">HHH", data, at)
            states[slot, subslot] = place
            at += 6
        has = {name for name, sizes in expected.items() if sizes[kind - 1] or kind == 1 and not any(sizes)}
        others = {name for name, sizes in expected.items() if sizes[2 - kind] or kind == 2 and not any(sizes)}
        if at != len(data) or set(objects) != has or set(states) != others:
            self.wrong.append("objects of an IOCR: %s, states %s" % (sorted(objects), sorted(states)))
            return False
        taken = sorted([(place, place + expected[name][kind - 1] + 1) for name, place in objects.items()]
                       + [(place, place + 1) for place in states.values()])
        if any(first[1] > second[0] for first, second in zip(taken, taken[1:])) or taken[-1][1] > size:
            self.wrong.append("objects of an IOCR overlap: %s" % taken)
            return False
        name = ("in", "out")[kind - 1]
        if kind == 2 and frame == 0xFFFF:
            frame = 0x8002
        if not 0x8000 <= frame <= 0xBBFF:
            self.wrong.append("FrameID %04X" % frame)
            return False
        period = ratio / 1000
        ar.update({name + "_frame": frame, name + "_reference": reference, name + "_objects": objects, name + "_states": states,
                   name + "_size": size, name + "_ratio": ratio, name + "_time": watchdog * period})
        if kind == 1:
            ar["period"] = period
        return True

    def control(self, data, command):
        """Whether this control block belongs to the relation."""
        _, name, key, _, said, properties = struct.unpack_from(">H16sHHHH", data)
        if said != command or properties:
            self.wrong.append("a control block: %s" % data.hex())
        return self.ar is not None and name == self.ar["uuid"] and key == self.ar["key"]

    def done(self, kind, data):
        _, name, key, _, _, _ = struct.unpack_from(">H16sHHHH", data)
        return self.block(kind | 0x8000, struct.pack(">H16sHHHH", 0, name, key, 0, 8, 0))

    def release(self, data):
        if not self.control(data, 4):
            return 0xDC814005, b""
        self.drop()
        return 0, self.done(0x0114, data)

    def end_of_parameters(self, data):
        if not self.control(data, 1):
            return 0xDD814005, b""
        if self.ar["ready"] is None:
            self.ar["ready"] = uuid.uuid4().bytes
            asyncio.get_running_loop().call_soon(self.call_ready, self.ar, 3)
        return 0, self.done(0x0110, data)

    def call_ready(self, ar, tries):
        """Calls ApplicationReady at the controller."""
        if self.ar is not ar or ar["is_ready"]:
            return
        if not tries:
            return self.abort(0x18)
        block = self.block(0x0112, struct.pack(">H16sHHHH", 0, ar["uuid"], ar["key"], 0, 2, 0))
        body = struct.pack(">5I", 4096, len(block), 4096, 0, len(block)) + block
        head = bytes([4, 0, 0x20, 0, 0, 0, 0, 0]) + ar["caller"] + uuid.UUID(INTERFACES % 2).bytes + ar["ready"]
        head += struct.pack(">IIIHHHHHBB", 0, 1, 0, 4, 0xFFFF, 0xFFFF, len(body), 0, 0, 0)
        self.udp.sendto(head + body, (ar["address"][0], PORT))
        asyncio.get_running_loop().call_later(2.0, self.call_ready, ar, tries - 1)

    def ready_answered(self, activity, status, data):
        ar = self.ar
        if ar is None or ar["ready"] is None or activity not in (ar["ready"], uuid.UUID(bytes=ar["ready"]).bytes_le):
            return
        expected = self.block(0x8112, struct.pack(">H16sHHHH", 0, ar["uuid"], ar["key"], 0, 8, 0))
        if status or data != expected:
            self.wrong.append("the answer to ApplicationReady: %08X %s" % (status, data.hex()))
        ar["is_ready"] = True

    # Cyclic frames.

    def feed_watchdog(self, ar, seconds):
        if ar["watchdog"] is not None:
            ar["watchdog"].cancel()
        ar["watchdog"] = asyncio.get_running_loop().call_later(seconds, self.abort, 0x05)

    def receive(self, source, data):
        kind = self.images.fault()
        if kind.startswith("lose") or kind == "cut":
            return
        self.delay(kind)
        held, self.images.held = self.images.held, None
        if held is not None:
            # One frame late: after more than 128 ms, the cycle counter no longer shows that a frame is old.
            self.consume(self.ar, source, data)
            data = held
        elif kind == "reorder":
            self.images.held = data
            return
        self.stall.pass_on(self.consume, self.ar, source, data)
        if kind == "double":
            self.consume(self.ar, source, data)

    def delay(self, kind):
        """Ethernet keeps the order of frames: what follows a late frame is late, too."""
        if kind.startswith("delay"):
            self.stall.hold(LATE[kind])
            self.images.packets_left = 0

    def consume(self, ar, source, data):
        if ar is None or self.ar is not ar:
            return
        size = ar["out_size"]
        if source != ar["mac"] or len(data) < size + 4:
            self.wrong.append("an output frame of %d bytes" % len(data))
            return
        counter, status, transfer = struct.unpack_from(">HBB", data, size)
        if ar["counter"] is not None and not 1 <= (counter - ar["counter"]) & 0xFFFF <= 61440:
            return
        ar["counter"] = counter
        if transfer or status & VALID != VALID:
            self.wrong.append("data status %02X" % status)
            return
        states = [data[place] for place in ar["out_states"].values()]
        place = ar["out_objects"][2, 1]
        if any(state != GOOD for state in states) or data[place + SIZE] != GOOD:
            self.wrong.append("states of an output frame: %s" % data.hex())
            return
        self.feed_watchdog(ar, ar["out_time"])
        if ar["is_ready"]:
            self.image = to_bytes(self.controller.image(to_words(data[place:place + SIZE])))

    def data(self, ar, image):
        """An input frame with the next counter."""
        data = bytearray(ar["in_size"])
        for name, place in ar["in_objects"].items():
            size = DATA.get(name, (0, 0))[0]
            data[place:place + size] = image[:size]
            data[place + size] = GOOD
        for place in ar["in_states"].values():
            data[place] = GOOD
        ar["out"] = ar["out"] + 32 * ar["in_ratio"] & 0xFFFF
        return bytes(data) + struct.pack(">HBB", ar["out"], 0x35, 0)

    def produce(self, ar):
        if self.ar is not ar:
            return
        loop = asyncio.get_running_loop()
        ar["due"] = max(ar["due"] + ar["period"], loop.time())
        ar["tick"] = loop.call_at(ar["due"], self.produce, ar)
        target, name = ar["mac"], ar["in_frame"]
        data = self.data(ar, self.image)
        kind, chance = self.images.fault(), self.images.plan.random
        if kind.startswith("lose"):
            return
        self.delay(kind)
        if kind == "cut":
            return self.frame(target, name, data[:chance.randrange(len(data))])
        if kind == "reorder":
            self.frame(target, name, self.data(ar, self.image))
        elif kind == "flood":
            for _ in range(100):
                other = bytearray(data)
                other[chance.randrange(len(other) - 4, len(other))] ^= 1 << chance.randrange(8)
                noise = bytes(chance.randrange(256) for _ in range(60))
                self.frame(target, chance.randrange(0x8100, 0xFC00), bytes(other) if chance.randrange(2) else noise)
        elif kind == "wrong peer":
            forged = self.data(ar, to_bytes([0x0200] + [0x1234] * 15 + [0] * 8))
            ar["out"] = ar["out"] - 32 * ar["in_ratio"] & 0xFFFF
            self.frame(target, name, forged, source=b"\2\0\0\0\0\x99")
        self.stall.pass_on(self.frame, target, name, data)
        if kind == "double":
            self.frame(target, name, data)
