//! Forward kinematics of a deflected arm: frames and screws over drives and springs.
//!
//! From base to tool, each drive turns by `theta_i + x_i`, and each spring adds the displacement `exp(u_k x_k)`
//! at its attachment. Springs of one attachment act one after the other; their order has an effect of second order in
//! `x`.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `theta` | chain positions of the drives | rad (m) |
//! | `x` | deflections of the drives, then of the springs | rad or m, small |
//!
//! Screws are at the tool centre point of the deflected arm, base basis.

use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Vector3};

use super::chain::{Axis, Motion};
use super::forward::Frames;
use super::model::Robot;
use super::spring::{Attachment, Spring};
use crate::frame::{Isometry, turn_between};
use crate::spatial::Twist;

/// An arm with deflected drives and springs.
#[derive(Clone, Debug)]
pub struct DeflectedArm {
    /// Screw of each drive, then of each spring, at the TCP.
    pub screws: Vec<Twist>,
    /// Frame of each attachment in base, from base to tool, by [`Attachment::rank`]; deflected by its own springs.
    pub attachments: Vec<IsometryMatrix3<f64>>,
}

impl DeflectedArm {
    /// Working memory for `robot` with this many springs.
    pub fn for_robot(robot: &Robot, springs: usize) -> DeflectedArm {
        let joints = robot.joints().len();
        DeflectedArm {
            screws: vec![Twist::ZERO; joints + springs],
            attachments: vec![IsometryMatrix3::identity(); Attachment::count(joints)],
        }
    }

    /// The tool in base.
    pub fn base_from_tool(&self) -> IsometryMatrix3<f64> {
        self.attachments
            .last()
            .copied()
            .unwrap_or_else(IsometryMatrix3::identity)
    }
}

/// The frame of an attachment in base without deflection.
pub fn attachment_frame(
    attachment: Attachment,
    frames: &Frames,
    base_from_tool: &IsometryMatrix3<f64>,
) -> IsometryMatrix3<f64> {
    match attachment {
        Attachment::Base => IsometryMatrix3::identity(),
        Attachment::Joint(index) => frames.base_from_joint[index],
        Attachment::Flange => frames.base_from_flange,
        Attachment::Tool => *base_from_tool,
    }
}

/// The screw at `tcp` (m, base) of a spring with this local direction on an attachment in this frame.
pub fn spring_screw(
    direction: &Twist,
    base_from_attachment: &IsometryMatrix3<f64>,
    tcp: Vector3<f64>,
) -> Twist {
    let at_attachment = Twist {
        linear: base_from_attachment.rotation * direction.linear,
        angular: base_from_attachment.rotation * direction.angular,
    };
    at_attachment.moved(tcp - base_from_attachment.translation.vector)
}

/// An arm whose drives and springs can deflect.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleArm<'a> {
    /// Chain and drives.
    pub robot: &'a Robot,
    /// Springs in addition to the drives.
    pub springs: &'a [Spring],
    /// The tool.
    pub flange_from_tool: &'a Isometry,
}

/// Writes the arm at chain positions `theta`, with drives and springs deflected by `x`, into `out`.
///
/// # Panics
/// If there are fewer `theta` than joints, or fewer `x` than joints and springs.
pub fn deflect_into(arm: &FlexibleArm<'_>, theta: &[f64], x: &[f64], out: &mut DeflectedArm) {
    let FlexibleArm {
        robot,
        springs,
        flange_from_tool,
    } = *arm;
    let (mut axes, mut origin) = (Matrix3::identity(), Vector3::zeros());
    let chain = robot.chain();
    let joints = theta.len();
    for rank in 0..Attachment::count(joints) {
        if let Some(joint) = rank.checked_sub(1).filter(|joint| *joint < joints) {
            let link = &chain.links()[joint];
            link.before.advance(&mut axes, &mut origin);
            link.motion
                .advance(theta[joint] + x[joint], &mut axes, &mut origin);
            let of = |axis: Axis| axes.column(axis.index()).into_owned();
            let drive = match link.motion {
                Motion::About(axis, _) => Twist::about(of(axis)),
                Motion::Along(axis, _) => Twist::along(of(axis)),
            };
            out.screws[joint] = drive.moved(-origin);
        } else if rank == Attachment::Flange.rank(joints) {
            chain.last_joint_from_flange().advance(&mut axes, &mut origin);
        } else if rank == Attachment::Tool.rank(joints) {
            origin += axes * flange_from_tool.translation.vector;
            axes *= flange_from_tool.rotation.to_rotation_matrix().matrix();
        }
        for (index, spring) in springs.iter().enumerate() {
            if spring.attachment.rank(joints) != rank {
                continue;
            }
            let at_attachment = Twist {
                linear: axes * spring.direction.linear,
                angular: axes * spring.direction.angular,
            };
            out.screws[joints + index] = at_attachment.moved(-origin);
            let (turn, shift) = exponential(&(spring.direction * x[joints + index]));
            origin += axes * shift;
            axes *= turn;
        }
        out.attachments[rank] =
            IsometryMatrix3::from_parts(origin.into(), Rotation3::from_matrix_unchecked(axes));
    }
    // Until here relative to the base origin; the tool is at `origin` now.
    for screw in &mut out.screws {
        *screw = screw.moved(origin);
    }
}

