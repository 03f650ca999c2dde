"""Sweeps: points, table, what is continued, what is refused, the page, the command."""

import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import flag_tables

import muslin
import muslin.sweeps
from muslin.errors import Interrupted
from muslin.sweeps.description import read_description
from muslin.sweeps.directory import SweepDirectory
from muslin.sweeps.points import Span
from muslin.sweeps.processes import ProcessPool
from muslin.sweeps.sampling import unit_samples
from muslin.sweeps.source import from_python, read_file

GRAVITY, STEPS = "force.0.acceleration.1", "time.steps_per_frame"
FORCE = [{"type": "gravity", "acceleration": [0, -9.8, 0]}]
GRID = {GRAVITY: [-9.8, -5.0, -1.0], STEPS: [2, 4]}


@pytest.fixture(scope="module")
def flag_scene(source):
    return str(source / "scenes/thesis/2_two_corners.toml")


@pytest.fixture(scope="module")
def undisturbed(flag_scene, tmp_path_factory):
    """Six runs of eight frames."""
    return muslin.sweep(
        scene=flag_scene, frames=8, grid=GRID, directory=tmp_path_factory.mktemp("sweep") / "flag"
    )


def cells(directory: Path, without: tuple[str, ...] = ("wall_seconds",)) -> list[list[str]]:
    """The table, without the columns that are times."""
    with open(directory / "table.csv", newline="") as text:
        header, *rows = csv.reader(text)
    kept = [i for i, name in enumerate(header) if name not in without]
    return [[row[i] for i in kept] for row in [header, *rows]]


def test_each_row_is_what_a_run_alone_gives(undisturbed, flag_scene, tmp_path):
    assert [(row[GRAVITY], row[STEPS]) for row in undisturbed.rows] == [
        (g, s) for g in GRID[GRAVITY] for s in GRID[STEPS]
    ]
    assert undisturbed.column("exit_code") == [0] * 6 and undisturbed.failed == []
    scene = muslin.read_scene(flag_scene, [f"{GRAVITY}=-5.0", f"{STEPS}=4"])
    muslin.run(scene, tmp_path / "alone", frames=8)
    alone, row = muslin.Run(tmp_path / "alone"), undisturbed.rows[3]
    for name in ("kinetic", "elastic", "work", "max_stretch", "steps", "error"):
        assert row[name] == alone.diagnostics[name][-1], name
    assert row["largest_stretch"] == alone.diagnostics["max_stretch"].max()
    kept = json.loads((tmp_path / "alone/run.json").read_text())["convergence"]
    assert row["convergence.steps"] == kept["steps"] == 32
    assert row["convergence.frames_missed"] == len(kept["frames_missed"])
    with open(tmp_path / "alone/probes.csv") as table:
        last = list(csv.DictReader(table))[-1]
    assert row[f"probe.{last['name']}.y"] == float(last["y"])
    own = undisturbed.directory / "runs/0004"
    assert (own / "flag.skin.pc2").read_bytes() == (tmp_path / "alone/flag.skin.pc2").read_bytes()
    assert (own / "report.html").exists()


def test_table_file_has_all_rows(undisturbed):
    header, *rows = cells(undisturbed.directory, without=())
    assert header == undisturbed.columns and len(rows) == 6
    assert header[:5] == ["run", GRAVITY, STEPS, "status", "exit_code"] and header[-1] == "wall_seconds"
    assert float(rows[2][header.index("kinetic")]) == undisturbed.rows[2]["kinetic"]


def test_lists_grids_and_samples_multiply():
    source = from_python(
        {
            "scene": muslin.make_scene(flag_tables(force=FORCE)),
            "list": {"time": {"duration": [1, 2]}, STEPS: [3, 5]},
            "grid": {GRAVITY: [-1, -2, -3]},
            "sample": {"runs": 4, "keys": {"body": {"flag": {"voxel_width": {"from": 0.5, "to": 1}}}}},
        }
    )
    found = read_description(source)
    points = found.points()
    assert found.keys == ["time.duration", STEPS, GRAVITY, "body.flag.voxel_width"]
    assert len(points) == found.count == 2 * 3 * 4
    assert {(p["time.duration"], p[STEPS]) for p in points} == {(1, 3), (2, 5)}
    assert points == found.points()


