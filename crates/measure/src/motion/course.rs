//! The programmed path of a stretch: straight moves and their corners, from the log of the path that was followed.
//!
//! Corners are where the path turns at once; the moves between them are lines, arcs or other curves by their middle parts. Of a stretch of lines
//! the corners are where the lines cross, and the joint positions along each line are polynomials of the distance along it: what the controller
//! rounds at the corners does not enter.

use std::ops::Range;

use armill_core::motion::Programmed;
use armill_core::nalgebra::{DMatrix, DVector, Point3};

use super::line::{Line, circle};

/// Distance of the points at which directions are compared, relative to the length of the stretch, and at least, m.
const REACH: (f64, f64) = (0.02, 5e-3);
/// Points of a stretch for the search of corners.
const POINTS: f64 = 400.0;
/// A corner turns by more than this, rad, ...
const LEAST_TURN: f64 = 0.17;
/// ... and than this number of usual turns.
const TURNS: f64 = 4.0;
/// Part at each end of a move that is not used for its shape.
const ENDS: f64 = 0.15;
/// A line is as straight as this, relative to its length, ...
const STRAIGHT: f64 = 1e-3;
/// ... and at least, m.
const STRAIGHT_AT_LEAST: f64 = 1e-4;
/// A shorter stretch has no moves, m.
const SHORTEST: f64 = 0.01;
/// Degrees of the joint positions along a line.
const DEGREES: (usize, usize) = (3, 5);
/// A degree is as good as a higher one whose variance is this part of its own at least.
const AS_GOOD: f64 = 1.2;
/// Step of the programmed points, m.
const STEP: f64 = 1e-3;
/// Points of a move at most.
const MOST_POINTS: f64 = 2000.0;

/// Shape of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A line.
    Line,
    /// An arc of this radius, m.
    Arc(f64),
    /// Another curve of the tip.
    Curve,
    /// A joint move.
    JointMove,
}

/// A move of a stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct MovePart {
    /// Its instants.
    pub range: Range<usize>,
    /// Its shape.
    pub shape: Shape,
    /// Its length, m.
    pub length: f64,
}

/// The straight moves of a stretch.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// Start, corners and end, m.
    pub vertices: Vec<Point3<f64>>,
    /// Programmed points of each move, its vertices included, m.
    points: Vec<Vec<Point3<f64>>>,
    /// Joint positions there, rad.
    positions: Vec<Vec<f64>>,
}

/// The moves of a stretch whose instants `range` move; `tips` are those of the whole log.
pub(super) fn moves(tips: &[Point3<f64>], range: &Range<usize>) -> Vec<MovePart> {
    let length: f64 = way(tips, range);
    if length < SHORTEST {
        return vec![MovePart {
            range: range.clone(),
            shape: Shape::Curve,
            length,
        }];
    }
    let mut corners = corners(tips, range, length);
    loop {
        let parts = parts(tips, range, &corners);
        // Noise may look like a corner: lines on both sides in the same direction have none between them.
        let straight = (0..corners.len()).find(|k| {
            let both = [0, 1].map(|side| {
                let part = &parts[k + side];
                let is_line = part.shape == Shape::Line;
                Line::through(&middle(tips, &part.range, part.length)).filter(|_| is_line)
            });
            matches!(both, [Some(one), Some(other)] if one.direction.angle(&other.direction) < 0.5 * LEAST_TURN)
        });
        match straight {
            Some(k) => _ = corners.remove(k),
            None => return parts,
        }
    }
}

/// The moves between these corners.
fn parts(tips: &[Point3<f64>], range: &Range<usize>, corners: &[usize]) -> Vec<MovePart> {
    let starts = std::iter::once(range.start).chain(corners.iter().copied());
    let ends = corners.iter().copied().chain([range.end]);
    starts
        .zip(ends)
        .map(|(start, end)| {
            let range = start..end;
            let length = way(tips, &range);
            MovePart {
                shape: shape(&middle(tips, &range, length), length),
                range,
                length,
            }
        })
        .collect()
}

fn way(tips: &[Point3<f64>], range: &Range<usize>) -> f64 {
    tips[range.clone()]
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm())
        .sum()
}

