//! Closed-form inverse for ortho-parallel arms with spherical wrist.
//!
//! Any six revolute joints qualify whose axis 2 is perpendicular to axis 1 and parallel to axis 3, and whose
//! axes 4, 5, 6 meet in one point with 4 perpendicular to 5 and 5 to 6, whatever the zeros. All angles
//! are about axes turned to a common sense: 1 up, 2 and 3 along the arm's +y, 4 out along the forearm,
//! 5 along +y, 6 out of the flange.
//!
//! The formulas are in `eight_branches`.
//!
//! Lengths m, angles rad. Source: textbook geometry; compare Brandstoetter, Angerer, Hofbaur 2014 (OPW).

use nalgebra::{Point3, Vector3};

use super::super::branch::{Branch, Shoulder, Wrist};
use super::super::chain::Chain;
use super::super::posture::Singularity;
use super::lines::{
    AxisDeviation, IDEAL, Line, Turn, across, base_from_arm, lines_at_zero, sense_of, up_to_noise,
};
use super::two_links::TwoLinks;
use crate::frame::Isometry;

/// The geometry of an ortho-parallel arm with spherical wrist, read off its chain.
#[derive(Clone, Debug)]
pub struct OrthoParallel {
    /// x to the front, y along axis 2, z along axis 1; origin on axis 1 at the height of axis 2.
    pub(crate) arm_from_base: Isometry,
    pub(crate) a1: f64,
    pub(crate) b: f64,
    pub(crate) links: TwoLinks,
    /// Angles of upper arm and forearm from the vertical at chain zero.
    pub(crate) upper_arm_at_zero: f64,
    pub(crate) forearm_at_zero: f64,
    pub(super) forearm_turn_at_zero: Turn,
    /// Wrist bend at chain zero.
    pub(crate) bend_at_zero: f64,
    /// Sense of each axis against the common one, 1 or -1.
    pub(crate) sense: [f64; 6],
    /// Axes 4 and 5 at chain zero, in the arm's axes, in the common sense.
    pub(crate) wrist_axes: [Vector3<f64>; 2],
    /// Axes 5 and 6 at chain zero, in the flange's axes, in the common sense.
    pub(crate) flange_from_axis_5: Vector3<f64>,
    pub(crate) flange_from_axis_6: Vector3<f64>,
    pub(crate) flange_from_wrist: Point3<f64>,
}

impl OrthoParallel {
    /// The geometry of `chain`, or `None` if it is of another kind.
    pub fn recognise(chain: &Chain) -> Option<OrthoParallel> {
        OrthoParallel::of(&lines_at_zero(chain)?, &chain.base_from_flange(&[0.0; 6]))
    }

    /// The geometry of the arm with these axes and this flange at zero, or `None` if it is of another kind.
    pub(super) fn of(lines: &[Line; 6], at_zero: &Isometry) -> Option<OrthoParallel> {
        let wrist = lines[3].nearest_to(&lines[4])?;
        (deviation_from_ideal(lines, wrist).largest() < IDEAL)
            .then(|| OrthoParallel::of_lines(at_zero, lines, wrist))
            .flatten()
    }

    /// The ortho-parallel geometry next to that of `chain`, if that deviates from it by less than `within` (m, rad);
    /// beyond its reach it answers as far as such an arm may reach, up to `slack` (m).
    pub(super) fn next_to(chain: &Chain, within: f64, slack: f64) -> Option<OrthoParallel> {
        let mut lines = lines_at_zero(chain)?;
        let wrist = lines[4].nearest_to(&lines[3])?;
        let deviation = deviation_from_ideal(&lines, wrist);
        if deviation.largest() >= within {
            return None;
        }
        lines = lines.map(|line| line.with_point_near(wrist));
        lines[1].axis = across(lines[1].axis, &lines[0].axis);
        lines[2].axis = lines[1].axis * sense_of(lines[2].axis.dot(&lines[1].axis));
        lines[4].axis = across(lines[4].axis, &lines[3].axis);
        lines[5].axis = across(lines[5].axis, &lines[4].axis);
        let at_zero = chain.base_from_flange(&[0.0; 6]);
        let mut arm = OrthoParallel::of_lines(&at_zero, &lines, wrist)?;
        arm.links.slack = deviation.slack(arm.links.l2 + arm.links.l3).min(slack);
        Some(arm)
    }

