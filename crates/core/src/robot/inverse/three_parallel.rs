//! Closed-form inverse for arms whose axes 2, 3 and 4 are parallel (UR and other cobots).
//!
//! Six revolute joints qualify whose axis 2 is perpendicular to axis 1 and parallel to axes 3 and 4, whose axis 5 is
//! perpendicular to axes 4 and 6 and meets axis 6 in the wrist centre. The arm's axes: z along axis 1 and up, y along
//! axis 2, x to the front, origin on axis 1 at the height of axis 2. Joints 2 to 4 turn about y and move nothing
//! along it, so that two subproblems split off:
//!
//! ```text
//! joint 1: the wrist centre p has the offset b from the arm plane: r = +-sqrt(px^2 + py^2 - b^2)    + front, - back
//! joint 5: axis 6, seen from the turned base as s, has the angle beta to axis 4: cos beta = s a4  beta >= 0 no-flip
//! joint 6: axis 5 = a4 x (s - cos beta a4) / sin beta, relative to its direction on the flange
//! chi    : turn of joints 2 to 4 together, from axis 5; then axis 4 is a point in the plane
//! joints 2, 3: triangle of `two_links`; joint 4 = chi less both
//! ```
//!
//! Lengths m, angles rad. Source: subproblems after Paden 1986 and Kahan; the split for three parallel axes as in
//! Elias & Wen 2022 (IK-Geo), here in the case of two meeting axes; `docs/theory/inverse.md`.

use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::super::branch::{Branch, Shoulder, Wrist};
use super::super::chain::Chain;
use super::super::posture::Singularity;
use super::super::unreachable::Unreachable;
use super::lines::{AxisDeviation, IDEAL, Line, Turn, across, base_from_arm, lines_at_zero, sense_of};
use super::two_links::{TwoLinks, WRIST_SINGULAR};
use crate::frame::Isometry;

/// The geometry of an arm with three parallel axes, read off its chain.
#[derive(Clone, Debug)]
pub struct ThreeParallel {
    /// x to the front, y along axis 2, z along axis 1; origin on axis 1 at the height of axis 2.
    pub(crate) arm_from_base: Isometry,
    /// Axis 2 before axis 1.
    pub(crate) a1: f64,
    /// Offset of the wrist centre from the arm's plane, along y.
    pub(crate) b: f64,
    pub(crate) links: TwoLinks,
    /// From axis 4 to the wrist centre at chain zero, in the arm's plane.
    pub(crate) hand: Vector3<f64>,
    /// Axis 5 at chain zero, arm's axes.
    pub(crate) axis_5: Vector3<f64>,
    pub(crate) upper_arm_at_zero: f64,
    pub(crate) forearm_at_zero: f64,
    pub(crate) bend_at_zero: f64,
    /// Sense of axes 1 to 4 against the common one, 1 or -1; 5 and 6 use their own right hand.
    pub(crate) sense: [f64; 6],
    /// Axes 5 and 6 at chain zero, and the wrist centre, in the flange's axes.
    pub(crate) flange_from_axis_5: Vector3<f64>,
    pub(crate) flange_from_axis_6: Vector3<f64>,
    pub(crate) flange_from_wrist: Point3<f64>,
}

impl ThreeParallel {
    /// The geometry of `chain`, or `None` if it is of another kind.
    pub fn recognise(chain: &Chain) -> Option<ThreeParallel> {
        let lines = lines_at_zero(chain)?;
        let wrist = lines[4].nearest_to(&lines[5])?;
        (deviation_from_ideal(&lines, wrist).largest() < IDEAL)
            .then(|| ThreeParallel::of_lines(chain, &lines, wrist))
            .flatten()
    }

