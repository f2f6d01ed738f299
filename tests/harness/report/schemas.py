#!/usr/bin/env python3
"""Checks that the schemas accept the baselines of the reports and reject wrong reports.

Usage: schemas.py SOURCE_DIR XMLLINT
"""

import copy
import json
import pathlib
import subprocess
import sys

import jsonschema

SOURCE = pathlib.Path(sys.argv[1])
XMLLINT = sys.argv[2]
BASELINES = SOURCE / "tests/baselines"
XSD = SOURCE / "tests/harness/report/junit.xsd"
SCHEMAS = SOURCE / "harness/report"

# Each makes a right report wrong by one change.
WRONG_REPORT = {
    "another schema": lambda r: r.update(schema="attest-report-2"),
    "an unknown member": lambda r: r.update(elapsed_s=1.0),
    "a missing member": lambda r: r.pop("conformant"),
    "a suite without a hash": lambda r: r["suite"].pop("sha256"),
    "a hash that is cut": lambda r: r["suite"].update(sha256="abc"),
    "a date with a time": lambda r: r.update(date="2026-03-31T12:00:00Z"),
    "a claim that does not say what is missing": lambda r: r["claims"][0].pop("missing"),
    "conformant as a word": lambda r: r.update(conformant="true"),
    "an unknown level": lambda r: r.update(level="loose"),
    "a rate as a number": lambda r: r["rates"].append(250),
    "a rate of zero": lambda r: r["rates"].append("0"),
    "a verdict without a total": lambda r: r["totals"].pop("xpass"),
    "a negative total": lambda r: r["totals"].update({"pass": -1}),
    "an unknown verdict": lambda r: r["results"][3].update(verdict="flaky"),
    "a time in a result": lambda r: r["results"][3].update(elapsed_s=0.1),
    "a port without a version": lambda r: r["port"].pop("version"),
    "a channel by index": lambda r: r["results"][3]["first"].update(channel=17),
    "an unknown stage": lambda r: r["results"][3]["first"].update(stage="mixer law"),
    "a null for NaN": lambda r: r["results"][3]["first"].update(got=None),
    "another word for NaN": lambda r: r["results"][3]["first"].update(got="NaN"),
    "bits of one value only": lambda r: r["results"][3]["first"].pop("want_bits"),
    "bits in capitals": lambda r: r["results"][3]["first"].update(got_bits="0xBF800000"),
    "a vehicle without a plant": lambda r: r["results"][-1].pop("plant"),
    "a plant without a name": lambda r: r["results"][-1].update(plant=""),
    "metrics of no flight": lambda r: r["results"][3].update(metrics=r["results"][-1]["metrics"]),
    "an unknown measure": lambda r: r["results"][-1]["metrics"][0].update(measure="grace"),
    "an error without a place": lambda r: r["errors"][0].pop("line"),
}

WRONG_STRESS = {
    "another schema": lambda r: r.update(schema="attest-stress-2"),
    "an unknown member": lambda r: r.update(misses=1),
    "another word for the whole": lambda r: r.update(verdict="ok"),
    "a run without a verdict": lambda r: r.pop("verdict"),
    "a rate as a number": lambda r: r.update(rates_not_judged=[1000]),
    "an expected failure": lambda r: r["results"][0]["result"].update(verdict="xfail"),
    "a term of its own": lambda r: r["results"][0].update(lateness={}),
    "no response time": lambda r: r["results"][0].pop("response_time"),
    "a time with a fraction": lambda r: r["results"][0].update(wall_ns=1.5),
    "negative misses": lambda r: r["results"][0].update(deadline_misses=-1),
    "p99 of 499 samples": lambda r: r["results"][0]["response_time"].update(p99_ns=1),
    "p99.9 of 499 samples": lambda r: r["results"][0]["execution_time"].update(p99_9_ns=1),
    "no median of 499 samples": lambda r: r["results"][0]["sample_age"].pop("median_ns"),
    "no p99.9 of 20,000 samples": lambda r: r["results"][0]["plant_wake_up_latency"].pop(
        "p99_9_ns"
    ),
    "no histogram": lambda r: r["results"][0]["wake_up_latency"].pop("buckets"),
    "an empty bucket": lambda r: r["results"][0]["wake_up_latency"]["buckets"][0].update(count=0),
    "a bucket without an end": lambda r: r["results"][0]["execution_time"]["buckets"][0].pop(
        "below_ns"
    ),
    "a rhythm by chance": lambda r: r["results"][1]["slow_steps"]["rhythm"].update(
        chance_at_most=0.05
    ),
    "a rhythm of every step": lambda r: r["results"][1]["slow_steps"]["rhythm"].update(
        every_steps=1
    ),
    "a refusal without a reason": lambda r: r["results"][1]["privileges"][1].pop("why"),
}

