#!/usr/bin/env python3
"""A strict slave of PROFIBUS DP on a pseudo-terminal, which shares nothing with armctl but the standard.

Prints the path of its terminal, then a line for each thing that a master must not do ("wrong: ...") and for each change of
state. It ends after the slave was set free, with exit code 0 if nothing was wrong, or 1. It shows what it is shown.

usage: slave.py [IMAGES]  - afterwards tells how many images it was shown; at least so many must have been.
"""

import os
import select
import sys
import time
import tty

STATION, IDENT, CONFIGURATION, SIZE = 5, b"\x12\x34", bytes.fromhex("C0D7D7"), 48
WAIT_PRM, WAIT_CFG, EXCHANGE = "waits for parameters", "waits for configuration", "exchanges data"
DEADLINE = 60


class Slave:
    def __init__(self):
        self.state, self.owner, self.patience, self.last_heard = WAIT_PRM, None, None, 0.0
        self.counts, self.wrong, self.images, self.released = {}, [], 0, False
        self.shown = bytes(SIZE)
        self.faults = 0
        self.operates = 0

    def complain(self, text):
        self.wrong.append(text)
        print("wrong:", text, flush=True)

    def go(self, state):
        self.state = state
        print("state:", state, flush=True)

    def leave(self):
        self.owner = self.patience = None
        self.go(WAIT_PRM)

    def telegram(self, raw):
        """What is answered to a telegram, if anything."""
        if raw[0] == 0xDC:
            if raw[1] != raw[2]:
                self.complain("a token to somebody who is not there")
            return None
        body = raw[1:-2] if raw[0] == 0x10 else raw[4:-2]
        to, sender, code = body[0] & 0x7F, body[1] & 0x7F, body[2]
        rest = body[3:]
        to_sap = from_sap = None
        if body[0] & 0x80:
            to_sap, rest = rest[0], rest[1:]
        if body[1] & 0x80:
            from_sap, rest = rest[0], rest[1:]
        if code & 0x80 or not code & 0x40:
            self.complain("a request that is none: %02X" % code)
            return None
        service = code & 0x0F
        if to == 127:
            if code != 0x46 or (to_sap, from_sap) != (58, 62) or len(rest) != 2:
                self.complain("a broadcast that is no Global_Control")
            elif rest != b"\0\0":
                self.complain("clear, which to a robot is an emergency stop")
            self.operates += 1
            return None
        if to != STATION:
            return None
        if service == 9:
            if code != 0x49:
                self.complain("FDL status with a frame count")
            return bytes([0x10, sender, STATION, 0, (sender + STATION) & 0xFF, 0x16])
        if service not in (0xC, 0xD):
            self.complain("a service that slaves do not have")
            return None
        fcb, fcv = code >> 5 & 1, code >> 4 & 1
        last = self.counts.get(sender)
        if not fcv:
            if not fcb:
                self.complain("SRD that is not counted")
        elif last is None:
            self.complain("the first request is counted as a later one")
        elif last[0] == fcb:
            if last[1] != raw:
                self.complain("another request with the frame count of the last one")
            return last[2]
        answer = self.serve(sender, to_sap, from_sap, rest)
        self.counts[sender] = (fcb, raw, answer)
        if sender == self.owner:
            self.last_heard = time.monotonic()
        return answer

    def serve(self, sender, to_sap, from_sap, data):
        if to_sap is not None and from_sap != 62:
            self.complain("a service access point other than 62 asks")
        is_owner = sender == self.owner
        if to_sap == 60:
            ready = self.state == EXCHANGE
            first = (0 if ready else 2) | self.faults
            second = 4 | (1 if self.state == WAIT_PRM else 0) | (8 if self.patience else 0)
            owner = 255 if self.owner is None else self.owner
            return answer(sender, (62, 60), 8, bytes([first, second, 0, owner]) + IDENT)
        if to_sap == 59:
            return answer(sender, (62, 59), 8, CONFIGURATION)
        if to_sap == 61:
            return self.parameters(sender, data)
        if to_sap == 62 and is_owner and self.state == WAIT_CFG:
            if data != CONFIGURATION:
                self.complain("another configuration than the one that it asked for")
                self.faults = 4
                self.leave()
            else:
                self.go(EXCHANGE)
            return b"\xE5"
        if to_sap is None and is_owner and self.state == EXCHANGE:
            if len(data) != SIZE:
                self.complain("%d bytes of data" % len(data))
                return answer(sender, None, 3, b"")
            if self.images == 0 and data != bytes(32) + b"\x41" + bytes(15):
                self.complain("the first image is not the resting one")
            if not self.operates:
                self.complain("data before the slaves were told to operate")
            if not data[32] & 0x41 == 0x41:
                self.complain("an image without SI(00) or SI(06)")
            self.images += 1
            self.shown = data
            return answer(sender, None, 8, self.shown)
        self.complain("a service that this state does not have: %s" % to_sap)
        return answer(sender, None if to_sap is None else (62, to_sap), 3, b"")

    def parameters(self, sender, data):
        if self.owner is not None and sender != self.owner:
            self.complain("parameters of somebody else")
            return answer(sender, (62, 61), 3, b"")
        if len(data) < 7 or data[4:6] != IDENT:
            self.complain("parameters for another slave")
            return b"\xE5"
        if data[0] & 0x40:
            self.released = True
            self.leave()
            return b"\xE5"
        if data[0] & 0xC0 != 0x80:
            self.complain("parameters that neither lock nor unlock")
        if not data[0] & 8 or not data[1] or not data[2]:
            self.complain("a robot without a watchdog")
        else:
            self.patience = data[1] * data[2] / 100
        if data[3] < 11:
            self.complain("a shortest answer time below 11 bits")
        if data[7:] not in (b"", b"\0\0\0"):
            self.complain("user parameters that nobody has set")
        self.owner, self.faults = sender, 0
        self.go(WAIT_CFG)
        return b"\xE5"

    def watch(self):
        if self.patience and time.monotonic() - self.last_heard > self.patience and self.state == EXCHANGE:
            self.complain("the watchdog of %.2f s ran out" % self.patience)
            self.leave()


