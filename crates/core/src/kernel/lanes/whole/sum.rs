//! The sum of the sources at each point of a block: what no load causes, and each load case.

use nalgebra::Vector3;

use super::chain::FramePlanes;
use super::model::ModelConstants;
use super::parts::PartPlanes;
use crate::numbers::{BLOCK, Float, Planes, Real, Vector, Work, put, vector};

/// Displacements of the tool without load, m, base.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct StillPlanes<T> {
    /// By gravity, relative to tool setting.
    pub gravity: Planes<T, 3>,
    pub geometry: Planes<T, 3>,
    /// The constant lengths from base to flange, which thermal growth multiplies.
    pub lengths: Planes<T, 3>,
}

/// Fills [`StillPlanes`].
pub(in crate::kernel::lanes) struct FindStill<'a, T> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<T>],
    /// The frames of the calibrated arm.
    pub actual: Option<&'a [FramePlanes<T>]>,
    pub parts: &'a [PartPlanes<T>],
    pub still: &'a mut StillPlanes<T>,
}

impl<T: Float> Work<T> for FindStill<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindStill {
            model,
            frames,
            actual,
            parts,
            still,
        } = self;
        let zero = R::of(0.0);
        let nothing = Vector::new(zero, zero, zero);
        for i in 0..BLOCK {
            R::step();
            put(&mut still.gravity, i, nothing);
        }
        if model.acceleration.is_some() {
            let mut k = 0;
            while k < parts.len() {
                let (constants, part) = (&model.parts[k], &parts[k]);
                let (c, there) = (
                    R::of(constants.compliance),
                    Vector::<R>::of(&constants.reference[0]),
                );
                for i in 0..BLOCK {
                    R::step();
                    let so_far = vector::<R>(&still.gravity, i) - there;
                    let turned = c * R::load(part.weight[i]);
                    put(
                        &mut still.gravity,
                        i,
                        vector::<R>(&part.linear, i).mul_add(turned, so_far),
                    );
                }
                k += 1;
            }
        }
        let tool = frames.len() - 1;
        if let Some(actual) = actual {
            for i in 0..BLOCK {
                R::step();
                let away = vector::<R>(&actual[tool].origin, i) - vector::<R>(&frames[tool].origin, i);
                put(&mut still.geometry, i, away);
            }
        }
        if model.growth.is_some() {
            for i in 0..BLOCK {
                R::step();
                put(&mut still.lengths, i, vector::<R>(&frames[tool - 1].origin, i));
            }
        }
    }
}

/// Fills the displacement of the tool (m, base) under one wrench at the TCP (base): elastic and gravity, then geometry
/// and thermal growth.
pub(in crate::kernel::lanes) struct OneWrench<'a, T> {
    pub model: &'a ModelConstants,
    pub parts: &'a [PartPlanes<T>],
    pub still: &'a StillPlanes<T>,
    pub force: Vector3<f64>,
    pub moment: Vector3<f64>,
    pub deviation: &'a mut Planes<T, 3>,
}

impl<T: Float> Work<T> for OneWrench<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let OneWrench {
            model,
            parts,
            still,
            force,
            moment,
            deviation,
        } = self;
        let (force, moment) = (Vector::<R>::of(&force), Vector::<R>::of(&moment));
        for i in 0..BLOCK {
            R::step();
            put(deviation, i, vector::<R>(&still.gravity, i));
        }
        let mut k = 0;
        while k < parts.len() {
            let part = &parts[k];
            let c = R::of(model.parts[k].compliance);
            for i in 0..BLOCK {
                R::step();
                let linear = vector::<R>(&part.linear, i);
                let torque = linear.dot(force) + vector::<R>(&part.angular, i).dot(moment);
                let so_far = vector::<R>(deviation, i);
                put(deviation, i, linear.mul_add(c * torque, so_far));
            }
            k += 1;
        }
        if model.geometry.is_some() {
            for i in 0..BLOCK {
                R::step();
                let sum = vector::<R>(deviation, i) + vector::<R>(&still.geometry, i);
                put(deviation, i, sum);
            }
        }
        if let Some([growth, _]) = model.growth {
            let growth = R::of(growth);
            for i in 0..BLOCK {
                R::step();
                let so_far = vector::<R>(deviation, i);
                put(
                    deviation,
                    i,
                    vector::<R>(&still.lengths, i).mul_add(growth, so_far),
                );
            }
        }
    }
}
