//! Data check of circular tests against the circles of a study: zero and direction of their angles, of all circles or
//! of one.
//!
//! The residual is that of the backlash fit, over all circles. Joints reverse at angles that the study predicts; steps
//! of files with another zero or a mirrored angle are elsewhere. The sign of the radii is not seen: it changes the sign
//! of every backlash, which the estimate reports.

use std::f64::consts::{FRAC_PI_2, PI};

use armill_core::measure::ballbar::joints::{BacklashOptions, Followed, Observed, fit_backlash};
use armill_core::measure::ballbar::{CircularTest, Direction, Run};
use armill_core::units::to_deg;

use super::{SlipAnswer, Trial, likely_slip};

/// A residual below this fraction of the one as given is no chance: fits have thousands of samples.
const BETTER: f64 = 0.8;

/// Another reading of the angles.
#[derive(Clone, Copy, Debug)]
struct AngleChange {
    mirrored: bool,
    /// Position of angle 0, rad.
    zero: f64,
}

impl AngleChange {
    /// Every change but the identity: zeros, the mirrored angles, both.
    fn all() -> Vec<AngleChange> {
        let zeros = [0.0, FRAC_PI_2, -FRAC_PI_2, PI];
        let both = [false, true]
            .into_iter()
            .flat_map(|mirrored| zeros.map(|zero| AngleChange { mirrored, zero }));
        both.skip(1).collect()
    }

    fn of(&self, test: &CircularTest) -> Option<CircularTest> {
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        let run = |run: &Run| {
            let direction = match (self.mirrored, run.direction()) {
                (false, direction) => direction,
                (true, Direction::Clockwise) => Direction::Anticlockwise,
                (true, Direction::Anticlockwise) => Direction::Clockwise,
            };
            let angle = run.angle().iter().map(|angle| self.zero + sign * angle).collect();
            Run::new(direction, angle, run.deviation().to_vec()).ok()
        };
        CircularTest::new(test.radius(), test.runs().iter().map(run).collect::<Option<_>>()?).ok()
    }

    fn words(&self) -> String {
        let zero = format!("zero_deg changed by {:.0} deg", to_deg(self.zero));
        match (self.mirrored, self.zero == 0.0) {
            (true, true) => "the angles mirrored (mirrored = true or false)".to_owned(),
            (true, false) => format!("the angles mirrored and {zero}"),
            (false, _) => zero,
        }
    }
}

/// The joint motion along a measured circle, its test, and the name of its analysis.
#[derive(Clone, Copy, Debug)]
pub struct NamedTest<'a> {
    /// Name of the analysis.
    pub name: &'a str,
    /// The joint motion.
    pub followed: &'a Followed,
    /// The test.
    pub test: &'a CircularTest,
}

/// The likely slip in the angles of the files of all circles or of one, where the fit as given has the residual
/// `as_given`, m.
pub fn slip(observed: &[NamedTest<'_>], requested: &BacklashOptions, as_given: f64) -> Option<SlipAnswer> {
    let trial = |change: &AngleChange, only: Option<usize>| -> Option<Trial> {
        let tests: Vec<CircularTest> = (observed.iter().enumerate())
            .map(|(circle, of)| match only {
                Some(one) if one != circle => Some(of.test.clone()),
                _ => change.of(of.test),
            })
            .collect::<Option<_>>()?;
        let changed: Vec<Observed<'_>> = (observed.iter().zip(&tests))
            .map(|(of, test)| Observed {
                followed: of.followed,
                test,
            })
            .collect();
        let found = fit_backlash(&changed, requested).ok()??;
        // A fit that needs backlash below zero explains nothing.
        let sound = found.estimates.iter().all(|gap| gap.gap > -2.0 * gap.u);
        sound.then(|| Trial {
            change: match only {
                Some(one) => format!("{} of circle {}", change.words(), observed[one].name),
                None => change.words(),
            },
            residual: found.rms_after,
        })
    };
    let changes = AngleChange::all();
    let mut trials: Vec<Trial> = (changes.iter())
        .filter_map(|change| trial(change, None))
        .collect();
    if observed.len() > 1 {
        for one in 0..observed.len() {
            trials.extend(changes.iter().filter_map(|change| trial(change, Some(one))));
        }
    }
    likely_slip(as_given, BETTER, &trials)
}
