//! The slice of a cylinder, cone or sphere by a plane: all within a conic.
//!
//! ```text
//! u^2 <= w^2(v) = A + 2 B v + C v^2,    v_a <= v <= v_b            w concave
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u`, `v` | coordinates in the plane: across the tool axis, and as steep as the plane | m |
//! | `w` | half the width of the slice at `v` | m |
//! | `A`, `B`, `C` | coefficients of the conic: `C < 0` an ellipse, `C >= 0` a parabola or a branch of a hyperbola | m^2, m, - |
//! | `D` | `B^2 - A C` | m^2 |
//!
//! The largest value of `a w + b v` is where its derivative is zero, or at an end. With `g = w w' = B + C v`:
//!
//! ```text
//! a g + b w = 0    =>    g = -b sqrt(D / (b^2 - a^2 C)),    v = (g - B) / C = (a^2 B^2 - b^2 A) / ((b^2 - a^2 C) (g + B))
//! ```
//!
//! Source: \[derived\].

/// A slice within a conic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) c: f64,
    /// Square root of `D`, m; `None` where the slice is empty.
    pub(super) root: Option<f64>,
    /// The side to which a parabola or hyperbola opens: the sign of this number.
    pub(super) opening: f64,
    /// Ends of `v`, m; may be infinite.
    pub(super) range: [f64; 2],
}

/// A point of the outline of a slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Farthest {
    /// Half the width there, m.
    pub(super) w: f64,
    /// m
    pub(super) v: f64,
    /// Whether `v` is within its range and not at an end of it.
    pub(super) inside: bool,
}

/// The part of a line within a slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    /// Places along the line, m.
    pub(super) ends: [f64; 2],
    /// Whether an end is on the outline and not where the range ends.
    pub(super) on_outline: [bool; 2],
}

impl Chord {
    /// What of a line is within the outline and within the range.
    #[inline]
    pub(super) fn of(outline: [f64; 2], range: [f64; 2]) -> Option<Chord> {
        let ends = [outline[0].max(range[0]), outline[1].min(range[1])];
        (ends[0] <= ends[1]).then_some(Chord {
            ends,
            on_outline: [outline[0] > range[0], outline[1] < range[1]],
        })
    }
}

/// A straight line in the plane: `u = u_0 + s u_s`, `v = v_0 + s v_s`.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneLine {
    pub(super) start: [f64; 2],
    pub(super) rate: [f64; 2],
}

impl PlaneLine {
    /// The part with `v` in this range.
    #[inline]
    pub(super) fn within(&self, [low, high]: [f64; 2]) -> Option<[f64; 2]> {
        let (v, rate) = (self.start[1], self.rate[1]);
        if rate == 0.0 {
            return (v >= low && v <= high).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let ends = [(low - v) / rate, (high - v) / rate];
        let ends = if rate > 0.0 { ends } else { [ends[1], ends[0]] };
        (ends[0] <= ends[1]).then_some(ends)
    }
}

impl Conic {
    /// Where `a w + b v` is largest; `None` where the slice is empty. `a` is not negative.
    #[inline]
    pub(super) fn farthest(&self, a: f64, b: f64) -> Option<Farthest> {
        let root = self.root?;
        let [low, high] = self.range;
        let v = self.stationary(a, b, root);
        // An end that is not a number is that of an ellipse of no size.
        let v = if v.is_nan() { -self.b / self.c } else { v };
        let clamped = v.max(low).min(high);
        let square = self.a + clamped * (2.0 * self.b + clamped * self.c);
        let inside = v > low && v < high;
        if square < 0.0 && !inside {
            return None;
        }
        Some(Farthest {
            w: square.max(0.0).sqrt(),
            v: clamped,
            inside,
        })
    }

    /// Where the derivative of `a w + b v` is zero; infinite, or an end, where it is zero nowhere.
    #[inline]
    fn stationary(&self, a: f64, b: f64, root: f64) -> f64 {
        let [low, high] = self.range;
        let excess = b * b - a * a * self.c;
        if self.c >= 0.0 {
            if self.opening == 0.0 {
                // Two parallel lines.
                return if b < 0.0 { low } else { high };
            }
            if excess <= 0.0 || b * self.opening >= 0.0 {
                return if self.opening > 0.0 { high } else { low };
            }
        }
        let g = -b * root / excess.sqrt();
        if g * self.b > 0.0 {
            (a * a * self.b * self.b - b * b * self.a) / (excess * (g + self.b))
        } else {
            (g - self.b) / self.c
        }
    }

