//! The eight branches of an ortho-parallel arm at one pose, one lane each.
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
//! `r`, `u` and `eps` belong to several branches and are computed once; the rest is computed for all eight by the same
//! instructions. All angles are computed as (cos, sin); each joint needs one arc tangent at the end.
//!
//! Lengths m, angles rad. Source: textbook geometry; compare Brandstoetter, Angerer, Hofbaur 2014 (OPW).

use nalgebra::Vector3;

use super::super::branch::{Branch, BranchPattern};
use super::super::posture::Singularity;
use super::super::unreachable::Unreachable;
use super::lines::Turn;
use super::ortho_parallel::OrthoParallel;
use super::two_links::WRIST_SINGULAR;
use crate::frame::Isometry;
use crate::numbers::{
    Backend, Eight, Lanes, Real, Vector, Work, atan2, lanes_of, put_in_lane, vector_in_lane,
};

/// The eight branches of one pose, in the order of [`Branch::ALL`].
#[derive(Clone, Debug)]
pub(super) struct EightBranches {
    /// Chain positions of each joint, modulo whole turns; undefined where a branch does not reach.
    pub(super) theta: [Eight; 6],
    /// The singularity that each is near, or why it does not reach.
    pub(super) outcomes: [Result<Option<Singularity>, Unreachable>; 8],
}

impl EightBranches {
    /// One of them.
    ///
    /// # Errors
    /// It does not reach.
    pub(super) fn get(&self, branch: Branch) -> Result<([f64; 6], Option<Singularity>), Unreachable> {
        let lane = branch.index();
        Ok((self.theta.map(|theta| theta.0[lane]), self.outcomes[lane]?))
    }

    /// The branches that match `pattern`, each from `solve`.
    pub(super) fn one_by_one(
        pattern: BranchPattern,
        solve: impl Fn(Branch) -> Result<([f64; 6], Option<Singularity>), Unreachable>,
    ) -> EightBranches {
        let mut theta = [Eight::default(); 6];
        let outcomes = Branch::ALL.map(|branch| {
            if !pattern.matches(branch) {
                return Err(Unreachable::OtherBranch);
            }
            let (own, singularity) = solve(branch)?;
            for (theta, own) in theta.iter_mut().zip(own) {
                theta.0[branch.index()] = own;
            }
            Ok(singularity)
        });
        EightBranches { theta, outcomes }
    }
}

impl OrthoParallel {
    /// Chain positions of one branch that bring the flange to `base_from_flange`, modulo whole turns, and the
    /// singularity that they are near.
    ///
    /// At the wrist singularity joint 4 stays at `kept` (chain position, rad), or joints 4 and 6 share the turn evenly.
    /// Not checked: forward kinematics (see [`verify`](fn@super::verify)).
    ///
    /// # Errors
    /// The wrist centre is out of reach of this branch.
    pub fn chain_positions(
        &self,
        base_from_flange: &Isometry,
        branch: Branch,
        kept: Option<f64>,
    ) -> Result<([f64; 6], Option<Singularity>), Unreachable> {
        self.eight_branches(base_from_flange, kept).get(branch)
    }

    /// [`chain_positions`](Self::chain_positions) of every branch.
    pub(super) fn eight_branches(&self, base_from_flange: &Isometry, kept: Option<f64>) -> EightBranches {
        let arm_from_flange = self.arm_from_base * base_from_flange;
        let p = arm_from_flange * self.flange_from_wrist;
        let aim = Aim {
            v: p.z,
            out: arm_from_flange * self.flange_from_axis_6,
            second: arm_from_flange * self.flange_from_axis_5,
        };
        let mut solved = Solved::default();
        let mut outcomes = [Ok(None); 8];
        for first in [0, 4] {
            let reached = self.links.reach(&p, self.b, Branch::ALL[first].shoulder);
            let arm = reached.and_then(|(r, phi1)| {
                let u = r - self.a1;
                Ok((u, phi1, self.links.across(u, p.z, Branch::ALL[first].elbow)?))
            });
            match arm {
                Ok((u, phi1, across)) => solved.set_arm(first, u, phi1, across),
                Err(miss) => outcomes[first..first + 4].fill(Err(miss)),
            }
        }
        let mut theta = [Eight::default(); 6];
        if outcomes.iter().all(Result::is_err) {
            return EightBranches { theta, outcomes };
        }
        let backend = Backend::fastest();
        backend.run(FindWrists {
            arm: self,
            aim: &aim,
            solved: &mut solved,
        });
        for (lane, outcome) in outcomes.iter_mut().enumerate() {
            if outcome.is_err() {
                continue;
            }
            if solved.bent.0[lane] < WRIST_SINGULAR {
                self.choose_joint_4(lane, kept, &mut solved);
            }
            let r = solved.u.0[lane] + self.a1;
            *outcome = Ok(self
                .links
                .singularity(solved.bent.0[lane], solved.sin_elbow.0[lane], r));
        }
        backend.run(FindAngles {
            arm: self,
            solved: &solved,
            theta: &mut theta,
        });
        EightBranches { theta, outcomes }
    }

