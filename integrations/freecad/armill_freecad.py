"""The path of a CAM job of FreeCAD in the colours of its predicted deviation.

::

    job -> G-code (post-processor of LinuxCNC) -> armill run STUDY -> NAME.csv -> coloured path and worst points

The study names the program: ``[analysis.program] file = "part.ngc"``. This file is written here, in millimetres and in the
coordinates of the job; robot, tool, load, position of the part and tolerance are those of the study. Lengths are mm,
deviations um. Works with and without the graphical interface; needs the command ``armill`` on the path, or in ``ARMILL``.
"""

import csv
import importlib
import json
import math
import os
import re
import shutil
import subprocess
import tempfile

import FreeCAD
import Part

try:
    import tomllib
except ImportError:  # Python before 3.11
    tomllib = None

#: First line of the programs that are written here; other files are not overwritten.
MARK = "(written by armill_freecad)"
#: Number of colours between the smallest and the largest deviation.
LEVELS = 8
#: Colours from low to high, RGB: viridis of matplotlib (CC0) at equal distances.
COLOURS = (
    (0.267, 0.005, 0.329),
    (0.275, 0.194, 0.496),
    (0.213, 0.359, 0.552),
    (0.153, 0.497, 0.558),
    (0.122, 0.632, 0.531),
    (0.290, 0.758, 0.428),
    (0.622, 0.854, 0.226),
    (0.993, 0.906, 0.144),
)
UNREACHABLE_COLOUR = (0.85, 0.1, 0.1)
#: Part of the length of a move by which its chord may be longer, from rounding.
ROUNDING = 1e-3
#: Property of a job with the path of its study.
STUDY = "ArmillStudy"


class Problem(Exception):
    """Something that the user can mend; the text says what and how."""


class Prediction:
    """The answer of armill for one path.

    ``points`` are dicts: ``at`` (x, y, z) in the job, ``distance_mm``, ``line`` and ``deviation_um`` (the largest in the
    plane, None where the arm does not reach); ``path`` is the entry of ``paths`` in ``result.json``; ``folder`` contains all files.
    """

    def __init__(self, points, path, tolerance_um, folder):
        self.points, self.path, self.tolerance_um, self.folder = points, path, tolerance_um, folder


def show(job, study=None):
    """Predicts the job with a study file and draws its path; returns the group of the document and the Prediction."""
    study = os.path.abspath(study or getattr(job, STUDY, "") or "")
    if not os.path.isfile(study):
        raise Problem("no study file: give the path of a study.toml (`armill new cell` writes a commented one)")
    prediction = predict(job, study)
    if STUDY not in job.PropertiesList:
        job.addProperty("App::PropertyFile", STUDY, "armill", "study with robot, tool, load and position of the part")
    setattr(job, STUDY, study)
    return draw(job, prediction), prediction


def predict(job, study):
    """Writes the program that the study names, runs armill, and returns the Prediction."""
    name, program = _analysis(study)
    write_program(job, program)
    folder = tempfile.mkdtemp(prefix="armill-")
    try:
        _run([_command(), "run", study, "--out", os.path.join(folder, "out"), "--no-pictures"])
        return _read(os.path.join(folder, "out"), name)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def write_program(job, path):
    """Writes the active operations of the job as G-code, one file. Refuses a file that was not written here."""
    if os.path.exists(path):
        with open(path, encoding="utf-8", errors="replace") as file:
            if file.readline().strip() != MARK:
                raise Problem(f"{path} exists and was not written from FreeCAD: move it, or name another file in the study")
    operations = [each for each in job.Operations.Group if getattr(each, "Active", True) and each.Path.Commands]
    if not operations:
        raise Problem(f"job {job.Label} has no active operation with a path: recompute it")
    objects, tool = [], None
    for operation in operations:
        controller = getattr(operation, "ToolController", None)
        if controller is not None and controller is not tool:
            objects.append(controller)
            tool = controller
        objects.append(operation)
    temporary = path + ".unfinished"
    _post().export(objects, temporary, "--no-show-editor --no-header --no-tlo --precision=6")
    with open(temporary, encoding="utf-8") as file:
        text = file.read()
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(f"{MARK}\n{text}")
    os.replace(temporary, path)


