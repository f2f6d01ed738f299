#!/usr/bin/env python3
"""The same error has the same exit code in every command. docs/verdicts.md has the table.

    exit_codes.py --attest BINARY            checks the codes, and that the table has all of them
    exit_codes.py --attest BINARY --list     prints the codes of all commands
"""

import argparse
import concurrent.futures
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
TRACE = str(SOURCE / "golden/recorded/px4-v1.5.5/fuzz_50hz.csv")

TASKS = """[task.unit]
rate_hz = 250
execution_us = 76
priority = 2
"""
SWEEP = """schema = 1
case = "px4-v1.5.5/flight/hover"
vehicle = "iris"
rate = 250
design = "latin_hypercube"
samples = 8

[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "uniform"
low = 0.99
high = 1.01

[require.levels]
max = 1
probability = 0.5
"""

# The arguments with which each command succeeds in few seconds, the option that names its port, and
# one that names a file to write.
VECTOR = ["--filter", "px4-v1.5.5/attitude/tilt_by_azimuth@250hz"]
FLIGHT = "px4-v1.5.5/flight/hover"
COMMANDS = {
    "run": (["run", *VECTOR, "--no-diagnose"], "--port", "--json"),
    "hunt": (["hunt", "--steps", "2000"], "--port", "--json"),
    "sim": (["sim", FLIGHT, "--rate", "250"], "--port", "--out"),
    "stress": (["stress", "--rates", "250", "--duration", "0.1"], "--port", "--json"),
    "sweep": (["sweep", "sweep.toml", "--out", "OUT"], "--port", "--html"),
    "sweep-rate": (
        ["sweep-rate", "--rates", "250", "--vehicle", "iris", "--plant", "mujoco"],
        "--port",
        "--csv",
    ),
    "schedule": (["schedule", "tasks.toml"], "--port", "--record-timing"),
    "time": (["time", *VECTOR, "--repeat", "1", "--no-stack"], "--port", "--json"),
    "replay": (["replay", TRACE], "--port", "--json"),
    "record": (["record", "px4-v1.5.5/tpa/each_axis", "--rate", "250"], "--port", "--out"),
    "smoke": (["smoke"], "--port", None),
    "doctor": (["doctor"], "--port", None),
    "compare": (["compare", TRACE, TRACE], None, None),
    "plot": (["plot", TRACE], None, "--html"),
    "merge": (["merge", "report.json", "--no-diagnose"], None, "--json"),
    "list": (["list", "--group", "tpa"], None, None),
    "vectors": (["vectors", "OUT", *VECTOR], None, None),
    "new-port": (["new-port", "OUT", "--lang", "c"], None, None),
}
# Commands that judge the law.
JUDGES = ("run", "hunt", "sim", "replay", "stress")
INPUTS = {"sweep": "sweep.toml", "schedule": "tasks.toml", "merge": "report.json"}


def with_port(port: str):
    return lambda arguments, option, _: [*arguments, option, port] if option else None


def with_input(arguments: list, _, __):
    """The arguments with another name in the place of the file or case that the command reads."""
    named = {TRACE, FLIGHT, "px4-v1.5.5/tpa/each_axis", *INPUTS.values(), VECTOR[1], "tpa"}
    changed = ["none.csv" if argument in named else argument for argument in arguments]
    return changed if changed != arguments else None


ERRORS = {
    "an unknown option": (2, lambda arguments, _, __: [*arguments, "--bogus"]),
    "an input file, case or group that does not exist": (2, with_input),
    "a suite that does not exist": (
        2,
        lambda arguments, _, __: ["--suite", "none", *arguments],
    ),
    "a file that cannot be written": (
        2,
        lambda arguments, _, out: [*arguments, out, "/proc/none/file"] if out else None,
    ),
    "a library that does not exist": (2, with_port("lib:./none.so")),
    "a library that cannot be loaded": (2, with_port("lib:./tasks.toml")),
    "a program that does not exist": (2, with_port("proc:./none")),
    "a program that ends before its first answer": (2, with_port("proc:false")),
    "a fault that does not exist": (2, with_port("fault:none")),
}


class Machine:
    def __init__(self, attest: str, folder: pathlib.Path):
        self.attest = attest
        self.folder = folder
        self.number = 0

    def start(self, arguments: list, **options) -> subprocess.Popen:
        self.number += 1
        words = [f"out-{self.number}" if word == "OUT" else word for word in arguments]
        return subprocess.Popen(
            [self.attest, *words],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            **{"stdout": subprocess.DEVNULL, **options},
        )

    def code(self, arguments: list, **options) -> tuple[int, str]:
        process = self.start(arguments, **options)
        errors = process.communicate(timeout=120)[1]
        return process.returncode, errors

    def interrupted(self, arguments: list, port: str) -> tuple[int, str]:
        """The code after SIGINT, while the port does not answer."""
        process = self.start([*arguments, port, "proc:sleep 60"])
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
        # A shell reports the end by a signal as 128 and the number of the signal.
        ended = process.returncode
        return ended if ended >= 0 else 128 - ended, errors


def tasks_of(machine: Machine):
    """(command, error, expected code, function that gives the code)."""
    for command, (arguments, port, out) in COMMANDS.items():
        if command not in ("stress", "doctor"):  # a busy machine fails one, the other is slow
            yield command, "success", 0, lambda a=arguments: machine.code(a)
        for error, (code, change) in ERRORS.items():
            changed = change(arguments, port, out)
            if changed is not None:
                yield command, error, code, lambda a=changed: machine.code(a)
        if port:
            yield command, "Ctrl-C", 130, lambda a=arguments, p=port: machine.interrupted(a, p)
        if command in JUDGES:
            wrong = [*arguments, port, "fault:quat-order-xyzw"]
            yield command, "a port that deviates", 1, lambda a=wrong: machine.code(a)
        full = open("/dev/full", "w", encoding="ascii")  # pylint: disable=consider-using-with
        yield (
            command,
            "stdout that cannot be written",
            2,
            lambda a=arguments, f=full: machine.code(a, stdout=f),
        )


def documented() -> dict[str, int]:
    """The rows of the table of errors in docs/verdicts.md."""
    text = (SOURCE / "docs/verdicts.md").read_text(encoding="utf-8")
    table = text.split("| error | code |")[1].split("\n\n")[0]
    return {what: int(code) for what, code in re.findall(r"^\| (.+?) \| (\d+) \|$", table, re.M)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--attest", required=True)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    attest = str(pathlib.Path(options.attest).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "tasks.toml").write_text(TASKS, encoding="ascii")
        (folder / "sweep.toml").write_text(SWEEP, encoding="ascii")
        machine = Machine(attest, folder)
        machine.code(["run", *VECTOR, "--json", "report.json"])
        tasks = list(tasks_of(machine))
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            codes = list(pool.map(lambda task: task[3](), tasks))
    rows: dict[str, int] = {}
    wrong = []
    for (command, error, expected, _), (code, errors) in zip(tasks, codes):
        rows[error] = expected
        if options.list:
            print(f"{command:12}{error:50}{code}")
        if code != expected:
            wrong.append(f"{command}, {error}: {code}, not {expected}\n{errors}")
    if documented() != {what: code for what, code in rows.items() if what != "success"}:
        wrong.append(f"docs/verdicts.md has {documented()}, and the commands have {rows}")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
