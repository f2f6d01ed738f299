"""Writes the first inputs of a fuzz target, from the suite, and a dictionary of its words.

    seeds.py TARGET FOLDER DICTIONARY
"""

import json
import pathlib
import re
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

TRACE_ROWS = 4  # of a long trace: mutations of short inputs reach more
MOST_BYTES = 16_384


def case_seeds():
    for file in sorted((ROOT / "cases").rglob("*.toml")):
        yield file.read_bytes()
    # The examples of the keys that no case uses.
    schema = (ROOT / "harness/casefile/SCHEMA.md").read_text(encoding="utf-8")
    for block in re.findall(r"```toml\n(.*?)```", schema, re.DOTALL):
        yield block.encode()


def shortened(file):
    with file.open("rb") as lines:
        return b"".join(line for _, line in zip(range(TRACE_ROWS + 1), lines))


def csv_seeds():
    for file in sorted((ROOT / "golden/recorded").rglob("*.csv")):
        yield shortened(file)


def vehicle_seeds():
    for file in sorted((ROOT / "models").glob("*.toml")):
        yield file.read_bytes()


# Elements and attributes of MJCF that no model here uses.
MJCF_WORDS = """
actuator angle armature asset axis body builtin camera cdof childclass class composite connect
contact content_type coordinate damping default density diaginertia discardvisual dynprm dyntype
element elevation equality euler exclude extension file fitaabb flag frictionloss fromto fullinertia
gainprm gear general geom hfield inertiafromgeom inertial integrator joint keyframe key limited
margin mesh muscle name ncol nkey nrow numeric nuser_geom nuserdata option pair plugin pos quat
range ref sensor site size skin solimp solref spatial springlength statistic tendon text texture
tuple type user vertex visual weld width worldbody xyaxes zaxis
"""


def mjcf_seeds():
    for file in sorted((ROOT / "models").glob("*.xml")):
        yield file.read_bytes()
    elements = "".join(f"<{word} name='a'/>" for word in MJCF_WORDS.split())
    yield f"<mujoco><worldbody>{elements}</worldbody>{elements}</mujoco>".encode()


def timing_seeds():
    timing = {
        "attest_timing": 1,
        "case": "px4-v1.5.5/flight/hover",
        "case_sha256": "00",
        "rate": "1000/3",
        "vehicle": "iris",
        "plant": "mujoco",
        "duration_s": 10,
        "ticks_ns": [[-1, 8113, 1_000_000], [0, 1_009_001, None], [9, 3_000_000, 3_000_000]],
    }
    yield json.dumps(timing).encode()
    other = {"plant": "ode", "rate": "62.5", "duration_s": 0.5}
    yield json.dumps(timing | other, indent=1).encode()


def task_set_seeds():
    unit = "[task.unit]\nrate_hz = 1000\nexecution_us = 76\npriority = 2\n"
    estimator = "[task.estimator]\nrate_hz = 1000\nexecution_us = [100, 400]\npriority = 3\n"
    logger = "[task.logger]\nrate_hz = 62.5\nphase_us = 100.5\nexecution_us = 4000\npriority = 1\n"
    triggered = '[task.unit]\ntrigger = "estimator"\nexecution_us = 76\npriority = -2\ncpu = 1\n'
    yield unit.encode()
    yield f"{unit}\n{estimator}\n{logger}".encode()
    yield f"{triggered}\n{estimator}\n{logger}cpu = 1\n".encode()


# As the requests in protocol.cpp: for each module create, set_parameter, step, step, a batch of
# three steps if the program has batches, destroy.
OUTPUT_BYTES = {"mc_att_control": 72, "mixer": 36, "battery_status": 4}
CREATE, DESTROY, SET_PARAMETER, STEP, BATCH = 1, 2, 3, 4, 5
OK, FAILED = 0, 3
HELLO = {"protocol": 1, "name": "seed", "version": "1", "profiles": ["px4-v1.5.5"]}


def binary_session(hello, modules, last_of_batch=OK):
    answers, sequence = [json.dumps(hello).encode() + b"\n"], 0
    for unit, module in enumerate(modules, 1):
        outputs = bytes(range(OUTPUT_BYTES[module]))
        result = struct.pack("<I", OK)
        batch = struct.pack("<II", OK, 3) + 3 * outputs
        if last_of_batch != OK:
            batch = struct.pack("<II", last_of_batch, 1) + outputs
        frames = [(CREATE, result), (SET_PARAMETER, result)] + 2 * [(STEP, result + outputs)]
        frames += [(BATCH, batch)] if hello.get("batch") else []
        for kind, payload in [*frames, (DESTROY, result)]:
            sequence += 1
            answers += [struct.pack("<IIII", len(payload), kind, unit, sequence), payload]
    return b"".join(answers)


