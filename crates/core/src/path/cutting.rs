//! What a cut pushes with along a path: the forces of [`Process`] at every point, told in the feed frame.
//!
//! One wrench a point, the mean over a revolution; where it is asked for also the greatest. An arm whose modes lie at some
//! 10 Hz does not follow the teeth: the mean moves it, and what the greatest force would move it if it stood still is a
//! bound. Feed and spindle are those of the program,
//! where it tells them; depths too. Engagement is the same everywhere: what the program cuts away before is not looked
//! at ([`super::stock`] knows).
//!
//! The greatest force is searched for once for each feed, spindle and depth, on the level; on a ramp it is taken to be
//! as many times the mean as there. Plunges and steep dives have no force here: the bottom of the cutter is not modelled.

use nalgebra::{Matrix3, Vector3};

use super::placing::Placing;
use super::program::{Operation, Pace};
use super::sampler::PathPoint;
use crate::load::{
    Advance, Cutter, CuttingError, CuttingForce, CuttingLaw, Immersion, LoadFrame, PathLoad, Process,
};
use crate::spatial::Wrench;

/// What cuts, and how, where the program does not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// The tool.
    pub cutter: Cutter,
    /// Force of a chip.
    pub law: CuttingLaw,
    /// Axial depth, m.
    pub depth: f64,
    /// Radial depth and its side.
    pub immersion: Immersion,
    /// Feed, m/s.
    pub feed: Option<f64>,
    /// Speed of the spindle, rad/s; clockwise.
    pub spindle: Option<f64>,
    /// Whether the greatest force is a load case too.
    pub greatest: Greatest,
}

/// What becomes of the greatest force of a revolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Greatest {
    /// The mean alone is a load case.
    LeftOut,
    /// It is the second load case.
    SecondCase,
}

/// Forces along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingForces {
    /// The wrenches at every point.
    pub load: PathLoad,
    /// Largest of the mean forces and of the greatest ones along the path, N.
    pub largest: [f64; 2],
    /// Standard uncertainty of the largest mean force over its size, from the law.
    pub relative_uncertainty: f64,
    /// Points without a force: plunges, dives too steep, withdrawals.
    pub without_force: usize,
}

/// Why there are no forces along a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoForces {
    /// Nobody tells the feed.
    #[error("line {line} cuts with a feed that is not told")]
    NoFeed {
        /// Line of the program.
        line: u32,
    },
    /// Nobody tells the speed of the spindle.
    #[error("line {line} cuts with a spindle speed that is not told")]
    NoSpindle {
        /// Line of the program.
        line: u32,
    },
    /// The cut cannot be.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program.
        line: u32,
        /// Why.
        error: CuttingError,
    },
}

