//! Drilling forces along a path: thrust and torque wherever the drill feeds into the part along its own axis.
//!
//! Thrust and torque are those of [`Drilling`] with the whole point in the part, from the first point of a plunge to
//! its last: the position of the surface is not given in the program, so the approach is treated as drilling.
//! Withdrawals have no force. Milling with a drill is not modelled: points with a feed across the axis have no force
//! and are reported by number.

use super::cutting::{ForceSummary, NoForces, feed_at, spindle_of};
use super::placing::Placing;
use super::sampled::SampledPath;
use crate::load::drilling::Drilling;
use crate::load::{Advance, Kienzle, LoadFrame, PathLoad};
use crate::spatial::Wrench;

/// Drill and process, where they are not given in the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drill {
    /// m
    pub diameter: f64,
    /// Full angle of the point, rad.
    pub point_angle: f64,
    /// Kienzle's law; its radial ratio is the force normal to a lip over the cutting force.
    pub law: Kienzle,
    /// Feed, m/s.
    pub feed: Option<f64>,
    /// Speed of the spindle, rad/s.
    pub spindle: Option<f64>,
}

impl Drill {
    /// Thrust and torque at the points of `path`, one wrench per point in the feed frame.
    ///
    /// # Errors
    /// [`NoForces`] at the first plunge without feed or spindle speed, or with a process that is not possible.
    pub fn along(&self, path: &SampledPath, placing: &Placing) -> Result<(PathLoad, ForceSummary), NoForces> {
        let none = Wrench::ZERO;
        let mut wrenches = Vec::with_capacity(path.points.len());
        let mut summary = ForceSummary::default();
        for (_, point, operation) in path.with_operations() {
            wrenches.push(match placing.advance(point) {
                Advance::Plunge => {
                    let turns = spindle_of(operation, self.spindle, point)? / std::f64::consts::TAU;
                    let drilling = Drilling {
                        diameter: self.diameter,
                        point_angle: self.point_angle,
                        feed: feed_at(point, self.feed)? / turns,
                        law: self.law,
                    };
                    let line = point.line;
                    let force = drilling.force().map_err(|error| NoForces::Cut { line, error })?;
                    if force.thrust > summary.largest_mean {
                        (summary.largest_mean, summary.greatest) = (force.thrust, force.thrust);
                        summary.relative_uncertainty =
                            force.covariance[(0, 0)].max(0.0).sqrt() / force.thrust;
                    }
                    force.wrench()
                }
                Advance::Withdrawal => none,
                Advance::Level | Advance::Ramp(_) => {
                    summary.without_force += 1;
                    none
                }
            });
        }
        let load = PathLoad::OfEach {
            cases: 1,
            frame: LoadFrame::Feed,
            wrenches,
        };
        Ok((load, summary))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Isometry;
    use crate::load::{Estimate, KienzleValues};
    use crate::path::{Pace, PathPoint, Spin};
    use nalgebra::Vector3;
    use nalgebra::{Point3, Unit};
    use std::f64::consts::TAU;

    fn drill() -> Drill {
        let estimate = |value: f64, relative: f64| Estimate {
            value,
            standard_uncertainty: value * relative,
        };
        let law = KienzleValues {
            specific_force: estimate(800e6, 0.1),
            exponent: estimate(0.25, 0.0),
            radial_ratio: estimate(0.5, 0.0),
            axial_ratio: estimate(0.0, 0.0),
        };
        Drill {
            diameter: 10e-3,
            point_angle: 118_f64.to_radians(),
            law: Kienzle::new(law).unwrap(),
            feed: None,
            spindle: Some(1000.0 * TAU / 60.0),
        }
    }

    fn along(
        drill: &Drill,
        directions: &[[f64; 3]],
        pace: Pace,
    ) -> Result<(Vec<Wrench>, ForceSummary), NoForces> {
        let point = |direction: &[f64; 3]| PathPoint {
            at: Point3::origin(),
            axis: None,
            normal: None,
            spin: None,
            direction: Unit::new_normalize((*direction).into()),
            along: 0.0,
            pace,
            line: 3,
        };
        let placing = Placing {
            base_from_path: Isometry::identity(),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        };
        let points: Vec<PathPoint> = directions.iter().map(point).collect();
        let path = SampledPath {
            points,
            ..SampledPath::default()
        };
        let (load, summary) = drill.along(&path, &placing)?;
        let PathLoad::OfEach { wrenches, .. } = load else {
            panic!("each point has its own")
        };
        Ok((wrenches, summary))
    }

    #[test]
    fn thrust_acts_only_on_the_way_in() {
        let ways = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        // 200 mm/min at 1000 rev/min: 0.2 mm a revolution, the case of the module `drilling`.
        let (wrenches, summary) = along(&drill(), &ways, Pace::Feed(0.2 / 60.0)).unwrap();
        let kc = 800.0 * (0.1 * 59_f64.to_radians().sin()).powf(-0.25);
        let thrust = 0.5 * kc * 10.0 * 0.2 / 2.0 * 59_f64.to_radians().sin();
        assert!((wrenches[0].force - Vector3::z() * thrust).norm() < 1e-9);
        assert!((wrenches[0].moment.z - kc * 10.0 * 10.0 * 0.2 / 8.0 * 1e-3).abs() < 1e-9);
        assert_eq!([wrenches[1], wrenches[2]], [Wrench::ZERO; 2]);
        assert_eq!(summary.without_force, 1);
        assert!(
            (summary.relative_uncertainty - 0.1).abs() < 1e-9 && summary.largest_mean == wrenches[0].force.z
        );
    }

    #[test]
    fn values_that_are_not_given_are_reported_with_their_line() {
        let in_it_goes = [[0.0, 0.0, -1.0]];
        assert_eq!(
            along(&drill(), &in_it_goes, Pace::Unknown).unwrap_err(),
            NoForces::NoFeed { line: 3 }
        );
        let still = Drill {
            spindle: None,
            ..drill()
        };
        assert_eq!(
            along(&still, &in_it_goes, Pace::Feed(0.01)).unwrap_err(),
            NoForces::NoSpindle { line: 3 }
        );
        let thick = Drill {
            diameter: 0.0,
            ..drill()
        };
        let error = along(&thick, &in_it_goes, Pace::Feed(0.01))
            .unwrap_err()
            .to_string();
        assert!(error.contains("line 3") && error.contains("diameter"), "{error}");
    }
}
