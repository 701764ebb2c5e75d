#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whatever is wrong is said in a line that names file, place and what was expected; nothing is left half-written."""

import gzip
import json
import os
import random
import resource
import shutil
import sqlite3
import subprocess

from program import SystemTest, dataset, formats, main, run, tables
from tiny_logs import carmen_log, png


class BadInput(SystemTest):
    # The tiny log's walls go with its robot, so that wheels alone tell its way.
    MANY_SUBMAPS = ("--poses", "odometry", "--set", "submap.max_distance=2")

    def setUp(self):
        super().setUp()
        self.map = self.folder / "map.prodomos"

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def refuse(self, log, *words, options=(), **expected):
        """Replay fails so, and leaves either no map or one that is whole."""
        done = run("replay", log, "-o", self.map, "--quiet", *options)
        self.check_refused(done, *words, **expected)
        if self.map.exists():
            self.check_whole(self.map)

    def refuse_unwritten(self, log, *words, **expected):
        self.refuse(log, *words, **expected)
        self.assertFalse(self.map.exists())

    def good_map(self):
        self.replay(self.write("good.log", carmen_log()), self.map)
        return self.map

    # --- logs ---

    def test_a_missing_log(self):
        self.refuse_unwritten(self.folder / "none.rawlog", self.folder / "none.rawlog", "expected")

    def test_an_empty_log(self):
        log = self.write("empty.rawlog", "")
        self.refuse_unwritten(log, log, "expected")

    def test_a_picture_that_is_called_a_log(self):
        log = self.write("picture.rawlog", b"\xff\xd8\xff\xe0\x00\x10JFIF\x00" + random.Random(1).randbytes(5000))
        self.refuse_unwritten(log, log, "expected")

    def test_a_folder_without_a_log(self):
        self.write("photos/one.txt", "one")
        self.refuse_unwritten(self.folder / "photos", self.folder / "photos", "expected")

    def check_cut(self, content, stored):
        """Logs cut at random places: what was complete is mapped, the cut is reported."""
        whole_log = self.write("log.rawlog", content)
        self.replay(whole_log, self.folder / "whole.prodomos")
        whole = tables(self.folder / "whole.prodomos")["trajectory_point"]  # the way travelled, before loops are closed
        dice, mapped = random.Random(10), []
        for cut in sorted(dice.randrange(len(content) // 20, len(content)) for _ in range(10)):
            with self.subTest(cut=cut):
                self.write("log.rawlog", content[:cut])
                self.map = self.folder / f"{stored}{cut}.prodomos"
                self.refuse(whole_log, whole_log, "object", "byte", "expected", "found", codes=(1,))
                trajectory = tables(self.map)["trajectory_point"]
                # The very last scan had no odometry after it any more: it stands where the robot was last known to be.
                self.assertEqual(trajectory[:-1], whole[:len(trajectory) - 1])
                mapped.append(len(trajectory))
        self.assertEqual(mapped, sorted(mapped))
        self.assertGreater(mapped[-1], len(whole) / 2)

    def test_a_compressed_log_that_was_cut(self):
        self.check_cut(dataset("laser/sena_loop.rawlog").read_bytes(), "gzip")

    def test_a_stored_log_that_was_cut(self):
        self.check_cut(gzip.decompress(dataset("laser/sena_loop.rawlog").read_bytes()), "stored")

    def test_ranges_that_are_no_number_or_negative(self):
        def ranges(scan):
            return ["nan" if scan == 3 and i == 7 else "-1.5" if scan == 5 and i > 90 else "2.0" for i in range(180)]
        log = self.write("ranges.log", carmen_log(ranges=ranges))
        self.refuse(log, f"{log}:6: expected", "NaN", f"{log}:8: expected", "negative", codes=(1,), lines=2)
        self.assertEqual(len(tables(self.map)["trajectory"]), 60)  # the other beams of these scans are good

    def test_lines_that_are_cut_or_garbled(self):
        lines = carmen_log().splitlines()
        lines[10], lines[20] = lines[10][:300], lines[20].replace("2.00", "2,00", 1)
        log = self.write("lines.log", "\n".join(lines))
        self.refuse(log, f"{log}:11: expected", f"{log}:21: expected", codes=(1,), lines=2)
        self.assertEqual(len(tables(self.map)["trajectory"]), 58)

    # --- RGB-D folders ---

    def tum_folder(self):
        for kind, image in (("rgb", png(64, 48, 8, 3, 128)), ("depth", png(64, 48, 16, 1, 10000))):
            for frame in range(5):
                self.write(f"tum/{kind}/{frame}.png", image)
            self.write(f"tum/{kind}.txt", "".join(f"{100 + frame}.0 {kind}/{frame}.png\n" for frame in range(5)))
        self.write("tum/groundtruth.txt", "".join(f"{100 + frame}.0 0 0 1 0.5 -0.5 0.5 -0.5\n" for frame in range(5)))
        self.write("tum/camera.yaml", "fx: 50\nfy: 50\ncx: 31.5\ncy: 23.5\n")
        return self.folder / "tum"

    def test_no_fault_is_found_in_a_good_folder(self):
        self.replay(self.tum_folder(), self.map)
        self.assertEqual(len(tables(self.map)["trajectory"]), 5)

    def test_a_folder_with_a_missing_image(self):
        folder = self.tum_folder()
        (folder / "depth/2.png").unlink()
        self.refuse(folder, folder / "depth/2.png", "expected", codes=(1,))
        self.assertEqual(len(tables(self.map)["trajectory"]), 4)

    def test_a_folder_with_an_unreadable_image(self):
        folder = self.tum_folder()
        image = (folder / "depth/3.png").read_bytes()
        (folder / "depth/3.png").write_bytes(image[:len(image) // 2])
        (folder / "depth/1.png").write_bytes(b"no image at all")
        self.refuse(folder, folder / "depth/1.png", folder / "depth/3.png", "expected", codes=(1,), lines=2)

    def test_a_folder_with_unsorted_time_stamps(self):
        folder = self.tum_folder()
        self.write("tum/depth.txt", "100.0 depth/0.png\n102.0 depth/2.png\n101.0 depth/1.png\n")
        self.refuse_unwritten(folder, f"{folder / 'depth.txt'}:3: expected", "102")

    # --- configuration and usage ---

    def test_a_configuration_with_three_mistakes(self):
        config = self.write("bad.yaml", "submap:\n  max_distanse: 5\n  least_overlap: 2.5\ngrid:\n  resolution: wide\n")
        log = self.write("good.log", carmen_log())
        self.refuse_unwritten(log, f"{config}:2", "max_distanse", f"{config}:3", "least_overlap", f"{config}:5",
                              "resolution", options=("--config", config), codes=(2,), lines=3)

    def test_unknown_commands_options_and_formats(self):
        good = self.good_map()
        for arguments in (["fly"], ["replay"], ["replay", good, "--fast"], ["query", good], ["info"], []):
            with self.subTest(arguments=arguments):
                self.check_refused(run(*arguments), codes=(2,))
        self.check_refused(run("export", good, "docx"), "'docx'", *formats(), codes=(2,))

    def test_malformed_positions(self):
        good = self.good_map()
        for position in ("1", "1,", "1;2", "a,b", "1,2,3,4", "1,2,x", "nan,0", "inf,0", ""):
            with self.subTest(position=position):
                self.check_refused(run("query", good, "place", position), "'" + position + "'", codes=(2,))
        self.check_refused(run("query", good, "route", "0,0", "1"), "'1'", codes=(2,))
        self.check_refused(run("query", good, "predicted-rooms", "--from", "1"), "'1'", codes=(2,))
        self.check_refused(run("query", good, "route", "0,0"), codes=(2,))

    def test_negative_positions_are_no_options(self):
        good = self.good_map()
        for question in (["place", "-1.5,-2"], ["place", "-1,-2,0"], ["place", "-0.5,-2"], ["place", "--", "-.5,-2"],
                         ["route", "0,0", "-1.5,-2"], ["route", "-1,0", "-0.5,-2"],
                         ["predicted-rooms", "--from", "-1.5,-2"], ["predicted-rooms", "--from=-.5,-2"]):
            with self.subTest(question=question):
                done = run("query", good, question[0], "--json", *question[1:])
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                json.loads(done.stdout)

    # --- outputs ---

    def test_an_output_that_cannot_be_written(self):
        log = self.write("good.log", carmen_log())
        (self.folder / "folder").mkdir()
        for output in ("none/map.prodomos", "folder", "good.log/map.prodomos"):
            with self.subTest(output=output):
                self.map = self.folder / output
                done = run("replay", log, "-o", self.map, "--quiet")
                self.check_refused(done, self.map)
        self.map = self.folder / "map.prodomos"
        self.refuse(log, self.folder / "none/report.json", options=("--report", self.folder / "none/report.json"))
        for name in formats():
            for output in ("none/map", "folder"):
                if name == "nav2" and output == "folder":
                    continue  # is folder.yaml and folder.pgm
                with self.subTest(format=name, output=output):
                    self.check_refused(run("export", self.map, name, "-o", self.folder / output), self.folder / output)
        self.check_refused(run("view", self.map, "--screenshot", self.folder / "none/map.png"), self.folder / "none")
        self.assertEqual(log.read_text(), carmen_log())

    def test_an_output_that_is_an_input(self):
        log = self.write("good.log", carmen_log())
        self.check_refused(run("replay", log, "-o", log), log)
        self.check_refused(run("replay", log, "-o", self.map, "--report", log), log, codes=(2,))
        self.check_refused(run("replay", log, "-o", self.map, "--report", self.map), self.map, codes=(2,))
        self.assertFalse(self.map.exists())
        self.assertEqual(log.read_text(), carmen_log())
        good = self.good_map()
        for name in ("json", "nav2"):
            with self.subTest(format=name):
                self.check_refused(run("export", good, name, "-o", good), good, codes=(2,))
        self.check_refused(run("view", good, "--screenshot", good), good, codes=(2,))
        self.check_whole(good)

    def test_another_file_in_the_outputs_place_stays(self):
        log, notes = self.write("good.log", carmen_log()), self.write("notes.txt", "precious")
        self.check_refused(run("replay", log, "-o", notes), notes)
        self.assertEqual(notes.read_text(), "precious")

    def check_full_disk(self, output, **options):
        self.write("good.log", carmen_log(400))
        done = run("replay", self.folder / "good.log", "-o", output, "--quiet", *self.MANY_SUBMAPS, **options)
        self.check_refused(done, output, codes=(1,))
        self.assertRegex(done.stderr, "no room|No space|full")

    def test_a_file_that_must_not_grow(self):
        limit = 150_000

        def limited():
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        self.check_full_disk(self.map, preexec_fn=limited)
        self.check_whole(self.map)
        self.check_resumes(self.map)

    def check_resumes(self, output):
        truth = self.folder / "truth.prodomos"
        self.replay(self.folder / "good.log", truth, *self.MANY_SUBMAPS)
        self.replay(self.folder / "good.log", output, "--resume", *self.MANY_SUBMAPS)
        self.assertEqual(tables(output), tables(truth))

    def test_a_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = os.geteuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", disk],
                                                       capture_output=True).returncode == 0
        if not mounted:
            print("[mounting is not allowed here: left to the limit of a file's size] ", end="", flush=True)
            return
        try:
            output = disk / "map.prodomos"
            self.check_full_disk(output)
            self.assertTrue(output.exists())
            # Reading needs no room where there is none.
            for part in disk.iterdir():
                shutil.copy(part, self.folder / part.name)
            done = run("info", output)
            self.assertEqual(done.returncode, 0, done.stderr)
            # The report and exports meet the same disk.
            fill = disk / "fill"
            try:
                with open(fill, "wb", buffering=0) as file:
                    while file.write(b"x" * 4096):
                        pass
            except OSError:
                pass
            before = sorted(disk.iterdir())
            for name in formats():
                with self.subTest(format=name):
                    done = run("export", output, name, "-o", disk / f"out.{name}")
                    self.check_refused(done, disk, codes=(1,))
                    self.assertEqual(sorted(disk.iterdir()), before)
        finally:
            subprocess.run(["umount", disk], check=True)
        self.check_whole(self.map)
        self.check_resumes(self.map)

    # --- maps ---

    def ask_everything(self, path):
        """Every command that reads a map, on this one. Which format is asked for makes no difference to opening it."""
        yield run("info", path)
        yield run("query", path, "place", "0,0")
        yield run("query", path, "route", "0,0", "1,1")
        yield run("query", path, "predicted-rooms")
        yield run("export", path, "json", "-o", self.folder / "out")
        yield run("view", path, "--screenshot", self.folder / "out.png")

    def check_no_map(self, path, *words):
        for done in self.ask_everything(path):
            with self.subTest(command=done.args[1:]):
                self.check_refused(done, path, *words)
        self.assertFalse((self.folder / "out").exists() or (self.folder / "out.png").exists())

    def test_maps_that_are_none(self):
        self.check_no_map(self.folder / "none.prodomos", "expected")
        self.check_no_map(self.write("text.prodomos", "no map at all " * 100), "expected")
        self.check_no_map(self.write("empty.prodomos", ""), "expected")
        self.check_no_map(self.folder)
        other = self.folder / "other.prodomos"
        with sqlite3.connect(other) as database:
            database.execute("CREATE TABLE bookmark (url TEXT)")
        database.close()
        self.check_no_map(other, "expected a prodomos map")
        self.check_refused(run("replay", self.write("good.log", carmen_log()), "-o", other, "--resume"), other)

    def test_a_map_of_a_newer_schema(self):
        good = self.good_map()
        with sqlite3.connect(good) as database:
            database.execute("PRAGMA user_version = 99")
        database.close()
        self.check_no_map(good, "expected a map of schema version", "99")
        for options in ((), ("--resume",)):
            self.check_refused(run("replay", self.folder / "good.log", "-o", good, *options), good, "99")

    def test_a_map_with_a_flipped_byte_in_a_layer(self):
        good = self.good_map()
        with sqlite3.connect(good) as database:
            node, data = database.execute("SELECT node, data FROM layer WHERE type = 'occupancy_grid' LIMIT 1").fetchone()
            data = bytearray(data)
            data[len(data) // 2] ^= 0x10
            database.execute("UPDATE layer SET data = ? WHERE node = ? AND type = 'occupancy_grid'", (bytes(data), node))
        database.close()
        for name in ("html", "nav2", "png"):
            with self.subTest(format=name):
                done = run("export", good, name, "-o", self.folder / "out")
                self.check_refused(done, good, f"s{node}", "checksum", codes=(1,))
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith("out")], [])

    def test_a_map_with_damaged_pages(self):
        good = self.good_map()
        content = bytearray(good.read_bytes())
        content[4096:4096 * 6] = bytes(4096 * 5)
        good.write_bytes(content)
        for done in self.ask_everything(good):
            with self.subTest(command=done.args[1:]):
                if done.returncode != 0:
                    self.check_refused(done, good, codes=(1,))
        self.check_refused(run("info", good), good)

    def test_to_resume_with_another_log_or_configuration(self):
        good = self.good_map()
        with sqlite3.connect(good) as database:
            database.execute("UPDATE session SET state = 'running'")
        database.close()
        other = self.write("other.log", carmen_log(10))
        self.check_refused(run("replay", other, "-o", good, "--resume"), "good.log", codes=(2,))
        self.check_refused(run("replay", self.folder / "good.log", "-o", good, "--resume", "--set",
                               "submap.max_distance=7"), "configuration", codes=(2,))


if __name__ == "__main__":
    main()
