#!/usr/bin/env python3
"""Checks that the suite notices a variable that the instances of a port share.

    check.py --attest PATH [--only MODULE:FIELD]...

Each port is a C starter in which one field of an instance is moved to file scope, or a variable of
a step is static. Every one must fail in a case with several instances; the starters themselves must
pass. Prints a table. Exits 1 if one
is judged wrong, 2 if one cannot be made.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple

CONTROLLER = pathlib.Path(__file__).resolve().parents[3] / "controller"
# The groups are named, too, so that attest reads no case of the others.
CASES = ["--group", "instances,tailsitter", "--filter", "*/instances/*"]
CASES += ["--filter", "*/tailsitter/two_*"]


class Module(NamedTuple):
    """`fields` are C declarators. Left out are fields that each step sets before it uses them, and
    `started` of the units of the cascade: the first tick of a case has parameter_update. `scratch`
    are declarations inside of functions: such a variable is wrong only if two threads step at the
    same time."""

    starter: str
    files: str  # that use an instance of it, as a regular expression
    instance: str  # the expression before a field
    declared_before: tuple[str, str]  # file and line of the starter
    fields: list[str]
    scratch: list[str]


MODULES = {
    "controller": Module(
        "c",
        r".*",
        "c->",
        ("law.h", "/* attitude.c: sets"),
        [
            *("parameters parameters", "gains gains", "uint32_t pending"),
            *("bool started", "bool have_vehicle_status", "bool on_virtual_topics"),
            *("bool tailsitter", "float rates_prev[3]", "float rates_int[3]"),
        ],
        ["float err[3];", "float u[3];"],
    ),
    # Fields of `copy`: the topics of the controller.
    "controller_topic": Module(
        "c",
        r".*",
        "c->copy.",
        ("law.h", "/* attitude.c: sets"),
        [
            *("uint64_t timestamp", "vehicle_attitude_setpoint", "vehicle_rates_setpoint"),
            *("manual_control_setpoint", "battery_status", "vehicle_control_mode"),
            *("actuator_armed", "vehicle_status", "multirotor_motor_limits"),
        ],
        [],
    ),
    "attitude_unit": Module(
        "c_cascade",
        r"attitude.*|sticks.*",
        "u->",
        ("attitude.h", "/* The heading of q"),
        [
            *("attitude_parameters parameters", "uint64_t last"),
            *("attitude_setpoint sample", "bool sample_pending", "float roll", "float pitch"),
            *("float yaw", "float throttle", "bool attitude_controlled", "bool sticks_enabled"),
            *("bool rotary_wing", "bool vtol", "bool in_transition", "bool tailsitter"),
            *("bool spooled_up", "bool landed", "bool heading_good", "float unaided_heading"),
            *("float hover_estimate", "attitude_law law", "float thrust[3]"),
            *("uint64_t setpoint_time", "uint8_t reset_counter", "float stick_tilt_max"),
            *("float stick_yaw_max", "stick_state sticks"),
        ],
        ["float rates[3];", "attitude_setpoint sp = {0};"],
    ),
    "rate_unit": Module(
        "c_cascade",
        r"rate_unit.c",
        "u->",
        ("rate_unit.c", "/* ---- parameters -"),
        [
            *("parameters parameters", "gains gains", "uint64_t last"),
            *("uint32_t pending", "rates_setpoint sample", "bool armed", "bool manual"),
            *("bool attitude_controlled", "bool rates_controlled", "bool rotary_wing"),
            *("bool on_ground", "bool saturated_up[3]", "bool saturated_down[3]"),
            *("float battery_scale", "rates_setpoint setpoint", "float integral[3]"),
            *("lowpass yaw_torque",),
        ],
        ["float torque[3], thrust[3];"],
    ),
}


def share(module: Module, declarator: str, folder: pathlib.Path) -> None:
    """Moves the field out of the instance: one variable, of all files. Not one that a header uses:
    Builder relies on that."""
    name = re.search(r"(\w+)(\[\d+\])?$", declarator)[1]
    if " " not in declarator:  # a topic; its type has no name
        declarator = f"__typeof__(((attest_inputs*)0)->{name}) {name}"
    variable = re.sub(rf"\b{name}(\[\d+\])?$", rf"shared_{name}\1", declarator)
    file, line = module.declared_before
    for path in folder.glob("*.[ch]"):
        if not re.fullmatch(module.files, path.name):
            continue
        text = path.read_text()
        text = re.sub(rf"(?<!\w){re.escape(module.instance)}{name}\b", f"shared_{name}", text)
        if path.suffix == ".h" and f"shared_{name}" in text:
            sys.exit(f"{path.name} uses {name}")
        text = re.sub(rf"(?<!define )\bLATCH\({name},", f"LATCH_SHARED({name},", text)
        if path.name == file:
            before, after = text.split(line, 1)
            macro = "#define LATCH_SHARED(topic, bit) \\\n"
            macro += "  if (take(c, ATTEST_UPDATED_##bit)) shared_##topic = in->topic\n"
            text = f"{before}{macro}__attribute__((weak)) {variable};\n{line}{after}"
        path.write_text(text)


def make_static(module: Module, declaration: str, folder: pathlib.Path) -> None:
    found = 0
    for path in folder.glob("*.c"):
        if re.fullmatch(module.files, path.name):
            text = path.read_text()
            found += text.count(f"\n  {declaration}")
            # A static variable keeps its value, so it is not initialised in each step.
            text = text.replace(f"\n  {declaration}", f"\n  static {declaration}")
            path.write_text(text)
    if found != 1:
        sys.exit(f"{module.starter}: `{declaration}` is there {found} times")


class Builder:
    """Compiles the starters with a shared variable, each in the same folder."""

    def __init__(self, folder: pathlib.Path):
        self._folder = folder
        # Text of a source file -> its object file. Most sources do not use the shared variable. The
        # headers only declare it, which does not change the code of these sources.
        self._objects: dict[str, pathlib.Path] = {}

    def build(self, module: Module, declarator: str | None) -> pathlib.Path:
        for old in self._folder.glob("*.[ch]"):
            old.unlink()
        for source in (CONTROLLER / "starters" / module.starter).glob("*.[ch]"):
            shutil.copy(source, self._folder)
        if declarator in module.scratch:
            make_static(module, declarator, self._folder)
        elif declarator:
            share(module, declarator, self._folder)
        library = self._folder / "port.so"
        objects = [self._object(path) for path in sorted(self._folder.glob("*.c"))]
        self._cc("-shared", "-o", library, *objects, "-lm")
        return library

    def _object(self, source: pathlib.Path) -> pathlib.Path:
        text = source.read_text()
        if text not in self._objects:
            made = self._folder / f"{len(self._objects)}.o"
            self._cc("-c", "-o", made, source)
            self._objects[text] = made
        return self._objects[text]

    def _cc(self, *arguments: str | pathlib.Path) -> None:
        # Not optimised: each library steps few ticks, and is compiled for longer than it runs.
        command = ["cc", "-std=gnu11", "-O0", "-ffp-contract=off", "-fPIC"]
        command += ["-fvisibility=hidden", f"-I{CONTROLLER}", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, arguments))}:\n{done.stderr}")


def passes(attest: pathlib.Path, library: pathlib.Path) -> bool:
    command = [attest, "-q", "run", "--port", f"lib:{library}", "--no-diagnose", "-j1"]
    command += ["--fail-fast", *CASES]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"attest run exited with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.returncode == 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--attest", type=pathlib.Path, default=shutil.which("attest"))
    parser.add_argument("--only", action="append", default=[], metavar="MODULE:FIELD")
    args = parser.parse_args()
    wrong = 0
    print("| module | shared | judged |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        builder = Builder(pathlib.Path(folder))
        for name, module in MODULES.items():
            for declarator in [None, *module.fields, *module.scratch]:
                if args.only and f"{name}:{declarator}" not in args.only:
                    continue
                good = passes(args.attest, builder.build(module, declarator))
                is_wrong = good != (declarator is None)
                wrong += is_wrong
                remark = ("passes" if good else "fails") + (": WRONG" if is_wrong else "")
                print(f"| {name} | {declarator or 'nothing'} | {remark} |", flush=True)
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
