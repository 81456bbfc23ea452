//! Load-dependent stiffness: the load acts on the deflected arm.
//!
//! With the wrench `w` constant in base, drives and springs deflect by `x` until
//!
//! ```text
//! K x = J(x)^T w + tau_g(x) - tau_g(0)          K_C[i, j] = d(J^T w + tau_g)_i / d x_j
//! C = J (K - K_C)^-1 J^T                        tangent at the loaded posture
//! ```
//!
//! Newton's method with the exact `K_C`, in the compliance form `x = c (..)`, so that rigid joints (`c = 0`) need no
//! special case. For the screws `[v; o]` of `e` and `l`, the earlier and the later of i and j in the chain, the force
//! `f` at the TCP gives `K_C[i, j] = (o_e x v_l) . f`. The moment `m` gives `(o_j x o_i) . m` where j comes before i
//! and zero where it comes after: with moments `K_C` is not symmetric. Each mass acts at its own centre, on the screws
//! that both carry it.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x` | deflections of the drives, then of the springs | rad (m) |
//! | `K`, `K_C` | their stiffness; the stiffness by the load | N m/rad |
//!
//! An equilibrium is accepted if the symmetric part of `K - K_C` is positive definite: it is stable then.
//! Source: Chen & Kao 2000, Int. J. Robotics Research 19:835-847; Alici & Shirinzadeh 2005, IEEE Trans. Robotics
//! 21:554-564; `docs/theory/load-dependent.md`.

use nalgebra::{DMatrix, Matrix6, Vector3};

use super::gravity::{Carried, carry_into, torque};
use super::linear_system::{is_positive_definite, solve};
use super::stiffness_model::Arm;
use crate::robot::Attachment;
use crate::robot::deflected_arm::{DeflectedArm, deflect_into, twist_between};
use crate::spatial::{Twist, Wrench};

/// Why an arm has no equilibrium under its load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unstable {
    /// The equation has no solution nearby, or none was found.
    #[error("the arm finds no equilibrium under this load")]
    NoEquilibrium,
    /// An unstable equilibrium: the arm buckles.
    #[error("the arm buckles: its equilibrium under this load is not stable")]
    Buckles,
}

/// An arm without the load.
#[derive(Clone, Copy, Debug)]
pub struct AtRest<'a> {
    /// Chain positions of the drives, rad (m).
    pub theta: &'a [f64],
    /// Torque of gravity and compensator on each drive and spring, N m (N).
    pub torques: &'a [f64],
}

/// Working memory for the equilibrium, and the last one found.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    rest: DeflectedArm,
    deflected: DeflectedArm,
    carried: Vec<Carried>,
    /// Position of each drive or spring in the chain, base first.
    place: Vec<usize>,
    /// Attachment of each, by rank.
    rank: Vec<usize>,
    x: Vec<f64>,
    torques: Vec<f64>,
    slopes: Vec<f64>,
    k_c: DMatrix<f64>,
    matrix: DMatrix<f64>,
    step: DMatrix<f64>,
}

/// Maximum number of Newton steps; four are usual.
const MOST_STEPS: usize = 40;
/// Beyond this deflection of a drive (rad) the model is not valid.
const FARTHEST: f64 = 0.5;
/// Convergence: steps this small relative to the largest deflection, and absolutely (rad, m), leave only rounding.
const CONVERGED: (f64, f64) = (1e-10, 1e-16);

