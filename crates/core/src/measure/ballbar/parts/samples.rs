//! The samples of a circular test, as the fit of its parts uses them.

use nalgebra::{DVector, Vector2};

use super::super::centre::least_squares_centre;
use super::super::profile::Profile;
use super::super::run::{CircularTest, Direction};
use super::term::Reversal;

/// The samples of all profiles that are used, run by run.
pub(in super::super) struct Samples {
    /// Angle (rad) and direction.
    pub at: Vec<(f64, Direction)>,
    /// Radial deviation without the second-order effect of the offset, m.
    pub deviation: DVector<f64>,
    /// First sample of each run, and the end of the last one.
    pub begins: Vec<usize>,
    /// Number of runs of each circle; one circle, of one test.
    pub runs: Vec<usize>,
}

impl Samples {
    pub(in super::super) fn of(test: &CircularTest, reversals: &[Reversal]) -> Samples {
        let offset = least_squares_centre(test).map_or_else(Vector2::zeros, |centre| centre.offset);
        let radius = test.radius();
        // |R n + e| without R and e . n.
        let second_order = |angle: f64| {
            let n = Vector2::new(angle.cos(), angle.sin());
            (n * radius + offset).norm() - radius - offset.dot(&n)
        };
        let on_step = |angle: f64| {
            let mut steps = reversals.iter().flat_map(|reversal| &reversal.steps);
            steps.any(|step| step.is_at(angle))
        };
        let (mut at, mut deviation, mut begins) = (Vec::new(), Vec::new(), vec![0]);
        for run in test.runs() {
            for (angle, dr) in Profile::of(run).samples().filter(|(angle, _)| !on_step(*angle)) {
                at.push((angle, run.direction()));
                deviation.push(dr - second_order(angle));
            }
            begins.push(at.len());
        }
        Samples {
            at,
            deviation: deviation.into(),
            runs: vec![begins.len() - 1],
            begins,
        }
    }

    /// Those of several circles, one after the other.
    pub(in super::super) fn joined(circles: &[Samples]) -> Samples {
        let (mut at, mut deviation, mut begins) = (Vec::new(), Vec::new(), vec![0]);
        for circle in circles {
            begins.extend(circle.begins[1..].iter().map(|begin| at.len() + begin));
            at.extend_from_slice(&circle.at);
            deviation.extend_from_slice(circle.deviation.as_slice());
        }
        Samples {
            at,
            deviation: deviation.into(),
            begins,
            runs: circles.iter().flat_map(|circle| circle.runs.clone()).collect(),
        }
    }
}
