#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A path from start to goal, each motion of it proved free at every point.

RRT-Connect, with measure_edge() as its only test: it tells how much of a motion is proved free, so that a
tree grows that far. With OMPL's planners the same is done from C++: examples/plan_with_ompl.
"""

import numpy as np
import spherule

STEP = 0.8  # radians that a tree grows at once


def make_checker():
    """A planar arm of three links behind a gap between two posts."""
    robot = spherule.RobotModel("base")
    for i in range(3):
        origin = spherule.Pose((0.0 if i == 0 else 0.3, 0.0, 0.0))
        joint = spherule.Joint(f"joint{i}", "revolute", origin, (0, 0, 1), -2.8, 2.8)
        robot.add_link(f"link{i}", robot.links[-1].name, joint)
        along = np.linspace(0.0, 0.3, 7)
        spheres = np.column_stack([along, 0 * along, 0 * along, np.full(7, 0.03)])
        robot.attach(f"link{i}", spherule.build_tree(spheres))
    scene = spherule.RobotScene(robot)
    scene.add("left", spherule.Cylinder(0.06, 1.0), spherule.Pose((0.5, 0.2, 0.0)))
    scene.add("right", spherule.Cylinder(0.06, 1.0), spherule.Pose((0.5, -0.2, 0.0)))
    return scene.snapshot()


class Tree:
    """Configurations that are joined to the root by proved motions."""

    def __init__(self, root):
        self.points, self.parents = [root], [-1]

    def grow(self, checker, target):
        """Towards the target as far as is proved, by STEP at most. The new index, or None."""
        nearest = int(np.argmin(np.linalg.norm(np.array(self.points) - target, axis=1)))
        start = self.points[nearest]
        length = np.linalg.norm(target - start)
        end = start + (target - start) * min(1.0, STEP / max(length, 1e-9))
        proved = checker.measure_edge(start, end)
        if proved < 0.05:
            return None
        self.points.append(end if proved == 1.0 else start + 0.9 * proved * (end - start))
        self.parents.append(nearest)
        return len(self.points) - 1

    def path_to(self, index):
        path = []
        while index >= 0:
            path.append(self.points[index])
            index = self.parents[index]
        return path[::-1]


def plan(checker, start, goal, seed, tries=5000):
    rng = np.random.default_rng(seed)
    lower, upper = checker.robot.limits.T
    trees = [Tree(start), Tree(goal)]
    for i in range(tries):
        one, other = trees[i % 2], trees[1 - i % 2]
        grown = one.grow(checker, rng.uniform(lower, upper))
        while grown is not None:
            target = one.points[grown]
            met = other.grow(checker, target)
            if met is None:
                break
            if np.array_equal(other.points[met], target):
                path = one.path_to(grown) + other.path_to(met)[::-1][1:]
                return np.array(path if one is trees[0] else path[::-1])
    raise SystemExit("no path found")


def main():
    checker = make_checker()
    start, goal = np.array([1.4, 0.3, 0.2]), np.array([-1.4, -0.3, -0.2])
    print("straight motion proved free:", checker.check_edge(start, goal).verdict == spherule.Verdict.FREE)
    path = plan(checker, start, goal, seed=1)
    edges = checker.check_edges(path[:-1], path[1:])
    print(f"a path of {len(path)} configurations, {edges.free.sum()} of {len(path) - 1} motions proved free")
    np.savetxt("path.csv", path, delimiter=",", header="joint0,joint1,joint2", comments="")
    assert edges.free.all()


if __name__ == "__main__":
    main()
