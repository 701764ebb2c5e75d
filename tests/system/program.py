# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the system tests share: running the program, finding data sets, comparing maps.

PRODOMOS_PROGRAM     the program; build/apps/prodomos if not given
PRODOMOS_DATASETS    the folder of data sets; what the build was told if not given, else ../shared/datasets
PRODOMOS_LONG_TESTS  1: the full sizes, minutes instead of seconds
"""

import hashlib
import os
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("PRODOMOS_PROGRAM") or str(ROOT / "build/apps/prodomos")
DATASETS = pathlib.Path(os.environ.get("PRODOMOS_DATASETS") or os.environ.get("PRODOMOS_DATASETS_DEFAULT")
                        or ROOT.parent / "shared/datasets")
LONG = os.environ.get("PRODOMOS_LONG_TESTS") == "1"

SKIPPED = 77  # what ctest takes for "skipped"
WALL_CLOCK = {("revision", "committed_at")}


def dataset(name):
    path = DATASETS / name
    if not path.exists():
        raise unittest.SkipTest(f"data set {name} is not in {DATASETS} (PRODOMOS_DATASETS)")
    return path


def run(*arguments, **options):
    """The finished process: returncode, stdout, stderr."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=600, **options)


def formats():
    """All that `export` offers."""
    listed = run("export", "--help").stdout.split("Formats:")[1].split("Examples:")[0]
    return re.findall(r"^  (\S+)", listed, re.MULTILINE)


class SystemTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="prodomos_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def replay(self, log, output, *options, **how):
        done = run("replay", log, "-o", output, "--quiet", *options, **how)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
        return done

    def check_whole(self, path):
        """SQLite finds no fault in the file, no row points to nowhere, and the program opens it."""
        with sqlite3.connect(path) as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
        database.close()
        done = run("info", path, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)

    def check_refused(self, done, *words, codes=(1, 2), lines=1):
        """It failed in so many lines, each of them meant for people."""
        self.assertIn(done.returncode, codes, done.stdout + done.stderr)
        errors = [line for line in done.stderr.splitlines() if line.startswith("prodomos: error: ")]
        others = [line for line in done.stderr.splitlines() if not line.startswith("prodomos: ")]
        self.assertEqual(others, [], done.stderr)
        self.assertEqual(len(errors), lines, done.stderr)
        for word in ("terminate called", "unexpected:", "std::", "mrpt::"):
            self.assertNotIn(word, done.stderr)
        for word in words:
            self.assertIn(str(word), done.stderr)


def tables(path):
    """Every row of every table and view, but for the columns that hold the wall clock."""
    with sqlite3.connect(path) as database:
        rows = {}
        for (table,) in database.execute("SELECT name FROM sqlite_master WHERE type IN ('table', 'view') ORDER BY name").fetchall():
            columns = [row[1] for row in database.execute(f"PRAGMA table_info({table})")]
            kept = ", ".join(column for column in columns if (table, column) not in WALL_CLOCK)
            rows[table] = database.execute(f"SELECT {kept} FROM {table} ORDER BY 1, 2").fetchall()
    database.close()
    return rows


def exports(map_file, folder):
    """Every file that exporting in every format writes, as name -> checksum."""
    folder.mkdir()
    for name in formats():
        done = run("export", map_file, name, "-o", folder / f"map.{name}")
        if done.returncode != 0:
            raise AssertionError(f"export {name}: {done.stderr}")
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def main():
    result = unittest.main(exit=False, verbosity=2).result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.skipped:
        print(f"SKIPPED {len(result.skipped)} of {result.testsRun} tests:")
        for test, reason in result.skipped:
            print(f"  {test}: {reason}")
        sys.exit(SKIPPED)
