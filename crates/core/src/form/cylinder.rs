//! Cylinders: least squares, minimum zone, inscribed and circumscribed, size and position.
//!
//! ```text
//! d = |(p - c) x a|                     distance of a point from the axis
//! least squares     sum of (d - R)^2 least                         size GG (ISO 14405-1): 2 R
//! minimum zone      max d - min d least: cylindricity (ISO 1101, ISO 12180), size GC
//! inscribed         min d largest                                  size GX: 2 min d
//! circumscribed     max d least                                    size GN: 2 max d
//! position          2 max over the length of the distance of the axis from its nominal one (ISO 1101)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p`, `c`, `a` | point; point of the axis and its direction | m, -|
//! | `d`, `R` | distance from the axis, radius | m |
//!
//! The last three are found by steps of linear minimax about the cylinder of the step before: `d` falls by
//! `u (e + t z)` where the axis moves by `e` and tilts by `t` at the height `z`, `u` the direction of the point from the axis.
//! A step is halved until the true value falls. `d` is convex in `e` and `t`: the lines found earlier for the farthest points stay
//! below it and are kept, so that steps do not alternate where curvature decides (Kelley's cutting planes). The result is a
//! local optimum near the start, which for form errors far below the radius is the global one; the value and the promise of
//! the linear model, which no cylinder near it falls below, differ by at most 1e-9 of the radius. Valid for a feature longer than its form error over the tilt that matters: a short
//! ring has no axis.
//! Source: ISO 12180-1; J. Kelley, The cutting-plane method for solving convex programs, J. SIAM 8, 1960; linear steps as in T. Murthy, S. Abdin, Minimum zone evaluation of surfaces, Int. J. Mach. Tool
//! Des. Res. 20, 1980 \[recalled\].

use nalgebra::{DMatrix, Point3, UnitVector3, Vector3};

use super::chebyshev::{ResidualSide, SupportRow, minimax};
use super::error::FormError;
use super::plane::{known, range};
use crate::least_squares::{Problem, Triangle, descend};

/// A step whose linear model promises less than this part of the radius is the last.
const SETTLED: f64 = 1e-13;
/// After the last step this is sufficient.
const SUFFICIENT: f64 = 1e-9;
/// Maximum number of steps; four to twenty are usual.
const MOST_ROUNDS: usize = 60;
/// A step is halved at most this many times.
const MOST_HALVINGS: usize = 8;
/// Points that one block of least squares takes.
const POINTS_AT_ONCE: usize = 4_096;

/// A cylinder without ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// A point of the axis, m; of a result the one next to the mean of the points.
    pub at: Point3<f64>,
    /// Direction of the axis.
    pub axis: UnitVector3<f64>,
    /// m
    pub radius: f64,
}

/// Form and size of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderForm {
    /// The least-squares cylinder (size GG).
    pub least_squares: Cylinder,
    /// Peak to valley about it (CYLt), m.
    pub peak_to_valley: f64,
    /// The cylinder in the middle of the minimum zone.
    pub minimum_zone: Cylinder,
    /// Cylindricity: the width of the minimum zone, m.
    pub cylindricity: f64,
    /// The largest inscribed cylinder (size GX); `None` where the points do not enclose one.
    pub inscribed: Option<Cylinder>,
    /// The smallest circumscribed cylinder (size GN); `None` where the points do not bound one.
    pub circumscribed: Option<Cylinder>,
}

/// A nominal axis over the length of its feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSegment {
    /// One end, m.
    pub from: Point3<f64>,
    /// The other end, m.
    pub to: Point3<f64>,
}

