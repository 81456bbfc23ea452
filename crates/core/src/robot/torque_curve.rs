//! A joint whose stiffness depends on its torque: gears are compliant while few teeth and bearings carry.
//!
//! `theta(tau)` is piecewise linear through measured pairs. Under gravity `tau_g` a joint has already turned by
//! `theta(tau_g)`; a load turns it further by `theta(tau_g + tau) - theta(tau_g)`. With friction there are two
//! curves: the *rising* one applies where the load raises the torque, the *falling* one where it lowers it. Beyond the
//! last pair the curve continues with the slope of its last piece.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `tau` | torque about the joint's axis in the chain, right hand | N m |
//! | `theta` | rotation of the joint under it | rad |
//!
//! Source: piecewise-linear torsional stiffness of strain wave and cycloidal gears as their makers print it (stiffness
//! by torque range); `docs/theory/gravity.md`.

use super::structure_error::StructureError;

/// Piecewise-linear angle over torque.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueCurve {
    /// Pairs of torque and angle, torque rising.
    points: Vec<[f64; 2]>,
}

impl TorqueCurve {
    /// The curve through these pairs `[torque, angle]`.
    ///
    /// # Errors
    /// Fewer than two pairs, numbers that are not finite, torques that do not rise, angles that fall.
    pub fn new(points: Vec<[f64; 2]>) -> Result<TorqueCurve, StructureError> {
        if points.len() < 2 {
            return Err(StructureError::ShortCurve(points.len()));
        }
        if points.iter().flatten().any(|value| !value.is_finite()) {
            return Err(StructureError::NotFinite("a torque curve"));
        }
        for (index, (a, b)) in points.iter().zip(&points[1..]).enumerate() {
            if b[0] <= a[0] || b[1] < a[1] {
                return Err(StructureError::FallingCurve { pair: index + 1 });
            }
        }
        Ok(TorqueCurve { points })
    }

    /// The pairs `[torque, angle]`, N m and rad.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Angle (rad) under `torque` (N m).
    pub fn angle(&self, torque: f64) -> f64 {
        let [[t0, a0], [t1, a1]] = self.piece(torque);
        a0 + (torque - t0) * (a1 - a0) / (t1 - t0)
    }

    /// Compliance (rad/(N m)) at `torque`: the slope of its piece.
    pub fn slope(&self, torque: f64) -> f64 {
        let [[t0, a0], [t1, a1]] = self.piece(torque);
        (a1 - a0) / (t1 - t0)
    }

    /// The same with torque and angle of the opposite sign.
    fn reversed(&self) -> TorqueCurve {
        let points = self.points.iter().rev();
        TorqueCurve {
            points: points.map(|[torque, angle]| [-torque, -angle]).collect(),
        }
    }

    fn more_compliant(&self, by: f64) -> TorqueCurve {
        let points = self
            .points
            .iter()
            .map(|[torque, angle]| [*torque, angle + by * torque]);
        TorqueCurve {
            points: points.collect(),
        }
    }

    /// The piece that contains `torque`; the first or last beyond them.
    fn piece(&self, torque: f64) -> [[f64; 2]; 2] {
        let after = self.points.partition_point(|[t, _]| *t <= torque);
        let end = after.clamp(1, self.points.len() - 1);
        [self.points[end - 1], self.points[end]]
    }
}

/// The curve or curves of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointCurve {
    /// Where the load raises the torque; everywhere if there is no other.
    pub rising: TorqueCurve,
    /// Where the load lowers it.
    pub falling: Option<TorqueCurve>,
}

impl JointCurve {
    /// Rotation (rad) of a joint that carries the torque `before` when `change` is added (N m).
    pub fn turn(&self, before: f64, change: f64) -> f64 {
        let curve = self.towards(change);
        curve.angle(before + change) - curve.angle(before)
    }

    /// Slope (rad/(N m)) at the end of that turn.
    pub fn slope(&self, before: f64, change: f64) -> f64 {
        self.towards(change).slope(before + change)
    }