    /// The geometry with three parallel axes next to that of `chain`, if that deviates from it by less than `within`
    /// (m, rad); beyond its reach it answers as far as such an arm may reach, up to `slack` (m).
    pub(super) fn next_to(chain: &Chain, within: f64, slack: f64) -> Option<ThreeParallel> {
        let mut lines = lines_at_zero(chain)?;
        let wrist = lines[4].nearest_to(&lines[5])?;
        let deviation = deviation_from_ideal(&lines, wrist);
        if deviation.largest() >= within {
            return None;
        }
        lines = lines.map(|line| line.with_point_near(wrist));
        lines[1].axis = across(lines[1].axis, &lines[0].axis);
        for parallel in [2, 3] {
            lines[parallel].axis = lines[1].axis * sense_of(lines[parallel].axis.dot(&lines[1].axis));
        }
        lines[4].axis = across(lines[4].axis, &lines[1].axis);
        lines[5].axis = across(lines[5].axis, &lines[4].axis);
        let mut arm = ThreeParallel::of_lines(chain, &lines, wrist)?;
        arm.links.slack = deviation.slack(arm.links.l2 + arm.links.l3).min(slack);
        Some(arm)
    }

    fn of_lines(chain: &Chain, lines: &[Line; 6], wrist: Point3<f64>) -> Option<ThreeParallel> {
        let [z1, z2, z3, z4, z5, z6] = lines.map(|line| line.axis);
        let arm = base_from_arm(lines, wrist);
        let [y, up] = [1, 2].map(|i| arm.rotation.matrix().column(i).into_owned());
        let base_from_arm = Isometry::from_parts(arm.translation, arm.rotation.into());
        let arm_from_base = base_from_arm.inverse();
        let [shoulder, elbow, hand] = [1, 2, 3].map(|i| arm_from_base * lines[i].point);
        let w = arm_from_base * wrist;
        let (upper_arm, forearm) = (elbow - shoulder, hand - elbow);
        let [axis_4, axis_5, axis_6] = [z4, z5, z6].map(|axis| arm_from_base * axis);
        let flange_from_base = chain.base_from_flange(&[0.0; 6]).inverse();
        let parallel = |axis: Vector3<f64>| sense_of(axis.dot(&y));
        Some(ThreeParallel {
            a1: shoulder.x,
            b: w.y,
            links: TwoLinks {
                l2: upper_arm.xz().norm(),
                l3: forearm.xz().norm(),
                slack: 0.0,
            },
            hand: Vector3::new(w.x - hand.x, 0.0, w.z - hand.z),
            axis_5,
            upper_arm_at_zero: upper_arm.x.atan2(upper_arm.z),
            forearm_at_zero: forearm.x.atan2(forearm.z),
            bend_at_zero: (axis_6.dot(&axis_5.cross(&axis_4))).atan2(axis_6.dot(&axis_4)),
            sense: [
                sense_of(z1.dot(&up)),
                parallel(z2),
                parallel(z3),
                parallel(z4),
                1.0,
                1.0,
            ],
            flange_from_axis_5: flange_from_base * z5,
            flange_from_axis_6: flange_from_base * z6,
            flange_from_wrist: flange_from_base * wrist,
            arm_from_base,
        })
        .filter(|arm| arm.links.l2 > IDEAL && arm.links.l3 > IDEAL)
    }

