"""usage: thin_log.py LOG OUT

Copies a ULog of attest as another logger would have written it: by another system, and without
every second sample of control_state and actuator_controls_0."""

import pathlib
import struct
import sys

THINNED = {b"control_state", b"actuator_controls_0"}


def thinned(log):
    subscribed, seen, at = {}, {}, 16
    yield log[:at]
    while at < len(log):
        size, kind = struct.unpack_from("<HB", log, at)
        body = log[at + 3 : at + 3 + size]
        if kind == ord("A"):
            subscribed[body[1:3]] = body[3:]
        topic = subscribed.get(body[:2]) if kind == ord("D") else None
        seen[topic] = seen.get(topic, -1) + 1
        if topic not in THINNED or seen[topic] % 2 == 0:
            yield log[at : at + 3 + size]
        at += 3 + size


log = pathlib.Path(sys.argv[1]).read_bytes()
log = log.replace(b"sys_nameattest", b"sys_nameanyone").replace(b"attest_source", b"source_of_log")
pathlib.Path(sys.argv[2]).write_bytes(b"".join(thinned(log)))
