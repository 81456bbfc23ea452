//! Deviation along a path on a plane: vectors of every load case; on a circle the radial part and the
//! roundness of the circle that comes out.

use nalgebra::{Point2, Vector2, Vector3};

use crate::kernel::{Answers, Question, evaluate_in_order};
use crate::path::{Roundness, Sample, Shape, roundness};
use crate::watch::{Cancelled, Watch};
use crate::workpiece::Plane;

/// Answers along a path.
#[derive(Clone, Debug)]
pub struct PathAnswer {
    /// The plane that the path lies on.
    pub plane: Plane,
    /// Its points.
    pub samples: Vec<Sample>,
    /// What came out at each.
    pub answers: Answers,
    /// On a circle, where every point is reached: radial deviation of each load case.
    pub radial: Vec<RadialDeviation>,
}

/// What becomes of a circle under one load case. m.
#[derive(Clone, Debug)]
pub struct RadialDeviation {
    /// Outward part of the deviation at each point.
    pub outward: Vec<f64>,
    /// The least-squares circle of the deviated points and their roundness about it.
    pub roundness: Roundness,
}

impl PathAnswer {
    /// Deviation of load case `case` at point `index` in part axes (m): in-plane x, y, then normal.
    pub fn deviation_in_part(&self, index: usize, case: usize) -> Vector3<f64> {
        self.plane.in_part(&self.answers.deviations_at(index)[case])
    }

    /// The largest roundness of all load cases, m; `None` off circles.
    pub fn worst_roundness(&self) -> Option<f64> {
        self.radial
            .iter()
            .map(|r| r.roundness.peak_to_valley)
            .max_by(f64::total_cmp)
    }
}

/// The answers along `shape` on `plane`, sampled at most `step` (m) apart.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn along_path(
    question: &Question<'_>,
    plane: Plane,
    shape: &Shape,
    step: f64,
    watch: Watch<'_>,
) -> Result<PathAnswer, Cancelled> {
    let samples = shape.sampled(step);
    let pose = |i: usize| plane.base_from_tool(samples[i].at, 0.0);
    let answers = evaluate_in_order(question, samples.len(), pose, watch)?;
    let mut path = PathAnswer {
        plane,
        samples,
        answers,
        radial: Vec::new(),
    };
    if let Shape::Circle { centre, .. } = shape {
        let cases = 0..question.cases.len();
        path.radial = cases
            .filter_map(|case| radial_deviation(&path, *centre, case))
            .collect();
    }
    Ok(path)
}

fn radial_deviation(path: &PathAnswer, centre: Point2<f64>, case: usize) -> Option<RadialDeviation> {
    if path.answers.points.iter().any(Result::is_err) {
        return None;
    }
    let in_plane = |i: usize| path.deviation_in_part(i, case).xy();
    let outward = |(i, sample): (usize, &Sample)| {
        let radial: Vector2<f64> = (sample.at - centre).normalize();
        radial.dot(&in_plane(i))
    };
    let deviated: Vec<Point2<f64>> = path
        .samples
        .iter()
        .enumerate()
        .map(|(i, sample)| sample.at + in_plane(i))
        .collect();
    Some(RadialDeviation {
        outward: path.samples.iter().enumerate().map(outward).collect(),
        roundness: roundness(&deviated)?,
    })
}
