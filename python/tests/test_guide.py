"""Every Python example of the guide runs, top to bottom, and type-checks."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGES = ["python.md", "sweep.md"]


def examples(page: Path) -> str:
    """The Python blocks of a page as one program in which lines keep their numbers."""
    lines = page.read_text().split("\n")
    kept, inside = [], False
    for line in lines:
        fence = re.match(r"```(\w*)", line)
        if fence:
            inside = not inside and fence.group(1) == "python"
            kept.append("")
        else:
            kept.append(line if inside else "")
    return "\n".join(kept) + "\n"


@pytest.fixture
def workplace(source, tmp_path):
    """A folder that looks like the root of the repository to the examples."""
    for folder in ("scenes", "examples"):
        (tmp_path / folder).symlink_to(source / folder)
    (tmp_path / "out").mkdir()
    return tmp_path


@pytest.mark.parametrize("name", PAGES)
def test_examples_run(source, workplace, name):
    program = workplace / name.replace(".md", "_examples.py")
    program.write_text(examples(source / "docs/guide" / name))
    done = subprocess.run([sys.executable, program], cwd=workplace, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    if name == "python.md":
        assert "flag.toml:3:1" in done.stdout
        assert (workplace / "out/flag.usdc").stat().st_size > 1000
    else:
        assert "24 runs, 0 failed" in done.stdout and "4 of 4" in done.stdout


@pytest.mark.parametrize("name", PAGES)
def test_examples_type_check(source, workplace, name):
    program = workplace / name.replace(".md", "_examples.py")
    program.write_text(examples(source / "docs/guide" / name))
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", workplace / "mypy", program],
        cwd=workplace,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout

