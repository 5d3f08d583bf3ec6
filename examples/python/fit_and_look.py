#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Covers a part with spheres, says what is proved, and makes a page that shows it.

    fit_and_look.py [MESH [MAX_ERROR]]

Without a mesh it makes a bracket. Writes part.stl, part.json and, where the command is, part.html.
"""

import shutil
import subprocess
import sys

import numpy as np
import spherule


def box(low, high):
    """The corners and triangles of a box, closed and outwards."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = np.array([t for a, b, c, d in sides for t in ([a, b, c], [a, c, d])])
    return np.add(low, corners * np.subtract(high, low)), triangles


def bracket():
    """Two plates at a right angle, in millimetres."""
    parts = [box((0, 0, 0), (60, 30, 8)), box((0, 0, 4), (8, 30, 50))]
    vertices = np.concatenate([part[0] for part in parts])
    triangles = np.concatenate([part[1] + 8 * i for i, part in enumerate(parts)])
    return spherule.TriangleMesh(vertices, triangles)


def main(mesh="", max_error="2"):
    part = spherule.read_mesh(mesh) if mesh else bracket()
    fit = spherule.simplify(part, max_error=float(max_error), effort=5)
    proved = fit.certificate
    print(f"{len(fit.spheres)} spheres; every point of the part lies in one: {proved.covered} (proved)")
    print(f"they protrude by at most {proved.protrusion_over_simplified_max:.3g} from the simplified part (proved)")

    spherule.write_stl(part, "part.stl")
    spherule.save_spheres(fit.file, "part.json")
    tree = spherule.sphere_tree(fit)
    tool = spherule.Capsule(3.0, 40.0)
    for height in (60.0, 100.0):
        hit = spherule.collides(tree, None, tool, spherule.Pose((4.0, 15.0, height)))
        print(f"a tool {height:.0f} above: {'touches' if hit else 'free'}")
    if shutil.which("spherule"):
        subprocess.run(["spherule", "view", "part.stl", "part.json", "-o", "part.html"], check=True)
    else:
        print("next: spherule view part.stl part.json -o part.html")


if __name__ == "__main__":
    main(*sys.argv[1:])
