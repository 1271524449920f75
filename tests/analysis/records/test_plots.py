"""Figures hold the numbers they were given, in the units their axes say."""

from dataclasses import replace

import numpy as np
import pytest

from hapticlab.analysis.records.plot import plot
from hapticlab.analysis.records.sweep_plot import plot_sweep
from hapticlab.analysis.sweeps.sweep import Sweep
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError
from hapticlab.limits.limit import Limit

pytest.importorskip("matplotlib")

k, T, b = np.geomspace(20, 2000, 9), np.array([5e-4, 1e-3]), np.linspace(0.05, 0.5, 8)
bound = Limit(K=200.0, frequency=None, kind="passivity", reason="all frequencies alike")


def record():
    t = np.arange(50) * 1e-3
    return Telemetry(t=t, x=2e-3 * np.sin(60 * t), v=0.12 * np.cos(60 * t), F=3 * t, T=1e-3, channels={"z": t}, units={"z": "m"})


def test_a_force_is_drawn_as_it_is_held():
    position, force = plot(record()).axes
    assert (position.lines[0].get_drawstyle(), force.lines[0].get_drawstyle()) == ("default", "steps-post")
    thinned = replace(record(), every=4)  # what was held between its rows is not known
    assert plot(thinned, "F").axes[0].lines[0].get_drawstyle() == "default"


@pytest.mark.filterwarnings("error")
def test_an_empty_record_is_drawn_without_warnings():
    none = np.zeros(0)
    assert len(plot(Telemetry(t=none, x=none, v=none, F=none, T=1e-3)).axes) == 2


def swept(**axes):
    units = {"k": "N/m", "T": "s", "b": "N s/m", "B": "N s/m"}
    shape = tuple(len(a) for a in axes.values())
    values = np.arange(np.prod(shape), dtype=float).reshape(shape) * 1e-3
    return Sweep(axes, values, "chatter", "m", {name: units[name] for name in axes})


def test_a_record_is_drawn_in_millimetres_and_newtons():
    log = record()
    figure = plot(log, "x", "F", "z")
    assert [" ".join(a.get_ylabel().split()) for a in figure.axes] == ["handle position x [mm]", "force F [N]", "z [mm]"]
    assert figure.axes[-1].get_xlabel() == "time t [s]"
    np.testing.assert_allclose(figure.axes[0].lines[0].get_ydata(), 1e3 * log.x, rtol=1e-15)
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), log.F, rtol=1e-15)


def test_force_over_position_is_held_from_sample_to_sample():
    log = record()
    (axes,) = plot(log, over="x").axes
    (line,) = axes.lines
    assert line.get_drawstyle() == "steps-post" and axes.get_xlabel() == "handle position x [mm]"
    np.testing.assert_allclose(line.get_xydata(), np.transpose([1e3 * log.x, log.F]), rtol=1e-15)


def test_periods_with_a_force_are_shaded_where_there_are_others():
    log = record()
    assert all(len(axes.collections) == 1 for axes in plot(log).axes)  # F is 0 at the first sample alone
    (path,) = plot(log).axes[0].collections[0].get_paths()
    assert (path.vertices[:, 0].min(), path.vertices[:, 0].max()) == (log.t[1], log.t[-1])
    assert not plot(replace(log, F=log.F + 1)).axes[0].collections


def test_three_quantities_are_at_most_520_pixels_high():
    assert 110 * plot(record(), "x", "v", "F").get_size_inches()[1] <= 520


def test_a_notebook_can_show_it_and_a_script_save_it(tmp_path):
    figure = plot(record())
    assert figure._repr_png_().startswith(b"\x89PNG")
    figure.savefig(tmp_path / "x.pdf")
    assert (tmp_path / "x.pdf").read_bytes().startswith(b"%PDF")


def test_a_name_that_was_not_recorded():
    with pytest.raises(AnalysisError, match=r"q was not recorded; this log has t, x, v, F, z. Watch it"):
        plot(record(), "q")


def test_one_axis_is_a_line_and_a_short_second_one_a_family():
    axes = plot_sweep(swept(k=k)).axes[0]
    assert axes.get_xlabel() == "stiffness k [N/m]" and axes.get_ylabel() == "chatter amplitude [mm]"
    assert axes.get_xscale() == "log"  # the values were spaced by a ratio
    np.testing.assert_allclose(axes.lines[0].get_ydata(), np.arange(9), rtol=1e-12)
    family = plot_sweep(swept(k=k, T=T)).axes[0]
    assert [line.get_label() for line in family.lines] == ["T = 0.5 ms", "T = 1 ms"]
    np.testing.assert_allclose(family.lines[1].get_ydata(), np.arange(1, 18, 2), rtol=1e-12)
    assert len({str(line.get_linestyle()) for line in family.lines}) == 2  # told apart without colour


def test_two_long_axes_are_a_map_with_the_first_to_the_right():
    result = swept(k=k, b=b)
    axes = plot_sweep(result).axes[0]
    assert axes.get_xlabel() == "stiffness k [N/m]" and axes.get_ylabel() == "handle damping b [N s/m]"
    mesh = axes.collections[0]
    np.testing.assert_allclose(np.asarray(mesh.get_array()).reshape(8, 9), 1e3 * result.values.T, rtol=1e-12)


def test_limits_are_drawn_and_named():
    axes = plot_sweep(swept(k=k), limits=bound).axes[0]
    assert axes.lines[-1].get_xdata()[0] == 200 and "passivity: 200 N/m" in axes.lines[-1].get_label()
    curve = [Limit(K=2 * one / 1e-3, frequency=None, kind="passivity", reason="") for one in b]
    for result, x_first in ((swept(k=k, b=b), True), (swept(b=b, k=k), False)):
        drawn = plot_sweep(result, limits={"Eq. (23.10)": curve}).axes[0].lines[-1]
        x, y = (drawn.get_xdata(), drawn.get_ydata())[:: 1 if x_first else -1]
        np.testing.assert_allclose(x, 2000 * b, rtol=1e-12)
        np.testing.assert_allclose(y, b, rtol=1e-12)


def test_each_line_of_a_family_has_its_own_limit():
    result = swept(k=k, b=b[:3])
    limits = [Limit(K=2000.0 * one, frequency=None, kind="passivity", reason="") for one in b[:3]]
    lines = plot_sweep(result, limits={"Eq. (23.10)": limits}).axes[0].lines
    for curve, limit, one in zip(lines[:3], lines[3:], b, strict=False):
        assert limit.get_xdata()[0] == 2000.0 * one
        assert limit.get_color() == curve.get_color()
    with pytest.raises(AnalysisError, match=r"2 limits for 3 line\(s\)"):
        plot_sweep(result, limits={"Eq. (23.10)": limits[:2]})


def test_what_cannot_be_drawn_is_said():
    with pytest.raises(AnalysisError, match="3 axes; a plot shows 1 or 2"):
        plot_sweep(swept(k=k, b=b, B=b))
    with pytest.raises(AnalysisError, match="needs an axis in N/m"):
        plot_sweep(swept(b=b), limits=bound)
    with pytest.raises(AnalysisError, match="a curve of 2 limits"):
        plot_sweep(swept(k=k, b=b), limits={"too short": [bound, bound]})


def test_missing_points_are_left_out_of_a_map():
    result = swept(k=k, b=b)
    result.values[2, 3] = np.nan
    mesh = plot_sweep(result).axes[0].collections[0]
    assert np.ma.getmaskarray(mesh.get_array()).sum() == 1