impl Cutting {
    /// The forces at `points`; `operations` come with the index of their first point.
    ///
    /// # Errors
    /// [`NoForces`] at the first point where the cut is not known or cannot be.
    pub fn along(
        &self,
        points: &[PathPoint],
        operations: &[(usize, Operation)],
        placing: &Placing,
    ) -> Result<CuttingForces, NoForces> {
        let cases = match self.greatest {
            Greatest::LeftOut => 1,
            Greatest::SecondCase => 2,
        };
        let mut wrenches = Vec::with_capacity(points.len() * cases);
        let (mut largest, mut relative_uncertainty, mut without_force) = ([0.0_f64; 2], 0.0, 0);
        let mut operation = operations.iter().peekable();
        let mut process = self.process(None);
        let mut known: Option<(Process, CuttingForce)> = None;
        for (index, point) in points.iter().enumerate() {
            while let Some((_, next)) = operation.next_if(|(first, _)| *first <= index) {
                process = self.process(Some(next));
            }
            process.feed = match point.pace {
                Pace::Feed(feed) if feed > 0.0 => feed,
                _ => self.feed.ok_or(NoForces::NoFeed { line: point.line })?,
            };
            if process.spindle <= 0.0 {
                return Err(NoForces::NoSpindle { line: point.line });
            }
            let told = |error| NoForces::Cut {
                line: point.line,
                error,
            };
            let level = match &known {
                Some((of, force)) if *of == process => *force,
                _ => {
                    let force = process.force(Advance::Level).map_err(told)?;
                    known = Some((process, force));
                    force
                }
            };
            let mean = match placing.advance(point) {
                Advance::Level => level.mean,
                advance => match process.mean(advance) {
                    Ok(mean) => mean.force,
                    Err(CuttingError::Plunge { .. } | CuttingError::Withdrawal) => {
                        without_force += 1;
                        Vector3::zeros()
                    }
                    Err(error) => return Err(told(error)),
                },
            };
            let share = mean.norm() / level.mean.norm().max(f64::MIN_POSITIVE);
            let greatest = level.peak.force * share;
            wrenches.push(Wrench::from_force(mean));
            if self.greatest == Greatest::SecondCase {
                wrenches.push(Wrench::from_force(greatest));
            }
            if mean.norm() > largest[0] {
                relative_uncertainty = along(&level.covariance, &level.mean) / level.mean.norm();
            }
            largest = [largest[0].max(mean.norm()), largest[1].max(greatest.norm())];
        }
        Ok(CuttingForces {
            load: PathLoad::OfEach {
                cases,
                frame: LoadFrame::Feed,
                wrenches,
            },
            largest,
            relative_uncertainty,
            without_force,
        })
    }

    /// The process of an operation, its feed still to be told; a spindle that nobody tells stands.
    fn process(&self, operation: Option<&Operation>) -> Process {
        let depths = operation.and_then(|operation| operation.depths);
        let spindle = operation.and_then(|operation| operation.spindle).map(f64::abs);
        Process {
            cutter: self.cutter,
            law: self.law,
            depth: depths.map_or(self.depth, |depths| depths.axial),
            immersion: match (depths, self.immersion) {
                (None, immersion) => immersion,
                (Some(depths), Immersion::Up(_)) => Immersion::Up(depths.radial),
                (Some(depths), Immersion::Down(_)) => Immersion::Down(depths.radial),
                (Some(depths), Immersion::Centred(_) | Immersion::Slot) => Immersion::Centred(depths.radial),
            },
            feed: 0.0,
            spindle: spindle
                .filter(|speed| *speed > 0.0)
                .or(self.spindle)
                .unwrap_or(0.0),
        }
    }
}

