"""Pictures have the numbers of their answers, with units, and without overlapping text."""

from __future__ import annotations

import itertools
import json
import re

import matplotlib as mpl
import numpy as np
import pyarrow
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import answers
import armill
from conftest import ROOT
from test_docs import blocks

mpl.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from armill import plot  # noqa: E402

TOLERANCE = "#c8102e"
JOINTS = np.radians([[0, 12, -28, 0, 39, 0], [30, -5, -20, 0, 50, 0]])
MH12 = armill.Robot.load("yaskawa/mh12")
# Half the last digit of deviations in tables, of two that are compared, µm.
DIGITS_UM = 0.0011


def drawn_placement(ax=None):
    tilts = np.linspace(60, 90, 7)
    return plot.placement(answers.placed(), {"tilt_deg": (tilts, 12 + 0.1 * (90 - tilts))}, tolerance_um=50, ax=ax)


PICTURES = {
    "map": lambda ax=None: plot.map(answers.paper(), "Fig. 6, best branch", ax=ax),
    "map out of reach": lambda ax=None: plot.map(answers.far(), ax=ax),
    "region": lambda ax=None: plot.region(answers.paper(), "Fig. 6, best branch", ax=ax),
    "sections": lambda ax=None: plot.sections(answers.paper(), "Table 4, best branch", ax=ax),
    "path": lambda ax=None: plot.path(answers.paths(), "pocket", ax=ax),
    "along": lambda ax=None: plot.along(answers.paths(), "pocket", ax=ax),
    "contributions": lambda ax=None: plot.contributions(answers.paths(), "pocket", ax=ax),
    "polar": lambda ax=None: plot.polar(answers.paths(), ax=ax),
    "polar of a ball-bar": lambda ax=None: plot.polar(answers.ballbar()[1], ax=ax),
    "turns": lambda ax=None: plot.turns(answers.paths(), "turned", robot=MH12, tool=answers.tool(), turn_count=37, ax=ax),
    "roundness": lambda ax=None: plot.roundness(answers.bore()[0], table=answers.bore()[1], ax=ax),
    "budget": lambda ax=None: plot.budget(answers.budget(), ax=ax),
    "placement": drawn_placement,
    "identify": lambda ax=None: plot.identify(answers.springs(), ax=ax),
    "robot": lambda ax=None: plot.robot(MH12, JOINTS, answers.tool(), ax=ax),
    "stiffness": lambda ax=None: plot.stiffness(MH12, JOINTS[0], ax=ax),
}


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def as_list(axes):
    return axes if isinstance(axes, list) else [axes]


def columns(result, analysis):
    table = pyarrow.table(result.table(analysis))
    return {name: table[name].to_numpy() for name in table.column_names}


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def lines(ax):
    return {line.get_label(): line for line in ax.get_lines()}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_has_labels_and_restores_settings(name):
    before = dict(mpl.rcParams)
    axes = as_list(PICTURES[name]())
    assert {key: value for key, value in mpl.rcParams.items() if before[key] != value} == {}
    assert plt.get_fignums() == [axes[0].figure.number]
    for ax in axes:
        assert ax.get_title(loc="left") or ax.get_title()
        if ax.name == "polar":
            assert all(label.get_text().endswith("µm") for label in ax.get_yticklabels()[:-1])
            continue
        named = [ax.get_xlabel(), ax.get_ylabel(), *([ax.get_zlabel()] if ax.name == "3d" else [])]
        labels = [label for label in named if label]
        units = [re.search(r"\((mm|µm|deg|µm/N|µrad/\(N m\))\)$", label) for label in labels]
        # Rows with names, tests by their numbers and waves by theirs have no unit.
        unitless = ("test, in the order of the table", "waves per revolution; below: phase of the prediction minus phase of the part")
        assert all(unit or label in unitless for unit, label in zip(units, labels)), labels
        assert labels or name == "sections"


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_drawn_on_given_axes(name):
    own = as_list(PICTURES[name]())
    figure = plt.figure(figsize=(9, 3.4 * len(own)))
    projection = None if own[0].name == "rectilinear" else own[0].name
    mine = [figure.add_subplot(len(own), 1, i + 1, projection=projection) for i in range(len(own))]
    given = mine if len(mine) > 1 else mine[0]
    numbers = plt.get_fignums()
    assert as_list(PICTURES[name](ax=given)) == mine
    assert plt.get_fignums() == numbers
    figure.canvas.draw()
    if projection is not None:
        with pytest.raises(ValueError, match=f"expected {projection} axes"):
            PICTURES[name](ax=plt.figure().add_subplot())
    if len(own) > 1:
        with pytest.raises(ValueError, match=f"expected {len(own)} axes, given 1"):
            PICTURES[name](ax=[mine[0]])


