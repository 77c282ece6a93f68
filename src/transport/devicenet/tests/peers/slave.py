"""A strict slave 5: every frame of a master must be the one that is due. Serves one connection, from the allocation to
the release, and tells the last image. Polls, and reads that keep the explicit connection alive, may come at any time."""
import sys

import can

bus = can.Bus(interface="slcan", channel=sys.argv[1], bitrate=500000, sleep_after_open=0)
size = int(sys.argv[2])
pieces = 1 if size <= 8 else -(-size // 7)


def send(identifier, data):
    bus.send(can.Message(arbitration_id=identifier, data=bytes(data), is_extended_id=False))


def receive():
    while True:
        message = bus.recv(30)
        assert message is not None, "the master is silent"
        assert not message.is_extended_id and not message.is_remote_frame
        if message.arbitration_id == 0x42F:  # the master looks whether this MAC is free
            send(0x42F, [0x80, 0x7C, 2, 1, 0, 0, 0])
        elif message.arbitration_id != 0x40F:
            return message.arbitration_id, bytes(message.data)


print("ready", flush=True)
xid = None
for identifier, request, answer in [
    (0x42E, [0x4B, 3, 1, 3, 1], [0xCB, 0]),
    (0x42C, [0x0E, 5, 2, 7], [0x8E, size, 0]),
    (0x42C, [0x0E, 5, 2, 8], [0x8E, size, 0]),
    (0x42C, [0x10, 5, 2, 9, 100, 0], [0x90, 100, 0]),
]:
    got, data = receive()
    assert (got, data[1:]) == (identifier, bytes(request)), f"{got:03X} {data.hex()}"
    assert data[0] & 0xBF == 1 and data[0] & 0x40 != xid, data.hex()  # from MAC 1, no fragment, another xid
    xid = data[0] & 0x40
    send(0x42B, [data[0]] + answer)

image, first = b"", None
while True:
    got, data = receive()
    if got == 0x42C:
        if data[1:] == bytes([0x4C, 3, 1, 3]):
            send(0x42B, [data[0], 0xCC])
            break
        assert data[1:] == bytes([0x0E, 3, 1, 5]), data.hex()
        send(0x42B, [data[0], 0x8E, 3, 1])
        continue
    assert got == 0x42D, f"{got:03X}"
    if pieces == 1:
        assert len(data) == size, data.hex()
        image = data
    else:
        parts = [data]
        for _ in range(pieces - 1):
            got, data = receive()
            assert got == 0x42D, f"{got:03X} within a poll"
            parts.append(data)
        heads = [0x00] + [0x40 | count for count in range(1, pieces - 1)] + [0x80 | pieces - 1]
        assert [part[0] for part in parts] == heads, [part.hex() for part in parts]
        image = b"".join(part[1:] for part in parts)
        assert len(image) == size
    first = first or image
    back = image if pieces == 1 else None
    if back is not None:
        send(0x3C5, back)
    else:
        for head, at in zip(heads, range(0, size, 7)):
            send(0x3C5, bytes([head]) + image[at : at + 7])
print("first", first.hex())
print("last", image.hex())
bus.shutdown()
