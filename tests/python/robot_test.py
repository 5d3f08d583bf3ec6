# SPDX-License-Identifier: BSD-3-Clause
"""Robots: files, covers, audits, scenes and checkers."""

import numpy as np
import pytest
import spherule
from conftest import random_configurations
from spherule import Joint, Pose, Verdict


def test_a_description_tells_what_the_file_holds(description):
    assert description.name == "arm" and len(description.links) == 6
    model = description.model
    assert model.variable_count == 4
    assert model.variable_joints == ("turn", "shoulder", "wrist", "grip")
    assert model.limits[1].tolist() == [-2.5, 2.5]
    other = model.joints[model.find_joint("other")]
    assert other.mimics == "grip" and other.type == "prismatic" and other.parent_link == "hand"
    assert description.links[0].collision[0].geometry == spherule.Cylinder(0.08, 0.2)


def test_kinematics(description):
    poses = spherule.forward_kinematics(description, [np.pi / 2, 0, 0, 0.01])
    hand = poses[description.model.find_link("hand")]
    assert np.allclose(hand.translation, [0, 0, 0.89]) and len(poses) == 6
    left, right = (poses[description.model.find_link(name)].translation for name in ("left", "right"))
    assert np.linalg.norm(left - right) == pytest.approx(0.06)


def test_a_robot_made_by_hand():
    robot = spherule.RobotModel("base")
    axis = Joint("slide", "prismatic", Pose((0, 0, 1)), (2, 0, 0), 0.0, 1.0)
    assert robot.add_link("car", "base", axis) == 1
    robot.add_link("copy", "base", Joint("follower", "prismatic", lower=0.0, upper=2.0))
    robot.mimic("follower", "slide", 2.0)
    robot.attach("car", spherule.build_tree([[0, 0, 0, 0.5]]))
    assert robot.variable_count == 1 and robot.sphere_count == 1
    assert robot.links[1].trees[0].spheres[0, 3] == 0.5 and robot.joints[0].axis == (1, 0, 0)
    scene = spherule.RobotScene(robot)
    scene.add("ball", spherule.SolidSphere(0.5), Pose((1.5, 0, 1)))
    checker = scene.snapshot()
    assert checker.check_config([0.0]) and not checker.check_config([1.0])
    edge = checker.check_edge([0.0], [1.0], first=True)
    assert edge.verdict == Verdict.COLLISION and edge.free_until == pytest.approx(0.5, abs=1e-3)
    assert checker.measure_edge([0.0], [1.0]) == pytest.approx(0.5, abs=1e-3)
    assert checker.clearance([0.0]).lower == pytest.approx(0.5)
    assert checker.within([0.0], 0.6) and not checker.within([0.0], 0.4)


def test_covers_are_proved(cover):
    assert cover.links_not_proved == () and cover.spheres.count > 10
    assert all(link.fit.certificate.covered for link in cover.links)


@pytest.fixture(scope="module")
def bar():
    """A thin bar on a slide: audits flood cells of a share of its diagonal."""
    model = spherule.RobotModel("rail")
    model.add_link("bar", "rail", Joint("slide", "prismatic", lower=0.0, upper=1.0))
    shape = spherule.LinkShape("", Pose(), spherule.Box((0.01, 0.01, 0.4)))
    links = [spherule.LinkDescription("rail"), spherule.LinkDescription("bar", (), (shape,))]
    return spherule.RobotDescription("bar", model, links)


def test_audits_find_leaks_and_repairs_close_them(bar):
    spheres = spherule.cover_robot(bar, max_error=0.02, effort=0).spheres
    audit = spherule.audit_robot(bar, spheres, max_error=0.02, configurations=[[0.0], [1.0]])
    assert audit.links_covered and audit.configurations_covered
    assert [link.link for link in audit.links] == ["rail", "bar"] and len(audit.configurations) == 2
    leaky = {"bar": spheres.links["bar"][1:], "wing": [[0, 0, 0, 1]]}
    audit = spherule.audit_robot(bar, leaky, max_error=0.02)
    assert not audit.links_covered and audit.unknown_links == ("wing",)
    assert audit.links[1].uncovered_share > 0 and audit.links[0].certificate is None
    assert all(link.warnings == () for link in audit.links)
    mended = spherule.repair_robot(bar, leaky, max_error=0.02)
    assert mended.links[0].certificate.covered and mended.links[0].warnings == ()
    assert spherule.audit_robot(bar, mended.spheres, max_error=0.02).links_covered


