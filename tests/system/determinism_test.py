#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""The same log, configuration and version make the same map, byte for byte in every export, on however many cores."""

import os

from program import ROOT, SystemTest, dataset, exports, main, run, tables


def on_one_core():
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


class Determinism(SystemTest):
    def check(self, log, *options):
        runs = []
        for name, limit in (("all_cores", None), ("one_core", on_one_core)):
            folder = self.folder / name
            folder.mkdir()
            self.replay(log, folder / "map.prodomos", *options, preexec_fn=limit)
            runs.append((exports(folder / "map.prodomos", folder / "exports"), tables(folder / "map.prodomos")))
        self.assertGreaterEqual(len(runs[0][0]), 13)
        self.assertEqual(runs[0][0], runs[1][0])
        self.assertEqual(runs[0][1], runs[1][1])

    def test_of_a_laser_log(self):
        self.check(dataset("laser/driving_in_office.rawlog"))

    def test_of_depth_images(self):
        self.check(dataset("rgbd/tum_fr3_structure"))

    def test_of_depth_images_without_poses(self):
        self.check(dataset("rgbd/tum_fr3_structure"), "--poses", "estimated")

    def test_of_laser_and_depth_images_together(self):
        log = self.folder / "office.rawlog"
        done = run("simulate", ROOT / "configs/sample_office.scene.yaml", "--seed", "7", "--frames", "100", "-o", log)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check(log)


if __name__ == "__main__":
    main()
