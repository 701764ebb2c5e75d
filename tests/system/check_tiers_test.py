#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tier check finds what it is there to find."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class CheckTiers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for name in ("include", "src", "apps", ".ci"):
            if (ROOT / name).exists():
                shutil.copytree(ROOT / name, self.root / name)

    def tearDown(self):
        self.folder.cleanup()

    def check(self, *arguments):
        done = subprocess.run([sys.executable, str(ROOT / ".ci/check_tiers"), "--root", str(self.root), *arguments],
                              capture_output=True, text=True)
        return done.returncode, done.stdout

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def assert_found(self, fault, *arguments):
        code, output = self.check(*arguments)
        self.assertEqual(code, 1, output)
        self.assertIn(fault, output)

    def test_accepts_the_tree_as_it_is(self):
        self.assertEqual(self.check(), (0, "tiers: all within the table\n"))

    def test_finds_an_upward_include(self):
        self.write("src/map/bad.cpp", '#include "prodomos/query/query.hpp"\n')
        self.assert_found("src/map/bad.cpp:1: prodomos/query/query.hpp: map must not see query")

    def test_finds_a_sideways_include(self):
        self.write("include/prodomos/query/bad.hpp", '#pragma once\n#include "prodomos/io/open_source.hpp"\n')
        self.assert_found("include/prodomos/query/bad.hpp:2: prodomos/io/open_source.hpp: query must not see io")

    def test_finds_a_third_party_in_a_public_header(self):
        self.write("include/prodomos/map/bad.hpp", "#include <sqlite3.h>\n")
        self.assert_found("sqlite3.h: sqlite is not for public headers")

    def test_finds_a_third_party_in_the_wrong_tier(self):
        self.write("src/query/bad.cpp", "#include <opencv2/core.hpp>\n")
        self.assert_found("opencv2/core.hpp: opencv is not for query")

    def test_finds_another_tiers_private_header(self):
        self.write("src/exporter/bad.cpp", '#include "map/database.hpp"\n')
        self.assert_found("private headers of map are not for exporter")

    def test_finds_a_header_of_nobody_knows_whom(self):
        self.write("src/base/bad.cpp", "#include <fmt/core.h>\n")
        self.assert_found("neither std nor in the table's third parties")

    def test_finds_a_tier_that_is_not_in_the_table(self):
        self.write("src/cellar/bad.cpp", "\n")
        self.assert_found("no tier cellar in the table")

    def test_finds_links_that_run_upward_or_to_third_parties_of_others(self):
        graph = self.write("graph.dot", '"a" -> "b" // prodomos_map -> prodomos_query\n'
                                        '"a" -> "c" [style = dotted] // prodomos_query -> opencv_core\n')
        self.assert_found("prodomos_map links prodomos_query, which map must not see", "--graph", str(graph))
        self.assert_found("prodomos_query links opencv_core: opencv is not for query", "--graph", str(graph))

    def test_finds_what_a_planner_must_not_carry_however_deep(self):
        graph = self.write("graph.dot", "// prodomos_query -> prodomos_map\n// prodomos_map -> SQLite::SQLite3\n"
                                        "// SQLite::SQLite3 -> mrpt::io\n")
        self.assert_found("prodomos_query has mrpt below it", "--graph", str(graph))

    def test_refuses_a_table_that_runs_in_circles(self):
        table = self.root / ".ci/tiers.txt"
        table.write_text(table.read_text().replace("base         |         ", "base         | query   "))
        self.assertEqual(self.check()[0], 2)


if __name__ == "__main__":
    unittest.main()
