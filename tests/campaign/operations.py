"""The operations of the campaign: the words of a command, what it changes, and how its result is compared with the controller."""

import os
import struct


class Operation:
    """`words` of the command. `check(data)` compares the report with the controller; `done()` says if the change is there now.

    A read has no `done`. `may_be_equal`: the controller can already have the value, so that nothing is sent.
    """

    def __init__(self, words, check=lambda data: None, done=None, equal=False, motion=False):
        self.words, self.check, self.done, self.equal = words, check, done, equal
        self.is_change = done is not None
        if motion:
            self.words = self.words + ["--yes"]


def same(what, shown, true):
    return None if shown == true else "%s: armctl reported %r, the controller has %r" % (what, shown, true)


def first(*problems):
    return next((problem for problem in problems if problem), None)


class YercOperations:
    def __init__(self, controller, folder, tag):
        self.c, self.folder, self.tag, self.serial = controller, folder, tag, 1

    def next(self, chance):
        kind = chance.choice(["status", "read", "read", "read many", "write", "write", "write", "write many", "register",
                              "position", "servo", "hold", "cycle", "say", "select", "start", "start", "get", "put", "list"])
        self.serial += 1
        return getattr(self, kind.replace(" ", "_"))(chance)

    def status(self, chance):
        c = self.c
        return Operation(["status"], lambda data: first(
            same("servo", data["servo_on"], c.servo), same("hold", data["held"], c.hold),
            same("cycle", data["cycle"], ("step", "one_cycle", "continuous")[c.cycle - 1])))

    def variable(self, name, number):
        raw = self.c.values[name][number]
        return struct.unpack({"B": "<B", "I": "<h", "D": "<i", "R": "<f", "M": "<H"}[name], raw)[0]

    def items(self, data, names):
        shown = [item.get("value") for item in data["items"]]
        return same(" ".join(names), shown, [self.variable(name[0], int(name[1:])) for name in names])

    def read(self, chance):
        name = "%s%d" % (chance.choice("BIDR"), chance.randrange(8))
        return Operation(["var", "get", name], lambda data: self.items(data, [name]))

    def read_many(self, chance):
        start = chance.randrange(5)
        names = ["D%d" % at for at in range(start, start + 3)] + ["I%d" % chance.randrange(8)]
        return Operation(["var", "get", *names], lambda data: self.items(data, names))

    def write(self, chance):
        name, value = chance.choice([("I%d" % chance.randrange(8), self.serial % 30000),
                                     ("D%d" % chance.randrange(8), self.serial)])
        return Operation(["var", "set", "%s=%d" % (name, value)], self.written,
                         lambda: self.variable(name[0], int(name[1:])) == value)

    def write_many(self, chance):
        start = chance.randrange(5)
        names = ["D%d" % at for at in range(start, start + 4)]
        values = [self.serial * 4 + at + 10_000_000 for at in range(4)]
        return Operation(["var", "set", *("%s=%d" % pair for pair in zip(names, values))], self.written,
                         lambda: [self.variable("D", start + at) for at in range(4)] == values)

    def written(self, data):
        return first(*(same(item["name"], item["new"], self.variable(item["name"][0], int(item["name"][1:])))
                       for item in data["items"]))

    def register(self, chance):
        number, value = chance.randrange(8), self.serial % 60000
        return Operation(["register", "set", "M%d=%d" % (number, value)], self.written,
                         lambda: self.variable("M", number) == value)

    def position(self, chance):
        self.c.position = [chance.randrange(-200000, 200000) for _ in range(6)]
        return Operation(["position"], lambda data: same(
            "position", [joint["pulses"] for joint in data["positions"][0]["joints"]], self.c.position))

    def servo(self, chance):
        on = not self.c.servo
        return Operation(["servo", "on" if on else "off"], lambda data: same("servo", data["new"], self.c.servo),
                         lambda: self.c.servo == on, motion=True)

    def hold(self, chance):
        on = not self.c.hold
        return Operation(["hold", "on" if on else "off"], lambda data: same("hold", data["new"], self.c.hold),
                         lambda: self.c.hold == on, motion=True)

    def cycle(self, chance):
        cycle = chance.choice([value for value in (1, 2, 3) if value != self.c.cycle])
        return Operation(["cycle", ("step", "once", "continuous")[cycle - 1]], lambda data: None,
                         lambda: self.c.cycle == cycle)

    def say(self, chance):
        text = "message %s %d" % (self.tag, self.serial)
        return Operation(["say", text], lambda data: None, lambda: self.c.message == text.encode())

    def select(self, chance):
        name = chance.choice(sorted(self.c.files))[:-4]
        return Operation(["job", "select", name.decode()], lambda data: None, lambda: self.c.job == name)

    def start(self, chance):
        before = self.c.starts
        return Operation(["job", "start"], lambda data: None, lambda: self.c.starts > before, motion=True)

    def get(self, chance):
        name = chance.choice(sorted(self.c.files)).decode()
        path = os.path.join(self.folder, name)

        def check(data):
            with open(path, "rb") as file:
                return same(name, file.read(), self.c.files[name.encode()])
        return Operation(["file", "get", name, "--dir", self.folder, "--force"], check)

    def put(self, chance):
        name = "J%d.JBI" % chance.randrange(3)
        lines = ["/JOB", "//NAME " + name[:-4], "'%s %d" % (self.tag, self.serial)]
        lines += ["'%s" % ("x" * chance.randrange(70)) for _ in range(chance.choice([0, 5, 40]))]
        content = "\r\n".join(lines + ["NOP", "END", ""]).encode()
        path = os.path.join(self.folder, "put.JBI")
        with open(path, "wb") as file:
            file.write(content)
        return Operation(["file", "put", path, "--as", name], lambda data: None,
                         lambda: self.c.files.get(name.encode()) == content, motion=True)

    def list(self, chance):
        return Operation(["file", "list"], lambda data: same(
            "files", sorted(file["name"] for file in data["files"]), sorted(name.decode() for name in self.c.files)))


