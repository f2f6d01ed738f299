"""usage: odd_log.py LOG OUT [--flip TOPIC=N:BIT]... [--shift TOPIC=US]...
                  [--info KEY=VALUE]... [--by-px4]

Copies a ULog with what real logs have. --flip: in the time of sample N (from 0) of a topic, this
bit is wrong. --shift: all times of a topic are so much later. --info: this info message comes
first; the key has its type, as in "char[3] x", and the value is a text, or bytes as in hex:00ff.
--by-px4: another system than attest wrote it, so it is judged as the log of a flight."""

import argparse
import pathlib
import struct


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--flip", action="append", default=[])
    parser.add_argument("--shift", action="append", default=[])
    parser.add_argument("--info", action="append", default=[])
    parser.add_argument("--by-px4", action="store_true")
    return parser.parse_args()


def message(kind, body):
    return struct.pack("<HB", len(body), ord(kind)) + body


def info(text):
    key, value = text.split("=", 1)
    hexadecimal = value.startswith("hex:")
    value = bytes.fromhex(value[4:]) if hexadecimal else value.encode()
    return message("I", bytes([len(key)]) + key.encode() + value)


def flips(options):
    """{(topic, sample): bits that are wrong}"""
    found = {}
    for text in options:
        topic, place = text.split("=")
        sample, bit = map(int, place.split(":"))
        key = (topic.encode(), sample)
        found[key] = found.get(key, 0) ^ (1 << bit)
    return found


def shifts(options):
    """{topic: us}"""
    pairs = (text.split("=") for text in options)
    return {topic.encode(): int(time) for topic, time in pairs}


def edited(log, wrong, later, infos):
    subscribed, seen, at = {}, {}, 16
    head_end = at
    if log[at + 2] == ord("B"):
        head_end += 3 + struct.unpack_from("<H", log, at)[0]
    yield log[:head_end] + b"".join(infos)
    at = head_end
    while at < len(log):
        size, kind = struct.unpack_from("<HB", log, at)
        body = bytearray(log[at + 3 : at + 3 + size])
        if kind == ord("A"):
            subscribed[bytes(body[1:3])] = bytes(body[3:])
        if kind == ord("D"):
            topic = subscribed[bytes(body[:2])]
            sample = seen[topic] = seen.get(topic, -1) + 1
            time = struct.unpack_from("<Q", body, 2)[0] ^ wrong.get((topic, sample), 0)
            time += later.get(topic, 0)
            struct.pack_into("<Q", body, 2, time)
        yield message(chr(kind), bytes(body))
        at += 3 + size


args = arguments()
data = args.log.read_bytes()
if args.by_px4:
    data = data.replace(b"sys_nameattest", b"sys_nameanyone")
    data = data.replace(b"attest_source", b"source_of_log")
messages = edited(data, flips(args.flip), shifts(args.shift), [info(text) for text in args.info])
args.out.write_bytes(b"".join(messages))
