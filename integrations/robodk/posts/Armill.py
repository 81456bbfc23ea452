"""Post-processor of RoboDK: writes a program as a tool path of armill (CSV) and a study that follows it.

Copy this file into the folder ``Posts`` of RoboDK, select it for the robot (*Select Post Processor*, *Armill*), and generate
the program. ``NAME.csv`` has one row for each point: position of the tip, tool axis, spin, feed, spindle speed, in the
reference frame of the program, and the joints of RoboDK as remark. ``NAME.toml`` is a study with the tool and the reference
frame of RoboDK; robot, load and tolerance are to be entered.

Lengths are mm, angles deg, feeds mm/min. The tool axis of RoboDK (z of the tool) must point from the spindle to the tip.
"""

import math
import os
import re

from robodk.robomath import Mat, eye, invH, pose_2_xyzrpw, roty, rotz

#: Largest distance of an arc from its straight pieces, mm, and largest rotation of the tool within a piece, deg.
CHORD_MM = 0.001
TURN_DEG = 2.0
#: Calls such as ``SpindleOn(9000)``, ``setRPM 9000``, ``SPINDLE_RPM(9000)``.
SPINDLE = re.compile(r"(?:spindle|rpm)[^\d-]*(-?\d+(?:\.\d+)?)", re.IGNORECASE)
#: Calls that stop the spindle.
STOPPED = re.compile(r"spindle[\s_]*(?:off|stop)", re.IGNORECASE)
HEADER = "x_mm,y_mm,z_mm,i,j,k,spin_deg,feed_mm_per_min,rapid,spindle_rpm,note\n"


