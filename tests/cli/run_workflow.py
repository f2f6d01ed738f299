#!/usr/bin/env python3
"""Runs the commands of attest in a workflow of `attest sweep --plan`, as GitHub or GitLab would:
`run_workflow.py FILE`. Exits 1 if the file lacks a part that the service needs."""

import os
import re
import subprocess
import sys

import yaml


def run(script: str, **environment: str) -> None:
    subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", script],
        check=True,
        env={**os.environ, **environment},
    )


def evaluated(script: str, values: dict[str, object]) -> str:
    """With the values of the expressions `${{ ... }}`: names, or texts in quotes."""

    def value_of(match: re.Match) -> str:
        expression = match[1].strip()
        return expression[1:-1] if expression[0] == "'" else str(values[expression])

    return re.sub(r"\$\{\{((?:[^'}]|'[^']*')*)\}\}", value_of, script)


def step(job: dict, key: str, value: str) -> dict:
    """The only one with that value, of which `uses` has a version."""
    found = [one for one in job["steps"] if one.get(key, "").split("@")[0] == value]
    assert len(found) == 1, f"{len(found)} steps with {key}: {value}"
    return found[0]


def run_github(workflow: dict) -> None:
    shard, merge = workflow["jobs"]["shard"], workflow["jobs"]["merge"]
    assert workflow[True] == "workflow_dispatch"  # the key `on` is true in YAML 1.1
    assert merge["needs"] == "shard"
    for job in (shard, merge):
        step(job, "uses", "actions/checkout")
        assert "$PACKAGE" in step(job, "name", "Install attest")["run"]
    assert step(shard, "uses", "actions/upload-artifact")["with"]["path"] == "shards/"
    download = step(merge, "uses", "actions/download-artifact")["with"]
    assert download == {"pattern": "shard-*", "path": "shards", "merge-multiple": True}
    for index in shard["strategy"]["matrix"]["shard"]:
        run(evaluated(step(shard, "name", "Fly")["run"], {"matrix.shard": index}))
    run(evaluated(step(merge, "name", "Merge")["run"], {}))


def run_gitlab(pipeline: dict) -> None:
    shard, merge = pipeline["sweep-shard"], pipeline["sweep-merge"]
    assert merge["needs"] == ["sweep-shard"] and shard["artifacts"]["paths"] == ["shards/"]
    count = shard["parallel"]
    for index in range(1, count + 1):
        for line in shard["script"]:
            run(line, CI_NODE_INDEX=str(index), CI_NODE_TOTAL=str(count))
    for line in merge["script"]:
        run(line)


def main(file: str) -> None:
    with open(file, encoding="utf-8") as text:
        workflow = yaml.safe_load(text)
    (run_github if "jobs" in workflow else run_gitlab)(workflow)


if __name__ == "__main__":
    main(sys.argv[1])
