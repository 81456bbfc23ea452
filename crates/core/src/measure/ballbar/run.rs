//! Measurement of a ball-bar: the radius along a circle, one run after the other.
//!
//! ```text
//! r(a) = R + dr(a)      a from the first axis of the plane towards the second, dr outwards positive
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R` | nominal radius | m |
//! | `a` | angle of a sample, of any size: whole turns have no effect | rad |
//! | `dr` | radial deviation there | m |
//!
//! Anticlockwise is the direction in which `a` increases.

/// Direction round the circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// Clockwise: the angle decreases.
    Clockwise,
    /// Anticlockwise: the angle increases.
    Anticlockwise,
}

impl Direction {
    /// Both, in the order of the results.
    pub const BOTH: [Direction; 2] = [Direction::Clockwise, Direction::Anticlockwise];

    /// -1 clockwise, +1 anticlockwise.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Clockwise => -1.0,
            Direction::Anticlockwise => 1.0,
        }
    }

    /// 0 clockwise, 1 anticlockwise.
    pub fn index(self) -> usize {
        usize::from(self == Direction::Anticlockwise)
    }

    /// Its name in programs and files.
    pub fn name(self) -> &'static str {
        match self {
            Direction::Clockwise => "CW",
            Direction::Anticlockwise => "CCW",
        }
    }
}

/// One run: at least [`Run::LEAST`] samples, in the order in which they came.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    direction: Direction,
    /// rad
    angle: Vec<f64>,
    /// m
    deviation: Vec<f64>,
}

/// Why samples are not a valid run, or runs not a valid test.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// Too few samples.
    #[error("a run of {0} samples is shorter than the {least} it needs", least = Run::LEAST)]
    TooShort(usize),
    /// Lists of different lengths.
    #[error("{angles} angles but {deviations} radii")]
    Lengths {
        /// Angles.
        angles: usize,
        /// Radial deviations.
        deviations: usize,
    },
    /// A number that is not finite.
    #[error("sample {0} contains a number that is not finite")]
    NotFinite(usize),
    /// A nominal radius out of range.
    #[error("a nominal radius of {} mm is not above 0 and at most {} mm", .0 * 1e3, CircularTest::LARGEST_RADIUS * 1e3)]
    Radius(f64),
    /// A deviation out of range.
    #[error("run {}, sample {}: {}", run + 1, sample + 1, CircularTest::too_far(*radius, *deviation).unwrap_or_default())]
    TooFar {
        /// Index of the run, from 0.
        run: usize,
        /// Index of the sample, from 0.
        sample: usize,
        /// m
        deviation: f64,
        /// m
        radius: f64,
    },
    /// More runs than the maximum.
    #[error("{0} runs exceed the maximum of {most} of one test", most = CircularTest::MOST_RUNS)]
    TooMany(usize),
    /// A test without runs.
    #[error("a test needs at least one run")]
    NoRuns,
}

impl Run {
    /// Minimum number of samples of a run: a turn of them leaves no gap.
    pub const LEAST: usize = 24;

    /// A run of these angles (rad) and radial deviations (m).
    ///
    /// # Errors
    /// Too few samples, lists of other lengths, numbers that are not finite.
    pub fn new(direction: Direction, angle: Vec<f64>, deviation: Vec<f64>) -> Result<Run, RunError> {
        if angle.len() != deviation.len() {
            return Err(RunError::Lengths {
                angles: angle.len(),
                deviations: deviation.len(),
            });
        }
        if angle.len() < Run::LEAST {
            return Err(RunError::TooShort(angle.len()));
        }
        let finite = |(a, dr): (&f64, &f64)| a.is_finite() && dr.is_finite();
        match angle.iter().zip(&deviation).position(|sample| !finite(sample)) {
            Some(at) => Err(RunError::NotFinite(at)),
            None => Ok(Run {
                direction,
                angle,
                deviation,
            }),
        }
    }

    /// Its direction.
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Angle of each sample, rad.
    pub fn angle(&self) -> &[f64] {
        &self.angle
    }

    /// Radial deviation of each sample, m.
    pub fn deviation(&self) -> &[f64] {
        &self.deviation
    }

    /// Angle and radial deviation of each sample.
    pub fn samples(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.angle.iter().copied().zip(self.deviation.iter().copied())
    }

    /// The same run without the samples with these indices, which increase; `None` where too few remain.
    pub fn without(&self, places: &[usize]) -> Option<Run> {
        let kept = |list: &[f64]| -> Vec<f64> {
            let kept = list.iter().enumerate();
            kept.filter(|(at, _)| places.binary_search(at).is_err())
                .map(|(_, value)| *value)
                .collect()
        };
        Run::new(self.direction, kept(&self.angle), kept(&self.deviation)).ok()
    }
}

/// Runs round one circle, in both directions or one.
#[derive(Clone, Debug, PartialEq)]
pub struct CircularTest {
    radius: f64,
    runs: Vec<Run>,
}

impl CircularTest {
    /// Longest bar, m: a longer radius has a wrong unit.
    pub const LARGEST_RADIUS: f64 = 10.0;
    /// Maximum number of runs: every two of one direction are compared.
    pub const MOST_RUNS: usize = 100;

    /// Runs round a circle of this nominal radius (m).
    ///
    /// # Errors
    /// A radius out of range, no runs or too many, a deviation of more than half the radius.
    pub fn new(radius: f64, runs: Vec<Run>) -> Result<CircularTest, RunError> {
        // NaN is refused too.
        if !(radius > 0.0 && radius <= CircularTest::LARGEST_RADIUS) {
            return Err(RunError::Radius(radius));
        }
        if runs.is_empty() {
            return Err(RunError::NoRuns);
        }
        if runs.len() > CircularTest::MOST_RUNS {
            return Err(RunError::TooMany(runs.len()));
        }
        for (run, of) in runs.iter().enumerate() {
            let far = |dr: &f64| CircularTest::too_far(radius, *dr).is_some();
            if let Some(sample) = of.deviation.iter().position(far) {
                return Err(RunError::TooFar {
                    run,
                    sample,
                    deviation: of.deviation[sample],
                    radius,
                });
            }
        }
        Ok(CircularTest { radius, runs })
    }

    /// The message for a deviation (m) that is out of range for a test of this radius (m); none for a valid one.
    pub fn too_far(radius: f64, deviation: f64) -> Option<String> {
        (deviation.abs() > 0.5 * radius).then(|| {
            let [off, nominal] = [deviation, radius].map(|metres| metres * 1e3);
            format!("the radius is off by {off} mm, more than half the nominal {nominal} mm")
        })
    }

    /// Nominal radius, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// All runs, in the order in which they came.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// The runs of one direction.
    pub fn of(&self, direction: Direction) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(move |run| run.direction == direction)
    }

    /// Whether there are runs in both directions.
    pub fn is_bidirectional(&self) -> bool {
        Direction::BOTH
            .iter()
            .all(|direction| self.of(*direction).next().is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(count: usize) -> Result<Run, RunError> {
        Run::new(Direction::Clockwise, vec![0.1; count], vec![1e-6; count])
    }

    #[test]
    fn refuses_invalid_runs() {
        assert_eq!(run(23).unwrap_err(), RunError::TooShort(23));
        assert!(run(24).is_ok());
        let odd = Run::new(Direction::Clockwise, vec![0.0; 24], vec![0.0; 25]);
        assert_eq!(odd.unwrap_err().to_string(), "24 angles but 25 radii");
        for (angle, deviation) in [(f64::NAN, 0.0), (0.0, f64::INFINITY)] {
            let run = Run::new(Direction::Clockwise, vec![angle; 24], vec![deviation; 24]);
            assert_eq!(run.unwrap_err(), RunError::NotFinite(0));
        }
    }

    #[test]
    fn refuses_invalid_tests() {
        let runs = || vec![run(24).unwrap()];
        assert!(CircularTest::new(0.1, runs()).is_ok());
        for radius in [0.0, -0.1, 10.1, f64::NAN] {
            assert!(matches!(
                CircularTest::new(radius, runs()),
                Err(RunError::Radius(_))
            ));
        }
        assert_eq!(CircularTest::new(0.1, Vec::new()), Err(RunError::NoRuns));
        let many = CircularTest::new(0.1, vec![run(24).unwrap(); 101]);
        assert_eq!(many, Err(RunError::TooMany(101)));
        let far = CircularTest::new(1.9e-6, runs()).unwrap_err().to_string();
        assert!(
            far.starts_with("run 1, sample 1: the radius is off by 0.001 mm"),
            "{far}"
        );
    }

    #[test]
    fn samples_are_removed_by_their_indices() {
        let run = Run::new(
            Direction::Anticlockwise,
            (0..26).map(f64::from).collect(),
            vec![0.0; 26],
        );
        let fewer = run.unwrap().without(&[0, 25]).unwrap();
        assert_eq!((fewer.angle()[0], fewer.angle().len()), (1.0, 24));
        assert!(fewer.without(&[3]).is_none());
    }
}