class RobotPost:
    """Receives the program from RoboDK, one call for each instruction."""

    PROG_EXT = "csv"

    def __init__(self, robotpost=None, robotname=None, robot_axes=6, **kwargs):
        self.robot, self.axes = robotname or "robot", robot_axes
        self.PROG_FILES = []
        self.LOG = ""
        self.rows = []
        self.name = "program"
        # Of the first move, in which the file is written; of the instructions before the next move.
        self.base_from_file = None
        self.base_from_frame, self.flange_from_tool = eye(4), eye(4)
        self.tool = None
        self.feed, self.rpm = None, None
        self.last = None
        self.first_joints = None

    # Program

    def ProgStart(self, progname):
        self.name = file_name(progname)

    def ProgFinish(self, progname):
        pass

    def ProgSave(self, folder, progname, ask_user=False, show_result=False):
        """Writes both files into the folder."""
        name = file_name(progname)
        path = os.path.join(folder, f"{name}.csv")
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(f"# {self.robot}, program {self.name}, from RoboDK\n{HEADER}{''.join(self.rows)}")
        study = os.path.join(folder, f"{name}.toml")
        with open(study, "w", encoding="utf-8", newline="") as file:
            file.write(self.study(f"{name}.csv"))
        self.PROG_FILES = [path, study]
        if self.LOG:
            print(self.LOG)

    def ProgSendRobot(self, robot_ip, remote_path, ftp_user, ftp_pass):
        self.log("nothing is sent to a robot by this post-processor")

    # Moves

    def MoveJ(self, pose, joints, conf_RLF=None):
        """A joint move is a rapid."""
        if self.known(pose, joints):
            self.point(self.base_from_frame * pose, joints, rapid=True)

    def MoveL(self, pose, joints, conf_RLF=None):
        """A straight move, in pieces where the tool turns."""
        if self.known(pose, joints):
            start, end = self.last, self.base_from_frame * pose
            count = 1 if start is None else pieces(turn_between(start, end))
            self.follow(lambda part: on_line(start, end, part), end, joints, count)

    def MoveC(self, pose1, joints1, pose2, joints2, conf_RLF_1=None, conf_RLF_2=None):
        """An arc through a point, in straight pieces."""
        if not (self.known(pose1, joints1) and self.known(pose2, joints2)):
            return
        start, middle, end = self.last, self.base_from_frame * pose1, self.base_from_frame * pose2
        arc = None if start is None else arc_through(start.Pos(), middle.Pos(), end.Pos())
        if arc is None:
            self.log("an arc without three different points is written as two straight moves")
            self.MoveL(pose1, joints1)
            self.MoveL(pose2, joints2)
            return
        radius, angle, at = arc
        count = max(pieces(turn_between(start, end)), math.ceil(angle / (2 * math.acos(1 - min(1.0, CHORD_MM / radius)))))
        self.follow(lambda part: placed(on_line(start, end, part), at(part * angle)), end, joints2, count)

    # Settings

    def setFrame(self, pose, frame_id=None, frame_name=None):
        self.base_from_frame = pose

    def setTool(self, pose, tool_id=None, tool_name=None):
        if self.rows and self.tool is not None and pose_2_xyzrpw(pose) != pose_2_xyzrpw(self.tool):
            self.log(f"tool {tool_name or tool_id} differs from the tool of the first move: armill has one tool in a study")
        self.flange_from_tool = pose

    def setSpeed(self, speed_mms):
        self.feed = 60.0 * speed_mms if speed_mms > 0 else self.feed

    def RunCode(self, code, is_function_call=False):
        if STOPPED.search(code):
            self.rpm = None
            return
        found = SPINDLE.search(code)
        if found:
            self.rpm = float(found.group(1))

    def RunMessage(self, message, iscomment=False):
        pass

    def Pause(self, time_ms):
        pass

    def setAcceleration(self, accel_mmss):
        pass

    def setSpeedJoints(self, speed_degs):
        pass

    def setAccelerationJoints(self, accel_degss):
        pass

    def setZoneData(self, zone_mm):
        pass

    def setDO(self, io_var, io_value):
        pass

    def setAO(self, io_var, io_value):
        pass

    def waitDI(self, io_var, io_value, timeout_ms=-1):
        pass

    def addline(self, newline):
        pass

    def addlog(self, newline):
        self.log(newline)

    # Parts

    def log(self, text):
        self.LOG += f"{text}\n"

    def known(self, pose, joints):
        """Whether the target has a pose; joints beyond those of the arm are external axes."""
        if len(joints) > self.axes or self.axes > 7:
            raise ValueError(f"{self.name}: {len(joints)} joints: programs with external axes cannot be written as a path in one frame")
        if pose is None:
            self.log(f"a move to joints {rounded(joints)} is left out: give the target a Cartesian position")
        return pose is not None

    def follow(self, at, end, joints, count):
        for number in range(1, count):
            self.point(at(number / count), None)
        self.point(end, joints)

    def point(self, base_from_tool, joints, rapid=False):
        if self.base_from_file is None:
            self.base_from_file, self.tool, self.first_joints = self.base_from_frame, self.flange_from_tool, list(joints)
        x, y, z = (invH(self.base_from_file) * base_from_tool).Pos()
        axis = direction(base_from_tool, 2)
        i, j, k = (-sum(direction(self.base_from_file, n)[m] * axis[m] for m in range(3)) for n in range(3))
        values = [number(value, 6) for value in (x, y, z)] + [number(value, 9) for value in (i, j, k)]
        feed = "" if rapid or self.feed is None else number(self.feed, 6)
        rpm = "" if self.rpm is None else number(self.rpm, 3)
        note = "" if joints is None else f"joints {rounded(joints)}"
        self.rows.append(",".join([*values, number(spin(base_from_tool), 6), feed, "1" if rapid else "0", rpm, note]) + "\n")
        self.last = base_from_tool

    def study(self, path):
        """The text of the study. The part frame is the reference frame of RoboDK."""
        tool = ", ".join(number(value, 6) for value in pose_2_xyzrpw(self.tool or self.flange_from_tool))
        x, y, z, rx, ry, rz = pose_2_xyzrpw(self.base_from_file or self.base_from_frame)
        centre, angles = (", ".join(number(value, 6) for value in values) for values in ((x, y, z), (rx, ry, rz)))
        name = path.rsplit(".", 1)[0]
        return f"""# From RoboDK: {self.robot}, program {self.name}. The joints of the first point are {rounded(self.first_joints or [])} deg:
# compare them with the joint columns of the table of armill before you rely on the result.
format = 1
robot = "MAKER/MODEL"    # `armill robots` lists the library; or the path of a robot file
tolerance_um = 100

[tool]
flange_from_tool_mm_deg = [{tool}]

[plane]    # the reference frame of the program, relative to the base of the robot
centre_mm = [{centre}]
rotation_deg = [{angles}]
half_size_mm = 100
step_mm = 20

[load]    # or [cut]: material, cutter and depths
cases_n = [[50, 0, 0], [0, 50, 0], [0, 0, 50]]

[[analysis]]
kind = "path"
name = "{name}"
program = {{ file = "{path}", spin = "given" }}
"""


