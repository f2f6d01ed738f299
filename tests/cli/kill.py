#!/usr/bin/env python3
"""Kills attest at random points, and takes away its disk. Afterwards there is no process, no
temporary file and no partial report, and every golden is complete, old or new.

    kill.py --attest PATH --starter LIBRARY [--points N] [--seed S]

Each point is a command, SIGKILL or SIGINT, and a random time between the start and the end of that
command. A process has the mark of its point in its environment, which it inherits from attest.

SIGKILL has two limits that are no error here. A killed `bless` leaves its lock and unfinished
goldens (`*.new`), which the next `bless` removes. A kill between the two system calls that replace
an old report leaves the new one with another name.
"""

import argparse
import csv
import hashlib
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from typing import Callable, NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MARK = "ATTEST_TEST_KILLED_AT"
FLIGHT = "cases/px4-v1.5.5/flight/hover.toml"
CASE = "cases/px4-v1.5.5/attitude/{}.toml"
CASE_TEXT = """schema = 1
profiles = ["px4-v1.5.5", "px4-v1.3.4"]
group = "attitude"
why = "A level vehicle is asked to {name}."
duration_ticks = 300

[control_state]
{name}_rate = {{ signal = "sine", amplitude = {amplitude}, cycles = 2 }}

[vehicle_attitude_setpoint]
q_d = {{ tilt_deg = {{ signal = "ramp", from = 0, to = 20, end_ticks = 25 }} }}
"""
NAMES = ("roll", "pitch", "yaw")
BLESS = ("bless", "--group", "attitude", "--yes", "--reason", "test")

REPORTS = ("r.html", "r.json", "r.xml", "r.svg")
OLD = b"a report of an earlier run"
OLD_SHA256 = hashlib.sha256(OLD).hexdigest()

# A port with two processes of its own, which do not end by themselves. The second is in a session
# of its own, and its parent has ended.
PORT_WITH_HELPERS = """import subprocess, sys
for command in (["sleep", "1000"], ["setsid", "--fork", "sleep", "1000"]):
    subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
sys.path.insert(0, {folder!r})
import port
port.main()
"""

# For all that ends by itself or is killed, on a busy machine with sanitizers.
PATIENCE_S = 60


