"""Mean cutting forces of leaning end mills from a map of heights of the material: writes forces.tsv.

    python3 record.py          needs numpy; some minutes

The material is a layer of the depth ap over the surface z = 0, as wide as the strip that is cut. A pass before this moment
is made step by step: the heights under the body of the tool are taken away at each step behind its present position. Of the
kinds "up" and "down" the same tool has passed before next to it, of the others the sides of the strip are walls. Then
points of the edges are turned through a revolution; a point cuts where it is below the remaining height. No angle of the
engagement is computed, and no normal decides where a tooth cuts.

mm, N; x along the feed, y to its left, z along the normal of the surface.
"""

import numpy as np

# Step of the map along the feed and of the pass, and across the feed. Near the tip of a ball nose the surfaces of both passes
# are almost parallel: the map decides there for a border that is wider than its cells.
CELLS = {"ball": (0.005, 0.005), "bull": (0.01, 0.02)}
TURNS = 1440
SLICES = 500
FEED = 0.1  # per tooth
SHEAR = np.array([631.0, 99.0, 273.0])  # N/mm2: tangential, radial, axial
EDGE = np.array([13.0, 10.0, 2.8])  # N/mm
HELD_RIGHT = 1.0  # right-hand helix

# diameter, corner radius, teeth, ap, kind, ae, lead deg, tilt deg
CASES = [
    (12.0, 6.0, 2, 1.0, "slot", 0.0, 0.0, 0.0),
    (12.0, 6.0, 2, 1.0, "slot", 0.0, 15.0, 0.0),
    (12.0, 6.0, 2, 1.0, "slot", 0.0, -15.0, 10.0),
    (12.0, 6.0, 2, 0.5, "wall-up", 1.2, 20.0, 0.0),
    (12.0, 6.0, 2, 0.5, "wall-down", 1.2, 20.0, 0.0),
    (12.0, 6.0, 2, 0.5, "wall-up", 1.2, 10.0, -25.0),
    (12.0, 6.0, 2, 0.5, "wall-down", 1.2, -10.0, 25.0),
    (25.0, 5.0, 3, 1.0, "wall-up", 6.0, 0.0, 0.0),
    (25.0, 5.0, 3, 1.0, "slot", 0.0, 10.0, 0.0),
    (25.0, 5.0, 3, 1.0, "wall-up", 3.0, 5.0, 10.0),
    (25.0, 5.0, 3, 1.0, "wall-down", 3.0, 15.0, -20.0),
    (25.0, 5.0, 3, 0.6, "wall-down", 2.0, 8.0, 30.0),
    (25.0, 5.0, 3, 1.5, "slot", 0.0, -8.0, 5.0),
    (12.0, 6.0, 2, 0.5, "up", 1.2, 0.0, 0.0),
    (12.0, 6.0, 2, 0.5, "down", 1.2, 0.0, 0.0),
    (12.0, 6.0, 2, 0.5, "up", 1.2, 20.0, 0.0),
    (12.0, 6.0, 2, 0.5, "down", 1.2, 20.0, 0.0),
    (12.0, 6.0, 2, 0.5, "up", 1.2, 10.0, -25.0),
    (12.0, 6.0, 2, 0.5, "down", 1.2, -10.0, 25.0),
    (12.0, 6.0, 2, 1.0, "up", 3.0, 15.0, 0.0),
    (25.0, 5.0, 3, 1.0, "up", 6.0, 0.0, 0.0),
    (25.0, 5.0, 3, 1.0, "down", 3.0, 0.0, 0.0),
    (25.0, 5.0, 3, 1.0, "up", 3.0, 5.0, 10.0),
    (25.0, 5.0, 3, 1.0, "down", 3.0, 15.0, -20.0),
    (25.0, 5.0, 3, 0.6, "down", 2.0, 8.0, 30.0),
]


