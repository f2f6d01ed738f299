#!/usr/bin/env python3
"""Runs the commands of attest in a workflow with shards, as GitHub or GitLab would:
`run_workflow.py FILE`. Exits 1 if the file lacks a part that the service needs. `run_workflow.py
--scripts FOLDER FILE` only writes the shell scripts of a file into a new folder, for shellcheck."""

import os
import pathlib
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
    assert workflow[True]  # the key `on` is true in YAML 1.1
    assert merge["needs"] == "shard"
    for job in (shard, merge):
        step(job, "uses", "actions/checkout")
        assert step(job, "name", "Install attest")["run"] == "sh install-attest"
    assert step(shard, "uses", "actions/upload-artifact")["with"]["path"] == "shards/"
    download = step(merge, "uses", "actions/download-artifact")["with"]
    assert download == {"pattern": "shard-*", "path": "shards", "merge-multiple": True}
    for index in shard["strategy"]["matrix"]["shard"]:
        run(evaluated(step(shard, "name", "Run a shard")["run"], {"matrix.shard": index}))
    run(evaluated(step(merge, "name", "Merge")["run"], {}))


def run_gitlab(pipeline: dict) -> None:
    (name,) = (name for name, job in pipeline.items() if "parallel" in job)
    shard = pipeline[name]
    (merge,) = (job for job in pipeline.values() if job.get("needs") == [name])
    assert shard["artifacts"]["paths"] == ["shards/"] and merge["extends"] == shard["extends"]
    first, *others = pipeline[merge["extends"]]["before_script"]
    assert first == "sh install-attest"
    for line in others:
        run(line)
    count = shard["parallel"]
    for index in range(1, count + 1):
        for line in shard["script"]:
            run(line, CI_NODE_INDEX=str(index), CI_NODE_TOTAL=str(count))
    for line in merge["script"]:
        run(line)


def scripts_of(part: object) -> list[str]:
    """GitHub runs the texts of `run`, GitLab the lists `before_script` and `script`."""
    if isinstance(part, list):
        return [script for one in part for script in scripts_of(one)]
    if not isinstance(part, dict):
        return []
    found = [part["run"]] if isinstance(part.get("run"), str) else []
    found += ["\n".join(part[key]) for key in ("before_script", "script") if key in part]
    return found + [script for one in part.values() for script in scripts_of(one)]


def write_scripts(folder: str, workflow: dict) -> None:
    os.mkdir(folder)
    for number, script in enumerate(scripts_of(workflow)):
        text = "#!/bin/sh -e\n" + re.sub(r"\$\{\{.*?\}\}", "VALUE", script) + "\n"
        pathlib.Path(folder, f"{number}.sh").write_text(text, encoding="utf-8")


def main(*arguments: str) -> None:
    with open(arguments[-1], encoding="utf-8") as text:
        workflow = yaml.safe_load(text)
    if arguments[0] == "--scripts":
        write_scripts(arguments[1], workflow)
    else:
        (run_github if "jobs" in workflow else run_gitlab)(workflow)


if __name__ == "__main__":
    main(*sys.argv[1:])
