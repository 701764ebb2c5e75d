#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""datasets/get puts data in place, and nothing but the data of its catalogue."""

import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

GET = pathlib.Path(__file__).resolve().parents[2] / "datasets/get"


class DatasetsGet(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        (self.root / "here/laser").mkdir(parents=True)
        (self.root / "here/laser/a.log").write_text("ranges")
        (self.root / "here/frames").mkdir()
        (self.root / "here/frames/b.png").write_text("pixels")
        listing = f"{hashlib.sha256(b'pixels').hexdigest()}  b.png\n"
        self.catalogue = self.root / "catalogue.yaml"
        self.catalogue.write_text(
            "# test\n"
            f'laser/a.log:\n  what: "a"\n  source: "http://a"\n  sha256: {hashlib.sha256(b"ranges").hexdigest()}\n'
            f'frames:\n  what: "b"\n  source: "http://b"\n  sha256: {hashlib.sha256(listing.encode()).hexdigest()}\n'
            'absent.log:\n  what: "c"\n  source: "http://example.org/c"\n  sha256: 0\n')

    def tearDown(self):
        self.folder.cleanup()

    def get(self, *names):
        done = subprocess.run([sys.executable, str(GET), *names, "--to", str(self.root / "to"),
                               "--catalogue", str(self.catalogue)], capture_output=True, text=True,
                              env={**os.environ, "PRODOMOS_DATASETS": str(self.root / "here")})
        return done.returncode, done.stdout + done.stderr

    def test_copies_files_and_folders_and_is_content_the_second_time(self):
        self.assertEqual(self.get("laser/a.log", "frames")[0], 0)
        self.assertEqual((self.root / "to/laser/a.log").read_text(), "ranges")
        self.assertEqual((self.root / "to/frames/b.png").read_text(), "pixels")
        code, output = self.get("frames")
        self.assertEqual(code, 0)
        self.assertIn("there already", output)

    def test_refuses_data_whose_checksum_is_another(self):
        (self.root / "here/laser/a.log").write_text("other ranges")
        code, output = self.get("laser/a.log")
        self.assertEqual(code, 1)
        self.assertIn("expected SHA-256", output)
        self.assertFalse((self.root / "to/laser/a.log").exists())

    def test_names_the_source_of_what_it_cannot_fetch(self):
        code, output = self.get("absent.log")
        self.assertEqual(code, 1)
        self.assertIn("http://example.org/c", output)

    def test_refuses_names_that_are_not_in_the_catalogue(self):
        self.assertEqual(self.get("nothing")[0], 2)


if __name__ == "__main__":
    unittest.main()