impl Cylinder {
    /// Distance of a point from the axis, m.
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        self.across(point).norm()
    }

    /// From the axis to the point, across the axis.
    fn across(&self, point: &Point3<f64>) -> Vector3<f64> {
        let from = point - self.at;
        from - self.axis.as_ref() * from.dot(&self.axis)
    }

    /// Two directions across the axis, of length 1.
    pub(super) fn directions(&self) -> [Vector3<f64>; 2] {
        let x = Vector3::ith(self.axis.iamin(), 1.0);
        let x = (x - self.axis.as_ref() * x.dot(&self.axis)).normalize();
        [x, self.axis.cross(&x)]
    }

    /// Its axis displaced and tilted: along the first direction and the second, slopes along them, and the radius.
    fn changed(&self, by: [f64; 5]) -> Cylinder {
        let [x, y] = self.directions();
        let axis = self.axis.as_ref() + x * by[2] + y * by[3];
        Cylinder {
            at: self.at + x * by[0] + y * by[1],
            axis: UnitVector3::new_normalize(axis),
            radius: self.radius + by[4],
        }
    }

    /// Position of the axis (ISO 1101): the diameter of the cylinder about the nominal axis that contains this axis over the
    /// length of the feature, m. `None` where it is across the nominal axis.
    pub fn position(&self, nominal: &AxisSegment) -> Option<f64> {
        let along = (nominal.to - nominal.from).try_normalize(0.0)?;
        let rise = self.axis.dot(&along);
        if rise.abs() < f64::EPSILON {
            return None;
        }
        let off = |end: &Point3<f64>| {
            let to_plane = (end - self.at).dot(&along) / rise;
            (self.at + self.axis.as_ref() * to_plane - end).norm()
        };
        Some(2.0 * off(&nominal.from).max(off(&nominal.to)))
    }

    /// This cylinder with the point of its axis next to `point`.
    fn at_height_of(&self, point: &Point3<f64>) -> Cylinder {
        let along = self.axis.dot(&(point - self.at));
        Cylinder {
            at: self.at + self.axis.as_ref() * along,
            ..*self
        }
    }
}

/// Form and size of the cylinder of `points` (m) near a nominal one.
///
/// # Errors
/// Fewer than five points, values that are not finite, points that do not determine the axis.
pub fn cylinder_form(points: &[Point3<f64>], nominal: &Cylinder) -> Result<CylinderForm, FormError> {
    let least_squares = least_squares_cylinder(points, nominal)?;
    let [least, largest] = distances(points, &least_squares);
    let minimum_zone = optimal(points, &least_squares, Aim::Zone)?;
    let [low, high] = distances(points, &minimum_zone);
    let enclosed = |aim| match optimal(points, &least_squares, aim) {
        Ok(found) => Ok(Some(found)),
        Err(FormError::OneSided | FormError::Undetermined) => Ok(None),
        Err(wrong) => Err(wrong),
    };
    Ok(CylinderForm {
        least_squares,
        peak_to_valley: largest - least,
        minimum_zone,
        cylindricity: high - low,
        inscribed: enclosed(Aim::Inscribed)?,
        circumscribed: enclosed(Aim::Circumscribed)?,
    })
}

/// The least-squares cylinder of `points` (m) near a nominal one.
///
/// # Errors
/// Fewer than five points, values that are not finite, points that do not determine the axis.
pub fn least_squares_cylinder(points: &[Point3<f64>], nominal: &Cylinder) -> Result<Cylinder, FormError> {
    known(points, 5)?;
    known(&[nominal.at, Point3::from(Vector3::repeat(nominal.radius))], 1)?;
    let mean = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let fit = Fit {
        points,
        half_length: half_length(points, nominal),
    };
    let start = nominal.at_height_of(&mean.into());
    let found = descend(&fit, start).ok_or(FormError::Undetermined)?;
    let found = found.at_height_of(&mean.into());
    match found.radius > 0.0 && found.radius.is_finite() {
        true => Ok(found),
        false => Err(FormError::Undetermined),
    }
}

/// Half the length of the points along the axis, m; 1 of none.
fn half_length(points: &[Point3<f64>], about: &Cylinder) -> f64 {
    let [low, high] = range(points.iter().map(|p| (p - about.at).dot(&about.axis)));
    match high > low {
        true => 0.5 * (high - low),
        false => 1.0,
    }
}

/// The least and the largest distance from the axis, m.
fn distances(points: &[Point3<f64>], cylinder: &Cylinder) -> [f64; 2] {
    range(points.iter().map(|p| cylinder.distance(p)))
}

/// The least-squares problem; tilts are in displacements at half the length.
struct Fit<'a> {
    points: &'a [Point3<f64>],
    half_length: f64,
}

