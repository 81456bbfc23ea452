//! A commented study that runs, for a robot: its plate is within reach, and unknown values are marked as missing.
//!
//! The template fits a Yaskawa MH12. For another arm lengths grow with its reach, the height of the plate with reach
//! and shoulder; if the arm cannot reach its corners, the plate is moved nearer, step by step.

use std::path::{Component, Path};

use armill_core::frame::Isometry;
use armill_core::nalgebra::Point3;
use armill_core::robot::forward::forward;
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::robot::{Robot, reach};
use armill_core::units::{from_mm, to_mm};
use armill_core::workpiece::Plane;
use serde::Serialize;

use crate::compliance_class::ComplianceClass;
use crate::error::StudyError;
use crate::{ENOUGH_JOINTS, library, robots};

/// The study of an MH12; words in capitals are filled in.
const TEMPLATE: &str = include_str!("new.toml");
/// Inserted if a class of assumed compliances is defined for the robot.
const COMPLIANCE: &str = "
# No joint compliance is known for this robot. The values of a class of arms are assumed, with a large uncertainty:
# light (up to 20 kg payload), medium (to 100 kg), heavy (to 300 kg); every result states this. Once yours are
# identified from load tests, write:
# rad_per_n_m = [...], one for each joint, u_rad_per_n_m = [...], source = \"...\".
[compliance]
class = \"CLASS\"
";
/// Inserted if there is none: the user must give them.
const COMPLIANCE_OPEN: &str = "
# No joint compliance is known for this robot, and no class of assumed values fits its joints. Nothing can be predicted
# until you give yours, one for each joint, base to flange: `armill identify` identifies them from load tests.
[compliance]
rad_per_n_m = []
source = \"\"
";

/// Reach of the arm that the plate of the template fits, m: Yaskawa MH12.
const REACH_OF_TEMPLATE: f64 = 1.44;
/// Height of its second axis, mm.
const SHOULDER_OF_TEMPLATE: f64 = 450.0;
/// Length of the tool of the template, m.
const TOOL_OF_TEMPLATE: f64 = 0.150;
/// Number of steps by which the plate is moved nearer.
const TRIES: i32 = 10;

/// A new study.
#[derive(Clone, Debug)]
pub struct NewStudy {
    /// The study file.
    pub text: String,
    /// What is known of its joints.
    pub compliances: Compliances,
}

/// Knowledge of the joint compliances in a new study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compliances {
    /// The robot has its own.
    Known,
    /// They are assumed, of a class.
    Assumed,
    /// The user must give them before it runs.
    Missing,
}

/// The created files, as JSON.
#[derive(Clone, Debug, Serialize)]
pub struct MadeStudy {
    /// The study file.
    pub study: String,
    /// The other files.
    pub files: Vec<String>,
}

/// A study in `folder` of the robot `given`: a library name, or the path of a robot file relative to the current folder.
///
/// # Errors
/// As [`robots::find`]; a robot of too few joints for any study.
pub fn new_study(given: &str, folder: &Path) -> Result<NewStudy, StudyError> {
    let found = robots::find(given, ".".as_ref())?;
    let joints = found.robot.joints().len();
    if joints < ENOUGH_JOINTS {
        let message = format!("robot `{given}` has {joints} joints: no study can be run with it");
        return Err(StudyError::value(
            message,
            "`armill pose` accepts its joint positions; `armill robots` lists robots for studies",
        ));
    }
    let class = found
        .payload_kg
        .map_or(ComplianceClass::Medium, ComplianceClass::of_payload);
    let (compliances, table) = match found.robot.compliance() {
        Some(_) => (Compliances::Known, String::new()),
        None if class.compliance_of(&found.robot).is_err() => {
            (Compliances::Missing, COMPLIANCE_OPEN.to_owned())
        }
        None => (Compliances::Assumed, COMPLIANCE.replace("CLASS", class.name())),
    };
    let robot = toml_string(&robot_for(given, folder)?);
    let text = scaled(&found.robot)
        .replace("\"ROBOT\"", &robot)
        .replace("# COMPLIANCE\n", &table);
    Ok(NewStudy { text, compliances })
}

/// The plate of a new study, mm.
struct Plate {
    x: f64,
    z: f64,
    half_size: f64,
    distances: [f64; 4],
}

/// The template with its plate at the same position in the working range of `robot`.
fn scaled(robot: &Robot) -> String {
    let factor = reach(robot).unwrap_or(REACH_OF_TEMPLATE) / REACH_OF_TEMPLATE;
    // If the reach is not known, the plate is moved nearer until the arm reaches it.
    let tried = (0..TRIES).map(|step| Plate::scaled(robot, factor * 0.9_f64.powi(step)));
    let plate = tried
        .into_iter()
        .find(|plate| plate.is_reached(robot))
        .unwrap_or_else(|| Plate::scaled(robot, factor));
    let half_size = plate.half_size;
    TEMPLATE
        .replace("CENTRE", &format!("{}, 0, {}", plate.x, plate.z))
        .replace("HALF_SIZE", &half_size.to_string())
        .replace("STEP", &(half_size / 10.0).to_string())
        .replace("DISTANCES", &plate.distances.map(|x| x.to_string()).join(", "))
        .replace("RADIUS", &(half_size / 2.0).to_string())
}

