#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Maps of simulated logs are scored against their truth: every kind, as a table, as JSON and as a page."""

import html.parser
import json
import pathlib
import shutil
import tempfile

from program import ROOT, SystemTest, main, run

KEYS = {
    "prediction": {"doors", "doorways", "stairs", "nodes", "free_space", "room_iou", "calibration", "worst"},
    "hindsight": {"bets", "rooms", "free_space", "room_iou", "calibration"},
    "noise": {"cells", "free_floor", "noise_share", "walls", "walls_kept", "points"},
    "labels": {"why", "voxels", "unlabeled", "stray", "accuracy", "miou", "iou", "confusion"},
    "planes": {"truth", "mapped", "threshold", "correct", "over_segmented", "under_segmented", "missed", "noise",
               "correct_share", "angle_deg", "offset_m", "curve"},
    "objects": {"truth", "mapped", "found", "recall", "precision", "recall_50", "precision_50", "class_accuracy", "centre_m",
                "iou", "by_class"},
    "humans": {"frames", "seen", "matches", "false_positives", "false_negatives", "identity_switches", "recall", "precision",
               "mota", "motp_m", "position_m", "heading_deg", "joint_m", "least_pixels", "range_m"},
}


class Balanced(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.seen = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.seen.add(tag)
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag


class Scores(SystemTest):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="prodomos_")
        cls.addClassCleanup(cls.made.cleanup)
        folder = pathlib.Path(cls.made.name)
        cls.log, cls.truth, cls.map = folder / "home.rawlog", folder / "home.truth.json", folder / "home.prodomos"
        for command in (("simulate", ROOT / "configs/sample_home.scene.yaml", "--seed", 3, "--frames", 60, "--quiet", "-o", cls.log),
                        ("replay", cls.log, "-o", cls.map, "--quiet")):
            done = run(*command)
            assert done.returncode == 0, done.stderr

    def ask(self, *arguments):
        done = run("evaluate", *arguments, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def test_every_kind_has_its_keys_and_a_table(self):
        for kind, keys in KEYS.items():
            with self.subTest(kind):
                report = self.ask(kind, self.map)
                self.assertEqual(set(report), keys | {"buildings"})
                self.assertEqual(len(report["buildings"]), 1)
                self.assertEqual(set(report["buildings"][0]), (keys - {"worst"}) | {"building", "map"})
                printed = run("evaluate", kind, self.map)
                self.assertEqual((printed.returncode, printed.stderr), (0, ""))
                self.assertGreater(len(printed.stdout.splitlines()), 3)

    def test_what_cannot_be_measured_is_null(self):
        labels = self.ask("labels", self.map)  # the log has no label images
        self.assertIsNone(labels["accuracy"])
        self.assertIsNone(labels["miou"])
        self.assertIn("no layer", labels["why"])
        self.assertIsNone(self.ask("planes", self.map)["angle_deg"])
        self.assertIsNone(self.ask("humans", self.map, "--range", "0.001")["mota"])

    def test_hindsight_needs_no_truth(self):
        alone = self.folder / "alone.prodomos"
        shutil.copy(self.map, alone)
        report = self.ask("hindsight", alone)
        self.assertEqual(report["bets"]["made"], sum(report["bets"][state] for state in
                                                     ("open", "confirmed", "merged", "refuted")))
        both = self.ask("hindsight", self.map, alone)
        self.assertEqual(both["bets"]["made"], 2 * report["bets"]["made"])
        self.assertEqual(both["rooms"]["entered"], 2 * report["rooms"]["entered"])
        self.check_refused(run("evaluate", "hindsight", alone, "--truth", self.truth), "--truth", codes=(2,))

    def test_the_grid_has_the_walls_that_it_saw(self):
        noise = self.ask("noise", self.map)
        self.assertGreater(noise["free_floor"], 500)
        self.assertGreater(noise["walls"], 50)
        self.assertGreater(noise["walls_kept"], 0.6)  # the robot ends on stairs, from where it sees over walls

    def test_several_maps_are_added_up(self):
        one = self.ask("humans", self.map)
        both = self.ask("humans", self.map, self.map, "--truth", self.truth, "--truth", self.truth)
        self.assertEqual(both["seen"], 2 * one["seen"])
        self.assertEqual(both["frames"], 2 * one["frames"])
        self.assertEqual(both["mota"], one["mota"])
        self.assertEqual(len(both["buildings"]), 2)

    def test_pages_stand_alone(self):
        for kind in KEYS:
            with self.subTest(kind):
                path = self.folder / f"{kind}.html"
                done = run("evaluate", kind, self.map, "--html", path)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                text = path.read_text()
                page = Balanced(text)
                self.assertEqual(page.open, [])
                self.assertLessEqual({"table", "svg", "figure"}, page.seen)
                self.assertNotIn("http", text)

    def test_faults_are_named(self):
        missing = self.folder / "none.truth.json"
        self.check_refused(run("evaluate", "noise", self.map, "--truth", missing), missing, codes=(1,))
        self.check_refused(run("evaluate", "noise", self.map, "--truth", self.truth, "--truth", self.truth), "--truth",
                           codes=(2,))
        bad = self.folder / "bad.truth.json"
        bad.write_text("{}")
        self.check_refused(run("evaluate", "planes", self.map, "--truth", bad), bad, codes=(1,))
        self.check_refused(run("evaluate", "humans", self.map, "--range", "-1"), "--range", codes=(2,))
        nowhere = self.folder / "nowhere" / "page.html"
        self.check_refused(run("evaluate", "humans", self.map, "--html", nowhere), nowhere, codes=(1,))

    def test_the_truth_of_another_log_is_refused(self):
        other = self.folder / "other.truth.json"
        shutil.copy(self.truth, other)
        text = json.loads(other.read_text())
        text["trajectory"] = []
        other.write_text(json.dumps(text))
        self.check_refused(run("evaluate", "objects", self.map, "--truth", other), other, "times in common", codes=(1,))


if __name__ == "__main__":
    main()