@pytest.mark.parametrize("name", PICTURES)
def test_no_text_overlaps_another_or_the_edge(name):
    figure: Figure = as_list(PICTURES[name]())[0].figure
    figure.canvas.draw()
    boxes = []
    for ax in figure.axes:
        words = [ax.title, ax._left_title, ax.xaxis.label, ax.yaxis.label]
        words += [text for text in ax.texts if text.get_text()]
        boxes += [(text.get_text(), text.get_window_extent()) for text in words if text.get_text() and text.get_visible()]
        if ax.get_legend() is not None:
            boxes += [(text.get_text(), text.get_window_extent()) for text in ax.get_legend().get_texts()]
        if ax.name == "rectilinear":
            for axis in (ax.xaxis, ax.yaxis):
                ticks = [label for label in axis.get_ticklabels() if label.get_text() and label.get_visible()]
                low, high = sorted(axis.get_view_interval())
                ticks = [tick for tick, at in zip(ticks, axis.get_ticklocs()) if low <= at <= high] if len(ticks) else []
                boxes += [(label.get_text(), label.get_window_extent()) for label in ticks]
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        assert not a.shrunk(0.9, 0.9).overlaps(b.shrunk(0.9, 0.9)) or one == other, f"{one!r} overlaps {other!r}"
    width, height = figure.canvas.get_width_height()
    for text, box in boxes:
        assert box.x0 > -2 and box.y0 > -2 and box.x1 < width + 2 and box.y1 < height + 2, f"{text!r} is cut off"


def test_adjacent_titles_do_not_overlap():
    figure = plt.figure(figsize=(11, 6.4), layout="constrained")
    axes = [figure.add_subplot(1, 2, i + 1, projection="polar") for i in range(2)]
    for ax, analysis in zip(axes, ("groove", "turned")):
        plot.polar(answers.paths(), analysis, ax=ax)
    figure.canvas.draw()
    left, right = (ax.texts[-1].get_window_extent() for ax in axes)
    assert left.x1 < right.x0 and right.x1 < figure.bbox.width


# ---- planes


def test_contours_are_at_the_levels_and_the_tolerance_where_the_core_finds_it():
    found = answers.paper().answer["maps"][3]
    ax = plot.map(answers.paper(), found["name"], levels=[20, 60, 100, 140, 160])
    filled, tolerance, thin = [each for each in ax.collections if isinstance(each, QuadContourSet)]
    assert list(filled.levels) == [20, 60, 100, 140, 160] and list(thin.levels) == [60, 100, 140]
    assert list(tolerance.levels) == [50] and to_hex(tolerance.get_edgecolor()[0]) == TOLERANCE
    assert tolerance.get_linewidth()[0] > 4 * thin.get_linewidth()[0]
    # The marching squares of the core interpolate along the same edges; only they have corners of the frame.
    boundary = np.vstack([np.array(line) for line in found["region"]["boundary_mm"]])
    for vertex in tolerance.get_paths()[0].vertices:
        assert np.min(np.linalg.norm(boundary - vertex, axis=1)) < 0.05, vertex
    assert ax.get_xlim() == (400, -400), "seen from the tool side"
    assert "tolerance 50 µm" in legend(ax) and "smallest 20.1 µm" in legend(ax)
    smallest = lines(ax)["smallest 20.1 µm"].get_xydata()
    assert smallest.tolist() == [found["best"]["in_plane_mm"]]


