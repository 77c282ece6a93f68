"""A strict PROFIBUS DP slave with 48-byte images on a pseudo-terminal, written from public descriptions for the campaign. It
shares nothing with armctl.

The slave uses `Images` for the planned faults. A fault applies to one telegram: a request that is lost, or an answer.
"""

import asyncio
import struct

from line import Terminal
from yrcx import to_bytes, to_words

STATION, IDENT, CONFIGURATION, SIZE = 5, b"\x12\x34", bytes.fromhex("C0D7D7"), 48
SHORT_ACKNOWLEDGE = b"\xE5"
GAP = 0.05  # seconds; a telegram has no pauses
WAIT_PRM, WAIT_CFG, EXCHANGE = "waits for parameters", "waits for a configuration", "exchanges data"
FAULTS = ["none", "lose some", "lose long", "double", "reorder", "delay some", "cut", "flood", "damage", "wrong peer",
          "reset", "kill client", "kill holder"]
# An answer that is later than the slot time of a repetition does not exist on this bus: it would look like the answer to a
# later request. `delay some` is the longest delay.
# A token of another master, which `wrong peer` sends, ends the link: two masters without a common ring are a fault.
HARMLESS = {"none", "lose some", "double", "reorder", "delay some", "cut", "flood", "damage"}


class Slave:
    @classmethod
    def open(cls, images):
        slave = cls()
        slave.images, slave.controller, slave.wrong = images, images.controller, images.controller.wrong
        slave.watchdog, slave.last_answer, slave.pending, slave.heard = None, b"", b"", 0.0
        slave.restart()
        slave.terminal = Terminal(None, lambda line, peer: slave)
        slave.path = slave.terminal.path
        images.on_reset = slave.restart
        return slave

    def close(self):
        self.leave()
        self.terminal.close()

    def restart(self):
        """Power off and on."""
        self.state, self.owner, self.fault = WAIT_PRM, None, 0
        self.counts, self.patience, self.operates = {}, None, False
        self.controller.lost()

    def leave(self):
        """Leaves the exchange: the outputs become 0, and the controller stops."""
        if self.watchdog is not None:
            self.watchdog.cancel()
            self.watchdog = None
        if self.state == EXCHANGE:
            self.controller.lost()
        self.state, self.owner, self.patience = WAIT_PRM, None, None

    # Telegrams.

    def feed(self, data):
        loop = asyncio.get_running_loop()
        if loop.time() > self.heard + GAP:
            self.pending = b""
        self.heard = loop.time()
        self.pending += data
        while self.pending:
            size = self.size()
            if size is None or len(self.pending) < size:
                return
            raw, self.pending = self.pending[:size], self.pending[size:]
            if raw[0] == 0xDC:
                if raw[1] != raw[2]:
                    self.wrong.append("a token to station %d" % raw[2])
                continue
            body = raw[1:-2] if raw[0] == 0x10 else raw[4:-2]
            if raw[-1] != 0x16 or sum(body) & 0xFF != raw[-2]:
                self.wrong.append("a damaged telegram: %s" % raw.hex())
                continue
            self.telegram(raw, body)

    def size(self):
        """The length of the telegram that begins here; None if it is not known yet."""
        start = self.pending[0]
        if start in (0x10, 0xDC):
            return 6 if start == 0x10 else 3
        if start != 0x68:
            self.wrong.append("a byte that begins no telegram: %02X" % start)
            self.pending = b""
            return None
        if len(self.pending) < 4:
            return None
        if self.pending[1] != self.pending[2] or self.pending[3] != 0x68 or not 4 <= self.pending[1] <= 249:
            self.wrong.append("a wrong start of a telegram: %s" % self.pending[:4].hex())
            self.pending = b""
            return None
        return self.pending[1] + 6

    def telegram(self, raw, body):
        to, sender, code, data = body[0] & 0x7F, body[1] & 0x7F, body[2], body[3:]
        saps = None
        if body[0] & 0x80 and body[1] & 0x80:
            saps, data = (data[0], data[1]), data[2:]
        elif (body[0] | body[1]) & 0x80:
            self.wrong.append("only one service access point: %s" % raw.hex())
            return
        if code & 0xC0 != 0x40:
            self.wrong.append("not a request: %s" % raw.hex())
            return
        if to == 127:
            return self.broadcast(code, saps, data)
        if to != STATION:
            return
        kind = self.images.fault()
        if kind.startswith("lose"):
            return
        answer = self.request(raw, sender, code, saps, data)
        if answer is not None:
            self.send(answer, sender)

    def broadcast(self, code, saps, data):
        if code != 0x46 or saps != (58, 62) or len(data) != 2:
            self.wrong.append("a broadcast that is not Global_Control")
        elif data[0]:
            self.wrong.append("Global_Control %02X" % data[0])
        else:
            self.operates = True

    def request(self, raw, sender, code, saps, data):
        if code & 0x0F == 9:
            if code != 0x49:
                self.wrong.append("FDL status with %02X" % code)
            return self.answer(sender, None, 0, b"")
        if code & 0x0F not in (0x0C, 0x0D):
            self.wrong.append("the service %02X" % code)
            return None
        count, is_counted = code >> 5 & 1, code >> 4 & 1
        before = self.counts.get(sender)
        if not is_counted and not count:
            self.wrong.append("a first request with FCB 0")
        if is_counted and before is None:
            return None  # the slave was restarted: it does not know this master
        if is_counted and before[0] == count:
            if before[1] != raw:
                self.wrong.append("another request with the frame count of the last one: %s" % raw.hex())
            self.feed_watchdog(sender)
            return before[2]
        answer = self.serve(sender, saps, data)
        self.counts[sender] = (count, raw, answer)
        self.feed_watchdog(sender)
        return answer

    def serve(self, sender, saps, data):
        if saps is None:
            return self.exchange(sender, data)
        service, source = saps
        if source != 62:
            self.wrong.append("a request from the service access point %d" % source)
        if service == 60:
            return self.answer(sender, (62, 60), 8, self.diagnosis())
        if service == 59:
            return self.answer(sender, (62, 59), 8, CONFIGURATION)
        if service == 61:
            return self.parameters(sender, data)
        if service == 62 and sender == self.owner and self.state == WAIT_CFG:
            if data == CONFIGURATION:
                self.state, self.operates = EXCHANGE, False
                self.first = True
            else:
                self.wrong.append("the configuration %s" % data.hex())
                self.fault = 4
                self.leave()
            return SHORT_ACKNOWLEDGE
        return self.answer(sender, (62, service), 3, b"")

    def diagnosis(self):
        first = (0 if self.state == EXCHANGE else 2) | self.fault
        second = 4 | (1 if self.state == WAIT_PRM else 0) | (8 if self.patience else 0)
        return bytes([first, second, 0, 255 if self.owner is None else self.owner]) + IDENT

    def parameters(self, sender, data):
        if self.owner not in (None, sender):
            self.wrong.append("parameters of another master")
            return self.answer(sender, (62, 61), 3, b"")
        if len(data) < 7 or data[4:6] != IDENT:
            self.fault = 0x40
            self.leave()
            return SHORT_ACKNOWLEDGE
        if data[0] & 0x40:
            self.leave()
            return SHORT_ACKNOWLEDGE
        if data[0] & 0xC8 != 0x88 or not data[1] or not data[2]:
            self.wrong.append("parameters without a lock or a watchdog: %s" % data.hex())
        if 0 < data[3] < 11 or data[7:] not in (b"", b"\0\0\0"):
            self.wrong.append("parameters: %s" % data.hex())
        self.leave()
        self.owner, self.fault, self.state, self.patience = sender, 0, WAIT_CFG, data[1] * data[2] / 100
        return SHORT_ACKNOWLEDGE

    def exchange(self, sender, data):
        if sender != self.owner or self.state != EXCHANGE:
            return self.answer(sender, None, 3, b"")
        if len(data) != SIZE:
            self.wrong.append("%d bytes of data" % len(data))
            self.leave()
            return self.answer(sender, None, 3, b"")
        # An emergency-stop or stop input that was off stays off.
        if self.first and any(byte & ~rest for byte, rest in zip(data, bytes(32) + b"\x41" + bytes(15))):
            self.wrong.append("the first image switches something on: %s" % data.hex())
        if not self.operates:
            self.wrong.append("data before the state operate")
        self.first = False
        return self.answer(sender, None, 8, to_bytes(self.controller.image(to_words(data))))

    def feed_watchdog(self, sender):
        if sender == self.owner and self.patience:
            if self.watchdog is not None:
                self.watchdog.cancel()
            self.watchdog = asyncio.get_running_loop().call_later(self.patience, self.leave)

    def answer(self, to, saps, status, data, station=STATION):
        mark = 0x80 if saps else 0
        body = bytes([to | mark, station | mark, status]) + bytes(saps or ()) + data
        end = bytes([sum(body) & 0xFF, 0x16])
        if len(body) == 3:
            return b"\x10" + body + end
        return struct.pack("4B", 0x68, len(body), len(body), 0x68) + body + end

    # Faults of an answer.

    def send(self, answer, sender):
        kind, chance, send = self.images.fault(), self.images.plan.random, self.terminal.send
        before, self.last_answer = self.last_answer, answer
        if kind.startswith("lose"):
            return
        if kind.startswith("delay"):
            asyncio.get_running_loop().call_later(0.08, send, answer)
            return
        if kind == "cut":
            return send(answer[:chance.randrange(len(answer))])
        if kind == "damage":
            at = chance.randrange(len(answer))
            answer = answer[:at] + bytes([answer[at] ^ 1 << chance.randrange(8)]) + answer[at + 1:]
        elif kind == "reorder" and len(before) == len(answer):
            send(before)
        elif kind == "flood":
            send(bytes(chance.randrange(256) for _ in range(chance.choice([1, 20, 300]))))
        elif kind == "wrong peer":
            forged = to_bytes([0x0200] + [0x1234] * 15 + [0] * 8)
            send(self.answer(sender, None, 8, forged, station=6) + b"\xDC\x03\x03" + self.answer(3, None, 8, forged))
        send(answer)
        if kind == "double":
            send(answer)