# (schema, the baselines of its reports, the one that is made wrong, how)
JSON_REPORTS = [
    ("report.schema.json", "report*.json", "report.json", WRONG_REPORT),
    ("stress.schema.json", "stress*.json", "stress.json", WRONG_STRESS),
]

# (what to replace, by what) in a JUnit file that is right; each must occur in it.
WRONG_XML = {
    "skipped on testsuites": ('<testsuites name="attest"', '<testsuites skipped="1" name="attest"'),
    "a suite without errors": (' errors="3"', ""),
    "a negative count": ('failures="4"', 'failures="-4"'),
    "a time with an exponent": ('time="0.012500"', 'time="1.25e-2"'),
    "a testcase without a classname": (' classname="px4-v1.5.5.attitude"', ""),
    "two testcases of one name": ('name="yaw_step@100hz"', 'name="yaw_step@250hz"'),
    "two suites of one name": ('name="px4-v1.5.5.mixed" tests', 'name="px4-v1.5.5.attitude" tests'),
    "a property twice": ('name="port.name"', 'name="port"'),
    "an unknown type": ('type="crash"', 'type="segfault"'),
    "a failure of the type of an error": ('<failure type="fail"', '<failure type="timeout"'),
    "a failure without a message": ('type="xpass" message="', 'type="xpass" massage="'),
    "a second outcome": ("</failure>", '</failure><skipped type="skip" message="m">m</skipped>'),
    "a suite without properties": ("<properties>", "<properties></properties><properties>"),
    "a character that XML lacks": ("killed by", "killed &#27; by"),
    "an element of no reader": ("</testsuite>", "<rerun/></testsuite>"),
}


def xml_complaint(text: str) -> str:
    run = subprocess.run(
        [XMLLINT, "--noout", "--schema", str(XSD), "-"],
        input=text.encode(),
        capture_output=True,
        check=False,
    )
    return run.stderr.decode() if run.returncode else ""


def json_complaint(validator, report) -> str:
    return "\n".join(error.message for error in validator.iter_errors(report))


def check_json() -> list[str]:
    problems = []
    for name, pattern, sample, wrongs in JSON_REPORTS:
        schema = json.loads((SCHEMAS / name).read_text())
        jsonschema.Draft7Validator.check_schema(schema)
        validator = jsonschema.Draft7Validator(schema)
        for path in sorted(BASELINES.glob(pattern)):
            if complaint := json_complaint(validator, json.loads(path.read_text())):
                problems.append(f"{path.name} is not valid: {complaint}")
        right = json.loads((BASELINES / sample).read_text())
        for what, spoil in wrongs.items():
            wrong = copy.deepcopy(right)
            spoil(wrong)
            if not json_complaint(validator, wrong):
                problems.append(f"{name} lets {what} pass")
    return problems


def check_definitions() -> list[str]:
    """Compares the definitions that both schemas contain."""
    one, other = (
        json.loads((SCHEMAS / name).read_text())["definitions"] for name, *_ in JSON_REPORTS
    )
    shared = ("count", "rate", "real", "bits", "channel", "deviation", "headroom")
    return [f"the schemas differ in `{name}`" for name in shared if one[name] != other[name]]


def check_xml() -> list[str]:
    problems = []
    for path in sorted(BASELINES.glob("junit*.xml")):
        if complaint := xml_complaint(path.read_text()):
            problems.append(f"{path.name} is not valid: {complaint}")
    right = (BASELINES / "junit.xml").read_text()
    for what, (old, new) in WRONG_XML.items():
        if old not in right:
            problems.append(f"`{old}` no longer occurs in junit.xml: {what} is not tested")
        elif not xml_complaint(right.replace(old, new, 1)):
            problems.append(f"junit.xsd lets {what} pass")
    return problems


def main() -> int:
    problems = check_json() + check_definitions() + check_xml()
    wrongs = len(WRONG_REPORT) + len(WRONG_STRESS) + len(WRONG_XML)
    print("\n".join(problems) or f"{wrongs} wrong reports rejected")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