/// The instants of the corners.
fn corners(tips: &[Point3<f64>], range: &Range<usize>, length: f64) -> Vec<usize> {
    // Points at even distances, without the noise of rests.
    let step = length / POINTS;
    let mut kept = vec![range.start];
    for index in range.clone() {
        if (tips[index] - tips[kept[kept.len() - 1]]).norm() >= step {
            kept.push(index);
        }
    }
    let reach = (REACH.0 * length).max(REACH.1);
    let back = |from: usize, sign: isize| -> Option<usize> {
        let mut at = from;
        while (tips[kept[at]] - tips[kept[from]]).norm() < reach {
            at = at.checked_add_signed(sign).filter(|at| *at < kept.len())?;
        }
        Some(at)
    };
    let turns: Vec<f64> = (0..kept.len())
        .map(|k| match (back(k, -1), back(k, 1)) {
            (Some(before), Some(after)) => {
                let here = tips[kept[k]];
                (here - tips[kept[before]]).angle(&(tips[kept[after]] - here))
            }
            _ => 0.0,
        })
        .collect();
    let mut sorted = turns.clone();
    sorted.sort_by(f64::total_cmp);
    let least = LEAST_TURN.max(TURNS * sorted[sorted.len() / 2]);
    let mut found: Vec<usize> = Vec::new();
    for k in 0..kept.len() {
        let near = |other: &usize| (tips[kept[*other]] - tips[kept[k]]).norm() < reach;
        let first = (0..k).rev().take_while(near).last().unwrap_or(k);
        let last = (k + 1..kept.len()).take_while(near).last().unwrap_or(k);
        let is_largest = turns[first..k].iter().all(|turn| *turn < turns[k])
            && turns[k + 1..=last.max(k)].iter().all(|turn| *turn <= turns[k]);
        if turns[k] > least && is_largest {
            found.push(kept[k]);
        }
    }
    found
}

/// The instants of the middle of a move, m.
fn middle(tips: &[Point3<f64>], range: &Range<usize>, length: f64) -> Vec<Point3<f64>> {
    let mut along = 0.0;
    let mut found = Vec::new();
    for index in range.clone() {
        if index > range.start {
            along += (tips[index] - tips[index - 1]).norm();
        }
        if (ENDS * length..(1.0 - ENDS) * length).contains(&along) {
            found.push(tips[index]);
        }
    }
    found
}

fn shape(middle: &[Point3<f64>], length: f64) -> Shape {
    let most = (STRAIGHT * length).max(STRAIGHT_AT_LEAST);
    let Some(line) = Line::through(middle).filter(|_| middle.len() > 4) else {
        return Shape::Curve;
    };
    let mut offsets: Vec<f64> = middle.iter().map(|point| line.offset(point).norm()).collect();
    offsets.sort_by(f64::total_cmp);
    // A few instants may be off.
    if offsets[offsets.len() * 9 / 10] < most {
        return Shape::Line;
    }
    match circle(middle) {
        Some((radius, far)) if far < most => Shape::Arc(radius),
        _ => Shape::Curve,
    }
}

impl Course {
    /// Of a stretch of lines; `None` of others. `range` has the rests before and after, `positions` and `tips` are those of the whole log.
    pub(super) fn of(
        parts: &[MovePart],
        range: &Range<usize>,
        positions: &[f64],
        tips: &[Point3<f64>],
    ) -> Option<Course> {
        let joints = positions.len() / tips.len();
        let lines: Vec<Line> = parts
            .iter()
            .map(|part| match part.shape {
                Shape::Line => Line::through(&middle(tips, &part.range, part.length)),
                _ => None,
            })
            .collect::<Option<_>>()?;
        let mut vertices = vec![lines.first()?.nearest(&tips[range.start])];
        for pair in lines.windows(2) {
            vertices.push(pair[0].crossing(&pair[1])?);
        }
        vertices.push(lines.last()?.nearest(&tips[range.end - 1]));
        let fits: Vec<Vec<DVector<f64>>> = (parts.iter().zip(&lines).zip(vertices.windows(2)))
            .map(|((part, line), ends)| polynomials(part, line, ends, positions, tips))
            .collect::<Option<_>>()?;
        let mut course = Course {
            vertices,
            points: Vec::new(),
            positions: Vec::new(),
        };
        // Both moves meet in the mean of what they give for their corner.
        let at =
            |fit: &[DVector<f64>], w: f64| -> Vec<f64> { fit.iter().map(|joint| value(joint, w)).collect() };
        let meeting: Vec<Vec<f64>> = (0..course.vertices.len())
            .map(|vertex| {
                let before = vertex.checked_sub(1).map(|k| at(&fits[k], 1.0));
                let after = fits.get(vertex).map(|fit| at(fit, -1.0));
                match (before, after) {
                    (Some(a), Some(b)) => a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect(),
                    // Where it rests.
                    (None, _) => positions[range.start * joints..][..joints].to_vec(),
                    (_, None) => positions[(range.end - 1) * joints..][..joints].to_vec(),
                }
            })
            .collect();
        for (k, fit) in fits.iter().enumerate() {
            let (from, to) = (course.vertices[k], course.vertices[k + 1]);
            let length = (to - from).norm();
            let pieces = (length / STEP).ceil().clamp(2.0, MOST_POINTS) as usize;
            let gaps = [-1.0, 1.0].map(|w| at(fit, w));
            let mut row = Vec::with_capacity((pieces + 1) * joints);
            for piece in 0..=pieces {
                let part = piece as f64 / pieces as f64;
                for (joint, fitted) in at(fit, 2.0 * part - 1.0).into_iter().enumerate() {
                    let first = meeting[k][joint] - gaps[0][joint];
                    let last = meeting[k + 1][joint] - gaps[1][joint];
                    row.push(fitted + (1.0 - part) * first + part * last);
                }
            }
            course.points.push(
                (0..=pieces)
                    .map(|piece| from + (to - from) * (piece as f64 / pieces as f64))
                    .collect(),
            );
            course.positions.push(row);
        }
        Some(course)
    }

