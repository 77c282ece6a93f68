"""The remote commands of a strict YRCX controller, written from the manual for the campaign. It shares nothing with armctl.

A bus gives it each image of the master (24 words), and sends the image that it returns. A command runs once, when WI0 changes
from 0 while the status is ready. `applied` has each change; `wrong` has what the manual does not allow.
"""

import struct

READY, RUNNING, DONE, FAILED = 0x0000, 0x0100, 0x0200, 0x4000
CHANGES = {0x0200, 0x0100, 0x0006, 0x0034, 0x0035, 0x0038}
RUN_IMAGES = 3  # a motion or a servo command runs for this number of images


class Yrcx:
    def __init__(self):
        self.variables, self.points = {}, {}
        self.servo, self.manual_speed, self.position = True, 20, [0, 0, 0, 0]
        self.moves = 0
        self.command, self.left, self.after = None, 0, None
        self.status, self.response = READY, [0] * 15
        self.applied, self.wrong, self.refused = [], [], 0
        self.emergency, self.withdrawn = False, 0
        self.on_command = lambda is_change: None

    def is_stop(self, message):
        return False

    def image(self, words):
        """Takes the image of the master; returns the image of the controller."""
        inputs, command = words[16], words[0]
        if not inputs & 1 and not self.emergency:
            self.wrong.append("SI(00) is off: an emergency stop")
        self.emergency = not inputs & 1
        if self.command is None:
            if command:
                self.begin(words)
        elif self.left:
            self.left -= 1
            if command == 0:
                self.withdrawn += 1  # armctl does this after --timeout without a status: see docs/reliability.md
            elif command != self.command[0]:
                self.wrong.append("WI0 changed during a command: %04X" % command)
            if not inputs & 0x40 and self.after is not None and self.after[0] == "move":
                self.end(FAILED, [12, 400])  # the stop input
            elif not self.left:
                self.finish()
        elif command == 0:
            self.command, self.status, self.response = None, READY, [0] * 15
        elif command != self.command[0]:
            self.wrong.append("a command without a status reset: %04X" % command)
        outputs = 0x0002 | (0x0004 if self.servo else 0) | 0x0010 | 0x0100 | 0x0200
        return [self.status, *self.response, outputs, *[0] * 7]

    def lost(self):
        """The connection is lost: the controller stops, and forgets the command. A change that is applied stays."""
        self.command, self.left, self.status, self.response = None, 0, READY, [0] * 15

    def begin(self, words):
        self.command = words[:16]
        code = words[0] & 0x0FFF
        self.on_command(code in CHANGES)
        if code >> 8 in (1, 2) and words[0] >> 12:
            self.wrong.append("a robot number in %04X" % words[0])
        data = words[1:16]
        wide = [signed(data[at] | data[at + 1] << 16) for at in (3, 5, 7, 9)]
        if code == 0x0503:
            state = 1 if self.servo else 0
            return self.end(DONE, [0, state, state, state, state, 9, 9])
        if code == 0x0506:
            return self.end(DONE, [0, 0, 0, *split(self.position)])
        if code == 0x0510:
            return self.end(DONE, [0, 1, 2, 3, 4])  # percent of the maximum torque
        if code == 0x0515:
            return self.end(DONE, [])  # no alarm
        if code == 0x050A:
            return self.end(DONE, [0, 100, self.manual_speed, 100])
        if code == 0x0214:
            return self.end(DONE, [0, data[1], 0, *split([self.variables.get(data[1], 0)])])
        if code == 0x0101:
            return self.end(DONE, [0, data[1], 1, *split(self.points.get(data[1], [0, 0, 0, 0]))])
        if code == 0x0200:
            self.expect(data[0] == data[2] == 0 and not any(data[5:]), "unused words of an assignment")
            self.variables[data[1]] = wide[0]
            self.applied.append((("var", data[1], wide[0]), False))
            return self.end(DONE, [])
        if code == 0x0100:
            self.expect(data[0] & 1 == 1 and data[2] == 0 and not any(data[11:]), "a point that is not in millimetres")
            self.points[data[1]] = wide
            self.applied.append((("point", data[1], tuple(wide)), False))
            return self.end(DONE, [])
        if code == 0x0038:
            self.expect(1 <= data[1] <= 100, "a speed outside 1 to 100 %")
            self.manual_speed = data[1]
            self.applied.append((("speed", data[1]), False))
            return self.end(DONE, [])
        if code in (0x0034, 0x0035):
            self.expect(not any(data[2:]) and data[0] == 0, "unused words of a servo command")
            self.after = ("servo", code == 0x0034)
        elif code == 0x0006:
            if not self.servo:
                return self.end(FAILED, [17, 31])
            axes = data[1] & 15 if data[0] & 1 else 15
            self.after = ("move", [new if axes >> at & 1 else old for at, (old, new) in enumerate(zip(self.position, wide))])
            self.moves += 1
        else:
            self.wrong.append("a command that the campaign does not use: %04X" % words[0])
            return self.end(FAILED, [12, 75])
        self.applied.append(((*self.after[:1], str(self.after[1])), False))
        self.left, self.status = RUN_IMAGES, RUNNING

    def finish(self):
        kind, value = self.after
        if kind == "servo":
            self.servo = value
        else:
            self.position = value
        self.end(DONE, [])

    def end(self, status, response):
        if status == FAILED:
            self.refused += 1
        self.left, self.after, self.status = 0, None, status
        self.response = (response + [0] * 15)[:15]

    def expect(self, holds, what):
        if not holds:
            self.wrong.append("%s: %s" % (what, " ".join("%04X" % word for word in self.command)))


def signed(value):
    return value - (1 << 32) if value >> 31 else value


def split(values):
    """32-bit values as words, the low word first."""
    return [word for value in values for word in (value & 0xFFFF, value >> 16 & 0xFFFF)]


def to_words(data):
    return list(struct.unpack("<24H", data))


def to_bytes(words):
    return struct.pack("<24H", *words)
