"""A controller that others wrote (profinet-py), up to data: what it sends comes back, and it reads who the device is.

It starts as controllers did before 2010, with frames of the older class.
"""
import sys
import time

import profinet.rpc as rpc
import profinet.rt as rt
from profinet.cyclic import CyclicController
from profinet.util import ethernet_socket, get_mac, s2mac

interface, name = sys.argv[1:3]
# Slot, subslot, bytes from it, bytes to it, module, submodule.
slots = [rpc.IOSlot(0, 1, 0, 0, 1, 1), rpc.IOSlot(0, 0x8000, 0, 0, 1, 0x8000), rpc.IOSlot(0, 0x8001, 0, 0, 1, 0x8001),
         rpc.IOSlot(1, 1, 48, 0, 0x101, 1), rpc.IOSlot(2, 1, 0, 48, 0x102, 1)]
mac = get_mac(interface)
info = rpc.get_station_info(ethernet_socket(interface, 3), mac, name)
connection = rpc.RPCCon(info)
got = connection.connect(mac, iocr_setup=rpc.IOCRSetup(slots=slots, reduction_ratio=16, watchdog_factor=100,
                                                       data_hold_factor=100))
listener = connection.create_alarm_listener(interface)
listener.start()
inputs, outputs = rt.build_iocr_configs(slots, got.input_frame_id, got.output_frame_id, 32, 16, 100)
cyclic = CyclicController(interface=interface, src_mac=mac, dst_mac=s2mac(info.mac), input_iocr=inputs,
                          output_iocr=outputs)
cyclic.start()
connection.prm_end()
connection.application_ready()
for number in range(1, 6):
    wanted = bytes([number] * 48)
    cyclic.set_output_data(2, 1, wanted)
    end = time.monotonic() + 20
    while cyclic.get_input_data(1, 1) != wanted:
        assert time.monotonic() < end, (number, cyclic.get_input_data(1, 1), cyclic.stats)
        time.sleep(0.01)
order = connection.read_im0().order_id
assert 'RCX340' in str(order), order
cyclic.stop()
connection.close()
listener.stop()
print('profinet-py has seen its data come back')
