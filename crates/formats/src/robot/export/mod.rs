//! Robots out, for other programs: calibrated geometry and stiffness included where the format has words for them.
//!
//! | format | module | contains |
//! |---|---|---|
//! | URDF | `urdf` | chain, limits, speeds, masses, shapes |
//! | xacro with its arguments in YAML | `xacro` | the same; the pose of each joint in a YAML file |
//! | calibration file of `ur_description` | `ur_yaml` | poses of the six joints of an arm like those of Universal Robots |
//! | Denavit-Hartenberg table | `dh_table`, `dh_rows` | chain, limits |
//! | SDF | `sdf` | as URDF; springs |
//! | MJCF of MuJoCo | `mjcf` | as URDF; springs, inertia of rotors |
//!
//! Common to them: `format` and `convention` (their names), `options` (what a user may decide), `error`; `bodies` (bodies and joints), made of a robot by `linkage` with
//! `names` and `elasticity`; `left_out` (what a format does not express), `spelling` (numbers), `shapes` (shapes of links).
//!
//! Positions of joints are those of the robot file. A number that is not known is not written; where a format requires one, it is marked as a
//! placeholder in the file and in a warning.

mod bodies;
mod convention;
mod dh_rows;
mod dh_table;
mod elasticity;
mod error;
mod format;
mod left_out;
mod linkage;
mod mjcf;
mod names;
mod options;
mod sdf;
mod shapes;
mod spelling;
mod ur_yaml;
mod urdf;
mod xacro;

use self::bodies::Linkage;
pub use self::convention::DhConvention;
pub use self::error::ExportError;
pub use self::format::ExportFormat;
use self::format::title;
pub use self::options::{CoupledJoints, ExportOptions, Exported, ExportedMesh, ExportedStiffness};
pub(super) use self::ur_yaml::{KEYS as UR_KEYS, LINKS as UR_LINKS};
use super::RobotDescription;

/// A robot in this format.
///
/// # Errors
/// What the format cannot express and would make of the robot another one: see [`ExportError`].
pub fn export(
    found: &RobotDescription,
    format: ExportFormat,
    options: &ExportOptions,
) -> Result<Exported, ExportError> {
    if options.stiffness != ExportedStiffness::None
        && !matches!(format, ExportFormat::Sdf | ExportFormat::Mjcf)
    {
        return Err(ExportError::NoStiffness(title(format)));
    }
    if options.coupling == Some(CoupledJoints::Follower)
        && !matches!(
            format,
            ExportFormat::Urdf | ExportFormat::Xacro | ExportFormat::Sdf
        )
        && found
            .robot
            .joints()
            .iter()
            .any(|joint| !joint.coupling.is_empty())
    {
        return Err(ExportError::NoFollower(title(format)));
    }
    let mut linkage = Linkage::of(found, options)?;
    let mut warnings = std::mem::take(&mut linkage.warnings);
    warnings.extend(options.caution.clone());
    warnings.extend(left_out::left_out(found, format, options));
    let head = head(found, format, &warnings);
    let mut exported = match format {
        ExportFormat::Urdf => urdf::write(&linkage, &head),
        ExportFormat::Xacro => xacro::write(found, (&linkage, options), &head),
        ExportFormat::Ur => ur_yaml::write(found, &head),
        ExportFormat::Dh => dh_table::write(found, (&linkage, options), &head),
        ExportFormat::Sdf => Ok(sdf::write(&linkage.with_rigid_flange(), &head)),
        ExportFormat::Mjcf => Ok(mjcf::write(found, (&linkage.with_rigid_flange(), options), &head)),
    }?;
    warnings.append(&mut exported.warnings);
    exported.warnings = warnings;
    Ok(exported)
}

/// The first lines of a file, for people.
fn head(found: &RobotDescription, format: ExportFormat, warnings: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!(
            "{} ({}), written by armill {} as {}.",
            found.title,
            found.robot.name(),
            env!("CARGO_PKG_VERSION"),
            title(format)
        ),
        "Joint positions have the signs and zeros of the robot file.".to_owned(),
    ];
    lines.extend(
        found
            .sources
            .iter()
            .map(|source| format!("Source `{}`: {}; {}", source.key, source.what, source.place)),
    );
    lines.extend(warnings.iter().map(|warning| format!("Note: {warning}.")));
    lines
}

#[cfg(test)]
mod tests;
