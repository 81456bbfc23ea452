//! armill's own robot file, format 1: TOML, the chain as ordered elementary motions, a source for every number.
//!
//! Lengths in mm, angles in degrees, compliances in rad/(N m); a sliding joint uses mm and um/N instead.

use std::collections::BTreeMap;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Amount, Axis, BranchPattern, Joint, JointCompliance, Limits, Motion, Robot};
use schemars::JsonSchema;
use serde::Deserialize;

use super::description::{JointNote, RobotDescription, Source};
use crate::document::{Document, Problem, Problems};

/// The robot file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RobotFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    _format: u32,
    /// Maker and type, for people.
    name: String,
    /// What a user should know before trusting the numbers.
    note: Option<String>,
    /// Branch that stands for the robot where none is asked for, such as `front elbow-up`.
    nominal_branch: Option<String>,
    /// Elementary motions from base to flange.
    chain: ChainTable,
    /// Joints, in the order of the chain.
    joint: Vec<JointEntry>,
    /// Frames that positions may be counted from, beside base_link.
    #[serde(default)]
    frame: Vec<FrameEntry>,
    /// Greatest load at the flange.
    payload: Option<PayloadTable>,
    /// Where the numbers come from, by key.
    sources: BTreeMap<String, SourceEntry>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ChainTable {
    /// Key of the source of the lengths and angles.
    source: String,
    /// Elementary motions, base to flange.
    motions: Vec<MotionEntry>,
}