    fn of_lines(base_from_flange: &Isometry, lines: &[Line; 6], wrist: Point3<f64>) -> Option<OrthoParallel> {
        let [z1, z2, z3, z4, z5, z6] = lines.map(|line| line.axis);
        let [_, o2, o3, ..] = lines.map(|line| line.point);
        let arm = base_from_arm(lines, wrist);
        let [y, up] = [1, 2].map(|i| arm.rotation.matrix().column(i).into_owned());
        let base_from_arm = Isometry::from_parts(arm.translation, arm.rotation.into());
        let arm_from_base = base_from_arm.inverse();
        let (shoulder, elbow, w) = (arm_from_base * o2, arm_from_base * o3, arm_from_base * wrist);
        let (upper_arm, forearm) = (elbow - shoulder, w - elbow);
        let flange = Point3::from(base_from_flange.translation.vector);
        let out_of_flange =
            up_to_noise((flange - wrist).dot(&z6)).unwrap_or((base_from_flange * Vector3::z()).dot(&z6));
        let sense = [
            sense_of(z1.dot(&up)),
            sense_of(z2.dot(&y)),
            sense_of(z3.dot(&y)),
            sense_of(z4.dot(&(base_from_arm * forearm))),
            sense_of(z5.dot(&y)),
            sense_of(out_of_flange),
        ];
        let (a4, a5, a6) = (z4 * sense[3], z5 * sense[4], z6 * sense[5]);
        let forearm_at_zero = forearm.x.atan2(forearm.z);
        let flange_from_base = base_from_flange.inverse();
        Some(OrthoParallel {
            a1: shoulder.x,
            b: w.y,
            links: TwoLinks {
                l2: upper_arm.xz().norm(),
                l3: forearm.xz().norm(),
                slack: 0.0,
            },
            upper_arm_at_zero: upper_arm.x.atan2(upper_arm.z),
            forearm_at_zero,
            forearm_turn_at_zero: Turn::by(forearm_at_zero),
            bend_at_zero: a5.dot(&a4.cross(&a6)).atan2(a4.dot(&a6)),
            sense,
            wrist_axes: [arm_from_base * a4, arm_from_base * a5],
            flange_from_axis_5: flange_from_base * a5,
            flange_from_axis_6: flange_from_base * a6,
            flange_from_wrist: flange_from_base * wrist,
            arm_from_base,
        })
        .filter(|arm| arm.links.l2 > IDEAL && arm.links.l3 > IDEAL)
    }

    /// Branch of the chain positions `theta`, and the singularity that they are near, if any.
    ///
    /// Not checked: that there are six.
    pub fn name(&self, theta: &[f64]) -> (Branch, Option<Singularity>) {
        let (bend, eps, u) = self.bends(theta);
        let branch = Branch {
            shoulder: Shoulder::at(u + self.a1),
            elbow: TwoLinks::elbow(eps, u),
            wrist: Wrist::bent(bend.sin()),
        };
        (branch, self.links.singularity(bend.sin(), eps.sin(), u + self.a1))
    }

    /// The bends of wrist and elbow (rad) at the chain positions `theta`, and the wrist centre's distance (m) to the
    /// front of the shoulder.
    fn bends(&self, theta: &[f64]) -> (f64, f64, f64) {
        let phi = |i: usize| self.sense[i] * theta[i];
        let psi = self.upper_arm_at_zero + phi(1);
        let forearm = self.forearm_at_zero + phi(1) + phi(2);
        let u = self.links.l2 * psi.sin() + self.links.l3 * forearm.sin();
        (self.bend_at_zero + phi(4), forearm - psi, u)
    }

    /// How near to a singularity the chain positions `theta` are: the least of the sines of wrist and elbow, and the
    /// wrist centre's distance from axis 1 over the length of the arm.
    pub(super) fn nearness(&self, theta: &[f64; 6]) -> f64 {
        let (bend, eps, u) = self.bends(theta);
        let from_axis_1 = (u + self.a1) / (self.links.l2 + self.links.l3);
        bend.sin().abs().min(eps.sin().abs()).min(from_axis_1.abs())
    }
}

/// Deviation of these axes from an ortho-parallel arm with spherical wrist.
fn deviation_from_ideal(lines: &[Line; 6], wrist: Point3<f64>) -> AxisDeviation {
    let [z1, z2, z3, z4, z5, z6] = lines.map(|line| line.axis);
    AxisDeviation::of(
        [
            z1.dot(&z2).abs(),
            z2.cross(&z3).norm(),
            z4.dot(&z5).abs(),
            z5.dot(&z6).abs(),
        ],
        [
            lines[3].distance(wrist),
            lines[4].distance(wrist),
            lines[5].distance(wrist),
        ],
    )
}