class Wrong(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Wrong(what)


def files_of(folder):
    """Relative path -> SHA-256 of each file, "folder" of each folder."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        found[name] = hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
    return found


def goldens_in(suite):
    """(path, profile) -> SHA-256 of the golden of each profile in each golden file of a suite."""
    found = {}
    for path in (suite / "golden").rglob("*.csv*"):
        header, *rows = [line.partition(",") for line in path.open(encoding="utf-8")]
        if header[0] != "profiles":
            continue  # a recording
        texts, profiles = {}, []
        for cell, _, rest in rows:
            profiles = cell.split() or profiles
            for profile in profiles:
                texts[profile] = texts.get(profile, header[2]) + rest
        for profile, text in texts.items():
            name = path.relative_to(suite).as_posix()
            found[name, profile] = hashlib.sha256(text.encode()).hexdigest()
    return found


def marked(mark):
    """The command lines of the processes with that mark in their environment."""
    wanted, found = f"{MARK}={mark}".encode(), []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if wanted in (process / "environ").read_bytes().split(b"\0"):
                found.append((process / "cmdline").read_bytes().replace(b"\0", b" ").decode())
        except OSError:  # it has ended, or is another user's
            continue
    return found


def require_no_process(mark):
    deadline = time.monotonic() + PATIENCE_S
    while left := marked(mark):
        require(time.monotonic() < deadline, f"these processes are left: {left}")
        time.sleep(0.02)


def write_cases(suite, amplitude):
    for name in NAMES:
        path = suite / CASE.format(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(CASE_TEXT.format(name=name, amplitude=amplitude), encoding="utf-8")


class Place:
    """A folder with a copy of the suite, and empty folders for temporary files and for output."""

    def __init__(self, template, folder):
        self.folder, self.suite = folder, folder / "suite"
        self.temporary, self.out = folder / "temporary", folder / "out"
        shutil.copytree(template, self.suite)
        self.temporary.mkdir()
        self.out.mkdir()
        self.had_reports = False

    def write_old_reports(self):
        self.had_reports = True
        for name in REPORTS:
            (self.out / name).write_bytes(OLD)


class Command(NamedTuple):
    name: str
    arguments: Callable[[Place], list[str]]
    prepare: Callable[[Place], None] = lambda place: None
    is_bless: bool = False


def reports(place):
    out = place.out
    return [
        "--json", f"{out}/r.json", "--junit", f"{out}/r.xml", "--badge", f"{out}/r.svg",
        "--html", f"{out}/r.html", "--group", "attitude",
    ]  # fmt: skip


def traces(place):
    return ["--save-traces", f"{place.out}/traces"]


def proc_port(place):
    script = place.folder.parent / "port.py"  # in a report
    starter = str(ROOT / "controller/starters/python")
    script.write_text(PORT_WITH_HELPERS.format(folder=starter), encoding="utf-8")
    return f"proc:{sys.executable} -B {script}"


def commands(starter):
    library = f"lib:{starter}"
    return [
        Command("run lib", lambda p: ["run", "--port", library, *reports(p), *traces(p)]),
        Command("run proc", lambda p: ["run", "--port", proc_port(p), *reports(p), *traces(p)]),
        # Without --save-traces, the page has a temporary folder.
        Command("run fault", lambda p: ["run", "--port", "fault:quat-order-xyzw", *reports(p)]),
        Command(
            "bless",
            lambda p: list(BLESS),
            lambda p: write_cases(p.suite, 0.4),
            is_bless=True,
        ),
        Command(
            "sim",
            lambda p: ["sim", "hover", "--rate=250", "--port", library, "--out", f"{p.out}/f.csv"],
        ),
        Command("vectors", lambda p: ["vectors", f"{p.out}/inputs", "--group", "attitude"]),
    ]


class Tester:
    def __init__(self, attest, folder):
        self.attest, self.folder, self.count = attest, folder, 0
        self.template = folder / "template"
        self.template.mkdir()
        shutil.copytree(ROOT / "golden/recorded", self.template / "golden/recorded")
        shutil.copytree(ROOT / "models", self.template / "models")
        (self.template / FLIGHT).parent.mkdir(parents=True)
        shutil.copy(ROOT / FLIGHT, self.template / FLIGHT)
        write_cases(self.template, 0.3)
        place = Place(self.template, self.new_folder())
        require(self.run(place, BLESS)[0] == 0, "the suite can be blessed")
        shutil.rmtree(self.template)
        place.suite.rename(self.template)

    def new_folder(self):
        self.count += 1
        folder = self.folder / f"p{self.count}"
        folder.mkdir()
        return folder

    def start(self, place, arguments, **options):
        environment = os.environ | {
            MARK: place.folder.name + self.folder.name,
            "TMPDIR": str(place.temporary),
            "SOURCE_DATE_EPOCH": "1774915200",
        }
        return subprocess.Popen(
            [self.attest, "--suite", place.suite, *arguments],
            env=environment, cwd=place.folder, start_new_session=True, text=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options,
        )  # fmt: skip

    def run(self, place, arguments, **options):
        process = self.start(place, arguments, **options)
        output, _ = process.communicate(timeout=10 * PATIENCE_S)
        require_no_process(place.folder.name + self.folder.name)
        return process.returncode, output


class Undisturbed(NamedTuple):
    """What a command leaves when it is not killed."""

    duration_s: float
    suite: dict[str, str]
    out: dict[str, str]
    goldens: dict[tuple[str, str], str]


def undisturbed(tester, command):
    place = Place(tester.template, tester.new_folder())
    command.prepare(place)
    begin = time.monotonic()
    code, output = tester.run(place, command.arguments(place))
    duration = time.monotonic() - begin
    require(code in (0, 1), f"{command.name} ends with {code}: {output}")
    require(files_of(place.temporary) == {}, f"{command.name} leaves temporary files")
    suite = place.suite
    left = Undisturbed(duration, files_of(suite), files_of(place.out), goldens_in(suite))
    shutil.rmtree(place.folder)
    return left


def check_goldens(tester, place, whole):
    """Each golden that the provenance of its profile names is there: in the file at its place, or
    in the new one next to it."""
    old, now = goldens_in(tester.template), goldens_in(place.suite)
    require(len(old) == 2 * len(NAMES), "each case has a golden of each profile")
    for (name, profile), old_golden in old.items():
        provenance = f"golden/{profile}/provenance.toml"
        old_hash = files_of(tester.template)[provenance]
        now_hash = files_of(place.suite)[provenance]
        is_new = now_hash == whole.suite[provenance]
        require(is_new or now_hash == old_hash, f"{provenance} is neither old nor new")
        expected = whole.goldens[name, profile] if is_new else old_golden
        found = (now.get((name, profile)), now.get((name + ".new", profile)))
        require(expected in found, f"{name} has not the golden that {provenance} names")


def check_partial(path):
    if path.suffix == ".json":
        json.loads(path.read_text(encoding="utf-8"))
    elif path.suffix in (".xml", ".svg"):
        ElementTree.parse(path)
    elif path.suffix == ".html":
        require(path.read_text(encoding="utf-8").endswith("</html>\n"), f"{path.name} is cut off")
    elif path.suffix == ".csv":
        with path.open(encoding="utf-8", newline="") as lines:
            widths = {len(row) for row in csv.reader(lines)}
        require(len(widths) == 1, f"{path.name} has rows of different lengths: {widths}")


def check_out(place, whole, output, is_killed):
    """Reports are the old ones, or absent if there were no old ones, or complete."""
    for name, content in files_of(place.out).items():
        # A file that replaces another one has a name of its own until it is renamed.
        if is_killed and re.fullmatch(r"(.*/)?\.(r|provenance)\.\w+\.\w{6}", name):
            continue
        require(name in whole.out, f"{name} is left")
        is_old = place.had_reports and name in REPORTS and content == OLD_SHA256
        if content == "folder" or is_old:
            continue
        check_partial(place.out / name)
        # Durations are in the JUnit report, and the path of the suite in the page.
        # After an interrupt, the reports may have only the vectors that were run, or all of them
        # without the probable mistake. A note says so.
        notes = ("the reports do not have the probable mistake", "the vectors that were run")
        is_noted = name in REPORTS and any(note in output for note in notes)
        same = content == whole.out[name] or is_noted or name.endswith((".xml", ".html"))
        require(same, f"{name} differs from that of a run that is not killed")


def check_left(tester, place, command, before, whole, output, is_killed):
    """After the end of attest. `is_killed`: by SIGKILL."""
    require_no_process(place.folder.name + tester.folder.name)
    temporary = files_of(place.temporary)
    require(temporary == {}, f"temporary files: {temporary}")
    after = files_of(place.suite)
    if not command.is_bless:
        require(after == before, "the suite has changed")
        check_out(place, whole, output, is_killed)
        return
    if not is_killed:
        unfinished = [name for name in after if ".new" in name or name.endswith(".lock")]
        require(not unfinished, f"unfinished goldens are left: {unfinished}")
    check_goldens(tester, place, whole)


def check_bless_again(tester, place, whole):
    code, output = tester.run(place, BLESS)
    require(code == 0, f"bless after a killed one ends with {code}: {output}")
    require(files_of(place.suite) == whole.suite, "bless after a killed one leaves other files")


def kill_once(tester, command, whole, chance):
    place = Place(tester.template, tester.new_folder())
    command.prepare(place)
    before = files_of(place.suite)
    if command.name.startswith("run") and chance.random() < 0.5:
        place.write_old_reports()
    number = chance.choice((signal.SIGKILL, signal.SIGINT))
    whole_group = number == signal.SIGINT and chance.random() < 0.5  # as Ctrl-C in a terminal
    delay = chance.uniform(0, 1.05 * whole.duration_s)
    said = f"{command.name}, {number.name}{' to the group' if whole_group else ''} at {delay:.4f} s"
    try:
        process = tester.start(place, command.arguments(place))
        try:
            process.wait(delay)
        except subprocess.TimeoutExpired:
            (os.killpg if whole_group else os.kill)(process.pid, number)
        has_ended = process.poll() is not None
        output, _ = process.communicate(timeout=PATIENCE_S)
        is_killed = process.returncode == -signal.SIGKILL
        check_left(tester, place, command, before, whole, output, is_killed)
        if command.is_bless:
            check_bless_again(tester, place, whole)
    except (Wrong, subprocess.TimeoutExpired, ValueError, ElementTree.ParseError) as wrong:
        print(f"WRONG: {said}: {wrong}\n  see {place.folder}", flush=True)
        return False
    shutil.rmtree(place.folder)
    ending = "had ended" if has_ended and process.returncode >= 0 else f"{process.returncode}"
    print(f"ok: {said}: {ending}", flush=True)
    return True


def limited(size):
    def limit():
        # As a shell's `ulimit -f`; the signal would end the process without a message.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


class Disk(NamedTuple):
    """What is wrong with the disk of an output folder."""

    name: str
    mount: list[str]  # command before the folder; empty: no mount
    limit: int | None = None  # of the size of a file
    error: tuple[str, ...] = ()


DISKS = (
    Disk("files of at most 0 bytes", [], 0, ("File too large",)),
    Disk("files of at most 700 bytes", [], 700, ("File too large",)),
    Disk("full disk", ["mount", "-t", "tmpfs", "-o", "size=4k", "none"], None, ("No space left",)),
    Disk("read-only disk", ["mount", "-t", "tmpfs", "-o", "ro", "none"], None, ("Read-only",)),
)


def mounted(disk, folder, copy):
    """Mounts the disk and returns whether that was possible. The content of the folder is kept in
    `copy`, and is on the disk."""
    if not disk.mount:
        return True
    folder.rename(copy)
    folder.mkdir()
    done = subprocess.run([*disk.mount, folder], capture_output=True, check=False)
    if done.returncode != 0:
        return False
    if "ro" in disk.mount:
        subprocess.run(["mount", "--bind", copy, folder], check=True)
        subprocess.run(["mount", "-o", "remount,bind,ro", folder], check=True)
        return True
    size = sum(path.stat().st_size + 4096 for path in copy.rglob("*"))
    subprocess.run(["mount", "-o", f"remount,size={size + 24_000}", folder], check=True)
    shutil.copytree(copy, folder, dirs_exist_ok=True)
    return True


def unmount(folder):
    while subprocess.run(["umount", folder], capture_output=True, check=False).returncode == 0:
        pass


def fill(folder):
    """Leaves no free block. Returns the file that fills the disk."""
    filler = folder / "filler"
    with filler.open("wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            pass
    return filler


def without_disk(tester, command, whole, disk):
    """True: right; False: wrong; None: cannot be tested here."""
    place = Place(tester.template, tester.new_folder())
    command.prepare(place)
    before = files_of(place.suite)
    folder = place.suite / "golden" if command.is_bless else place.out
    try:
        if not mounted(disk, folder, place.folder / "copy"):
            return None
        filler = fill(folder) if "No space left" in disk.error else None
        options = {} if disk.limit is None else {"preexec_fn": limited(disk.limit)}
        code, output = tester.run(place, command.arguments(place), **options)
        if filler:
            filler.unlink()
        require(code == 2, f"ends with {code}: {output}")
        require(any(text in output for text in disk.error), f"gives another reason: {output}")
        check_left(tester, place, command, before, whole, output, False)
        require(files_of(place.suite) == before, "the suite has changed")
    except (Wrong, ValueError, ElementTree.ParseError) as wrong:
        print(f"WRONG: {command.name}, {disk.name}: {wrong}", flush=True)
        return False
    finally:
        unmount(folder)
    shutil.rmtree(place.folder)
    print(f"ok: {command.name}, {disk.name}", flush=True)
    return True


def enter_namespace():
    """Starts this program again in a mount namespace, so that its mounts end with it."""
    if "--in-namespace" in sys.argv:
        return
    flags = "-m" if os.geteuid() == 0 else "-rm"
    possible = subprocess.run(["unshare", flags, "true"], capture_output=True, check=False)
    if possible.returncode == 0:
        program = [sys.executable, *sys.argv, "--in-namespace"]
        os.execvp("unshare", ["unshare", flags, *program])


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--attest", type=pathlib.Path, required=True)
    parser.add_argument("--starter", type=pathlib.Path, required=True, help="a port as a library")
    parser.add_argument("--points", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--in-namespace", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def main():
    enter_namespace()
    args = arguments()
    chance = random.Random(args.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kill"))
    tester = Tester(args.attest.resolve(), folder)
    wrong, skipped = 0, set()
    all_commands = commands(args.starter.resolve())
    wholes = [undisturbed(tester, command) for command in all_commands]
    for i in range(args.points):
        number = i % len(all_commands)
        wrong += not kill_once(tester, all_commands[number], wholes[number], chance)
    for disk in DISKS:
        for command, whole in zip(all_commands, wholes):
            done = without_disk(tester, command, whole, disk)
            wrong += done is False
            skipped |= {disk.name} if done is None else set()
    for name in sorted(skipped):
        print(f"skipped: {name}: no file system can be mounted here")
    print(f"{args.points} points, seed {args.seed}: {wrong} wrong")
    if wrong == 0:
        shutil.rmtree(folder)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
