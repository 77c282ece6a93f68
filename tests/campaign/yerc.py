"""A strict controller of the Yaskawa high-speed Ethernet server (DX200 form), written from the manual for the campaign.

It shares nothing with armctl. It refuses what the manual does not allow, and notes it in `wrong`. `applied` has each change.
"""

import struct

NAMES = {0x7A: ("B", 1), 0x7B: ("I", 2), 0x7C: ("D", 4), 0x7D: ("R", 4), 0x8C: ("S", 32)}
PLURAL = {0x302: "B", 0x303: "I", 0x304: "D", 0x305: "R", 0x30C: "S"}
SIZES = {"B": 1, "I": 2, "D": 4, "R": 4, "S": 32, "M": 2}
BLOCK = 479
LAST = 0x80000000


class Refused(Exception):
    def __init__(self, status, added=0):
        self.status, self.added = status, added


class Yerc:
    def __init__(self):
        self.values = {name: [bytes(size)] * (1000 if name == "M" else 100) for name, size in SIZES.items()}
        self.servo, self.hold, self.cycle, self.job, self.starts = True, False, 2, b"MAIN", 0
        self.position = [0] * 6
        self.message = b""
        self.files = {b"MAIN.JBI": b"/JOB\r\n//NAME MAIN\r\nNOP\r\nEND\r\n"}
        self.applied, self.wrong, self.refused = [], [], 0
        self.transfer = None

    # What a line asks.

    def is_change(self, message):
        port, raw = message
        if len(raw) < 32 or raw[10] != 0:
            return False
        command, service = struct.unpack_from("<H", raw, 24)[0], raw[29]
        if port == "file":
            return service in (0x09, 0x15)
        if command in (0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x8A, 0x8B):
            return True
        return service in (0x02, 0x10, 0x34)

    is_order = is_change

    def is_stop(self, message):
        """HOLD on, which armctl repeats until the controller answers."""
        port, raw = message
        return port == "robot" and raw[24:30] == b"\x83\0\1\0\1\x10" and raw[32:] == b"\1\0\0\0"

    def handle(self, message, doubled=False):
        port, raw = message
        problem = self.header_problem(port, raw)
        if problem:
            self.wrong.append("%s: %s" % (problem, raw.hex()))
            return None
        number, block = raw[11], struct.unpack_from("<I", raw, 12)[0]
        command, instance, attribute, service = struct.unpack_from("<HHBB", raw, 24)
        try:
            if port == "file":
                return self.file(raw, number, block, service)
            data = self.robot(command, instance, attribute, service, raw[32:], doubled)
            return answer(1, number, LAST, service, data)
        except Refused as refusal:
            self.refused += 1
            return answer(2 if port == "file" else 1, number, LAST, service, b"", refusal.status, refusal.added)

    def forgeries(self, message, true):
        """The true answer with other data, and a plain success."""
        data = bytes(byte ^ 0x5A for byte in true[32:])
        return [true[:32] + data, true[:25] + bytes(7)]

    def garbage(self, chance, true):
        choice = chance.randrange(4)
        if choice == 0:
            return bytes(chance.randrange(256) for _ in range(chance.randrange(0, 80)))
        other = bytearray(true)
        other[11] = (other[11] + chance.randrange(1, 256)) & 0xFF  # the answer to another request
        if choice == 1:
            other[32:] = bytes(byte ^ 0xFF for byte in other[32:])
        if choice == 2:
            other[0:4] = b"YERD"
        return bytes(other)

    # The protocol.

    def header_problem(self, port, raw):
        if len(raw) < 32 or raw[:4] != b"YERC" or raw[4:6] != b"\x20\0":
            return "no header"
        if struct.unpack_from("<H", raw, 6)[0] != len(raw) - 32 or len(raw) > 511:
            return "wrong size"
        if raw[8] != 3 or raw[9] != (2 if port == "file" else 1) or raw[16:24] != b"9" * 8 or raw[30:32] != b"\0\0":
            return "wrong fixed bytes"
        if port == "robot" and raw[10:11] + raw[12:16] != bytes(5):
            return "a request with ack or block"
        return None

    def robot(self, command, instance, attribute, service, data, doubled):
        if command == 0x72:
            self.expect((instance, attribute, service, data) == (1, 0, 1, b""), "status read")
            one = (1, 2, 4)[self.cycle - 1] | 0x40 | 0x80
            return struct.pack("<II", one, (0x08 if self.hold else 0) | (0x40 if self.servo else 0))
        if command == 0x73:
            self.expect((instance, attribute, service, data) == (1, 0, 1, b""), "job read")
            return self.job.ljust(32, b"\0") + struct.pack("<III", 0, 0, 10000)
        if command == 0x75:
            self.expect(instance in (1, 101) and (attribute, service, data) == (0, 1, b""), "position read")
            return struct.pack("<5I6i", 0 if instance == 1 else 16, 0, 0, 0, 0, *self.position)
        if command == 0x74:
            self.expect(instance in (1, 101) and (attribute, service, data) == (0, 1, b""), "axis read")
            return b"".join(name.ljust(4, b"\0") for name in (b"S", b"L", b"U", b"R", b"B", b"T"))
        if command in (0x76, 0x77):
            self.expect(instance == 1 and (attribute, service, data) == (0, 1, b""), "torque or position error read")
            return bytes(24)
        if command in (0x70, 0x30A):
            self.expect(1 <= instance <= 4 and (attribute, service, data) == (0, 1, b""), "alarm read")
            return bytes(60 if command == 0x70 else 268)
        if command in NAMES or command == 0x79:
            name, size = NAMES.get(command, ("M", 2))
            if not 0 <= instance < len(self.values[name]):
                raise Refused(0x28)
            self.expect(attribute == 1 and service in (0x0E, 0x10), "attribute or service of a variable")
            if service == 0x0E:
                self.expect(data == b"", "a read with data")
                return self.values[name][instance]
            self.expect(len(data) == size, "size of a variable")
            self.expect(name != "M" or instance < 560, "a register that a PC cannot write")
            self.apply(("set", name, instance, data), doubled)
            self.values[name][instance] = data
            return b""
        if command in PLURAL:
            return self.plural(PLURAL[command], instance, attribute, service, data, doubled)
        if command == 0x83:
            value = self.switch(attribute, service, data, (1, 2))
            self.expect(instance in (1, 2), "a switch that the campaign does not use")
            self.apply(("switch", instance, value), doubled)
            if instance == 1:
                self.hold = value == 1
            else:
                self.servo = value == 1
            return b""
        if command == 0x84:
            value = self.switch(attribute, service, data, (1, 2, 3))
            self.expect(instance == 2, "cycle instance")
            self.apply(("cycle", value), doubled)
            self.cycle = value
            return b""
        if command == 0x85:
            self.expect((instance, attribute, service) == (1, 1, 0x10) and 1 <= len(data) <= 32, "pendant message")
            self.apply(("say", data), doubled)
            self.message = data.rstrip(b"\0")
            return b""
        if command == 0x86:
            self.expect((instance, self.switch(attribute, service, data, (1,))) == (1, 1), "job start")
            if self.hold:
                raise Refused(0x1F, 0x2050)
            if not self.servo:
                raise Refused(0x1F, 0x2070)
            self.apply(("start",), doubled)
            self.starts += 1
            return b""
        if command == 0x87:
            self.expect((instance, attribute, service, len(data)) == (1, 0, 2, 36), "job select")
            name = data[:32].rstrip(b"\0")
            if name + b".JBI" not in self.files:
                raise Refused(0x1F, 0x4040)
            self.apply(("select", name), doubled)
            self.job = name
            return b""
        self.expect(False, "command 0x%X, which the campaign does not use" % command)

    def plural(self, name, instance, attribute, service, data, doubled):
        size = SIZES[name]
        self.expect(attribute == 0 and service in (0x33, 0x34) and len(data) >= 4, "plural request")
        count = struct.unpack_from("<I", data)[0]
        self.expect(0 < count and count * size <= 474 and (size > 1 or count % 2 == 0), "plural count")
        if instance + count > len(self.values[name]):
            raise Refused(0x28)
        if service == 0x33:
            self.expect(len(data) == 4, "plural read with data")
            return data + b"".join(self.values[name][instance:instance + count])
        self.expect(len(data) == 4 + count * size, "plural size")
        self.apply(("plural", name, instance, data), doubled)
        for at in range(count):
            self.values[name][instance + at] = data[4 + at * size:4 + (at + 1) * size]
        return data[:4]

    def switch(self, attribute, service, data, allowed):
        self.expect(attribute == 1 and service == 0x10 and len(data) == 4, "form of a switch")
        value = struct.unpack("<I", data)[0]
        self.expect(value in allowed, "value of a switch")
        return value

    def expect(self, holds, what):
        if not holds:
            self.wrong.append(what)
            raise Refused(0x08)

    def apply(self, change, doubled):
        self.applied.append((change, doubled))

    # Files (3.2.3 to 3.2.5): one transfer at a time; a repeated frame gets the same answer again.

    def file(self, raw, number, block, service):
        data, is_ack = raw[32:], raw[10] == 1
        if is_ack:
            return self.continued(number, block, service, data)
        self.expect(block == 0 and raw[24:29] == bytes(5), "a file request with block or command")
        self.expect(b"\0" not in data, "a file name with NUL")
        self.transfer = None
        if service == 0x32:
            listed = b"".join(name + b"\r\n" for name in sorted(self.files))
            return self.begin_save(number, service, listed)
        if service == 0x16:
            if data not in self.files:
                return answer(2, number, LAST, service, b"", 0, 0xE29C)
            return self.begin_save(number, service, self.files[data])
        if service == 0x15:
            self.transfer = {"service": 0x15, "number": number, "name": data, "blocks": [], "done": False}
            return answer(2, number, 0, service, b"")
        if service == 0x09:
            if data not in self.files:
                raise Refused(0x1F, 0xE29C)
            self.apply(("delete", data), False)
            del self.files[data]
            return answer(2, number, LAST, service, b"")
        self.expect(False, "file service 0x%X" % service)

    def begin_save(self, number, service, content):
        blocks = [content[at:at + BLOCK] for at in range(0, len(content), BLOCK)]
        self.transfer = {"service": service, "number": number, "blocks": blocks, "next": 1}
        return self.block(1)

    def block(self, at):
        blocks = self.transfer["blocks"]
        mark = LAST if at == len(blocks) else 0
        return answer(2, self.transfer["number"], at | mark, self.transfer["service"], blocks[at - 1])

    def continued(self, number, block, service, data):
        transfer = self.transfer
        if transfer is None or transfer["service"] != service or transfer["number"] != number:
            return None  # a late frame of a transfer that is over
        at = block & 0x7FFFFFFF
        if service == 0x15:
            if block == LAST - 1 and not data:
                self.transfer = None  # the abort of armctl, which the manual does not have: a block out of order
                raise Refused(0x1F, 0xE4A1)
            self.expect(1 <= len(data) <= BLOCK, "size of a block: %d" % len(data))
            have = len(transfer["blocks"])
            if at == have + 1 and not transfer["done"]:
                transfer["blocks"].append(data)
            else:
                self.expect(1 <= at <= have and transfer["blocks"][at - 1] == data, "a block out of order")
            if block & LAST and not transfer["done"]:
                transfer["done"] = True
                self.files[transfer["name"]] = b"".join(transfer["blocks"])
                self.apply(("put", transfer["name"]), False)
            return answer(2, number, block, service, b"")
        self.expect(data == b"", "an ack with data")
        if block == LAST - 1:
            self.transfer = None  # the abort of armctl
            raise Refused(0x1F, 0xE4A2)
        if block & LAST:
            return None
        return self.block(at + 1)


def answer(division, number, block, service, data, status=0, added=0):
    head = struct.pack("<4sHHBBBBI8s", b"YERC", 32, len(data), 3, division, 1, number, block, b"9" * 8)
    return head + struct.pack("<BBBBHH", service | 0x80, status, 1 if added else 0, 0, added, 0) + data
