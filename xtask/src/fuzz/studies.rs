//! Study files that are generated from the JSON schema: `crates/study/tests/generated` checks each, here it is called for many.
//!
//! Neither libFuzzer nor counters are needed: the studies are those of the seeds 0 to N.

use crate::command::{cargo, command_line};

/// The test that checks them.
const TEST: &str = "generated_studies_are_answered_or_refused_with_a_reason";

/// Checks this many generated studies; whether all are as required.
///
/// # Errors
/// Cargo does not start.
pub fn checked(studies: u32) -> Result<bool, String> {
    let mut command = cargo(&["test", "--package", "armill-study", "--test", "generated"]);
    command.args(["--", "--exact", TEST, "--nocapture"]);
    command.env("ARMILL_STUDIES", studies.to_string());
    let line = command_line(&command);
    eprintln!("+ {line}");
    let status = command.status();
    let status = status.map_err(|problem| format!("{line} does not start: {problem}"))?;
    Ok(status.success())
}
