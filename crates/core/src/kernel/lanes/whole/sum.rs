//! The sum of the sources at each point of a block: what no load causes, and each load case.

use nalgebra::Vector3;

use std::ops::Range;

use super::chain::FramePlanes;
use super::model::ModelConstants;
use super::parts::ResponsePlanes;
use crate::kernel::lanes::load::{CaseLanes, Worst};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, put, vector};
use crate::spatial::Wrench;

/// Displacements of the tool without load, m, base.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct StillPlanes<T> {
    /// Gravity relative to tool setting, geometry and thermal growth.
    pub sum: Planes<T, 3>,
    pub geometry: Planes<T, 3>,
    /// The constant lengths from base to flange, without the travel of prismatic joints, which thermal growth multiplies.
    pub lengths: Planes<T, 3>,
}

/// Fills geometry and lengths.
pub(in crate::kernel::lanes) struct FindUnloaded<'a, T> {
    pub model: &'a ModelConstants,
    /// Joint positions, rad (m).
    pub joints: &'a [Plane<T>],
    pub frames: &'a [FramePlanes<T>],
    /// The tool of the calibrated arm.
    pub actual: &'a FramePlanes<T>,
    pub still: &'a mut StillPlanes<T>,
}

impl<T: Float> Work<T> for FindUnloaded<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindUnloaded {
            model,
            joints,
            frames,
            actual,
            still,
        } = self;
        let tool = frames.len() - 1;
        if model.geometry.is_some() {
            for i in 0..BLOCK {
                R::step();
                let away = vector::<R>(&actual.origin, i) - vector::<R>(&frames[tool].origin, i);
                put(&mut still.geometry, i, away);
            }
        }
        if model.growth.is_some() {
            still.lengths.clone_from(&frames[tool - 1].origin);
            // A scale measures the travel of a prismatic joint: it does not grow.
            let mut joint = 0;
            while joint < model.chain.joints() {
                let (axis, slides) = model.chain.axis(joint);
                if slides {
                    let travel = model.chain.theta::<R>(joints, joint);
                    let along = &frames[joint + 1].axes[axis];
                    for i in 0..BLOCK {
                        R::step();
                        let so_far = vector::<R>(&still.lengths, i);
                        let travelled = vector::<R>(along, i).scaled(R::load(travel[i]));
                        put(&mut still.lengths, i, so_far - travelled);
                    }
                }
                joint += 1;
            }
        }
    }
}

/// Fills the sum of what no load causes.
pub(in crate::kernel::lanes) struct AddStill<'a, T> {
    pub model: &'a ModelConstants,
    pub response: &'a ResponsePlanes<T>,
    pub still: &'a mut StillPlanes<T>,
}

impl<T: Float> Work<T> for AddStill<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let AddStill {
            model,
            response,
            still,
        } = self;
        let there = Vector::<R>::of(&model.reference);
        for i in 0..BLOCK {
            R::step();
            put(&mut still.sum, i, vector::<R>(&response.by_gravity, i) - there);
        }
        if model.geometry.is_some() {
            for i in 0..BLOCK {
                R::step();
                let sum = vector::<R>(&still.sum, i) + vector::<R>(&still.geometry, i);
                put(&mut still.sum, i, sum);
            }
        }
        if let Some([growth, _]) = model.growth {
            let growth = R::of(growth);
            for i in 0..BLOCK {
                R::step();
                let so_far = vector::<R>(&still.sum, i);
                let sum = vector::<R>(&still.lengths, i).mul_add(growth, so_far);
                put(&mut still.sum, i, sum);
            }
        }
    }
}

/// Fills the displacement of the tool (m, base) under one wrench at the TCP (base) by all but backlash: the response to it, and
/// the `rest`; its moment acts only if `MOMENTS`.
pub(in crate::kernel::lanes) struct OneWrench<'a, T, const MOMENTS: bool> {
    pub response: &'a ResponsePlanes<T>,
    pub rest: &'a Planes<T, 3>,
    pub wrench: &'a Wrench,
    pub deviation: &'a mut Planes<T, 3>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for OneWrench<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let (force, moment) = (
            Vector::<R>::of(&self.wrench.force),
            Vector::<R>::of(&self.wrench.moment),
        );
        let (response, rest, deviation) = (self.response, self.rest, self.deviation);
        for i in 0..BLOCK {
            R::step();
            put(
                deviation,
                i,
                under::<R, MOMENTS>(response, rest, force, moment, i),
            );
        }
    }
}

/// [`OneWrench`], taken into the worst so far.
pub(in crate::kernel::lanes) struct OneCase<'a, T, const MOMENTS: bool> {
    pub response: &'a ResponsePlanes<T>,
    pub rest: &'a Planes<T, 3>,
    /// Index of the case and of those that follow.
    pub cases: Range<usize>,
    pub wrench: &'a Wrench,
    /// Two directions across the normal, then the normal, base.
    pub plane: &'a [Vector3<f64>; 3],
    pub deviation: &'a mut Planes<T, 3>,
    pub worst: &'a mut Worst<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for OneCase<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let Wrench { force, moment } = self.wrench;
        let case = CaseLanes::<R>::new(self.cases, force, moment, self.plane);
        let (response, rest, deviation) = (self.response, self.rest, self.deviation);
        for i in 0..BLOCK {
            R::step();
            let delta = under::<R, MOMENTS>(response, rest, case.force, case.moment, i);
            put(deviation, i, delta);
            case.take::<MOMENTS>(delta, i, self.worst);
        }
    }
}

/// Displacement of point `i` under a wrench, m, base: the response to it and the `rest`.
#[inline(always)]
pub(in crate::kernel::lanes) fn under<R: Real, const MOMENTS: bool>(
    response: &ResponsePlanes<R::Float>,
    rest: &Planes<R::Float, 3>,
    force: Vector<R>,
    moment: Vector<R>,
    i: usize,
) -> Vector<R> {
    let mut delta = response.by::<R>(force, i) + vector::<R>(rest, i);
    if MOMENTS {
        let by_moment = &response.by_moment;
        delta = delta
            + Vector::new(
                vector::<R>(&by_moment[0..3], i).dot(moment),
                vector::<R>(&by_moment[3..6], i).dot(moment),
                vector::<R>(&by_moment[6..9], i).dot(moment),
            );
    }
    delta
}
