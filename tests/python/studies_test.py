# SPDX-License-Identifier: BSD-3-Clause
"""Studies give what one call gives, on threads, on processes of Dask, and after they were ended."""

import copy
import json
import os
import pickle
import signal
import subprocess
import sys
import types
import warnings

import numpy as np
import pytest
import spherule
from conftest import make_cube, random_configurations
from spherule import studies

COUNT = 3000
CHUNK = 256


@pytest.fixture(scope="session")
def client():
    """Two processes of one thread each, once for all tests."""
    pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Debian's Dask, with its Tornado and msgpack
        from distributed import Client, LocalCluster

        with LocalCluster(2, threads_per_worker=1, dashboard_address=None, memory_limit=0) as cluster:
            with Client(cluster) as client:
                yield client


@pytest.fixture(params=["threads", "dask"])
def where(request):
    """Options that say where a study runs."""
    return {"client": request.getfixturevalue("client")} if request.param == "dask" else {"threads": 3}


@pytest.fixture(scope="module")
def configurations(robot):
    return random_configurations(robot, COUNT, 21)


def make_rows(rng, count):
    return rng.uniform(-2, 2, (count, 4))


def test_configurations_of_an_array(checker, configurations, where):
    study = studies.check_configs(checker, configurations, chunk=CHUNK, **where)
    expected = checker.check_configs(configurations)
    assert np.array_equal(study.free, expected)
    assert study.free_count == expected.sum() and len(study) == COUNT
    assert [len(part) for part in study.parts()] == [CHUNK] * (COUNT // CHUNK) + [COUNT % CHUNK]


def test_configurations_of_a_file(checker, configurations, where, tmp_path):
    np.save(tmp_path / "rows.npy", configurations)
    study = studies.check_configs(checker, tmp_path / "rows.npy", chunk=CHUNK, **where)
    assert np.array_equal(study.free, checker.check_configs(configurations))


def test_configurations_of_a_generator(checker, robot, where):
    rows = studies.uniform_configurations(robot, COUNT, seed=5)
    study = studies.check_configs(checker, rows, chunk=CHUNK, **where)
    assert np.array_equal(study.free, checker.check_configs(rows.rows(0, COUNT)))
    assert 0.05 < study.free.mean() < 0.95


def test_generated_rows_depend_on_seed_and_block_alone():
    rows = studies.GeneratedRows(make_rows, 1000, 3, block=64)
    whole = rows.rows(0, 1000)
    pieces = [rows.rows(first, min(77, 1000 - first)) for first in range(0, 1000, 77)]
    assert np.array_equal(np.concatenate(pieces), whole)
    assert np.array_equal(whole[64:128], make_rows(np.random.default_rng([3, 1]), 64))
    assert np.array_equal(studies.GeneratedRows(make_rows, 700, 3, block=64).rows(0, 700), whole[:700])
    assert not np.array_equal(studies.GeneratedRows(make_rows, 1000, 4, block=64).rows(0, 1000), whole)


def test_configurations_of_parquet(checker, configurations, monkeypatch, tmp_path):
    """pyarrow is in no package of Debian 12: its part that is used is played by this."""

    class File:
        metadata = types.SimpleNamespace(
            num_rows=COUNT, num_columns=4, num_row_groups=3, row_group=lambda i: types.SimpleNamespace(num_rows=COUNT // 3)
        )

        def __init__(self, path):
            assert path.endswith("rows.parquet")

        def read_row_group(self, group):
            part = configurations[group * COUNT // 3 : (group + 1) * COUNT // 3]
            return types.SimpleNamespace(columns=list(part.T))

    (tmp_path / "rows.parquet").touch()
    with pytest.raises(spherule.Error, match="pyarrow"):
        monkeypatch.setitem(sys.modules, "pyarrow", None)
        studies.check_configs(checker, tmp_path / "rows.parquet")
    monkeypatch.setitem(sys.modules, "pyarrow", types.ModuleType("pyarrow"))
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", types.SimpleNamespace(ParquetFile=File))
    study = studies.check_configs(checker, tmp_path / "rows.parquet", chunk=CHUNK)
    assert np.array_equal(study.free, checker.check_configs(configurations))


def test_edges(checker, configurations, where, tmp_path):
    path = configurations[:600]
    expected = checker.check_edges(path[:-1], path[1:], first=True)
    study = studies.check_edges(checker, (path[:-1], path[1:]), first=True, chunk=100, **where)
    assert study.results == expected
    assert study.counts == tuple((expected.verdict == v).sum() for v in spherule.Verdict)
    np.save(tmp_path / "edges.npy", np.stack([path[:-1], path[1:]], axis=1))
    assert studies.check_edges(checker, tmp_path / "edges.npy", first=True, chunk=70, **where).results == expected


def test_which_contact_is_told_depends_on_the_chunk_alone(checker, configurations, where):
    path = configurations
    chunks = [(path[first : first + 500], path[first + 1 : first + 501]) for first in range(0, COUNT, 500)]
    found = studies.check_edges(checker, (path[:-1], path[1:]), chunk=500, **where).results
    for i, (start, end) in enumerate(chunks):
        fresh = copy.copy(checker).check_edges(start[: len(end)], end)
        part = slice(500 * i, 500 * (i + 1))
        assert spherule.EdgeResults(found.verdict[part], found.free_until[part], found.contact_at[part]) == fresh


def test_edges_have_options(checker, configurations):
    path = configurations[:50]
    options = {"resolution": 0.05, "first": True, "continuous": "shortest"}
    study = studies.check_edges(checker, (path[:-1], path[1:]), chunk=7, **options)
    assert study.results == checker.check_edges(path[:-1], path[1:], **options)
    with pytest.raises(spherule.Error, match="continuous"):
        studies.check_edges(checker, (path[:-1], path[1:]), continuous="longest")


def postures_of(pose):
    """No inverse of this arm, but a function of the pose: as many postures as its x says."""
    rng = np.random.default_rng(int(1e6 * abs(pose[0, 0])) + int(1e3 * pose[2, 3]))
    return rng.uniform(-2, 2, (int(pose[0, 3]), 4))


def test_reachability(checker, where, tmp_path):
    poses = np.tile(np.eye(4), (40, 1, 1))
    poses[:, 0, 3] = np.arange(40) % 4
    poses[:, 2, 3] = np.arange(40)
    turns = [0.0, 0.5, 1.0]
    found = studies.reachability(checker, poses, postures_of, turns=turns, chunk=7, **where)
    padded = np.full((40, 3, 4, 4), np.nan)
    for i, pose in enumerate(poses):
        for j, angle in enumerate(turns):
            turn = spherule.Pose(rotation=(0, 0, np.sin(angle / 2), np.cos(angle / 2))).matrix
            postures = postures_of(pose @ turn)
            free = [checker.check_config(q) for q in postures]
            assert found.found[i, j] == len(postures) and found.free[i, j] == sum(free)
            assert found.posture[i, j] == (free.index(True) if any(free) else -1)
            padded[i, j, : len(postures)] = postures
    assert np.array_equal(found.reachable, found.free.max(axis=1) > 0)
    assert 0 < found.reachable.sum() < 40
    assert studies.reachability(checker, None, padded, turns=turns, chunk=7, **where) == found
    stored = tmp_path / "postures.npy"
    np.save(stored, padded)
    assert studies.reachability(checker, None, stored, turns=turns, chunk=7, **where) == found
    for array in (padded.transpose(0, 2, 1, 3), padded.reshape(40, -1)):
        np.save(stored, array)
        with pytest.raises(spherule.Error, match="its shape is"):
            studies.reachability(checker, None, stored, turns=turns, **where)


def test_inverses_of_one_name_are_told_apart(checker, tmp_path):
    def shifted(by):
        return lambda pose: np.full((2, 4), by)

    studies.reachability(checker, np.eye(4)[None], shifted(0.1), output=tmp_path)
    with pytest.raises(spherule.Error, match="another study"):
        studies.reachability(checker, np.eye(4)[None], shifted(0.2), output=tmp_path)


def test_parts(where, tmp_path):
    cubes = [tmp_path / f"cube{i}.stl" for i in range(3)]
    for i, path in enumerate(cubes):
        spherule.write_stl(make_cube(0.8 + 0.1 * i), path)
    (tmp_path / "broken.stl").write_text("no mesh")
    parts = [*cubes, tmp_path / "broken.stl"]
    options = {"max_error": 0.4, "effort": 0}
    found = studies.cover_parts(parts, output=tmp_path / "covers", **options, **where)
    assert list(found) == ["cube0", "cube1", "cube2", "broken"]
    for i, path in enumerate(cubes):
        assert found[f"cube{i}"].file == spherule.simplify(path, **options).file
        assert spherule.load_spheres(tmp_path / "covers" / f"cube{i}.json") == found[f"cube{i}"].file
        assert found[f"cube{i}"].covered
    assert "broken.stl" in found["broken"].error and not found["broken"].covered

    # A part that has changed is made again, others are not.
    spherule.write_stl(make_cube(1.2), cubes[1])
    made = []
    again = studies.cover_parts(
        cubes, output=tmp_path / "covers", progress=lambda share, name: made.append(name), **options, **where
    )
    assert made == ["cube1"]
    assert again["cube1"].file == spherule.simplify(cubes[1], **options).file
    assert again["cube0"] == found["cube0"]


def test_covers_of_others_stay(tmp_path):
    """What is there and of no study is never overwritten; what was cut is made again."""
    (tmp_path / "a.json").write_text("precious")
    with pytest.raises(spherule.Error, match="not of this study"):
        studies.cover_parts({"a": make_cube()}, output=tmp_path, max_error=0.4, effort=0)
    assert (tmp_path / "a.json").read_text() == "precious"
    (tmp_path / "a.json").unlink()
    options = {"output": tmp_path, "max_error": np.float64(0.4), "effort": 0}
    found = studies.cover_parts({"a": make_cube()}, **options)
    whole = (tmp_path / "a.json").read_bytes()
    (tmp_path / "a.json").write_bytes(whole[: len(whole) // 2])
    assert studies.cover_parts({"a": make_cube()}, **options) == found
    assert (tmp_path / "a.json").read_bytes() == whole


def test_meshes_by_name():
    found = studies.cover_parts({"a": make_cube(), "b": make_cube(1.1)}, max_error=0.4, effort=0)
    assert np.array_equal(found["b"].file.spheres, spherule.simplify(make_cube(1.1), max_error=0.4, effort=0).spheres)
    with pytest.raises(spherule.Error, match="named cube"):
        studies.cover_parts(["a/cube.stl", "b/cube.stl"])
    with pytest.raises(TypeError):
        studies.cover_parts({"a": make_cube()}, wrong=3)


class Enough(Exception):
    pass


def test_a_run_that_was_ended_goes_on(checker, configurations, where, tmp_path):
    """What is there is not made again: it is put there as no check would find it."""
    shares = []

    def enough(share, what):
        shares.append(share)
        if share > 0.4:
            raise Enough

    with pytest.raises(Enough):
        studies.check_configs(checker, configurations, chunk=CHUNK, output=tmp_path, progress=enough, **where)
    there = sorted(tmp_path.glob("part-*.npy"))
    assert 5 <= len(there) <= 6 and shares == sorted(shares)
    np.save(there[0], ~np.load(there[0]))
    there[1].write_bytes(there[1].read_bytes()[:-1])
    shares.clear()
    study = studies.check_configs(
        checker, configurations, chunk=CHUNK, output=tmp_path, progress=lambda share, what: shares.append(share), **where
    )
    first = int(there[0].stem[-8:]) * CHUNK
    expected = checker.check_configs(configurations)
    expected[first : first + CHUNK] ^= True
    assert np.array_equal(study.free, expected)
    assert shares[0] > 0.3 and shares[-1] == 1.0
    assert not list(tmp_path.glob(".*"))


def test_a_folder_is_of_one_study(checker, scene, configurations, tmp_path):
    studies.check_configs(checker, configurations, output=tmp_path, chunk=CHUNK)
    for other in ({"chunk": 100}, {"configurations": configurations[::-1]}, {"checker": scene.snapshot(enforce_limits=True)}):
        arguments = {"checker": checker, "configurations": configurations, "chunk": CHUNK, **other}
        with pytest.raises(spherule.Error, match="another study"):
            studies.check_configs(**arguments, output=tmp_path)
    # Parts of another shape or type, and what a killed run left.
    parts = sorted(tmp_path.glob("part-*.npy"))
    np.save(parts[0], np.ones(CHUNK) * 0.5)
    np.save(parts[1], np.array(5))
    (tmp_path / ".part-00000003.npy.77").write_text("cut")
    again = studies.check_configs(checker, configurations, output=tmp_path, chunk=np.int64(CHUNK))
    assert np.array_equal(again.free, checker.check_configs(configurations))
    assert not list(tmp_path.glob(".*"))
    content = json.loads((tmp_path / "study.json").read_text())
    (tmp_path / "study.json").unlink()
    with pytest.raises(spherule.Error, match="no study.json"):
        studies.check_configs(checker, configurations[::-1], output=tmp_path, chunk=CHUNK)
    assert content["count"] == COUNT and content["kind"] == "configurations"


KILLED = """
import os, pickle, signal, sys
from spherule import studies

def kill(share, what):
    if share > 0.5:
        os.kill(os.getpid(), signal.SIGKILL)

with open(sys.argv[1], "rb") as file:
    checker = pickle.load(file)
studies.check_configs(checker, sys.argv[2], chunk=256, threads=2, output=sys.argv[3], progress=kill)
"""


def test_a_killed_process_goes_on(checker, configurations, tmp_path):
    """The checker of another process is taken for the same one: its numbers are."""
    np.save(tmp_path / "rows.npy", configurations)
    (tmp_path / "checker").write_bytes(pickle.dumps(checker))
    arguments = [str(tmp_path / name) for name in ("checker", "rows.npy", "results")]
    process = subprocess.run([sys.executable, "-c", KILLED, *arguments])
    assert process.returncode == -signal.SIGKILL
    there = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "results").glob("part-*.npy")}
    assert 6 <= len(there) <= 7
    study = studies.check_configs(checker, tmp_path / "rows.npy", chunk=CHUNK, output=tmp_path / "results")
    assert np.array_equal(study.free, checker.check_configs(configurations))
    assert all((tmp_path / "results" / name).stat().st_mtime_ns == time for name, time in there.items())


class FailAtFirst:
    """A generator that fails at first, as disks and networks do."""

    def __init__(self, failures):
        self.failures = failures

    def __call__(self, rng, count):
        if count > 1 and self.failures > 0:
            self.failures -= 1
            raise OSError("no disk")
        return make_rows(rng, count)


def test_chunks_that_fail_are_tried_again(checker):
    expected = checker.check_configs(studies.GeneratedRows(make_rows, 1000, 3, block=100).rows(0, 1000))
    for failures in (1, 4):
        rows = studies.GeneratedRows(FailAtFirst(failures), 1000, 3, block=100)
        options = {"chunk": 1000, "threads": 1, "retries": 3}
        if failures == 1:
            assert np.array_equal(studies.check_configs(checker, rows, **options).free, expected)
        else:
            with pytest.raises(OSError, match="no disk"):
                studies.check_configs(checker, rows, **options)


def test_input_that_cannot_be_used(checker, tmp_path):
    (tmp_path / "text.npy").write_text("no array")
    with pytest.raises(spherule.Error, match="no array"):
        studies.check_configs(checker, tmp_path / "text.npy")
    with pytest.raises(spherule.Error, match="no such file"):
        studies.check_configs(checker, tmp_path / "none.npy")
    with pytest.raises(spherule.Error, match="5 numbers a row, 4 are needed"):
        studies.check_configs(checker, np.zeros((3, 5)))
    with pytest.raises(spherule.Error, match="it has no rows"):
        studies.check_configs(checker, np.zeros(4))
    with pytest.raises(spherule.Error, match="chunk"):
        studies.check_configs(checker, np.zeros((3, 4)), chunk=0)
    for option in ("threads", "retries"):
        with pytest.raises(spherule.Error, match=f"{option}: -1"):
            studies.check_configs(checker, np.zeros((3, 4)), **{option: -1})
        with pytest.raises(spherule.Error, match=f"{option}: -1"):
            studies.cover_parts({}, **{option: -1})
    with pytest.raises(spherule.Error, match="of starts 3"):
        studies.check_edges(checker, (np.zeros((3, 4)), np.zeros((2, 4))))
    with pytest.raises(spherule.Error, match="an inverse needs"):
        studies.reachability(checker, None, postures_of)
    with pytest.raises(spherule.Error, match="is needed"):
        studies.reachability(checker, None, np.zeros((3, 2, 1, 4)), turns=[0.0])
    assert len(studies.check_configs(checker, np.zeros((0, 4))).free) == 0
    assert studies.check_edges(checker, np.zeros((0, 8))).counts == (0, 0, 0)


def test_two_runs_do_not_share_a_folder(checker, configurations, tmp_path):
    def second(share, what):
        studies.check_configs(checker, configurations, output=tmp_path)

    with pytest.raises(spherule.Error, match="another run"):
        studies.check_configs(checker, configurations, output=tmp_path, progress=second)


def test_a_killed_worker_loses_nothing(checker, configurations, client, monkeypatch, tmp_path):
    """The last test with the cluster: whether its nanny brings the worker back is not asked."""
    monkeypatch.setattr(studies._engines, "PATIENCE", 1.0)
    pids = list(client.run(os.getpid).values())
    assert len(pids) == 2
    shares = []

    def kill(share, what):
        shares.append(share)
        if share > 0.3 and len(pids) == 2:
            os.kill(pids.pop(), signal.SIGKILL)

    study = studies.check_configs(
        checker, configurations, chunk=64, client=client, output=tmp_path / "results", progress=kill
    )
    assert len(pids) == 1
    assert np.array_equal(study.free, checker.check_configs(configurations))
    assert len(shares) == len(set(shares)) == len(list((tmp_path / "results").glob("part-*.npy"))) == -(-COUNT // 64)
