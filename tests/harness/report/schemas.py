#!/usr/bin/env python3
"""The baselines of the reports are valid under their schemas, and wrong reports are not.

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
SCHEMA = SOURCE / "harness/report/report.schema.json"

# What each does to a report that is right: one step away from it.
WRONG_JSON = {
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
    "an unknown stage": lambda r: r["results"][3]["first"].update(stage="mixer"),
    "a null for NaN": lambda r: r["results"][3]["first"].update(got=None),
    "another word for NaN": lambda r: r["results"][3]["first"].update(got="NaN"),
    "bits of one value only": lambda r: r["results"][3]["first"].pop("want_bits"),
    "bits in capitals": lambda r: r["results"][3]["first"].update(got_bits="0xBF800000"),
    "a vehicle without a plant": lambda r: r["results"][-1].pop("plant"),
    "an unknown plant": lambda r: r["results"][-1].update(plant="gazebo"),
    "metrics of no flight": lambda r: r["results"][3].update(metrics=r["results"][-1]["metrics"]),
    "an unknown measure": lambda r: r["results"][-1]["metrics"][0].update(measure="grace"),
    "an error without a place": lambda r: r["errors"][0].pop("line"),
}

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
    schema = json.loads(SCHEMA.read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    problems = []
    for path in sorted(BASELINES.glob("report*.json")):
        if complaint := json_complaint(validator, json.loads(path.read_text())):
            problems.append(f"{path.name} is not valid: {complaint}")
    right = json.loads((BASELINES / "report.json").read_text())
    for what, spoil in WRONG_JSON.items():
        wrong = copy.deepcopy(right)
        spoil(wrong)
        if not json_complaint(validator, wrong):
            problems.append(f"report.schema.json lets {what} pass")
    return problems


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
    problems = check_json() + check_xml()
    print("\n".join(problems) or f"{len(WRONG_JSON) + len(WRONG_XML)} wrong reports rejected")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
