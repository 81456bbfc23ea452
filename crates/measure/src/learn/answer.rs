//! The result of learning.

use armill_core::learn::HeldOut;
use armill_core::nalgebra::Vector3;
use armill_core::robot::{LearntAxes, Robot};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_study::number::decimals;
use serde::Serialize;

use super::learning::{Learning, Question};

/// Fewest components within the 95 % intervals, and most: otherwise the stated uncertainty is wrong.
const COVERAGE: std::ops::RangeInclusive<f64> = 0.90..=0.98;

/// What was learnt.
#[derive(Clone, Debug, Serialize)]
pub struct LearnAnswer {
    /// Name of the robot.
    pub robot: String,
    /// File of the poses.
    pub file: String,
    /// Number of poses.
    pub poses: usize,
    /// Number of stretches of the file, each held out once.
    pub stretches: usize,
    /// Errors of poses held out.
    pub held_out: ModelsAnswer,
    /// Errors of the poses of another file, base and point found from them.
    pub other: Option<OtherAnswer>,
    /// Whether the learnt residual reduces the error of poses held out by more than its uncertainty.
    pub is_significant: bool,
    /// Mean reduction of the squared error of poses held out, and its standard error.
    pub reduction_um2: [f64; 2],
    /// The process.
    pub residual: ResidualAnswer,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Notes on these numbers.
    pub notes: Vec<String>,
    /// Sources of the methods.
    pub sources: Vec<&'static str>,
}

/// Errors by three models.
#[derive(Clone, Debug, Serialize)]
pub struct ModelsAnswer {
    /// The chain of the robot file; base and tool found.
    pub nominal: LengthsAnswer,
    /// The calibrated chain.
    pub calibrated: LengthsAnswer,
    /// With the learnt residual in addition.
    pub learnt: LengthsAnswer,
    /// Components of the error within the 95 % interval of the learnt model.
    pub coverage_percent: f64,
}

/// Errors of another file.
#[derive(Clone, Debug, Serialize)]
pub struct OtherAnswer {
    /// The file.
    pub file: String,
    /// Number of its poses.
    pub poses: usize,
    /// Their errors.
    pub errors: ModelsAnswer,
}

/// Lengths of errors.
#[derive(Clone, Debug, Serialize)]
pub struct LengthsAnswer {
    /// Mean.
    pub mean_mm: f64,
    /// Root mean square.
    pub rms_mm: f64,
    /// 95 % of the poses are within.
    pub p95_mm: f64,
    /// Largest.
    pub max_mm: f64,
}

/// The learnt residual.
#[derive(Clone, Debug, Serialize)]
pub struct ResidualAnswer {
    /// Axes of its components: `base` or `first joint`.
    pub axes: &'static str,
    /// Standard deviation over all postures along each of these axes.
    pub deviation_um: [f64; 3],
    /// Scatter between neighbouring poses along each of these axes.
    pub scatter_um: [f64; 3],
    /// Length scale of each joint.
    pub length_scales: Vec<LengthScaleAnswer>,
}

/// The distance over which the residual changes with a joint.
#[derive(Clone, Debug, Serialize)]
pub struct LengthScaleAnswer {
    /// Name of the joint.
    pub joint: String,
    /// Of a revolute joint.
    pub length_scale_deg: Option<f64>,
    /// Of a prismatic joint.
    pub length_scale_mm: Option<f64>,
}

/// The numbers of what was learnt.
pub fn answer(robot: &Robot, learning: &Learning, question: &Question) -> LearnAnswer {
    let settings = learning.learnt.settings();
    let reduction = learning.held_out.reduction(question.stretches);
    let squared = |value: f64| decimals(to_um(to_um(value)), 1);
    let scale = |(joint, length): (usize, &f64)| LengthScaleAnswer {
        joint: robot.joints()[joint].name.clone(),
        length_scale_deg: (!robot.slides(joint)).then(|| decimals(to_deg(*length), 2)),
        length_scale_mm: robot.slides(joint).then(|| decimals(to_mm(*length), 1)),
    };
    let deviation = learning.learnt.deviation();
    let um = |of: Vector3<f64>| of.map(|value| decimals(to_um(value), 2)).into();
    LearnAnswer {
        robot: robot.name().to_owned(),
        file: learning.file.clone(),
        poses: learning.residuals.len(),
        stretches: question.stretches,
        held_out: models(&learning.held_out),
        other: learning.other.as_ref().map(|(file, errors)| OtherAnswer {
            file: file.clone(),
            poses: errors.learnt.len(),
            errors: models(errors),
        }),
        is_significant: reduction.is_significant(),
        reduction_um2: [squared(reduction.mean), squared(reduction.standard_error)],
        residual: ResidualAnswer {
            axes: match settings.axes {
                LearntAxes::Base => "base",
                LearntAxes::FirstJoint => "first joint",
            },
            deviation_um: um(deviation),
            scatter_um: um(deviation * settings.noise),
            length_scales: settings.lengths.iter().enumerate().map(scale).collect(),
        },
        unused: learning.unused.clone(),
        notes: notes(learning, reduction.is_significant()),
        sources: vec![
            "Rasmussen and Williams 2006: Gaussian Processes for Machine Learning",
            "theory: docs/theory/learnt-residual.md",
        ],
    }
}

fn notes(learning: &Learning, is_significant: bool) -> Vec<String> {
    let mut notes = vec![
        "held out: base, tool, chain and residual were found without the poses that are predicted".to_owned(),
        "the scatter contains the repeatability of the robot and the noise of the measurement".to_owned(),
        "far from the measured postures nothing is corrected, and the uncertainty is that of the calibrated robot".to_owned(),
        "rotations are not learnt: for a tool whose tip is far from the measured point, measure there (--tool-mm)".to_owned(),
    ];
    if !is_significant {
        notes.push(
            "the learnt residual does not reduce the error of poses held out beyond its uncertainty: use the calibration alone (armill calibrate)"
                .to_owned(),
        );
    }
    let sets = [
        Some(("poses held out", &learning.held_out)),
        learning
            .other
            .as_ref()
            .map(|(file, errors)| (file.as_str(), errors)),
    ];
    for (name, errors) in sets.into_iter().flatten() {
        if !COVERAGE.contains(&errors.coverage) {
            notes.push(format!(
                "{name}: {:.1} % of the errors are within the 95 % intervals: these poses are not like those learnt from, the stated uncertainty is not reliable there",
                100.0 * errors.coverage
            ));
        }
    }
    notes
}

fn models(errors: &HeldOut) -> ModelsAnswer {
    ModelsAnswer {
        nominal: lengths(&errors.nominal),
        calibrated: lengths(&errors.calibrated),
        learnt: lengths(&errors.learnt),
        coverage_percent: decimals(100.0 * errors.coverage, 1),
    }
}

fn lengths(errors: &[Vector3<f64>]) -> LengthsAnswer {
    let mut all: Vec<f64> = errors.iter().map(|error| to_mm(error.norm())).collect();
    all.sort_by(f64::total_cmp);
    let count = all.len().max(1) as f64;
    let place = (0.95 * count).ceil() as usize;
    let reported = |value: f64| decimals(value, 4);
    LengthsAnswer {
        mean_mm: reported(all.iter().sum::<f64>() / count),
        rms_mm: reported((all.iter().map(|length| length * length).sum::<f64>() / count).sqrt()),
        p95_mm: reported(all.get(place.saturating_sub(1)).copied().unwrap_or_default()),
        max_mm: reported(all.last().copied().unwrap_or_default()),
    }
}
