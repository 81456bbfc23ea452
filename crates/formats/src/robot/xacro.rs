//! xacro: URDF with macros, properties and expressions, expanded and then read as URDF.
//!
//! A file that defines one robot macro and calls nothing is read as that robot with an empty `prefix`. Files that it
//! includes are looked for beside it and in the packages around it ([`packages`]); missing files of colours, materials
//! and simulation are remarks. What links look like and weigh is dropped before expansion, so that nothing of it can
//! fail. Expressions are worked out by the crate `xacro-rs`; `$(env ...)` is not.

mod expand;
mod flatten;
mod packages;

use std::path::Path;

use self::flatten::Flat;
use super::description::RobotDescription;
use super::urdf;
use crate::document::{Problems, Source};

/// The robot of this xacro text, which was read from `path`; `id` is the robot's name in results.
///
/// # Errors
/// As [`read_to_tip`].
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    read_to_tip(Path::new(path), id, text, None)
}

/// The robot of this xacro text with its flange at the link `tip`.
///
/// # Errors
/// What is not XML, a file that is missing, a file without robot or with several, an expression that cannot be
/// worked out; then what [`urdf::read_to_tip`] finds in the expanded text.
pub fn read_to_tip(
    path: &Path,
    id: &str,
    text: &str,
    tip: Option<&str>,
) -> Result<RobotDescription, Problems> {
    let shown = path.display().to_string();
    let main = Source::new(&shown, text);
    let Flat {
        xml,
        sources,
        remarks,
    } = flatten::flatten(&main, path)?;
    let expanded = expand::expand(&main, &sources, path, xml)?;
    let mut found = urdf::read_to_tip(&format!("{shown} (expanded)"), id, &expanded, tip)?;
    for source in &mut found.sources {
        source.key = "xacro".to_owned();
        source.place.clone_from(&shown);
    }
    for joint in &mut found.joints {
        joint.source = Some("xacro".to_owned());
    }
    found.note = Some("xacro: no compliance; the base is its root link".to_owned());
    found.remarks.extend(remarks);
    Ok(found)
}

#[cfg(test)]
mod tests;
