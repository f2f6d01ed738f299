"""usage: long_log.py LOG OUT MEGABYTES

Writes a log with the data of LOG again and again, at later and later times, until it has this size.
The topics must begin with the field `timestamp`."""

import struct
import sys

HEAD = 16  # bytes of the file's header


def messages(log):
    at = HEAD
    while at < len(log):
        (size,) = struct.unpack_from("<H", log, at)
        yield log[at : at + 3 + size]
        at += 3 + size


def main(source, out, megabytes):
    log = open(source, "rb").read()
    start = b"".join(each for each in messages(log) if each[2:3] != b"D")
    data = [bytearray(each) for each in messages(log) if each[2:3] == b"D"]
    times = [struct.unpack_from("<Q", each, 5)[0] for each in data]
    period = max(times) - min(times) + 4000
    turns = int(megabytes * 1e6 / sum(map(len, data)))
    with open(out, "wb") as file:
        file.write(log[:HEAD] + start)
        for turn in range(turns):
            for time, each in zip(times, data):
                struct.pack_into("<Q", each, 5, time + turn * period)
            file.write(b"".join(data))


main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