def test_unreachable_cells_are_hatched_with_their_reason():
    found = answers.far().answer["maps"][0]
    reasons = {flag["reason"]: len(flag["points"]) for flag in found["grid"]["flags"]}
    ax = plot.map(answers.far())
    assert f"too far ({reasons['too_far']} points)" in legend(ax)
    hatches = [patch for patch in ax.patches if patch.get_hatch()]
    assert len(hatches) == 1
    # Five vertices per cell, around its point.
    cells = hatches[0].get_path().vertices.reshape(-1, 5, 2)[:, :4].mean(axis=1)
    values = np.array(found["grid"]["in_plane_um"], dtype=float).reshape(21, 21)
    rows, places = np.nonzero(np.isnan(values))
    expected = np.column_stack([np.array(found["grid"]["y_mm"])[places], np.array(found["grid"]["z_mm"])[rows]])
    assert np.allclose(cells[np.lexsort(cells.T)], expected[np.lexsort(expected.T)])


def test_other_values_of_the_grid_have_no_tolerance_and_unknown_ones_are_refused():
    ax = plot.map(answers.paper(), value="normal_um")
    assert not any(text.startswith("tolerance") for text in legend(ax) if ax.get_legend()) if ax.get_legend() else True
    assert ax.figure.axes[1].get_ylabel() == "deviation along the normal (µm)"
    with pytest.raises(ValueError, match="expected one of in_plane_um"):
        plot.map(answers.paper(), value="in_plane")


def test_the_drawn_region_has_the_reported_area():
    found = answers.paper().answer["maps"][3]
    ax = plot.region(answers.paper(), found["name"])
    labels = {patch.get_label(): patch for patch in ax.patches}
    x, y = plot._region.outline(found["region"]["boundary_mm"]).vertices.T
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert area == pytest.approx(found["region"]["area_mm2"], rel=1e-9)
    assert "within: 491 cm²" in legend(ax) and f"{found['region']['area_mm2'] / 100:.0f}" == "491"
    rectangle = labels["rectangle 380 mm x 100 mm"]
    assert [abs(rectangle.get_width()), abs(rectangle.get_height())] == [380, 100]
    assert labels["circle of radius 50 mm"].get_radius() == found["region"]["circle_radius_mm"]


def test_holes_of_a_region_are_not_filled():
    ring = [[0, 0], [10, 0], [10, 10], [0, 10]]
    hole = [[3, 3], [7, 3], [7, 7], [3, 7]]
    island = [[4, 4], [6, 4], [6, 6], [4, 6]]
    for turned in (False, True):
        outline = plot._region.outline([ring, hole[::-1] if turned else hole, island])
        figure = plt.figure(figsize=(1, 1), dpi=100)
        ax = figure.add_axes((0, 0, 1, 1), xlim=(0, 10), ylim=(0, 10))
        ax.add_patch(plt.matplotlib.patches.PathPatch(outline, facecolor="black"))
        figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, 0]
        assert [pixels[50, 15], pixels[50, 35], pixels[50, 50]] == [0, 255, 0]


def test_sections_share_their_levels_and_show_the_fraction_within():
    result = answers.paper()
    axes = plot.sections(result, "Table 5")
    planes = [plane for plane in result.answer["maps"] if plane["name"].startswith("Table 5: ")]
    assert [ax.get_title(loc="left").splitlines()[0] for ax in axes] == [p["name"].removeprefix("Table 5: ") for p in planes]
    bands = [next(each for each in ax.collections if isinstance(each, QuadContourSet)).levels.tolist() for ax in axes]
    assert all(levels == bands[0] for levels in bands)
    assert f"{100 * planes[0]['fraction_within']:.0f} % within" in axes[0].get_title(loc="left")
    with pytest.raises(plot.Missing, match="'Table 6' is not among the sections: 'Table 4'"):
        plot.sections(result, "Table 6")


# ---- paths


