"""Looks at the cyclic frames that leave an interface, by the clock of the system's kernel, until it is ended: prints how far
their intervals are from the cycle, at 99 of 100.

usage: looker.py INTERFACE NAME CYCLE_S
"""
import signal
import socket
import struct
import sys

STAMP = 35  # SO_TIMESTAMPNS
interface, name, cycle = sys.argv[1], sys.argv[2], float(sys.argv[3])
# Protocol 0 receives nothing: no frame arrives before its time is asked for.
looker = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, 0)
looker.setsockopt(socket.SOL_SOCKET, STAMP, 1)
looker.bind((interface, 3))
times = []


def done(*_):
    off = sorted(abs(after - before - cycle) for before, after in zip(times, times[1:]))
    print(name, 'jitter', off[(len(off) - 1) * 99 // 100] if off else 'nan', flush=True)
    sys.exit()


def is_cyclic(frame):
    """A frame of PROFINET with data, tagged or not; or any datagram, of the bare loop."""
    if name == 'bare':
        return frame[12:14] == b'\x08\x00'
    rest = frame[16:] if frame[12:14] == b'\x81\x00' else frame[12:]
    return rest[:2] == b'\x88\x92' and 0x80 <= rest[2] < 0xF8


signal.signal(signal.SIGTERM, done)
print('ready', flush=True)
while True:
    frame, extra, _, address = looker.recvmsg(2048, 64)
    if address[2] == socket.PACKET_OUTGOING and is_cyclic(frame):
        seconds, nanos = struct.unpack('qq', extra[0][2])
        times.append(seconds + nanos / 1e9)
