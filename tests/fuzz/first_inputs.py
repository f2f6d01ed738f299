#!/usr/bin/env python3
"""Runs a fuzzer once on some of its first inputs.

    first_inputs.py FUZZER TARGET

Exits 1 after a finding, or if the fuzzer has no inputs. ci/fuzz runs all inputs, and changes them.
"""

import pathlib
import subprocess
import sys
import tempfile

MOST_INPUTS = 60  # of each target; 60 cases take 2 s with sanitizers


def main():
    fuzzer, target = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        corpus = pathlib.Path(folder) / "corpus"
        seeds = pathlib.Path(__file__).with_name("seeds.py")
        command = [sys.executable, seeds, target, corpus, pathlib.Path(folder) / "words.dict"]
        subprocess.run(command, check=True)
        inputs = sorted(corpus.iterdir())
        if not inputs:
            sys.exit(f"first_inputs.py: seeds.py writes no input for {target}")
        chosen = inputs[:: -(-len(inputs) // MOST_INPUTS)]
        done = subprocess.run([fuzzer, *chosen], cwd=folder, check=False)
    sys.exit(0 if done.returncode == 0 else 1)


main()
