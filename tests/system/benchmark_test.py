#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark runs every step of every building once, goes on where it was stopped, and shows what failed."""

import html.parser
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCHMARK = pathlib.Path(__file__).resolve().parent / "benchmark"

# Stands for the program: writes what is asked for, and down what it was asked.
FAKE = '''#!/usr/bin/env -S python3 -IS
import json, os, pathlib, sys
words = sys.argv[1:]
if words == ["--version"]:
    print("prodomos 9.9.9")
    sys.exit()
with open(os.environ["CALLS"], "a") as calls:
    calls.write(" ".join(words) + "\\n")
after = lambda flag: pathlib.Path(words[words.index(flag) + 1])
if words[0] == "simulate":
    if "broken" in words[1]:
        sys.exit("prodomos: error: " + words[1] + ": expected a door, found <none>")
    after("-o").write_text("log of " + words[1])
    after("-o").with_suffix(".truth.json").write_text("{}")
elif words[0] == "replay":
    after("-o").write_text("map")
else:
    kind, maps = words[1], [word for word in words[2:] if word.endswith(".prodomos")]
    if kind == "labels" and len(maps) == 1 and "two" in maps[0]:
        sys.exit("prodomos: error: the class tables differ")
    if "--html" in words:
        after("--html").write_text("<style>p{}</style><section><h2>x, storey 0</h2><figure><svg></svg></figure></section>")
    one = lambda name: {"recall": 0.25 if "two" in name else 0.75, "count": 3, "position_m": None,
                        "doors": {"recall_visible": 0.5 if "two" in name else 1.0},
                        "angle_deg": {"median": 1.0, "mean": 1.5, "max": 4.0, "rmse": 2.0},
                        "free_space": {"0.5": {"overall": 0.9}}}
    report = one("all")
    report["buildings"] = [{"building": "plan", "map": name, **one(name)} for name in maps]
    if "--json" in words:
        print(json.dumps(report))
'''


