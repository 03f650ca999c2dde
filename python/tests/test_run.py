"""Run directories: the bytes of the program, resume, what ends a run, exports, pictures."""

import csv
import json
import subprocess
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import flag_tables, shell_tables

import muslin

FILES = ("flag.skin.obj", "flag.skin.pc2", "flag.contour.pc2", "flag.lattice.pc2", "probes.csv", "scene.toml", "stats.json")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A run of the flag of eight frames."""
    directory = tmp_path_factory.mktemp("runs") / "flag"
    muslin.run(muslin.make_scene(flag_tables()), directory, frames=8)
    return directory


def test_writes_the_bytes_of_the_program(source, program, tmp_path):
    scene = source / "scenes/thesis/2_two_corners.toml"
    subprocess.run([program, "run", scene, "-o", tmp_path / "program", "--frames", "4", "--quiet"], check=True)
    seen = []
    result = muslin.run(muslin.read_scene(scene), tmp_path / "python", frames=4, progress=seen.append)
    assert (result.first_frame, result.last_frame, result.changes, result.warnings) == (0, 4, [], [])
    for name in FILES:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    assert (seen[-1].frame, seen[-1].total, seen[-1].fraction, seen[-1].stage) == (4, 4, 1, "simulation")
    assert seen[-1].seconds_left == 0


def test_a_stopped_run_goes_on_to_the_same_bytes(tmp_path, finished):
    scene = muslin.make_scene(flag_tables())
    frames = []

    class Enough(Exception):
        pass

    def stop_at(number, how):
        def progress(now):
            if now.frame >= number:
                how()

        return progress

    def fail():
        raise Enough

    directory = tmp_path / "run"
    with pytest.raises(Enough):
        muslin.run(scene, directory, frames=8, progress=stop_at(2, fail))
    assert muslin.Run(directory).status == "interrupted"
    with pytest.raises(muslin.Interrupted):
        muslin.run(scene, directory, frames=8, resume=True, progress=stop_at(4, lambda: frames.append(1)), cancel=lambda: bool(frames))
    assert muslin.Run(directory).status == "interrupted"

    def press():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        muslin.run(scene, directory, frames=8, resume=True, progress=stop_at(6, press))
    assert muslin.Run(directory).status == "interrupted"
    result = muslin.run(scene, directory, frames=8, resume=True)
    assert result.first_frame == 6
    assert muslin.Run(directory).status == "finished"
    for name in FILES:
        assert (directory / name).read_bytes() == (finished / name).read_bytes(), name


def test_a_run_goes_back_to_any_frame_of_kept_states(tmp_path, finished):
    scene = muslin.make_scene(flag_tables())
    muslin.run(scene, tmp_path / "run", frames=6, keep_states=True)
    assert muslin.run(scene, tmp_path / "run", frames=8, resume_from=2, keep_states=True).first_frame == 2
    for name in FILES:
        assert (tmp_path / "run" / name).read_bytes() == (finished / name).read_bytes(), name
    simulation = muslin.Simulation(scene)
    with muslin.RunWriter(tmp_path / "run", simulation, frames=8, resume_from=2) as writer:
        assert simulation.frame == 2
        simulation.advance()
        writer.write_frame()
    assert muslin.Run(tmp_path / "run").frame_count == 4
    for frame in (-1, 77):
        with pytest.raises(muslin.Error):
            muslin.run(scene, tmp_path / "run", resume_from=frame)


def test_reads_all_there_is(finished):
    run = muslin.Run(finished)
    assert (run.title, run.status, run.frame_rate, run.frame_count, run.bodies) == ("flag", "finished", 24, 9, ["flag"])
    assert run.directory == finished
    assert run.last_frame == 8
    assert run.colour().shape == (3,) and (run.colour("flag") <= 1).all()
    assert run.scene["time"]["duration"] == 2
    assert run.has_lattice() and not run.is_collider("flag")
    assert run.mesh().face_count == 60
    assert muslin.is_closed(run.mesh("flag", surface="contour"))
    points = run.points(3)
    assert points.dtype == np.float32 and points.shape == (77, 3) and points.flags.writeable
    assert np.array_equal(run.points(-1), run.points(8))
    central = (run.points(4) - run.points(2)) * 12
    assert np.allclose(run.velocities(3), central, atol=1e-4)
    assert np.allclose(run.lattice_velocities(3), (run.lattice_points(4) - run.lattice_points(2)) * 12, atol=1e-4)
    assert run.lattice_voxels().shape == (60, 8)
    assert np.allclose(run.lattice_points(0), run.lattice_rest_positions())
    with open(finished / "diagnostics.csv") as table:
        rows = list(csv.DictReader(table))
    for name in ("kinetic", "elastic", "max_stretch", "min_distance", "steps", "converged_steps", "error", "unbalanced",
                 "crossings", "held_back", "penetration", "behind"):
        assert run.diagnostics[name].tolist() == [float(row[name]) for row in rows]
    assert json.loads((finished / "run.json").read_text())["title"] == run.title
    assert "9 frames" in repr(run)


def test_refuses_what_is_not_there(finished, tmp_path):
    run = muslin.Run(finished)
    for frame in (9, -10):
        with pytest.raises(muslin.UsageError, match="no frame"):
            run.points(frame)
    with pytest.raises(muslin.UsageError, match="did you mean `flag`"):
        run.points(0, "flog")
    with pytest.raises(muslin.UsageError, match="surface"):
        run.points(0, surface="fur")
    with pytest.raises(muslin.FileError, match="no run here"):
        muslin.Run(tmp_path)
    with pytest.raises(muslin.UsageError):
        muslin.run(muslin.make_scene(flag_tables()), tmp_path / "x", frames=-2)
    (tmp_path / "file").write_text("")
    with pytest.raises(muslin.FileError):
        muslin.run(muslin.make_scene(flag_tables()), tmp_path / "file" / "run")


def test_writer_takes_a_simulation_with_forces(tmp_path):
    def simulate():
        simulation = muslin.Simulation(muslin.make_scene(flag_tables(time={"duration": 0.25, "steps_per_frame": 2})))
        simulation.add_force(lambda x, v, t: np.tile([0, 0, 2.0], (len(x), 1)), name="blow")
        return simulation

    simulation = simulate()
    with muslin.RunWriter(tmp_path / "a", simulation) as writer:
        assert not writer.resumed
        for _ in simulation:
            writer.write_frame()
    run = muslin.Run(tmp_path / "a")
    assert (run.status, run.frame_count) == ("finished", 7)
    assert np.array_equal(run.points(-1), simulation.points().astype(np.float32))

    stopped = simulate()
    with pytest.raises(ZeroDivisionError), muslin.RunWriter(tmp_path / "b", stopped) as writer:
        for frame in stopped:
            writer.write_frame()
            if frame == 2:
                1 / 0  # noqa: B018
    assert muslin.Run(tmp_path / "b").status == "failed"
    again = simulate()
    with muslin.RunWriter(tmp_path / "b", again, resume=True) as writer:
        assert writer.resumed and writer.changes == []
        assert again.frame == 2
        for _ in again:
            writer.write_frame()
    for name in FILES:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name


def test_writer_says_how_a_run_ended(tmp_path, flag):
    simulation = flag()
    with muslin.RunWriter(tmp_path / "early", simulation):
        pass
    assert muslin.Run(tmp_path / "early").status == "interrupted"
    with pytest.raises(KeyboardInterrupt), muslin.RunWriter(tmp_path / "early", flag()):
        raise KeyboardInterrupt
    assert muslin.Run(tmp_path / "early").status == "interrupted"
    writer = muslin.RunWriter(tmp_path / "by hand", simulation, frames=0)
    writer.finish("finished")
    assert muslin.Run(tmp_path / "by hand").status == "finished"
    for use in (writer.write_frame, writer.finish, lambda: writer.resumed):
        with pytest.raises(muslin.UsageError, match="closed"):
            use()
    with pytest.raises(muslin.UsageError, match="status"):
        muslin.RunWriter(tmp_path / "odd", simulation, frames=0).finish("done")
    with muslin.RunWriter(tmp_path / "locked", flag()), pytest.raises(muslin.FileError):
        muslin.RunWriter(tmp_path / "locked", flag())


@pytest.mark.parametrize("suffix", ["pc2", "mdd", "glb", "usda", "obj", "ply", "vtu"])
def test_exports(finished, tmp_path, suffix):
    seen = []
    muslin.export_run(
        muslin.Run(finished), tmp_path / f"flag.{suffix}", progress=lambda fraction, stage: seen.append(fraction)
    )
    assert any(path.stat().st_size > 100 for path in tmp_path.iterdir())
    assert seen == sorted(seen)
    if suffix == "pc2":
        assert (tmp_path / "flag.pc2").read_bytes() == (finished / "flag.skin.pc2").read_bytes()


def test_finished_exports(finished, tmp_path):
    run = muslin.Run(finished)
    muslin.export_run(run, tmp_path / "plain.obj")
    muslin.export_run(run, tmp_path / "fine.obj", smooth=1, subdivide=1, thickness=0.001)
    report = muslin.export_run(run, tmp_path / "carried.obj", carry=tmp_path / "plain.0000.obj")
    assert report["frames_crossing"] == 0
    lines = {name: (tmp_path / f"{name}.0001.obj").read_text().count("\nf ") for name in ("plain", "fine", "carried")}
    assert lines["fine"] >= 8 * lines["plain"]
    assert lines["carried"] == lines["plain"]
    with pytest.raises(muslin.UsageError, match="0 to 8"):
        muslin.export_run(run, tmp_path / "fine.obj", subdivide=9)


def test_exports_that_cannot_be(finished, tmp_path):
    run = muslin.Run(finished)
    with pytest.raises(muslin.UsageError, match=r"\.xyz"):
        muslin.export_run(run, tmp_path / "flag.xyz")
    with pytest.raises(muslin.FileError):
        muslin.export_run(run, tmp_path / "none" / "flag.pc2")
    with pytest.raises(muslin.Interrupted):
        muslin.export_run(run, tmp_path / "flag.glb", cancel=lambda: True)
    assert list(tmp_path.iterdir()) == []


def test_pictures_and_plots(finished, tmp_path):
    pictures = muslin.RunPictures(finished, size=(160, 90), samples=1, stretch=True)
    assert (pictures.frame_count, pictures.frame_rate) == (9, 24)
    first, last = pictures.draw(0), pictures.draw(-1)
    assert first.shape == (90, 160, 3) and first.dtype == np.uint8
    assert np.ptp(first) > 50
    assert not np.array_equal(first, last)
    pictures.write(tmp_path / "last.png")
    assert (tmp_path / "last.png").read_bytes().startswith(b"\x89PNG")
    pictures.write(tmp_path / "frames")
    assert len(list((tmp_path / "frames").iterdir())) == 9
    pictures.write(tmp_path / "movie.mp4")
    assert (tmp_path / "movie.mp4").stat().st_size > 500
    with pytest.raises(muslin.UsageError, match="no frame"):
        pictures.draw(9)
    with pytest.raises(muslin.UsageError):
        pictures.write(tmp_path / "last.gif")
    for wrong in ({"size": (0, 10)}, {"samples": 0}, {"elevation": 100.0}, {"surface": "fur"}, {"body": "flog"}):
        with pytest.raises(muslin.UsageError):
            muslin.RunPictures(finished, **wrong)
    with pytest.raises(muslin.FileError):
        muslin.RunPictures(tmp_path / "none")
    muslin.write_run_plots(muslin.Run(finished))
    assert (finished / "energy.svg").read_text().startswith("<")


def test_a_page_for_browsers(finished, tmp_path):
    report = muslin.write_view(muslin.Run(finished), tmp_path / "flag.html")
    assert report.frames == 9 and report.notes == []
    assert report.bytes == (tmp_path / "flag.html").stat().st_size
    assert (tmp_path / "flag.html").read_text().lower().startswith("<!doctype html>")
    for size in (0, -1, float("nan")):
        with pytest.raises(muslin.UsageError):
            muslin.write_view(muslin.Run(finished), tmp_path / "flag.html", max_size=size)


def test_a_report_says_what_was_kept(finished, tmp_path):
    seen = []
    run = muslin.Run(finished)
    report = muslin.write_report(run, tmp_path / "flag.html", json=tmp_path / "flag.json", junit=tmp_path / "flag.xml",
                                 pictures=False, progress=lambda fraction, stage: seen.append(stage))
    assert report == json.loads((tmp_path / "flag.json").read_text())
    assert report["run"]["frames"] == 9 and report["verdict"]["broken"] == 0
    assert {p["key"] for p in report["promises"]} >= {"complete", "energy_closes", "nothing_crosses"}
    assert (tmp_path / "flag.html").read_text().startswith("<!doctype html>")
    suite = ElementTree.parse(tmp_path / "flag.xml").getroot()[0]
    assert suite.get("failures") == "0" and len(suite) == int(suite.get("tests")) == len(report["promises"])
    assert "looking for crossings" in seen
    assert muslin.write_report(run)["promises"] == report["promises"]
    with pytest.raises(muslin.Interrupted):
        muslin.write_report(run, cancel=lambda: True)


def test_a_shell_has_neither_contour_nor_lattice(tmp_path):
    muslin.run(muslin.make_scene(shell_tables()), tmp_path / "cloth", frames=2)
    run = muslin.Run(tmp_path / "cloth")
    assert not run.has_lattice("cloth")
    assert run.points(2).shape == (49, 3)
    with pytest.raises(muslin.UsageError, match="contour"):
        run.points(0, surface="contour")
    for use in (run.lattice_voxels, run.lattice_rest_positions, lambda: run.lattice_points(0)):
        with pytest.raises(muslin.UsageError, match="no lattice"):
            use()
