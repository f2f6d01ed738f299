"""Flies step_in_wind.toml with the reference on every vehicle: the baseline for ports.

Prints a table. --write keeps it as robustness.csv."""

import argparse
import csv
import json
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


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--attest", required=True)
    parser.add_argument("--samples", help="replaces the number of the sweep file")
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--write", action="store_true", help="replace robustness.csv")
    parser.add_argument("--out", type=pathlib.Path, help="keep the sweeps here, and continue them")
    arguments = parser.parse_args()
    samples = ["--samples", arguments.samples] if arguments.samples else []
    with tempfile.TemporaryDirectory() as temporary:
        out = arguments.out or pathlib.Path(temporary)
        rows = fly_all(arguments.attest, out, ["--jobs", arguments.jobs, *samples])
    print_table(rows)
    if arguments.write:
        write(rows)


if __name__ == "__main__":
    main()