def file_name(name):
    """As armill names the files of an analysis."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "program"


def number(value, digits):
    """Without zeros at the end, and without a negative zero."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def rounded(joints):
    return " ".join(number(value, 4) for value in joints)


def direction(pose, column):
    """A column of the rotation."""
    return [pose[row, column] for row in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def spin(base_from_tool):
    """Rotation about the tool axis from spin zero, deg: there y of the tool is as close as possible to y of the base, or to x."""
    y, z = direction(base_from_tool, 1), direction(base_from_tool, 2)
    near = [0.0, 1.0, 0.0] if abs(z[1]) < 1 - 1e-9 else [1.0, 0.0, 0.0]
    zero = unit([n - dot(near, z) * c for n, c in zip(near, z)])
    return math.degrees(math.atan2(dot(z, cross(zero, y)), dot(zero, y)))


def axis_angle(a, b):
    """The rotation from a to b in axes of a, rad."""
    turn = invH(a) * b
    cosine = min(1.0, max(-1.0, (turn[0, 0] + turn[1, 1] + turn[2, 2] - 1) / 2))
    twice = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    length = math.sqrt(dot(twice, twice))
    angle = math.atan2(length / 2, cosine)
    if angle < 1e-9:
        return [0.0, 0.0, 1.0], 0.0
    if length > 1e-6:
        return [x / length for x in twice], angle
    # A half turn: the columns of (R + 1) are along the axis.
    columns = [[turn[row, column] + (row == column) for row in range(3)] for column in range(3)]
    return unit(max(columns, key=lambda column: dot(column, column))), angle


def turn_between(a, b):
    return math.degrees(axis_angle(a, b)[1])


def pieces(turn_deg):
    return max(1, math.ceil(turn_deg / TURN_DEG - 1e-9))


def about(axis, angle):
    """A rotation about an axis through the origin."""
    x, y, z = axis
    polar, azimuth = math.acos(min(1.0, max(-1.0, z))), math.atan2(y, x)
    upright = rotz(azimuth) * roty(polar)
    return upright * rotz(angle) * invH(upright)


def on_line(a, b, part):
    """The pose between a and b: position on a line, rotation about one axis."""
    axis, angle = axis_angle(a, b)
    first, last = a.Pos(), b.Pos()
    return placed(a * about(axis, part * angle), [p + part * (q - p) for p, q in zip(first, last)])


def placed(pose, position):
    """The rotation of a pose at a position."""
    made = Mat(pose)
    made.setPos(position)
    return made


def arc_through(a, b, c):
    """Radius, angle in rad and position at an angle of the arc from a over b to c; None if they are on a line."""
    ab, ac = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    normal = cross(ab, ac)
    square = dot(normal, normal)
    if square < 1e-12 * max(dot(ab, ab), dot(ac, ac)) ** 2 or square == 0:
        return None
    # Centre of the circle through three points, relative to a.
    to_centre = [(dot(ab, ab) * p + dot(ac, ac) * q) / (2 * square) for p, q in zip(cross(ac, normal), cross(normal, ab))]
    radius = math.sqrt(dot(to_centre, to_centre))
    centre = [p + q for p, q in zip(a, to_centre)]
    x, z = unit([-p for p in to_centre]), unit(normal)
    y = cross(z, x)

    def angle_of(point):
        arm = [p - q for p, q in zip(point, centre)]
        return math.atan2(dot(arm, y), dot(arm, x)) % (2 * math.pi)

    def at(angle):
        return [o + radius * (math.cos(angle) * u + math.sin(angle) * v) for o, u, v in zip(centre, x, y)]

    return radius, angle_of(c), at
