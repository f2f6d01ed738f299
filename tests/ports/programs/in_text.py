#!/usr/bin/env python3
"""The starter in Python with text frames. `in_text.py MODE` answers one step wrongly. Two modes are
right: `fgetl` writes its handshake first, and reads as Octave does; `counts` counts the cost of its
steps."""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "controller/starters/python"))
sys.dont_write_bytecode = True

import port  # noqa: E402  (the path had to be set first)
from controller import Controller  # noqa: E402

TOPICS = (
    "vehicle_attitude_setpoint vehicle_rates_setpoint manual_control_setpoint vehicle_control_mode "
    "actuator_armed vehicle_status multirotor_motor_limits battery_status parameter_update"
).split()
MODES = "manual auto rates attitude rattitude velocity".split()
OUTPUTS = (
    ["vehicle_rates_setpoint." + name for name in ("roll", "pitch", "yaw", "thrust", "published")]
    + [f"actuator_controls_0.control[{i}]" for i in range(8)]
    + ["actuator_controls_0.published"]
    + ["mc_att_ctrl_status." + axis + "_rate_integ" for axis in ("roll", "pitch", "yaw")]
    + ["mc_att_ctrl_status.published"]
)


def inputs_of(request):
    def signals(topic, names):
        return tuple(float(request[f"in/{topic}.{name}"]) for name in names)

    def flags(topic, names):
        return tuple(int(request[f"in/{topic}.{name}"]) for name in names)

    setpoint = "vehicle_attitude_setpoint"
    q = [f"q[{i}]" for i in range(4)]
    return port.Inputs(
        request["timestamp"],
        sum(int(request["in/updated." + topic]) << i for i, topic in enumerate(TOPICS)),
        signals("control_state", q),
        signals("control_state", ("roll_rate", "pitch_rate", "yaw_rate")),
        (
            signals(setpoint, [f"q_d[{i}]" for i in range(4)]),
            *signals(setpoint, ("thrust", "yaw_sp_move_rate", "landing_gear")),
            *flags(setpoint, ("disable_mc_yaw_control",)),
        ),
        signals("vehicle_rates_setpoint", ("roll", "pitch", "yaw", "thrust")),
        signals("manual_control_setpoint", ("x", "y", "z", "r")),
        *signals("battery_status", ("scale",)),
        flags("vehicle_control_mode", [f"flag_control_{mode}_enabled" for mode in MODES]),
        *flags("actuator_armed", ("armed",)),
        *flags("vehicle_status", ("is_rotary_wing", "is_vtol")),
        flags("multirotor_motor_limits", ("lower_limit", "upper_limit", "yaw")),
    )


def in_json(value):
    if value != value:
        return "nan"
    value = port.as_binary32(value)
    return {float("inf"): "inf", -float("inf"): "-inf"}.get(value, value)


def outputs_of(outputs):
    groups = (group if hasattr(group, "__len__") else [group] for group in outputs)
    values = [in_json(one) for group in groups for one in group]
    return {"out/" + name: value for name, value in zip(OUTPUTS, values)}


WRONG = {
    "no_object": lambda answer: [1],
    "no_sequence": lambda answer: {k: v for k, v in answer.items() if k != "sequence"},
    "stale": lambda answer: answer | {"sequence": answer["sequence"] - 1},
    "other_result": lambda answer: answer | {"result": "fine"},
    "unknown_output": lambda answer: answer | {"out/roll": 1},
    "text_for_number": lambda answer: answer | {"out/vehicle_rates_setpoint.roll": "0.1"},
    "no_cost": lambda answer: {k: v for k, v in answer.items() if k != "cost"},
    "no_stack": lambda answer: {k: v for k, v in answer.items() if k != "stack"},
    "negative_cost": lambda answer: answer | {"cost": -1},
    "large_cost": lambda answer: answer | {"cost": 2**32},
    "half_a_byte": lambda answer: answer | {"stack": 0.5},
    "undeclared_cost": lambda answer: answer | {"cost": 1, "stack": 0},
    "half_a_flag": lambda answer: answer | {"out/vehicle_rates_setpoint.published": 0.5},
}


COUNTING = ("counts", "no_cost", "no_stack", "negative_cost", "large_cost", "half_a_byte")


def answer(request, units, counts):
    unit, result = request["unit"], "ok"
    reply = {"sequence": request["sequence"]}
    if request["do"] == "create":
        units[unit] = Controller(request["profile"])
    elif request["do"] == "destroy":
        del units[unit]
    elif request["do"] == "set_parameter":
        known = units[unit].set_parameter(request["name"], float(request["value"]))
        result = "ok" if known else "invalid"
    else:
        reply |= outputs_of(units[unit].step(inputs_of(request)))
        if counts:
            reply |= {"cost": 1000 + request["timestamp"] // 4000 % 7, "stack": 256}
    return reply | {"result": result}


def lines_of_fgetl():
    """Lines of stdin. Each is returned only when the byte after its line feed has arrived."""
    line = b""
    while byte := sys.stdin.buffer.read(1):
        if line.endswith(b"\n"):
            yield line
            line = b""
        line += byte


def main():
    mode = sys.argv[1] if len(sys.argv) > 1 else "right"
    hello = {"protocol": 1, "name": "in text", "version": "1", "frames": "text"}
    hello |= {"profiles": ["px4-v1.5.5"]} | ({"byte_after_line": True} if mode == "fgetl" else {})
    counts = mode in COUNTING
    hello |= {"cost": {"unit": "instructions"}} if counts else {}
    lines = lines_of_fgetl() if mode == "fgetl" else sys.stdin
    if mode == "fgetl":
        print(json.dumps(hello), flush=True)
    next(lines)
    if mode != "fgetl":
        print(json.dumps(hello), flush=True)
    units, steps = {}, 0
    for line in lines:
        request = json.loads(line)
        reply = answer(request, units, counts)
        steps += request["do"] == "step"
        if mode in WRONG and steps == 20 and request["do"] == "step":
            reply = WRONG[mode](reply)
        text = json.dumps(reply)
        if mode == "repeats" and steps == 20:
            text = text[:-1] + ', "out/vehicle_rates_setpoint.roll": 0.5}'
        print(text, flush=True)


if __name__ == "__main__":
    main()