def test_options_of_one_link(description, cover):
    options = {"fore": spherule.LinkCoverOptions(max_error=0.015)}
    finer = spherule.cover_robot(description, max_error=0.03, effort=0, links=options)
    counts = {link.link: len(link.spheres) for link in finer.links}
    assert counts["fore"] > len(cover.spheres.links["fore"])
    assert counts["upper"] == len(cover.spheres.links["upper"])


@pytest.mark.parametrize("format", ["urdf", "srdf", "curobo", "xrdf", "foam", "json"])
def test_formats_keep_every_bit(description, cover, urdf, tmp_path, format):
    path = tmp_path / f"arm.{format}"
    spherule.write_robot_spheres(
        cover.spheres, format, path, urdf=urdf, base_link="base", tool_link="hand",
        joint_names=description.model.variable_joints,
    )  # fmt: skip
    read = spherule.read_robot_spheres(path)
    assert read.format
    for link, spheres in cover.spheres.links.items():
        assert np.array_equal(read.links[link], spheres)


def test_srdf(tmp_path, robot):
    path = tmp_path / "arm.srdf"
    path.write_text(
        '<robot name="arm"><group name="all"><chain base_link="base" tip_link="hand"/></group>'
        '<group_state name="up" group="all"><joint name="wrist" value="1"/></group_state>'
        '<end_effector name="gripper" group="all" parent_link="hand"/>'
        '<disable_collisions link1="base" link2="fore" reason="Never"/></robot>'
    )
    semantics = spherule.read_srdf(path)
    assert semantics.groups[0].chains == (("base", "hand"),)
    assert semantics.group_states[0].joints == {"wrist": (1.0,)}
    assert semantics.end_effectors[0].parent_link == "hand"
    allowed = spherule.AllowedCollisions(robot)
    assert allowed.allows("base", "upper") and not allowed.allows("base", "fore")
    allowed.allow_pairs(semantics.disabled_pairs)
    assert ("base", "fore", "given") in allowed.pairs()
    allowed.forbid("base", "fore")
    assert allowed.allow_sampled(configurations=50) == 50
    path.write_text(
        '<robot name="arm"><disable_default_collisions link="base"/><wings/>'
        '<enable_collisions link1="base" link2="fore"/></robot>'
    )
    semantics = spherule.read_srdf(path)
    assert semantics.links_disabled_by_default == ("base",)
    assert semantics.enabled_pairs == (("base", "fore"),)
    assert "<wings>" in semantics.warnings[0]
    of_moveit = spherule.AllowedCollisions(robot)
    of_moveit.apply(semantics)
    assert ("base", "hand", "given") in of_moveit.pairs()
    assert not of_moveit.allows("base", "fore")
    scene = spherule.RobotScene(robot)
    scene.set_allowed_collisions(allowed)
    assert scene.allowed_collisions.pairs() == allowed.pairs()
    allowed.allow_all()
    allowed.forbid("base", "hand")
    allowed.allow("base", "hand")
    assert scene.reason("base", "upper") == "adjacent"


def test_scenes_are_edited(robot):
    scene = spherule.RobotScene(robot)
    scene.allow_contact("left", "right")
    q = np.zeros(4)
    assert scene.snapshot().check_config(q)
    scene.add("block", spherule.Box((0.2, 0.2, 0.2)), Pose((0, 0, 0.9)))
    checker = scene.snapshot()
    assert not checker.check_config(q) and scene.obstacles == ("block",)
    contacts = checker.explain(q)
    assert {c.second.name for c in contacts} == {"block"} and contacts[0].first.kind == "link"
    assert len(checker.explain(q, max_contacts=1)) == 1 and contacts[0].second.sphere == -1
    scene.move("block", Pose((2, 0, 0)))
    assert scene.snapshot().check_config(q) and not checker.check_config(q)
    scene.remove("block")
    scene.attach("tool", "hand", spherule.build_tree([[0, 0, 0.1, 0.01]]))
    assert scene.attached == ("tool",)
    assert not scene.snapshot().check_config(q)
    scene.allow_contact("tool", "hand")
    scene.allow_contact("tool", "left")
    scene.allow_contact("tool", "right")
    assert scene.snapshot().check_config(q)
    scene.forbid_contact("tool", "hand")
    scene.detach("tool")
    assert scene.snapshot(enforce_limits=True).check_config(q)
    assert not scene.snapshot(enforce_limits=True).check_config([0, 0, 3, 0])