def draw(job, prediction):
    """Adds a group to the document: one compound of edges for each colour, and the worst points. Replaces the group before."""
    document = job.Document
    name = f"Deviation_{job.Name}"
    _remove(document, name)
    group = document.addObject("App::DocumentObjectGroup", name)
    found = [each["deviation_um"] for each in prediction.points if each["deviation_um"] is not None] or [0.0]
    smallest, largest = min(found), max(found)
    group.Label = f"Deviation up to {largest:.1f} um"
    step = (largest - smallest) / LEVELS or 1.0
    levels = [[] for _ in range(LEVELS)]
    unreachable = []
    for first, last in _moves(prediction.points):
        values = (first["deviation_um"], last["deviation_um"])
        edge = (first["at"], last["at"])
        if None in values:
            unreachable.append(edge)
        else:
            levels[min(LEVELS - 1, int((max(values) - smallest) / step))].append(edge)
    for number, edges in enumerate(levels):
        low, high = smallest + number * step, smallest + (number + 1) * step
        above = " (above the tolerance)" if prediction.tolerance_um is not None and low >= prediction.tolerance_um else ""
        _edges(group, edges, f"{low:.1f} to {high:.1f} um{above}", COLOURS[number], (low, high))
    _edges(group, unreachable, "not reached", UNREACHABLE_COLOUR, (math.nan, math.nan))
    for worst in prediction.path["worst_points"]:
        _worst(group, prediction, worst)
    document.recompute()
    return group


def _analysis(study):
    """Name and program file of the first path of the study."""
    if tomllib is None:
        raise Problem("Python 3.11 or later is needed (FreeCAD 0.20.2 of Debian 12, FreeCAD 1.0)")
    try:
        with open(study, "rb") as file:
            found = tomllib.load(file)
    except ValueError as error:
        raise Problem(f"{study}: {error}") from error
    for number, each in enumerate(found.get("analysis", []), 1):
        program = each.get("program", {}).get("file") if each.get("kind") == "path" else None
        if program:
            return each.get("name", f"path-{number}"), os.path.join(os.path.dirname(study), program)
    raise Problem(f'{study} has no analysis of kind "path" with a program file: add [[analysis]] kind = "path", program = {{ file = "part.ngc" }}')


def _command():
    found = shutil.which(os.environ.get("ARMILL", "armill"))
    if found is None:
        raise Problem("the command armill is not on the path: install it, or set ARMILL to its file")
    return found


def _run(command):
    # The libraries of FreeCAD are not those of other programs.
    surroundings = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings, check=False)
    if done.returncode != 0:
        raise Problem(done.stderr.strip() or f"armill ended with exit code {done.returncode}")


def _read(folder, name):
    with open(os.path.join(folder, "result.json"), encoding="utf-8") as file:
        result = json.load(file)
    path = next((each for each in result["paths"] if each["name"] == name), None) or result["paths"][0]
    table = re.sub(r"[^a-z0-9]+", "-", path["name"].lower()).strip("-")
    with open(os.path.join(folder, f"{table}.csv"), encoding="utf-8", newline="") as file:
        points = [_point(row) for row in csv.DictReader(file)]
    return Prediction(points, path, path["setting"].get("tolerance_um"), folder)


def _point(row):
    def number(key):
        return float(row[key]) if row.get(key) else None

    return {
        "at": tuple(number(f"path_{axis}_mm") for axis in "xyz"),
        "distance_mm": number("distance_mm"),
        "line": int(row["line"]),
        "deviation_um": number("in_plane_um"),
    }


def _moves(points):
    """Neighbouring points of one cut: between cuts the path jumps."""
    for first, last in zip(points, points[1:]):
        along = last["distance_mm"] - first["distance_mm"]
        chord = math.dist(first["at"], last["at"])
        if 0.0 < chord <= along * (1 + ROUNDING) + 1e-6:
            yield first, last


def _edges(group, edges, label, colour, bounds):
    if not edges:
        return
    shape = Part.makeCompound([Part.makeLine(FreeCAD.Vector(*first), FreeCAD.Vector(*last)) for first, last in edges])
    made = group.newObject("Part::Feature", "Level")
    made.Shape, made.Label = shape, label
    for name, value in zip(("FromUm", "ToUm"), bounds):
        made.addProperty("App::PropertyFloat", name, "armill", "deviation, um")
        setattr(made, name, value)
    if made.ViewObject is not None:
        made.ViewObject.LineColor, made.ViewObject.LineWidth, made.ViewObject.PointSize = colour, 4.0, 1.0


def _worst(group, prediction, worst):
    near = min(prediction.points, key=lambda each: abs(each["distance_mm"] - worst["distance_mm"]))
    made = group.newObject("Part::Feature", "Worst")
    made.Shape = Part.Vertex(*near["at"])
    made.Label = f"{worst['point']['in_plane_um']:.1f} um, line {worst['line']}, {worst['cause']}"
    if made.ViewObject is not None:
        made.ViewObject.PointColor, made.ViewObject.PointSize = (0.0, 0.0, 0.0), 8.0


def _remove(document, name):
    group = document.getObject(name)
    if group is not None:
        for each in [found.Name for found in group.Group]:
            document.removeObject(each)
        document.removeObject(name)


def _post():
    """The post-processor of LinuxCNC: its place differs between versions of FreeCAD."""
    for name in ("PathScripts.post.linuxcnc_post", "Path.Post.scripts.linuxcnc_post"):
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    raise Problem("this FreeCAD has no post-processor for LinuxCNC")
