"""A client of DCP that others wrote (pnio-dcp): finds the station, reads its name, names it, makes it blink."""
import sys

from pnio_dcp import DCP

address, name = sys.argv[1:3]
dcp = DCP(address)
dcp.identify_all_timeout = 2
found = dcp.identify_all()
assert [device.name_of_station for device in found] == [name], [str(device) for device in found]
mac = found[0].MAC
assert dcp.get_name_of_station(mac) == name
assert dcp.get_ip_address(mac) == found[0].IP
assert dcp.blink(mac), 'it does not blink'
for other in ('robot-7', name):
    assert dcp.set_name_of_station(mac, other), other
    assert dcp.get_name_of_station(mac) == other
assert not dcp.set_name_of_station(mac, 'port-001'), 'a name that is kept for ports was taken'
print('pnio-dcp has seen all')
