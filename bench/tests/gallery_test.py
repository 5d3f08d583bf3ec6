#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What bench/plots/gallery.py decides by itself: licences, and spheres at no more than a count."""

import importlib.util
import pathlib
import sys
import tempfile
import types
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

    def test_ours_are_no_more_and_nearly_as_fine_as_possible(self):
        made = gallery.Gallery(types.SimpleNamespace(out=".", only=""), None)
        # As many spheres as 1 / E^2: 100 at E = 0.1.
        ours = made.finest(100, 0.001, 1.0, lambda e: {"count": round(e ** -2), "error": e})
        self.assertLessEqual(ours["count"], 100)
        self.assertLess(ours["error"], 0.11)
        # Where none are so few the coarsest is shown.
        self.assertGreater(made.finest(1, 0.01, 0.1, lambda e: {"count": 50, "error": e})["error"], 0.1)

    def test_an_index_without_models(self):
        with tempfile.TemporaryDirectory() as folder:
            made = gallery.Gallery(types.SimpleNamespace(out=folder, only=""), None)
            made.cards.append(("a.html", "a.png", "A & B", ["60 < 61"], "notes"))
            made.write_index()
            index = (pathlib.Path(folder) / "index.html").read_text()
        for text in ('href="a.html"', 'src="a.png"', "A &amp; B", "60 &lt; 61"):
            self.assertIn(text, index)


if __name__ == "__main__":
    unittest.main()