def test_many_are_as_one(checker, robot):
    configurations = random_configurations(robot, 400, 1)
    free = checker.check_configs(configurations)
    assert free.dtype == np.bool_ and 0.1 < free.mean() < 0.9
    assert free.tolist() == [checker.check_config(q) for q in configurations]
    assert np.array_equal(checker.check_configs(configurations, threads=2), free)
    assert free.tolist() == [not checker.explain(q) for q in configurations]
    bounds = checker.clearances(configurations)
    assert np.all(bounds[free, 1] > 0) and np.all(bounds[~free, 0] == 0)
    some = checker.clearance(configurations[7])
    assert (some.lower, some.upper) == tuple(bounds[7])
    other = checker.check_edges(configurations[:-1], configurations[1:], threads=2)
    edges = checker.check_edges(configurations[:-1], configurations[1:])
    assert np.array_equal(edges.verdict, other.verdict) and edges.free.any()
    assert not edges.free[~free[1:]].any() and not edges.free[~free[:-1]].any()
    one = checker.check_edge(configurations[0], configurations[1])
    assert one.verdict == edges.verdict[0]


def test_instructions_change_no_answer(scene, checker, robot):
    configurations = random_configurations(robot, 500, 2)
    portable = scene.snapshot(instructions="portable")
    assert np.array_equal(portable.check_configs(configurations), checker.check_configs(configurations))


def test_turns_go_the_shorter_way(checker):
    start, end = np.array([3.0, 0, 0, 0]), np.array([-3.0, 0, 0, 0])
    given = checker.check_edge(start, end)
    shorter = checker.check_edge(start, end, continuous="shortest")
    assert shorter.configurations <= given.configurations


def test_link_pairs(description, robot, tmp_path):
    pairs = spherule.prove_link_pairs(description, boxes=200, undecided_boxes=200, samples=20)
    told = pairs.pairs(robot)
    assert len(told) == len(pairs) > 3 and {p.verdict for p in told} <= {"never", "touching", "unknown"}
    path = tmp_path / "arm.pairs"
    spherule.save_link_pairs(pairs, path)
    assert spherule.load_link_pairs(path, description).pairs(robot) == told
    scene = spherule.RobotScene(robot)
    scene.set_link_pairs(pairs)
    never = [p for p in told if p.verdict == "never"]
    if never:
        assert scene.reason(never[0].first, never[0].second) in ("proved never", "adjacent", "rigid")
    scene.set_link_pairs(None)


def test_confirmed_on_triangles(cube, fit):
    tree = spherule.sphere_tree(fit)
    covered = spherule.CoveredMesh(cube, tree)
    robot = spherule.RobotModel()
    robot.add_link("car", "base_link", Joint("x", "prismatic", axis=(1, 0, 0), lower=-9.0, upper=9.0))
    robot.attach("car", tree)
    scene = spherule.RobotScene(robot)
    scene.add("other", tree)
    plain, exact = scene.snapshot(), scene.snapshot(meshes=[covered])
    assert not plain.check_config([1.01]) and exact.check_config([1.01])
    assert not exact.check_config([0.99])


def test_scene_files_and_trajectories(robot, tmp_path):
    path = tmp_path / "cell.json"
    path.write_text(
        '{"format":"spherule-scene","version":1,"obstacles":['
        '{"name":"block","box":{"size":[0.2,0.2,0.2]},"pose":{"position":[0,0,0.9]}}]}'
    )
    scene, warnings = spherule.prepare_scene(robot, path)
    assert scene.obstacles == ("block",) and warnings == ()
    csv = tmp_path / "path.csv"
    csv.write_text("0 0 0 0\n90 0 0 0.01\n")
    read = spherule.read_trajectory(csv, robot, angles="degrees")
    assert read.shape == (2, 4) and read[1, 0] == pytest.approx(np.pi / 2) and read[1, 3] == 0.01
