#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""`prodomos optimize`: poses fall into place, everything else in the file stays, and bad graphs are refused by line."""

import json
import math

from program import SystemTest, dataset, main, run

UNIT = " 100 0 0 100 0 100"
# A square of 1 m, each corner turned by a quarter, its sides measured a little long.
SQUARE = "".join(f"EDGE_SE2 {i} {(i + 1) % 4} 1.01 0 {math.pi / 2}{UNIT}\n" for i in range(4))


class Optimize(SystemTest):
    def setUp(self):
        super().setUp()
        self.output = self.folder / "out.g2o"

    def write(self, content, name="graph.g2o"):
        path = self.folder / name
        path.write_text(content)
        return path

    def optimize(self, graph, *options):
        done = run("optimize", graph, "-o", self.output, "--json", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def test_graphs_reach_the_published_chi2(self):
        for name, chi2 in (("intel", "45.0047"), ("manhattan", "3549.04"), ("CSAIL", "40.5551"),
                           ("parking-garage", "1.23869"), ("sphere2500", "727.15")):
            with self.subTest(graph=name):
                graph = dataset(f"posegraphs/{name}.g2o")
                report = self.optimize(graph)
                decimals = len(chi2.split(".")[1])
                self.assertEqual(f"{report['chi2']['after']:.{decimals}f}", chi2)
                self.assertGreater(report["chi2"]["before"], report["chi2"]["after"])
                lines = [line for line in graph.read_text().splitlines() if not line.startswith("VERTEX")]
                written = self.output.read_text().splitlines()
                self.assertEqual([line for line in written if not line.startswith("VERTEX")], lines)
                self.assertEqual(len(written) - len(lines), report["vertices"])
                # What was written stands where it should: nothing is left to gain.
                again = run("optimize", self.output, "-o", self.folder / "again.g2o", "--start", "file", "--json")
                after = json.loads(again.stdout)["chi2"]
                self.assertAlmostEqual(after["before"] / report["chi2"]["after"], 1.0, places=6)

    def test_the_same_graph_gives_the_same_bytes(self):
        graph = self.write(SQUARE)
        self.optimize(graph)
        first = self.output.read_bytes()
        self.optimize(graph)
        self.assertEqual(self.output.read_bytes(), first)

    def test_the_table_tells_of_unconnected_parts(self):
        graph = self.write(SQUARE + f"EDGE_SE2 10 11 1 0 0{UNIT}\n")
        done = run("optimize", graph, "-o", self.output)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("2 unconnected parts", done.stdout)
        self.assertEqual(self.optimize(graph)["parts"], 2)

    def test_robust_leaves_out_a_wrong_loop(self):
        wrong = f"EDGE_SE2 0 2 5 5 0{UNIT}\n"
        good = self.optimize(self.write(SQUARE))
        report = self.optimize(self.write(SQUARE + wrong), "--robust")
        self.assertEqual(report["rejected"], 1)
        self.assertAlmostEqual(report["chi2"]["after"], good["chi2"]["after"], places=6)
        self.assertGreater(self.optimize(self.write(SQUARE + wrong))["chi2"]["after"], 100)

    def refuse(self, content, *words):
        graph = self.write(content, "bad.g2o")
        self.check_refused(run("optimize", graph, "-o", self.output), f"{graph}", *words, codes=(1,))
        self.assertFalse(self.output.exists())

    def test_bad_graphs(self):
        vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
        self.refuse(vertices + f"EDGE_SE2 0 7 1 0 0{UNIT}\n", ":3: expected", "vertex 7")
        self.refuse(vertices + "EDGE_SE2 0 1 1 0 0 1 0 0 -1 0 1\n", ":3: expected", "positive definite")
        self.refuse(vertices + f"EDGE_SE2 0 1 nan 0 0{UNIT}\n", ":3: expected", "`nan`")
        self.refuse(vertices + vertices + f"EDGE_SE2 0 1 1 0 0{UNIT}\n", ":3: expected", "vertex 0")
        self.refuse(vertices + "EDGE_SE2 0 1 1 0 0 1 0", ":3: expected", "12 fields")
        self.refuse(vertices + "EDGE_SE2_XY 0 1 1 0 0 1 0", ":3: expected", "`EDGE_SE2_XY`")
        self.refuse(vertices, "no edge")
        self.refuse("", "no edge")
        self.refuse("\x00\x01\x02 binary", ":1: expected")

    def test_files_that_cannot_be(self):
        self.check_refused(run("optimize", self.folder / "none.g2o", "-o", self.output), "none.g2o", codes=(1,))
        self.check_refused(run("optimize", self.folder, "-o", self.output), self.folder, codes=(1,))
        graph = self.write(SQUARE)
        self.check_refused(run("optimize", graph, "-o", graph), graph, codes=(2,))
        self.check_refused(run("optimize", graph, "-o", self.folder / "none/out.g2o"), "none/out.g2o", codes=(1,))
        self.check_refused(run("optimize", graph), "-o", codes=(2,))
        self.assertEqual(graph.read_text(), SQUARE)


if __name__ == "__main__":
    main()
