//! Closed-form inverse for ortho-parallel arms with spherical wrist.
//!
//! Any six turning joints qualify whose axis 2 is perpendicular to axis 1 and parallel to axis 3, and whose
//! axes 4, 5, 6 meet in one point with 4 perpendicular to 5 and 5 to 6, wherever the zeros lie. All angles
//! below are about axes turned to a common sense: 1 up, 2 and 3 along the arm's +y, 4 out along the forearm,
//! 5 along +y, 6 out of the flange.
//!
//! With `r` the distance of the wrist centre from axis 1 in the arm's plane, `psi` and `chi` the angles of upper
//! arm and forearm from the vertical towards the front, and `eps = chi - psi` their bend:
//!
//! ```text
//! phi1:  (cos, sin) = ((r px + b py), (r py - b px)) / (r^2 + b^2)          r = +-sqrt(px^2 + py^2 - b^2)
//! eps:   cos = (d^2 - l2^2 - l3^2) / (2 l2 l3), sin = +-sqrt(...)           d^2 = u^2 + v^2, u = r - a1, v = pz
//! psi:   (cos, sin) = (v k1 + u k2, u k1 - v k2) / d^2                       k1 = l2 + l3 cos eps, k2 = l3 sin eps
//! wrist: R4 R5 R6 = (R1 R2 R3)^T R, bend psi3 = +-atan2(|across|, along) of axis 6 seen from axis 4
//! ```
//!
//! Everything is carried as (cos, sin); each joint costs one atan2 at the end.
//!
//! Lengths m, angles rad. Source: textbook geometry; compare Brandstoetter, Angerer, Hofbaur 2014 (OPW).

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

use super::super::chain::{Chain, Motion};
use super::super::model::Robot;
use super::super::posture::{Branch, Elbow, Shoulder, Singularity, Unreachable, Wrist};
use crate::frame::Isometry;

/// How far (rad, m) a geometry may stray from the ideal and still be solved by the closed form.
const IDEAL: f64 = 1e-9;
/// A posture nearer than this (sine of 1 deg) to a singularity is flagged.
pub(crate) const NEAR_SINGULAR: f64 = 0.017_452_406;
/// Below this sine of the wrist bend joints 4 and 6 cannot be told apart.
pub(crate) const WRIST_SINGULAR: f64 = 1e-9;

