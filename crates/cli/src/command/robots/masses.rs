//! `armill robots masses`: masses of the links, estimated from the mass of the arm, as tables of a robot file.
//!
//! The tables go to `--out`, or to stdout; with `--json` stdout has an [`EstimatedLinksAnswer`](armill_study::estimated_links::EstimatedLinksAnswer).

use armill_formats::robot::armill;
use armill_study::StudyError;
use armill_study::estimated_links::{ArmMass, EstimatedLinks};

use crate::arguments::MassesArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Estimates the masses, and writes the tables.
///
/// # Errors
/// A file that must not be replaced; the problems of the robot; a robot without bodies; a file that cannot be written.
pub(super) fn run(arguments: &MassesArguments) -> Result<Outcome, StudyError> {
    let found = EstimatedLinks::of(
        &arguments.robot,
        ArmMass {
            total_kg: arguments.total_kg,
            total_u_percent: arguments.total_u_percent,
        },
    )?;
    let text = armill::mass_tables(&found.robot);
    let shown = arguments.out.as_ref().map(|path| path.display().to_string());
    if let Some(path) = &arguments.out {
        arguments
            .writing
            .writer("robots masses")
            .for_new_files()
            .write(path, text.as_bytes())?;
    }
    if arguments.json {
        print(&serde_json::to_string(&found.answer(shown.clone(), &text))?)?;
    } else if shown.is_none() {
        print(text.trim_end())?;
    }
    let links = found.robot.robot.structure().masses.len();
    say(&format!("{}: masses of {links} links", found.robot.title));
    if let Some(file) = shown {
        say(&format!("created {file}: append it to the robot file"));
    }
    Ok(Outcome::Fine)
}