impl Plate {
    /// The plate of the template, its lengths times `factor`, rounded to convenient numbers.
    fn scaled(robot: &Robot, factor: f64) -> Plate {
        let scaled = |mm: f64, step: f64| (mm * factor / step).round().max(1.0) * step;
        let shoulder = to_mm(forward(robot, &vec![0.0; robot.joints().len()]).origin(1).z);
        // The height range of an arm with a low shoulder is smaller than its reach.
        let height = (800.0 * factor).min(shoulder + (800.0 - SHOULDER_OF_TEMPLATE) * factor);
        let x = scaled(1000.0, 50.0);
        Plate {
            x,
            z: (height / 50.0).round().max(1.0) * 50.0,
            half_size: scaled(200.0, 20.0),
            distances: [-200.0, -100.0, 0.0, 100.0].map(|mm| x + (mm * factor / 10.0).round() * 10.0),
        }
    }

    /// Whether the arm reaches the corners of the plate.
    fn is_reached(&self, robot: &Robot) -> bool {
        let centre = from_mm(Point3::new(self.x, 0.0, self.z));
        let plane = Plane::tilted(centre, std::f64::consts::FRAC_PI_2);
        let flange_from_tool = Isometry::translation(0.0, 0.0, TOOL_OF_TEMPLATE);
        let at = ToolAt {
            flange_from_tool: &flange_from_tool,
            near: None,
            home: None,
        };
        let half = from_mm(self.half_size);
        [[-half, -half], [-half, half], [half, -half], [half, half]]
            .into_iter()
            .all(|corner| postures(robot, &plane.base_from_tool(corner.into(), 0.0), at).is_ok())
    }
}

/// A robot file at most so many folders up is named relative to the study, so that both can be moved together.
const LEVELS_UP: usize = 2;

/// The robot as named in the study: paths there are relative to its folder, not to the current one.
fn robot_for(given: &str, folder: &Path) -> Result<String, StudyError> {
    if library::robot(given).is_some() {
        return Ok(given.to_owned());
    }
    let absolute = |path: &Path| {
        std::path::absolute(path).map_err(|error| {
            StudyError::value(
                format!("cannot find the location of {}: {error}", path.display()),
                "give its full path",
            )
        })
    };
    let (file, folder) = (absolute(given.as_ref())?, absolute(folder)?);
    // From a folder behind a link `..` leads to where the link points.
    let is_direct = folder
        .ancestors()
        .find_map(|above| above.canonicalize().ok().map(|physical| physical == above))
        .unwrap_or(false);
    let nearby = relative(&file, &folder).filter(|_| is_direct);
    Ok(nearby.unwrap_or_else(|| file.display().to_string()))
}

/// `file` relative to `folder`, both absolute, with `/` as in every study; `None` if it is too far up, or reached through `..`.
fn relative(file: &Path, folder: &Path) -> Option<String> {
    let is_plain = |path: &Path| !path.components().any(|part| part == Component::ParentDir);
    let up = (0..=LEVELS_UP).zip(folder.ancestors());
    let (up, rest) = up
        .filter(|(_, above)| above.parent().is_some())
        .find_map(|(up, above)| Some((up, file.strip_prefix(above).ok()?)))?;
    let down = rest.components().map(|part| part.as_os_str().to_str());
    let parts: Option<Vec<&str>> = std::iter::repeat_n(Some(".."), up).chain(down).collect();
    (is_plain(file) && is_plain(folder)).then_some(parts?.join("/"))
}

/// A TOML basic string.
fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_study_says_what_it_knows_of_the_joints() {
        for (robot, known) in [
            ("yaskawa/mh12", Compliances::Known),
            ("kuka/kr16-2", Compliances::Assumed),
            ("kuka/lbr-iiwa-14-r820", Compliances::Missing),
        ] {
            let made = new_study(robot, "cell".as_ref()).unwrap();
            assert_eq!(made.compliances, known, "{robot}");
            assert_eq!(made.text.contains("[compliance]"), known != Compliances::Known);
            assert!(
                made.text.contains(&format!("robot = \"{robot}\"")),
                "{}",
                made.text
            );
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_robot_file_nearby_is_named_relative_to_the_study() {
        let named = |file: &str, folder: &str| relative(file.as_ref(), folder.as_ref());
        let of = |text: &str| Some(text.to_owned());
        assert_eq!(named("/home/a/cell/arm.toml", "/home/a/cell"), of("arm.toml"));
        assert_eq!(named("/home/a/arm.toml", "/home/a/cell"), of("../arm.toml"));
        assert_eq!(
            named("/home/a/arms/1.urdf", "/home/a/cells/1"),
            of("../../arms/1.urdf")
        );
        assert_eq!(named("/home/arm.toml", "/home/a/b/cell"), None);
        assert_eq!(named("/opt/arm.toml", "/home/cell"), None, "nothing in common");
        assert_eq!(named("/home/b/../arm.toml", "/home/cell"), None);
    }
}