def text_session():
    step = {
        "out/vehicle_rates_setpoint.roll": 0.25,
        "out/vehicle_rates_setpoint.pitch": "nan",
        "out/vehicle_rates_setpoint.yaw": "-inf",
        "out/vehicle_rates_setpoint.published": 1,
        "out/actuator_controls_0.control[0]": -0.15,
        "out/actuator_controls_0.published": True,
        "out/mc_att_ctrl_status.roll_rate_integ": 1e-3,
        "out/mc_att_ctrl_status.published": 0,
    }
    lines = [HELLO | {"frames": "text", "fixed_step": "250", "arithmetic": "fixed:22"}]
    members = [{}, {}, step, {}, {}]
    lines += [{"sequence": i, "result": "ok"} | each for i, each in enumerate(members, 1)]
    return b"".join(json.dumps(line).encode() + b"\n" for line in lines)


def protocol_seeds():
    binary = HELLO | {"frames": "binary"}
    every_module = {"modules": ["mixer", "battery_status"], "unsupported_groups": ["tailsitter"]}
    yield binary_session(binary, ["mc_att_control"])
    yield binary_session(binary | {"batch": True}, ["mc_att_control"])
    yield binary_session(binary | {"batch": True}, ["mc_att_control"], FAILED)
    yield binary_session(binary | {"batch": True} | every_module, list(OUTPUT_BYTES))
    yield text_session()


# Answers to request 1 of a process: a letter for the kind, the head, and zeros for the blobs.
def host_seeds():
    fault = {"kind": 1, "tick": 2, "what": "step returned ATTEST_UNSUPPORTED"}
    says = {"name": "a", "version": "1", "unsupported_groups": ["tpa"], "modules": 1}
    change = {"tick": 0, "name": "MC_ROLL_P", "bits": 0}
    flown = {"ticks": 3, "parameters": [change]}
    timed = {"steps": 3, "clock_ns": 20, "stack": 4096}
    usage = {"cpu_ns": 1, "allocations": 0, "page_faults": 0, "yields": 0, "preemptions": 0}
    spread = {"min_ns": 1, "max_ns": 3, "buckets": [{"from_ns": 1, "count": 1}]}
    unit = {"ticks": 3, "skipped": 0, "usage": usage, "parameters": [change]}
    live = {"units": [unit], "plant": {"late_steps": 0, "usage": usage, "latency": spread}}
    live |= {"privileges": [{"name": "mlockall", "got": True, "why": ""}]}
    # Three LiveTicks with increasing `begins`.
    ticks = b"".join(struct.pack("=9q?3xIq", *[0] * 5, k, *[0] * 5, -1) for k in (1, 2, 3))
    for kind, head in [
        ("g", {"says": says}),
        ("g", {"says": says | {"fraction_bits": 22, "fixed_step": "250"}}),
        ("g", {"error": {"message": "no such library", "file": "a.so", "line": 1}}),
        ("d", {}),
        ("d", {"fault": fault}),
        ("f", flown),
        ("f", flown | {"divergence": {"at_ns": 1, "what": "lost"}}),
        ("t", timed),
        ("l", live),
        ("l", live | {"divergence": {"at_ns": 1, "what": "lost"}}),
    ]:
        yield f"{kind}{json.dumps({'request': 1} | head)}\n".encode() + ticks * (kind == "l")


def ulog_message(kind, body):
    return struct.pack("<Hc", len(body), kind.encode()) + body


def flight_log():
    state = "uint64_t timestamp;float[4] q;float roll_rate;float pitch_rate;float yaw_rate;"
    setpoint = "uint64_t timestamp;float[4] q_d;float thrust;float yaw_sp_move_rate;"
    rates = "uint64_t timestamp;float roll;float pitch;float yaw;float thrust;"
    controls = "uint64_t timestamp;uint64_t timestamp_sample;float[8] control;"
    names = "control_state", "vehicle_attitude_setpoint", "vehicle_rates_setpoint"
    topics = dict(zip(names, (state, setpoint, rates)), actuator_controls_0=controls)
    for name, fields in topics.items():
        yield ulog_message("F", f"{name}:{fields}".encode())
    for number, name in enumerate(topics):
        yield ulog_message("A", struct.pack("<BH", 0, number) + name.encode())
    for time in (4000, 8000):
        yield ulog_message("D", struct.pack("<HQ6f", 1, time, 1, 0, 0, 0, 0.5, 0))
        yield ulog_message("D", struct.pack("<HQ7f", 0, time, 1, 0, 0, 0, 0.1, 0, 0))
        yield ulog_message("D", struct.pack("<HQ4f", 2, time + 50, 0.1, 0, 0, 0.5))
        yield ulog_message("D", struct.pack("<HQQ8f", 3, time + 80, time, *8 * [0.1]))


