"""Checks the statements of the pages on other programs about files, as far as this works without those programs."""

import re
import sys
import types

import numpy as np
from conftest import flag_tables

import muslin


def test_houdini_reads_the_cache(source, tmp_path, monkeypatch):
    """The Python SOP of the page, with a stand-in for the module hou."""
    page = (source / "docs/guide/houdini.md").read_text()
    code = re.search(r"```python\n(import numpy.*?)```", page, flags=re.S).group(1)
    monkeypatch.chdir(tmp_path)
    muslin.run(muslin.make_scene(flag_tables()), "out/flag", frames=4)
    run = muslin.Run("out/flag")
    for asked, frame in ((0, 0), (3, 3), (4.0, 4), (99, 4), (-5, 0)):
        set_to = {}

        class Geometry:
            def setPointFloatAttribValues(self, name, values, sink=set_to):  # noqa: N802
                sink[name] = values

        hou = types.ModuleType("hou")
        hou.pwd = lambda: types.SimpleNamespace(geometry=Geometry)
        hou.frame = lambda now=asked: now
        monkeypatch.setitem(sys.modules, "hou", hou)
        exec(code, {"hou": hou})
        assert np.array_equal(np.array(set_to["P"], np.float32).reshape(-1, 3), run.points(frame))


def test_pages_link_to_what_is_there(source):
    for name in ("python.md", "sweep.md", "maya.md", "houdini.md"):
        page = source / "docs/guide" / name
        for target in re.findall(r"\]\(([^)#:]+)", page.read_text()):
            assert (page.parent / target).exists(), (name, target)