/// The geometry of an ortho-parallel arm with spherical wrist, read off its chain.
#[derive(Clone, Debug)]
pub struct OrthoParallel {
    /// x to the front, y along axis 2, z along axis 1; origin on axis 1 at the height of axis 2.
    pub(crate) arm_from_base: Isometry,
    pub(crate) a1: f64,
    pub(crate) b: f64,
    pub(crate) l2: f64,
    pub(crate) l3: f64,
    /// Angles of upper arm and forearm from the vertical at chain zero.
    pub(crate) upper_arm_at_zero: f64,
    pub(crate) forearm_at_zero: f64,
    forearm_turn_at_zero: Turn,
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

/// Joint positions of one branch.
#[derive(Clone, Copy, Debug)]
pub struct Solution {
    /// Which branch.
    pub branch: Branch,
    /// Joint positions `q`, rad, each as near as possible to the middle of its range.
    pub joints: [f64; 6],
    /// Near which singularity, if any.
    pub singularity: Option<Singularity>,
}

impl OrthoParallel {
    /// The geometry of `chain`, or `None` if it is of another kind.
    pub fn recognise(chain: &Chain) -> Option<OrthoParallel> {
        let lines = lines_at_zero(chain)?;
        let [(o1, z1), (o2, z2), (o3, z3), (o4, z4), (o5, z5), (o6, z6)] = lines;
        let wrist = meeting_point((o4, z4), (o5, z5))?;
        let on_axis_6 = (wrist - o6).cross(&z6).norm() < IDEAL;
        let perpendicular = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(b).abs() < IDEAL;
        let ideal = on_axis_6
            && perpendicular(&z1, &z2)
            && z2.cross(&z3).norm() < IDEAL
            && perpendicular(&z4, &z5)
            && perpendicular(&z5, &z6);
        if !ideal {
            return None;
        }
        let base_from_flange = chain.base_from_flange(&[0.0; 6]);
        let up = z1 * sense_of(z1.z);
        let centre = o1 + up * (o2 - o1).dot(&up);
        // The front is where base x points; if it points along axis 2, where the wrist is.
        let front =
            up_to_noise(z2.cross(&up).x).or_else(|| up_to_noise((wrist - centre).dot(&z2.cross(&up))));
        let y = z2 * sense_of(front.unwrap_or(1.0));
        let x = y.cross(&up);
        let base_from_arm = Isometry::from_parts(
            centre.into(),
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(Matrix3::from_columns(
                &[x, y, up],
            ))),
        );
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
            l2: upper_arm.xz().norm(),
            l3: forearm.xz().norm(),
            upper_arm_at_zero: upper_arm.x.atan2(upper_arm.z),
            forearm_at_zero,
            forearm_turn_at_zero: Turn {
                cos: forearm_at_zero.cos(),
                sin: forearm_at_zero.sin(),
            },
            bend_at_zero: a5.dot(&a4.cross(&a6)).atan2(a4.dot(&a6)),
            sense,
            wrist_axes: [arm_from_base * a4, arm_from_base * a5],
            flange_from_axis_5: flange_from_base * a5,
            flange_from_axis_6: flange_from_base * a6,
            flange_from_wrist: flange_from_base * wrist,
            arm_from_base,
        })
        .filter(|arm| arm.l2 > IDEAL && arm.l3 > IDEAL)
    }

    /// Joint positions of one branch that bring the flange to `base_from_flange`.
    ///
    /// At the wrist singularity joint 4 stays as in `near`, or joints 4 and 6 share the turn evenly.
    /// Not checked: joint limits; forward kinematics (see [`super::holds`]).
    ///
    /// # Errors
    /// The wrist centre is out of reach of this branch.
    pub fn solve(
        &self,
        robot: &Robot,
        base_from_flange: &Isometry,
        branch: Branch,
        near: Option<&[f64]>,
    ) -> Result<Solution, Unreachable> {
        let p = self.arm_from_base * (base_from_flange * self.flange_from_wrist);
        let r_squared = p.x * p.x + p.y * p.y - self.b * self.b;
        if r_squared < 0.0 {
            return Err(Unreachable::InsideLateralOffset {
                by: self.b.abs() - p.x.hypot(p.y),
            });
        }
        let r = match branch.shoulder {
            Shoulder::Front => r_squared.sqrt(),
            Shoulder::Back => -r_squared.sqrt(),
        };
        let phi1 = Turn::new(r * p.x + self.b * p.y, r * p.y - self.b * p.x);
        let (u, v) = (r - self.a1, p.z);
        let (psi, chi) = self.two_link(u, v, branch.elbow)?;
        let kept = near.map(|q| self.sense[3] * robot.theta(3, q));
        let [phi4, bend, phi6] = self.wrist(base_from_flange, phi1, chi, (branch.wrist, kept));

        let (psi_angle, chi_angle, bend_angle) = (psi.angle(), chi.angle(), bend.angle());
        let phi = [
            phi1.angle(),
            psi_angle - self.upper_arm_at_zero,
            chi_angle - psi_angle - (self.forearm_at_zero - self.upper_arm_at_zero),
            phi4.angle(),
            bend_angle - self.bend_at_zero,
            phi6.angle(),
        ];
        let sin_elbow = chi.sin * psi.cos - chi.cos * psi.sin;
        Ok(Solution {
            branch,
            joints: self.joint_positions(robot, &phi),
            singularity: self.singularity(bend.sin, sin_elbow, r),
        })
    }

    /// Branch of joint positions, and the singularity they stand near, if any.
    pub fn name(&self, robot: &Robot, q: &[f64]) -> (Branch, Option<Singularity>) {
        let phi = |i: usize| self.sense[i] * robot.theta(i, q);
        let psi = self.upper_arm_at_zero + phi(1);
        let forearm = self.forearm_at_zero + phi(1) + phi(2);
        let (eps, bend) = (forearm - psi, self.bend_at_zero + phi(4));
        let u = self.l2 * psi.sin() + self.l3 * forearm.sin();
        let branch = Branch {
            shoulder: if u + self.a1 >= 0.0 {
                Shoulder::Front
            } else {
                Shoulder::Back
            },
            elbow: if (eps.sin() >= 0.0) == (u >= 0.0) {
                Elbow::Up
            } else {
                Elbow::Down
            },
            wrist: if bend.sin() >= 0.0 {
                Wrist::NoFlip
            } else {
                Wrist::Flip
            },
        };
        (branch, self.singularity(bend.sin(), eps.sin(), u + self.a1))
    }

    /// Angles of upper arm and forearm from the vertical.
    fn two_link(&self, u: f64, v: f64, elbow: Elbow) -> Result<(Turn, Turn), Unreachable> {
        let d_squared = u * u + v * v;
        let (reach, fold) = (self.l2 + self.l3, self.l2 - self.l3);
        let (stretched, folded) = (reach * reach - d_squared, d_squared - fold * fold);
        if stretched < 0.0 {
            return Err(Unreachable::TooFar {
                by: d_squared.sqrt() - reach,
            });
        }
        if folded < 0.0 {
            return Err(Unreachable::TooNear {
                by: fold.abs() - d_squared.sqrt(),
            });
        }
        // l3 (cos, sin) of the elbow's bend; bending the forearm forwards lifts the elbow if the wrist is
        // before the shoulder.
        let along = 0.5 * (d_squared - self.l2 * self.l2 - self.l3 * self.l3) / self.l2;
        let across = 0.5 * (stretched * folded).sqrt() / self.l2;
        let k2 = if (elbow == Elbow::Up) == (u >= 0.0) {
            across
        } else {
            -across
        };
        let k1 = self.l2 + along;
        let psi = Turn::new(v * k1 + u * k2, u * k1 - v * k2);
        let chi = Turn::new(v - self.l2 * psi.cos, u - self.l2 * psi.sin);
        Ok((psi, chi))
    }

    /// Joint 4, bend and joint 6; at the singularity joint 4 is `kept`.
    fn wrist(
        &self,
        base_from_flange: &Isometry,
        phi1: Turn,
        chi: Turn,
        (wrist, kept): (Wrist, Option<f64>),
    ) -> [Turn; 3] {
        // The forearm has turned by phi1 about z and by chi - chi0 about y; seen from it, the flange's own
        // directions of axes 6 and 5 at zero:
        let forearm = chi.less(self.forearm_turn_at_zero);
        let seen = |in_flange: &Vector3<f64>| {
            let v = self.arm_from_base * (base_from_flange * in_flange);
            let x = phi1.cos * v.x + phi1.sin * v.y;
            let y = phi1.cos * v.y - phi1.sin * v.x;
            Vector3::new(
                forearm.cos * x - forearm.sin * v.z,
                y,
                forearm.sin * x + forearm.cos * v.z,
            )
        };
        let [a4, a5] = self.wrist_axes;
        let a3 = a4.cross(&a5);
        let (out, second) = (seen(&self.flange_from_axis_6), seen(&self.flange_from_axis_5));
        let (along, up, side) = (out.dot(&a4), out.dot(&a3), out.dot(&a5));
        let bent = up.hypot(side);
        let flip = if wrist == Wrist::NoFlip { 1.0 } else { -1.0 };
        let bend = Turn::new(along, flip * bent);
        // Joint 6 turns axis 5, as joint 4 left it, to where the flange has it.
        let rest = |phi4: Turn| {
            let left = a5 * phi4.cos + a3 * phi4.sin;
            Turn::new(left.dot(&second), out.dot(&left.cross(&second)))
        };
        let phi4 = if bent < WRIST_SINGULAR {
            // Only the sum (or difference) of joints 4 and 6 counts here.
            let even = 0.5 * rest(Turn::ZERO).angle() * along.signum();
            let (sin, cos) = kept.unwrap_or(even).sin_cos();
            Turn { cos, sin }
        } else {
            Turn::new(-flip * up, flip * side)
        };
        [phi4, bend, rest(phi4)]
    }

    fn singularity(&self, sin_bend: f64, sin_elbow: f64, r: f64) -> Option<Singularity> {
        if sin_bend.abs() < NEAR_SINGULAR {
            Some(Singularity::Wrist)
        } else if sin_elbow.abs() < NEAR_SINGULAR {
            Some(Singularity::Elbow)
        } else if r.abs() < NEAR_SINGULAR * (self.l2 + self.l3) {
            Some(Singularity::Shoulder)
        } else {
            None
        }
    }

    /// Joint positions from angles in the common sense, each as near as possible to the middle of its range.
    fn joint_positions(&self, robot: &Robot, phi: &[f64; 6]) -> [f64; 6] {
        let mut q = [0.0; 6];
        for index in 0..6 {
            let middle = robot.joints()[index].limits.map_or(0.0, |limits| limits.middle());
            q[index] = nearest_turn(
                robot.joint_position(index, self.sense[index] * phi[index], &q),
                middle,
            );
        }
        q
    }
}