/// One elementary motion: along or about an axis, by a length, an angle or a joint.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MotionEntry {
    /// Translation along this axis.
    along: Option<AxisName>,
    /// Rotation about this axis, by the right hand.
    about: Option<AxisName>,
    /// How far along.
    #[schemars(range(min = -1e6, max = 1e6))]
    length_mm: Option<f64>,
    /// How far about.
    #[schemars(range(min = -360.0, max = 360.0))]
    angle_deg: Option<f64>,
    /// Name of the joint that makes the motion.
    joint: Option<String>,
    /// Symbol in the source, for people.
    symbol: Option<String>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum AxisName {
    X,
    Y,
    Z,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct JointEntry {
    /// The maker's name.
    name: String,
    /// 1 if the controller counts by the right hand about the chain's axis, -1 if against it.
    #[schemars(range(min = -1, max = 1))]
    sign: i8,
    /// Chain angle at the controller's zero.
    zero_offset_deg: Option<f64>,
    /// Chain position at the controller's zero, sliding joints.
    zero_offset_mm: Option<f64>,
    /// Earlier joints that add to this one's count.
    #[serde(default)]
    coupling: Vec<CouplingEntry>,
    /// Lower and upper limit in the controller's counting.
    limits_deg: Option<[f64; 2]>,
    /// Lower and upper limit, sliding joints.
    limits_mm: Option<[f64; 2]>,
    /// Greatest speed.
    #[schemars(range(min = 0.0))]
    max_speed_deg_per_s: Option<f64>,
    /// Greatest speed, sliding joints.
    #[schemars(range(min = 0.0))]
    max_speed_mm_per_s: Option<f64>,
    /// Key of the source of sign, zero, limits and speed.
    source: String,
    /// Compliance about the axis, drive and control loop included.
    #[schemars(range(min = 0.0, max = 1.0))]
    compliance_rad_per_n_m: Option<f64>,
    /// Standard uncertainty of the compliance.
    #[schemars(range(min = 0.0, max = 1.0))]
    compliance_u_rad_per_n_m: Option<f64>,
    /// Compliance along the axis, sliding joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    compliance_um_per_n: Option<f64>,
    /// Standard uncertainty of the compliance, sliding joints.
    #[schemars(range(min = 0.0, max = 1e6))]
    compliance_u_um_per_n: Option<f64>,
    /// Key of the source of the compliance.
    compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty; that of the compliance if left out.
    compliance_u_source: Option<String>,
    /// Limits by other sources; told to the user, never enforced.
    #[serde(default)]
    other_limits: Vec<OtherLimits>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CouplingEntry {
    /// Name of the earlier joint.
    joint: String,
    /// What part of its position adds to this joint's count.
    factor: f64,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct OtherLimits {
    /// Lower and upper limit.
    limits_deg: [f64; 2],
    /// Key of the source.
    source: String,
    /// What to make of it.
    note: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FrameEntry {
    /// Its name, such as `controller`.
    name: String,
    /// Its origin in base_link.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    origin_mm: [f64; 3],
    /// Turn about the fixed axes x, y, z of base_link.
    #[serde(default)]
    rotation_deg: [f64; 3],
    /// Key of the source.
    source: String,
    /// What it is.
    #[serde(rename = "note")]
    _note: Option<String>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PayloadTable {
    /// Greatest mass at the flange.
    #[schemars(range(min = 0.0))]
    mass_kg: f64,
    /// Key of the source.
    source: String,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SourceEntry {
    /// What was taken.
    what: String,
    /// Where it stands.
    #[serde(rename = "where")]
    place: String,
    /// Under which licence, or that it is a fact.
    licence: String,
}

/// The robot of this file; `path` is what errors show, `id` the robot's name in results.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let document = Document::parse(path, text)?;
    let file: RobotFile = document.read()?;
    let mut checks = Checks { document: &document, problems: Vec::new(), sources: &file.sources };
    let motions = checks.motions(&file);
    let joints = checks.joints(&file);
    let compliance = checks.compliance(&file);
    checks.frames_and_payload(&file);
    let nominal = checks.nominal(&file);
    checks.unused_sources(&file);
    Problems::from(std::mem::take(&mut checks.problems)).into_result()?;

    let refused = |error: armill_core::robot::RobotError| {
        Problems::from(vec![document.problem("chain.motions", error.to_string(), None)])
    };
    let mut robot = Robot::new(id, motions, joints).map_err(refused)?.with_nominal_branch(nominal);
    robot = robot.with_frames(file.frame.iter().map(named_frame).collect());
    if let Some(compliance) = compliance {
        robot = robot.with_compliance(compliance).map_err(refused)?;
    }
    Ok(RobotDescription {
        robot,
        title: file.name,
        note: file.note.map(|note| note.trim().to_owned()),
        payload_kg: file.payload.map(|payload| payload.mass_kg),
        symbols: file.chain.motions.into_iter().map(|motion| motion.symbol).collect(),
        joints: file.joint.into_iter().map(joint_note).collect(),
        sources: file
            .sources
            .into_iter()
            .map(|(key, s)| Source { key, what: s.what, place: s.place, licence: s.licence })
            .collect(),
    })
}

/// JSON Schema of the robot file, for editors.
pub fn schema() -> String {
    crate::document::schema_json::<RobotFile>()
}

fn named_frame(entry: &FrameEntry) -> NamedFrame {
    let rotation = Vector3::from(entry.rotation_deg).map(f64::to_radians);
    let base_from_frame: Isometry = from_xyz_and_fixed_angles(Vector3::from(entry.origin_mm) * 1e-3, rotation);
    NamedFrame { name: entry.name.clone(), base_from_frame }
}

fn joint_note(entry: JointEntry) -> JointNote {
    JointNote {
        source: Some(entry.source),
        compliance_u_source: entry.compliance_u_source.or_else(|| entry.compliance_source.clone()),
        compliance_source: entry.compliance_source,
        other_limits: entry.other_limits.into_iter().map(|o| (o.limits_deg, o.source, o.note)).collect(),
    }
}

/// What no schema can say, collected.
struct Checks<'a> {
    document: &'a Document,
    problems: Vec<Problem>,
    sources: &'a BTreeMap<String, SourceEntry>,
}

impl Checks<'_> {
    fn problem(&mut self, path: &str, message: impl Into<String>, hint: &str) {
        self.problems.push(self.document.problem(path, message, Some(hint)));
    }

    fn source(&mut self, path: &str, key: &str) {
        if !self.sources.contains_key(key) {
            let known: Vec<&str> = self.sources.keys().map(String::as_str).collect();
            let hint = format!("add a table [sources.{key}], or use one of: {}", known.join(", "));
            self.problem(path, format!("source `{key}` is not among the sources"), &hint);
        }
    }

    fn motions(&mut self, file: &RobotFile) -> Vec<Motion> {
        self.source("chain.source", &file.chain.source);
        let mut motions = Vec::new();
        let mut used = 0;
        for (index, entry) in file.chain.motions.iter().enumerate() {
            let path = format!("chain.motions[{index}]");
            if let Some(motion) = self.motion(&path, entry, file, &mut used) {
                motions.push(motion);
            }
        }
        if used < file.joint.len() && self.problems.is_empty() {
            let name = &file.joint[used].name;
            let message = format!("joint `{name}` never moves: the chain does not name it");
            let hint = "add a motion such as { about = \"z\", joint = ... }, or remove the joint";
            self.problem(&format!("joint[{used}].name"), message, hint);
        }
        motions
    }

    fn motion(&mut self, path: &str, entry: &MotionEntry, file: &RobotFile, used: &mut usize) -> Option<Motion> {
        let (axis, turns) = match (entry.along, entry.about) {
            (Some(axis), None) => (axis, false),
            (None, Some(axis)) => (axis, true),
            _ => {
                let hint = "write { along = \"x\", length_mm = 100 } or { about = \"z\", joint = \"A1\" }";
                self.problem(path, "an elementary motion has either `along` or `about`", hint);
                return None;
            }
        };
        let amount = match (entry.length_mm, entry.angle_deg, &entry.joint) {
            (Some(length), None, None) if !turns => Amount::Constant(length * 1e-3),
            (None, Some(angle), None) if turns => Amount::Constant(exact_radians(angle)),
            (None, None, Some(name)) => Amount::Joint(self.next_joint(path, name, file, used)?),
            _ => {
                let hint = "`along` takes `length_mm` or `joint`, `about` takes `angle_deg` or `joint`";
                self.problem(path, "an elementary motion goes by exactly one of length, angle and joint", hint);
                return None;
            }
        };
        let axis = match axis {
            AxisName::X => Axis::X,
            AxisName::Y => Axis::Y,
            AxisName::Z => Axis::Z,
        };
        Some(if turns { Motion::About(axis, amount) } else { Motion::Along(axis, amount) })
    }

    fn next_joint(&mut self, path: &str, name: &str, file: &RobotFile, used: &mut usize) -> Option<usize> {
        let expected = file.joint.get(*used).map(|joint| joint.name.as_str());
        if expected == Some(name) {
            *used += 1;
            return Some(*used - 1);
        }
        let message = match expected {
            Some(expected) => format!("joint `{name}` stands where `{expected}` comes next"),
            None => format!("joint `{name}` has no table [[joint]] of its own"),
        };
        self.problem(&format!("{path}.joint"), message, "joints appear once each, in the order of the [[joint]] tables");
        None
    }

    fn joints(&mut self, file: &RobotFile) -> Vec<Joint> {
        if file.joint.is_empty() {
            self.problem("chain", "the chain has no joint", "add [[joint]] tables and name them in `motions`");
        }
        let mut joints = Vec::new();
        for (index, entry) in file.joint.iter().enumerate() {
            let path = format!("joint[{index}]");
            self.source(&format!("{path}.source"), &entry.source);
            if entry.sign == 0 {
                self.problem(&format!("{path}.sign"), format!("joint {}: sign 0", entry.name), "write 1 or -1");
            }
            joints.push(Joint {
                name: entry.name.clone(),
                sign: if entry.sign < 0 { Sign::Negative } else { Sign::Positive },
                zero_offset: entry.zero_offset_deg.map_or(0.0, exact_radians)
                    + entry.zero_offset_mm.map_or(0.0, |mm| mm * 1e-3),
                coupling: self.coupling(&path, entry, &file.joint[..index]),
                limits: self.limits(&path, entry),
                max_speed: entry
                    .max_speed_deg_per_s
                    .map(f64::to_radians)
                    .or(entry.max_speed_mm_per_s.map(|mm| mm * 1e-3)),
            });
            for (other, limits) in entry.other_limits.iter().enumerate() {
                self.source(&format!("{path}.other_limits[{other}].source"), &limits.source);
            }
        }
        joints
    }

    fn coupling(&mut self, path: &str, entry: &JointEntry, earlier: &[JointEntry]) -> Vec<Coupling> {
        let mut coupling = Vec::new();
        for (index, c) in entry.coupling.iter().enumerate() {
            match earlier.iter().position(|joint| joint.name == c.joint) {
                Some(joint) => coupling.push(Coupling { joint, factor: c.factor }),
                None => {
                    let message = format!("joint {}: `{}` is no earlier joint", entry.name, c.joint);
                    let hint = "only an earlier joint can add to a joint's count";
                    self.problem(&format!("{path}.coupling[{index}].joint"), message, hint);
                }
            }
        }
        coupling
    }

    fn limits(&mut self, path: &str, entry: &JointEntry) -> Option<Limits> {
        let (limits, key, unit) = match (entry.limits_deg, entry.limits_mm) {
            (Some(deg), _) => (deg, "limits_deg", "deg"),
            (None, Some(mm)) => (mm, "limits_mm", "mm"),
            (None, None) => return None,
        };
        let [lower, upper] = limits;
        if lower >= upper {
            let message =
                format!("joint {}: lower limit {lower} {unit} is not below upper limit {upper} {unit}", entry.name);
            self.problem(&format!("{path}.{key}"), message, "write [lower, upper]");
            return None;
        }
        let to_si = |value: f64| if unit == "deg" { exact_radians(value) } else { value * 1e-3 };
        Some(Limits { lower: to_si(lower), upper: to_si(upper) })
    }

    fn compliance(&mut self, file: &RobotFile) -> Option<Vec<JointCompliance>> {
        let mut known = Vec::new();
        for (index, entry) in file.joint.iter().enumerate() {
            let path = format!("joint[{index}]");
            let value = entry.compliance_rad_per_n_m.or(entry.compliance_um_per_n.map(|um| um * 1e-6));
            let u = entry.compliance_u_rad_per_n_m.or(entry.compliance_u_um_per_n.map(|um| um * 1e-6));
            match (value, &entry.compliance_source) {
                (Some(value), Some(_)) => {
                    known.push(JointCompliance { value, standard_uncertainty: u.unwrap_or(0.0) });
                }
                (Some(_), None) => {
                    let message = format!("joint {}: its compliance names no source", entry.name);
                    self.problem(&path, message, "add compliance_source = \"...\"");
                }
                (None, _) => {}
            }
            for (key, source) in [
                ("compliance_source", &entry.compliance_source),
                ("compliance_u_source", &entry.compliance_u_source),
            ] {
                if let Some(source) = source {
                    self.source(&format!("{path}.{key}"), source);
                }
            }
        }
        if !known.is_empty() && known.len() < file.joint.len() {
            let message = format!("{} of {} joints have a compliance", known.len(), file.joint.len());
            self.problem("joint", message, "give all of them (0 for a rigid joint) or none");
        }
        (known.len() == file.joint.len()).then_some(known)
    }

    fn frames_and_payload(&mut self, file: &RobotFile) {
        for (index, frame) in file.frame.iter().enumerate() {
            self.source(&format!("frame[{index}].source"), &frame.source);
        }
        if let Some(payload) = &file.payload {
            self.source("payload.source", &payload.source);
        }
    }

    fn nominal(&mut self, file: &RobotFile) -> BranchPattern {
        let named = file.nominal_branch.as_deref().map(str::parse::<BranchPattern>);
        match named {
            None => BranchPattern::FRONT_ELBOW_UP,
            Some(Ok(pattern)) => pattern,
            Some(Err(error)) => {
                self.problem("nominal_branch", error.to_string(), "such as \"front elbow-up\"");
                BranchPattern::FRONT_ELBOW_UP
            }
        }
    }

    fn unused_sources(&mut self, file: &RobotFile) {
        let joints = file.joint.iter().flat_map(|joint| {
            [Some(&joint.source), joint.compliance_source.as_ref(), joint.compliance_u_source.as_ref()]
                .into_iter()
                .flatten()
                .chain(joint.other_limits.iter().map(|limits| &limits.source))
        });
        let others = file.frame.iter().map(|frame| &frame.source).chain(file.payload.iter().map(|p| &p.source));
        let used: Vec<&String> = joints.chain(others).chain([&file.chain.source]).collect();
        let unused: Vec<&String> = file.sources.keys().filter(|key| !used.contains(key)).collect();
        for key in unused {
            let message = format!("source `{key}` is used by no number");
            self.problem(&format!("sources.{key}"), message, "name it where its numbers stand, or remove it");
        }
    }
}

/// Degrees to radians; whole quarter turns exactly.
fn exact_radians(degrees: f64) -> f64 {
    degrees / 90.0 * std::f64::consts::FRAC_PI_2
}

#[cfg(test)]
mod tests;
