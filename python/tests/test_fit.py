"""Fabrics fitted to measurements."""

from pathlib import Path

import pytest

import muslin

MEASUREMENTS = """
areal_density = [0.118, 0.120, 0.122]
[[tensile]]
direction = "warp"
points = [[0.01, 20], [0.02, 60], [0.03, 130]]
plus_minus = 0.02
[[bending]]
direction = "warp"
bending_length = [0.020, 0.021]
"""


def test_fit_gives_material_and_uncertainty(tmp_path: Path) -> None:
    (tmp_path / "cloth.toml").write_text(MEASUREMENTS)
    fit = muslin.fit(tmp_path / "cloth.toml")
    assert fit.material.name == "cloth"
    values = {value.key: value for value in fit.values}
    assert values["areal_density"].value == pytest.approx(0.12)
    assert values["areal_density"].plus_minus == pytest.approx(0.002 / 3**0.5)
    assert values["warp_curve"].plus_minus == pytest.approx(0.02)
    assert values["bending_warp"].origin == "cantilever"
    assert values["bending_weft"].guess
    assert fit.material.curves["warp_curve"][0] == pytest.approx((0.01, 20))
    assert fit.simulated_drape is None
    assert "bending_warp" in str(fit)
    fit.write(tmp_path / "material.toml")
    assert muslin.read_material(tmp_path / "material.toml").shell == fit.material.shell


def test_fit_of_a_drape_can_be_stopped(tmp_path: Path) -> None:
    (tmp_path / "drape.toml").write_text("areal_density = 0.12\n[drape]\ncoefficient = 60\n")
    with pytest.raises(muslin.Interrupted):
        muslin.fit(tmp_path / "drape.toml", cancel=lambda: True)


def test_bad_measurements_have_their_place(tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text("areal_density = 120\n")
    with pytest.raises(muslin.InputError) as error:
        muslin.fit(tmp_path / "bad.toml")
    assert (error.value.line, error.value.column) == (1, 17)
    with pytest.raises(muslin.FileError):
        muslin.fit(tmp_path / "none.toml")
    with pytest.raises(muslin.UsageError):
        muslin.fit(tmp_path / "bad.toml", drops=0)
