#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs killed at any moment leave a whole map, and --resume ends in the map of an undisturbed run.

The quick variant kills the runs of a short log and compares every table each time, every export the last time. The
full one kills 20 runs of a longer log and compares every export each time:

    PRODOMOS_LONG_TESTS=1 PRODOMOS_PROGRAM=build/apps/prodomos tests/system/resume_test.py
"""

import collections
import json
import random
import signal
import subprocess
import time

from program import LONG, PROGRAM, SystemTest, dataset, exports, main, run, tables

RUNS = 20 if LONG else 8
LOG = "laser/fr079.rawlog" if LONG else "laser/mit-csail.rawlog"
EXPORTS_EVERY = 1 if LONG else RUNS
OPTIONS = ("--set", "submap.max_distance=2")  # many commits to be killed in


class Resume(SystemTest):
    def start(self, log, output, *more):
        return subprocess.Popen([PROGRAM, "replay", log, "-o", output, "--quiet", *OPTIONS, *more],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def kill_after(self, seconds, process):
        time.sleep(seconds)
        process.send_signal(signal.SIGKILL)
        process.wait()

    def look(self, path):
        """How far had the run come that was killed? Its file is whole, and the program opens it."""
        if not path.exists():
            return "before the file"
        self.check_whole(path)
        info = json.loads(run("info", path, "--json").stdout)
        if not info["sessions"]:
            return "before the session"
        if info["sessions"][0]["state"] == "complete":
            return "complete"
        return "within the sub-maps" if info["submaps"]["observed"] > 0 else "before the first sub-map"

    def test_after_kills_at_random_moments(self):
        log = dataset(LOG)
        truth = self.folder / "undisturbed"
        truth.mkdir()
        begin = time.monotonic()
        self.replay(log, truth / "map.prodomos", *OPTIONS)
        duration = time.monotonic() - begin
        expected_tables = tables(truth / "map.prodomos")
        expected_exports = exports(truth / "map.prodomos", truth / "exports")

        dice = random.Random(79)
        states, kills = collections.Counter(), 0
        for number in range(RUNS):
            with self.subTest(run=number):
                folder = self.folder / str(number)
                folder.mkdir()
                output = folder / "map.prodomos"
                # Spread over the whole run, the very beginning included; every fourth run is killed again.
                share = (number + dice.random()) / RUNS
                for _ in range(10):
                    self.kill_after(0.9 * duration * share, self.start(log, output))
                    state = self.look(output)
                    if state != "complete":
                        break
                    duration *= 0.8  # the machine has become faster: once more
                    for part in folder.iterdir():
                        part.unlink()
                kills += 1
                states[state] += 1
                if number % 4 == 3:
                    self.kill_after(dice.random() * duration * (1.0 - share), self.start(log, output, "--resume"))
                    kills += 1
                    states[self.look(output)] += 1
                resumed = run("replay", log, "-o", output, "--resume", "--quiet", *OPTIONS)
                self.assertEqual((resumed.returncode, resumed.stderr), (0, ""))
                self.check_whole(output)
                self.assertEqual(tables(output), expected_tables)
                if number % EXPORTS_EVERY == EXPORTS_EVERY - 1:
                    self.assertEqual(exports(output, folder / "exports"), expected_exports)
        print(f"[{kills} kills of {RUNS} runs of {duration:.1f} s: {dict(states)}] ", end="", flush=True)
        self.assertGreaterEqual(states["within the sub-maps"], kills / 2)

    def test_after_a_kill_while_the_file_is_made(self):
        log = dataset("laser/sena_loop.rawlog")
        self.replay(log, self.folder / "truth.prodomos")
        output = self.folder / "map.prodomos"
        self.folder.joinpath("map.prodomos.part").write_bytes(b"cut")
        self.folder.joinpath("map.prodomos.part-wal").write_bytes(b"cut")
        self.replay(log, output, "--resume")
        self.assertEqual(tables(output), tables(self.folder / "truth.prodomos"))
        self.assertEqual(list(self.folder.glob("*.part*")), [])


if __name__ == "__main__":
    main()
