#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scores of the program are those that one computes by hand, or with other tools, from the map file."""

import json
import math
import sqlite3
import statistics

from program import SystemTest, dataset, main, run
from tiny_logs import carmen_log, png


def relation_errors(map_file, relations):
    """Metres and degrees, in the plane, from the map's rows."""
    with sqlite3.connect(map_file) as database:
        poses = {round(time / 1000): (x, y, 2 * math.atan2(qz, qw)) for time, x, y, qz, qw in
                 database.execute("SELECT time_ns, x, y, qz, qw FROM trajectory")}
    database.close()
    shifts, turns = [], []
    for line in relations.read_text().splitlines():
        first, second, x, y, _, _, _, yaw = line.split()
        a, b = (poses[int(time.replace(".", ""))] for time in (first, second))
        dx, dy, c, s = b[0] - a[0], b[1] - a[1], math.cos(a[2]), math.sin(a[2])
        shifts.append(math.hypot(c * dx + s * dy - float(x), -s * dx + c * dy - float(y)))
        turns.append(abs(math.degrees(math.remainder(b[2] - a[2] - float(yaw), 2 * math.pi))))
    return shifts, turns


class Evaluate(SystemTest):
    def setUp(self):
        super().setUp()
        self.map = self.folder / "map.prodomos"

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def straight_map(self):
        # Its walls go with the robot, so that wheels alone tell its way.
        self.replay(self.write("straight.log", carmen_log()), self.map, "--poses", "odometry")
        return self.map

    def ask(self, *arguments):
        done = run("evaluate", *arguments, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    # --- relations ---

    def test_relations_have_the_errors_that_were_put_in(self):
        # A metre ahead is right; of the second the truth is 0.2 m longer, of the third it turns by 3°.
        relations = self.write("some.relations", "1000.0 1001.0 1.0 0 0 0 0 0\n"
                                                 "1001.0 1002.0 1.2 0 0 0 0 0\n"
                                                 f"1002.0 1003.0 1.0 0 0 0 0 {math.radians(3)}\n"
                                                 "1002.0 9999.0 1.0 0 0 0 0 0\n")
        score = self.ask("relations", self.straight_map(), "--relations", relations)
        self.assertEqual((score["relations"], score["matched"], score["poses"]), (4, 3, "refined"))
        self.assertAlmostEqual(score["translation_m"]["mean"], 0.2 / 3)
        self.assertAlmostEqual(score["translation_m"]["squared_mean"], 0.04 / 3)
        self.assertAlmostEqual(score["translation_m"]["std"], statistics.pstdev([0, 0, 0.2]))
        self.assertAlmostEqual(score["rotation_deg"]["mean"], 1.0)
        self.assertAlmostEqual(score["rotation_deg"]["squared_mean"], 3.0)
        self.assertEqual(score["worst_translation"][0]["first"], "1001.0")
        self.assertEqual(score["worst_rotation"][0]["second"], "1003.0")
        printed = run("evaluate", "relations", self.map, "--relations", relations)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        for words in ("3 of 4 relations", "0.0667 ± 0.0943 m", "1.000 ± 1.414 °", "1001.0 to 1002.0  0.200 m"):
            self.assertIn(words, printed.stdout)

    def test_relations_of_a_real_log_score_as_computed_from_its_rows(self):
        log, relations = dataset("laser/fr079.rawlog"), dataset("laser/fr079.relations")
        self.replay(log, self.map)
        shifts, turns = relation_errors(self.map, relations)
        score = self.ask("relations", self.map, "--relations", relations)
        self.assertEqual((score["relations"], score["matched"]), (len(shifts), len(shifts)))
        for errors, scored in ((shifts, score["translation_m"]), (turns, score["rotation_deg"])):
            squares = [error * error for error in errors]
            for value, key in ((statistics.fmean(errors), "mean"), (statistics.pstdev(errors), "std"),
                               (statistics.fmean(squares), "squared_mean"), (statistics.pstdev(squares), "squared_std"),
                               (statistics.median(errors), "median"), (max(errors), "max")):
                self.assertAlmostEqual(scored[key] / value, 1.0, places=6, msg=key)

    def test_faults_of_relations_are_named(self):
        good = self.straight_map()
        other = self.write("other.relations", "5.0 6.0 0 0 0 0 0 0\n7.0 8.0 0 0 0 0 0 0\n")
        self.check_refused(run("evaluate", "relations", good, "--relations", other), other, "none of 2", "1000.0",
                           codes=(1,))
        bad = self.write("bad.relations", "1000.0 1001.0 1.0 0 0 0 0 0\n1000.25 1001.0 nan 0 0 0 0 0\n")
        self.check_refused(run("evaluate", "relations", good, "--relations", bad), f"{bad}:2: expected", codes=(1,))
        missing = self.folder / "none.relations"
        self.check_refused(run("evaluate", "relations", good, "--relations", missing), missing, codes=(1,))
        self.check_refused(run("evaluate", "relations", self.folder / "none.prodomos", "--relations", bad), codes=(1,))
        self.check_refused(run("evaluate", "relations", good), "--relations", codes=(2,))
        self.check_refused(run("evaluate", "beauty", good), codes=(2,))
        self.check_refused(run("evaluate", "relations", good, "--relations", bad, "--poses", "best"), codes=(2,))

    # --- trajectory ---

    def tum_map(self):
        """A camera that looks ahead, goes ahead and turns left."""
        for kind, image in (("rgb", png(64, 48, 8, 3, 128)), ("depth", png(64, 48, 16, 1, 10000))):
            for frame in range(30):
                self.write(f"tum/{kind}/{frame}.png", image)
            self.write(f"tum/{kind}.txt", "".join(f"{100 + frame / 10} {kind}/{frame}.png\n" for frame in range(30)))
        poses = []
        for frame in range(30):
            c, s = math.cos(0.025 * frame), math.sin(0.025 * frame)  # of half the angle
            qx, qy, qz, qw = (v / 2 for v in (-c - s, c - s, s - c, c + s))
            poses.append(f"{100 + frame / 10} {0.1 * frame} {0.01 * frame * frame} 1.0 {qx} {qy} {qz} {qw}\n")
        self.truth = self.write("tum/groundtruth.txt", "".join(poses))
        self.write("tum/camera.yaml", "fx: 50\nfy: 50\ncx: 31.5\ncy: 23.5\n")
        self.replay(self.folder / "tum", self.map)
        return self.map

    def test_recorded_poses_have_no_error_against_themselves(self):
        score = self.ask("trajectory", self.tum_map(), "--truth", self.truth)
        self.assertEqual((score["matched"], score["trajectory"], score["truth_frame"]), (30, 30, "camera"))
        self.assertEqual((score["rpe_delta_s"], score["rpe_pairs"]), (1.0, 19))
        for key, tolerance in (("ate_m", 1e-9), ("rpe_m", 1e-9), ("rpe_deg", 1e-5)):
            self.assertLess(score[key]["max"], tolerance, key)
        # Taken for those of the body, the same poses turn about the wrong axis.
        wrong = self.ask("trajectory", self.map, "--truth", self.truth, "--truth-frame", "body")
        self.assertGreater(wrong["rpe_deg"]["mean"], 10.0)

    def test_truth_in_another_frame_is_aligned_and_its_errors_are_seen(self):
        # The same way, drawn along y, and one pose in ten is 0.3 m aside, to both sides in turn.
        lines = [f"{1000.0 + i} {7 + (0.3 if i % 20 == 4 else -0.3 if i % 20 == 14 else 0)} {i} 0 0 0 {math.sqrt(0.5)} "
                 f"{math.sqrt(0.5)}\n" for i in range(60)]
        truth = self.write("truth.txt", "# time x y z qx qy qz qw\n" + "".join(lines))
        score = self.ask("trajectory", self.straight_map(), "--truth", truth)
        self.assertEqual((score["matched"], score["truth_frame"]), (60, "body"))
        self.assertAlmostEqual(score["ate_m"]["rmse"], 0.3 * math.sqrt(0.1), delta=0.002)
        self.assertAlmostEqual(score["ate_m"]["max"], 0.3, delta=0.02)
        self.assertEqual(score["rpe_pairs"], 58)
        self.assertAlmostEqual(score["rpe_m"]["mean"], 12 * 0.3 / 58)
        self.assertAlmostEqual(score["rpe_deg"]["max"], 0.0, delta=1e-5)
        longer = self.ask("trajectory", self.map, "--truth", truth, "--delta", "10")
        self.assertEqual(longer["rpe_pairs"], 49)
        self.assertAlmostEqual(longer["rpe_m"]["max"], 0.6)
        none = self.ask("trajectory", self.map, "--truth", truth, "--delta", "1000")
        self.assertEqual((none["rpe_pairs"], none["rpe_m"], none["rpe_deg"]), (0, None, None))
        for delta in ("1", "1000"):
            printed = run("evaluate", "trajectory", self.map, "--truth", truth, "--delta", delta)
            self.assertEqual((printed.returncode, printed.stderr), (0, ""))
            self.assertIn("60 of 60 have a true pose of the body", printed.stdout)

    def test_faults_of_truth_are_named(self):
        good = self.straight_map()
        other = self.write("other.txt", "5.0 0 0 0 0 0 0 1\n")
        self.check_refused(run("evaluate", "trajectory", good, "--truth", other), other, "none of 1", "1000.0", codes=(1,))
        bad = self.write("bad.txt", "1000.0 0 0 0 0 0 0 1\n1001.25 0 0 0 0 0 0\n")
        self.check_refused(run("evaluate", "trajectory", good, "--truth", bad), f"{bad}:2: expected", codes=(1,))
        self.check_refused(run("evaluate", "trajectory", good, "--truth", other, "--delta", "0"), codes=(2,))
        self.check_refused(run("evaluate", "trajectory", good), "--truth", codes=(2,))


if __name__ == "__main__":
    main()
