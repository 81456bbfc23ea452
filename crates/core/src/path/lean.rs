//! Lean of the tool from the surface that it cuts: lead and tilt about the programmed axis.
//!
//! ```text
//! a = cos(lead) (cos(tilt) n + sin(tilt) l) + sin(lead) f
//! P = p + (r + (R - r) sin(angle(a, n))) n          tip = P - r a
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `n` | programmed tool axis: the normal of the surface | - |
//! | `f`, `l` | feed direction across `n`, and to its left, `n x f` | - |
//! | `a` | tool axis with the lean, from the tip towards the spindle | - |
//! | `R`, `r` | radius of the tool and of its corner; equal for a ball nose | m |
//! | `p` | programmed position of the tip | m |
//! | `P` | on the tool axis, at the height of the centres of the corner | m |
//!
//! `P` stays over the programmed point, and the tool is raised until it just touches the surface: the centre of a ball
//! stays where it is, and the rim of a bull nose does not cut into the surface. On a surface that is flat over the width
//! of the tool this is exact; on a concave surface the rim may still cut into it.

use nalgebra::{Unit, UnitQuaternion, Vector3};

use super::placing::{Placing, across};
use super::program::GivenSpin;
use super::sampler::PathPoint;
pub use crate::load::Lean;

/// The lower end of a tool with a rounded corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedEnd {
    /// Radius of the tool, m.
    pub radius: f64,
    /// Radius of its corner, m, up to that of the tool.
    pub corner: f64,
}

impl RoundedEnd {
    /// Height of a point of the tool axis at the centres of the corner over the surface, m, where the tool touches it.
    fn height(self, sine: f64) -> f64 {
        self.corner + (self.radius - self.corner) * sine
    }
}

impl Placing {
    /// The lean of the tool at a point that [leans](Placing::leaned); none at any other.
    pub fn lean(&self, point: &PathPoint) -> Lean {
        let (Some(normal), Some(axis)) = (point.normal, point.axis.filter(|_| !self.keeps_axis)) else {
            return Lean::NONE;
        };
        let Some(feed) = across(&point.direction, &normal).filter(|_| axis != normal) else {
            return Lean::NONE;
        };
        let (axis, normal) = (axis.into_inner(), normal.into_inner());
        Lean {
            lead: axis.dot(&feed).clamp(-1.0, 1.0).asin(),
            tilt: axis.dot(&normal.cross(&feed)).atan2(axis.dot(&normal)),
        }
    }