/// Below this angle (rad) the truncation error of the series of [`exponential`] is below rounding.
const SMALL_ANGLE: f64 = 1e-2;

/// The finite displacement of a constant twist: rotation, and displacement of the reference point.
fn exponential(twist: &Twist) -> (Matrix3<f64>, Vector3<f64>) {
    let angle = twist.angular.norm();
    let square = angle * angle;
    let (sine, first, second) = if angle < SMALL_ANGLE {
        (
            1.0 - square / 6.0 + square * square / 120.0,
            0.5 - square / 24.0 + square * square / 720.0,
            1.0 / 6.0 - square / 120.0 + square * square / 5040.0,
        )
    } else {
        let (sin, cos) = angle.sin_cos();
        (
            sin / angle,
            (1.0 - cos) / square,
            (angle - sin) / (square * angle),
        )
    };
    let cross = twist.angular.cross_matrix();
    let rotation = Matrix3::identity() + cross * sine + cross * cross * first;
    let way = twist.linear + cross * twist.linear * first + cross * cross * twist.linear * second;
    (rotation, way)
}

/// The displacement of the tool from `before` to `after`: of its centre point (m), and its rotation vector (rad), base
/// basis.
pub fn twist_between(before: &IsometryMatrix3<f64>, after: &IsometryMatrix3<f64>) -> Twist {
    Twist {
        linear: after.translation.vector - before.translation.vector,
        angular: turn_between(before.rotation.matrix(), after.rotation.matrix()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::forward::forward;
    use crate::robot::inverse::tool_on;
    use crate::robot::jacobian::screws_at;
    use crate::robot::{Amount, Joint, JointCompliance};

    fn arm() -> (Robot, Vec<Spring>, Isometry) {
        let motions = vec![
            Motion::Along(Axis::Z, Amount::Constant(0.5)),
            Motion::About(Axis::Z, Amount::Joint(0)),
            Motion::Along(Axis::X, Amount::Constant(0.2)),
            Motion::About(Axis::Y, Amount::Joint(1)),
            Motion::Along(Axis::X, Amount::Joint(2)),
            Motion::About(Axis::X, Amount::Constant(0.3)),
        ];
        let robot = Robot::new("some", motions, ["a", "b", "c"].map(Joint::plain).to_vec()).unwrap();
        let c = JointCompliance {
            value: 1e-6,
            standard_uncertainty: 0.0,
        };
        let mut springs = vec![
            Spring::about(Attachment::Tool, Vector3::x(), c),
            Spring::about(Attachment::Joint(1), Vector3::x(), c),
            Spring::along(Attachment::Base, Vector3::y(), c),
            Spring::about(Attachment::Joint(1), Vector3::y(), c),
            Spring::about(Attachment::Flange, Vector3::z(), c),
        ];
        springs[4].direction.linear = Vector3::new(0.1, -0.4, 0.2);
        let tool = crate::frame::from_xyz_and_fixed_angles(
            Vector3::new(0.05, 0.0, 0.3),
            Vector3::new(0.1, 0.7, -0.2),
        );
        (robot, springs, tool)
    }

    fn flexible<'a>(
        robot: &'a Robot,
        springs: &'a [Spring],
        flange_from_tool: &'a Isometry,
    ) -> FlexibleArm<'a> {
        FlexibleArm {
            robot,
            springs,
            flange_from_tool,
        }
    }

    const THETA: [f64; 3] = [0.4, -0.7, 0.25];

    #[test]
    fn an_arm_without_deflection_matches_forward_kinematics() {
        let (robot, springs, tool) = arm();
        let arm = flexible(&robot, &springs, &tool);
        let mut out = DeflectedArm::for_robot(&robot, springs.len());
        deflect_into(&arm, &THETA, &[0.0; 8], &mut out);
        let frames = forward(&robot, &THETA);
        let at = tool_on(&frames, &tool);
        let away = out.base_from_tool().to_homogeneous() - at.to_homogeneous();
        assert!(away.norm() < 1e-15);
        let tcp = at.translation.vector;
        let drives = screws_at(&robot, &frames, &tcp.into());
        for (a, b) in out.screws.iter().zip(&drives) {
            assert!((a.to_vector() - b.to_vector()).norm() < 1e-15);
        }
        let base_from_tool = out.base_from_tool();
        for (a, spring) in out.screws[3..].iter().zip(&springs) {
            let attachment = attachment_frame(spring.attachment, &frames, &base_from_tool);
            let b = spring_screw(&spring.direction, &attachment, tcp);
            assert!((a.to_vector() - b.to_vector()).norm() < 1e-15);
        }
    }

    #[test]
    fn screws_of_a_deflected_arm_match_finite_differences() {
        let (robot, springs, tool) = arm();
        let arm = flexible(&robot, &springs, &tool);
        let x: Vec<f64> = (0..8).map(|i| 0.03 * f64::from(i) - 0.1).collect();
        let deflected = |x: &[f64]| {
            let mut out = DeflectedArm::for_robot(&robot, springs.len());
            deflect_into(&arm, &THETA, x, &mut out);
            out
        };
        let here = deflected(&x);
        let h = 1e-5;
        for k in 0..8 {
            let (mut less, mut more) = (x.clone(), x.clone());
            less[k] -= h;
            more[k] += h;
            let moved = twist_between(
                &deflected(&less).base_from_tool(),
                &deflected(&more).base_from_tool(),
            );
            let difference = (moved * (0.5 / h)).to_vector() - here.screws[k].to_vector();
            // h^2, and rounding over h.
            assert!(difference.norm() < 1e-9, "{k}: {difference}");
        }
    }

    #[test]
    fn the_series_of_small_angles_joins_the_closed_form() {
        let twist = |angle: f64| Twist {
            linear: Vector3::new(0.3, -0.2, 0.9),
            angular: Vector3::new(0.6, 0.0, -0.8) * angle,
        };
        let (below, above) = (
            exponential(&twist(0.999_999_9e-2)),
            exponential(&twist(1.000_000_1e-2)),
        );
        // They differ by 2e-9 rad.
        assert!((below.0 - above.0).norm() < 1e-8 && (below.1 - above.1).norm() < 1e-8);
        let orthogonal = below.0 * below.0.transpose() - Matrix3::identity();
        assert!(orthogonal.norm() < 1e-15);
    }

    #[test]
    fn a_twist_and_its_negative_return_to_the_start() {
        for angle in [0.0, 1e-9, 1e-4, 0.009, 0.011, 0.5, 2.5] {
            let twist = Twist {
                linear: Vector3::new(0.3, -0.2, 0.9),
                angular: Vector3::new(0.6, 0.0, -0.8) * angle,
            };
            let ((turn, way), (back, way_back)) = (exponential(&twist), exponential(&(twist * -1.0)));
            assert!((turn * back - Matrix3::identity()).norm() < 1e-14, "{angle}");
            // First the one, then the other: way + R way_back.
            assert!((way + turn * way_back).norm() < 1e-14, "{angle}");
        }
    }

    #[test]
    fn a_twist_in_two_halves_is_the_whole_twist() {
        let twist = Twist {
            linear: Vector3::new(0.3, -0.2, 0.9),
            angular: Vector3::new(0.6, 0.1, -0.8),
        };
        let ((half, way), (whole, all_the_way)) = (exponential(&(twist * 0.5)), exponential(&twist));
        assert!((half * half - whole).norm() < 1e-14);
        assert!((way + half * way - all_the_way).norm() < 1e-14);
    }

    #[test]
    fn the_twist_between_two_poses_is_valid_up_to_half_a_turn() {
        let (robot, springs, tool) = arm();
        let arm = flexible(&robot, &springs, &tool);
        let mut before = DeflectedArm::for_robot(&robot, springs.len());
        deflect_into(&arm, &THETA, &[0.0; 8], &mut before);
        for angle in [0.1, 1.4, 1.7, 3.0] {
            // Beyond a quarter turn the sine of the angle decreases again.
            let mut x = [0.0; 8];
            x[0] = angle;
            let mut after = DeflectedArm::for_robot(&robot, springs.len());
            deflect_into(&arm, &THETA, &x, &mut after);
            let twist = twist_between(&before.base_from_tool(), &after.base_from_tool());
            assert!(
                (twist.angular - Vector3::z() * angle).norm() < 1e-12,
                "{angle}: {}",
                twist.angular
            );
        }
    }

    #[test]
    fn the_order_of_springs_of_one_attachment_has_an_effect_of_second_order() {
        let (robot, springs, tool) = arm();
        let mut swapped = springs.clone();
        swapped.swap(1, 3);
        let reached = |springs: &[Spring], x: &[f64]| {
            let arm = flexible(&robot, springs, &tool);
            let mut out = DeflectedArm::for_robot(&robot, springs.len());
            deflect_into(&arm, &THETA, x, &mut out);
            out.base_from_tool()
        };
        let apart = |size: f64| {
            let (mut x, mut y) = ([0.0; 8], [0.0; 8]);
            (x[4], x[6]) = (size, 2.0 * size);
            (y[4], y[6]) = (2.0 * size, size);
            twist_between(&reached(&springs, &x), &reached(&swapped, &y))
                .to_vector()
                .norm()
        };
        let (large, small) = (apart(2e-3), apart(1e-3));
        assert!(
            large > 0.0 && (large / small - 4.0).abs() < 0.05,
            "{large} {small}"
        );
    }
}
