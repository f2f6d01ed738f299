# SPDX-License-Identifier: BSD-3-Clause
"""The program that attest starts. Requests and answers are lines of JSON: PROTOCOL.md."""

import json
import math
import os
import sys

from binary32 import Binary32
from law import RateLaw, attitude_law

PROFILES = ["px4-v1.14.4", "px4-v1.15.4", "px4-v1.16.0", "px4-v1.17", "px4-v1.18"]
AXES = ("roll", "pitch", "yaw")


def attitude_step(_, number, vector):
    rates_sp = attitude_law(
        vector("vehicle_attitude.q", 4),
        vector("vehicle_attitude_setpoint.q_d", 4),
        number("vehicle_attitude_setpoint.yaw_sp_move_rate"),
        vector("attitude_gains.p"),
        vector("attitude_gains.rate_max"),
        number("attitude_gains.yaw_weight"),
    )
    return {f"vehicle_rates_setpoint.{axis}": rate for axis, rate in zip(AXES, rates_sp)}


def rate_step(law, number, vector):
    if number("law.reset").value:
        law.reset()
    torque = law.torque(
        {name: vector(f"rate_gains.{name}") for name in ("p", "i", "d", "ff", "integral_max")},
        vector("vehicle_angular_velocity.xyz"),
        vector("vehicle_angular_velocity.xyz_derivative"),
        [number(f"vehicle_rates_setpoint.{axis}") for axis in AXES],
        [flag.value for flag in vector("saturation.positive")],
        [flag.value for flag in vector("saturation.negative")],
        number("law.landed").value,
        number("law.dt"),
    )
    outputs = {f"vehicle_torque_setpoint.xyz[{i}]": torque[i] for i in range(3)}
    for axis, integral in zip(AXES, law.integral):
        outputs[f"rate_ctrl_status.{axis}speed_integ"] = integral
    return outputs


MODULES = {"attitude_law": (object, attitude_step), "rate_law": (RateLaw, rate_step)}
WITHOUT = [("attitude_law", "px4-v1.18")]  # it has a reference model


def answer(request, units):
    """The result and the outputs of a request. `units` has the law and the step of each unit."""
    module, number = request.get("module"), request["unit"]
    if request["do"] == "create":
        if module not in MODULES or (module, request["profile"]) in WITHOUT:
            return "unsupported", {}
        law, step = MODULES[module]
        units[number] = law(), step
    elif request["do"] == "destroy":
        del units[number]
    elif request["do"] == "step":
        law, step = units[number]
        return "ok", step(law, *readers(request))
    return "ok", {}


def readers(request):
    """Functions that read an input by its name in attest_law.h."""

    def number(name):
        return Binary32(float(request[f"in/{name}"]))  # also of the text "nan" or "inf"

    def vector(name, size=3):
        return [number(f"{name}[{i}]") for i in range(size)]

    return number, vector


def as_json(number):
    return number.value if math.isfinite(number.value) else str(number.value)


def main():
    folder = os.path.dirname(os.path.abspath(__file__))
    sys.stdin.readline()  # the handshake of attest
    handshake = {
        "protocol": 1,
        "name": "attest-starter-python-law",
        "version": "1.0",
        "profiles": PROFILES,
        "frames": "text",
        "modules": list(MODULES),
        "files": [os.path.join(folder, file) for file in ("law.py", "binary32.py")],
    }
    print(json.dumps(handshake), flush=True)
    units = {}
    for line in sys.stdin:
        request = json.loads(line)
        result, outputs = answer(request, units)
        reply = {f"out/{name}": as_json(number) for name, number in outputs.items()}
        print(json.dumps({"sequence": request["sequence"], "result": result, **reply}), flush=True)


main()