    /// Chain positions of one branch that bring the flange to `base_from_flange`, modulo whole turns, and the
    /// singularity that they are near.
    ///
    /// Where axis 6 is parallel to axes 2, 3 and 4, joint 6 stays at `kept` (chain position, rad), or at zero; if the
    /// arm cannot reach the pose then, where its hand points away from the shoulder, or towards it.
    /// Not checked: forward kinematics (see [`verify`](fn@super::verify)).
    ///
    /// # Errors
    /// Axis 4 or the wrist centre is out of reach of this branch.
    pub fn chain_positions(
        &self,
        base_from_flange: &Isometry,
        branch: Branch,
        kept: Option<f64>,
    ) -> Result<([f64; 6], Option<Singularity>), Unreachable> {
        let p = self.arm_from_base * (base_from_flange * self.flange_from_wrist);
        let (r, phi1) = self.links.reach(&p, self.b, branch.shoulder)?;
        let seen =
            |in_flange: &Vector3<f64>| phi1.back_about_z(self.arm_from_base * (base_from_flange * in_flange));
        let (out, second) = (seen(&self.flange_from_axis_6), seen(&self.flange_from_axis_5));
        let bent = out.x.hypot(out.z);
        let flip = if branch.wrist == Wrist::NoFlip { 1.0 } else { -1.0 };
        let bend = Turn::new(out.y * self.sense[3], flip * bent);
        let hand_and_links = |axis_5: &Vector3<f64>| {
            let turned = Turn::new(
                self.axis_5.dot(axis_5),
                axis_5.dot(&Vector3::y().cross(&self.axis_5)),
            );
            let hand = turned.about_y(self.hand);
            let links = self
                .links
                .solve(r - hand.x - self.a1, p.z - hand.z, branch.elbow)?;
            Ok::<_, Unreachable>((turned, links))
        };
        let (axis_5, (turned, (psi, chi))) = if bent < WRIST_SINGULAR {
            // Joint 6 is free: at its previous position, or with the hand pointing away from the shoulder, or towards
            // it.
            let kept = across(
                UnitQuaternion::new(out * -kept.unwrap_or(0.0)) * second,
                &Vector3::y(),
            );
            let away = Turn::new(r - self.a1, p.z).less(Turn::new(self.hand.x, self.hand.z));
            let outwards = away.back_about_y(self.axis_5);
            let solved = |axis_5: Vector3<f64>| Ok((axis_5, hand_and_links(&axis_5)?));
            solved(kept).or_else(|miss| solved(outwards).or_else(|_| solved(-outwards)).map_err(|_| miss))?
        } else {
            let axis_5 = Vector3::new(out.z, 0.0, -out.x) * (self.sense[3] * flip / bent);
            (axis_5, hand_and_links(&axis_5)?)
        };
        let phi6 = Turn::new(axis_5.dot(&second), out.dot(&axis_5.cross(&second)));
        let (psi_angle, chi_angle) = (psi.angle(), chi.angle());
        let phi2 = psi_angle - self.upper_arm_at_zero;
        let forearm = chi_angle - self.forearm_at_zero;
        let mut positions = [
            phi1.angle(),
            phi2,
            forearm - phi2,
            turned.angle() - forearm,
            bend.angle() - self.bend_at_zero,
            phi6.angle(),
        ];
        for (phi, sense) in positions.iter_mut().zip(self.sense) {
            *phi *= sense;
        }
        Ok((positions, self.links.singularity(bend.sin, chi.less(psi).sin, r)))
    }

    /// Branch of the chain positions `theta`, and the singularity that they are near, if any.
    ///
    /// Not checked: that there are six.
    pub fn name(&self, theta: &[f64]) -> (Branch, Option<Singularity>) {
        let phi = |i: usize| self.sense[i] * theta[i];
        let psi = self.upper_arm_at_zero + phi(1);
        let forearm = self.forearm_at_zero + phi(1) + phi(2);
        let hand = Turn::by(phi(1) + phi(2) + phi(3)).about_y(self.hand);
        let u = self.links.l2 * psi.sin() + self.links.l3 * forearm.sin();
        let r = self.a1 + u + hand.x;
        let (eps, bend) = (forearm - psi, self.bend_at_zero + phi(4));
        let branch = Branch {
            shoulder: Shoulder::at(r),
            elbow: TwoLinks::elbow(eps, u),
            wrist: Wrist::bent(bend.sin()),
        };
        (branch, self.links.singularity(bend.sin(), eps.sin(), r))
    }
}

/// Deviation of these axes from those of an arm with three parallel axes.
fn deviation_from_ideal(lines: &[Line; 6], wrist: Point3<f64>) -> AxisDeviation {
    let [z1, z2, z3, z4, z5, z6] = lines.map(|line| line.axis);
    AxisDeviation::of(
        [
            z1.dot(&z2).abs(),
            z2.cross(&z3).norm(),
            z2.cross(&z4).norm(),
            z4.dot(&z5).abs(),
            z5.dot(&z6).abs(),
        ],
        [lines[5].distance(wrist)],
    )
}