    /// Joint 4 at the wrist singularity, where only the sum (or difference) of joints 4 and 6 has an effect.
    fn choose_joint_4(&self, lane: usize, kept: Option<f64>, solved: &mut Solved) {
        let phi4 = kept.map_or_else(
            || {
                let (x, y) = solved.rest(WristAxes::of(self), Turn::ZERO, lane);
                0.5 * y.atan2(x) * solved.along.0[lane].signum()
            },
            |theta| self.sense[3] * theta,
        );
        (solved.sin_4.0[lane], solved.cos_4.0[lane]) = phi4.sin_cos();
    }
}

/// What a pose requests of an arm, in the arm's axes.
struct Aim {
    /// Height of the wrist centre above axis 2, m.
    v: f64,
    /// The flange's own directions of axes 6 and 5 at zero.
    out: Vector3<f64>,
    second: Vector3<f64>,
}

/// What is known of the eight branches before their angles.
#[derive(Default)]
struct Solved {
    u: Eight,
    cos_1: Eight,
    sin_1: Eight,
    across: Eight,
    cos_psi: Eight,
    sin_psi: Eight,
    cos_chi: Eight,
    sin_chi: Eight,
    sin_elbow: Eight,
    /// The flange's own directions of axes 6 and 5, seen from the forearm.
    out: [Eight; 3],
    second: [Eight; 3],
    /// Cosine and size of the sine of the wrist's bend.
    along: Eight,
    bent: Eight,
    cos_4: Eight,
    sin_4: Eight,
}

impl Solved {
    /// Sets the four branches from `first` on, elbow up before elbow down.
    fn set_arm(&mut self, first: usize, u: f64, phi1: Turn, across: f64) {
        for lane in first..first + 4 {
            self.u.0[lane] = u;
            self.cos_1.0[lane] = phi1.cos;
            self.sin_1.0[lane] = phi1.sin;
            self.across.0[lane] = if lane < first + 2 { across } else { -across };
        }
    }

    /// Cosine and sine of joint 6, up to a common factor, with joint 4 at `phi4`: joint 6 turns axis 5, as joint 4 left
    /// it, to its direction on the flange.
    #[inline(always)]
    fn rest<R: Real<Float = f64>>(&self, axes: WristAxes<R>, phi4: Turn<R>, lane: usize) -> (R, R) {
        let (out, second) = (
            vector_in_lane(&self.out, lane),
            vector_in_lane(&self.second, lane),
        );
        let left = axes.a3.mul_add(phi4.sin, axes.a5.scaled(phi4.cos));
        (left.dot(second), out.dot(left.cross(second)))
    }
}

/// Axes 4 and 5 at chain zero, and their cross product, in the arm's axes.
#[derive(Clone, Copy)]
struct WristAxes<R> {
    a4: Vector<R>,
    a5: Vector<R>,
    a3: Vector<R>,
}

impl<R: Real> WristAxes<R> {
    #[inline(always)]
    fn of(arm: &OrthoParallel) -> Self {
        let [a4, a5] = arm.wrist_axes;
        WristAxes {
            a4: Vector::of(&a4),
            a5: Vector::of(&a5),
            a3: Vector::of(&a4.cross(&a5)),
        }
    }
}

/// 1 for the branches without flip, -1 for those with it.
const FLIP: Eight = Lanes([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0]);

