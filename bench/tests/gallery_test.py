#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/plots/gallery.py shows only what its licence allows."""

import importlib.util
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[1] / "plots/gallery.py"
spec = importlib.util.spec_from_file_location("gallery", SOURCE)
sys.dont_write_bytecode = True
gallery = importlib.util.module_from_spec(spec)
spec.loader.exec_module(gallery)

SOURCES = """# Models
|file|tris|bbox|units|watertight|open/nm/mis|deg/dup|shells (neg)|vol|source|licence|note|
|---|---|---|---|---|---|---|---|---|---|---|---|
|parts/a.stl|1|1|mm|yes|0|0|1|1|some/one `a.stl` @12|MIT|a part|
|parts/b.stl|1|1|mm|yes|0|0|1|1|some/one `b.stl` @12|all rights reserved|a part|
"""


class GalleryTest(unittest.TestCase):
    def test_only_what_its_licence_allows_is_shown(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "SOURCES.md").write_text(SOURCES)
            sources = gallery.read_sources(pathlib.Path(folder))
        self.assertIn("MIT", gallery.notes_of(sources, ["parts/a.stl"]))
        for refused in (["parts/b.stl"], ["parts/unknown.stl"], ["parts/a.stl", "parts/b.stl"]):
            self.assertIsNone(gallery.notes_of(sources, refused))


if __name__ == "__main__":
    unittest.main()
