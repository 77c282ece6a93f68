"""A controller that others wrote (profinet-py), up to data: what it sends comes back, and it reads who the device is.

It starts as controllers did before 2010, with frames of the older class; with "class2" behind the names, with those of
today. With "yrcx" the device is a controller, and runs a remote command; with "time=SECONDS" it holds the connection for so
long, and tells seconds until data flowed, and seconds of processors in that time.
"""
import sys
import time

import profinet.rpc as rpc
import profinet.rt as rt
from profinet.cyclic import CyclicController
from profinet.util import ethernet_socket, get_mac, s2mac

interface, name, *words = sys.argv[1:]
begin = time.monotonic()
if 'class2' in words:
    older = rpc.PNIOCRBlockReqHeader

    def today(**fields):
        fields['iocr_properties'] = 2
        if fields['iocr_type'] == 1:
            fields['frame_id'] = 0x8001
        return older(**fields)

    today.fmt_size, today.BLOCK_TYPE = older.fmt_size, older.BLOCK_TYPE
    rpc.PNIOCRBlockReqHeader = today
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


def show(image, answered):
    """Shows an image until the device shows one that answers it."""
    cyclic.set_output_data(2, 1, bytes(image))
    end = time.monotonic() + 20
    while not answered(cyclic.get_input_data(1, 1) or bytes(48)):
        assert time.monotonic() < end, (image, cyclic.get_input_data(1, 1), cyclic.stats)
        time.sleep(0.01)


def tell(connected, seconds):
    """Holds the connection."""
    used = time.process_time()
    time.sleep(seconds)
    print('profinet-py figures', connected, time.process_time() - used)


# SI(00) and SI(06): no emergency stop, no stop.
image = bytearray(48)
image[32] = 0x41
cyclic.set_output_data(2, 1, bytes(image))
cyclic.start()
connection.prm_end()
connection.application_ready()
if 'yrcx' in words:
    # CPU OK; then 0x0501, the versions, until it is done; and ready again.
    show(image, lambda shown: shown[32] & 2)
    connected = time.monotonic() - begin
    seconds = [float(word[5:]) for word in words if word.startswith('time=')]
    if seconds:
        tell(connected, seconds[0])
    image[0:2] = b'\x01\x05'
    show(image, lambda shown: shown[0:2] == b'\x00\x02')
    image[0:2] = b'\x00\x00'
    show(image, lambda shown: shown[0:2] == b'\x00\x00')
else:
    for number in range(1, 6):
        image = bytes([number] * 48)
        show(image, lambda shown: shown == image)
order = connection.read_im0().order_id
assert ('YRCX' if 'yrcx' in words else 'RCX340') in str(order), order
cyclic.stop()
connection.close()
listener.stop()
print('profinet-py has seen its data come back' if 'yrcx' not in words else 'profinet-py has run a remote command')
