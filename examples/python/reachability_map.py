#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Where on a table a torch can weld: process points x turns of the torch x postures of the arm.

    reachability_map.py [POINTS_A_SIDE [SCHEDULER]]

SCHEDULER is the address of one of Dask; without it the cores of this machine work. Writes
reachability.npy and, where matplotlib is, reachability.png.
"""

import sys

import numpy as np
import spherule
from spherule import studies

UPPER, FORE, BASE, WRIST, NECK = 0.5, 0.45, 0.4, 0.1, 0.15  # metres


def spheres_along(end, radius, count=8):
    points = np.linspace((0.0, 0.0, 0.0), end, count)
    return spherule.build_tree(spherule.spheres_of(points, np.full(count, radius)))


def make_checker():
    """A turntable, shoulder, elbow and wrist in one plane, and a bent torch that turns about its wire."""
    robot = spherule.RobotModel("base")
    links = [
        ("column", (0, 0, 0), (0, 0, 1), (0, 0, BASE), 0.07),
        ("upper", (0, 0, BASE), (0, 1, 0), (UPPER, 0, 0), 0.05),
        ("fore", (UPPER, 0, 0), (0, 1, 0), (FORE, 0, 0), 0.04),
        ("wrist", (FORE, 0, 0), (0, 1, 0), (0, 0, -WRIST), 0.03),
        ("torch", (0, 0, -WRIST), (0, 0, 1), (0.08, 0, 0.0), 0.02),
    ]
    for name, origin, axis, end, radius in links:
        joint = spherule.Joint(f"{name}_joint", "revolute", spherule.Pose(origin), axis, -3.1, 3.1)
        robot.add_link(name, robot.links[-1].name, joint)
        robot.attach(name, spheres_along(end, radius))
    robot.attach("torch", spherule.build_tree(spherule.spheres_of(
        np.linspace((0.08, 0, 0), (0, 0, -NECK + 0.06), 8), np.full(8, 0.012))))  # fmt: skip
    scene = spherule.RobotScene(robot)
    allowed = spherule.AllowedCollisions(robot)
    for (first, *_), (second, *_) in zip(links[:-1], links[1:]):
        allowed.allow(first, second)
    scene.set_allowed_collisions(allowed)
    scene.add("table", spherule.Box((1.6, 1.6, 0.02)), spherule.Pose((0.0, 0.0, -0.02)))
    scene.allow_contact("column", "table")
    scene.add("fixture", spherule.Box((0.1, 0.5, 0.3)), spherule.Pose((0.5, 0.1, 0.15)))
    scene.add("clamp", spherule.Cylinder(0.04, 0.25), spherule.Pose((-0.1, 0.55, 0.12)))
    return scene.snapshot(enforce_limits=True)


def inverse(pose):
    """Postures that bring the wire's end to a pose whose z axis points up: two shoulders, two elbows."""
    x, y, z = pose[:3, 3]
    height = z + NECK + WRIST - BASE  # of the wrist over the shoulder
    postures = []
    for turn, reach in ((np.arctan2(y, x), np.hypot(x, y)), (np.arctan2(-y, -x), -np.hypot(x, y))):
        cosine = (reach**2 + height**2 - UPPER**2 - FORE**2) / (2 * UPPER * FORE)
        if abs(cosine) > 1:
            continue
        for elbow in (np.arccos(cosine), -np.arccos(cosine)):
            # Turns about y lead from x down to -z.
            shoulder = -np.arctan2(height, reach) - np.arctan2(FORE * np.sin(elbow), UPPER + FORE * np.cos(elbow))
            wrist = -shoulder - elbow
            roll = np.arctan2(pose[1, 0], pose[0, 0]) - turn
            postures.append([turn, shoulder, elbow, wrist, roll])
    postures = np.array(postures).reshape(-1, 5)
    return np.arctan2(np.sin(postures), np.cos(postures))


def draw(points, found, side):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    share = (found.free > 0).mean(axis=1).reshape(side, side)
    axes = plt.figure(figsize=(6, 5)).add_subplot()
    extent = [points[0, 0, 3], points[-1, 0, 3], points[0, 1, 3], points[-1, 1, 3]]
    image = axes.imshow(share.T, origin="lower", extent=extent, vmin=0, vmax=1, cmap="viridis")
    axes.figure.colorbar(image, label="share of the torch's turns without contact")
    axes.set(xlabel="x / m", ylabel="y / m", title="Where the torch can weld")
    axes.figure.savefig("reachability.png", dpi=120, bbox_inches="tight")
    print("reachability.png")


def main(side="25", scheduler=""):
    side = int(side)
    points = np.tile(np.eye(4), (side * side, 1, 1))
    points[:, :2, 3] = np.stack(np.meshgrid(*2 * [np.linspace(-0.8, 0.8, side)], indexing="ij"), -1).reshape(-1, 2)
    turns = (np.arange(12) + 0.5) * np.pi / 6 - np.pi
    client = None
    if scheduler:
        from distributed import Client

        client = Client(scheduler)
        client.upload_file(__file__)
    checker = make_checker()
    found = studies.reachability(checker, points, inverse, turns=turns, client=client)
    print(f"{found.found.sum()} postures, {found.free.sum()} free; {found.reachable.sum()} of {len(points)} points reached")
    for point, turn in np.argwhere(found.free > 0)[:100]:  # kinematics and inverse agree
        posture = inverse(studies_pose(points[point], turns[turn]))[found.posture[point, turn]]
        tip = spherule.forward_kinematics(checker.robot, posture)[-1] * np.array([0.0, 0.0, -NECK])
        assert np.allclose(tip, points[point, :3, 3], atol=1e-9)
    np.save("reachability.npy", found.free)
    try:
        draw(points, found, side)
    except ImportError:
        print("no picture: matplotlib is missing (Debian: python3-matplotlib)")


def studies_pose(pose, angle):
    """The pose as reachability() turns it."""
    turn = spherule.Pose(rotation=(0, 0, np.sin(angle / 2), np.cos(angle / 2)))
    return pose @ turn.matrix


if __name__ == "__main__":
    main(*sys.argv[1:])