def axis_of(lead, tilt):
    """Turn the normal to the left by the tilt, then towards the feed by the lead."""
    upright = np.array([0.0, np.sin(tilt), np.cos(tilt)])
    return np.cos(lead) * upright + np.sin(lead) * np.array([1.0, 0.0, 0.0])


class Body:
    """A leaning end mill that touches the surface; its corner is balls about the points of a ring."""

    def __init__(self, diameter, corner, axis):
        self.corner, self.flat, self.axis = corner, diameter / 2 - corner, axis
        helper = np.array([0.3, 0.9, 0.1])
        u = np.cross(axis, helper)
        self.u = u / np.linalg.norm(u)
        self.v = np.cross(axis, self.u)
        angles = np.linspace(0, 2 * np.pi, 4001)
        ring = self.flat * (np.outer(np.cos(angles), self.u) + np.outer(np.sin(angles), self.v))
        # The lowest ball touches the surface.
        self.centre = np.array([0.0, 0.0, corner - ring[:, 2].min()])

    def heights(self, x, y):
        """Lowest point of the body over each position; infinite beyond it."""
        px, py = np.meshgrid(x, y, indexing="ij")
        least = np.full(px.shape, np.inf)
        count = 1 if self.flat == 0 else 720
        for angle in np.linspace(0, 2 * np.pi, count, endpoint=False):
            c = self.centre + self.flat * (np.cos(angle) * self.u + np.sin(angle) * self.v)
            i = slice(*np.searchsorted(x, [c[0] - self.corner, c[0] + self.corner]))
            j = slice(*np.searchsorted(y, [c[1] - self.corner, c[1] + self.corner]))
            under = self.corner**2 - (px[i, j] - c[0]) ** 2 - (py[i, j] - c[1]) ** 2
            ball = np.where(under >= 0, c[2] - np.sqrt(np.maximum(under, 0.0)), np.inf)
            least[i, j] = np.minimum(least[i, j], ball)
        if self.flat > 0:
            low = self.centre - self.corner * self.axis
            z = low[2] - ((px - low[0]) * self.axis[0] + (py - low[1]) * self.axis[1]) / self.axis[2]
            off = np.stack([px - low[0], py - low[1], z - low[2]], axis=-1)
            inside = np.linalg.norm(off, axis=-1) <= self.flat
            least = np.where(inside, np.minimum(least, z), least)
        # The cylinder over the corner: along its lines from the rim upwards.
        radius = self.flat + self.corner
        for angle in np.linspace(0, 2 * np.pi, 1440, endpoint=False):
            out = np.cos(angle) * self.u + np.sin(angle) * self.v
            if out[2] >= 0 or np.hypot(self.axis[0], self.axis[1]) < 1e-9:
                continue
            for s in np.arange(0.0, 12.0, 0.02):
                at = self.centre + radius * out + s * self.axis
                if at[2] > 3.0:
                    break
                i, j = np.searchsorted(x, at[0]), np.searchsorted(y, at[1])
                if 0 <= i < len(x) and 0 <= j < len(y):
                    least[i, j] = min(least[i, j], at[2])
        return least

    def edge(self, ap):
        """Points of an edge along its profile: height over the tip and radius over the axis, normal, width."""
        kappa = (np.arange(SLICES) + 0.5) / SLICES * np.pi / 2
        corner = [
            (self.corner * (1 - np.cos(k)), self.flat + self.corner * np.sin(k), np.sin(k), np.cos(k),
             self.corner * np.pi / 2 / SLICES)
            for k in kappa
        ]
        high = np.arange(SLICES) + 0.5
        length = 12.0
        cylinder = [(self.corner + s / SLICES * length, self.flat + self.corner, 1.0, 0.0, length / SLICES) for s in high]
        bottom = []
        if self.axis[0] < -1e-3:
            bottom = [(0.0, (s / SLICES) * self.flat, 0.0, 1.0, self.flat / SLICES) for s in high]
        return np.array(corner + cylinder + bottom)


