//! Requested flange poses of a block, and whether frames are there.

use crate::frame::Isometry;
use crate::kernel::lanes::whole::FramePlanes;
use crate::numbers::{BLOCK, Float, Plane, Real, Work, vector};
use crate::robot::inverse::VERIFIED;

/// Fills the flange pose of each tool pose, at most a block; the remaining lanes repeat the last.
pub(super) fn set_targets(poses: &[Isometry], tool_from_flange: &Isometry, targets: &mut FramePlanes<f64>) {
    let repeated = poses.last().into_iter().cycle();
    for (i, pose) in poses.iter().chain(repeated).take(BLOCK).enumerate() {
        let flange = pose * tool_from_flange;
        let rotation = flange.rotation.to_rotation_matrix();
        for (axis, column) in targets.axes.iter_mut().zip(rotation.matrix().column_iter()) {
            for (plane, value) in axis.iter_mut().zip(column.iter()) {
                plane[i] = *value;
            }
        }
        for (plane, value) in targets.origin.iter_mut().zip(flange.translation.vector.iter()) {
            plane[i] = *value;
        }
    }
}

/// Writes 1 where a frame misses its target by more than 1e-9 (m, rad), otherwise 0.
pub(in crate::kernel::lanes) struct FindMissed<'a, T> {
    targets: &'a FramePlanes<T>,
    frames: &'a FramePlanes<T>,
    missed: &'a mut Plane<T>,
}

/// See [`FindMissed`].
pub(in crate::kernel::lanes) fn find_missed<'a, T>(
    targets: &'a FramePlanes<T>,
    frames: &'a FramePlanes<T>,
    missed: &'a mut Plane<T>,
) -> FindMissed<'a, T> {
    FindMissed {
        targets,
        frames,
        missed,
    }
}

impl<T: Float> Work<T> for FindMissed<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let least = R::of(VERIFIED * VERIFIED);
        let (zero, one) = (R::of(0.0), R::of(1.0));
        for i in 0..BLOCK {
            R::step();
            let away = vector::<R>(&self.frames.origin, i) - vector::<R>(&self.targets.origin, i);
            // For small angles the sines of the angles between the axes, half their sum for each direction.
            let sine = vector::<R>(&self.frames.axes[0], i).cross(vector::<R>(&self.targets.axes[0], i))
                + vector::<R>(&self.frames.axes[1], i).cross(vector::<R>(&self.targets.axes[1], i))
                + vector::<R>(&self.frames.axes[2], i).cross(vector::<R>(&self.targets.axes[2], i));
            let opposite =
                vector::<R>(&self.frames.axes[0], i).dot(vector::<R>(&self.targets.axes[0], i)) < zero;
            let turned = R::of(0.25) * sine.dot(sine);
            let there = (away.dot(away) < least) & (turned < least) & !opposite;
            self.missed[i] = R::either(there, zero, one).store();
        }
    }
}
