//! The answer to a study as one JSON value: the same bytes whatever the surface.
//!
//! `maps[]` with `name, branch, fraction_within, max_in_plane_um, counts` and `paths[]` with `name, branch,
//! max_in_plane_um, roundness_um` are a public contract.
//!
//! A file for each part: `map`, `volume`, `path`, `program` with `limits` and `measured`, `point`; `statement`, `cautions` and
//! `sentence` say what they mean.

mod cautions;
pub(crate) mod limits;
mod map;
mod measured;
mod path;
mod point;
mod program;
mod sentence;
mod statement;
mod volume;

pub use limits::{LimitResult, LimitsResult, RestResult, StockResult};
pub use map::{CountsAnswer, GridAnswer, MapAnswer, RegionAnswer};
pub use measured::MeasuredResult;
pub use path::PathResult;
pub use point::{PointAnswer, SettingAnswer};
pub use program::{FeatureResult, OperationResult, ProgramResult, WorstPoint};
pub use statement::{Reading, StatementAnswer};
pub use volume::VolumeAnswer;

use armill_core::load::CuttingLaw;
use armill_core::map::PlaneMap;
use armill_formats::robot::Source;
use rayon::prelude::*;
use serde::Serialize;

use crate::file::cut::Cut;
use crate::file::program::ProgramAsk;
use crate::file::resolve::{Ask, Sheet, Study, Subject};
use crate::parts::left_out;
use crate::run::Found;

/// The whole answer.
#[derive(Clone, Debug, Serialize)]
pub struct StudyAnswer {
    /// Version of this format.
    pub format: u32,
    /// Version of armill that gave it.
    pub armill: &'static str,
    /// Title of the study.
    pub title: String,
    /// The question in words.
    pub question: Option<String>,
    /// The answer in one sentence.
    pub answer: String,
    /// The robot and what its joints yield.
    pub robot: RobotAnswer,
    /// Every plane, sections included.
    pub maps: Vec<MapAnswer>,
    /// Every path.
    pub paths: Vec<PathResult>,
    /// Every box.
    pub volumes: Vec<VolumeAnswer>,
    /// What others state, beside what was found here.
    pub statements: Vec<StatementAnswer>,
    /// What a user should know before trusting it.
    pub warnings: Vec<String>,
    /// Where the numbers come from.
    pub sources: Vec<Source>,
}

/// The robot and what its joints yield.
#[derive(Clone, Debug, Serialize)]
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

/// What a joint yields.
#[derive(Clone, Debug, Serialize)]
pub struct JointAnswer {
    /// Its name.
    pub name: String,
    /// Compliance.
    pub compliance_rad_per_n_m: f64,
    /// Its standard uncertainty.
    pub compliance_u_rad_per_n_m: f64,
    /// Where the compliance comes from.
    pub compliance_source: String,
}

/// The answer to one ask.
enum Told {
    Maps(Vec<MapAnswer>),
    Path(Box<PathResult>),
    Volume(Box<VolumeAnswer>),
}

/// The answer to `study` from what was found for each of its asks.
pub fn answer(study: &Study, found: &[Found]) -> StudyAnswer {
    let told = |(ask, found): (&Ask, &Found)| match (&ask.subject, found) {
        (Subject::Map(sheet), Found::Map(map)) => {
            Told::Maps(vec![map::answer(study, &ask.name, &sheet.setting, map)])
        }
        (Subject::Sections(sections), Found::Sections(found)) => {
            let section = |((label, sheet), map): (&(String, Sheet), &PlaneMap)| {
                map::answer(study, &format!("{}: {label}", ask.name), &sheet.setting, map)
            };
            Told::Maps(sections.par_iter().zip(found).map(section).collect())
        }
        (Subject::Volume(setting, _), Found::Volume(volume)) => {
            Told::Volume(Box::new(volume::answer(study, &ask.name, setting, volume)))
        }
        (Subject::Path(setting, ..), Found::Path(path)) => {
            Told::Path(Box::new(path::answer(study, &ask.name, setting, path)))
        }
        (Subject::Program(ask_of), Found::Program(found)) => {
            Told::Path(Box::new(program::answer(study, &ask.name, ask_of, found)))
        }
        _ => Told::Maps(Vec::new()),
    };
    let all: Vec<Told> = study.asks.par_iter().zip(found).map(told).collect();
    let (mut maps, mut paths, mut volumes) = (Vec::new(), Vec::new(), Vec::new());
    for told in all {
        match told {
            Told::Maps(told) => maps.extend(told),
            Told::Path(told) => paths.push(*told),
            Told::Volume(told) => volumes.push(*told),
        }
    }
    StudyAnswer {
        format: 1,
        armill: env!("CARGO_PKG_VERSION"),
        title: study.title.clone(),
        question: study.question.clone(),
        answer: sentence::answer(study, &maps, &paths),
        robot: robot_answer(study),
        statements: statement::answers(study, &maps, &paths),
        warnings: warnings(study, &maps, &paths),
        maps,
        paths,
        volumes,
        sources: sources(study),
    }
}