def test_a_path_is_coloured_by_its_table():
    points = columns(answers.paths(), "pocket")
    ax = plot.path(answers.paths(), "pocket")
    lit = next(each for each in ax.collections if isinstance(each, LineCollection))
    values = points["in_plane_um"]
    assert np.array_equal(lit.get_array(), np.maximum(values[:-1], values[1:]))
    ends = np.array([segment[0] for segment in lit.get_segments()])
    # A rectangle of 160 mm x 100 mm about the centre, whatever the tilt.
    assert np.allclose(np.abs(ends).max(axis=0), [80, 50], atol=1e-4)
    worst = lines(ax)[next(label for label in lines(ax) if label.startswith("worst points"))]
    assert np.allclose(worst.get_xydata()[0], answers.paths().answer["paths"][2]["worst"]["in_plane_mm"])


def test_a_plane_given_by_angles_has_its_own_axes():
    """In-plane coordinates of the core compared with those of the pictures."""
    for result, analysis in ((answers.far(), 0), (answers.paths(), 2), (answers.paper(), 0)):
        answer = result.answer["paths"][analysis]
        for point in answer["worst_points"]:
            place = {f"{axis}_mm": np.array([value]) for axis, value in zip("xyz", point["point"]["xyz_mm"])}
            assert np.allclose(np.ravel(plot._setting.in_plane(answer, place)), point["point"]["in_plane_mm"], atol=1e-6)


def test_separate_cuts_are_not_joined(tmp_path):
    (tmp_path / "part.nc").write_text("G21 G90 G94\nG0 X0 Y0 Z5\nG1 Z0 F200\nG1 X80 F600\nG0 Z5\nG0 X0 Y40\nG1 Z0\nG1 X80\nM30\n")
    study = answers.PATHS.split("[[analysis]]")[0] + '[[analysis]]\nkind = "path"\nname = "part"\n[analysis.program]\nfile = "part.nc"\n'
    result = armill.Study.from_text(study, tmp_path).run()
    points = columns(result, "part")
    apart = plot._setting.breaks(points)
    assert len(apart) == 1 and points["line"][apart[0] - 1] < points["line"][apart[0]]
    drawn = next(each for each in plot.path(result).collections if isinstance(each, LineCollection))
    assert len(drawn.get_segments()) == len(points["line"]) - 2
    line = lines(plot.along(result))["in-plane, across the tool"]
    assert np.isnan(line.get_xdata()).sum() == 1


def test_along_a_path_has_the_numbers_of_the_table():
    points = columns(answers.paths(), "pocket")
    ax = plot.along(answers.paths(), "pocket")
    drawn = lines(ax)
    for label, name in (("in-plane, across the tool", "in_plane_um"), ("along the track", "along_um")):
        assert np.array_equal(drawn[label].get_xydata(), np.column_stack([points["distance_mm"], points[name]]))
    assert set(drawn["tolerance 300 µm"].get_ydata()) == {300} and to_hex(drawn["tolerance 300 µm"].get_color()) == TOLERANCE
    worst = drawn[next(label for label in drawn if label.startswith("worst points"))]
    assert worst.get_ydata()[0] == pytest.approx(np.max(points["in_plane_um"]), abs=DIGITS_UM)


def test_contributions_add_up_to_the_deviation():
    answer = answers.paths().answer["paths"][2]
    ax = plot.contributions(answers.paths(), "pocket")
    assert [bars.get_label() for bars in ax.containers] == answer["setting"]["contributors"]
    sums = np.sum([[bar.get_width() for bar in bars] for bars in ax.containers], axis=0)
    assert np.allclose(sums, [each["point"]["in_plane_um"] for each in answer["worst_points"]], rtol=1e-9)
    plane = plot.contributions(answers.paper(), "Fig. 6")
    assert [label.get_text() for label in plane.get_yticklabels()] == ["largest", "smallest"]


def test_radial_deviations_are_those_of_the_core_and_other_tables_refused():
    answer = answers.paths().answer["paths"][0]
    curves = {label: line for label, line in lines(plot.polar(answers.paths(), "groove")).items() if label.startswith("case")}
    assert len(curves) == 2
    for line, case in zip(curves.values(), answer["circle_cases"]):
        assert np.max(line.get_ydata()) == pytest.approx(case["max_radial_um"], abs=DIGITS_UM)
        assert np.min(line.get_ydata()) == pytest.approx(case["min_radial_um"], abs=DIGITS_UM)
    with pytest.raises(plot.Missing, match="is not of 'turned': its radial deviations are off by"):
        plot.polar(answers.paths().answer, "turned", table=columns(answers.paths(), "groove"))
    with pytest.raises(plot.Missing, match="the table has no column deviation_x_case_2_um"):
        plot.polar(answers.paths().answer, "turned", table=answers.far().table("round"))
    with pytest.raises(plot.Missing, match="'pocket' is not a circle"):
        plot.polar(answers.paths(), "pocket")


