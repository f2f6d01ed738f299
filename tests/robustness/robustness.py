"""Flies step_in_wind.toml with the reference on every vehicle: the baseline for ports.

Prints a table. --write keeps it as robustness.csv. --check flies the first samples only, and
compares them with robustness.csv."""

import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
SWEEP = HERE / "step_in_wind.toml"
BASELINE = HERE / "robustness.csv"
VEHICLES = sorted(path.stem for path in (HERE.parents[1] / "models").glob("*.toml"))
STATISTICS = ["min", "median", "p95", "p99", "max"]


def sweep(attest, vehicle, folder, *options):
    """Ends with 1 when a requirement is not met, which is a result here."""
    command = [attest, "-q", "sweep", SWEEP, "--vehicle", vehicle, "--out", folder, *options]
    if subprocess.run(command).returncode not in (0, 1):
        sys.exit(f"robustness.py: the sweep of {vehicle} cannot be flown")


def rows_of(report, vehicle):
    """One row for each metric. An infinite number is null in JSON, and empty here."""
    requirements = {one["metric"]: one for one in report["requirements"]}
    for metric in report["metrics"]:
        required = requirements[metric["name"]]
        low, high = required["interval"]
        correlation = metric["rank_correlation"]
        strongest = max(correlation, key=lambda name: abs(correlation[name] or 0))
        yield {
            "vehicle": vehicle,
            "metric": metric["name"],
            "samples": report["samples"],
            "lost": report["samples"] - report["outcomes"].get("done", 0),
            "at_most_s": required["max"],
            "held": required["held"],
            "probability_low": f"{low:.4f}",
            "probability_high": f"{high:.4f}",
            **{name: "" if metric[name] is None else f"{metric[name]:.4g}" for name in STATISTICS},
            "strongest_dispersion": strongest,
            "rank_correlation": f"{correlation[strongest]:+.2f}",
            "attest": report["attest"],
            "sweep_sha256": report["sweep_sha256"],
        }


def fly_all(attest, out, options):
    """A sweep that was interrupted in the folder `out` continues."""
    rows = []
    for vehicle in VEHICLES:
        print(f"robustness.py: {vehicle}", file=sys.stderr)
        sweep(attest, vehicle, out / vehicle, *options)
        rows += rows_of(json.loads((out / vehicle / "report.json").read_text()), vehicle)
    return rows


def print_table(rows):
    print("| vehicle | metric | flights | lost | held | with probability (0.95) | median [s] "
          "| strongest dispersion |")
    print("|---|---|---|---|---|---|---|---|")
    for row in rows:
        print(f"| {row['vehicle']} | {row['metric']} | {row['samples']} | {row['lost']} "
              f"| {row['held']} | {row['probability_low']} to {row['probability_high']} "
              f"| {row['median']} | {row['strongest_dispersion']} ({row['rank_correlation']}) |")


def write(rows):
    text = BASELINE.with_suffix(".csv.new")
    with open(text, "w", newline="") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    text.replace(BASELINE)


def binomial_tail(most, trials, probability):
    """Of at most that many successes."""
    return sum(
        math.comb(trials, k) * probability**k * (1 - probability) ** (trials - k)
        for k in range(most + 1)
    )


def is_likely(held, trials, probability):
    # A right table is refused once in more than 10,000 changes of the suite.
    least = 1e-5
    lost = trials - held
    return min(binomial_tail(held, trials, probability),
               binomial_tail(lost, trials, 1 - probability)) > least  # fmt: skip


def differences(row, folder):
    """Between a row of robustness.csv and the first samples of that sweep."""
    now = json.loads((folder / "identity.json").read_text())["sweep_sha256"]
    if now != row["sweep_sha256"]:
        yield (f"sweep_sha256 is {now}, not {row['sweep_sha256']}: the sweep file, the case or the "
               "vehicle has changed")
        return
    samples = list(csv.DictReader((folder / "samples.csv").open()))
    values = [sample[f"reference.{row['metric']}"] for sample in samples]
    held = sum(bool(value) and float(value) <= float(row["at_most_s"]) for value in values)
    share = int(row["held"]) / int(row["samples"])
    if not is_likely(held, len(values), share):
        yield f"{held} of the first {len(values)} samples hold, {share:.1%} of all in the table"


def check(attest, options):
    table = list(csv.DictReader(BASELINE.open()))
    if sorted({row["vehicle"] for row in table}) != VEHICLES:
        sys.exit(f"{BASELINE}: needs rows for {', '.join(VEHICLES)}; run `ci/quality --sweep`")
    found = []
    with tempfile.TemporaryDirectory() as temporary:
        for vehicle in VEHICLES:
            folder = pathlib.Path(temporary) / vehicle
            sweep(attest, vehicle, folder, "--shard", "1/200", *options)
            for row in (row for row in table if row["vehicle"] == vehicle):
                found += [f"{BASELINE}: {vehicle} {row['metric']}: {difference}"
                          for difference in differences(row, folder)]
    if found:
        sys.exit("\n".join([*found, "run `ci/quality --sweep`, which makes the table anew"]))
    print(f"{len(table)} rows agree with the first samples of their sweeps")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--attest", required=True)
    parser.add_argument("--samples", help="replaces the number of the sweep file")
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--write", action="store_true", help="replace robustness.csv")
    parser.add_argument("--check", action="store_true", help="compare with robustness.csv")
    parser.add_argument("--out", type=pathlib.Path, help="keep the sweeps here, and continue them")
    arguments = parser.parse_args()
    if arguments.check:
        return check(arguments.attest, ["--jobs", arguments.jobs])
    samples = ["--samples", arguments.samples] if arguments.samples else []
    with tempfile.TemporaryDirectory() as temporary:
        out = arguments.out or pathlib.Path(temporary)
        rows = fly_all(arguments.attest, out, ["--jobs", arguments.jobs, *samples])
    print_table(rows)
    if arguments.write:
        write(rows)


if __name__ == "__main__":
    main()
