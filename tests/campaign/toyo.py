"""A strict Toyo controller (RS-232C host communication), written from the manual for the campaign. It shares nothing with armctl.

A block that the manual does not have is answered with @NG and noted in `wrong`. `applied` has each change.
"""

import re
import time

CHANGES = (b"@MCST", b"@WOVR", b"@WPAR", b"@SVON", b"@SVOF", b"@EXTP", b"@CTSK", b"@WSTX")
MOTION = 0.4  # seconds of a motion
COORDINATE = rb"[+-]\d{4}\.\d\d"
POINT = rb"@WPAR T1 PT=(\d{3}) X=(%s) Y=(%s) Z=(%s) R=(%s)" % ((COORDINATE,) * 4)


class Toyo:
    def __init__(self):
        self.host, self.servo, self.override = False, True, 100
        self.counters, self.points = [0] * 100, {}
        self.position = [b"+0000.00"] * 4
        self.starts, self.moving_until, self.target = 0, 0.0, None
        self.applied, self.wrong, self.refused = [], [], 0

    def is_change(self, message):
        return message.startswith(CHANGES)

    def is_stop(self, message):
        return message == b"@STOP"

    def is_order(self, message):
        """A change, or host ON and OFF, which armctl switches for it."""
        return self.is_change(message) or message in (b"@HSON", b"@HSOF")

    def moves(self):
        """Whether a motion is still in execution."""
        if self.target and time.monotonic() >= self.moving_until:
            self.position, self.target = self.target, None
        return self.target is not None

    def garbage(self, chance, true):
        """Bytes that are no answer: noise without a line end, or half a line of another answer."""
        if chance.randrange(2):
            return bytes(chance.choice(b"\x80\xff\x00?~") for _ in range(chance.randrange(1, 30)))
        return b"\r\n"

    def handle(self, message, doubled=False):
        if len(message) > 126:
            self.wrong.append("a block of more than 128 bytes")
            return None
        answer = self.command(message, doubled)
        if answer is None:
            self.wrong.append("not in the manual: %r" % message)
            answer = b"@NG"
        if answer == b"@NG":
            self.refused += 1
        return answer + b"\r\n"

    def command(self, block, doubled):
        if block == b"@HSON":
            self.host = True
            return b"@OK"
        if block == b"@HSOF":
            self.host = False
            return b"@OK"
        if block in (b"@STOP", b"@REST", b"@CERR", b"@JGST X=SP Y=SP Z=SP R=SP"):
            self.target = None
            return b"@OK"
        if match := re.fullmatch(rb"@STAS SNO=([0-4])", block):
            page = int(match[1])
            moves = page == 0 and self.moves()
            state = (0x02 if moves else 0x20, 0, (0x80 if self.host else 0) | 2, 0x10 | self.servo, 0x10)[page]
            return b"@STAS SNO=%d ST1=%02X ST2=00" % (page, state)
        if block == b"@RSTX 0000":
            return b"@RSTX 0001 NOP"
        if block == b"@SYSP":
            return b"@SYSP RTYP=000000 VER=04.00 E ARM1=X ARM2=Y ARM3=Z ARM4=R N"
        if block == b"@MPST":
            self.moves()
            return b"@MPST X=%s Y=%s Z=%s R=%s" % tuple(self.position)
        if block == b"@MTSK":
            return b"@MTSK TASK=01"
        if block == b"@ROVR":
            return b"@ROVR OV=%03d" % self.override
        if match := re.fullmatch(rb"@MCNT CN=(\d\d)", block):
            return b"@MCNT CN%s=%04d" % (match[1], self.counters[int(match[1])])
        if match := re.fullmatch(rb"@RPAR T1 PT=(\d{3})", block):
            return b"@RPAR T1 PT=%s X=%s Y=%s Z=%s R=%s" % (match[1], *self.points.get(int(match[1]), (b"+0000.00",) * 4))
        if match := re.fullmatch(rb"@MCST CN(\d\d)=(\d{4})", block):
            self.applied.append((block, doubled))
            self.counters[int(match[1])] = int(match[2])
            return b"@OK"
        if not self.is_change(block):
            return None
        if not self.host:
            self.wrong.append("without host ON: %r" % block)
            return b"@NG"
        if match := re.fullmatch(rb"@WOVR OV=(\d{3})", block):
            if not 1 <= int(match[1]) <= 100:
                return None
            self.override = int(match[1])
        elif match := re.fullmatch(POINT, block):
            self.points[int(match[1])] = match.groups()[1:]
        elif block in (b"@SVON", b"@SVOF"):
            self.servo = block == b"@SVON"
        elif match := re.fullmatch(rb"@EXTP PT=(\d{3})", block):
            if not self.servo:
                return b"@NG"
            self.starts += 1
            self.moving_until = time.monotonic() + MOTION
            self.target = list(self.points.get(int(match[1]), (b"+0000.00",) * 4))
        else:
            return None
        self.applied.append((block, doubled))
        return b"@OK"