    /// Length of each move, m.
    pub(super) fn lengths(&self) -> Vec<f64> {
        self.vertices
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).norm())
            .collect()
    }

    /// The ways from stop to stop at a feed, m/s; the corners with a zone, m, are passed, others are stops.
    pub(super) fn ways(&self, feed: f64, zones: &[Option<f64>]) -> Vec<Way> {
        let joints = self.positions[0].len() / self.points[0].len();
        let mut ways: Vec<Way> = Vec::new();
        for (k, (points, positions)) in self.points.iter().zip(&self.positions).enumerate() {
            let zone = k
                .checked_sub(1)
                .and_then(|corner| zones.get(corner).copied().flatten());
            match (zone, ways.last_mut()) {
                (Some(radius), Some(way)) => {
                    way.zones.push((way.points.len() - 1, radius));
                    way.points.extend_from_slice(&points[1..]);
                    way.positions.extend_from_slice(&positions[joints..]);
                }
                _ => ways.push(Way {
                    points: points.clone(),
                    positions: positions.clone(),
                    feeds: Vec::new(),
                    zones: Vec::new(),
                }),
            }
        }
        for way in &mut ways {
            way.feeds = vec![feed; way.points.len() - 1];
        }
        ways
    }
}

/// A way from a stop to a stop.
#[derive(Clone, Debug)]
pub(super) struct Way {
    points: Vec<Point3<f64>>,
    positions: Vec<f64>,
    feeds: Vec<f64>,
    zones: Vec<(usize, f64)>,
}

impl Way {
    /// For the core.
    pub(super) fn programmed(&self) -> Programmed<'_> {
        Programmed {
            points: &self.points,
            positions: &self.positions,
            feeds: &self.feeds,
            zones: &self.zones,
        }
    }
}

/// Chebyshev polynomials of each joint between the ends of a line, from the instants that are on it.
fn polynomials(
    part: &MovePart,
    line: &Line,
    ends: &[Point3<f64>],
    positions: &[f64],
    tips: &[Point3<f64>],
) -> Option<Vec<DVector<f64>>> {
    let joints = positions.len() / tips.len();
    let (from, length) = (line.along(&ends[0]), (ends[1] - ends[0]).norm());
    if length < SHORTEST {
        return None;
    }
    let shape = middle(tips, &part.range, part.length);
    let most = shape
        .iter()
        .map(|point| line.offset(point).norm())
        .fold(0.0, f64::max);
    let used: Vec<(usize, f64)> = part
        .range
        .clone()
        .filter(|index| line.offset(&tips[*index]).norm() <= most)
        .map(|index| (index, 2.0 * (line.along(&tips[index]) - from) / length - 1.0))
        .filter(|(_, w)| w.abs() <= 1.0)
        .collect();
    if used.len() < 4 * DEGREES.1 {
        return None;
    }
    let values: Vec<DVector<f64>> = (0..joints)
        .map(|joint| {
            let column = used.iter().map(|(index, _)| positions[index * joints + joint]);
            DVector::from_iterator(used.len(), column)
        })
        .collect();
    let fit = |degree: usize| -> Option<(Vec<DVector<f64>>, f64)> {
        let basis = DMatrix::from_fn(used.len(), degree + 1, |row, k| chebyshev(k, used[row].1));
        let svd = basis.clone().svd(true, true);
        let fitted: Vec<DVector<f64>> = (values.iter())
            .map(|values| svd.solve(values, 1e-10).ok())
            .collect::<Option<_>>()?;
        let pairs = fitted.iter().zip(&values);
        let squares: f64 = pairs
            .map(|(fit, values)| (&basis * fit - values).norm_squared())
            .sum();
        Some((fitted, squares / (used.len() - degree - 1) as f64))
    };
    // The lowest degree that is about as good as the highest: ends beyond the instants used are sought.
    let (highest, least) = fit(DEGREES.1)?;
    let lower = (DEGREES.0..DEGREES.1)
        .find_map(|degree| fit(degree).filter(|(_, variance)| *variance < AS_GOOD * least));
    Some(lower.map_or(highest, |(fitted, _)| fitted))
}

fn value(coefficients: &DVector<f64>, w: f64) -> f64 {
    coefficients
        .iter()
        .enumerate()
        .map(|(k, c)| c * chebyshev(k, w))
        .sum()
}

fn chebyshev(degree: usize, w: f64) -> f64 {
    (degree as f64 * w.clamp(-1.0, 1.0).acos()).cos()
}