/// Standard uncertainty of a force along itself.
fn along(covariance: &Matrix3<f64>, force: &Vector3<f64>) -> f64 {
    let direction = force.normalize();
    direction.dot(&(covariance * direction)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Isometry;
    use crate::load::{Hand, Mechanistic};
    use crate::path::{DepthOfCut, Spin};
    use nalgebra::{Point3, Unit};
    use std::f64::consts::TAU;

    /// The cut of `figures.md` section 4.3: 155.6207 N.
    fn cutting() -> Cutting {
        let shear = Vector3::new(1930.4e6, 1159.6e6, 200.6e6);
        let law = Mechanistic::new(shear, Vector3::zeros()).unwrap();
        let cutter = Cutter::flat(16e-3, 4).unwrap();
        Cutting {
            cutter: cutter.with_helix(45_f64.to_radians(), Hand::Right).unwrap(),
            law: CuttingLaw::Mechanistic(law.with_relative_uncertainty(0.2).unwrap()),
            depth: 1e-3,
            immersion: Immersion::Up(5e-3),
            feed: Some(40e-3),
            spindle: Some(3333.0 * TAU / 60.0),
            greatest: Greatest::SecondCase,
        }
    }

    fn point(direction: [f64; 3], pace: Pace) -> PathPoint {
        PathPoint {
            at: Point3::origin(),
            axis: None,
            direction: Unit::new_normalize(direction.into()),
            along: 0.0,
            pace,
            line: 7,
        }
    }

    fn placing() -> Placing {
        Placing {
            base_from_path: Isometry::identity(),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        }
    }

    fn forces(
        cutting: &Cutting,
        points: &[PathPoint],
        operations: &[(usize, Operation)],
    ) -> Vec<Vector3<f64>> {
        let found = cutting.along(points, operations, &placing()).unwrap();
        let PathLoad::OfEach { wrenches, .. } = found.load else {
            panic!("each point has its own")
        };
        wrenches.iter().map(|wrench| wrench.force).collect()
    }

    #[test]
    fn the_mean_force_is_the_published_one_wherever_the_feed_goes() {
        for direction in [[1.0, 0.0, 0.0], [-0.3, 0.8, 0.0]] {
            let both = forces(&cutting(), &[point(direction, Pace::Untold)], &[]);
            assert!((both[0].norm() - 155.6207).abs() < 5e-5, "{}", both[0]);
            assert!(both[1].norm() > both[0].norm());
            let alone = Cutting {
                greatest: Greatest::LeftOut,
                ..cutting()
            };
            assert_eq!(forces(&alone, &[point(direction, Pace::Untold)], &[]), both[..1]);
        }
    }

    #[test]
    fn feed_spindle_and_depths_are_those_of_the_program_where_it_tells_them() {
        let slow = Operation {
            spindle: Some(3333.0 * TAU / 60.0 / 2.0),
            depths: Some(DepthOfCut {
                axial: 2e-3,
                radial: 5e-3,
            }),
            ..Operation::default()
        };
        let points = [
            point([1.0, 0.0, 0.0], Pace::Feed(40e-3)),
            point([1.0, 0.0, 0.0], Pace::Feed(20e-3)),
        ];
        let found = forces(&cutting(), &points, &[(1, slow)]);
        // Half the feed at half the speed is the same chip; twice the depth is twice the force.
        assert!((found[2] - found[0] * 2.0).norm() < 1e-9);
    }

    #[test]
    fn a_ramp_keeps_the_share_of_its_greatest_force_and_a_plunge_has_none() {
        let points = [
            point([1.0, 0.0, -0.2], Pace::Untold),
            point([0.0, 0.0, -1.0], Pace::Untold),
        ];
        let found = cutting().along(&points, &[], &placing()).unwrap();
        assert_eq!(found.without_force, 1);
        let level = cutting().along(&points[..1], &[], &placing()).unwrap();
        assert!((level.relative_uncertainty - 0.2).abs() < 0.1);
        let PathLoad::OfEach { wrenches, .. } = found.load else {
            panic!("each point has its own")
        };
        let flat = forces(&cutting(), &[point([1.0, 0.0, 0.0], Pace::Untold)], &[]);
        let (mean, peak) = (wrenches[0].force.norm(), wrenches[1].force.norm());
        assert!((peak / mean - flat[1].norm() / flat[0].norm()).abs() < 1e-12);
        assert_eq!(wrenches[2].force, Vector3::zeros());
    }

    #[test]
    fn what_nobody_tells_is_named_with_its_line() {
        let points = [point([1.0, 0.0, 0.0], Pace::Untold)];
        let no_feed = Cutting {
            feed: None,
            ..cutting()
        };
        let error = no_feed.along(&points, &[], &placing()).unwrap_err();
        assert_eq!(error, NoForces::NoFeed { line: 7 });
        let no_spindle = Cutting {
            spindle: None,
            ..cutting()
        };
        let error = no_spindle.along(&points, &[], &placing()).unwrap_err();
        assert_eq!(error, NoForces::NoSpindle { line: 7 });
        let too_wide = Cutting {
            immersion: Immersion::Up(1.0),
            ..cutting()
        };
        let error = too_wide.along(&points, &[], &placing()).unwrap_err().to_string();
        assert!(
            error.starts_with("line 7: ") && error.contains("radial"),
            "{error}"
        );
    }
}