    /// The same of a joint whose positive direction is the opposite: rising and falling change places.
    #[must_use]
    pub fn reversed(&self) -> JointCurve {
        let rising = self.rising.reversed();
        match &self.falling {
            None => JointCurve {
                rising,
                falling: None,
            },
            Some(falling) => JointCurve {
                rising: falling.reversed(),
                falling: Some(rising),
            },
        }
    }

    /// The same with an additional compliance, rad/(N m).
    #[must_use]
    pub fn more_compliant(&self, by: f64) -> JointCurve {
        JointCurve {
            rising: self.rising.more_compliant(by),
            falling: self.falling.as_ref().map(|falling| falling.more_compliant(by)),
        }
    }

    fn towards(&self, change: f64) -> &TorqueCurve {
        match &self.falling {
            Some(falling) if change < 0.0 => falling,
            _ => &self.rising,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knee() -> TorqueCurve {
        // Compliant (2e-6 rad/(N m)) up to 100 N m either way, stiff (5e-7) beyond.
        TorqueCurve::new(vec![
            [-300.0, -3e-4],
            [-100.0, -2e-4],
            [100.0, 2e-4],
            [300.0, 3e-4],
        ])
        .unwrap()
    }

    #[test]
    fn angles_are_linear_between_pairs_and_beyond_them() {
        for (torque, angle) in [
            (0.0, 0.0),
            (50.0, 1e-4),
            (200.0, 2.5e-4),
            (500.0, 4e-4),
            (-500.0, -4e-4),
        ] {
            assert!((knee().angle(torque) - angle).abs() < 1e-18, "{torque} N m");
        }
        assert_eq!(knee().slope(100.0), (3e-4 - 2e-4) / 200.0);
    }

    #[test]
    fn under_gravity_the_same_load_turns_a_joint_less() {
        let joint = JointCurve {
            rising: knee(),
            falling: None,
        };
        assert!((joint.turn(0.0, 50.0) - 1e-4).abs() < 1e-18);
        assert!((joint.turn(150.0, 50.0) - 2.5e-5).abs() < 1e-18);
        assert_eq!(joint.turn(150.0, 0.0), 0.0);
    }

    #[test]
    fn the_sign_of_the_change_selects_the_side_of_a_hysteresis() {
        let joint = JointCurve {
            rising: knee(),
            falling: Some(TorqueCurve::new(vec![[-300.0, -9e-4], [300.0, 9e-4]]).unwrap()),
        };
        assert!((joint.turn(0.0, 50.0) - 1e-4).abs() < 1e-18);
        assert!((joint.turn(0.0, -50.0) + 1.5e-4).abs() < 1e-18);
    }

    #[test]
    fn an_additional_compliance_adds_its_turn_to_both_sides() {
        let joint = JointCurve {
            rising: knee(),
            falling: Some(knee()),
        };
        let more = joint.more_compliant(1e-7);
        for (before, change) in [(0.0, 50.0), (150.0, -400.0)] {
            let by = more.turn(before, change) - joint.turn(before, change);
            assert!((by - 1e-7 * change).abs() < 1e-18);
        }
    }

    #[test]
    fn refuses_invalid_curves() {
        let refused = |points: &[[f64; 2]]| TorqueCurve::new(points.to_vec()).unwrap_err();
        assert!(matches!(refused(&[[0.0, 0.0]]), StructureError::ShortCurve(1)));
        let falling = [[0.0, 0.0], [1.0, 1e-6], [2.0, 0.5e-6]];
        assert!(matches!(
            refused(&falling),
            StructureError::FallingCurve { pair: 2 }
        ));
        let twice = [[0.0, 0.0], [0.0, 1e-6]];
        assert!(matches!(
            refused(&twice),
            StructureError::FallingCurve { pair: 1 }
        ));
        assert!(matches!(
            refused(&[[0.0, 0.0], [f64::NAN, 1.0]]),
            StructureError::NotFinite(_)
        ));
    }
}
