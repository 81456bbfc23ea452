//! The answer to a study as one JSON value: the same bytes in the command line, Python and the page.
//!
//! `maps[]` with `name, branch, fraction_within, max_in_plane_um, counts` and `paths[]` with `name, branch,
//! max_in_plane_um, roundness_um` are a public contract.
//!
//! Every key names its unit, and `_u_` in it a standard uncertainty. Positions are relative to the frame
//! `setting.base`, deviations are in base axes or in the components that their keys name. Values that are not available
//! are `null`.
//!
//! ```text
//! robot         joints with their compliance
//! maps[]        setting, counts, region, certainty, worst and best point, grid of all points
//! paths[]       setting, worst_points, features, cut or measured, limits, program, joint ranges
//! volumes[]     setting, counts, worst and best point
//! holes[]       setting, counts, worst_holes, each hole
//! measured      measurements of a circle: contributions, sums, part, waves
//! statements[]  published statements, with a reading for each map or path they may refer to
//! warnings[]    what to know before relying on it; sources[]: where its numbers come from
//! ```
//!
//! The parts are those of the kinds of [`crate::analysis`], which `by_kind` collects; `statement` and `sentence`
//! interpret them; `check` is the answer to the check of a study, `limit_warnings` warns of disputed limits.

mod by_kind;
mod check;
mod limit_warnings;
mod sentence;
mod statement;

pub use check::CheckAnswer;
pub use statement::{Reading, StatementAnswer};

pub use crate::analysis::holes::answer::{HoleAnswer, HolesAnswer, WorstHole};
pub use crate::analysis::map::answer::{CountsAnswer, GridAnswer, MapAnswer, RegionAnswer};
pub use crate::analysis::path::answer::{
    CutAnswer, FeatureAnswer, LimitAnswer, LimitsAnswer, MeasuredAnswer, OperationAnswer, PathAnswer,
    ProgramAnswer, RestAnswer, SearchAnswer, StatisticsAnswer, StockAnswer, WorstPoint,
};
pub use crate::analysis::point::{PointAnswer, SettingAnswer};
pub use crate::analysis::volume::answer::VolumeAnswer;

use armill_core::load::CuttingLaw;
use armill_core::robot::BacklashSide;
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis;
use crate::analysis::path::{Cut, PathAnalysis};
use crate::analysis::vibration::VibrationAnswer;
use crate::analysis::{AnalysisResult, Subject};
use crate::answer::by_kind::AnalysisAnswers;
use crate::budget::{self, BudgetAnswer};
use crate::file::resolve::Study;
use crate::file::slips;
use crate::input::setting::Setting;
use crate::joint_order::joint_order;
use crate::joint_unit::JointUnit;
use crate::model_words::left_out;
use crate::uncertainty_words;

/// The whole answer.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StudyAnswer {
    /// Version of this format.
    pub format: u32,
    /// Version of armill that produced it.
    pub armill: &'static str,
    /// Title of the study.
    pub title: String,
    /// The question in words.
    pub question: Option<String>,
    /// The answer in one sentence.
    pub answer: String,
    /// The robot and the compliance of its joints.
    pub robot: RobotAnswer,
    /// Every plane, sections included.
    pub maps: Vec<MapAnswer>,
    /// Every path.
    pub paths: Vec<PathAnswer>,
    /// Every box.
    pub volumes: Vec<VolumeAnswer>,
    /// Every set of holes.
    pub holes: Vec<HolesAnswer>,
    /// Published statements, compared with these results.
    pub statements: Vec<StatementAnswer>,
    /// The measurement of a circle, compared with its prediction; none without a measurement.
    pub measured: Option<BudgetAnswer>,
    /// What a user should know before relying on it.
    pub warnings: Vec<String>,
    /// Sources of the numbers.
    pub sources: Vec<Source>,
}

