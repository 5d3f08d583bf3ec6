#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a check of samples along a motion misses, and the proof in its place.

Random motions of an arm past a thin rod: first the usual loop over samples, then check_edges(), which
proves each motion free at every point or finds where it touches.
"""

import numpy as np
import spherule

STEP = 0.1  # radians from sample to sample, as sampling planners have it
MOTIONS = 4000


def make_checker():
    robot = spherule.RobotModel("base")
    for i, axis in enumerate([(0, 0, 1), (0, 1, 0), (0, 1, 0)]):
        origin = spherule.Pose((0.0, 0.0, 0.0 if i == 0 else 0.4))
        joint = spherule.Joint(f"joint{i}", "revolute", origin, axis, -2.5, 2.5)
        robot.add_link(f"link{i}", robot.links[-1].name, joint)
        along = np.linspace(0.0, 0.4, 9)
        spheres = np.column_stack([0 * along, 0 * along, along, np.full(9, 0.04)])
        robot.attach(f"link{i}", spherule.build_tree(spheres))
    scene = spherule.RobotScene(robot)
    allowed = spherule.AllowedCollisions(robot)
    allowed.allow_all()
    scene.set_allowed_collisions(allowed)
    scene.add("rod", spherule.Capsule(0.005, 1.5), spherule.Pose((0.5, 0.0, 0.5)))
    return scene.snapshot()


def sampled(checker, start, end):
    """The loop that is replaced: free if all samples are."""
    count = int(np.ceil(np.abs(end - start).max() / STEP)) + 1
    return all(checker.check_config(q) for q in np.linspace(start, end, count))


def main():
    checker = make_checker()
    rng = np.random.default_rng(1)
    starts, ends = rng.uniform(-2, 2, (2, MOTIONS, 3))
    by_samples = np.array([sampled(checker, a, b) for a, b in zip(starts, ends)])

    proved = checker.check_edges(starts, ends, first=True, threads=0)

    missed = by_samples & (proved.verdict == spherule.Verdict.COLLISION)
    print(f"{by_samples.sum()} of {MOTIONS} motions are free at their samples, {proved.free.sum()} are proved free")
    print(f"{missed.sum()} motions touch the rod between samples")
    worst = np.flatnonzero(missed)[0]
    at = proved.contact_at[worst]
    touching = starts[worst] + at * (ends[worst] - starts[worst])
    for contact in checker.explain(touching):
        print(f"motion {worst}, at {at:.4f}: {contact.first.name} and {contact.second.name}")
    assert not (proved.free & ~by_samples).any()  # what is proved has no sample that touches


if __name__ == "__main__":
    main()
