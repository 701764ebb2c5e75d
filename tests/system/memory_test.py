#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Memory does not grow with the log."""

import gzip
import json
import shutil

from program import SystemTest, dataset, main


class Memory(SystemTest):
    def peak(self, log):
        """In megabytes, and the readings that it took."""
        output, report_file = self.folder / "map.prodomos", self.folder / "report.json"
        self.replay(log, output, "--report", report_file)
        output.unlink()
        report = json.loads(report_file.read_text())
        return report["peak_memory_mb"], report["readings"]["used"]

    def test_a_log_five_times_as_long_takes_little_more(self):
        log = dataset("laser/intel.rawlog")
        fivefold = self.folder / "fivefold.rawlog"
        # Objects follow one another without a header, so a log can be strung together. Its time stamps jump back to the
        # beginning of the drive four times, and the robot with them.
        with gzip.open(fivefold, "wb", compresslevel=1) as out:
            for _ in range(5):
                with gzip.open(log) as part:
                    shutil.copyfileobj(part, out)
        once, readings = self.peak(log)
        five, five_readings = self.peak(fivefold)
        print(f"[{once:.1f} MB once, {five:.1f} MB five times over: {five / once:.3f}] ", end="", flush=True)
        self.assertEqual(five_readings, 5 * readings)
        self.assertLessEqual(five, 1.3 * once)


if __name__ == "__main__":
    main()