/// Upper arm, forearm, bend of the wrist and joint 4, as cosines and sines. Joint 4 is undefined where axes 4 and 6 are
/// in line.
struct FindWrists<'a> {
    arm: &'a OrthoParallel,
    aim: &'a Aim,
    solved: &'a mut Solved,
}

impl Work<f64> for FindWrists<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let FindWrists { arm, aim, solved } = self;
        let axes = WristAxes::<R>::of(arm);
        let (aim_out, aim_second) = (Vector::of(&aim.out), Vector::of(&aim.second));
        let (v, at_zero, links) = (R::of(aim.v), Turn::of(arm.forearm_turn_at_zero), arm.links);
        for i in 0..8 {
            R::step();
            let phi1 = Turn {
                cos: solved.cos_1.at(i),
                sin: solved.sin_1.at(i),
            };
            let (psi, chi) = links.turns::<R>(solved.u.at(i), v, solved.across.at(i));
            let forearm = chi.less(at_zero);
            let (out, second) = (seen(phi1, forearm, aim_out), seen(phi1, forearm, aim_second));
            let (along, up, side) = (out.dot(axes.a4), out.dot(axes.a3), out.dot(axes.a5));
            let bent = up.mul_add(up, side * side).sqrt();
            let per_bent = FLIP.at::<R>(i) / bent;
            solved.cos_4.set(i, -(up * per_bent));
            solved.sin_4.set(i, side * per_bent);
            solved.along.set(i, along);
            solved.bent.set(i, bent);
            put_in_lane(&mut solved.out, i, out);
            put_in_lane(&mut solved.second, i, second);
            solved.cos_psi.set(i, psi.cos);
            solved.sin_psi.set(i, psi.sin);
            solved.cos_chi.set(i, chi.cos);
            solved.sin_chi.set(i, chi.sin);
            solved.sin_elbow.set(i, chi.less(psi).sin);
        }
    }
}

/// A vector seen from the forearm, which has turned by phi1 about z and by `forearm` about y.
#[inline(always)]
fn seen<R: Real>(phi1: Turn<R>, forearm: Turn<R>, v: Vector<R>) -> Vector<R> {
    let (x, y) = phi1.back(v.x, v.y);
    let (z, x) = forearm.back(v.z, x);
    Vector::new(x, y, z)
}

/// Chain positions from cosines and sines.
struct FindAngles<'a> {
    arm: &'a OrthoParallel,
    solved: &'a Solved,
    theta: &'a mut [Eight; 6],
}

impl Work<f64> for FindAngles<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let FindAngles { arm, solved, theta } = self;
        let axes = WristAxes::<R>::of(arm);
        let [s1, s2, s3, s4, s5, s6] = lanes_of::<R>(&arm.sense);
        let (psi_at_zero, bend_at_zero) = (R::of(arm.upper_arm_at_zero), R::of(arm.bend_at_zero));
        let eps_at_zero = R::of(arm.forearm_at_zero - arm.upper_arm_at_zero);
        // A separate value: so short a loop is vectorised only where its results cannot overlap what it reads.
        let mut found = [Eight::default(); 6];
        for i in 0..8 {
            R::step();
            let psi = atan2::<R>(solved.sin_psi.at(i), solved.cos_psi.at(i));
            let chi = atan2::<R>(solved.sin_chi.at(i), solved.cos_chi.at(i));
            found[0].set(i, s1 * atan2(solved.sin_1.at(i), solved.cos_1.at(i)));
            found[1].set(i, s2 * (psi - psi_at_zero));
            found[2].set(i, s3 * (chi - psi - eps_at_zero));
        }
        for i in 0..8 {
            R::step();
            let phi4 = Turn {
                cos: solved.cos_4.at(i),
                sin: solved.sin_4.at(i),
            };
            let bend = atan2::<R>(FLIP.at::<R>(i) * solved.bent.at(i), solved.along.at(i));
            let (x, y) = solved.rest(axes, phi4, i);
            found[3].set(i, s4 * atan2(phi4.sin, phi4.cos));
            found[4].set(i, s5 * (bend - bend_at_zero));
            found[5].set(i, s6 * atan2(y, x));
        }
        *theta = found;
    }
}