@pytest.mark.parametrize("method", ["random", "latin_hypercube", "sobol"])
def test_samples_lie_in_the_cube_and_repeat(method):
    if method == "sobol":
        pytest.importorskip("scipy", reason="Sobol's points need scipy")
    drawn = unit_samples(method, 32, 3, seed=5)
    assert drawn == unit_samples(method, 32, 3, seed=5) != unit_samples(method, 32, 3, seed=6)
    assert all(0 <= u < 1 for row in drawn for u in row)
    if method != "random":  # one in each of the 32 intervals, of each dimension
        assert all(sorted(int(row[d] * 32) for row in drawn) == list(range(32)) for d in range(3))


def test_spans_reach_both_ends():
    assert [Span(2, 8).at(u) for u in (0, 0.5, 1)] == [2, 5, 8]
    assert Span(1e-6, 1e-2, logarithmic=True).at(0.5) == pytest.approx(1e-4)
    assert [Span(1, 3, whole=True).at(u) for u in (0, 0.34, 0.99, 1)] == [1, 2, 3, 3]
    assert [Span(choices=("a", "b")).at(u) for u in (0, 0.5, 1)] == ["a", "b", "b"]


def test_a_run_that_fails_is_a_row(flag_scene, tmp_path):
    listed = {"body.flag.voxel_width": [1.0, 1e-5, 1.0], "body.flag.thickness": [1, 1, 2]}
    made = muslin.sweep(scene=flag_scene, frames=1, list=listed, directory=tmp_path / "sweep")
    assert made.column("status") == ["finished", "failed", "finished"]
    failed = made.rows[1]
    assert (
        failed["exit_code"] in (3, 4)
        and "voxel width of 1e-05 m" in failed["message"]
        and failed["frames"] == 0
    )
    assert str(tmp_path) not in (tmp_path / "sweep/table.csv").read_text()
    ended = (tmp_path / "sweep/runs/0002.json").stat().st_mtime_ns
    muslin.sweep(scene=flag_scene, frames=1, list=listed, directory=tmp_path / "sweep")
    assert (tmp_path / "sweep/runs/0002.json").stat().st_mtime_ns == ended


def test_killed_workers_lose_nothing(flag_scene, undisturbed, tmp_path):
    """Kills a worker six times, at times drawn at random, while it writes frames."""
    draws, killed = random.Random(3), []

    class Killer(ProcessPool):
        def _hear(self, worker, lines, progress):
            super()._hear(worker, lines, progress)
            if worker.job and worker.frame >= 0 and len(killed) < 6:
                time.sleep(draws.uniform(0, 0.02))
                killed.append(worker.process.pid)
                worker.process.kill()

    reasons = []

    class Watch:
        def frame(self, number, frame, last): ...
        def done(self, number, kept=False): ...
        def lost(self, number, reason):
            reasons.append(reason)

    todo = muslin.sweeps.jobs({"scene": flag_scene, "frames": 8, "grid": GRID}, tmp_path / "killed")
    pool = Killer(2, 1, tmp_path / "log")
    pool.run(todo, Watch(), None)
    pool.close()
    assert reasons == ["killed by SIGKILL"] * len(killed) and killed
    again = muslin.sweep(scene=flag_scene, frames=8, grid=GRID, directory=tmp_path / "killed")
    assert again.lost == 0
    assert cells(tmp_path / "killed") == cells(undisturbed.directory)
    for number in ("0001", "0006"):
        for name in ("flag.skin.pc2", "flag.lattice.pc2", "probes.csv"):
            here = tmp_path / "killed/runs" / number / name
            assert here.read_bytes() == (undisturbed.directory / "runs" / number / name).read_bytes()


def test_a_job_that_always_kills_its_worker_is_given_up(flag_scene, tmp_path):
    todo = muslin.sweeps.jobs({"scene": flag_scene, "frames": 1, "grid": {STEPS: [2, 3]}}, tmp_path / "sweep")
    broken = muslin.sweeps.Job(**(vars(todo[0]) | {"frames": "one"}))

    class Watch:
        losses = 0

        def frame(self, number, frame, last): ...
        def done(self, number, kept=False): ...
        def lost(self, number, reason):
            self.losses += 1

    pool, watch = ProcessPool(1, 1, tmp_path / "log"), Watch()
    pool.run([broken, todo[1]], watch, None)
    pool.close()
    results = [json.loads((tmp_path / f"sweep/runs/000{n}.json").read_text()) for n in (1, 2)]
    assert results[0]["exit_code"] == 128 and "given up" in results[0]["message"] and watch.losses == 4
    assert results[1]["exit_code"] == 0
    assert "TypeError" in (tmp_path / "log").read_text()
    made = muslin.sweep(scene=flag_scene, frames=1, grid={STEPS: [2, 3]}, directory=tmp_path / "sweep")
    assert made.column("exit_code") == [0, 0]  # it is tried again


