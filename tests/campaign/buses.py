"""The buses of the campaign: how each controller is reached, and which faults its line has."""


import devicenet
import profibus
import profinet
from eip import CYCLIC_FAULTS, CYCLIC_HARMLESS, Adapter, Images
from line import DATAGRAM_FAULTS, HARMLESS, STREAM_FAULTS, TERMINAL_FAULTS, Line, TcpPort, Terminal, UdpPort
from operations import ToyoOperations, YercOperations, YrcxOperations
from toyo import Toyo
from yerc import Yerc
from yrcx import Yrcx


class World:
    needs_session, session_flags, timeout, stop = False, [], 0.2, None
    harmless = HARMLESS
    prefix = []  # words before those of armctl
    probe = None  # a read that fails while a command of another client runs

    def close(self):
        pass

    def killed(self):
        """armctl was killed."""

    def without_number(self, message):
        return message


class YercWorld(World):
    name, family, faults = "yerc", "yerc", DATAGRAM_FAULTS
    stop = ("switch", 1, 1)

    async def open(self, folder, tag):
        self.controller = Yerc()
        self.line = Line(self.controller, self.timeout)
        self.ports = [await UdpPort.open(self.line, "robot"), await UdpPort.open(self.line, "file")]
        self.target = "udp://127.0.0.1:%d?file_port=%d&model=dx200" % (self.ports[0].number, self.ports[1].number)
        self.operations = YercOperations(self.controller, folder, tag)
        return self

    def close(self):
        for port in self.ports:
            port.transport.close()
            port.forger.close()

    def without_number(self, message):
        port, raw = message
        return port, raw[:11] + raw[12:]


class ToyoTcp(World):
    name, family, faults = "toyo-tcp", "toyo", STREAM_FAULTS

    async def open(self, folder, tag):
        self.controller = Toyo()
        self.line = Line(self.controller, self.timeout)
        self.port = await TcpPort.open(self.line)
        self.target = "tcp://127.0.0.1:%d" % self.port.number
        self.operations = ToyoOperations(self.controller, folder, tag)
        return self

    def close(self):
        self.port.server.close()


class ToyoTerminal(ToyoTcp):
    name, faults = "toyo-pty", TERMINAL_FAULTS

    async def open(self, folder, tag):
        self.controller = Toyo()
        self.line = Line(self.controller, self.timeout)
        self.terminal = Terminal(self.line)
        self.target = "serial://" + self.terminal.path
        self.operations = ToyoOperations(self.controller, folder, tag)
        return self

    def killed(self):
        self.terminal.release()

    def close(self):
        self.terminal.close()


class Eip(World):
    name, family, faults, harmless = "yrcx-eip", "yrcx", CYCLIC_FAULTS, CYCLIC_HARMLESS
    probe = ["info", "servo"]
    needs_session, session_flags, timeout = True, ["--yes"], 0.5

    async def open(self, folder, tag):
        self.controller = Yrcx()
        self.line = Images(self.controller)
        self.adapter = await Adapter.open(self.line)
        self.target = "eip://127.0.0.1:%d?rpi=20ms&multiplier=64" % self.adapter.number
        self.operations = YrcxOperations(self.controller, folder, tag)
        return self

    def close(self):
        self.adapter.close()


class DeviceNet(Eip):
    name, faults, harmless = "yrcx-devicenet", devicenet.FAULTS, devicenet.HARMLESS

    async def open(self, folder, tag):
        self.controller = Yrcx()
        self.line = Images(self.controller)
        self.adapter = await devicenet.Slave.open(self.line)
        self.target = "slcan://127.0.0.1:%d?mac=5&rate=250ms" % self.adapter.number
        self.operations = YrcxOperations(self.controller, folder, tag)
        return self


class Profibus(Eip):
    name, faults, harmless = "yrcx-profibus", profibus.FAULTS, profibus.HARMLESS

    async def open(self, folder, tag):
        self.controller = Yrcx()
        self.line = Images(self.controller)
        self.adapter = profibus.Slave.open(self.line)
        # The slot time is long, because the slave is a program on a busy computer.
        self.target = "profibus://%s?station=5&slot=60ms&watchdog=1s" % self.adapter.path
        self.operations = YrcxOperations(self.controller, folder, tag)
        return self

    def killed(self):
        self.adapter.terminal.release()


class Profinet(Eip):
    name, faults, harmless = "yrcx-profinet", profinet.FAULTS, profinet.HARMLESS

    async def open(self, folder, tag):
        self.controller = Yrcx()
        self.line = Images(self.controller)
        self.adapter = await profinet.Device.open(self.line)
        self.prefix = self.adapter.prefix
        self.target = "profinet://%s@%s?layout=%s&cycle=32ms&watchdog=960ms" % (self.adapter.name, self.adapter.peer_card, profinet.LAYOUT)
        self.operations = YrcxOperations(self.controller, folder, tag)
        return self


def bus(world):
    async def make(folder, tag):
        return await world().open(folder, tag)
    return make


BUSES = {world.name: bus(world) for world in (YercWorld, ToyoTcp, ToyoTerminal, Eip, DeviceNet, Profibus, Profinet)}
