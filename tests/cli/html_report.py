#!/usr/bin/env python3
"""Opens the page of `attest run --html` in a headless Chromium.

    html_report.py --attest BINARY --ports FOLDER     the tests
    html_report.py --open PAGE [--shot PNG] [--width N] [--dark]
                                                      how long the page takes to open; a picture
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from browser import Browser, chromium

SKIPPED = 77
SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
ARGUMENTS = argparse.Namespace()

# The rows of the table, by the names of their columns.
ROWS = """(() => {
  const table = document.getElementById('results');
  const names = [...table.tHead.rows[0].cells].map((cell) => cell.dataset.name);
  return [...table.tBodies[0].rows].map((row) => Object.fromEntries(
    [...row.cells].map((cell, i) => [names[i], cell.textContent.trim()])));
})()"""


class Page(unittest.TestCase):
    """The page of a command: a run with `options`, or that of make_page()."""

    options = ["--port", "fault:tpa-missing", "--group", "tpa", "--rate", "100,250"]

    @classmethod
    def setUpClass(cls):
        folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.page = folder / "page.html"
        cls.make_page(folder)
        cls.browser = cls.enterClassContext(Browser())

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        report = folder / "report.json"
        cls.run_attest("run", *cls.options, "--html", cls.page, "--json", report)
        cls.report = json.loads(report.read_text())

    @staticmethod
    def run_attest(*arguments):
        subprocess.run(
            [ARGUMENTS.attest, "-q", *arguments],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        )

    def setUp(self):
        self.browser.open(self.page.as_uri())

    def tearDown(self):
        self.assertEqual(self.browser.problems, [])
        others = [u for u in self.browser.requests if u != self.page.as_uri()]
        self.assertEqual([u for u in others if not u.startswith("data:")], [])

    def run_in_page(self, script: str):
        return self.browser.run(script)


class HasPlots:
    """A page that has plots when it opens."""

    def test_each_plot_has_the_width_of_its_box(self):
        # The window must not have been resized, because dygraphs then draws again.
        drawn = "[...document.querySelectorAll('.values, .deviation')]"
        self.browser.wait_for(f"{drawn}.filter((box) => box.querySelector('canvas')).length > 1")
        widths = self.run_in_page(
            f"{drawn}.map((box) => [box.clientWidth, box.querySelector('canvas').clientWidth])"
        )
        for box, canvas in widths:
            self.assertEqual(canvas, box, widths)


class FailingPort(HasPlots, Page):
    def test_the_numbers_are_those_of_the_json_report(self):
        rows = self.run_in_page(ROWS)
        self.assertEqual(len(rows), len(self.report["results"]))
        for row, result in zip(rows, self.report["results"]):
            self.assertEqual(f"{row['group']}/{row['name']}@{row['configuration']}", result["id"])
            self.assertEqual(row["verdict"], result["verdict"])
            self.assertEqual(int(row["ticks"]), result["ticks"])
            self.check_headroom(row, result)
            self.check_deviation(row, result)

    def check_headroom(self, row: dict, result: dict):
        tightest = result.get("tightest") if result["verdict"] == "pass" else None
        self.assertEqual(row["headroom"] != "", tightest is not None)
        if tightest and isinstance(tightest["ratio"], float):
            self.assertAlmostEqual(float(row["headroom"]) / tightest["ratio"], 1, places=5)
            self.assertEqual(row["tightest"], tightest["channel"])

    def check_deviation(self, row: dict, result: dict):
        first = result.get("first")
        self.assertEqual(bool(row.get("tick")), first is not None)
        if first is None:
            return
        self.assertEqual(int(row["deviating"]), result["deviating_ticks"])
        self.assertEqual(int(row["tick"]), first["tick"])
        self.assertEqual(int(row["time"]), first["timestamp_us"])
        self.assertEqual(row["signal"].split()[0], first["channel"])
        self.assertEqual(row["stage"], first["stage"])
        worst = result["worst"]
        if (worst["tick"], worst["channel"]) != (first["tick"], first["channel"]):
            self.assertTrue(row["worst"].startswith(f"tick {worst['tick']}, in {worst['channel']}"))
        for name in ("got", "want"):
            value, bits = row[name].split()
            self.assertAlmostEqual(float(value), first[name], places=6)
            self.assertEqual(bits, first[f"{name}_bits"])

    def test_the_case_that_the_report_names_is_open(self):
        named = self.report["diagnosis"]["specific_case"]["case"]
        shown = "document.querySelector('.details h2').textContent"
        self.browser.wait_for(f"{shown}.startsWith('{named}@')")
        self.browser.wait_for("document.querySelector('.details canvas')")

    def test_the_matrix_counts_the_results(self):
        text = self.run_in_page(
            "Object.fromEntries("
            "[...document.querySelectorAll('.matrix tr:last-child td:last-child[data-group]')]"
            ".map((cell) => [cell.dataset.group,"
            " cell.querySelector('button').firstElementChild.nextSibling.data.trim()]))"
        )
        totals = {}
        for result in self.report["results"]:
            passed, compared = totals.setdefault(result["profile"], [0, 0])
            is_compared = result["verdict"] in ("pass", "fail")
            totals[result["profile"]] = [
                passed + (result["verdict"] == "pass"),
                compared + is_compared,
            ]
        expected = {
            profile: str(passed) if passed == compared else f"{passed}/{compared}"
            for profile, (passed, compared) in totals.items()
        }
        self.assertEqual(text, expected)

    def test_profiles_share_the_place_of_a_matrix(self):
        shown = (
            "[...document.querySelectorAll('.matrix')].filter((matrix) => matrix.offsetParent)"
            ".map((matrix) => matrix.caption.textContent.split(':')[0])"
        )
        profiles = list(dict.fromkeys(result["profile"] for result in self.report["results"]))
        self.assertGreater(len(profiles), 1)
        for profile in profiles:
            tabs = "[...document.querySelectorAll('[aria-label=Profile] button')]"
            self.browser.click(f"{tabs}.find((tab) => tab.textContent === '{profile}')")
            names = [name for name in self.run_in_page(shown) if name != "accuracy"]
            self.assertEqual(names, [profile])

    def test_a_click_on_a_failing_cell_shows_its_plot(self):
        cell = "document.querySelector('.matrix td.v-fail[data-rate=\"250hz\"]')"
        group = self.run_in_page(f"{cell}.dataset.group")
        self.browser.click(cell)
        shown = "document.querySelector('.details h2').textContent"
        self.browser.wait_for(f"{shown}.startsWith('{group}/')")
        self.assertTrue(self.run_in_page(shown).endswith("@250hz"))
        self.browser.wait_for("document.querySelector('.details canvas')")
        for curve in ("got", "expected"):
            self.assertGreater(self.pixels_of(curve), 50, curve)
        ids = self.run_in_page("[...document.querySelectorAll('.row')].map((r) => r.title)")
        self.assertTrue(ids)
        self.assertTrue(all(i.startswith(group) and i.endswith("@250hz") for i in ids), ids)

    def pixels_of(self, colour: str) -> int:
        """How many pixels of the first plot have the colour of that name in page.css."""
        return self.run_in_page(
            "(() => { const name = getComputedStyle(document.documentElement)"
            f".getPropertyValue('--{colour}').trim();"
            " const want = [1, 3, 5].map((i) => parseInt(name.slice(i, i + 2), 16));"
            " return Math.max(...[...document.querySelectorAll('.values canvas')].map((c) => {"
            " const copy = new OffscreenCanvas(c.width, c.height)"
            ".getContext('2d', {willReadFrequently: true});"
            " copy.drawImage(c, 0, 0);"
            " const d = copy.getImageData(0, 0, c.width, c.height).data;"
            " let n = 0; for (let i = 0; i < d.length; i += 4)"
            " n += d[i + 3] === 255 && want.every((w, k) => Math.abs(d[i + k] - w) < 3);"
            " return n; })); })()"
        )

    def test_the_list_replaces_the_table(self):
        shown = "getComputedStyle(document.querySelector('#results')).display"
        self.assertEqual(self.run_in_page(shown), "none")

    def test_the_plots_zoom_together(self):
        self.browser.wait_for("document.querySelectorAll('.values canvas').length > 0")
        labels = (
            "[...document.querySelectorAll('.details .dygraph-axis-label-x')]"
            ".map((l) => l.textContent).join()"
        )
        before = self.run_in_page(labels)
        self.browser.click("document.querySelector('.details .tools button')")
        self.assertNotEqual(self.run_in_page(labels), before)

    def test_the_keyboard_searches_and_selects(self):
        self.browser.press("/")
        self.assertEqual(self.run_in_page("document.activeElement.type"), "search")
        for key in "each_axis":
            self.browser.press(key)
        self.browser.press("ArrowDown")
        self.browser.press("ArrowDown")
        selected = "document.querySelector('.row[aria-selected=true]')?.title"
        self.browser.wait_for(f"({selected} ?? '').includes('each_axis')")
        first = self.run_in_page(selected)
        self.browser.press("ArrowUp")
        self.browser.wait_for(f"{selected} !== '{first}'")
        self.browser.press("Enter")
        self.browser.wait_for("document.activeElement.tagName === 'H2'")
        self.assertEqual(
            self.run_in_page("document.activeElement.textContent"), self.run_in_page(selected)
        )

    def test_every_control_has_a_name(self):
        unnamed = self.run_in_page(
            "[...document.querySelectorAll('button, input, select, [role]')]"
            ".filter((e) => e.offsetParent"
            " && !(e.getAttribute('aria-label') || e.textContent.trim())"
            " && e.role !== 'status').map((e) => e.outerHTML)"
        )
        self.assertEqual(unnamed, [])

    def test_the_tables_remain_without_scripts(self):
        self.browser.send("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.browser.open(self.page.as_uri())
            root = self.browser.send("DOM.getDocument")["root"]["nodeId"]
            for selector in (".matrix td.v-fail", "#results td.v-fail", "#results td.v-pass"):
                node = self.browser.send("DOM.querySelector", nodeId=root, selector=selector)
                box = self.browser.send("DOM.getBoxModel", nodeId=node["nodeId"])["model"]
                self.assertGreater(box["width"], 10, selector)
        finally:
            self.browser.send("Emulation.setScriptExecutionDisabled", value=False)


class CrashingPort(Page):
    @classmethod
    def setUpClass(cls):
        cls.options = ["--port", f"lib:{ARGUMENTS.ports}/port_crash.so", "--group", "tpa"]
        super().setUpClass()

    def test_the_call_is_shown_and_no_plot(self):
        details = self.run_in_page("document.querySelector('.details').textContent")
        self.assertIn("in step() at tick 20", details)
        self.assertIn("attest run --port", details)
        self.assertEqual(self.run_in_page("document.querySelectorAll('canvas').length"), 0)


class PassingPort(Page):
    options = ["--port", "builtin", "--group", "tpa"]

    def test_it_is_quiet_about_failures(self):
        self.assertIn("pass", self.run_in_page("document.querySelector('header').textContent"))
        self.assertEqual(self.run_in_page("document.querySelectorAll('.v-fail').length"), 0)
        self.assertEqual(self.run_in_page("document.querySelector('.details').textContent"), "")
        self.assertGreater(self.run_in_page("document.querySelectorAll('.row').length"), 3)


class CascadeFlights(Page):
    """A flight of the cascade has two rates: 250-1000hz."""

    options = ["--port", "builtin", "--filter", "px4-v1.16.0/flight/hover@250-1000hz*"]

    def test_a_click_on_a_cell_shows_its_flights(self):
        self.browser.click("document.querySelector('.matrix td[data-rate=\"250-1000hz\"]')")
        ids = self.run_in_page("[...document.querySelectorAll('.row')].map((r) => r.title)")
        self.assertEqual(len(ids), len(self.report["results"]))
        self.assertTrue(all("@250-1000hz-" in i for i in ids), ids)


class StepTimes(HasPlots, Page):
    """The page of `attest time --html`: axes with logarithms, bars, steps."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        options = ["--filter", "px4-v1.5.5/tpa/*@100hz", "--repeat", "1", "--budget", "1000"]
        cls.run_attest("time", *options, "--html", cls.page)

    def test_an_arrow_key_moves_the_cursor(self):
        self.run_in_page("document.querySelector('.values').focus()")
        self.browser.press("ArrowRight")
        reading = "document.querySelector('.legend-of-plot').textContent"
        self.browser.wait_for(f"{reading}.includes('at ')")
        first = self.run_in_page(reading)
        self.browser.press("ArrowRight")
        self.browser.wait_for(f"{reading} !== '{first}'")

    def test_a_click_on_a_name_hides_the_series(self):
        button = "document.querySelector('.legend-of-plot button')"
        picture = "document.querySelectorAll('.values canvas')[0].toDataURL()"
        before = self.run_in_page(picture)
        self.browser.click(button)
        self.browser.wait_for(f"{button}.getAttribute('aria-pressed') === 'false'")
        self.assertNotEqual(self.run_in_page(picture), before)

    def test_the_tables_remain_without_scripts(self):
        self.browser.send("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.browser.open(self.page.as_uri())
            root = self.browser.send("DOM.getDocument")["root"]["nodeId"]
            node = self.browser.send("DOM.querySelector", nodeId=root, selector=".figures td")
            box = self.browser.send("DOM.getBoxModel", nodeId=node["nodeId"])["model"]
            self.assertGreater(box["width"], 10)
        finally:
            self.browser.send("Emulation.setScriptExecutionDisabled", value=False)


SWEEP = """
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
rate = 250
design = "monte_carlo"
samples = 30
[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "uniform"
low = 0.9
high = 1.1
[require.tilts]
max = 1.2
probability = 0.8
"""


class DispersedSweep(StepTimes):
    """The page of `attest sweep --html`: distributions and dots, in groups of their own."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        sweep = folder / "sweep.toml"
        sweep.write_text(SWEEP)
        options = ["--out", folder / "out", "--keep-worst", "2"]
        cls.run_attest("sweep", sweep, *options, "--html", cls.page)

    def test_the_worst_flights_are_marked(self):
        titles = self.run_in_page("[...document.querySelectorAll('h3')].map((h) => h.textContent)")
        place = next(i for i, title in enumerate(titles) if "tilts over mass" in title)
        legend = f"document.querySelectorAll('.legend-of-plot')[{place}].textContent"
        self.assertIn("worst flights", self.run_in_page(legend))


class ReplayedTrace(HasPlots, Page):
    """The page of `attest replay --html`."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        trace = SOURCE / "golden/recorded/px4-v1.5.5/fuzz_250hz.csv"
        cls.run_attest("replay", trace, "--html", cls.page)


class HuntFindings(HasPlots, Page):
    """The page of `attest hunt --html`: a finding of one tick, and one of 12."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        port = "fault:cascade-d-reversed+cascade-yaw-correction-fast"
        options = ["--module", "rate_law,attitude_unit", "--profile", "v1.16.0", "--steps", "1"]
        options += ["--seed", "3"]  # a seed with which a round finds both
        cls.run_attest("hunt", "--port", port, *options, "--html", cls.page)

    def test_each_finding_links_to_its_values(self):
        links = self.run_in_page("[...document.querySelectorAll('th a')].map((a) => a.hash)")
        self.assertEqual(len(links), 2)
        for link in links:
            caption = self.run_in_page(f"document.querySelector('{link} caption').textContent")
            self.assertEqual(caption, f"{link[1:]}: values")

    def test_a_finding_of_many_ticks_is_plotted_with_its_tolerance(self):
        titles = self.run_in_page(
            "[...document.querySelectorAll('#plots-of-page h2')].map((h) => h.textContent)"
        )
        self.assertEqual(titles, ["cascade_yaw_correction_fast"])
        legend = self.run_in_page("document.querySelector('.legend-of-plot').textContent")
        for word in ("want", "got", "allowed"):
            self.assertIn(word, legend)


class Comparison(HasPlots, Page):
    """The page of `attest compare --html`."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        for port in ("builtin", "fault:tpa-missing"):
            options = ["--rate", "250", "--port", port, "--out", folder / f"{port}.csv"]
            cls.run_attest("record", "px4-v1.5.5/tpa/each_axis", *options)
        files = [folder / "builtin.csv", folder / "fault:tpa-missing.csv"]
        cls.run_attest("compare", *files, "--by-time", "--html", cls.page)


class Signals(HasPlots, Page):
    """The page of `attest plot`."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        trace = SOURCE / "golden/recorded/px4-v1.5.5/fuzz_250hz.csv"
        cls.run_attest("plot", trace, "--html", cls.page)


class RateSweep(HasPlots, Page):
    """The page of `attest sweep-rate --html`."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        options = ["--rates", "100,250", "--vehicle", "iris"]
        cls.run_attest("sweep-rate", *options, "--html", cls.page)


class Flight(HasPlots, Page):
    """The page of `attest sim --html`."""

    @classmethod
    def make_page(cls, folder: pathlib.Path):
        options = ["flip_150_level", "--rate", "250", "--port", "builtin"]
        cls.run_attest("sim", *options, "--html", cls.page)

    def test_the_slider_moves_the_replay_and_the_plots(self):
        picture = "document.querySelector('.replay canvas').toDataURL()"
        reading = "document.querySelector('#plots-of-page .reading').textContent"
        before = [self.run_in_page(picture), self.run_in_page(reading)]
        self.run_in_page(
            "(() => { const s = document.querySelector('input[type=range]'); s.value = 100;"
            " s.dispatchEvent(new Event('input')); })()"
        )
        after = [self.run_in_page(picture), self.run_in_page(reading)]
        self.assertNotEqual(before[0], after[0])
        self.assertNotEqual(before[1], after[1])
        clock = self.run_in_page("document.querySelector('output').textContent")
        self.assertEqual(clock, "0.400 s")

    def test_the_pointer_in_a_plot_moves_the_slider(self):
        self.browser.move("document.querySelector('#plots-of-page .values')")
        self.browser.wait_for("document.querySelector('input[type=range]').value > 100")

    def test_there_is_a_plot_of_each_part(self):
        titles = self.run_in_page("[...document.querySelectorAll('h3')].map((h) => h.textContent)")
        for part in ("Attitude", "Body rates", "Integrals", "Motor", "Saturation"):
            self.assertTrue(any(part in title for title in titles), titles)


def measure(page: str, shot: str | None, width: int, dark: bool) -> None:
    with Browser(width=width) as browser:
        browser.send(
            "Emulation.setEmulatedMedia",
            features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}],
        )
        browser.send("Emulation.setDeviceMetricsOverride", width=width, height=1000,
                     deviceScaleFactor=1, mobile=False)
        browser.open(pathlib.Path(page).absolute().as_uri())
        timing = browser.run(
            "(() => { const t = performance.getEntriesByType('navigation')[0];"
            " return [t.domContentLoadedEventEnd, t.loadEventEnd]; })()"
        )
        browser.run("new Promise((r) => setTimeout(r, 300))")
        rows = browser.run("document.querySelectorAll('.row').length")
        print(f"loaded in {timing[1] / 1000:.2f} s, {rows} rows of the list exist")
        scrolled = browser.run("document.documentElement.scrollWidth")
        print(f"problems: {browser.problems}, width of the page: {scrolled}")
        if shot:
            browser.screenshot(shot)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--attest")
    parser.add_argument("--ports")
    parser.add_argument("--open")
    parser.add_argument("--shot")
    parser.add_argument("--width", type=int, default=1440)
    parser.add_argument("--dark", action="store_true")
    parser.parse_args(namespace=ARGUMENTS)
    if chromium() is None:
        print("skipped: chromium is not installed")
        return SKIPPED
    if ARGUMENTS.open:
        measure(ARGUMENTS.open, ARGUMENTS.shot, ARGUMENTS.width, ARGUMENTS.dark)
        return 0
    program = unittest.main(argv=[sys.argv[0]], exit=False)
    return 0 if program.result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
