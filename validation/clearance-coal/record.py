"""Writes pairs.tsv and arm.tsv: distances of coal for the shapes of case.rs.

    coal/bin/python validation/clearance-coal/record.py       (environment as of compare.py)

The shapes and the bodies of the arm are those of case.rs, typed again. Lengths in m, angles in deg; distances in mm with nine decimals.
"""

import itertools
import xml.etree.ElementTree as ET
from pathlib import Path

import coal
import numpy as np
import trimesh

from compare import Arm, distance, placed, solid

HERE = Path(__file__).resolve().parent
FRAMES = 8
POSTURES = 40
SEED = 2


def torus() -> trimesh.Trimesh:
    """Radii 0.25 and 0.08, 24 x 12 points, about z."""
    n, m = 24, 12
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    across = 0.25 + 0.08 * np.cos(v)
    points = np.stack([across * np.cos(u), across * np.sin(u), 0.08 * np.sin(v)], axis=-1).reshape(-1, 3)
    faces = []
    for i, j in itertools.product(range(n), range(m)):
        a, b, c, d = (k % n * m + place % m for k, place in [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)])
        faces += [[a, b, c], [a, c, d]]
    return trimesh.Trimesh(points, faces, process=False)


def angle() -> trimesh.Trimesh:
    """An L in x and y, 0.2 m high."""
    profile = [(0, 0), (0.4, 0), (0.4, 0.1), (0.1, 0.1), (0.1, 0.5), (0, 0.5)]
    points = [(x, y, z) for z in (0, 0.2) for x, y in profile]
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    faces = [(c, b, a) for a, b, c in caps] + [(a + 6, b + 6, c + 6) for a, b, c in caps]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, j + 6), (i, j + 6, i + 6)]
    mesh = trimesh.Trimesh(points, faces, process=False)
    assert mesh.is_watertight and mesh.volume > 0
    return mesh


def shapes():
    all_shapes = {
        "capsule": coal.Capsule(0.1, 0.6),
        "cylinder": coal.Cylinder(0.15, 0.4),
        "box": coal.Box(0.3, 0.4, 0.6),
        "torus": solid(torus()),
        "angle": solid(angle()),
    }
    for shape in all_shapes.values():
        shape.computeLocalAABB()
    return all_shapes


def frame(numbers) -> list[float]:
    """x, y, z in m, then rotations about the fixed axes x, y, z in deg."""
    return [*np.round(numbers.uniform(-0.8, 0.8, 3), 3), *np.round(numbers.uniform(-180, 180, 3), 1)]


def matrix(at) -> np.ndarray:
    result = trimesh.transformations.euler_matrix(*np.radians(at[3:]), "sxyz")
    result[:3, 3] = at[:3]
    return result


def pairs(numbers):
    all_shapes = shapes()
    yield "first\tsecond\tx_m\ty_m\tz_m\troll_deg\tpitch_deg\tyaw_deg\tdistance_mm"
    for first, second in itertools.combinations_with_replacement(all_shapes, 2):
        for _ in range(FRAMES):
            at = frame(numbers)
            bodies = [(all_shapes[first], placed(np.eye(4))), (all_shapes[second], placed(matrix(at)))]
            found = 1e3 * distance(*bodies, np.inf)
            yield "\t".join([first, second, *(f"{x:g}" for x in at), f"{found:.9f}"])


# The joint that a body moves with, its shape, and its frame in base at joint positions 0.
BODIES = [
    (0, "box", [-0.25, 0, 0.15, 0, 0, 0]),
    (2, "torus", [0.155, 0, 0.86, 90, 0, 0]),
    (3, "angle", [-0.1, -0.2, 1.2, 0, 0, 0]),
    (5, "capsule", [0.87, 0, 1.264, 90, 0, 0]),
    (6, "cylinder", [1.15, 0, 1.264, 0, 90, 0]),
]
OBSTACLES = [("box", [1.2, 0.9, 0.3, 0, 0, 30]), ("torus", [0.4, -1.1, 1.2, 40, 0, 0])]


def arm(numbers):
    all_shapes = shapes()
    mh12 = Arm(ET.parse(HERE.parent / "urdf-forward/mh12.urdf").getroot(), HERE)
    zero = mh12.frames(np.zeros(6))
    link_of = {rank: link for link, rank in sorted(mh12.rank.items(), reverse=True) if "tool" not in link}
    obstacles = [(all_shapes[shape], placed(matrix(at))) for shape, at in OBSTACLES]
    yield "S_deg\tL_deg\tU_deg\tR_deg\tB_deg\tT_deg\tdistance_mm"
    for _ in range(POSTURES):
        limits = np.degrees(mh12.limits)
        positions = np.round(numbers.uniform(limits[:, 0], limits[:, 1]), 2)
        frames = mh12.frames(np.radians(positions))
        bodies = []
        for rank, shape, at in BODIES:
            link = link_of[rank]
            bodies.append((rank, (all_shapes[shape], placed(frames[link] @ np.linalg.inv(zero[link]) @ matrix(at)))))
        best = np.inf
        for (one, first), (other, second) in itertools.combinations(bodies, 2):
            if other - one > 1:
                best = min(best, distance(first, second, best))
        for (rank, body), obstacle in itertools.product(bodies, obstacles):
            if rank > 0:
                best = min(best, distance(body, obstacle, best))
        yield "\t".join([*(f"{x:g}" for x in positions), f"{1e3 * best:.9f}"])


def main():
    numbers = np.random.default_rng(SEED)
    (HERE / "pairs.tsv").write_text("\n".join(pairs(numbers)) + "\n")
    (HERE / "arm.tsv").write_text("\n".join(arm(numbers)) + "\n")


if __name__ == "__main__":
    main()
