#!/usr/bin/env python3
"""How far right ports that compute in other ways are from a failure.

    headroom.py ATTEST FOLDER [--group GROUP]... [--rate HZ,...] [--profile PROFILE]

Runs each right port in FOLDER through the suite at the numeric level and prints a Markdown table:
the number of vectors that failed, and the tightest headroom (tolerance / difference) of each kind
of output. Exits 1 if a right port failed, or if a headroom is not above 3.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

LEAST = 3.0

# name of the library, what is different in it
RIGHT = [
    ("reference_gcc_O0", "gcc -O0"),
    ("reference_clang_O3", "clang -O3"),
    ("reference_fma_gcc", "gcc -O3 -march=native, contracted"),
    ("reference_fma_clang", "clang -O3 -march=native, contracted"),
    ("reference_unsafe_math", "gcc -funsafe-math-optimizations"),
    ("reference_double", "double precision"),
    ("right_quaternion", "tilt and torsion from the error quaternion"),
    ("right_polynomial_atan2", "a polynomial atan2, right to 2e-7"),
    ("right_eigen_products", "Eigen's own products"),
    ("right_cpp_style", "modern C++, written anew"),
    ("right_simulink_style", "as generated from a model, other orders of sums"),
    ("right_fixed_point", "fixed point, 32 bits behind the point"),
    ("right_fixed_22", "fixed point, 22 bits, judged as one"),
]


KINDS = ("rates", "controls", "integrals", "motors and battery")


def kind_of(channel):
    if "vehicle_rates_setpoint" in channel or "vehicle_attitude_setpoint" in channel:
        return "rates"
    if "actuator_outputs" in channel or "battery_status" in channel:
        return "motors and battery"
    return "integrals" if "ctrl_status" in channel else "controls"


def tightest(results):
    """The smallest ratio of each kind, with the id of its result."""
    least = {}
    for result in results:
        headroom = result.get("tightest")
        if not headroom or headroom["ratio"] == "inf":
            continue
        kind = kind_of(headroom["channel"])
        if kind not in least or headroom["ratio"] < least[kind][0]:
            least[kind] = (headroom["ratio"], result["id"].split("/", 1)[1])
    return least


def run(attest, library, selection):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        command = [attest, "-q", "run", "--port", f"lib:{library}", "--json", report, *selection]
        subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
        return json.loads(report.read_text())["results"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("attest")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--group", action="append", default=[])
    parser.add_argument("--rate")
    parser.add_argument("--profile")
    args = parser.parse_args()
    selection = [word for group in args.group for word in ("--group", group)]
    selection += ["--rate", args.rate] if args.rate else []
    selection += ["--profile", args.profile] if args.profile else []
    good = True
    print(f"| right port | passed | accused | {' | '.join(KINDS)} |")
    print("|---|---|---|---|---|---|---|")
    for name, what in RIGHT:
        results = run(args.attest, args.folder / f"{name}.so", selection)
        counted = [r for r in results if r["verdict"] not in ("skip", "unsupported")]
        accused = [r for r in counted if r["verdict"] != "pass"]
        least = tightest(counted)
        cells = [
            f"{least[kind][0]:.0f}x in {least[kind][1]}" if kind in least else "same bits"
            for kind in KINDS
        ]
        print(f"| {what} | {len(counted) - len(accused)} | {len(accused)} | {' | '.join(cells)} |")
        for result in accused[:5]:
            print(f"accused: {what}: {result['id']}: {result['verdict']}", file=sys.stderr)
        good = good and not accused and all(ratio > LEAST for ratio, _ in least.values())
    sys.exit(0 if good else 1)


main()