def test_continues_what_is_missing(flag_scene, undisturbed, tmp_path):
    stops = iter([False] * 4)
    with pytest.raises(Interrupted):
        muslin.sweep(
            scene=flag_scene, frames=8, grid=GRID, directory=tmp_path / "s", cancel=lambda: next(stops, True)
        )
    rows = cells(tmp_path / "s")
    assert len(rows) == 7 and "missing" in {row[3] for row in rows}
    counted = []
    muslin.sweep(
        scene=flag_scene,
        frames=8,
        grid=GRID,
        directory=tmp_path / "s",
        progress=lambda *now: counted.append(now),
    )
    assert counted == [(n, 6) for n in range(1, 7)]
    assert cells(tmp_path / "s") == cells(undisturbed.directory)


def test_scenes_from_python(tmp_path):
    scene = muslin.make_scene(flag_tables(force=FORCE), overrides=[f"{STEPS}=3"])
    grid = {GRAVITY: [-9.8], "title": ['x, "y"']}
    made = muslin.sweep({"scene": scene}, tmp_path / "a", frames=2, grid=grid, pictures=False)
    assert made.rows[0]["convergence.steps"] == 6 and made.rows[0]["title"] == 'x, "y"'
    assert repr(made).endswith("1 runs, 0 failed>")


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("", "", "nothing varies"),
        ("[grid]\ntime.duratoin = [1]", ":3:18", "did you mean `duration`"),
        ("[grid]\ntime.duration = []", ":3:6", "has no values"),
        ("[grid]\ntime.duration = 2", ":3:6", "give a list"),
        ('[grid]\ntime.duration = [1, "x"]', ":3:21", "give a number above 0"),
        ("[grid]\nbody.flog.thickness = [1]", ":3", "did you mean `flag`"),
        ("[grid]\ntime.duration = [1, 2]\n[list]\ntime.duration = [1]", ":3:6", "is in [list] too"),
        ("[list]\ntime.duration = [1, 2]\ntime.frame_rate = [24]", ":4:6", "equal lengths"),
        ("frames = -1\n[grid]\ntime.duration = [1]", ":2:1", "whole number of 0 or more"),
        ("[gird]\ntime.duration = [1]", ":2:2", "did you mean `grid`"),
        ('set = ["time.duratio=2"]\n[grid]\ntime.duration = [1]', ":2:8", "did you mean `duration`"),
        ('pages = ["reprot"]\n[grid]\ntime.duration = [1]', ":2:10", "did you mean `report`"),
        ("[sample]\nruns = 3\nkeys.time.duration = { from = 2, to = 1 }", ":4:11", "smaller number"),
        ("[sample]\nruns = 3\nkeys.time.duration = { from = 2 }", ":4:11", "has no `to`"),
        (
            '[sample]\nruns = 3\nkeys.time.duration = { from = 0, to = 1, scale = "log" }',
            ":4",
            "begin above 0",
        ),
        ("[sample]\nkeys.time.duration = { from = 1, to = 2 }", ":2:2", "has no `runs`"),
        (
            '[sample]\nruns = 3\nmethod = "sobl"\nkeys.time.duration = { from = 1, to = 2 }',
            ":4:1",
            "did you mean `sobol`",
        ),
        (
            '[search]\nobjective = "error"\nruns = 0\nkeys.time.duration = { from = 1, to = 2 }',
            ":4:1",
            "1 or more",
        ),
    ],
)
def test_refuses_wrong_descriptions_at_their_place(flag_scene, tmp_path, text, place, words):
    file = tmp_path / "sweep.toml"
    file.write_text(f'scene = "{flag_scene}"\n{text}\n')
    with pytest.raises(muslin.InputError) as caught:
        muslin.sweep(file, tmp_path / "out")
    assert str(caught.value).startswith(f"{file}{place}") and words in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_refuses_too_many_runs_and_missing_scenes(flag_scene, tmp_path):
    grid = {"time.duration": list(range(1, 41)), STEPS: list(range(1, 31))}
    with pytest.raises(
        muslin.InputError, match=r"1200 runs \(40 × 30\), more than the limit of 1000.*limit=1200"
    ):
        muslin.sweep(scene=flag_scene, grid=grid, directory=tmp_path / "out")
    assert read_description(from_python({"scene": flag_scene, "grid": grid}), limit=1200).count == 1200
    with pytest.raises(muslin.FileError, match=r"none\.toml"):
        muslin.sweep(scene="none.toml", grid={STEPS: [1]}, directory=tmp_path / "out")
    for wrong in ({"workers": 0}, {"threads": -1}):
        with pytest.raises(muslin.UsageError, match="1 or more"):
            muslin.sweep(scene=flag_scene, grid={STEPS: [1]}, directory=tmp_path / "out", **wrong)