class Page(html.parser.HTMLParser):
    """Text of cells, row by row; and that all elements are closed."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.open = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "meta":
            return
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


class Benchmark(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="prodomos_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "prodomos"
        self.program.write_text(FAKE)
        self.program.chmod(0o755)
        self.calls = self.folder / "calls"
        for scene in ("plans/school/one.xml", "plans/office/two.xml", "plans/school/broken.xml",
                      "hospital/hospital_two_floors.world"):
            path = self.folder / "data/buildings" / scene
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(scene)
        self.write_split("school/one.xml", "office/two.xml")
        self.output = self.folder / "out"

    def write_split(self, *plans):
        self.split = self.folder / "split.yaml"
        self.split.write_text("# a list\nversion: 1\ntrain:\n  - school/never.xml\ntest:\n" +
                              "".join(f"  - {plan}\n" for plan in plans))

    def run_benchmark(self, *options):
        self.calls.write_text("")
        done = subprocess.run([sys.executable, BENCHMARK, "--prodomos", self.program, "--datasets", self.folder / "data",
                               "--split", self.split, "-o", self.output, *options], capture_output=True, text=True,
                              env={**os.environ, "CALLS": str(self.calls)}, timeout=120, check=False)
        self.done = done
        return self.calls.read_text().splitlines()

    def report(self):
        return json.loads((self.output / "benchmark.json").read_text())

    def page(self):
        return (self.output / "benchmark.html").read_text()

    def test_runs_the_test_list_and_the_hospital(self):
        self.write_split("school/one.xml")
        calls = self.run_benchmark("--frames", "30", "--seed", "5")
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        simulated = [call for call in calls if call.startswith("simulate")]
        self.assertEqual(len(simulated), 2)
        for call in simulated:
            self.assertIn("--seed 5 --frames 30", call)
            self.assertIn("--labels none", call)
        hospital = next(call for call in simulated if "hospital" in call)
        self.assertIn("--storeys 2", hospital)
        self.assertFalse([call for call in calls if "never" in call])
        report = self.report()
        self.assertEqual(report["version"], "prodomos 9.9.9")
        self.assertEqual(set(report["scores"]), {"prediction", "noise", "labels", "planes", "objects", "humans"})
        self.assertEqual([entry["building"] for entry in report["scores"]["noise"]["buildings"]], ["one", "hospital"])

    def test_does_nothing_twice(self):
        self.write_split("school/one.xml")
        first = self.run_benchmark()
        page = self.page()
        self.assertGreater(len(first), 10)
        self.assertEqual(self.run_benchmark(), [])
        self.assertEqual(self.page(), page)
        # What is lost is made again, and what depends on it.
        (self.output / "one/log.prodomos").unlink()
        again = self.run_benchmark()
        self.assertFalse([call for call in again if call.startswith("simulate")])
        self.assertEqual(len([call for call in again if call.startswith("replay")]), 1)
        # Other options, other logs; another program, everything anew.
        self.assertEqual(len(self.run_benchmark("--frames", "7")), len(first))
        self.program.write_text(FAKE + "# a later version\n")
        self.assertEqual(len(self.run_benchmark("--frames", "7")), len(first))

    def test_goes_on_after_what_fails_and_shows_it(self):
        self.write_split("school/broken.xml", "school/one.xml", "office/two.xml")
        self.run_benchmark()
        self.assertEqual(self.done.returncode, 1)
        self.assertIn("broken: simulate FAILED", self.done.stdout)
        report = self.report()
        faults = report["buildings"]["broken"]["faults"]
        self.assertEqual([fault["step"] for fault in faults], ["simulate"])
        self.assertIn("expected a door, found <none>", faults[0]["reason"])
        self.assertEqual([entry["building"] for entry in report["scores"]["noise"]["buildings"]], ["one", "two", "hospital"])
        self.assertEqual([entry["building"] for entry in report["scores"]["labels"]["buildings"]], ["one", "hospital"])
        page = self.page()
        self.assertIn("What failed", page)
        self.assertIn("expected a door, found &lt;none&gt;", page)

    def test_page_has_tables_pictures_and_the_worst_building(self):
        self.run_benchmark("--only", "one", "--only", "two")
        text = self.page()
        page = Page(text)
        self.assertEqual(page.open, [])
        self.assertIn(["prediction", "doors · recall visible", "1.000", "0.500", "two"], page.rows)
        self.assertIn(["prediction", "free space · 0.5 · overall", "0.900", "0.900", "one"], page.rows)
        self.assertIn(["objects", "recall", "0.750", "0.250", "two"], page.rows)
        self.assertIn(["", "all", "one", "two"], page.rows)
        self.assertIn(["angle, °", "1.000 (mean 1.500, max 4.000)"] + ["1.000 (mean 1.500, max 4.000)"] * 2, page.rows)
        self.assertIn(["position, m", "–", "–", "–"], page.rows)
        self.assertEqual(text.count("<figure>"), 2)
        self.assertIn("<h2>two, storey 0</h2>", text)
        self.assertIn("prodomos replay", text)
        self.assertNotIn("http", text)
        self.assertEqual(self.report()["worst"]["objects.recall"], {"building": "two", "value": 0.25})

    def test_wrong_usage_is_named(self):
        self.run_benchmark("--only", "nowhere")
        self.assertNotEqual(self.done.returncode, 0)
        self.assertIn("expected a part of one of one, two, hospital", self.done.stderr)
        self.split.write_text("train:\n  - a.xml\n")
        self.run_benchmark()
        self.assertIn("expected a list `test`", self.done.stderr)
        self.split = self.folder / "none.yaml"
        self.run_benchmark()
        self.assertEqual(self.done.returncode, 2)
        self.assertIn("none.yaml: no such file", self.done.stderr)


if __name__ == "__main__":
    unittest.main()
