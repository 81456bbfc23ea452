//! The evaluation of a cut: lobes and limits by the core.

use armill_core::stability::named_mode::modes;
use armill_core::stability::{
    Boundary, BoundaryUncertainty, CutOfAnyDepth, Floquet, Forced, Instability, Lobe, PeriodSteps,
    StabilityLobes, SurfaceError, WallSide, discretisation,
};

use super::question::{Question, of_cut};
use crate::StudyError;

/// What was found; SI.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Zeroth-order boundary over the spindle speed.
    pub lobes: Vec<Lobe>,
    /// The same at the programmed speed, with its uncertainty.
    pub zeroth: Option<BoundaryUncertainty>,
    /// The boundary at the programmed speed by semi-discretisation.
    pub boundary: Option<(Boundary, Instability)>,
    /// Multiplier of the programmed cut.
    pub programmed: Floquet,
    /// Lowest boundary over all speeds.
    pub critical: Option<Boundary>,
    /// Boundary without regeneration.
    pub mode_coupling: Option<Boundary>,
    /// The vibration under the teeth.
    pub forced: Forced,
    /// Error of the walls that the cut leaves.
    pub walls: Vec<SurfaceError>,
}

/// Spindle speeds of the lobes.
const SPEEDS: usize = 500;

/// Evaluates the cut.
///
/// # Errors
/// A depth, sought or programmed, that the cutter cannot cut.
pub fn evaluate(question: &Question) -> Result<Evaluation, StudyError> {
    let cut = CutOfAnyDepth::new(&question.milling);
    let bare = modes(&question.modes);
    let (spindle, deepest) = (question.spindle, question.deepest);
    let lobes = StabilityLobes::new(&bare, &cut, deepest).map_err(of_cut)?;
    let [low, high] = question.speeds;
    let speeds: Vec<f64> = (0..SPEEDS)
        .map(|k| low + (high - low) * k as f64 / (SPEEDS - 1) as f64)
        .collect();
    let forced = Forced::new(&bare, &question.milling, spindle).map_err(of_cut)?;
    Ok(Evaluation {
        lobes: lobes.at_speeds(&speeds),
        zeroth: BoundaryUncertainty::at_speed(&question.modes, &cut, spindle, deepest).map_err(of_cut)?,
        boundary: discretisation::boundary(&bare, &cut, spindle, deepest).map_err(of_cut)?,
        programmed: discretisation::floquet(&bare, &question.milling, spindle, PeriodSteps::ByFastestMode),
        critical: lobes.critical(),
        mode_coupling: lobes.mode_coupling(),
        walls: WallSide::of(&question.milling)
            .map(|side| forced.surface_error(side))
            .collect(),
        forced,
    })
}