    /// The part of a line within the slice.
    #[inline]
    pub(super) fn meets(&self, line: &PlaneLine) -> Option<Chord> {
        self.root?;
        let range = line.within(self.range)?;
        let ([u, v], [du, dv]) = (line.start, line.rate);
        let slope = self.b + self.c * v;
        let square = du * du - self.c * dv * dv;
        let half = u * du - slope * dv;
        let rest = u * u - (self.a + v * (self.b + slope));
        if square == 0.0 && half == 0.0 {
            return (rest <= 0.0).then_some(Chord {
                ends: range,
                on_outline: [false; 2],
            });
        }
        let discriminant = half * half - square * rest;
        let inside = if square < 0.0 {
            // The line is steeper than the cone: it enters one of both nappes and does not leave it.
            let q = -(half + discriminant.max(0.0).sqrt().copysign(half));
            let (one, other) = (q / square, if q == 0.0 { 0.0 } else { rest / q });
            if dv * self.opening > 0.0 {
                [one.max(other), f64::INFINITY]
            } else {
                [f64::NEG_INFINITY, one.min(other)]
            }
        } else {
            if discriminant < 0.0 {
                return None;
            }
            let q = -(half + discriminant.sqrt().copysign(half));
            let (one, other) = (q / square, if q == 0.0 { 0.0 } else { rest / q });
            [one.min(other), one.max(other)]
        };
        Chord::of(inside, range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slice of a cone `x^2 + y^2 <= (p + k h)^2`, `0 <= h <= 1`, by the plane at `y` that is turned by `turn`.
    fn of_cone(p: f64, slope: f64, y: f64, turn: f64) -> Conic {
        let (sin, cos) = turn.sin_cos();
        let opening = slope * sin;
        Conic {
            a: p * p - y * y,
            b: p * opening - y * cos,
            c: opening * opening - cos * cos,
            root: Some((p * cos - y * opening).abs()),
            opening,
            range: [0.0, 1.0 / sin],
        }
    }

    /// Half the width at `v` by its definition; not a number beyond the slice.
    fn width(p: f64, slope: f64, y: f64, turn: f64, v: f64) -> f64 {
        let radius = p + slope * v * turn.sin();
        let across = y + v * turn.cos();
        (radius * radius - across * across).sqrt()
    }

    #[test]
    fn the_farthest_point_is_that_of_sampled_widths() {
        for (p, slope, y, turn) in [
            (0.3, 0.4, 0.1, 1.0),
            (0.3, 0.4, 0.1, 1.4),
            (0.3, 1.5, 0.2, 1.0),
            (0.3, 1.5, -0.5, 1.3),
            (0.3, 0.0, 0.1, 0.9),
            (0.0, 1.0, 0.1, 1.5),
            (0.5, 0.3, 0.1, 1.2793395323170296),
        ] {
            let conic = of_cone(p, slope, y, turn);
            for (a, b) in [
                (1.0, 0.5),
                (1.0, -0.5),
                (0.2, -1.0),
                (1.0, 0.0),
                (0.0, -1.0),
                (0.3, 1.0),
            ] {
                let mut best = f64::NEG_INFINITY;
                let steps = 200_000;
                for k in 0..=steps {
                    let v = conic.range[1] * f64::from(k) / f64::from(steps);
                    let value = a * width(p, slope, y, turn, v) + b * v;
                    best = best.max(value);
                }
                match conic.farthest(a, b) {
                    None => assert_eq!(best, f64::NEG_INFINITY, "{p} {slope} {y} {turn}"),
                    Some(found) => {
                        // Between two samples where the width begins like a root: sqrt(1 / 200 000) / 2.
                        let more = a * found.w + b * found.v - best;
                        assert!(
                            more > -1e-12 && more < 2e-3,
                            "{p} {slope} {y} {turn} {a} {b}: {more}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_line_meets_the_slice_where_its_points_are_inside() {
        for (p, slope, y, turn) in [
            (0.3, 0.4, 0.1, 1.0),
            (0.3, 1.5, 0.2, 1.0),
            (0.3, 2.5, 0.2, 1.5),
            (0.4, 0.0, 0.1, 1.57),
        ] {
            let conic = of_cone(p, slope, y, turn);
            for (start, rate) in [
                ([0.1, 0.2], [1.0, 0.1]),
                ([-0.2, 0.0], [0.1, 1.0]),
                ([-0.2, 0.9], [0.3, -1.0]),
                ([0.0, 0.5], [1.0, 0.0]),
                ([0.05, 0.0], [0.0, 1.0]),
                ([9.0, 0.5], [0.0, 1.0]),
            ] {
                let line = PlaneLine { start, rate };
                let inside = |s: f64| {
                    let (u, v) = (start[0] + s * rate[0], start[1] + s * rate[1]);
                    v >= 0.0 && v <= conic.range[1] && u.abs() <= width(p, slope, y, turn, v)
                };
                let samples = (-40_000..=40_000).map(|k| f64::from(k) * 1e-4);
                let within: Vec<f64> = samples.filter(|&s| inside(s)).collect();
                let met = conic.meets(&line).map(|chord| chord.ends);
                match (within.first(), within.last(), met) {
                    (None, None, None) => {}
                    (Some(first), Some(last), Some([low, high])) => {
                        let off = [first - low, high - last];
                        assert!(off.iter().all(|off| (-1e-9..1.001e-4).contains(off)), "{off:?}");
                    }
                    other => unreachable!("{p} {slope} {start:?} {rate:?}: {other:?}"),
                }
            }
        }
    }
}
