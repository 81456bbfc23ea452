//! `armill compensate`: compensated paths, commanded so that the tool follows the nominal path.
//!
//! `--out` (`compensated` next to the study) receives one table and one picture per path; stdout one line each, before
//! and after. `--program` writes the path as a robot program, in the language of its extension.

use std::fmt::Write as _;

use armill_core::optimize::Compensation;
use armill_core::source::StiffnessModel;
use armill_plan::compensate::in_place::allow_programs;
use armill_plan::compensate::{CompensatedPath, CompensationAnswer, compensate};
use armill_study::program_out::{HolesToWrite, PathToWrite, hole_program, program};
use armill_study::{StudyError, studies};

use super::program::{requested, save};
use crate::arguments::CompensateArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Compensates and writes the results.
///
/// # Errors
/// No such study, or its problems; no such path; a folder that cannot be written.
pub(crate) fn run(arguments: &CompensateArguments) -> Result<Outcome, StudyError> {
    let found = studies::find(&arguments.study)?;
    let study = found.read()?;
    let requested = requested(&arguments.program, arguments.feed_mm_per_min)?;
    let writer = arguments.writing.writer("compensate");
    let folder = match &arguments.out {
        Some(out) => writer.folder(out)?,
        None => writer.folder_in(&found.folder, "compensated")?,
    };
    let out = folder.path().to_owned();
    allow_programs(&study, arguments.analysis.as_deref(), &folder)?;
    let progress = Progress::new(armill_plan::compensate::point_count(
        &study,
        arguments.analysis.as_deref(),
    ));
    let compensation = match arguments.nominal {
        true => Compensation::NONE,
        false => Compensation::USUAL,
    };
    let name = arguments.analysis.as_deref();
    let commanded = progress.watch(|watch| compensate(&study, name, compensation, watch))?;
    let mut files: Vec<(String, &[u8])> = Vec::new();
    for one in &commanded {
        files.push((one.given.file.clone(), &one.csv));
        if let Some(svg) = one.picture.as_ref().filter(|_| one.given.rounds > 0) {
            let picture = one.given.file.replace(".commanded.csv", "-compensated.svg");
            files.push((picture, svg.as_bytes()));
        }
        files.extend(one.program.iter().map(|(name, bytes)| (name.clone(), &bytes[..])));
    }
    folder.allow(files.iter().map(|(name, _)| name.as_str()))?;
    for (name, bytes) in files {
        folder.write(&name, bytes)?;
    }
    folder.finish()?;
    drop(folder);
    if let Some((folder, requested)) = &requested {
        let [one] = &commanded[..] else {
            let message = format!(
                "--program: the study has {} paths and sets of holes, a program contains one",
                commanded.len()
            );
            return Err(StudyError::value(message, "select one: --analysis NAME"));
        };
        let (track, answers) = (&one.path.0, &one.path.1);
        let written = match one.holes {
            Some(holes) => hole_program(
                &study,
                HolesToWrite {
                    holes,
                    track,
                    answers,
                    refused: &one.refused,
                },
                requested,
            )?,
            None => program(
                &study,
                PathToWrite {
                    setting: one.setting,
                    track,
                    answers,
                    top: one.top,
                    spindle: one.spindle,
                },
                requested,
            )?,
        };
        save(&writer, folder, &written)?;
    }
    let any = |known: fn(&StiffnessModel) -> bool| commanded.iter().any(|one| known(&one.setting.model));
    let answer = CompensationAnswer {
        backlash: any(|model| model.structure.joints_with_backlash().next().is_some()),
        geometry: any(|model| model.actual.is_some()),
        paths: commanded.into_iter().map(|one| one.given).collect(),
        compliance_assumed: study.compliance_is_assumed(),
    };
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    say(&format!("commanded paths in {}", out.display()));
    Ok(Outcome::Fine)
}

/// Result for a path from a robot program.
fn in_place(path: &CompensatedPath) -> Vec<String> {
    let written = path.in_place.iter().map(|given| {
        format!(
            "{}: {} written with {} changed targets; largest deviation of its moves {:.2} µm ({:.2} µm rms)",
            path.name,
            given.files.join(", "),
            given.moved_targets,
            given.after.max_um,
            given.after.rms_um
        )
    });
    let notes = path
        .in_place
        .iter()
        .flat_map(|given| &given.notes)
        .chain(&path.notes);
    written.chain(notes.map(|note| format!("note: {note}"))).collect()
}

fn as_text(answer: &CompensationAnswer) -> String {
    let mut lines: Vec<String> = answer
        .paths
        .iter()
        .map(|path| match path.rounds {
            0 => format!(
                "{}: not compensated; largest deviation of the tool {:.1} µm ({:.1} µm rms)",
                path.name, path.before.max_um, path.before.rms_um
            ),
            _ => format!(
                "{}: largest deviation of the tool {:.1} µm ({:.1} µm rms), compensated {:.2} µm ({:.2} µm rms); points move by up to {:.1} µm",
                path.name, path.before.max_um, path.before.rms_um, path.after.max_um, path.after.rms_um, path.largest_correction_um
            ),
        })
        .collect();
    for path in answer
        .paths
        .iter()
        .filter(|path| path.unreachable + path.outside_joint_limits > 0)
    {
        lines.push(format!(
            "{}: {} of {} points are out of reach and remain unchanged; {} are outside joint limits",
            path.name, path.unreachable, path.points, path.outside_joint_limits
        ));
    }
    lines.extend(answer.paths.iter().flat_map(in_place));
    let parts = [
        (answer.backlash, "backlash"),
        (answer.geometry, "the geometric errors of the robot"),
    ];
    let named = |counts: bool| {
        parts
            .iter()
            .filter(move |part| part.0 == counts)
            .map(|part| part.1)
    };
    let within = ["elastic deviation"].into_iter().chain(named(true));
    let mut known = format!("Predicted from {}", within.collect::<Vec<_>>().join(", "));
    let without: Vec<&str> = named(false).collect();
    if !without.is_empty() {
        let _ = write!(known, "; not known and not included: {}", without.join(", "));
    }
    lines.push(known + ".");
    if answer.compliance_assumed {
        lines.push(
            "The joint compliances are assumed, not measured: do not send such a path to a robot.".to_owned(),
        );
    }
    lines.join("\n")
}
