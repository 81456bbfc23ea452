//! Screws of all drives and springs of a block, and the torque of gravity on each.

use super::chain::FramePlanes;
use super::model::ModelConstants;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, vector};

/// A drive or spring at each point: its screw at the TCP (base), and the torque of gravity on it, N m (N).
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct PartPlanes<T> {
    pub linear: Planes<T, 3>,
    pub angular: Planes<T, 3>,
    pub weight: Plane<T>,
}

impl<T: Float> PartPlanes<T> {
    /// A part of which nothing is known yet.
    pub fn unknown() -> PartPlanes<T> {
        PartPlanes {
            linear: planes(),
            angular: planes(),
            weight: [T::default(); BLOCK],
        }
    }
}

/// Fills the parts from the frames, which are in the order of ranks.
pub(in crate::kernel::lanes) struct FindParts<'a, T> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a mut [PartPlanes<T>],
}

impl<T: Float> Work<T> for FindParts<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindParts { model, frames, parts } = self;
        let tcp = &frames[frames.len() - 1].origin;
        let mut k = 0;
        while k < parts.len() {
            let constants = &model.parts[k];
            let frame = &frames[constants.rank];
            let (along, about) = (
                Vector::<R>::of(&constants.linear),
                Vector::<R>::of(&constants.angular),
            );
            let part = &mut parts[k];
            for i in 0..BLOCK {
                R::step();
                let x = vector::<R>(&frame.axes[0], i);
                let y = vector::<R>(&frame.axes[1], i);
                let z = vector::<R>(&frame.axes[2], i);
                let lever = vector::<R>(tcp, i) - vector::<R>(&frame.origin, i);
                let angular = x.mul_add(about.x, y.mul_add(about.y, z.scaled(about.z)));
                let linear = x.mul_add(along.x, y.mul_add(along.y, z.scaled(along.z)));
                put(&mut part.angular, i, angular);
                put(&mut part.linear, i, linear + angular.cross(lever));
            }
            k += 1;
        }
        weigh::<R>(model, frames, parts);
    }
}

/// Torque of gravity on every part: it carries all masses between itself and the tool.
#[inline(always)]
fn weigh<R: Real>(
    model: &ModelConstants,
    frames: &[FramePlanes<R::Float>],
    parts: &mut [PartPlanes<R::Float>],
) {
    let Some(acceleration) = &model.acceleration else {
        return;
    };
    let g = Vector::<R>::of(acceleration);
    let tcp = &frames[frames.len() - 1].origin;
    let mut mass = 0.0;
    let mut moment: Planes<R::Float, 3> = planes();
    let mut rank = frames.len();
    while rank > 0 {
        rank -= 1;
        let frame = &frames[rank];
        let mut m = 0;
        while m < model.masses.len() {
            let one = &model.masses[m];
            m += 1;
            if one.rank != rank {
                continue;
            }
            mass += one.mass;
            let (centre, heavy) = (Vector::<R>::of(&one.centre), R::of(one.mass));
            for i in 0..BLOCK {
                R::step();
                let x = vector::<R>(&frame.axes[0], i);
                let y = vector::<R>(&frame.axes[1], i);
                let z = vector::<R>(&frame.axes[2], i);
                let away = vector::<R>(&frame.origin, i) - vector::<R>(tcp, i);
                let at = x.mul_add(centre.x, y.mul_add(centre.y, z.mul_add(centre.z, away)));
                let so_far = vector::<R>(&moment, i);
                put(&mut moment, i, at.mul_add(heavy, so_far));
            }
        }
        let force = g.scaled(R::of(mass));
        let mut k = 0;
        while k < parts.len() {
            if model.parts[k].rank == rank {
                let part = &mut parts[k];
                for i in 0..BLOCK {
                    R::step();
                    let turned = vector::<R>(&moment, i).cross(g);
                    let linear = vector::<R>(&part.linear, i);
                    let angular = vector::<R>(&part.angular, i);
                    part.weight[i] = (linear.dot(force) + angular.dot(turned)).store();
                }
            }
            k += 1;
        }
    }
}
