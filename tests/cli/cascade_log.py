"""usage: cascade_log.py OUT [--thin TOPIC=N]... [--lose TOPIC=N]... [--without TOPIC]...
                       [--profile PROFILE] [--release N.N.N] [--from S] [--rate-max HZ]
                       [--port PORT]

Writes the ULog that PX4's logger would have written of a flight with both units of v1.14 to v1.18:
the attitude unit at 250 Hz, the rate unit at 1 kHz, in position, stabilized and acro mode. The
outputs are those of the port (default: the reference, by `attest record`), for inputs that a case
describes.
Topics have the fields of PX4, in its order, and the times at which its modules publish.

--thin keeps every Nth sample of a topic, --lose leaves out every Nth. --release 0: not in the log.
--from begins S seconds after the flight. --rate-max is IMU_GYRO_RATEMAX; 0: not in the log."""

import argparse
import csv
import os
import pathlib
import struct
import subprocess
import tempfile

MODES = {  # manual, altitude, velocity, position, attitude
    "position": (1, 1, 1, 1, 1),
    "stabilized": (1, 0, 0, 0, 1),
    "acro": (1, 0, 0, 0, 0),
}
FLIGHT = [(0, "position"), (1.5999, "stabilized"), (2.3999, "acro"), (2.7999, "position")]
DURATION_S = 4
MODE_FLAGS = "manual altitude velocity position attitude".split()

FIELDS = {  # as in the messages of PX4 v1.16
    "vehicle_attitude": "Q timestamp_sample;4f q;4f delta_q_reset;B quat_reset_counter",
    "vehicle_attitude_setpoint": "f yaw_sp_move_rate;4f q_d;3f thrust_body;? reset_integral",
    "vehicle_rates_setpoint": "f roll;f pitch;f yaw;3f thrust_body;? reset_integral",
    "vehicle_angular_velocity": "Q timestamp_sample;3f xyz;3f xyz_derivative",
    "vehicle_torque_setpoint": "Q timestamp_sample;3f xyz",
    "vehicle_thrust_setpoint": "Q timestamp_sample;3f xyz",
    "rate_ctrl_status": "f rollspeed_integ;f pitchspeed_integ;f yawspeed_integ;f wheel_rate_integ",
    "manual_control_setpoint": "Q timestamp_sample;f roll;f pitch;f yaw;f throttle;f flaps;? valid",
    "vehicle_control_mode": "? flag_armed;? flag_control_manual_enabled;"
    "? flag_control_auto_enabled;? flag_control_position_enabled;? flag_control_velocity_enabled;"
    "? flag_control_altitude_enabled;? flag_control_attitude_enabled;? flag_control_rates_enabled",
    "vehicle_status": "Q armed_time;B arming_state;B nav_state;B vehicle_type;? is_vtol;"
    "? is_vtol_tailsitter;? in_transition_mode",
    "vehicle_land_detected": "? freefall;? maybe_landed;? landed",
    "hover_thrust_estimate": "f hover_thrust;f hover_thrust_var;? valid",
    "control_allocator_status": "3f unallocated_torque;? torque_setpoint_achieved",
    "battery_status": "f voltage_v;f scale;? connected",
}
TYPES = {"Q": "uint64_t", "f": "float", "B": "uint8_t", "?": "bool", "i": "int32_t"}


def signal(amplitude, frequency_hz, phase_deg=0, mean=0):
    return (
        f'{{ signal = "sine", mean = {mean}, amplitude = {amplitude}, '
        f"frequency_hz = {frequency_hz}, phase_deg = {phase_deg} }}"
    )


def samples(times_s, values):
    return f'{{ signal = "samples", times_s = {list(times_s)}, values = {list(values)} }}'


def sticks():
    return f"""
[manual_control_setpoint]
roll = {signal(0.4, 0.9)}
pitch = {signal(0.3, 0.7, 40)}
yaw = {samples([0, 1.7, 2.1], [0, 0.6, 0])}
throttle = {signal(0.1, 0.5)}
period_s = 0.02
"""


def mode_table(flags, more=""):
    times_s = [time for time, _ in FLIGHT]
    lines = [
        f"flag_control_{flag}_enabled = "
        + samples(times_s, [MODES[mode][MODE_FLAGS.index(flag)] for _, mode in FLIGHT])
        for flag in flags
    ]
    return "\n[vehicle_control_mode]\n" + "\n".join(lines) + f"\npublish_at_s = {times_s}\n{more}"


def head(module, rate_hz, parameters):
    return f"""schema = 1
profiles = ["PROFILE"]
group = "attitude"
module = "{module}"
why = "a flight"
duration_s = {DURATION_S}
rates_hz = [{rate_hz}]
rates_why = "of this flight"

[parameters]
{parameters}
"""


PARAMETERS = {
    "attitude_unit": {"MC_YAW_WEIGHT": 0.5, "MC_ROLL_P": 6.0, "MC_MAN_TILT_TAU": 0.1},
    "rate_unit": {
        "MC_ROLLRATE_I": 0.4,
        "MC_ROLLRATE_K": 1.2,
        "MC_YAWRATE_D": 0.002,
        "MC_BAT_SCALE_EN": 1,
    },
}