def test_clockwise_and_anticlockwise_runs_of_a_ball_bar_have_two_colours():
    answer, out = answers.ballbar()
    runs = plot._answers.read_table(out / "runs.csv", "")
    drawn = lines(plot.polar(answer, table=out / "runs.csv"))
    for name in ("CW1", "CCW1", "CW2", "CCW2"):
        assert np.array_equal(drawn[name].get_ydata(), runs[f"{name}_um"])
    assert drawn["CW1"].get_color() == drawn["CW2"].get_color() != drawn["CCW1"].get_color()
    assert (drawn["CW1"].get_linestyle(), drawn["CW2"].get_linestyle()) == ("-", "--")
    with pytest.raises(plot.Missing, match="its points are not in the JSON: .* table= runs.csv"):
        plot.polar(answer)


def test_at_the_chosen_spin_the_lattice_has_the_deviation_of_the_path():
    points = columns(answers.paths(), "turned")
    ax = plot.turns(answers.paths(), "turned", robot=MH12, tool=answers.tool(), turn_count=19)
    assert np.allclose(lines(ax)["chosen spin"].get_ydata(), points["turn_deg"], atol=1e-9)
    values = ax.collections[0].get_array().reshape(19, -1)
    turns = np.linspace(-180, 180, 19)
    rows = np.array([np.flatnonzero(np.isclose(turns, turn))[0] for turn in points["turn_deg"]])
    found = values[rows, np.arange(len(rows))]
    assert np.allclose(found, points["in_plane_um"], atol=0.01)
    with pytest.raises(plot.Missing, match="'groove' has no search"):
        plot.turns(answers.paths(), "groove")
    with pytest.raises(plot.Missing, match="is of another arm: it has no joint_"):
        plot.turns(answers.paths(), "turned", robot=armill.Robot.load("kuka/kr120r2500pro"))


def test_a_spin_beyond_half_a_turn_is_shown_modulo_one_turn():
    study = answers.PATHS.split("[[analysis]]")[0].replace("[900, 100, 500]", "[1250, 100, 500]")
    study += '[[analysis]]\nkind = "path"\nname = "slot"\nrectangle = { size_mm = [300, 500] }\nstep_mm = 5\n'
    result = armill.Study.from_text(study + "posture.search = { step_deg = 10 }\n").run()
    labels = columns(result, "slot")["turn_deg"]
    assert labels.max() > 180, "the spin of this path no longer exceeds half a turn: use another path"
    drawn = lines(plot.turns(result))["chosen spin"].get_ydata()
    known = drawn[np.isfinite(drawn)]
    assert len(known) == len(labels) and np.allclose(np.cos(np.radians(known - labels)), 1.0) and np.isnan(drawn).any()
    assert known.min() >= -180 and known.max() <= 180


def test_an_unreachable_plane_is_drawn_as_such_or_reported():
    study = answers.PATHS.split("[[analysis]]")[0].replace("[900, 100, 500]", "[3000, 100, 500]")
    study += '[[analysis]]\nkind = "map"\nname = "far"\n[[analysis]]\nkind = "path"\nname = "away"\nrectangle = { size_mm = [160, 100] }\n'
    result = armill.Study.from_text(study).run()
    assert legend(plot.map(result)) == ["too far (25 points)"]
    assert not [patch for patch in plot.region(result).patches if patch.get_label().startswith("circle")]
    assert legend(plot.path(result)) == ["unreachable"]
    assert any(label.startswith("unreachable") for label in legend(plot.along(result)))
    for analysis in ("far", "away"):
        with pytest.raises(plot.Missing, match=f"contributions: no point of '{analysis}' is reachable"):
            plot.contributions(result, analysis)


# ---- answers of commands