    /// `point` with the tool leaning from its programmed axis, for a tool with this end, in a placing that does not
    /// [keep](Placing::keeps_axis) the axis. In a plunge the tool does not lean. The spin that the program gives is kept;
    /// a whole orientation is turned by the shortest rotation.
    pub fn leaned(&self, point: &PathPoint, lean: Lean, end: RoundedEnd) -> PathPoint {
        let normal = self.path_spindle(point);
        let n = normal.into_inner();
        let axis = match across(&point.direction, &normal).filter(|_| lean != Lean::default()) {
            Some(feed) => {
                let upright = n * lean.tilt.cos() + n.cross(&feed) * lean.tilt.sin();
                Unit::new_normalize(upright * lean.lead.cos() + feed * lean.lead.sin())
            }
            None => normal,
        };
        let sine = axis.cross(&n).norm();
        let at = point.at + n * end.height(sine) - axis.into_inner() * end.corner;
        let spin = match point.spin {
            Some(GivenSpin::Orientation(given)) => {
                let over = UnitQuaternion::rotation_between(&(given * Vector3::z()), &-axis.into_inner());
                Some(GivenSpin::Orientation(over.map_or(given, |over| over * given)))
            }
            other => other,
        };
        PathPoint {
            at,
            axis: Some(axis),
            normal: Some(normal),
            spin,
            ..*point
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3};

    use super::*;
    use crate::path::{Pace, Spin};

    const BULL: RoundedEnd = RoundedEnd {
        radius: 0.0125,
        corner: 0.005,
    };

    fn placing() -> Placing {
        Placing {
            base_from_path: Isometry3::identity(),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        }
    }

    fn point(direction: Vector3<f64>) -> PathPoint {
        PathPoint {
            at: Point3::new(0.3, -0.1, 0.2),
            axis: None,
            normal: None,
            spin: None,
            direction: Unit::new_normalize(direction),
            along: 0.0,
            pace: Pace::Unknown,
            line: 1,
        }
    }

    /// Height of the lowest point of the torus of the corner over the plane through `surface` across z: by sampling.
    fn lowest(of: &PathPoint, end: RoundedEnd, surface: f64) -> f64 {
        let axis = of.axis.unwrap();
        let across = axis.cross(&Vector3::x()).normalize();
        let other = axis.cross(&across);
        let centre = of.at + axis.into_inner() * end.corner;
        let rim = (0..3600).map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 3600.0;
            let on_ring = centre + (across * angle.cos() + other * angle.sin()) * (end.radius - end.corner);
            on_ring.z - end.corner
        });
        rim.fold(f64::INFINITY, f64::min) - surface
    }

    #[test]
    fn a_leaning_tool_touches_the_surface_and_does_not_cut_into_it() {
        let ball = RoundedEnd {
            radius: 0.006,
            corner: 0.006,
        };
        for end in [BULL, ball] {
            for (lead, tilt) in [(0.2, 0.0), (-0.3, 0.1), (0.0, -0.5), (0.4, 0.4)] {
                let leaned = placing().leaned(&point(Vector3::new(1.0, 0.5, 0.0)), Lean { lead, tilt }, end);
                let height = lowest(&leaned, end, 0.2);
                assert!(height.abs() < 1e-8, "{lead} {tilt}: {height}");
            }
        }
    }

    #[test]
    fn the_centre_of_a_ball_stays() {
        let ball = RoundedEnd {
            radius: 0.006,
            corner: 0.006,
        };
        let leaned = placing().leaned(
            &point(Vector3::y()),
            Lean {
                lead: 0.3,
                tilt: -0.2,
            },
            ball,
        );
        let centre = leaned.at + leaned.axis.unwrap().into_inner() * 0.006;
        assert!((centre - Point3::new(0.3, -0.1, 0.206)).norm() < 1e-15);
    }

    #[test]
    fn lead_goes_to_the_feed_and_tilt_to_its_left() {
        let lean = |lead, tilt| placing().leaned(&point(Vector3::x()), Lean { lead, tilt }, BULL);
        let axis = |lead, tilt| lean(lead, tilt).axis.unwrap().into_inner();
        assert!((axis(0.3, 0.0) - Vector3::new(0.3f64.sin(), 0.0, 0.3f64.cos())).norm() < 1e-15);
        assert!((axis(0.0, 0.3) - Vector3::new(0.0, 0.3f64.sin(), 0.3f64.cos())).norm() < 1e-15);
    }

    #[test]
    fn the_lean_of_a_point_is_that_by_which_it_leans() {
        let slanted = Vector3::new(0.3, -1.0, 0.2);
        assert_eq!(placing().lean(&point(slanted)), Lean::NONE);
        for (lead, tilt) in [(0.3, -0.2), (-0.5, 0.0), (0.0, 1.2), (0.0, 0.0)] {
            let found = placing().lean(&placing().leaned(&point(slanted), Lean { lead, tilt }, BULL));
            assert!((found.lead - lead).abs() < 1e-14 && (found.tilt - tilt).abs() < 1e-14);
        }
    }

    #[test]
    fn without_lean_and_in_a_plunge_the_point_stays() {
        let upright = point(Vector3::x());
        assert_eq!(placing().leaned(&upright, Lean::default(), BULL).at, upright.at);
        let plunge = point(-Vector3::z());
        let lean = Lean { lead: 0.2, tilt: 0.1 };
        let leaned = placing().leaned(&plunge, lean, BULL);
        assert_eq!((leaned.at, leaned.axis), (plunge.at, Some(Vector3::z_axis())));
    }

    #[test]
    fn a_small_lean_moves_the_tip_little() {
        let lean = Lean {
            lead: 1e-4,
            tilt: 0.0,
        };
        let leaned = placing().leaned(&point(Vector3::x()), lean, BULL);
        assert!((leaned.at - point(Vector3::x()).at).norm() < 2e-6);
    }
}