def parameters_of(module):
    return "\n".join(f"{name} = {value}" for name, value in PARAMETERS[module].items())


def in_mode(time_s, wanted):
    return [mode for begin, mode in FLIGHT if begin <= time_s][-1] == wanted


def attitude_case():
    setpoints_s = [0.02 * i for i in range(200) if in_mode(0.02 * i, "position")]
    return f"""{head("attitude_unit", 250, parameters_of("attitude_unit"))}
[vehicle_attitude]
q = {{ roll_deg = {signal(20, 0.8)}, pitch_deg = {signal(15, 0.6)}, \
yaw_deg = {{ signal = "ramp", from = 0, to = 720, end_s = 4 }} }}
"delta_q_reset[0]" = 0.8
"delta_q_reset[3]" = 0.6
quat_reset_counter = {samples([0, 1.01], [0, 1])}
timestamp_sample = -0.0005

[vehicle_attitude_setpoint]
q_d = {{ roll_deg = {signal(15, 0.5, 90)}, pitch_deg = {signal(12, 0.4)}, \
yaw_deg = {{ signal = "ramp", from = 40, to = 600, end_s = 4 }}, sign = -1 }}
yaw_sp_move_rate = 0.3
timestamp = -0.0001
publish_at_s = {setpoints_s}
{mode_table(MODE_FLAGS)}
{sticks()}
[vehicle_land_detected]
landed = {samples([0, 0.2], [1, 0])}
publish_at_s = [0, 0.2]

[hover_thrust_estimate]
hover_thrust = 0.45
valid = 1
rate_hz = 10
"""


def rate_case(attitude_rows):
    setpoints = [row for row in attitude_rows if row["out/vehicle_rates_setpoint.published"] == "1"]
    times_s = [(int(row["timestamp"]) - 5000000) * 1e-6 + 0.0009 for row in setpoints]
    fields = ["roll", "pitch", "yaw"] + [f"thrust_body[{i}]" for i in range(3)]
    values = "\n".join(
        f'"{field}" = '
        + samples(times_s, [float(row[f"out/vehicle_rates_setpoint.{field}"]) for row in setpoints])
        for field in fields
    )
    gyro = "\n".join(
        f'"xyz[{i}]" = {signal(0.6 + 0.2 * i, 1.3 + i, 30 * i)}\n'
        f'"xyz_derivative[{i}]" = {signal(8 + 4 * i, 1.3 + i, 90 + 30 * i)}'
        for i in range(3)
    )
    return f"""{head("rate_unit", 1000, parameters_of("rate_unit"))}
[vehicle_angular_velocity]
{gyro}
timestamp_sample = -0.0003

[vehicle_rates_setpoint]
{values}
publish_at_s = {times_s}
{mode_table(["manual", "attitude"])}
{sticks()}
[vehicle_land_detected]
landed = {samples([0, 0.2], [1, 0])}
publish_at_s = [0, 0.2]

[control_allocator_status]
"unallocated_torque[0]" = {signal(0.1, 1)}
torque_setpoint_achieved = {samples([0, 0.5, 1.5], [1, 0, 1])}
rate_hz = 100

[battery_status]
scale = 1.03
rate_hz = 5
"""