def test_the_profile_is_between_the_circles_and_touches_them():
    answer, table = answers.bore()
    drawn = lines(plot.roundness(answer, table=table))
    profile = drawn["profile"]
    angles = profile.get_xdata() % (2 * np.pi)
    name = next(label for label in drawn if label.startswith("MCCI"))
    outer = np.interp(angles, drawn[name].get_xdata(), drawn[name].get_ydata())
    # Both are drawn to a thousandth of a µm.
    assert np.all(profile.get_ydata() < outer + 2e-3) and np.sum(outer - profile.get_ydata() < 5e-3) >= 2
    name = next(label for label in drawn if label.startswith("MICI"))
    inner = np.interp(angles, drawn[name].get_xdata(), drawn[name].get_ydata())
    assert np.all(profile.get_ydata() > inner - 2e-3) and np.sum(profile.get_ydata() - inner < 5e-3) >= 2
    assert "profile" not in lines(plot.roundness(answer))


def test_the_budget_has_a_bar_for_every_contribution_and_a_pair_for_every_wave():
    answer = answers.budget()
    bars, waves = plot.budget(answer)
    widths = {label.get_text(): bar.get_width() for label, bar in zip(bars.get_yticklabels(), bars.patches)}
    assert widths == {
        **{each["name"]: each["largest_um"] for each in answer.contributions},
        "added with their signs": answer.sums["as_functions_um"],
        "root of the squares": answer.sums["root_sum_square_um"],
        "plain sum": answer.sums["plain_um"],
        "part, measured": answer.part["largest_um"],
        "part, not explained": answer.part["residual"]["largest_um"],
    }
    heights = [[bar.get_height() for bar in bars] for bars in waves.containers]
    assert heights == [[w[key] for w in answer.part["waves"]] for key in ("measured_um", "predicted_um")]
    with pytest.raises(plot.Missing, match="the answer has no `measured`: give that of `armill budget`"):
        plot.budget(answers.paths())


def test_a_placement_shows_its_front_and_the_costs_that_are_given():
    found = json.loads((answers.placed() / "placement.json").read_text())
    front, tilt = drawn_placement()
    line = lines(front)["smallest, by margin"]
    assert line.get_xydata().tolist() == [[each["margin_deg"], each["cost_um"]] for each in found["by_margin"]]
    assert f"nominal {plot._style.number(found['nominal']['cost_um'])} µm" in legend(front)
    assert lines(tilt)["others as recommended"].get_xdata()[0] == 60 and tilt.get_xlabel() == "tilt of the part (deg)"
    assert plot.placement(found)[0].get_ylabel() == "largest in-plane deviation (µm)"
    with pytest.raises(plot.Missing, match="tilt is not a coordinate"):
        plot.placement(found, {"tilt": ([1], [1])})
    with pytest.raises(plot.Missing, match="the answer has no `by_margin`: give that of `armill place`"):
        plot.placement(answers.paths())


def test_springs_and_residuals_have_the_values_of_the_answer():
    answer = answers.springs()
    springs, residuals = plot.identify(answer)
    labels = [label.get_text() for label in springs.get_yticklabels()]
    assert labels == [spring["name"] for spring in answer.springs]
    means = [line.get_xdata()[0] for line in springs.get_lines() if line.get_marker() == "o"]
    assert np.allclose(means, [1e6 * spring["compliance_rad_per_n_m"] for spring in answer.springs])
    sizes = lines(residuals)["with this test used"].get_ydata()
    assert np.allclose(sizes, [np.linalg.norm(test["residual_um"]) for test in answer.by_test])
    assert [text.get_text() for text in residuals.texts if "outlier" in text.get_text()] == [f"{answer.outliers[0]}: outlier"]


# ---- arms


@pytest.mark.parametrize("name", ["yaskawa/mh12", "kuka/kr120r2500pro", "fanuc/r2000ic", "universal-robots/ur10"])
def test_the_links_of_a_drawn_arm_are_rigid(name):
    arm = armill.Robot.load(name)
    joints = np.random.default_rng(3).uniform(0.2, 1.2, (20, arm.dof))
    lengths = [np.linalg.norm(np.diff(plot.skeleton(arm, each), axis=0), axis=1) for each in joints]
    assert np.allclose(lengths, lengths[0], atol=1e-6)
    assert np.allclose(plot.skeleton(arm, joints[0])[-1], arm.forward(joints[0])[:3, 3])