def test_refuses_another_description_by_name(undisturbed, flag_scene, tmp_path):
    where = undisturbed.directory
    for change, name in (
        ({"frames": 9}, r"`frames`.*8 then, 9 now"),
        ({"grid": GRID | {STEPS: [2, 5]}}, rf"`grid\.{STEPS}`.*\[2, 4\] then, \[2, 5\] now"),
        ({"set": ["time.duration=3"]}, "`set`"),
    ):
        with pytest.raises(muslin.InputError, match=name):
            muslin.sweep(**({"scene": flag_scene, "frames": 8, "grid": GRID, "directory": where} | change))
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(muslin.FileError, match=r"not empty.*letter\.txt"):
        muslin.sweep(scene=flag_scene, grid=GRID, directory=tmp_path)


def test_the_page_needs_nothing_else(flag_scene, tmp_path):
    title = 'a </script> & "b" %DATA%'
    made = muslin.sweep(
        scene=flag_scene, title=title, frames=2, grid={STEPS: [2, 3]}, directory=tmp_path / "s"
    )
    page = (made.directory / "index.html").read_text()
    assert not re.search(r"(src|href)=\"?(https?:)?//", page) and "@import" not in page
    found = json.loads(page.split('id="data">', 1)[1].split("</script>", 1)[0])
    assert found["keys"] == [STEPS] and len(found["rows"]) == len(found["runs"]) == 2
    assert found["rows"][1][found["columns"].index("kinetic")] == made.rows[1]["kinetic"]
    run = found["runs"][0]
    assert run["picture"].startswith("data:image/png;base64,") and len(run["curves"]["kinetic"]) == 3
    for _, link in run["links"]:
        assert (made.directory / link).exists()
    assert page.count("</script>") == 2 and "&lt;/script&gt;" in page


@pytest.mark.skipif(not shutil.which("chromium"), reason="Chromium is not installed: tools/setup --tests")
def test_the_page_shows_and_filters_runs(undisturbed, tmp_path):
    """In a browser: all runs have card, picture, curve and dot; those of a value that is pressed are hidden."""
    script = """
      const count = (what) => document.querySelectorAll(what).length;
      const found = [['.card', '.card img', '.line', '.dot'].map(count)];
      document.querySelector('#filters button').click();
      found.push([count('.card'), document.getElementById('shown').textContent]);
      document.getElementById('as-table').click();
      found.push(count('tbody tr'));
      document.body.replaceChildren(JSON.stringify(found));
    """
    page = (undisturbed.directory / "index.html").read_text()
    (tmp_path / "page.html").write_text(page.replace("</body>", f"<script>{script}</script></body>"))
    words = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/browser"]
    words += ["--dump-dom", f"file://{tmp_path}/page.html"]
    seen = subprocess.run(words, capture_output=True, text=True, timeout=60).stdout
    assert json.loads(seen.split("<body>")[1].split("</body>")[0]) == [[6, 6, 6, 6], [4, "4 shown"], 4]


def test_jobs_run_anywhere(flag_scene, tmp_path):
    """As a scheduler does it, then gathered."""
    tables = {"scene": flag_scene, "frames": 2, "grid": {STEPS: [2, 3]}, "pictures": False, "pages": []}
    todo = muslin.sweeps.jobs(tables, tmp_path / "s")
    results = [muslin.sweeps.execute(job) for job in todo]
    assert [result["exit_code"] for result in results] == [0, 0]
    assert muslin.sweeps.jobs(tables, tmp_path / "s") == []
    assert muslin.sweep(tables, tmp_path / "s").column("convergence.steps") == [4, 6]