/// An angle as its cosine and sine.
#[derive(Clone, Copy, Debug)]
struct Turn {
    cos: f64,
    sin: f64,
}

impl Turn {
    const ZERO: Turn = Turn { cos: 1.0, sin: 0.0 };

    /// The angle of the vector (`x`, `y`); zero where it has no length.
    fn new(x: f64, y: f64) -> Turn {
        let length = (x * x + y * y).sqrt();
        if length > 0.0 {
            Turn {
                cos: x / length,
                sin: y / length,
            }
        } else {
            Turn::ZERO
        }
    }

    fn angle(self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// This angle minus another.
    fn less(self, other: Turn) -> Turn {
        Turn {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        }
    }
}

/// `angle` plus whole turns, in (middle - pi, middle + pi].
fn nearest_turn(angle: f64, middle: f64) -> f64 {
    use std::f64::consts::TAU;
    let away = (angle - middle) / TAU;
    // A hair below -half a turn is half a turn: -180 deg and 180 deg are one posture.
    angle - TAU * (away - 0.5 - 1e-12).ceil()
}

fn sense_of(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

fn up_to_noise(value: f64) -> Option<f64> {
    (value.abs() > IDEAL).then_some(value)
}

/// Point and unit axis of six turning joints at chain zero, in base.
fn lines_at_zero(chain: &Chain) -> Option<[(Point3<f64>, Vector3<f64>); 6]> {
    let (mut axes, mut origin) = (Matrix3::identity(), Vector3::zeros());
    let mut lines = Vec::with_capacity(6);
    for link in chain.links() {
        link.before.advance(&mut axes, &mut origin);
        match link.motion {
            Motion::About(axis, _) => lines.push((origin.into(), axes.column(axis.index()).into_owned())),
            Motion::Along(..) => return None,
        }
    }
    lines.try_into().ok()
}

/// Where two lines meet, if they do within 1e-9 m.
fn meeting_point(
    (o1, z1): (Point3<f64>, Vector3<f64>),
    (o2, z2): (Point3<f64>, Vector3<f64>),
) -> Option<Point3<f64>> {
    let normal = z1.cross(&z2);
    let n2 = normal.norm_squared();
    if n2 < IDEAL {
        return None;
    }
    let between = o2 - o1;
    let on_first = o1 + z1 * (between.cross(&z2).dot(&normal) / n2);
    ((on_first - o2).cross(&z2).norm() < IDEAL).then_some(on_first)
}
