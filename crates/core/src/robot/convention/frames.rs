//! Base height, turn of the flange and unit of length from the readings, with the joints taken for granted.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::{Apart, Change, Comparison};
use crate::frame::Isometry;

const MM_PER_INCH: f64 = 25.4;

/// Which of the frames may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Free {
    /// Where the base lies.
    pub base: FreeBase,
    /// How the flange is turned.
    pub flange: bool,
    /// Whether lengths are in inches.
    pub inches: bool,
}

/// How the base may differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreeBase {
    /// Not at all.
    #[default]
    Held,
    /// In height.
    Height,
    /// Anywhere.
    Shift,
}

impl Free {
    /// Every combination that counts `count`.
    pub fn counting(count: usize) -> Vec<Free> {
        let mut found = Vec::new();
        for (base, of_base) in [(FreeBase::Held, 0), (FreeBase::Height, 1), (FreeBase::Shift, 2)] {
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

/// The changes of these frames that fit best, and how far the readings then lie from `flanges` (file's flange in
/// base, one a reading); `None` where no quarter turn of the flange fits, or a change would change nothing.
pub fn fit(comparison: &Comparison<'_>, flanges: &[Isometry], free: Free) -> Option<(Vec<Change>, Apart)> {
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
        // A turn about the flange's own z is a zero of the last joint: told as that.
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
        FreeBase::Held => Vector3::zeros(),
        FreeBase::Height => Vector3::new(0.0, 0.0, missing.z),
        FreeBase::Shift => missing,
    };
    if free.base != FreeBase::Held {
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
        Apart::between(predicted, &moved)
    });
    Some((changes, apart.fold(Apart::default(), Apart::or_worse)))
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