def test_a_search_finds_the_least_for_any_number_of_workers(flag_scene, tmp_path):
    pytest.importorskip("optuna", reason="searches need optuna")
    search = {
        "objective": "largest_stretch",
        "runs": 8,
        "batch": 4,
        "keys": {GRAVITY: {"from": -20, "to": -1}},
    }
    tables = {"scene": flag_scene, "frames": 3, "search": search, "pictures": False, "pages": []}
    made = muslin.sweep(tables, tmp_path / "a", workers=2)
    assert made.best["largest_stretch"] == min(made.column("largest_stretch"))
    muslin.sweep(tables, tmp_path / "b", workers=1)
    assert cells(tmp_path / "a") == cells(tmp_path / "b")
    for name in ("0003", "0007"):
        (tmp_path / f"b/runs/{name}.json").unlink()
    muslin.sweep(tables, tmp_path / "b", workers=1)
    assert cells(tmp_path / "a") == cells(tmp_path / "b")
    by_function = search | {
        "objective": lambda row: -row["largest_stretch"],
        "direction": "maximize",
        "runs": 4,
    }
    assert (
        muslin.sweep(tables | {"search": by_function}, tmp_path / "c").best["run"]
        == min(made.rows[:4], key=lambda row: row["largest_stretch"])["run"]
    )
    with pytest.raises(muslin.UsageError, match="did you mean `largest_stretch`"):
        muslin.sweep(tables | {"search": search | {"objective": "larget_stretch"}}, tmp_path / "d")


def command(program: str, *words: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, "sweep", *map(str, words)],
        capture_output=True,
        text=True,
        env=os.environ | {"MUSLIN_PYTHON": sys.executable} | environment,
    )


@pytest.fixture
def small(flag_scene, tmp_path):
    """A file of a sweep of two runs, one of which fails."""
    file = tmp_path / "small.toml"
    file.write_text(
        f'scene = "{flag_scene}"\nframes = 1\npictures = false\n[grid]\nbody.flag.voxel_width = [1, 1e-5]\n'
    )
    return file


def test_command(program, small, tmp_path):
    planned = command(program, small, "--plan")
    assert planned.returncode == 0 and planned.stdout.splitlines()[1] == "0002  body.flag.voxel_width=1e-05"
    done = command(program, small, "-o", tmp_path / "out", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert (result["runs"], result["failed"]) == (2, 1) and len(result["rows"]) == 2
    strict = command(program, small, "-o", tmp_path / "out", "--strict", "--quiet")
    assert strict.returncode == 4 and "1 of 2 runs failed, run 2: " in strict.stderr
    assert command(program, small, "--workrs", "2").stderr.endswith("did you mean `--workers`?\n")
    assert command(program, tmp_path / "none.toml").returncode == 5
    assert "--limit" in command(program, "--help").stdout


def test_command_says_how_to_get_the_package(program, small):
    lacking = command(program, small, PYTHONPATH="/nowhere")
    assert lacking.returncode == 2 and "pip install muslin[sweep]" in lacking.stderr
    missing = command(program, small, MUSLIN_PYTHON="/nowhere/python3")
    assert missing.returncode == 2 and "/nowhere/python3" in missing.stderr


def test_ctrl_c_leaves_a_sweep_to_continue(undisturbed, flag_scene, tmp_path):
    file = tmp_path / "sweep.toml"
    grid = "\n".join(f"{key} = {values}" for key, values in GRID.items())
    file.write_text(f'scene = "{flag_scene}"\nframes = 8\n[grid]\n{grid}\n')
    words = [sys.executable, "-m", "muslin.sweeps", str(file), "-o", str(tmp_path / "out"), "--quiet"]
    process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "out/runs/0001").exists() and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130 and "the same command continues" in said
    assert len(cells(tmp_path / "out")) == 7
    subprocess.run(words, check=True)
    assert cells(tmp_path / "out") == cells(undisturbed.directory)


def test_two_processes_do_not_share_a_directory(flag_scene, tmp_path):
    description = read_description(from_python({"scene": flag_scene, "grid": {STEPS: [1]}}))
    first = SweepDirectory(tmp_path / "s")
    first.open(description)
    with pytest.raises(muslin.FileError, match="another process is running this sweep"):
        muslin.sweep(scene=flag_scene, grid={STEPS: [1]}, directory=tmp_path / "s")
    first.close()


def test_results_of_broken_files_are_named(flag_scene, tmp_path):
    muslin.sweep(scene=flag_scene, frames=1, grid={STEPS: [1]}, directory=tmp_path / "s", pictures=False)
    (tmp_path / "s/runs/0001.json").write_text("{")
    with pytest.raises(muslin.InputError, match=r"0001\.json: this is not JSON"):
        muslin.sweep(scene=flag_scene, frames=1, grid={STEPS: [1]}, directory=tmp_path / "s", pictures=False)
    assert read_file(Path(flag_scene)).places["time.duration"][0] > 1