/// The robot and the compliance of its joints.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RobotAnswer {
    /// Name in the library, or of the file.
    pub name: String,
    /// Maker and type.
    pub title: String,
    /// Whether its joint compliances are assumed by the study, not measured.
    pub compliance_assumed: bool,
    /// Its joints, base to flange.
    pub joints: Vec<JointAnswer>,
}

/// The compliance of a joint.
///
/// Of the two pairs of compliance and uncertainty, the one of the joint's kind has numbers, the other is `null`; both
/// are `null` if nothing is known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JointAnswer {
    /// Its name.
    pub name: String,
    /// Compliance of a revolute joint.
    pub compliance_rad_per_n_m: Option<f64>,
    /// Its standard uncertainty; none where it is not known.
    pub compliance_u_rad_per_n_m: Option<f64>,
    /// Compliance of a prismatic joint.
    pub compliance_um_per_n: Option<f64>,
    /// Its standard uncertainty; none where it is not known.
    pub compliance_u_um_per_n: Option<f64>,
    /// Source of the compliance.
    pub compliance_source: String,
}

/// The answer to `study` from its results.
///
/// `done` is the result of `run` for this study, in the order of its analyses; the answer has that order on any number
/// of threads.
pub fn answer(study: &Study, done: &[AnalysisResult<'_>]) -> StudyAnswer {
    let answers = AnalysisAnswers::of(study, done);
    let (measured, unmeasured) = match budget::of_results(study, done) {
        Some(Ok((_, given))) => (Some(given), None),
        Some(Err(reason)) => (None, Some(format!("The measurement is not compared: {reason}."))),
        None => (None, None),
    };
    let mut warnings = warnings(study, done, &answers);
    let of_measured = measured.iter().flat_map(|given| &given.warnings);
    warnings.extend(of_measured.map(|warning| format!("Measured: {warning}.")));
    warnings.extend(unmeasured);
    StudyAnswer {
        format: 1,
        armill: env!("CARGO_PKG_VERSION"),
        title: study.title.clone(),
        question: study.question.clone(),
        answer: sentence::answer(study, &answers),
        robot: robot_answer(study),
        statements: statement::answers(study, &answers.maps, &answers.paths),
        measured,
        warnings,
        maps: answers.maps,
        paths: answers.paths,
        volumes: answers.volumes,
        holes: answers.holes,
        sources: sources(study),
    }
}

/// The robot of the study: with the compliances of the study and their source, if it gives some.
fn robot_answer(study: &Study) -> RobotAnswer {
    let robot = &study.robot.robot;
    let own = study.own_compliance.as_ref().map(|own| own.source.clone());
    let joint = |i: usize, joint: &armill_core::robot::Joint| {
        let compliance = robot.compliance().map(|c| c[i]);
        let (slides, scale) = (robot.slides(i), JointUnit::SLIDING.compliance_scale);
        let (turning, sliding) = (compliance.filter(|_| !slides), compliance.filter(|_| slides));
        JointAnswer {
            name: joint.name.clone(),
            compliance_rad_per_n_m: turning.map(|c| c.value),
            compliance_u_rad_per_n_m: turning.and_then(|c| c.known_uncertainty()),
            compliance_um_per_n: sliding.map(|c| c.value * scale),
            compliance_u_um_per_n: sliding.and_then(|c| Some(c.known_uncertainty()? * scale)),
            compliance_source: own
                .clone()
                .or_else(|| study.robot.joint_notes[i].compliance_source.clone())
                .unwrap_or_default(),
        }
    };
    RobotAnswer {
        name: robot.name().to_owned(),
        title: study.robot.title.clone(),
        compliance_assumed: study.compliance_is_assumed(),
        joints: joint_order(robot)
            .into_iter()
            .map(|i| joint(i, &robot.joints()[i]))
            .collect(),
    }
}

/// Sources of the coefficients that the forces of a cut are computed with; each key is the material's, behind
/// `material:`.
pub(crate) fn sources_of_cut(cut: &Cut) -> Vec<Source> {
    material_sources(match cut.cutting.law {
        CuttingLaw::Mechanistic(_) => cut.material.mechanistic_sources(),
        CuttingLaw::Kienzle(_) => cut.material.kienzle_sources(),
    })
}

/// These sources of a material, their keys kept apart from those of the robot.
fn material_sources(sources: Vec<&Source>) -> Vec<Source> {
    let of_material = |source: &Source| Source {
        key: format!("material:{}", source.key),
        ..source.clone()
    };
    sources.into_iter().map(of_material).collect()
}

/// Sources of the numbers of the study: of the robot and its compliances, then of loads and tools, then
/// materials of cuts and drills, each of these once.
fn sources(study: &Study) -> Vec<Source> {
    let own = |key: &str, place: &str| Source {
        key: key.to_owned(),
        what: format!("{key} of the study"),
        place: place.to_owned(),
        licence: "the user's".to_owned(),
    };
    let mut sources = study.robot.sources.clone();
    sources.extend(
        study
            .own_compliance
            .iter()
            .map(|of_study| own("compliance", &of_study.source)),
    );
    for setting in study.settings() {
        let of_load = setting.load_source.iter().map(|source| own("load", source));
        let of_tool = setting.tool_sources.iter().map(|source| own("tool", source));
        for source in of_load.chain(of_tool) {
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
    }
    let cuts = study
        .analyses
        .iter()
        .filter_map(|analysis| match &analysis.subject {
            Subject::Path(path) => Some(&**path),
            Subject::Holes(holes) => Some(&holes.path),
            _ => None,
        });
    let of_path = |path: &PathAnalysis| {
        let cut = path.cut.as_ref().map(sources_of_cut);
        let drill = || {
            path.drill
                .as_ref()
                .map(|drill| material_sources(drill.material.kienzle_sources()))
        };
        cut.or_else(drill).unwrap_or_default()
    };
    for source in cuts.flat_map(of_path) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    sources
}

/// What a user should know before relying on the answer, from the robot to its points: assumed compliances, limits that
/// sources disagree about where the results depend on them, what is out of reach or outside joint limits, a record with an uncertain start, masses
/// without gravity, the note of the robot file.
fn warnings(study: &Study, done: &[AnalysisResult<'_>], answers: &AnalysisAnswers) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(study.own_compliance.iter().filter_map(|own| own.caution.clone()));
    warnings.extend(slips::of_study(study));
    for setting in study.settings() {
        let unknown = uncertainty_words::warning(&setting.arm(&study.robot.robot));
        warnings.extend(unknown.filter(|warning| !warnings.contains(warning)));
    }
    warnings.extend(limit_warnings::warnings(study, done, answers));
    for map in &answers.maps {
        if map.counts.within + map.counts.above_tolerance + map.counts.in_collision == 0 {
            warnings.push(format!(
                "{}: no point on the plane has a posture; check that its coordinates are in mm and relative to {}.",
                map.name, map.setting.base
            ));
            continue;
        }
        warnings.extend(lost_points(&map.name, &map.counts));
        if map.outside_joint_limits > 0 {
            warnings.push(format!(
                "{}: {} of {} points are outside joint limits in the branch {}; `fraction_within` includes them, headline and region do not.",
                map.name, map.outside_joint_limits, map.grid.points, map.branch
            ));
        }
    }
    for volume in &answers.volumes {
        match volume.worst {
            None if volume.counts.in_collision == 0 => warnings.push(format!(
                "{}: no point of the box has a posture; check that its coordinates are in mm and relative to {}.",
                volume.name, volume.setting.base
            )),
            _ => warnings.extend(lost_points(&volume.name, &volume.counts)),
        }
    }
    warnings.extend(answers.paths.iter().flat_map(analysis::path::warnings::warnings));
    warnings.extend(answers.holes.iter().flat_map(analysis::holes::warnings::warnings));
    let of_maps = answers.maps.iter().map(|map| (&map.name, &map.vibration));
    let of_volumes = answers
        .volumes
        .iter()
        .map(|volume| (&volume.name, &volume.vibration));
    let of_paths = answers.paths.iter().map(|path| (&path.name, &path.vibration));
    for (name, vibration) in of_maps.chain(of_volumes).chain(of_paths) {
        warnings.extend(vibration.as_ref().and_then(|vibration| vibration.warning(name)));
    }
    for analysis in &study.analyses {
        if let Subject::Path(path) = &analysis.subject {
            let uncertain = path.measured.as_ref().and_then(|measured| measured.warning());
            warnings.extend(uncertain.map(|warning| format!("{}: {warning}.", analysis.name)));
        }
    }
    warnings.extend(study.settings().find_map(|setting| left_out(&setting.model)));
    let off_paths = study
        .analyses
        .iter()
        .any(|analysis| !matches!(analysis.subject, Subject::Path(_)));
    let has_backlash = |setting: &Setting| {
        setting
            .model
            .structure
            .joints_with_backlash()
            .any(|(_, gap)| gap.side == BacklashSide::Motion)
    };
    if off_paths && study.settings().any(has_backlash) {
        warnings.push(
            "Outside tool paths the side of the backlash is unknown: maps, sections, volumes and holes report the worst case."
                .to_owned(),
        );
    }
    warnings.extend(study.robot.note.clone());
    warnings.extend(study.cell_notes.iter().cloned());
    warnings
}

/// That some points of a map or box have no result, with their number for each reason.
fn lost_points(name: &str, counts: &CountsAnswer) -> Option<String> {
    let reasons = [
        (counts.out_of_reach, "out of reach"),
        (
            counts.no_posture_inside_limits,
            "without a posture inside the joint limits",
        ),
        (counts.not_found, "where the search found no posture"),
        (counts.unverified, "where the inverse kinematics failed its check"),
        (counts.unstable, "without a stable equilibrium under the load"),
        (
            counts.in_collision,
            "where no posture keeps the demanded clearance",
        ),
    ];
    let each = reasons.iter().filter(|(count, _)| *count > 0);
    let each: Vec<String> = each.map(|(count, reason)| format!("{count} {reason}")).collect();
    (!each.is_empty()).then(|| {
        format!(
            "{name}: {} of {} points have no result and are not within the tolerance: {}.",
            counts.unreached(),
            counts.total(),
            each.join(", ")
        )
    })
}

impl StudyAnswer {
    /// Whether every point of every map, path, box and set of holes is within the tolerance.
    ///
    /// A point that is not reached, or only outside joint limits, is not. A cut that must be stable is.
    pub fn meets_tolerance(&self) -> bool {
        let maps = self
            .maps
            .iter()
            .map(|map| map.fraction_within_and_inside_joint_limits);
        let whole = |path: &PathAnswer| match path.outside_joint_limits {
            0 => path.fraction_within,
            _ => 0.0,
        };
        let paths = self.paths.iter().map(whole);
        let volumes = self
            .volumes
            .iter()
            .map(|volume| volume.fraction_within_and_inside_joint_limits);
        let holes = self.holes.iter().map(|holes| holes.fraction_within);
        maps.chain(paths)
            .chain(volumes)
            .chain(holes)
            .all(|fraction| fraction == 1.0)
            && self.is_stable_as_demanded()
    }

    /// Whether every cut that must be stable is.
    fn is_stable_as_demanded(&self) -> bool {
        self.vibrations()
            .iter()
            .all(|(_, vibration)| vibration.meets_demand())
    }

    /// The vibration of each analysis that has it, by name.
    pub fn vibrations(&self) -> Vec<(&str, &VibrationAnswer)> {
        let maps = self.maps.iter().map(|map| (map.name.as_str(), &map.vibration));
        let volumes = self
            .volumes
            .iter()
            .map(|volume| (volume.name.as_str(), &volume.vibration));
        let paths = self
            .paths
            .iter()
            .map(|path| (path.name.as_str(), &path.vibration));
        let all = maps.chain(volumes).chain(paths);
        all.filter_map(|(name, vibration)| Some((name, vibration.as_ref()?)))
            .collect()
    }
}
