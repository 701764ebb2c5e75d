#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Poses that are estimated are at least as good as published ones, with one configuration for all logs.

The bounds of relations are those of Graph Mapping in Kümmerle et al. 2009, that of the trajectory is our own.
"""

import json

from program import SystemTest, dataset, main, run


class Localization(SystemTest):
    def evaluate(self, log, kind, *truth, options=()):
        output = self.folder / "map.prodomos"
        self.replay(log, output, *options)
        done = run("evaluate", kind, output, *truth, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def check_relations(self, name, count, most_metres, most_degrees):
        log, relations = dataset(f"laser/{name}.rawlog"), dataset(f"laser/{name}.relations")
        score = self.evaluate(log, "relations", "--relations", relations)
        self.assertEqual((score["matched"], score["poses"]), (count, "refined"))
        metres, degrees = score["translation_m"]["mean"], score["rotation_deg"]["mean"]
        print(f"[{metres:.4f} m, {degrees:.3f}°] ", end="", flush=True)
        self.assertLessEqual(metres, most_metres)
        self.assertLessEqual(degrees, most_degrees)

    def test_of_intel(self):
        self.check_relations("intel", 2984, 0.031, 1.3)

    def test_of_fr079(self):
        self.check_relations("fr079", 1685, 0.056, 0.6)

    def test_of_a_camera_that_turns(self):
        folder = dataset("rgbd/tum_fr1_rpy")
        score = self.evaluate(folder, "trajectory", "--truth", folder / "groundtruth.txt",
                              options=("--poses", "estimated"))
        print(f"[{score['ate_m']['rmse']:.4f} m] ", end="", flush=True)
        self.assertGreater(score["matched"], 220)
        self.assertLessEqual(score["ate_m"]["rmse"], 0.06)


if __name__ == "__main__":
    main()
