//! Joints whose stiffness depends on their torque (`robot/torque_curve.rs`): their part of the displacement is not
//! proportional to the load, and is added for each load case.
//!
//! ```text
//! theta(x) = start + m_0 x + sum_j (m_j - m_(j-1)) max(x - t_j, 0)        knots t_j, slopes m_j
//! delta += v (theta(tau_g + tau) - theta(tau_g))                          theta: falling where tau < 0, otherwise rising
//! ```
//!
//! No branch, and any number of pairs up to a limit (`curve_angles`). Angles are relative to that without torque; they differ from
//! those of the plain row by rounding of the largest angle of the curve.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `tau_g`, `tau` | torque of gravity on the joint, torque of the load | N m |
//! | `v` | linear part of its screw at the TCP | m/rad |

use super::chain::FramePlanes;
use super::curve_angles::{CurveConstants, find_angles, find_turns};
use super::input_order::{AMOUNT, FORCES, INPUTS, LENGTH};
use super::model::ModelConstants;
use super::parts::{PartPlanes, angular};
use super::sum::StillPlanes;
use crate::load::InputUncertainty;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, vector};

/// A joint with curves at each point.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct CurvePlanes<T> {
    /// Angles of the rising and the falling curve under gravity, rad.
    before: Planes<T, 2>,
    /// Rotation by gravity alone, rad.
    sag: Plane<T>,
}

/// Memory for the curves of this arm.
pub(in crate::kernel::lanes) fn curves_of<T: Float>(model: &ModelConstants) -> Vec<CurvePlanes<T>> {
    let unknown = CurvePlanes {
        before: planes(),
        sag: [T::default(); BLOCK],
    };
    vec![unknown; model.curves.len()]
}

/// Fills the angles under gravity and adds the displacement by it, m, base.
pub(in crate::kernel::lanes) struct FindSag<'a, T> {
    pub model: &'a ModelConstants,
    pub parts: &'a [PartPlanes<T>],
    pub curves: &'a mut [CurvePlanes<T>],
    pub still: &'a mut StillPlanes<T>,
}

impl<T: Float> Work<T> for FindSag<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let zero = R::of(0.0);
        let mut n = 0;
        while n < self.curves.len() {
            let (constants, curve) = (&self.model.curves[n], &mut self.curves[n]);
            let part = &self.parts[constants.part];
            find_angles::<R>(constants, &part.weight, &mut curve.before);
            for i in 0..BLOCK {
                R::step();
                let (rising, falling) = (R::load(curve.before[0][i]), R::load(curve.before[1][i]));
                let sag = R::either(R::load(part.weight[i]) < zero, falling, rising);
                curve.sag[i] = sag.store();
                let so_far = vector::<R>(&self.still.sum, i);
                let sum = vector::<R>(&part.linear, i).mul_add(sag, so_far);
                put(&mut self.still.sum, i, sum);
            }
            n += 1;
        }
    }
}

/// Torques on part `k` by wrenches at the TCP (base), N m; moments only if `MOMENTS`.
#[inline(always)]
fn find_torques<R: Real, const MOMENTS: bool>(
    linear: &Planes<R::Float, 3>,
    axis: &Planes<R::Float, 3>,
    wrench: &Planes<R::Float, 6>,
    torques: &mut Plane<R::Float>,
) {
    for i in 0..BLOCK {
        R::step();
        let mut torque = vector::<R>(linear, i).dot(vector::<R>(&wrench[0..3], i));
        if MOMENTS {
            torque = torque + vector::<R>(axis, i).dot(vector::<R>(&wrench[3..6], i));
        }
        torques[i] = torque.store();
    }
}

/// Joints with curves in one posture at each point.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Curved<'a, T> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a [PartPlanes<T>],
    pub curves: &'a [CurvePlanes<T>],
}

/// Adds the displacement (m, base) by the rotation of these joints under a wrench (at the TCP, base) at each point; its
/// moment acts only if `MOMENTS`.
pub(in crate::kernel::lanes) struct AddTurns<'a, T, const MOMENTS: bool> {
    pub arm: Curved<'a, T>,
    pub wrench: &'a Planes<T, 6>,
    pub sum: &'a mut Planes<T, 3>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for AddTurns<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let arm = self.arm;
        let (mut torques, mut turns) = ([T::default(); BLOCK], [T::default(); BLOCK]);
        let mut n = 0;
        while n < arm.curves.len() {
            arm.turn::<R, MOMENTS>(n, self.wrench, &mut torques, &mut turns);
            let linear = &arm.parts[arm.model.curves[n].part].linear;
            for i in 0..BLOCK {
                R::step();
                let so_far = vector::<R>(self.sum, i);
                let sum = vector::<R>(linear, i).mul_add(R::load(turns[i]), so_far);
                put(self.sum, i, sum);
            }
            n += 1;
        }
    }
}

