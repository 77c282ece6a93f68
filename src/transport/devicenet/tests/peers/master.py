"""A master, message by message: allocates slave 5, reads its name and sizes, polls it, releases it."""
import sys

import can

bus = can.Bus(interface="slcan", channel=sys.argv[1], bitrate=500000, sleep_after_open=0)
size = int(sys.argv[2])


def send(identifier, data):
    bus.send(can.Message(arbitration_id=identifier, data=bytes(data), is_extended_id=False))


def receive(identifier):
    while True:
        message = bus.recv(20)
        assert message is not None, f"nothing came from {identifier:03X}"
        if message.arbitration_id == identifier:
            return bytes(message.data)


def ask(identifier, data, expected):
    send(identifier, data)
    got = receive(0x42B)
    assert got == bytes(expected), (got.hex(), bytes(expected).hex())


ask(0x42E, [1, 0x0E, 1, 1, 1], [1, 0x94, 0x0C, 0x03])  # without a connection: only 4B and 4C
ask(0x42E, [1, 0x4B, 3, 1, 2, 1], [1, 0x94, 0x0C, 0x02])  # a poll without explicit
ask(0x42E, [1, 0x4B, 3, 1, 3, 1], [1, 0xCB, 0])
ask(0x42E, [1, 0x4B, 3, 1, 3, 1], [1, 0x94, 0x0B, 0x02])  # twice
ask(0x42E, [2, 0x4B, 3, 1, 3, 2], [2, 0x94, 0x0C, 0x01])  # another master
ask(0x42C, [1, 0x0E, 1, 1, 1], [1, 0x8E, 0x7C, 0x02])
send(0x42C, [1, 0x0E, 1, 1, 7])
name = b""
while True:
    part = receive(0x42B)
    assert part[0] == 0x81, part.hex()
    name += part[2:]
    send(0x42C, [0x81, 0xC0 | part[1] & 0x3F, 0])
    if part[1] >> 6 == 2:
        break
assert name == b"\x8e\x0aYRCX (sim)", name
ask(0x42C, [1, 0x0E, 5, 2, 7], [1, 0x8E, size, 0])
ask(0x42C, [1, 0x0E, 5, 2, 8], [1, 0x8E, size, 0])
send(0x42D, bytes(min(size, 8)))  # before attribute 9 polls are passed over
ask(0x42C, [1, 0x10, 5, 2, 9, 0x5F, 0], [1, 0x90, 0x64, 0])
image = bytes(range(1, size + 1))
if size <= 8:
    send(0x42D, image)
    back = receive(0x3C5)
else:
    parts = [image[at : at + 7] for at in range(0, size, 7)]
    heads = [0x00] + [0x40 | count for count in range(1, len(parts) - 1)] + [0x80 | len(parts) - 1]
    for head, part in zip(heads, parts):
        send(0x42D, bytes([head]) + part)
    back = b""
    for head in heads:
        part = receive(0x3C5)
        assert part[0] == head, part.hex()
        back += part[1:]
assert back == image, back.hex()
send(0x42D, [])  # idle: answered with inputs
assert receive(0x3C5)[-1:] != b""
if size > 8:
    for _ in range(6):
        receive(0x3C5)
ask(0x42C, [1, 0x4C, 3, 1, 3], [1, 0xCC])
print("released")
