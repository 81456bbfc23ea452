//! Base height, flange rotation and unit of length from the readings, with given joints.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::{Change, Comparison, PoseDifference};
use crate::frame::Isometry;

const MM_PER_INCH: f64 = 25.4;

/// The frames that may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Free {
    /// Position of the base.
    pub base: FreeBase,
    /// Rotation of the flange.
    pub flange: bool,
    /// Whether lengths are in inches.
    pub inches: bool,
}

/// Permitted difference of the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreeBase {
    /// Not at all.
    #[default]
    Fixed,
    /// In height.
    Height,
    /// Anywhere.
    Shift,
}

impl Free {
    /// Every combination of complexity `count`.
    pub fn counting(count: usize) -> Vec<Free> {
        let mut found = Vec::new();
        for (base, of_base) in [(FreeBase::Fixed, 0), (FreeBase::Height, 1), (FreeBase::Shift, 2)] {
            for flange in [false, true] {
                for inches in [false, true] {
                    if of_base + usize::from(flange) + usize::from(inches) == count {
                        found.push(Free { base, flange, inches });
                    }
                }
            }
        }
        found
    }
}

/// The changes of these frames that fit best, and how far the readings then are from `flanges` (file's flange in
/// base, one per reading); `None` where no quarter turn of the flange fits, or a change would have no effect.
pub fn fit(
    comparison: &Comparison<'_>,
    flanges: &[Isometry],
    free: Free,
) -> Option<(Vec<Change>, PoseDifference)> {
    let read: Vec<Isometry> = comparison
        .readings
        .iter()
        .map(|reading| {
            let mut pose = reading.reference_from_tool;
            if free.inches {
                pose.translation.vector *= MM_PER_INCH;
            }
            comparison.base_from_reference * pose
        })
        .collect();
    let mut changes = Vec::new();
    let mut flange_from_tool = *comparison.flange_from_tool;
    if free.flange {
        let turned = flanges.first()?.rotation.inverse()
            * read.first()?.rotation
            * comparison.flange_from_tool.rotation.inverse();
        let turn = nearest_quarter_turns(&turned)?;
        // A turn about the flange's own z is a zero of the last joint, and reported as that.
        if turn.angle() < comparison.within.radians || (turn * Vector3::z() - Vector3::z()).norm() < 1e-9 {
            return None;
        }
        changes.push(Change::FlangeTurn { turn });
        flange_from_tool = Isometry::from_parts(Vector3::zeros().into(), turn) * flange_from_tool;
    }
    let predicted: Vec<Isometry> = flanges.iter().map(|flange| flange * flange_from_tool).collect();
    let pairs = || predicted.iter().zip(&read);
    let missing: Vector3<f64> = pairs()
        .map(|(predicted, read)| predicted.translation.vector - read.translation.vector)
        .sum::<Vector3<f64>>()
        / read.len() as f64;
    let shift = match free.base {
        FreeBase::Fixed => Vector3::zeros(),
        FreeBase::Height => Vector3::new(0.0, 0.0, missing.z),
        FreeBase::Shift => missing,
    };
    if free.base != FreeBase::Fixed {
        if shift.norm() <= comparison.within.metres {
            return None;
        }
        changes.push(match free.base {
            FreeBase::Height => Change::BaseHeight { by: shift.z },
            _ => Change::BaseShift { by: shift },
        });
    }
    if free.inches {
        changes.push(Change::Inches);
    }
    let apart = pairs().map(|(predicted, read)| {
        let moved = Isometry::from_parts((read.translation.vector + shift).into(), read.rotation);
        PoseDifference::between(predicted, &moved)
    });
    Some((
        changes,
        apart.fold(PoseDifference::default(), PoseDifference::or_worse),
    ))
}

/// The rotation onto the axes themselves that is nearest to `turn`; `None` more than 20 deg away from any.
fn nearest_quarter_turns(turn: &UnitQuaternion<f64>) -> Option<UnitQuaternion<f64>> {
    let rounded: Matrix3<f64> = turn.to_rotation_matrix().matrix().map(f64::round);
    let is_rotation =
        (rounded.transpose() * rounded - Matrix3::identity()).norm() < 1e-9 && rounded.determinant() > 0.5;
    let nearest = is_rotation
        .then(|| UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rounded)))?;
    (nearest.angle_to(turn) < 20_f64.to_radians()).then_some(nearest)
}
