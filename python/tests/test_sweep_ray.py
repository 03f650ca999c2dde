"""Sweeps on a Ray cluster of several local nodes, of which one is killed. `pip install ray` to run it."""

import csv
import json
import threading
import time

import pytest

import muslin

ray = pytest.importorskip("ray", reason="Ray is not installed: pip install muslin[sweep]")


@pytest.fixture
def cluster():
    """A head without CPUs and two nodes of one CPU each."""
    from ray.cluster_utils import Cluster

    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    yield made
    ray.shutdown()
    made.shutdown()


def table(directory):
    with open(directory / "table.csv", newline="") as text:
        return [row[:-1] for row in csv.reader(text)]  # the last column is a time


def test_a_node_is_killed_and_nothing_lost(source, cluster, tmp_path):
    # A run takes several seconds, which a node needs to die.
    tables = {
        "scene": str(source / "scenes/thesis/2_two_corners.toml"),
        "frames": 96,
        "pictures": False,
        "pages": [],
        "grid": {"time.steps_per_frame": [900, 1000], "force.0.acceleration.1": [-9.8, -5.0]},
    }
    doomed, _ = [cluster.add_node(num_cpus=1) for _ in range(2)]
    cluster.wait_for_nodes()
    ray.init(address=cluster.address, log_to_driver=False)
    hit = []

    def kill_when_both_work():
        """Kills a node once two runs are under way."""
        runs, end = tmp_path / "ray/runs", time.monotonic() + 60
        while time.monotonic() < end:
            begun = [run for run in runs.glob("*/diagnostics.csv") if run.read_text().count("\n") > 8]
            if len(begun) >= 2:
                hit.append(sorted(path.name for path in runs.glob("*.json")))
                cluster.remove_node(doomed, allow_graceful=False)
                return
            time.sleep(0.01)

    killer = threading.Thread(target=kill_when_both_work)
    killer.start()
    made = muslin.sweep(tables, tmp_path / "ray", ray=cluster.address)
    killer.join()
    assert hit and len(hit[0]) < 4
    assert made.column("exit_code") == [0] * 4 and made.column("frames") == [96] * 4
    sessions = [
        json.loads(file.read_text())["timings"]["sessions"] for file in tmp_path.glob("ray/runs/*/run.json")
    ]
    assert any(
        len(run) > 1 and run[-1]["from_frame"] > 0 for run in sessions
    )  # a run went on from its checkpoint
    muslin.sweep(tables, tmp_path / "alone")
    assert table(tmp_path / "ray") == table(tmp_path / "alone")


def test_a_cluster_that_is_not_there(source, tmp_path):
    scene = str(source / "scenes/thesis/2_two_corners.toml")
    with pytest.raises(muslin.Error, match=r"no Ray cluster at `127\.0\.0\.1:1`"):
        muslin.sweep(scene=scene, grid={"time.duration": [1]}, directory=tmp_path / "s", ray="127.0.0.1:1")
    with pytest.raises(muslin.UsageError, match="cluster's CPUs decide"):
        muslin.sweep(
            scene=scene, grid={"time.duration": [1]}, directory=tmp_path / "s", ray="local", workers=2
        )
