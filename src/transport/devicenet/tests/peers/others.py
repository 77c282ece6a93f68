"""A master that others wrote (devicenet-py): goes on line, allocates slave 5 of 4 bytes, brings the poll up and polls it.

It does not put fragments together, so it is no check for the large image, and it has no release.
"""
import functools
import sys

import can
from devicenet.devicenet import DeviceNet
from devicenet.enums import DeviceNetConnectionObjectAttributes as Attribute
from devicenet.fields import DeviceNetAllocationChoiceByte

# It gives an answer a tenth of a second: too little for a busy machine.
DeviceNet.handle_messages = functools.partialmethod(DeviceNet.handle_messages, timeout=0.5)

bus = can.Bus(interface="slcan", channel=sys.argv[1], bitrate=500000, sleep_after_open=0)
try:
    DeviceNet(bus, mac_id=5).connect()
    sys.exit("it does not hear that MAC 5 is taken")
except RuntimeError as error:
    assert "already in use" in str(error), error
# It says the number of the master two bits too far to the left, which only 0 survives.
master = DeviceNet(bus, mac_id=0, vendor_id=0xFFFF, serial_number=9)
master.connect()
master.master_slave_connect(5, DeviceNetAllocationChoiceByte(explicit_message=True, polled=True))
for attribute in (Attribute.PRODUCED_CONNECTION_SIZE, Attribute.CONSUMED_CONNECTION_SIZE):
    size = master.get_attribute_single(5, attribute)
    assert size == 4, (attribute, size)
master.set_attribute_single(5, Attribute.EXPECTED_PACKET_RATE, 5000)
for number in range(1, 6):
    image = bytes([0x41, 0, number, 0])
    master.poll_io(5, image)
    back = bytes(master.poll_io(5))
    assert back == image, (back.hex(), image.hex())
print("devicenet-py has seen its images come back")
