//! The uncertainty of the in-plane deviation by the uncertainties of load and tool.
//!
//! Each input is changed by its standard uncertainty, as in `source/arm_state/input_uncertainty.rs`; the displacement
//! is proportional to the wrench:
//!
//! ```text
//! by the amount of the load   r a . delta                  by a force u     a . C u
//! by the tool length l        a . (C at the TCP moved by l along the tool, under the same wrench) w  -  a . C w
//! ```

use super::chain::FramePlanes;
use super::model::ModelConstants;
use super::parts::PartPlanes;
use crate::kernel::lanes::load::Worst;
use crate::load::InputUncertainty;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, vector};

/// Adds the contribution of load and tool to the standard uncertainty (m).
pub(in crate::kernel::lanes) struct AddInputs<'a, T> {
    pub model: &'a ModelConstants,
    pub inputs: &'a InputUncertainty,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a [PartPlanes<T>],
    pub worst: &'a Worst<T>,
    /// Direction of the in-plane deviation, base.
    pub along: &'a Planes<T, 3>,
    pub uncertainty: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for AddInputs<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let zero = T::default();
        // Elastic, with a longer tool, and by each uncertain force.
        let (mut as_is, mut longer, mut by_force) = ([zero; BLOCK], [zero; BLOCK], [[zero; BLOCK]; 3]);
        let forces = [
            Vector::<R>::of(&self.inputs.forces[0]),
            Vector::<R>::of(&self.inputs.forces[1]),
            Vector::<R>::of(&self.inputs.forces[2]),
        ];
        let tool = &self.frames[self.frames.len() - 1];
        let mut k = 0;
        while k < self.parts.len() {
            let (constants, part) = (&self.model.parts[k], &self.parts[k]);
            let c = R::of(constants.compliance);
            // What is attached to the tool moves with its tip.
            let carried = constants.rank + 1 == self.frames.len();
            let length = R::of(if carried { 0.0 } else { self.inputs.tool_length });
            for i in 0..BLOCK {
                R::step();
                let (linear, angular) = (vector::<R>(&part.linear, i), vector::<R>(&part.angular, i));
                let force = vector::<R>(&self.worst.wrench[0..3], i);
                let by_moment = angular.dot(vector::<R>(&self.worst.wrench[3..6], i));
                let along = vector::<R>(self.along, i);
                let reach = linear.dot(along) * c;
                as_is[i] = (linear.dot(force) + by_moment)
                    .mul_add(reach, R::load(as_is[i]))
                    .store();
                let moved = angular
                    .cross(vector::<R>(&tool.axes[2], i))
                    .mul_add(length, linear);
                let torque = moved.dot(force) + by_moment;
                longer[i] = torque.mul_add(moved.dot(along) * c, R::load(longer[i])).store();
                let mut u = 0;
                while u < 3 {
                    let so_far = R::load(by_force[u][i]);
                    by_force[u][i] = linear.dot(forces[u]).mul_add(reach, so_far).store();
                    u += 1;
                }
            }
            k += 1;
        }
        let relative = R::of(self.inputs.relative);
        for i in 0..BLOCK {
            R::step();
            let before = R::load(self.uncertainty[i]);
            let by_amount = R::load(as_is[i]) * relative;
            let by_length = R::load(longer[i]) - R::load(as_is[i]);
            let mut variance = before.mul_add(before, by_amount.mul_add(by_amount, by_length * by_length));
            let mut u = 0;
            while u < 3 {
                let by = R::load(by_force[u][i]);
                variance = by.mul_add(by, variance);
                u += 1;
            }
            self.uncertainty[i] = variance.sqrt().store();
        }
    }
}
