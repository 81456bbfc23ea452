//! The variance of the in-plane deviation by the uncertainties of load and tool.
//!
//! Each input is changed by its standard uncertainty, as in `source/arm_state/input_uncertainty.rs`; where no joint has a
//! torque curve (`curves`) the displacement is proportional to the wrench:
//!
//! ```text
//! by the amount of the load   r a . delta                  by a force u     a . C u
//! by the tool length l        a . (C at the TCP moved by l along the tool, under the same wrench) w  -  a . C w
//! ```

use super::chain::FramePlanes;
use super::compensator::Compensated;
use super::curves::Curved;
use super::input_order::{AMOUNT, FORCES, INPUTS, LENGTH};
use super::model::ModelConstants;
use super::parts::{PartPlanes, ResponsePlanes, angular};
use crate::kernel::lanes::load::Worst;
use crate::load::InputUncertainty;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, vector};

/// Adds the variance by load and tool, m^2; moments act only if `MOMENTS`.
pub(in crate::kernel::lanes) struct AddInputs<'a, T, const MOMENTS: bool> {
    pub model: &'a ModelConstants,
    pub inputs: &'a InputUncertainty,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a [PartPlanes<T>],
    pub curved: Curved<'a, T>,
    pub compensated: Option<Compensated<'a, T>>,
    pub response: &'a ResponsePlanes<T>,
    pub worst: &'a Worst<T>,
    /// Direction of the in-plane deviation, base.
    pub along: &'a Planes<T, 3>,
    pub variance: &'a mut Plane<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for AddInputs<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let mut by = planes();
        self.find_load::<R>(&mut by);
        if self.inputs.tool_length != 0.0 {
            self.find_length::<R>(&mut by[LENGTH]);
        }
        self.curved
            .change_by_inputs::<R, MOMENTS>(&self.worst.wrench, self.along, self.inputs, &mut by);
        for i in 0..BLOCK {
            R::step();
            let mut variance = R::load(self.variance[i]);
            let mut input = 0;
            while input < INPUTS {
                let by = R::load(by[input][i]);
                variance = by.mul_add(by, variance);
                input += 1;
            }
            self.variance[i] = variance.store();
        }
    }
}

impl<T: Float, const MOMENTS: bool> AddInputs<'_, T, MOMENTS> {
    /// By the amount of the load and by three forces.
    #[inline(always)]
    fn find_load<R: Real<Float = T>>(&self, by: &mut Planes<T, INPUTS>) {
        let relative = R::of(self.inputs.relative);
        let forces = [
            Vector::<R>::of(&self.inputs.forces[0]),
            Vector::<R>::of(&self.inputs.forces[1]),
            Vector::<R>::of(&self.inputs.forces[2]),
        ];
        for i in 0..BLOCK {
            R::step();
            let along = vector::<R>(self.along, i);
            // The compliance is symmetric.
            let reach = self.response.by::<R>(along, i);
            let mut as_is = reach.dot(vector::<R>(&self.worst.wrench[0..3], i));
            if MOMENTS {
                let by_moment = &self.response.by_moment;
                let moment = vector::<R>(&self.worst.wrench[3..6], i);
                let turned = Vector::new(
                    vector::<R>(&by_moment[0..3], i).dot(moment),
                    vector::<R>(&by_moment[3..6], i).dot(moment),
                    vector::<R>(&by_moment[6..9], i).dot(moment),
                );
                as_is = as_is + turned.dot(along);
            }
            by[AMOUNT][i] = (as_is * relative).store();
            let mut u = 0;
            while u < 3 {
                by[FORCES + u][i] = reach.dot(forces[u]).store();
                u += 1;
            }
        }
    }

    /// By the length of the tool: every part but those of the tool itself has a longer lever.
    #[inline(always)]
    fn find_length<R: Real<Float = T>>(&self, by_length: &mut Plane<T>) {
        let length = R::of(self.inputs.tool_length);
        let last = self.frames.len() - 1;
        let axis = &self.frames[last].axes[2];
        let mut k = 0;
        while k < self.parts.len() {
            let (constants, part) = (&self.model.parts[k], &self.parts[k]);
            let about = angular(self.model, self.frames, self.parts, k);
            let mut compliance = [T::from_f64(constants.compliance); BLOCK];
            if let Some(compensated) = &self.compensated
                && compensated.constants.part == k
            {
                compliance = compensated.compensated.compliance;
            }
            if constants.rank != last {
                for i in 0..BLOCK {
                    R::step();
                    let (linear, angular) = (vector::<R>(&part.linear, i), vector::<R>(about, i));
                    let force = vector::<R>(&self.worst.wrench[0..3], i);
                    let along = vector::<R>(self.along, i);
                    let more = angular.cross(vector::<R>(axis, i)).scaled(length);
                    let more_torque = more.dot(force);
                    let mut torque = linear.dot(force) + more_torque;
                    if MOMENTS {
                        torque = torque + angular.dot(vector::<R>(&self.worst.wrench[3..6], i));
                    }
                    let change = more.dot(along).mul_add(torque, linear.dot(along) * more_torque);
                    by_length[i] = change
                        .mul_add(R::load(compliance[i]), R::load(by_length[i]))
                        .store();
                }
            }
            k += 1;
        }
    }
}