impl<T: Float> Curved<'_, T> {
    /// Torques (N m) and rotations (rad) of the joint with the curves `n` under a wrench.
    #[inline(always)]
    fn turn<R: Real<Float = T>, const MOMENTS: bool>(
        &self,
        n: usize,
        wrench: &Planes<T, 6>,
        torques: &mut Plane<T>,
        turns: &mut Plane<T>,
    ) {
        let (constants, curve) = (&self.model.curves[n], &self.curves[n]);
        let part = &self.parts[constants.part];
        let axis = angular(self.model, self.frames, self.parts, constants.part);
        find_torques::<R, MOMENTS>(&part.linear, axis, wrench, torques);
        find_turns::<R>(constants, [&part.weight, torques], &curve.before, turns);
    }

    /// Adds the parts of these joints under a wrench along a direction to the shares of their contributors and to their
    /// sum, m; gravity is relative to tool setting.
    #[inline(always)]
    pub fn share<R: Real<Float = T>, const MOMENTS: bool>(
        &self,
        wrench: &Planes<T, 6>,
        along: &Planes<T, 3>,
        shares: &mut [Plane<T>],
        sum: &mut Plane<T>,
    ) {
        let (mut torques, mut turns) = ([T::default(); BLOCK], [T::default(); BLOCK]);
        let mut n = 0;
        while n < self.curves.len() {
            self.turn::<R, MOMENTS>(n, wrench, &mut torques, &mut turns);
            let (constants, sag) = (&self.model.curves[n], &self.curves[n].sag);
            let linear = &self.parts[constants.part].linear;
            let share = &mut shares[self.model.parts[constants.part].contributor];
            let there = Vector::<R>::of(&constants.reference);
            for i in 0..BLOCK {
                R::step();
                let along = vector::<R>(along, i);
                let reach = vector::<R>(linear, i).dot(along);
                let turned = R::load(turns[i]) + R::load(sag[i]);
                let part = reach.mul_add(turned, -there.dot(along));
                share[i] = (R::load(share[i]) + part).store();
                sum[i] = (R::load(sum[i]) + part).store();
            }
            n += 1;
        }
    }

    /// Adds to `by` (m) what these joints contribute to the change of the displacement along a direction by each input
    /// changed by its standard uncertainty.
    #[inline(always)]
    pub fn change_by_inputs<R: Real<Float = T>, const MOMENTS: bool>(
        &self,
        wrench: &Planes<T, 6>,
        along: &Planes<T, 3>,
        inputs: &InputUncertainty,
        by: &mut Planes<T, INPUTS>,
    ) {
        let (mut torques, mut turns) = ([T::default(); BLOCK], [T::default(); BLOCK]);
        let mut reach = turns;
        let mut n = 0;
        while n < self.curves.len() {
            self.turn::<R, MOMENTS>(n, wrench, &mut torques, &mut turns);
            let (constants, curve) = (&self.model.curves[n], &self.curves[n]);
            let part = &self.parts[constants.part];
            for i in 0..BLOCK {
                R::step();
                reach[i] = vector::<R>(&part.linear, i).dot(vector::<R>(along, i)).store();
            }
            let changed = Changed {
                constants,
                reach: &reach,
                turns: &turns,
            };
            let mut more = torques;
            let of_amount = R::of(inputs.relative);
            for i in 0..BLOCK {
                R::step();
                let torque = R::load(torques[i]);
                more[i] = of_amount.mul_add(torque, torque).store();
            }
            changed.add::<R>([&part.weight, &more], &curve.before, &reach, &mut by[AMOUNT]);
            let mut u = 0;
            while u < 3 {
                let force = Vector::<R>::of(&inputs.forces[u]);
                for i in 0..BLOCK {
                    R::step();
                    let torque = R::load(torques[i]) + vector::<R>(&part.linear, i).dot(force);
                    more[i] = torque.store();
                }
                changed.add::<R>([&part.weight, &more], &curve.before, &reach, &mut by[FORCES + u]);
                u += 1;
            }
            if inputs.tool_length != 0.0 {
                let length = R::of(inputs.tool_length);
                let tool = &self.frames[self.frames.len() - 1].axes[2];
                let axis = angular(self.model, self.frames, self.parts, constants.part);
                let weight = Vector::<R>::of(&self.model.weight_on_tool);
                let (mut before, mut farther) = (part.weight, reach);
                for i in 0..BLOCK {
                    R::step();
                    let away = vector::<R>(axis, i).cross(vector::<R>(tool, i)).scaled(length);
                    let force = vector::<R>(&wrench[0..3], i);
                    more[i] = (R::load(torques[i]) + away.dot(force)).store();
                    // Masses on the tool move with its end.
                    before[i] = (R::load(part.weight[i]) + away.dot(weight)).store();
                    let along = vector::<R>(along, i);
                    farther[i] = (R::load(reach[i]) + away.dot(along)).store();
                }
                let mut from = planes();
                find_angles::<R>(constants, &before, &mut from);
                changed.add::<R>([&before, &more], &from, &farther, &mut by[LENGTH]);
            }
            n += 1;
        }
    }
}

/// A joint before an input changes: displacement along a direction per rotation, m/rad, and rotation under the load, rad.
struct Changed<'a, T> {
    constants: &'a CurveConstants,
    reach: &'a Plane<T>,
    turns: &'a Plane<T>,
}

impl<T: Float> Changed<'_, T> {
    /// Adds to `by` how much this joint changes the displacement when its torques and its reach are these.
    #[inline(always)]
    fn add<R: Real<Float = T>>(
        &self,
        torques: [&Plane<T>; 2],
        from: &Planes<T, 2>,
        reach: &Plane<T>,
        by: &mut Plane<T>,
    ) {
        let mut turns = [T::default(); BLOCK];
        find_turns::<R>(self.constants, torques, from, &mut turns);
        for i in 0..BLOCK {
            R::step();
            let as_is = R::load(self.reach[i]) * R::load(self.turns[i]);
            let changed = R::load(reach[i]).mul_add(R::load(turns[i]), -as_is);
            by[i] = (R::load(by[i]) + changed).store();
        }
    }
}