def widest(heights, y, ap):
    """Right and left end of the part of the body below the upper surface, on straight lines between positions."""
    profile = heights.min(axis=0)
    below = np.flatnonzero(profile < ap)
    ends = []
    for last, step in ((below[0], -1), (below[-1], 1)):
        beyond = profile[last + step]
        part = (ap - profile[last]) / (beyond - profile[last]) if np.isfinite(beyond) else 0.5
        ends.append(y[last] + step * part * (y[1] - y[0]))
    return ends


def mean_force(diameter, corner, teeth, ap, kind, ae, lead, tilt):
    axis = axis_of(np.radians(lead), np.radians(tilt))
    body = Body(diameter, corner, axis)
    half = diameter / 2 + 2.0
    step, across = CELLS["ball" if body.flat == 0 else "bull"]
    x = np.arange(-half, half, step)
    y = np.arange(-half, half, across) + across / 2
    heights = body.heights(x, y)
    right, left = widest(heights, y, ap)
    free = (-np.inf, np.inf)
    sides = {"wall-up": (left - ae, np.inf), "wall-down": (-np.inf, right + ae)}.get(kind, free)
    # The pass: behind the present position the tool was at every step, so that over a position its heights ahead were.
    ahead = np.minimum.accumulate(heights[::-1], axis=0)[::-1]
    remaining = np.full(heights.shape, ap)
    remaining[:-1] = np.minimum(ap, ahead[1:])
    # The same tool passed before, by the stepover to the side of it that has no material.
    before = {"up": -ae, "down": ae}.get(kind)
    if before is not None:
        lowest = np.minimum(heights.min(axis=0), ap + 10.0)
        remaining = np.minimum(remaining, np.interp(y - before, y, lowest, left=ap + 10.0, right=ap + 10.0))
    edge = body.edge(ap)
    height, radius, sin_kappa, cos_kappa, width = edge.T
    force = np.zeros(3)
    for turn in range(TURNS):
        angle = 2 * np.pi * (turn + 0.5) / TURNS
        out = np.cos(angle) * body.u + np.sin(angle) * body.v
        at = body.centre + np.outer(radius, out) + np.outer(height - corner, axis)
        i = np.clip(np.searchsorted(x, at[:, 0]) - 1, 0, len(x) - 2)
        j = np.clip(np.searchsorted(y, at[:, 1]) - 1, 0, len(y) - 2)
        u, v = (at[:, 0] - x[i]) / step, (at[:, 1] - y[j]) / across
        near = remaining[i, j] * (1 - u) + remaining[i + 1, j] * u
        far = remaining[i, j + 1] * (1 - u) + remaining[i + 1, j + 1] * u
        here = near * (1 - v) + far * v
        cuts = (at[:, 2] < here) & (at[:, 2] < ap) & (at[:, 1] > sides[0]) & (at[:, 1] < sides[1])
        normal = np.outer(sin_kappa, out) - np.outer(cos_kappa, axis)
        chip = np.maximum(FEED * normal[:, 0], 0.0)
        # Clockwise, seen from the spindle: the tooth moves along out x axis; the profile goes down to the tip.
        motion = np.cross(out, axis)
        down = -np.outer(cos_kappa, out) - np.outer(sin_kappa, axis)
        per_width = SHEAR[:, None] * chip + EDGE[:, None]
        on_edge = -np.outer(per_width[0], motion) - per_width[1][:, None] * normal + HELD_RIGHT * per_width[2][:, None] * down
        force += (on_edge * (width * cuts)[:, None]).sum(axis=0)
    return force * teeth / TURNS


def main():
    with open("forces.tsv", "w", encoding="utf-8") as out:
        print("diameter", "corner", "teeth", "ap", "kind", "ae", "lead", "tilt", "fx", "fy", "fz", sep="\t", file=out)
        for case in CASES:
            force = mean_force(*case)
            print(*case, *(f"{f:.3f}" for f in force), sep="\t", file=out, flush=True)
            print(case, force)


main()