impl Problem for Fit<'_> {
    type State = Cylinder;

    fn triangle(&self, state: &Cylinder) -> Triangle {
        let mut triangle = Triangle::new(5);
        for points in self.points.chunks(POINTS_AT_ONCE) {
            let mut rows = DMatrix::zeros(points.len(), 6);
            let across = Across {
                directions: state.directions(),
                reach: self.half_length,
            };
            for (k, point) in points.iter().enumerate() {
                let row = gradient(state, point, &across);
                for (column, value) in row
                    .falls
                    .into_iter()
                    .chain([1.0, row.distance - state.radius])
                    .enumerate()
                {
                    rows[(k, column)] = value;
                }
            }
            triangle.take(&rows);
        }
        triangle
    }

    fn cost(&self, state: &Cylinder) -> f64 {
        let squares = self
            .points
            .iter()
            .map(|p| (state.distance(p) - state.radius).powi(2));
        squares.sum()
    }

    fn changed(&self, state: &Cylinder, by: &[f64]) -> Cylinder {
        let tilt = |k: usize| by[k] / self.half_length;
        state.changed([by[0], by[1], tilt(2), tilt(3), by[4]])
    }
}

/// Directions in which the axis moves, and the height at which a tilt is measured.
struct Across {
    directions: [Vector3<f64>; 2],
    // unit: m
    reach: f64,
}

/// Distance of a point from the axis, and how it falls with displacements of the axis and tilts (at the reach).
struct Gradient {
    distance: f64,
    falls: [f64; 4],
}

fn gradient(cylinder: &Cylinder, point: &Point3<f64>, across: &Across) -> Gradient {
    let radial = cylinder.across(point);
    let distance = radial.norm();
    let [x, y] = across.directions;
    // A point on the axis has no direction from it.
    let u = if distance > 0.0 { radial / distance } else { x };
    let z = (point - cylinder.at).dot(&cylinder.axis) / across.reach;
    let (ux, uy) = (u.dot(&x), u.dot(&y));
    Gradient {
        distance,
        falls: [ux, uy, ux * z, uy * z],
    }
}

/// What is made least.
#[derive(Clone, Copy)]
enum Aim {
    /// The difference of the largest and the least distance.
    Zone,
    /// The negative of the least distance.
    Inscribed,
    /// The largest distance.
    Circumscribed,
}

impl Aim {
    /// The value that is made least, m.
    fn value(self, distances: [f64; 2]) -> f64 {
        match self {
            Aim::Zone => distances[1] - distances[0],
            Aim::Inscribed => -distances[0],
            Aim::Circumscribed => distances[1],
        }
    }
}

/// The best cylinder near `start`; its radius is that of the middle of the zone, or of the cylinder that touches.
fn optimal(points: &[Point3<f64>], start: &Cylinder, aim: Aim) -> Result<Cylinder, FormError> {
    let mut search = Search {
        points,
        start,
        half_length: half_length(points, start),
        aim,
        lines: Vec::new(),
    };
    let mut best = [0.0; 4];
    let mut value = search.value(&best);
    let mut promised = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        let step = search.step(&best)?;
        promised = value - step.value;
        if promised <= SETTLED * start.radius {
            break;
        }
        search.keep_lines(&step);
        let mut next = step.at;
        for _ in 0..MOST_HALVINGS {
            let there = search.value(&next);
            if there < value {
                (best, value) = (next, there);
                break;
            }
            next = std::array::from_fn(|k| 0.5 * (best[k] + next[k]));
        }
    }
    match promised <= SUFFICIENT * start.radius {
        true => Ok(search.finished(&best)),
        false => Err(FormError::NotFound { rounds: MOST_ROUNDS }),
    }
}

/// The search from one start: states are displacements and tilts (at half the length) of the axis of the start.
struct Search<'a> {
    points: &'a [Point3<f64>],
    start: &'a Cylinder,
    half_length: f64,
    aim: Aim,
    /// Lines below the distances of the farthest points: falls, and the right-hand side.
    lines: Vec<([f64; 4], f64)>,
}

/// The optimum of a linear model.
struct LinearStep {
    at: [f64; 4],
    /// What the model promises there.
    value: f64,
    /// Points whose distance is the largest there.
    farthest: Vec<usize>,
}