fn robot_answer(study: &Study) -> RobotAnswer {
    let robot = &study.robot.robot;
    let own = study.own_compliance.as_ref().map(|own| own.source.clone());
    let joint = |i: usize, joint: &armill_core::robot::Joint| {
        let compliance = robot.compliance().map(|c| c[i]);
        JointAnswer {
            name: joint.name.clone(),
            compliance_rad_per_n_m: compliance.map_or(0.0, |c| c.value),
            compliance_u_rad_per_n_m: compliance.map_or(0.0, |c| c.standard_uncertainty),
            compliance_source: own
                .clone()
                .or_else(|| study.robot.joints[i].compliance_source.clone())
                .unwrap_or_default(),
        }
    };
    RobotAnswer {
        name: robot.name().to_owned(),
        title: study.robot.title.clone(),
        compliance_assumed: study.compliance_is_assumed(),
        joints: robot
            .joints()
            .iter()
            .enumerate()
            .map(|(i, j)| joint(i, j))
            .collect(),
    }
}

/// Sources of the coefficients that the forces of a cut are computed with; each key is the material's, behind `material:`.
pub(crate) fn sources_of_cut(cut: &Cut) -> Vec<Source> {
    told_by(match cut.cutting.law {
        CuttingLaw::Mechanistic(_) => cut.material.mechanistic_sources(),
        CuttingLaw::Kienzle(_) => cut.material.kienzle_sources(),
    })
}

fn told_by(sources: Vec<&Source>) -> Vec<Source> {
    let of_material = |source: &Source| Source {
        key: format!("material:{}", source.key),
        ..source.clone()
    };
    sources.into_iter().map(of_material).collect()
}

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
    sources.extend(study.load_source.iter().map(|source| own("load", source)));
    let cuts = study.asks.iter().filter_map(|ask| match &ask.subject {
        Subject::Program(program) => Some(program),
        _ => None,
    });
    let of_program = |program: &ProgramAsk| {
        let cut = program.cut.as_ref().map(sources_of_cut);
        let drill = || {
            program
                .drill
                .as_ref()
                .map(|drill| told_by(drill.material.kienzle_sources()))
        };
        cut.or_else(drill).unwrap_or_default()
    };
    for source in cuts.flat_map(|program| of_program(program)) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    sources
}

fn warnings(study: &Study, maps: &[MapAnswer], paths: &[PathResult]) -> Vec<String> {
    let mut warnings = Vec::new();
    warnings.extend(study.own_compliance.iter().filter_map(|own| own.caution.clone()));
    for (i, joint) in study.robot.joints.iter().enumerate() {
        for ([lower, upper], source, note) in &joint.other_limits {
            let name = &study.robot.robot.joints()[i].name;
            let note = note.as_ref().map_or(String::new(), |note| format!(" ({note})"));
            warnings.push(format!(
                "Limits of joint {name}: another source ({source}) says {lower} to {upper} deg{note}."
            ));
        }
    }
    for map in maps {
        if map.counts.within + map.counts.over_limit == 0 {
            warnings.push(format!(
                "{}: no point of the plane has a posture; are its coordinates in mm, and counted from {}?",
                map.name, map.setting.base
            ));
        } else if map.outside_joint_limits > 0 {
            warnings.push(format!(
                "{}: {} of {} points stand outside joint limits in the branch {}; they are counted as if they did not.",
                map.name, map.outside_joint_limits, map.grid.points, map.branch
            ));
        }
    }
    for path in paths.iter().filter(|path| path.outside_joint_limits > 0) {
        warnings.push(format!(
            "{}: {} of {} points stand outside joint limits in the branch {}.",
            path.name, path.outside_joint_limits, path.points, path.branch
        ));
    }
    warnings.extend(paths.iter().flat_map(cautions::of_program));
    for ask in &study.asks {
        if let Subject::Program(program) = &ask.subject {
            let unsure = program.measured.as_ref().and_then(|measured| measured.warning());
            warnings.extend(unsure.map(|warning| format!("{}: {warning}.", ask.name)));
        }
    }
    warnings.extend(study.settings().find_map(|setting| left_out(&setting.model)));
    warnings.extend(study.robot.note.clone());
    warnings
}

impl StudyAnswer {
    /// Whether every point of every map, path and box holds the limit.
    pub fn holds_everywhere(&self) -> bool {
        let maps = self.maps.iter().map(|map| map.fraction_within);
        let paths = self.paths.iter().map(|path| path.fraction_within);
        let volumes = self.volumes.iter().map(|volume| volume.fraction_within);
        maps.chain(paths).chain(volumes).all(|fraction| fraction == 1.0)
    }
}
