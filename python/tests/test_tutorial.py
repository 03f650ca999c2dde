"""The tutorial runs, gives the numbers on its page, and its picture shows something."""

import re
import subprocess
import sys

import matplotlib.image
import numpy as np
import pytest


@pytest.fixture(scope="module")
def made(source, tmp_path_factory):
    """A folder with the page and the picture as they come out now."""
    folder = tmp_path_factory.mktemp("tutorial")
    command = [sys.executable, source / "tools/tutorial", source / "docs/tutorial/flag.py", folder]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


def test_page_is_what_comes_out(source, made):
    """Texts and code to the letter, printed numbers to the last digit but two units of it."""
    number = re.compile(r"\d+(?:\.\d+)?(?:e[-+]\d+)?")
    kept, now = ((folder / "flag.md").read_text() for folder in (source / "docs/tutorial", made))
    # A speed at rest is rounding; only its size is said.
    speed = re.compile(r"speed after 10 s: .* m/s\n")
    assert all(float(re.search(r": (\S+) m/s", speed.search(page).group()).group(1)) < 1e-6 for page in (kept, now))
    kept, now = speed.sub("", kept), speed.sub("", now)
    assert number.sub("#", kept) == number.sub("#", now)
    for a, b in zip(number.findall(kept), number.findall(now), strict=True):
        assert abs(float(a) - float(b)) <= 2 * 10.0 ** -len(a.partition(".")[2]), (a, b)


def test_simulation_is_the_closed_form(made):
    page = (made / "flag.md").read_text()
    rows = re.findall(r"^ +\d\.\d+ m +(\d\.\d+) +(\d\.\d+)$", page, flags=re.M)
    assert len(rows) == 5
    assert all(abs(float(found) - float(exact)) <= 2e-5 for found, exact in rows)
    ratios = [float(r) for r in re.search(r"ratios: (.*)", page).group(1).split(", ")]
    assert all(3.3 < ratio < 4.2 for ratio in ratios)


def test_picture_is_not_blank(source, made):
    for folder in (source / "docs/tutorial", made):
        picture = matplotlib.image.imread(folder / "flag.png")
        assert picture.shape[0] > 300 and picture.shape[1] > 600
        assert (np.ptp(picture[..., :3], axis=-1) > 0.2).mean() > 0.005  # coloured lines