impl Search<'_> {
    fn cylinder(&self, state: &[f64; 4]) -> Cylinder {
        let tilt = |k: usize| state[k] / self.half_length;
        self.start.changed([state[0], state[1], tilt(2), tilt(3), 0.0])
    }

    fn value(&self, state: &[f64; 4]) -> f64 {
        self.aim.value(distances(self.points, &self.cylinder(state)))
    }

    /// The directions at a state: the tilts are those of the start.
    fn across(&self, state: &[f64; 4]) -> Across {
        let slope = (state[2] * state[2] + state[3] * state[3]) / (self.half_length * self.half_length);
        Across {
            directions: self.start.directions(),
            reach: self.half_length * (1.0 + slope).sqrt(),
        }
    }

    /// The line of a point at a state: falls, and the distance at the start of the line.
    fn line(&self, gradient: &Gradient, state: &[f64; 4]) -> ([f64; 4], f64) {
        let before: f64 = gradient.falls.iter().zip(state).map(|(fall, by)| fall * by).sum();
        (gradient.falls, gradient.distance + before)
    }

    /// The optimum of the linear model about a state.
    fn step(&self, state: &[f64; 4]) -> Result<LinearStep, FormError> {
        let (cylinder, across) = (self.cylinder(state), self.across(state));
        let count = self.points.len();
        let own = self
            .points
            .iter()
            .map(|p| self.line(&gradient(&cylinder, p, &across), state));
        let all: Vec<([f64; 4], f64)> = own.chain(self.lines.iter().copied()).collect();
        let farthest = |support: &[SupportRow]| {
            let rows = support.iter().filter(|s| s.sign > 0.0 && s.row < count);
            rows.map(|s| s.row).collect()
        };
        if matches!(self.aim, Aim::Zone) {
            let with_radius = |line: &([f64; 4], f64)| {
                let [a, b, c, d] = line.0;
                [a, b, c, d, 1.0]
            };
            let falls: Vec<[f64; 5]> = all.iter().map(with_radius).collect();
            let right: Vec<f64> = all.iter().map(|line| line.1 - self.start.radius).collect();
            let found = minimax(&falls, &right, ResidualSide::Both)?;
            let [a, b, c, d, _] = found.unknowns;
            return Ok(LinearStep {
                at: [a, b, c, d],
                value: 2.0 * found.level,
                farthest: farthest(&found.support),
            });
        }
        let sign = if matches!(self.aim, Aim::Inscribed) {
            -1.0
        } else {
            1.0
        };
        let falls: Vec<[f64; 4]> = all.iter().map(|line| line.0.map(|fall| sign * fall)).collect();
        let right: Vec<f64> = all.iter().map(|line| sign * line.1).collect();
        let found = minimax(&falls, &right, ResidualSide::Above)?;
        Ok(LinearStep {
            at: found.unknowns,
            value: found.level,
            farthest: farthest(&found.support),
        })
    }

    /// Keeps the lines of the farthest points at the end of a step; those of the nearest points would be above their distances.
    fn keep_lines(&mut self, step: &LinearStep) {
        if matches!(self.aim, Aim::Inscribed) {
            return;
        }
        let (cylinder, across) = (self.cylinder(&step.at), self.across(&step.at));
        let far = (0..self.points.len()).fold(0, |far, k| {
            let farther = cylinder.distance(&self.points[k]) > cylinder.distance(&self.points[far]);
            if farther { k } else { far }
        });
        for row in step.farthest.iter().copied().chain([far]) {
            let line = self.line(&gradient(&cylinder, &self.points[row], &across), &step.at);
            self.lines.push(line);
        }
    }

    fn finished(&self, state: &[f64; 4]) -> Cylinder {
        let cylinder = self.cylinder(state);
        let [low, high] = distances(self.points, &cylinder);
        let radius = match self.aim {
            Aim::Zone => 0.5 * (low + high),
            Aim::Inscribed => low,
            Aim::Circumscribed => high,
        };
        Cylinder { radius, ..cylinder }
    }
}

#[cfg(test)]
mod tests;
