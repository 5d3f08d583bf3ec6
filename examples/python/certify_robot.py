#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do published spheres cover the robot? Says where they leak and how deep, and mends them.

    certify_robot.py [URDF SPHERES [GEOMETRY]]

SPHERES in any format of audit_robot (cuRobo, XRDF, foam, spherized URDF, SRDF, ...). Without arguments it
writes a robot and spheres as people set them by hand, which leak.
"""

import sys

import spherule

URDF = """<?xml version="1.0"?>
<robot name="gantry">
  <link name="base"><collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0 0 0.25"/><geometry><box size="0.1 0.1 0.5"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.05"/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint>
</robot>
"""
SPHERES = {
    "base": [[x, y, 0, 0.16] for x in (-0.1, 0.1) for y in (-0.1, 0.1)],
    "arm": [[0, 0, 0.05 + 0.1 * i, 0.085] for i in range(5)],
}


def tell(link, spheres, certificate):
    if certificate is not None:
        low, high = certificate.uncovered_depth
        verdict = "covered" if certificate.covered else f"leaks {1e3 * low:.1f} to {1e3 * high:.1f} mm deep"
        print(f"  {link:12} {spheres:4} spheres, {verdict}")


def main(urdf="", spheres="", geometry="collision"):
    if not urdf:
        urdf, spheres = "gantry.urdf", "gantry.json"
        with open(urdf, "w") as file:
            file.write(URDF)
        spherule.write_robot_spheres(SPHERES, "json", spheres)
    robot = spherule.read_urdf(urdf)
    published = spherule.read_robot_spheres(spheres)
    audit = spherule.audit_robot(robot, published, geometry=geometry)
    print(f"{spheres}: {'covers' if audit.links_covered else 'does not cover'} {robot.name}")
    for link in audit.links:
        tell(link.link, link.spheres, link.certificate)
    if audit.links_covered:
        return
    repair = spherule.repair_robot(robot, published, max_error=0.05, geometry=geometry)
    print("mended:")
    for link in repair.links:
        tell(link.link, len(link.repair.spheres), link.certificate)


if __name__ == "__main__":
    main(*sys.argv[1:])
