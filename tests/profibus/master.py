#!/usr/bin/env python3
"""The master of the package pyprofibus (1.13, with pyserial) drives a slave on a terminal until images came back.

usage: master.py TERMINAL [COUNT]  - ends with exit code 0 once the slave has exchanged so many images of 48 bytes each way, 20
if not told.
"""

import sys
import time

import pyprofibus.dp
from pyprofibus.dp import DpCfgDataElement
from pyprofibus.dp_master import DPM1, DpSlaveDesc
from pyprofibus.phy_serial import CpPhySerial

STATION, IDENT, DEADLINE = 5, 0x1234, 30


def main():
    phy = CpPhySerial(port=sys.argv[1])
    phy.setConfig(baudrate=CpPhySerial.BAUD_9600)
    master = DPM1(phy, masterAddr=2)
    slave = DpSlaveDesc()
    slave.identNumber, slave.slaveAddr, slave.name, slave.index = IDENT, STATION, "slave", 0
    slave.inputSize = slave.outputSize = 48
    slave.diagPeriod = 0
    slave.setPrmTelegram.identNumber = IDENT
    slave.setPrmTelegram.da = slave.chkCfgTelegram.da = STATION
    slave.setCfgDataElements([DpCfgDataElement(0xC0, b"\xD7\xD7")])
    slave.setUserPrmData(b"")
    slave.setSyncMode(False)
    slave.setFreezeMode(False)
    slave.setGroupMask(0)
    slave.setWatchdog(1000)
    master.addSlave(slave)
    master.initialize()
    image = bytearray(48)
    image[32] = 0x41
    wanted = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    exchanged, end = 0, time.monotonic() + DEADLINE
    while exchanged < wanted and time.monotonic() < end:
        slave.setMasterOutData(bytes(image))
        master.run()
        shown = slave.getMasterInData()
        if shown is not None:
            if len(shown) != 48:
                sys.exit("an image of %d bytes" % len(shown))
            exchanged += 1
    master.destroy()
    print("exchanged:", exchanged)
    sys.exit(0 if exchanged >= wanted else 1)


main()