def recorded(case, rate_hz, options, folder):
    """The rows of the trace of a case."""
    profile = options.profile
    path = folder / "suite" / "cases" / profile / "attitude" / f"flight_{rate_hz}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(case.replace("PROFILE", profile), encoding="utf-8")
    out = folder / f"{rate_hz}.csv"
    record = [os.environ["ATTEST"], "record", str(path), options.port, "--rate", str(rate_hz)]
    subprocess.run([*record, "--out", str(out)], check=True, stdout=subprocess.DEVNULL)
    lines = [line for line in out.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    return list(csv.DictReader(lines))


# When a module publishes, in us after the step of the unit (negative: before it).
BEFORE_STEP = -100
AFTER_STEP = {
    "vehicle_attitude_setpoint": 100,
    "vehicle_rates_setpoint": 150,
    "vehicle_torque_setpoint": 60,
    "vehicle_thrust_setpoint": 60,
    "rate_ctrl_status": 70,
}
STEP_TOPICS = {"vehicle_attitude", "vehicle_angular_velocity"}


def add_rows(rows, log):
    """Adds the samples of a unit's trace to log[time, topic]."""
    columns = [column for column in rows[0] if "." in column and not column.startswith("plant/")]
    for row in rows:
        for column in columns:
            prefix, name = column.split("/")
            topic, field = name.split(".", 1)
            if topic not in FIELDS or field in ("published", "timestamp"):
                continue
            if prefix == "in" and topic == "vehicle_rates_setpoint":
                continue  # an output of the attitude unit
            flag = f"in/updated.{topic}" if prefix == "in" else f"out/{topic}.published"
            if topic not in STEP_TOPICS and row[flag] != "1":
                continue
            after = 0 if topic in STEP_TOPICS else AFTER_STEP[topic] if prefix == "out" else None
            time = int(row["timestamp"]) + (BEFORE_STEP if after is None else after)
            sample = log.setdefault((time, topic), {})
            sample[field] = row[column]
            if topic in ("vehicle_torque_setpoint", "vehicle_thrust_setpoint"):
                sample["timestamp_sample"] = row["in/vehicle_angular_velocity.timestamp_sample"]
            if topic == "vehicle_attitude":
                sample["quat_reset_counter"] = str(
                    (int(row["in/vehicle_attitude.quat_reset_counter"]) + 7) % 256
                )
            if topic == "vehicle_status":
                armed = row.get("in/vehicle_status.armed", "1")
                wing = row["in/vehicle_status.is_rotary_wing"]
                sample.update(arming_state="2" if armed == "1" else "1", vehicle_type=wing)


def number(code, text):
    if code == "f":
        return float(text)
    return int(text)


def packed(topic, sample):
    out = b""
    for field in FIELDS[topic].split(";"):
        code, name = field.split(" ")
        count, code = (int(code[:-1] or 1), code[-1])
        names = [f"{name}[{i}]" for i in range(count)] if count > 1 else [name]
        out += b"".join(struct.pack("<" + code, number(code, sample.get(n, "0"))) for n in names)
    return out


def definition(topic):
    text = f"{topic}:uint64_t timestamp;"
    for field in FIELDS[topic].split(";"):
        code, name = field.split(" ")
        count = f"[{code[:-1]}]" if len(code) > 1 else ""
        text += f"{TYPES[code[-1]]}{count} {name};"
    return text + "uint8_t[2] _padding0;"


def message(kind, body):
    return struct.pack("<Hc", len(body), kind.encode()) + body


def key_value(kind, key, value):
    return message(kind, struct.pack("<B", len(key)) + key.encode() + value)


def header(options):
    yield b"ULog\x01\x12\x35" + struct.pack("<BQ", 1, 4000000) + message("B", bytes(40))
    yield key_value("I", "char[3] sys_name", b"PX4")
    if options.release != "0":
        major, minor, patch = map(int, [*options.release.split("."), 0][:3])
        release = struct.pack("<I", major << 24 | minor << 16 | patch << 8 | 0xFF)
        yield key_value("I", "uint32_t ver_sw_release", release)
    if options.rate_max:
        yield key_value("P", "int32_t IMU_GYRO_RATEMAX", struct.pack("<i", options.rate_max))
    for parameters in PARAMETERS.values():
        for name, value in parameters.items():
            code = "i" if name.endswith("_EN") else "f"
            yield key_value("P", f"{TYPES[code]} {name}", struct.pack("<" + code, value))


def pairs(texts):
    return {topic: int(count) for topic, count in (text.split("=") for text in texts)}


def kept(log, options):
    """The samples that the logger wrote: at its start the last one of each topic, then all."""
    thin, lose, seen = pairs(options.thin), pairs(options.lose), {}
    start = 5000000 + options.begin * 1000000 + BEFORE_STEP
    last = {topic: time for time, topic in sorted(log) if time < start}
    for time, topic in sorted(log):
        seen[topic] = seen.get(topic, -1) + 1
        if topic in options.without or (time < start and time != last[topic]):
            continue
        if topic in STEP_TOPICS and time < start:
            continue
        if topic in thin and seen[topic] % thin[topic] != 0:
            continue
        if topic in lose and seen[topic] % lose[topic] == lose[topic] - 1:
            continue
        yield time, topic


def write(log, options):
    parts = list(header(options))
    topics = [topic for topic in FIELDS if topic not in options.without]
    parts += [message("F", definition(topic).encode()) for topic in topics]
    for number_of_topic, topic in enumerate(topics):
        parts.append(message("A", struct.pack("<BH", 0, number_of_topic) + topic.encode()))
    for time, topic in kept(log, options):
        head_of_data = struct.pack("<HQ", topics.index(topic), time)
        parts.append(message("D", head_of_data + packed(topic, log[time, topic])))
    pathlib.Path(options.out).write_bytes(b"".join(parts))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("out")
    parser.add_argument("--thin", action="append", default=[])
    parser.add_argument("--lose", action="append", default=[])
    parser.add_argument("--without", action="append", default=[])
    parser.add_argument("--profile", default="px4-v1.16.0")
    parser.add_argument("--release", default="")
    parser.add_argument("--from", dest="begin", type=float, default=0)
    parser.add_argument("--rate-max", type=int, default=1000)
    parser.add_argument("--port", default="builtin")
    options = parser.parse_args()
    options.release = options.release or options.profile.removeprefix("px4-v")
    log = {}
    with tempfile.TemporaryDirectory() as folder:
        attitude = recorded(attitude_case(), 250, options, pathlib.Path(folder))
        add_rows(attitude, log)
        add_rows(recorded(rate_case(attitude), 1000, options, pathlib.Path(folder)), log)
    write(log, options)


if __name__ == "__main__":
    main()