def cascade_log():
    attitude = "uint64_t timestamp;uint64_t timestamp_sample;float[4] q;float[4] delta_q_reset;"
    topics = {
        "vehicle_attitude": attitude + "uint8_t quat_reset_counter;",
        "vehicle_attitude_setpoint": "uint64_t timestamp;float yaw_sp_move_rate;float[4] q_d;"
        "float[3] thrust_body;",
        "vehicle_rates_setpoint": "uint64_t timestamp;float roll;float pitch;float yaw;"
        "float[3] thrust_body;",
        "vehicle_angular_velocity": "uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;"
        "float[3] xyz_derivative;",
        "vehicle_torque_setpoint": "uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
        "vehicle_control_mode": "uint64_t timestamp;bool flag_armed;"
        "bool flag_control_rates_enabled;bool flag_control_manual_enabled;"
        "bool flag_control_attitude_enabled;",
    }
    release = b"\x17uint32_t ver_sw_release" + struct.pack("<I", 0x011000FF)
    yield ulog_message("I", release)
    for name, fields in topics.items():
        yield ulog_message("F", f"{name}:{fields}".encode())
    for number, name in enumerate(topics):
        yield ulog_message("A", struct.pack("<BH", 0, number) + name.encode())
    for time in (4000, 8000, 12000):
        mode = 1, 1, time == 8000, 1
        yield ulog_message("D", struct.pack("<HQ4B", 5, time - 50, *mode))
        yield ulog_message("D", struct.pack("<HQ8f", 1, time - 40, 0, 1, 0, 0, 0, 0, 0, -0.5))
        yield ulog_message("D", struct.pack("<HQQ8fB", 0, time, time, *[1, 0, 0, 0] * 2, 3))
        yield ulog_message("D", struct.pack("<HQQ6f", 3, time, time, *6 * [0.1]))
        yield ulog_message("D", struct.pack("<HQ6f", 2, time + 50, 0.1, 0, 0, 0, 0, -0.5))
        yield ulog_message("D", struct.pack("<HQQ3f", 4, time + 60, time, 0.1, 0, 0))


def ulog_seeds():
    key_value = b"\x0ffloat MC_ROLL_P" + struct.pack("<f", 6.5)
    inner = struct.pack("<ffI", 1, 2, 0)
    log = [
        ulog_message("I", b"\x10char[3] sys_namePX4"),
        ulog_message("M", b"\x01\x0cchar[3] perfone"),
        ulog_message("P", key_value),
        ulog_message("Q", b"\x01" + key_value),
        ulog_message("F", b"top:uint64_t timestamp;in[2] a;bool b;char[3] c;int8_t[4] _padding0;"),
        ulog_message("F", b"in:float[2] x;uint8_t[4] _padding0;"),
        ulog_message("A", b"\x00\x01\x00top"),
        ulog_message("D", struct.pack("<HQ", 1, 7) + 2 * inner + b"\x01abc"),
        ulog_message("S", b"\x2f\x73\x13\x20\x25\x0c\xbb\x12"),
        ulog_message("L", b"6" + struct.pack("<Q", 8) + b"text"),
        ulog_message("C", b"6" + struct.pack("<HQ", 3, 8) + b"text"),
        ulog_message("O", b"\x28\x00"),
        ulog_message("Z", b"new"),
        ulog_message("R", b"\x01\x00"),
    ]
    head = b"ULog\x01\x12\x35" + struct.pack("<BQ", 1, 5)
    flags = ulog_message("B", bytes(40))
    end = len(head + flags + b"".join(log))
    appended = ulog_message("B", bytes(8) + struct.pack("<QQQQ", 1, end, 0, 0))
    yield head.replace(b"\x35\x01", b"\x35\x00") + b"".join(log)
    yield head + flags + b"".join(log) + bytes(9) + b"".join(log[6:])
    yield head + appended + b"".join(log) + b"".join(log[6:])
    yield head + flags + b"".join(flight_log())
    yield head + flags + b"".join(cascade_log())


def words_of(seeds):
    word = re.compile(rb"[A-Za-z_][A-Za-z0-9_./\[\]]{2,40}")
    numbers = {b"nan", b"-inf", b"1e308", b"1e-9", b"-1", b"9223372036854775807", b"true"}
    return sorted(numbers.union(*(word.findall(seed) for seed in seeds)))


def main():
    target, folder, dictionary = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    seeds = [seed for seed in globals()[f"{target}_seeds"]() if len(seed) <= MOST_BYTES]
    folder.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds):
        (folder / f"seed_{number:03}").write_bytes(seed)
    lines = [f'"{word.decode()}"\n' for word in words_of(seeds)]
    dictionary.write_text("".join(lines), encoding="ascii")


if __name__ == "__main__":
    main()