class ToyoOperations:
    def __init__(self, controller, folder, tag):
        self.c, self.serial = controller, 0

    def next(self, chance):
        self.serial += 1
        return getattr(self, chance.choice(["status", "position", "counter", "counter_set", "counter_set", "override",
                                            "override_set", "point", "point_set", "point_set", "servo", "move"]))(chance)

    def status(self, chance):
        return Operation(["status"], lambda data: same("servo", data["servo_on"], self.c.servo))

    def position(self, chance):
        def check(data):
            joints = [joint["mm"] for joint in data["positions"][0]["joints"]]
            return same("position", joints, [float(axis) for axis in self.c.position])
        return Operation(["position"], check)

    def counter(self, chance):
        number = chance.randrange(1, 9)
        return Operation(["counter", "get", str(number)],
                         lambda data: same("counter", data["items"][0]["value"], self.c.counters[number]))

    def counter_set(self, chance):
        number, value = chance.randrange(1, 9), self.serial % 9999 + 1
        return Operation(["counter", "set", "%d=%d" % (number, value)],
                         lambda data: same("counter", data["items"][0]["new"], self.c.counters[number]),
                         lambda: self.c.counters[number] == value)

    def override(self, chance):
        return Operation(["override", "get"], lambda data: same("override", data["items"][0]["value"], self.c.override))

    def override_set(self, chance):
        value = chance.choice([percent for percent in range(1, 101) if percent != self.c.override])
        return Operation(["override", "set", str(value)], lambda data: None, lambda: self.c.override == value)

    def point_mm(self, number):
        return [float(axis) for axis in self.c.points.get(number, (b"0",) * 4)]

    def point(self, chance):
        number = chance.randrange(1, 9)

        def check(data):
            joints = [joint["mm"] for joint in data["items"][0]["value"]["joints"]]
            return same("point %d" % number, joints, self.point_mm(number))
        return Operation(["point", "get", str(number)], check)

    def point_set(self, chance):
        number = chance.randrange(1, 9)
        value = [self.serial % 8000 + 0.25, chance.randrange(-500, 500) + 0.5, 3.0, -4.75]
        return Operation(["point", "set", "%d=%s" % (number, ",".join("%.2f" % axis for axis in value))],
                         lambda data: None, lambda: self.point_mm(number) == value, motion=True)

    def servo(self, chance):
        on = not self.c.servo
        return Operation(["servo", "on" if on else "off"], lambda data: same("servo", data["new"], self.c.servo),
                         lambda: self.c.servo == on, motion=True)

    def move(self, chance):
        before = self.c.starts
        return Operation(["run", "point", str(chance.randrange(1, 9))], lambda data: None,
                         lambda: self.c.starts > before, motion=True)


class YrcxOperations:
    def __init__(self, controller, folder, tag):
        self.c, self.serial = controller, 0

    def next(self, chance):
        self.serial += 1
        return getattr(self, chance.choice(["status", "position", "var", "var", "var_set", "var_set", "point", "point_set",
                                            "point_set", "speed", "servo", "move"]))(chance)

    def status(self, chance):
        return Operation(["status"], lambda data: same("servo", data["servo_on"], self.c.servo))

    def millimetres(self, value):
        return [axis / 1000 for axis in value]

    def position(self, chance):
        return Operation(["position"], lambda data: same(
            "position", [joint["mm"] for joint in data["positions"][0]["joints"]], self.millimetres(self.c.position)))

    def var(self, chance):
        number = chance.randrange(8)
        return Operation(["var", "get", "SGI%d" % number], lambda data: same(
            "SGI%d" % number, data["items"][0]["value"], self.c.variables.get(number, 0)))

    def var_set(self, chance):
        number, value = chance.randrange(8), self.serial * 1009
        return Operation(["var", "set", "SGI%d=%d" % (number, value)], lambda data: None,
                         lambda: self.c.variables.get(number) == value)

    def point(self, chance):
        number = chance.randrange(1, 9)
        return Operation(["point", "get", str(number)], lambda data: same(
            "point %d" % number, [joint["mm"] for joint in data["items"][0]["value"]["joints"]],
            self.millimetres(self.c.points.get(number, [0] * 4))))

    def point_set(self, chance):
        number, value = chance.randrange(1, 9), [self.serial * 7 + 1000, -2500, chance.randrange(-9000, 9000), 4000]
        words = "mm=%s" % ",".join("%.3f" % axis for axis in self.millimetres(value))
        return Operation(["point", "set", str(number), words], lambda data: None,
                         lambda: self.c.points.get(number) == value, motion=True)

    def speed(self, chance):
        value = chance.choice([percent for percent in range(1, 101) if percent != self.c.manual_speed])
        return Operation(["speed", "manual", str(value)], lambda data: None, lambda: self.c.manual_speed == value)

    def servo(self, chance):
        on = not self.c.servo
        return Operation(["servo", "on" if on else "off"], lambda data: None, lambda: self.c.servo == on, motion=True)

    def move(self, chance):
        value = [chance.randrange(-90000, 90000) for _ in range(4)]
        before = self.c.moves
        target = ",".join("%.3f" % axis for axis in self.millimetres(value))
        return Operation(["move", "--to=" + target, "--speed-of-max", "50"], lambda data: None,
                         lambda: self.c.moves > before and self.c.position == value, motion=True)
