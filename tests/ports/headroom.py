#!/usr/bin/env python3
"""How far right ports that compute in other ways are from a failure.

    headroom.py ATTEST FOLDER [--law controller|cascade|laws] [--profile PROFILE] [--group GROUP]...
                [--rate HZ,...] [--only PREFIX]

Runs each right port in FOLDER through the suite at the numeric level. Prints a Markdown table for
the controller of v1.5.5 and v1.3.4, one for each profile of the cascade, and some for the two laws
alone: the number of vectors that failed, and the tightest headroom (tolerance / difference) of each
kind of output. --group does not apply to the two laws. Exits 1 if a right port failed or ran no
vector, if it left out others than it may, or if a headroom is not above 3.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

LEAST = 3.0

# What a right port may leave out. A port without a unit, or without a profile, has not passed.
EXACT_ONLY = "on a threshold of the law"
DECLARED = "the port declares that it does not support"
OPTIONAL_GROUPS = ("mixer", "battery_status")

# The groups of the two laws alone, which have a table of their own.
LAW_GROUPS = ("attitude_law", "rate_law")

# name of the library, what is different in it
REFERENCES = [
    ("reference_gcc_O0", "gcc -O0"),
    ("reference_clang_native", "clang -O3 -march=native"),
    ("reference_fma_gcc", "gcc -O3 -march=native, contracted"),
    ("reference_fma_clang", "clang -O3 -march=native, contracted"),
    ("reference_unsafe_math", "gcc -funsafe-math-optimizations"),
    ("reference_double", "double precision"),
]
CONTROLLERS = REFERENCES + [
    ("right_quaternion", "tilt and torsion from the error quaternion"),
    ("right_polynomial_atan2", "a polynomial atan2, right to 2e-7"),
    ("right_eigen_products", "Eigen's own products"),
    ("right_cpp_style", "modern C++, written anew"),
    ("right_simulink_style", "as generated from a model, other orders of sums"),
    ("right_fixed_point", "fixed point, 32 bits behind the point"),
    ("right_fixed_22", "fixed point, 22 bits, judged as one"),
]
CASCADES = REFERENCES + [
    ("right_cascade_quaternion", "swing and twist of the error quaternion, other orders of sums"),
    ("right_cascade_polynomial", "polynomial sin, cos, asin, acos, exp and atan2, right to 2e-7"),
    ("right_cascade_fixed_point", "fixed point, 32 bits behind the point"),
    ("right_cascade_fixed_22", "fixed point, 22 bits, judged as one"),
]
PURE_LAWS = REFERENCES + [("right_pure_laws", "double precision, written anew")]

# The profiles of each table, its ports, and the kinds of outputs with words of their channels. The
# first kind that fits counts.
LAWS = {
    "controller": {
        "tables": [["px4-v1.5.5", "px4-v1.3.4"]],
        "ports": CONTROLLERS,
        "kinds": {
            "rates": ["vehicle_rates_setpoint"],
            "controls": ["actuator_controls"],
            "integrals": ["mc_att_ctrl_status"],
            "motors and battery": ["actuator_outputs", "battery_status"],
        },
    },
    "cascade": {
        "tables": [
            ["px4-v1.18"],
            ["px4-v1.17"],
            ["px4-v1.16.0"],
            ["px4-v1.15.4"],
            ["px4-v1.14.4"],
        ],
        "ports": CASCADES,
        "kinds": {
            "thrust": ["thrust"],
            "attitude setpoint": ["vehicle_attitude_setpoint"],
            "rates": ["vehicle_rates_setpoint"],
            "torque": ["vehicle_torque_setpoint"],
            "integrals": ["rate_ctrl_status"],
        },
    },
    "laws": {
        "tables": [
            ["px4-v1.18"],
            ["px4-v1.17", "px4-v1.16.0", "px4-v1.15.4", "px4-v1.14.4"],
            ["px4-v1.5.5", "px4-v1.3.4"],
        ],
        "ports": PURE_LAWS,
        "kinds": {
            "rates": ["vehicle_rates_setpoint"],
            "torque": ["vehicle_torque_setpoint"],
            "integrals": ["rate_ctrl_status"],
        },
    },
}


def kind_of(channel, kinds):
    for kind, words in kinds.items():
        if any(word in channel for word in words):
            return kind
    sys.exit(f"headroom.py: no kind of output for {channel}; add it to LAWS")


def tightest(results, kinds):
    """The smallest ratio of each kind, with the id of its result."""
    least = {}
    for result in results:
        headroom = result.get("tightest")
        if not headroom or headroom["ratio"] == "inf":
            continue
        kind = kind_of(headroom["channel"], kinds)
        if kind not in least or headroom["ratio"] < least[kind][0]:
            least[kind] = (headroom["ratio"], result["id"].split("/", 1)[1])
    return least


def run(attest, library, selection):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        # In attest's process: the ports are right, and a process for each vector takes ten times
        # the CPU time.
        command = [attest, "-q", "run", "--in-process", "--no-diagnose", "--port", f"lib:{library}"]
        # A flight of a slow port at 8 kHz takes some seconds, more on a busy machine.
        command += ["--timeout", "60", "--json", report, *selection]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
        if not report.exists():
            sys.exit(f"headroom.py: {library}: attest run ended with {done.returncode}")
        return json.loads(report.read_text())["results"]


def may_be_left_out(result):
    reason = result.get("reason", "")
    return reason.startswith((EXACT_ONLY, DECLARED)) or result["group"] in OPTIONAL_GROUPS


def cell(kind, least):
    if kind not in least:
        return "same bits"
    ratio, where = least[kind]
    return f"{ratio:.1f}x in {where}" if ratio < 10 else f"{ratio:.0f}x in {where}"


def judge(what, results, kinds):
    """Prints the row of a port. Returns whether it passed, with enough headroom."""
    left_out = [r for r in results if r["verdict"] in ("skip", "unsupported")]
    missing = [r for r in left_out if not may_be_left_out(r)]
    counted = [r for r in results if r not in left_out]
    accused = [r for r in counted if r["verdict"] != "pass"]
    least = tightest(counted, kinds)
    cells = " | ".join(cell(kind, least) if counted else "no vector" for kind in kinds)
    print(f"| {what} | {len(counted) - len(accused)} | {len(accused)} | {cells} |", flush=True)
    for result in accused[:5]:
        print(f"accused: {what}: {result['id']}: {result['verdict']}", file=sys.stderr)
    for ratio, where in least.values():
        if ratio <= LEAST:
            print(f"too near: {what}: {where}: {ratio:.2f}x, bound {LEAST:g}x", file=sys.stderr)
    for result in missing[:1]:
        print(
            f"left out: {what}: {len(missing)} vectors, such as {result['id']}: {result['reason']}",
            file=sys.stderr,
        )
    if not counted:
        print(f"no vector: {what}", file=sys.stderr)
    near_enough = all(ratio > LEAST for ratio, _ in least.values())
    return bool(counted) and not missing and not accused and near_enough


def table(args, law, profiles):
    selection = [word for profile in profiles for word in ("--profile", profile)]
    if law is LAWS["laws"]:
        selection += ["--group", ",".join(LAW_GROUPS)]
    elif args.group:
        groups = [group for group in args.group if group not in LAW_GROUPS]
        selection += [word for group in groups for word in ("--group", group)]
    else:
        selection += [word for group in LAW_GROUPS for word in ("--exclude", f"{group}/*")]
    selection += ["--rate", args.rate] if args.rate else []
    kinds = law["kinds"]
    print(f"{' and '.join(profiles)}:\n")
    print(f"| right port | passed | accused | {' | '.join(kinds)} |")
    print("|---|---|---|" + "---|" * len(kinds), flush=True)
    ports = [port for port in law["ports"] if port[0].startswith(args.only)]
    if not ports:
        sys.exit(f"headroom.py: no right port begins with {args.only}")
    good = [
        judge(what, run(args.attest, args.folder / f"{name}.so", selection), kinds)
        for name, what in ports
    ]
    print(flush=True)
    return all(good)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("attest")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--law", choices=LAWS, help="only this law; default: both")
    parser.add_argument("--profile", help="only this profile")
    parser.add_argument("--group", action="append", default=[])
    parser.add_argument("--rate")
    parser.add_argument("--only", default="", help="only ports whose name begins like this")
    args = parser.parse_args()
    good = []
    for name, law in LAWS.items():
        for profiles in law["tables"]:
            selected = [p for p in profiles if args.profile in (None, p)]
            if selected and args.law in (None, name):
                good.append(table(args, law, selected))
    if not good:
        sys.exit("headroom.py: no table of this law has this profile")
    sys.exit(0 if all(good) else 1)


main()
