//! xacro: URDF with macros, properties and expressions, expanded and then read as URDF.
//!
//! A file that defines one robot macro and calls nothing is read as that robot with an empty `prefix`. Files that it
//! includes are searched next to it and in the packages around it; missing files of colours, materials and
//! simulation are remarks. `$(env ...)` is not evaluated.
//!
//! In reading order: `packages` (where included files may be), `elements` (which elements are of xacro), `flatten` (one
//! text of all files; what links look like is dropped, so that nothing of it can fail, except for meshes on request; where masses fail they are dropped too), `values` (what each
//! name is given anywhere), `load_yaml` (data of YAML files, checked before it is used), `growth` (refuses macros that
//! could grow without bound), `expand` (macros and expressions, evaluated by the crate `xacro-rs`).

mod elements;
mod expand;
mod flatten;
mod growth;
mod load_yaml;
mod packages;
mod values;

use std::path::Path;

pub use self::expand::EXPANDER;
use self::flatten::OfLinks;
use super::description::RobotDescription;
use super::urdf;
use crate::document::{Problems, Source};

/// The robot of this xacro text, which was read from `path`, with its flange at the link `tip`, or at the end of the
/// longest chain; `id` is the robot's name in results.
///
/// Problems of the expanded text are in `PATH (expanded)`: no line of it is in a file. The one source is called
/// `xacro`.
///
/// # Errors
/// What is not XML, a file that is missing, a file without robot or with several, an expression that cannot be
/// evaluated; then what [`urdf::read_to_tip`] finds in the expanded text.
pub fn read_to_tip(
    path: &Path,
    id: &str,
    text: &str,
    tip: Option<&str>,
) -> Result<RobotDescription, Problems> {
    let shown = path.display().to_string();
    let Expanded {
        urdf: expanded,
        remarks,
    } = expand_with_inertials(path, text)?;
    let mut found = urdf::read_to_tip(&format!("{shown} (expanded)"), id, &expanded, tip)?;
    for source in &mut found.sources {
        source.key = "xacro".to_owned();
        source.place.clone_from(&shown);
    }
    for joint in &mut found.joint_notes {
        joint.source = Some("xacro".to_owned());
    }
    found.note = Some("xacro: no compliance; the base is its root link".to_owned());
    found.remarks.extend(remarks);
    Ok(found)
}

/// What a xacro file comes to.
#[derive(Clone, Debug)]
pub struct Expanded {
    /// The text of a URDF: links by name, on request with their meshes, joints with what moves them.
    pub urdf: String,
    /// Files that were not found and are not needed.
    pub remarks: Vec<String>,
}

/// The URDF that this xacro text, which was read from `path`, represents.
///
/// Reads the files that it includes from the disk.
///
/// # Errors
/// What is not XML, a file that is missing, a file without robot or with several, an expression that cannot be
/// evaluated.
pub fn expand(path: &Path, text: &str) -> Result<Expanded, Problems> {
    expanded(path, text, OfLinks::Names)
}

/// [`expand`] with the meshes of the links and their origins: expressions in these can fail as well.
///
/// # Errors
/// As of [`expand`].
pub fn expand_with_meshes(path: &Path, text: &str) -> Result<Expanded, Problems> {
    expanded(path, text, OfLinks::Meshes)
}

/// [`expand`] with the masses of the links; without them, and with a remark, where their expressions fail.
///
/// # Errors
/// As of [`expand`].
pub fn expand_with_inertials(path: &Path, text: &str) -> Result<Expanded, Problems> {
    expanded(path, text, OfLinks::Inertials).or_else(|problems| {
        let mut without = expand(path, text)?;
        let why = problems
            .as_slice()
            .first()
            .map_or("", |problem| problem.message());
        without
            .remarks
            .push(format!("masses of links are left out: {why}"));
        Ok(without)
    })
}

fn expanded(path: &Path, text: &str, of_links: OfLinks) -> Result<Expanded, Problems> {
    let main = Source::new(&path.display().to_string(), text);
    let flat = flatten::flatten(&main, path, of_links)?;
    let urdf = expand::expand(&main, path, &flat)?;
    Ok(Expanded {
        urdf,
        remarks: flat.remarks,
    })
}

#[cfg(test)]
mod tests;