impl Equilibrium {
    /// Working memory for this arm.
    pub fn for_arm(arm: &Arm<'_>) -> Equilibrium {
        let joints = arm.robot.joints().len();
        let springs = arm.model.structure.springs.len();
        let rank: Vec<usize> = arm
            .attachments()
            .into_iter()
            .map(|attachment| attachment.rank(joints))
            .collect();
        let size = rank.len();
        // A drive comes before the springs of its own attachment; those come in the order of the list.
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by_key(|k| (rank[*k], *k));
        let mut place = vec![0; size];
        for (at, k) in order.into_iter().enumerate() {
            place[k] = at;
        }
        Equilibrium {
            rest: DeflectedArm::for_robot(arm.robot, springs),
            deflected: DeflectedArm::for_robot(arm.robot, springs),
            carried: vec![Carried::NOTHING; Attachment::count(joints)],
            place,
            rank,
            x: vec![0.0; size],
            torques: vec![0.0; size],
            slopes: vec![0.0; size],
            k_c: DMatrix::zeros(size, size),
            matrix: DMatrix::zeros(size, size),
            step: DMatrix::zeros(size, 1),
        }
    }

    /// Deflections of drives and springs, rad (m).
    pub fn turns(&self) -> &[f64] {
        &self.x
    }

    /// Torque of the load on each, the change of gravity's included, N m (N).
    pub fn torques(&self) -> &[f64] {
        &self.torques
    }

    /// Displacement of the tool from the arm `at_rest` to its equilibrium under `wrench`.
    ///
    /// `law` gives, for each drive or spring and the torque of the load on it, its deflection and the slope of that.
    ///
    /// # Errors
    /// [`Unstable`] with the reason.
    pub fn find(
        &mut self,
        arm: &Arm<'_>,
        at_rest: AtRest<'_>,
        wrench: &Wrench,
        law: impl Fn(usize, f64) -> (f64, f64),
    ) -> Result<Twist, Unstable> {
        self.x.fill(0.0);
        deflect_into(&arm.flexible(), at_rest.theta, &self.x, &mut self.rest);
        for _ in 0..MOST_STEPS {
            self.evaluate(arm, at_rest, wrench);
            for (k, slope) in self.slopes.iter_mut().enumerate() {
                let (turn, here) = law(k, self.torques[k]);
                *slope = here;
                self.step[(k, 0)] = turn - self.x[k];
            }
            self.fill_matrix();
            if !solve(&mut self.matrix, &mut self.step) {
                return Err(Unstable::NoEquilibrium);
            }
            let (mut longest, mut last) = (0.0_f64, 0.0_f64);
            for (x, step) in self.x.iter_mut().zip(self.step.iter()) {
                *x += step;
                if x.is_nan() || x.abs() > FARTHEST {
                    return Err(Unstable::NoEquilibrium);
                }
                (longest, last) = (longest.max(x.abs()), last.max(step.abs()));
            }
            if last <= CONVERGED.0 * longest + CONVERGED.1 {
                self.evaluate(arm, at_rest, wrench);
                return self.if_stable();
            }
        }
        Err(Unstable::NoEquilibrium)
    }

    /// The tangent compliance under the load at the current posture: 6 x 6 at the deflected TCP, base, translation
    /// first.
    pub fn tangent(&mut self) -> Option<Matrix6<f64>> {
        self.fill_matrix();
        let mut rows = DMatrix::from_fn(self.x.len(), 6, |k, j| {
            self.slopes[k] * self.deflected.screws[k].to_vector()[j]
        });
        solve(&mut self.matrix, &mut rows).then(|| {
            let column = |j: usize| -> nalgebra::Vector6<f64> {
                let screws = self.deflected.screws.iter().enumerate();
                screws.map(|(k, screw)| screw.to_vector() * rows[(k, j)]).sum()
            };
            Matrix6::from_columns(&[0, 1, 2, 3, 4, 5].map(column))
        })
    }

