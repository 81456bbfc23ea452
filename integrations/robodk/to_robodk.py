"""Brings a compensated path of armill into an open station of RoboDK, as a program of the robot there.

::

    armill compensate cell --out compensated
    python to_robodk.py compensated/pocket.commanded.csv --frame "Part" --tool "Spindle"

``--frame`` and ``--tool`` are the names of the reference frame and of the tool in the station: the frame must be at the origin
of the program (``part_from_path_mm_deg`` of the study on its plane), the tool that of the study. Select the post-processor
of the controller in RoboDK and generate the program there. Needs the package ``robodk`` and a running RoboDK.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

from robodk.robomath import Mat, invH

#: Columns of ``NAME.commanded.csv`` that are needed.
NEEDED = ("x_mm", "y_mm", "z_mm", "i", "j", "k", "spin_deg")


def read(path):
    """-> list of dict: the points; raises ValueError with the line of the file."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        missing = [name for name in NEEDED if name not in (rows.fieldnames or [])]
        if missing:
            raise ValueError(f"{path}: no column {', '.join(missing)}: give the NAME.commanded.csv of `armill compensate`")
        points = []
        for row in rows:
            try:
                point = {name: float(row[name]) for name in NEEDED}
                point["feed"] = float(row["feed_mm_per_min"]) if row.get("feed_mm_per_min") else None
            except (TypeError, ValueError) as error:
                raise ValueError(f"{path}:{rows.line_num}: {error}") from error
            point["rapid"] = row.get("rapid") in ("1", "true", "yes")
            points.append(point)
    if not points:
        raise ValueError(f"{path}: no points")
    return points


def pose_of(point, base_from_frame):
    """-> Mat: frame_from_tool. The spin is measured in the axes of the base."""
    turn = [[base_from_frame[row, column] for column in range(3)] for row in range(3)]
    outward = [point["i"], point["j"], point["k"]]
    length = math.sqrt(sum(value * value for value in outward))
    z = [-sum(turn[row][column] * outward[column] for column in range(3)) / length for row in range(3)]
    near = [0.0, 1.0, 0.0] if abs(z[1]) < 1 - 1e-9 else [1.0, 0.0, 0.0]
    across = [n - sum(p * q for p, q in zip(near, z)) * c for n, c in zip(near, z)]
    size = math.sqrt(sum(value * value for value in across))
    y_zero = [value / size for value in across]
    x_zero = [y_zero[1] * z[2] - y_zero[2] * z[1], y_zero[2] * z[0] - y_zero[0] * z[2], y_zero[0] * z[1] - y_zero[1] * z[0]]
    spin = math.radians(point["spin_deg"])
    cosine, sine = math.cos(spin), math.sin(spin)
    x = [cosine * p + sine * q for p, q in zip(x_zero, y_zero)]
    y = [cosine * q - sine * p for p, q in zip(x_zero, y_zero)]
    base_from_tool = Mat([[x[row], y[row], z[row], 0.0] for row in range(3)] + [[0.0, 0.0, 0.0, 1.0]])
    no_shift = Mat([[*turn[row], 0.0] for row in range(3)] + [[0.0, 0.0, 0.0, 1.0]])
    pose = invH(no_shift) * base_from_tool
    pose.setPos([point["x_mm"], point["y_mm"], point["z_mm"]])
    return pose


def build(station, points, name, frame, tool, rounding_mm=None):
    """Adds the program to the station and returns it. The first point and rapids that follow rapids are joint moves."""
    robot = station.Item("", ROBOT)
    items = [(robot, "robot", ""), (station.Item(frame, FRAME), "reference frame", frame), (station.Item(tool, TOOL), "tool", tool)]
    for item, kind, asked in items:
        if not item.Valid():
            raise ValueError(f"the station has no {kind} {asked}".rstrip())
    _, (reference, _, _), (spindle, _, _) = items
    base_from_frame = invH(robot.Parent().PoseAbs()) * reference.PoseAbs()
    program = station.AddProgram(name, robot)
    program.ShowInstructions(False)
    program.setPoseFrame(reference)
    program.setPoseTool(spindle)
    if rounding_mm is not None:
        program.setRounding(rounding_mm)
    station.Render(False)
    feed, previous_rapid = None, True
    for number, point in enumerate(points, 1):
        target = station.AddTarget(f"{name} {number}", reference, robot)
        target.setAsCartesianTarget()
        target.setPose(pose_of(point, base_from_frame))
        if point["feed"] is not None and point["feed"] != feed and not point["rapid"]:
            feed = point["feed"]
            program.setSpeed(feed / 60.0)
        if number == 1 or (point["rapid"] and previous_rapid):
            program.MoveJ(target)
        else:
            program.MoveL(target)
        previous_rapid = point["rapid"]
    station.Render(True)
    return program


# Types of items in RoboDK: robot, reference frame, tool.
ROBOT, FRAME, TOOL = 2, 3, 4


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", help="NAME.commanded.csv of `armill compensate`")
    parser.add_argument("--frame", required=True, help="reference frame in the station, at the origin of the program")
    parser.add_argument("--tool", required=True, help="tool in the station")
    parser.add_argument("--name", help="of the program in RoboDK; default: that of the file")
    parser.add_argument("--rounding-mm", type=float, help="distance of approximate positioning; default: that of RoboDK")
    given = parser.parse_args(arguments)
    try:
        points = read(given.path)
        from robodk.robolink import Robolink

        name = given.name or Path(given.path).name.split(".")[0]
        build(Robolink(), points, name, given.frame, given.tool, given.rounding_mm)
    except (OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"{len(points)} points in program {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