def answer(to, saps, status, data):
    body = bytes([to | (0x80 if saps else 0), STATION | (0x80 if saps else 0), status]) + bytes(saps or ()) + data
    check = bytes([sum(body) & 0xFF, 0x16])
    if len(body) == 3:
        return b"\x10" + body + check
    return bytes([0x68, len(body), len(body), 0x68]) + body + check


def take(buffer, slave):
    """The next telegram and what is behind it; nothing if it is not complete."""
    kinds = {0x10: 6, 0xDC: 3}
    if buffer[0] == 0x68:
        if len(buffer) < 4:
            return None, buffer
        if buffer[1] != buffer[2] or buffer[3] != 0x68 or not 4 <= buffer[1] <= 249:
            slave.complain("a head of a telegram that is none: %s" % buffer[:4].hex())
            return None, buffer[1:]
        size = buffer[1] + 6
    elif buffer[0] in kinds:
        size = kinds[buffer[0]]
    else:
        slave.complain("a byte that begins no telegram: %02X" % buffer[0])
        return None, buffer[1:]
    if len(buffer) < size:
        return None, buffer
    raw, rest = buffer[:size], buffer[size:]
    if raw[0] != 0xDC:
        body = raw[1:-2] if raw[0] == 0x10 else raw[4:-2]
        if raw[-1] != 0x16 or sum(body) & 0xFF != raw[-2]:
            slave.complain("a wrong check sum or end")
            return None, rest
    return raw, rest


def main():
    least = int(sys.argv[1]) if len(sys.argv) > 1 else 0
    near, far = os.openpty()
    tty.setraw(far)
    print(os.ttyname(far), flush=True)
    slave, buffer, end = Slave(), b"", time.monotonic() + DEADLINE
    while not slave.released and time.monotonic() < end:
        if select.select([near], [], [], 0.005)[0]:
            buffer += os.read(near, 4096)
        while buffer:
            before = len(buffer)
            raw, buffer = take(buffer, slave)
            reply = slave.telegram(raw) if raw else None
            if reply:
                os.write(near, reply)
            if len(buffer) == before:
                break
        slave.watch()
    if not slave.released:
        slave.complain("it was never set free")
    if slave.images < least:
        slave.complain("%d images, not %d" % (slave.images, least))
    print("images:", slave.images, flush=True)
    sys.exit(1 if slave.wrong else 0)


main()
