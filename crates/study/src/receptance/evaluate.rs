//! Receptance of nose and tip over the frequencies, and modes of the tip.
//!
//! ```text
//! feed frame: x = cos(a) x_nose + sin(a) y_nose      z = -z_nose: from part to spindle      y = z x x: to the left of the feed
//! ```
//!
//! `a` is the angle of the feed about the axis of the nose. Frequencies near the modes are added to those of the question, so that peaks are resolved.

use std::path::Path;

use armill_core::dynamics::coupling::{Frequencies, NotFinite, Swept, TipFit, sweep, tip_modes};
use armill_core::dynamics::{Mode, modal_fit::FitError};
use armill_core::nalgebra::{Complex, Matrix3, Matrix6, Rotation3};
use armill_formats::input;
use armill_formats::tool_assembly::{self, ToolAssembly};

use super::machine::Machine;
use crate::StudyError;

/// Additional frequencies around a mode, in half widths of its peak.
const AROUND: [f64; 11] = [-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0];

/// What is evaluated; SI.
#[derive(Clone, Debug)]
pub struct Question {
    /// What the assembly is attached to.
    pub machine: Machine,
    /// Holder and cutter.
    pub assembly: ToolAssembly,
    /// Frequencies.
    pub frequencies: Frequencies,
    /// From the axes of the nose to those of the feed.
    pub feed_from_nose: Rotation3<f64>,
}

/// Receptance and modes; feed frame, SI.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// At rest.
    pub at_rest: Matrix6<Complex<f64>>,
    /// At each frequency, rising.
    pub swept: Vec<Swept>,
    /// Modes of the tip, or why there are none.
    pub fit: Result<TipFit, FitError>,
}

/// From the axes of the nose to those of a feed at the angle `a` (rad) about the axis of the nose.
pub fn feed_from_nose(a: f64) -> Rotation3<f64> {
    let (sin, cos) = a.sin_cos();
    Rotation3::from_matrix_unchecked(Matrix3::new(cos, sin, 0.0, sin, -cos, 0.0, 0.0, 0.0, -1.0))
}

/// The tool assembly of this file.
///
/// # Errors
/// A file that cannot be read, or all its problems.
pub fn assembly_of(path: &Path) -> Result<ToolAssembly, StudyError> {
    let shown = path.display().to_string();
    let text = input::read_text(path).map_err(|error| {
        StudyError::value(
            format!("{shown}: {error}"),
            "give a file of a tool assembly, see docs/guide/receptance.md",
        )
    })?;
    Ok(tool_assembly::read(&shown, &text)?)
}

/// Evaluates the receptance of nose and tip, and the modes of the tip.
///
/// # Errors
/// An undamped resonance at exactly one of the frequencies.
pub fn evaluate(question: &Question) -> Result<Evaluation, StudyError> {
    let turned = |m: &Matrix6<Complex<f64>>| in_axes(m, &question.feed_from_nose);
    let at = |frequencies: &[f64]| -> Result<Vec<Swept>, StudyError> {
        let machine = |w: f64| question.machine.receptance(w);
        let assembly = &question.assembly;
        let found = sweep(
            machine,
            assembly.spindle.as_ref(),
            &assembly.segments,
            frequencies,
        );
        let found = found.map_err(|error: NotFinite| {
            let hint =
                "give loss factors above 0, or other frequencies: an undamped resonance has no receptance";
            StudyError::value(error.to_string(), hint)
        })?;
        let swept = found.into_iter().map(|own| Swept {
            w: own.w,
            base: turned(&own.base),
            tip: turned(&own.tip),
        });
        Ok(swept.collect())
    };
    let mut frequencies = question.frequencies.all();
    let mut swept = at(&frequencies)?;
    let mut fit = tip_modes(&swept, None);
    if let Ok(found) = &fit {
        frequencies.extend(around(&found.modes, &question.frequencies));
        frequencies.sort_by(f64::total_cmp);
        frequencies.dedup();
        swept = at(&frequencies)?;
        fit = tip_modes(&swept, None);
    }
    let at_rest = at(&[0.0])?;
    Ok(Evaluation {
        at_rest: at_rest.first().map_or_else(Matrix6::zeros, |own| own.tip),
        swept,
        fit,
    })
}

/// Frequencies around the modes within the range, rad/s.
fn around(modes: &[Mode], within: &Frequencies) -> Vec<f64> {
    let all = modes
        .iter()
        .flat_map(|mode| AROUND.map(|widths| mode.angular_frequency * (1.0 + widths * mode.damping_ratio)));
    all.filter(|w| (within.low..=within.high).contains(w)).collect()
}

/// A receptance in other axes.
fn in_axes(m: &Matrix6<Complex<f64>>, turn: &Rotation3<f64>) -> Matrix6<Complex<f64>> {
    let turn = turn.matrix().map(|part| Complex::new(part, 0.0));
    let mut all = Matrix6::zeros();
    for (row, column) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
        let block = turn * m.fixed_view::<3, 3>(row, column) * turn.transpose();
        all.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use armill_core::nalgebra::Vector3;

    #[test]
    fn the_feed_frame_is_right_handed_with_z_towards_the_spindle() {
        for a in [0.0, 0.7, -2.0] {
            let turn = feed_from_nose(a);
            assert!((turn.matrix().determinant() - 1.0).abs() < 1e-14);
            assert!((turn * Vector3::z() + Vector3::z()).norm() < 1e-15);
            let feed = turn * Vector3::new(a.cos(), a.sin(), 0.0);
            assert!((feed - Vector3::x()).norm() < 1e-14);
        }
    }
}
