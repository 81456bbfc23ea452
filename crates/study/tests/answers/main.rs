//! Small studies through the library: results compared with each other, with counting, and with invariants.
//!
//! `around`: floor, pedestal, what rides on a rail; `cell`: clearances; `counts`: points and the tolerance; `same_points`: one point computed in two ways; `paths`: shapes; `spin_curves`: a spin that changes along a path; `freedoms`: lean and external axes of a search; `deviations`:
//! what changes them; `statements`: sentences, sources, warnings; `vibration`: modes and stability at points; `without_masses`: an arm whose links have none; `running`: reading, progress, files.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

mod around;
mod cell;
mod counts;
mod deviations;
mod freedoms;
mod motion;
mod paths;
mod running;
mod same_points;
mod spin_curves;
mod statements;
mod vibration;
#[path = "../shared/without_masses.rs"]
mod without_masses;

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::analysis::AnalysisResult;
use armill_study::answer::{MapAnswer, StudyAnswer, answer};
use armill_study::file::resolve::{Study, read};
use armill_study::run::run;

/// 9 x 9 points in front of an MH12; tables can be appended.
const PLATE: &str = r#"format = 1
title = "Plate"
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [900, 0, 800], tilt_deg = 0, half_size_mm = 200, step_mm = 50 }
load = { cases_n = [[3, -5, -5], [3, -5, 5], [3, 5, -5], [3, 5, 5]] }
"#;

/// Two ways of computing the same point: 1e-15 of a metre in the pose, times some 1e2 um/m of slope; in m.
const SAME: f64 = 1e-15;

/// The study in this text, which has no problem.
fn study(text: &str) -> Study {
    read("study.toml", Path::new("."), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// The plate with these analyses, or other tables of its file.
fn plate_with(analyses: &str) -> Study {
    study(&format!("{PLATE}{analyses}"))
}

/// The result of each analysis.
fn found(study: &Study) -> Vec<AnalysisResult<'_>> {
    run(study, Watch::NONE).unwrap_or_else(|error| panic!("{error}"))
}

/// The answer of a study.
fn answered(study: &Study) -> StudyAnswer {
    answer(study, &found(study))
}

/// The map or section of this name.
fn map<'a>(answer: &'a StudyAnswer, name: &str) -> &'a MapAnswer {
    answer
        .maps
        .iter()
        .find(|map| map.name == name)
        .unwrap_or_else(|| panic!("no map `{name}`"))
}
