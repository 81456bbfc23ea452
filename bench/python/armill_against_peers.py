"""Compliance at joint positions: the Python package against pinocchio, the Robotics Toolbox and numpy, in one run on one machine.

usage: python bench/python/armill_against_peers.py [--poses N] [--quick] [--rust RATE]

First a check: all must agree within 1e-9 of the largest compliance. Then rates, one thread each, and the cost of a call for a
single pose. Numpy uses the dimensions of the arm, independent of armill; pinocchio and the toolbox use the arm exported by
`armill.interop`. Requires a wheel that was built for release, with its extras: `pip install 'armill[interop]'`.

`--rust` is the rate of `armill evaluate_at_joints, dev from angles` that `cargo xtask bench --only rust` prints on this machine, in million
poses a second: then the rate of the package relative to it is reported.
"""

import argparse
import os
import sys
import timeit
import warnings

for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"  # before numpy is loaded

import numpy as np
from arm import A1, A2, C1, C2, C3, C4, COMPLIANCE, FORCES, TOOL
from clock import print_rates

import armill

ALLOWED = 1e-9
ROUNDS, QUICK_ROUNDS = 9, 3
MANY = 1_000_000
FEW = 2_000  # poses for peers that answer one by one
CALLS = 20_000


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=100_000)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--rust", type=float)
    options = parser.parse_args()
    robot = armill.Robot.load("yaskawa/mh12").with_compliance(COMPLIANCE)
    tool = np.eye(4)
    tool[2, 3] = TOOL
    joints = np.random.default_rng(7).uniform(-2.0, 2.0, (options.poses, 6))
    ours = robot.compliance(joints, tool)
    work = "C66 from angles"
    candidates = [
        (f"armill {armill.__version__}", work, len(joints), "", lambda: robot.compliance(joints, tool, threads=1)),
        (f"armill {armill.__version__}, all threads", work, len(joints), "", lambda: robot.compliance(joints, tool)),
        (f"numpy {np.__version__}", work, len(joints), "whole arrays", lambda: by_numpy(joints)),
    ]
    agree("numpy", ours, by_numpy(joints))
    for peer in (of_pinocchio, of_toolbox):
        try:
            who, run = peer(robot, tool)
        except ImportError as problem:
            print("skipped", peer.__name__.removeprefix("of_"), problem, sep="\t")
            continue
        agree(who, ours, run(joints))
        candidates.append((who, work, FEW, "one by one", lambda run=run: run(joints[:FEW])))
    print_rates(candidates, QUICK_ROUNDS if options.quick else ROUNDS)
    single_calls(robot, joints[0], tool)
    many(robot, tool, options)


def agree(who, ours, theirs):
    difference = np.abs(ours - theirs).max() / np.abs(ours).max()
    print(f"{who}: {difference:.1e} from armill at {len(ours)} poses", file=sys.stderr)
    if not difference < ALLOWED:
        sys.exit(f"{who} is {difference:.1e} from armill, allowed {ALLOWED:.0e}")


def by_numpy(joints):
    """J C J^T along the drawing of the arm: lengths from bench/python/arm.py, all poses at once."""
    n = len(joints)
    turn, at = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
    axes, points = [], []

    def along(x, y, z):
        return at + turn @ np.array([x, y, z])

    def about(axis, angle):
        c, s = np.cos(angle), np.sin(angle)
        i, j = [(1, 2), (2, 0), (0, 1)]["xyz".index(axis)]
        r = np.zeros((n, 3, 3))
        r[:, [0, 1, 2], [0, 1, 2]] = 1.0
        r[:, i, i] = r[:, j, j] = c
        r[:, j, i] = s
        r[:, i, j] = -s
        return turn @ r

    # Axis, sense and the step that leads to it, joint by joint.
    chain = [
        ("z", 1, (0, 0, C1)),
        ("y", 1, (A1, 0, 0)),
        ("y", -1, (0, 0, C2)),
        ("x", -1, (0, 0, -A2)),
        ("y", -1, (C3, 0, 0)),
        ("x", -1, (0, 0, 0)),
    ]
    for joint, (axis, sign, step) in enumerate(chain):
        at = along(*step)
        axes.append(sign * turn[:, :, "xyz".index(axis)])
        points.append(at)
        turn = about(axis, sign * joints[:, joint])
    tip = along(C4 + TOOL, 0, 0)
    a = np.stack(axes, axis=2)
    arms = tip[:, :, None] - np.stack(points, axis=2)
    jacobian = np.concatenate([np.cross(a, arms, axis=1), a], axis=1)
    return (jacobian * np.array(COMPLIANCE)) @ jacobian.transpose(0, 2, 1)


def of_pinocchio(robot, tool):
    import pinocchio as pin

    from armill.interop import to_pinocchio

    model = to_pinocchio(robot)
    flange = model.frames[model.getFrameId("flange")]
    tcp = model.addFrame(pin.Frame("tcp", flange.parentJoint, flange.placement * pin.SE3(tool), pin.FrameType.OP_FRAME))
    data, c = model.createData(), np.array(COMPLIANCE)

    def run(joints):
        out = np.empty((len(joints), 6, 6))
        for i, q in enumerate(joints):
            j = pin.computeFrameJacobian(model, data, q, tcp, pin.LOCAL_WORLD_ALIGNED)
            out[i] = (j * c) @ j.T
        return out

    return f"pinocchio {pin.__version__}", run


def of_toolbox(robot, tool):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import roboticstoolbox as rtb

    from armill.interop import to_ets

    ets, c = to_ets(robot) * rtb.ET.tz(float(tool[2, 3])), np.array(COMPLIANCE)

    def run(joints):
        out = np.empty((len(joints), 6, 6))
        for i, q in enumerate(joints):
            j = ets.jacob0(q)
            out[i] = (j * c) @ j.T
        return out

    return f"Robotics Toolbox {rtb.__version__}", run


def single_calls(robot, q, tool):
    """The cost of a call for one pose: conversions, checks, the answer's array."""
    force = np.array([3.0, -5.0, 5.0])
    calls = {
        "forward": lambda: robot.forward(q),
        "jacobian": lambda: robot.jacobian(q),
        "compliance": lambda: robot.compliance(q),
        "compliance with tool": lambda: robot.compliance(q, tool),
        "deviation": lambda: robot.deviation(q, force, tool),
    }
    for name, call in calls.items():
        each = min(timeit.repeat(call, number=CALLS // 10, repeat=10)) / (CALLS // 10)
        print("one pose", name, f"{1e6 * each:.2f} us", sep="\t")


def many(robot, tool, options):
    """A million poses in one call, compared with the rate of Rust for the same work."""
    joints = np.random.default_rng(8).uniform(-2.0, 2.0, (MANY // (10 if options.quick else 1), 6))
    forces = np.array(FORCES)
    seconds = min(timeit.repeat(lambda: robot.deviation(joints, forces, tool, threads=1), number=1, repeat=3))
    rate = len(joints) * 1e-6 / seconds
    print("many poses", "dev from angles", f"{rate:.3f} M/s", f"{len(joints)} poses, one thread", sep="\t")
    if options.rust:
        print("many poses", "of the rate of Rust", f"{100 * rate / options.rust:.1f} %", sep="\t")


if __name__ == "__main__":
    main()
