#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Real logs of every kind become maps, with every reading accounted for."""

import json
import math
import pathlib
import sqlite3

from program import SystemTest, dataset, main, run


def node_poses(path):
    with sqlite3.connect(path) as database:
        rows = database.execute("SELECT x, y, z, qx, qy, qz, qw FROM node ORDER BY id").fetchall()
    database.close()
    return rows


def body_positions(path):
    with sqlite3.connect(path) as database:
        rows = database.execute("SELECT x, y, z FROM trajectory ORDER BY session, time_ns").fetchall()
    database.close()
    return rows


def read_pgm(path):
    magic, size, depth, cells = path.read_bytes().split(b"\n", 3)
    assert (magic, depth) == (b"P5", b"255")
    return size, cells


class Logs(SystemTest):
    def check(self, name, *options, kinds, poses="estimated"):
        log = dataset(name)
        output, report_file = self.folder / f"{log.name}.{poses}.prodomos", self.folder / "report.json"
        self.replay(log, output, "--report", report_file, *options)
        report = json.loads(report_file.read_text())
        readings = report["readings"]
        self.assertEqual(readings["used"] + sum(readings["skipped"].values()), readings["read"])
        self.assertEqual(sum(readings["used_by_kind"].values()), readings["used"])
        self.assertEqual(readings["used_by_kind"], kinds)
        self.assertEqual(report["poses"]["origin"], poses)
        self.assertLessEqual(report["poses"]["lost"], readings["used"])
        self.assertGreaterEqual(report["submaps"], 1)
        self.assertGreaterEqual(report["places"], 1)
        self.assertGreaterEqual(report["distance_m"], 0.0)
        self.assertGreater(report["peak_memory_mb"], 0.0)
        self.assertLessEqual({"total", "read", "store", "occupancy_grid", "points"}, set(report["seconds"]))
        self.check_whole(output)
        self.check_answers(output, report)
        return output

    def ask(self, *arguments):
        done = run(*arguments, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def check_answers(self, output, report):
        info = self.ask("info", output)
        self.assertEqual(info["submaps"]["observed"], report["submaps"])
        self.assertEqual(info["places"], report["places"])
        self.assertEqual([session["state"] for session in info["sessions"]], ["complete"])
        x, y = node_poses(output)[-1][:2]
        here = f"{x:.3f},{y:.3f}"
        self.assertIn(self.ask("query", output, "place", here)["state"], ("free", "occupied", "unknown"))
        route = self.ask("query", output, "route", here, here)
        self.assertTrue(route is None or route["length_m"] == 0.0, route)
        rooms = self.ask("query", output, "predicted-rooms", "--from", here)
        self.assertEqual(len(rooms), info["submaps"]["predicted"])

    def test_maps_intel(self):
        self.check("laser/intel.rawlog", kinds={"laser_scan": 13631, "odometry": 13631})

    def test_maps_mit_csail(self):
        self.check("laser/mit-csail.rawlog", kinds={"laser_scan": 1988, "odometry": 1988})

    def test_maps_ual_2014(self):
        self.check("laser/ual_2014.rawlog", kinds={"laser_scan": 3318, "odometry": 15351})

    def test_maps_sena_loop(self):
        self.check("laser/sena_loop.rawlog", kinds={"laser_scan": 225, "odometry": 224})

    def test_maps_a_single_depth_image(self):
        self.check("rgbd/single_frame.rawlog", kinds={"rgbd_frame": 1})

    def test_maps_a_tum_folder_with_recorded_poses(self):
        self.check("rgbd/tum_fr1_rpy", "--poses", "recorded", poses="recorded",
                   kinds={"rgbd_frame": 232, "recorded_pose": 2742})

    def test_maps_a_tum_folder_of_another_camera(self):
        self.check("rgbd/tum_fr3_structure", "--camera", "535.4,539.2,320.1,247.6", poses="recorded",
                   kinds={"rgbd_frame": 30, "recorded_pose": 2729})

    def test_maps_a_folder_of_images_without_time_stamps(self):
        self.check("rgbd/icsl_corridor", kinds={"rgbd_frame": 220})

    def check_alike(self, one, other, pose_tolerance, cell_tolerance):
        """Node by node within metres (and quaternions alike); the fused grids but for a share of the known cells."""
        poses = node_poses(one), node_poses(other)
        self.assertEqual(len(poses[0]), len(poses[1]))
        farthest = max(math.dist(a, b) for a, b in zip(*poses))
        self.assertLessEqual(farthest, pose_tolerance)
        grids = []
        for path in (one, other):
            written = pathlib.Path(f"{path}.yaml")
            self.assertEqual(run("export", path, "nav2", "-o", written).returncode, 0)
            origin = [line for line in written.read_text().splitlines() if not line.startswith("image:")]
            grids.append((origin, *read_pgm(written.with_suffix(".pgm"))))
        self.assertEqual(grids[0][:2], grids[1][:2])
        differing = sum(a != b for a, b in zip(grids[0][2], grids[1][2]))
        known = sum(cell != 205 for cell in grids[0][2])
        print(f"[poses within {farthest:.1e}, {differing} of {known} known cells differ] ", end="", flush=True)
        self.assertLessEqual(differing, cell_tolerance * known)

    def test_maps_both_flavours_of_a_rawlog_alike(self):
        # One flavour holds poses, the other their increments; summing these up rounds in the last bits, and an end
        # point on the very border of two cells may fall to either side.
        kinds = {"laser_scan": 1159, "odometry": 1161}
        for poses, tolerance in (("odometry", 1e-9), ("estimated", 1e-6)):
            with self.subTest(poses=poses):
                maps = [self.check(f"laser/{name}.rawlog", "--poses", poses, poses=poses, kinds=kinds)
                        for name in ("driving_in_office", "driving_in_office_obs")]
                self.check_alike(*maps, tolerance, 1e-5)

    # A rawlog counts time in 100 ns and holds ranges as floats, CARMEN's text has decimals; and of the log's many
    # odometry lines the rawlog kept one a scan.
    FR079 = (("laser/fr079.rawlog", {"laser_scan": 4934, "odometry": 4934}),
             ("laser/fr079.clf.bz2", {"laser_scan": 4934, "odometry": 13885}))

    def test_maps_a_rawlog_and_the_carmen_log_it_was_made_of_alike(self):
        # Which doorways are found, and so where sub-maps end, may hang by a rounded bit: here it is the way alone.
        maps = [self.check(name, "--poses", "odometry", "--set", "detectors.enabled=false", poses="odometry", kinds=kinds)
                for name, kinds in self.FR079]
        self.check_alike(*maps, 1e-9, 1e-5)

    def test_estimates_the_same_way_from_a_rawlog_and_its_carmen_log(self):
        # Where little tells the pose, a rounded bit decides it; all in all the ways are one.
        ways = [body_positions(self.check(name, kinds=kinds)) for name, kinds in self.FR079]
        self.assertEqual(len(ways[0]), len(ways[1]))
        mean = sum(map(math.dist, *ways)) / len(ways[0])
        print(f"[{mean:.4f} m apart in the mean] ", end="", flush=True)
        self.assertLessEqual(mean, 0.03)


if __name__ == "__main__":
    main()
