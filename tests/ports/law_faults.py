#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Counts the faults of the catalogue that the cases of the two laws alone catch.

    law_faults.py ATTEST [--profile PROFILE ...] [--missed]

A port of a law alone is judged by the groups attitude_law and rate_law only. Of the faults in the
groups about the laws, those that they miss should be in what is around a law: latching, arming,
parameters, published topics. --missed prints them. Exits 1 if a profile has fewer than BOUND.
"""

import argparse
import concurrent.futures
import os
import subprocess
import sys

ABOUT_LAWS = set(
    "attitude large_angle yaw_weight yaw_feed_forward reference_model rate_limit weathervane rates "
    "i_factor saturation integral_limit landed tpa anti_windup".split()
)
PROFILES = "px4-v1.5.5 px4-v1.3.4 px4-v1.14.4 px4-v1.15.4 px4-v1.16.0 px4-v1.17 px4-v1.18".split()
BOUND = 0.75


def faults_of(attest, profile):
    listed = subprocess.run(
        [attest, "faults", "--list", "--profile", profile],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    rows = [line.split()[:2] for line in listed.splitlines() if line.strip()]
    return [fault for fault, group in rows if group in ABOUT_LAWS]


def is_caught(attest, profile, fault):
    command = [attest, "-q", "run", "--port", f"fault:{fault}", "--profile", profile]
    command += ["--group", "attitude_law,rate_law", "--level", "exact", "--no-diagnose", "--jobs=1"]
    status = subprocess.run(
        command + ["--fail-fast"], capture_output=True, check=False
    ).returncode
    if status not in (0, 1):
        sys.exit(f"law_faults: {fault} of {profile}: attest exits with {status}")
    return status == 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("attest")
    parser.add_argument("--profile", action="append", choices=PROFILES)
    parser.add_argument("--missed", action="store_true", help="print the faults that are missed")
    options = parser.parse_args()
    status = 0
    print("| profile | caught by the laws alone | bound |\n|---|---|---|")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for profile in options.profile or PROFILES:
            faults = faults_of(options.attest, profile)
            caught = list(pool.map(lambda one: is_caught(options.attest, profile, one), faults))
            print(f"| {profile} | {sum(caught)} of {len(faults)} | {BOUND:.0%} |", flush=True)
            status |= sum(caught) < BOUND * len(faults)
            if options.missed:
                print("  ".join(fault for fault, found in zip(faults, caught) if not found))
    return status


if __name__ == "__main__":
    sys.exit(main())
