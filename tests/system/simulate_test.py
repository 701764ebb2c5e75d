#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""A scene and a seed make one log and one truth, which every tool can read; what makes no sense is refused."""

import hashlib
import json
import shutil
import sqlite3
import subprocess
import unittest

from program import SystemTest, dataset, main, run

SCENE = """\
scene: two offices
wall_thickness: 0.2
storeys:
  - height: 2.8
    rooms:
      - {id: corridor, label: CORRIDOR, rectangle: [0, 0, 12, 2.4]}
      - {id: west, label: OFFICE, rectangle: [0, 2.4, 6, 7]}
      - {id: east, label: OFFICE, rectangle: [6, 2.4, 12, 7]}
    doors:
      - {id: shut, rooms: [corridor, west], at: [3, 2.4], width: 0.9, state: closed}
      - {id: wide, rooms: [corridor, east], at: [9, 2.4], width: 1.0, state: open}
"""


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


class Simulate(SystemTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("two_offices.scene.yaml", SCENE)

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content)
        return path

    def simulate(self, name, *options, scene=None, seed=1, frames=15):
        """The log and its truth."""
        log = self.folder / f"{name}.rawlog"
        done = run("simulate", scene or self.scene, "--seed", seed, "--frames", frames, "-o", log, "--quiet", *options)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
        return log, json.loads((self.folder / f"{name}.truth.json").read_text())

    # --- the same again, and otherwise ---

    def test_the_same_seed_makes_the_same_log_and_truth_on_any_number_of_threads(self):
        options = ("--labels", "degraded", "--poses")
        a, _ = self.simulate("a", *options)
        b, _ = self.simulate("b", *options, "--threads", "1")
        self.assertEqual(digest(a), digest(b))
        self.assertEqual(digest(self.folder / "a.truth.json"), digest(self.folder / "b.truth.json"))

    def test_another_seed_makes_another_day(self):
        _, one = self.simulate("one", seed=1)
        _, other = self.simulate("other", seed=2)
        for key in ("objects", "people", "trajectory"):
            self.assertNotEqual(one[key], other[key], key)
        self.assertEqual([room["outline"] for room in one["rooms"]], [room["outline"] for room in other["rooms"]])

    # --- the truth ---

    def test_the_truth_is_that_of_the_scene(self):
        _, truth = self.simulate("log")
        doors = {door["id"]: door for door in truth["doors"]}
        self.assertEqual(set(doors), {"shut", "wide"})
        self.assertEqual(doors["shut"]["rooms"], ["corridor", "west"])
        self.assertAlmostEqual(doors["shut"]["width"], 0.9)
        self.assertEqual(doors["shut"]["states"][0]["state"], "closed")
        self.assertEqual(doors["wide"]["states"][0]["state"], "open")
        self.assertEqual({room["id"] for room in truth["rooms"]}, {"corridor", "west", "east"})
        self.assertEqual(truth["labels"], "none")

    def test_the_robot_drives_the_path_that_it_is_given(self):
        _, truth = self.simulate("log", "--path", "1,1.2", "11,1.2", frames=30)
        begin, end = truth["trajectory"][0]["pose"], truth["trajectory"][-1]["pose"]
        for value, expected in zip(begin[:3], (1, 1.2, 0)):
            self.assertAlmostEqual(value, expected, delta=0.05)
        self.assertGreater(end[0], 3)
        self.assertLess(max(abs(pose["pose"][1] - 1.2) for pose in truth["trajectory"]), 0.3)

    # --- the log ---

    def test_the_log_replays_in_both_flavours(self):
        for flavour in ("observations", "frames"):
            log, truth = self.simulate(flavour, "--flavour", flavour)
            map_file = self.folder / f"{flavour}.prodomos"
            self.replay(log, map_file)
            self.check_whole(map_file)
            with sqlite3.connect(map_file) as database:
                mapped = database.execute("SELECT count(*) FROM trajectory").fetchone()[0]
            database.close()
            self.assertGreater(mapped, 15, flavour)
            self.assertEqual(len(truth["trajectory"]), 45, flavour)  # 15 frames and 30 scans

    def test_the_tools_of_mrpt_read_the_log(self):
        tool = shutil.which("rawlog-edit")
        if not tool:
            raise unittest.SkipTest("rawlog-edit of mrpt-apps is not installed")
        for flavour in ("observations", "frames"):
            log, _ = self.simulate(flavour, "--flavour", flavour, "--labels", "true")
            told = subprocess.run([tool, "--info", "-i", log], capture_output=True, text=True, timeout=120)
            self.assertEqual(told.returncode, 0, told.stderr)
            for word in ("camera", "laser"):
                self.assertIn(word, told.stdout)

    def test_the_map_of_a_simulated_log_lies_where_the_robot_truly_was(self):
        log, truth = self.simulate("log", "--poses", frames=40)
        map_file = self.folder / "map.prodomos"
        self.replay(log, map_file, "--poses", "estimated")
        poses = self.write("truth.txt", "".join(
            f"{pose['time']} {' '.join(map(str, pose['pose']))}\n" for pose in truth["trajectory"]))
        score = json.loads(run("evaluate", "trajectory", map_file, "--truth", poses, "--truth-frame", "body",
                               "--json").stdout)
        self.assertGreater(score["matched"], 40)
        self.assertLess(score["ate_m"]["rmse"], 0.05)

    # --- floor plans and worlds ---

    def test_a_floor_plan_becomes_a_log(self):
        _, truth = self.simulate("plan", scene=dataset("buildings/plans/school/Borchen4_updated.xml"), frames=5)
        self.assertGreaterEqual(len(truth["rooms"]), 8)

    def test_a_world_of_meshes_becomes_a_log(self):
        _, truth = self.simulate("hospital", "--labels", "true",
                                 scene=dataset("buildings/hospital/hospital_two_floors.world"), frames=5)
        self.assertEqual(len(truth["storeys"]), 2)
        self.assertGreaterEqual(len(truth["stairs"]), 2)

    # --- what makes no sense ---

    def refused(self, scene, *words, options=(), codes=(1, 2), lines=1):
        log = self.folder / "refused.rawlog"
        done = run("simulate", scene, "--seed", "1", "--frames", "3", "-o", log, *options)
        self.check_refused(done, *words, codes=codes, lines=lines)
        self.assertEqual(sorted(path.name for path in self.folder.glob("refused*")), [])

    def test_a_scene_that_is_none_is_refused(self):
        self.refused(self.folder / "missing.xml", "missing.xml", "no such file")
        self.refused(self.write("poem.txt", "roses are red\n"), "poem.txt", "expected a floor plan", "scene")

    def test_an_unknown_key_of_a_scene_is_named_with_its_line(self):
        self.refused(self.write("odd.scene.yaml", SCENE + "dragons: 3\n"), "odd.scene.yaml", "12", "dragons")

    def test_a_path_through_a_wall_is_refused(self):
        self.refused(self.scene, options=("--path", "1,1.2", "3,5"))

    def test_an_unknown_key_of_the_configuration_is_refused(self):
        self.refused(self.scene, "camera.zoom", options=("--set", "camera.zoom=3"), codes=(2,))

    def test_the_scene_is_not_overwritten_by_its_log(self):
        done = run("simulate", self.scene, "--seed", "1", "-o", self.scene)
        self.check_refused(done, "-o", codes=(2,))
        self.assertEqual(self.scene.read_text(), SCENE)

    def test_a_place_that_cannot_be_written_to_is_named(self):
        done = run("simulate", self.scene, "--seed", "1", "--frames", "2", "-o", self.folder / "none" / "log.rawlog")
        self.check_refused(done, "none", codes=(1,))


if __name__ == "__main__":
    main()