def test_the_drawn_mh12_passes_through_the_points_of_its_drawing():
    line = plot.skeleton(MH12, np.zeros(6))
    for point in ([0, 0, 0.45], [0.155, 0, 0.45], [0.155, 0, 0.45 + 0.614], [0.795, 0, 0.45 + 0.614 + 0.2]):
        assert np.min(np.linalg.norm(line - point, axis=1)) < 1e-9, point


def test_the_ellipsoid_is_where_one_newton_moves_the_tool():
    ax = plot.stiffness(MH12, JOINTS[0], answers.tool())
    c = 1e6 * MH12.compliance(JOINTS[0], answers.tool())[:3, :3]
    points = np.vstack([np.asarray(line) for line in ax.collections[1]._segments3d])
    forces = np.linalg.solve(c, points.T)
    assert len(points) > 100 and np.allclose(np.linalg.norm(forces, axis=0), 1.0, atol=1e-6)
    softest = np.linalg.eigvalsh(c)[-1]
    assert legend(ax)[0] == f"softest: {softest:.1f} µm/N, {1 / softest:.4f} N/µm"
    with pytest.raises(ValueError, match=r"joints: expected shape \(6,\), given \(2, 6\)"):
        plot.stiffness(MH12, JOINTS)


# ---- inputs


def test_result_json_dict_and_folder_give_the_same_picture(tmp_path):
    answers.far().write(tmp_path, pictures=False)
    given = [answers.far(), answers.far().answer, tmp_path, tmp_path / "result.json"]
    drawn = [plot.map(each).collections[0].get_paths() for each in given]
    for other in drawn[1:]:
        assert all(np.array_equal(a.vertices, b.vertices) for a, b in zip(drawn[0], other))
    table = pyarrow.table(answers.paths().table("pocket"))
    for each in (table, table.to_pandas(), columns(answers.paths(), "pocket")):
        assert len(plot.along(answers.paths().answer, "pocket", table=each).get_lines()) > 5


def test_reports_missing_data(tmp_path):
    result = answers.paths()
    with pytest.raises(TypeError, match="map: expected an armill.Result, .* given int"):
        plot.map(7)
    with pytest.raises(plot.Missing, match=r"map: the answer has no maps; it has paths"):
        plot.map(result)
    with pytest.raises(plot.Missing, match="path: 'slot' is not among the paths: 'groove', 'turned', 'pocket'"):
        plot.path(result, "slot")
    with pytest.raises(plot.Missing, match="along: its points are not in the JSON: give the folder .* or table= pocket.csv"):
        plot.along(result.answer, "pocket")
    with pytest.raises(plot.Missing, match="along: the table has no column x_mm, y_mm, z_mm, along_um, cross_um, axial_um; it has"):
        plot.along(result.answer, "pocket", table={"distance_mm": [0], "in_plane_um": [0]})
    with pytest.raises(plot.Missing, match="map: the file .* does not exist"):
        plot.map(tmp_path / "nowhere")
    with pytest.raises(plot.Missing, match="the answer has no `springs`: give that of `armill identify`; it has format"):
        plot.identify(result)
    with pytest.raises(TypeError, match="robot: expected an armill.Robot, given Result"):
        plot.robot(result, np.zeros(6))
    with pytest.raises(TypeError, match="ax: expected matplotlib axes, given Figure"):
        plot.along(result, "pocket", ax=plt.figure())


def test_python_blocks_of_the_guide_run(tmp_path, monkeypatch, capsys):
    pytest.importorskip("roboticstoolbox")
    pytest.importorskip("pinocchio")
    monkeypatch.chdir(tmp_path)
    names = {}
    found = blocks(ROOT / "docs/guide/plotting.md")
    for number, block in enumerate(found, 1):
        exec(compile(block, f"plotting.md, block {number}", "exec"), names)
    assert len(found) == 6 and "along: its points are not in the JSON" in capsys.readouterr().out
    assert (tmp_path / "fig-6.pdf").is_file()
    for name in plot.__all__:
        labels = f"| `{name}` |" in (ROOT / "docs/guide/plotting.md").read_text()
        assert labels or name in ("Missing", "skeleton"), name