    /// Screws, torques and `K_C` of the arm deflected by `x`.
    fn evaluate(&mut self, arm: &Arm<'_>, at_rest: AtRest<'_>, wrench: &Wrench) {
        let AtRest { theta, torques } = at_rest;
        let structure = &arm.model.structure;
        deflect_into(&arm.flexible(), theta, &self.x, &mut self.deflected);
        let joints = theta.len();
        let (attachments, screws) = (&self.deflected.attachments, &self.deflected.screws);
        let tcp = self.deflected.base_from_tool().translation.vector;
        let g = arm.model.gravity.as_ref().map(|gravity| gravity.acceleration);
        if g.is_some() {
            let frame = |attachment: Attachment| attachments[attachment.rank(joints)];
            carry_into(&structure.masses, frame, tcp, &mut self.carried);
        }
        for (k, screw) in screws.iter().enumerate() {
            let weight = g.map_or(0.0, |g| {
                torque(screw, &self.carried[self.rank[k]], &g) - torques[k]
            });
            self.torques[k] = screw.dot(wrench) + weight;
        }
        self.set_load_stiffness(wrench);
        if let Some(g) = g {
            self.add_weight(&g);
        }
        if let Some(c) = &structure.compensator {
            let (at, turned) = (theta[c.joint], theta[c.joint] + self.x[c.joint]);
            // With gravity, the torque at rest contains the torque of the compensator at rest, and the weight above has
            // subtracted it.
            let taken_off = if g.is_some() { 0.0 } else { c.torque(at) };
            self.torques[c.joint] += c.torque(turned) - taken_off;
            self.k_c[(c.joint, c.joint)] += c.slope(turned);
        }
    }

    /// `K_C` of a wrench at the TCP.
    fn set_load_stiffness(&mut self, wrench: &Wrench) {
        for (i, a) in self.deflected.screws.iter().enumerate() {
            for (j, b) in self.deflected.screws.iter().enumerate() {
                let b_is_earlier = self.place[j] <= self.place[i];
                let (earlier, later) = if b_is_earlier { (b, a) } else { (a, b) };
                let mut value = earlier.angular.cross(&later.linear).dot(&wrench.force);
                if self.place[j] < self.place[i] {
                    value += b.angular.cross(&a.angular).dot(&wrench.moment);
                }
                self.k_c[(i, j)] = value;
            }
        }
    }

    /// Adds the part of the weight to `K_C`, each mass at its own centre.
    fn add_weight(&mut self, g: &Vector3<f64>) {
        for (i, a) in self.deflected.screws.iter().enumerate() {
            for (j, b) in self.deflected.screws.iter().enumerate() {
                let b_is_earlier = self.place[j] <= self.place[i];
                let (earlier, later) = if b_is_earlier { (b, a) } else { (a, b) };
                let both = &self.carried[self.rank[i].max(self.rank[j])];
                let (oe, ol) = (&earlier.angular, &later.angular);
                // (o_e x (v_l + o_l x r)) . g, summed over m and m r.
                let about = ol.dot(g) * oe.dot(&both.moment) - both.moment.dot(g) * oe.dot(ol);
                self.k_c[(i, j)] += oe.cross(&later.linear).dot(g) * both.mass + about;
            }
        }
    }

    /// `1 - c K_C`.
    fn fill_matrix(&mut self) {
        for i in 0..self.x.len() {
            for j in 0..self.x.len() {
                let unit = if i == j { 1.0 } else { 0.0 };
                self.matrix[(i, j)] = unit - self.slopes[i] * self.k_c[(i, j)];
            }
        }
    }

    fn if_stable(&mut self) -> Result<Twist, Unstable> {
        // K - K_C scaled by the roots of c on both sides; rows of rigid joints become those of the unit matrix.
        for i in 0..self.x.len() {
            for j in 0..self.x.len() {
                let unit = if i == j { 1.0 } else { 0.0 };
                let root = (self.slopes[i] * self.slopes[j]).sqrt();
                self.matrix[(i, j)] = unit - root * self.k_c[(i, j)];
            }
        }
        if !is_positive_definite(&mut self.matrix) {
            return Err(Unstable::Buckles);
        }
        Ok(twist_between(
            &self.rest.base_from_tool(),
            &self.deflected.base_from_tool(),
        ))
    }
}

#[cfg(test)]
mod tests;