def test_every_function_documents_inputs_and_result():
    for name in plot.__all__:
        thing = getattr(plot, name)
        if name != "Missing":
            assert "->" in thing.__doc__.splitlines()[0] and f"``{name}``" in plot.__doc__ or name == "skeleton", name


PROJECTIONS = {"polar": "polar", "polar of a ball-bar": "polar", "roundness": "polar", "robot": "3d", "stiffness": "3d"}
PANELS = {"budget": 2, "placement": 2, "identify": 2}


@pytest.mark.parametrize("name", [name for name in PICTURES if name != "sections"])
def test_a_picture_is_usable_in_a_column_of_a_journal(name):
    count = PANELS.get(name, 1)
    figure = plt.figure(figsize=(3.5, 3.2 * count), layout="constrained")
    given = [figure.add_subplot(count, 1, i + 1, projection=PROJECTIONS.get(name)) for i in range(count)]
    PICTURES[name](given if count > 1 else given[0])
    figure.draw_without_rendering()
    for ax in given:
        box = ax.get_window_extent()
        width, height = box.width / figure.dpi, box.height / figure.dpi
        assert width > 1.0 and height > 0.9, (width, height)
        title = ax.title if ax.get_title() else ax._left_title
        assert title.get_window_extent().x1 < figure.bbox.x1 + 0.15 * figure.dpi, title.get_text()


def test_sections_in_a_column_of_a_journal():
    figure, axes = plt.subplots(4, 2, figsize=(3.5, 7.0), layout="constrained", squeeze=False)
    drawn = plot.sections(answers.paper(), "Table 4, best branch", ax=axes)
    figure.draw_without_rendering()
    assert all(ax.get_window_extent().width / figure.dpi > 0.6 for ax in drawn)
    assert all(ax.get_legend() is None for ax in drawn) and len(figure.legends) == 1


def test_title_legend_colours_and_colour_bar_are_options():
    ax = plot.map(answers.paper(), "Fig. 6, best branch", title="Mine", legend=False, cmap="magma", cbar=False)
    assert ax.get_title(loc="left") == "Mine" and ax.get_legend() is None and len(ax.figure.axes) == 1
    filled = next(each for each in ax.collections if isinstance(each, QuadContourSet))
    assert filled.get_cmap().name == "magma"
    ax = plot.path(answers.paths(), "pocket", title=False, cmap="cividis")
    assert not ax.get_title(loc="left") and not ax.texts[0].get_text().startswith("100") and len(ax.figure.axes) == 2
    collections = [each for each in ax.collections if isinstance(each, LineCollection) and each.get_array() is not None]
    assert {each.get_cmap().name for each in collections} == {"cividis"}
    bars, waves = plot.budget(answers.budget(), title="Budget", legend=False)
    assert bars.get_title(loc="left") == "Budget" and waves.get_title(loc="left") == "Harmonics"
    assert bars.get_legend() is None and waves.get_legend() is None
    ax = plot.along(answers.paths(), "pocket", legend=False)
    assert ax.get_legend() is None and "pocket" in ax.get_title(loc="left")


def test_settings_of_the_caller_are_kept():
    with mpl.rc_context({"font.size": 14, "axes.labelsize": 17, "image.cmap": "plasma", "legend.fontsize": 13, "axes.linewidth": 3.0}):
        ax = plot.map(answers.paper(), "Fig. 6, best branch")
        assert ax.xaxis.label.get_size() == 17 and ax.spines["left"].get_linewidth() == 3.0
        filled = next(each for each in ax.collections if isinstance(each, QuadContourSet))
        assert filled.get_cmap().name == "plasma" and ax.get_legend().get_texts()[0].get_size() == 13
    with mpl.rc_context():
        ax = plot.map(answers.paper(), "Fig. 6, best branch")
        assert ax.xaxis.label.get_size() == 9 and not ax.get_legend().get_frame_on()
