//! What no schema can say of a robot file, and its numbers in SI.
//!
//! Each part of the file becomes its part of the robot; what is wrong is added to the problems, and the part is then
//! treated as not given, so that the rest is still checked. Nothing is used of a file with problems. That every
//! source is named and known is checked for all parts at once, by [`sources`](crate::sources).
//!
//! - The chain names every joint once, in the order of `[[joint]]`; names differ.
//! - A motion is `along` or `about` an axis, by exactly one of length, angle and joint.
//! - Rotations are given in degrees, translations in mm; a coupling names an earlier joint.
//! - All joints have a compliance, or none has: one left out is not taken for rigid. A compliance has a source.
//!
//! In SI: m, rad, rad/(N m), m/N; speeds in m/s and rad/s.

use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::{Amount, BranchPattern, Joint, JointCompliance, Limits, Motion, TorqueCurve};
use armill_core::units::{from_deg, from_mm};

use super::file::{JointEntry, MotionEntry, RobotFile};
use crate::document::{Document, Problem};

/// The file, and what was wrong with it so far.
pub(super) struct Checks<'a> {
    /// Finds places by path.
    pub document: &'a Document,
    /// In the order in which they were found.
    pub problems: Vec<Problem>,
}

impl Checks<'_> {
    /// Keeps a problem at the value that `path` names.
    pub(super) fn problem(&mut self, path: &str, message: impl Into<String>, hint: &str) {
        self.problems
            .push(self.document.problem(path, message, Some(hint)));
    }

    /// The chain, base to flange; every joint moves once, in the order of the tables.
    ///
    /// That a joint never moves is reported only where nothing else is wrong: a motion that was refused may have been
    /// its own.
    pub(super) fn motions(&mut self, file: &RobotFile) -> Vec<Motion> {
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

    /// One motion of the chain; `used` joints have moved before it.
    ///
    /// `None` where it is refused; the problem then is at `path`.
    fn motion(
        &mut self,
        path: &str,
        entry: &MotionEntry,
        file: &RobotFile,
        used: &mut usize,
    ) -> Option<Motion> {
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
            (Some(length), None, None) if !turns => Amount::Constant(from_mm(length)),
            (None, Some(angle), None) if turns => Amount::Constant(from_deg(angle)),
            (None, None, Some(name)) => Amount::Joint(self.next_joint(path, name, file, used)?),
            _ => {
                let hint = "`along` takes `length_mm` or `joint`, `about` takes `angle_deg` or `joint`";
                self.problem(
                    path,
                    "an elementary motion has exactly one of length, angle and joint",
                    hint,
                );
                return None;
            }
        };
        let axis = axis.axis();
        Some(if turns {
            Motion::About(axis, amount)
        } else {
            Motion::Along(axis, amount)
        })
    }

    /// The index of the joint called `name`, which must be the next that has not moved.
    fn next_joint(&mut self, path: &str, name: &str, file: &RobotFile, used: &mut usize) -> Option<usize> {
        let expected = file.joint.get(*used).map(|joint| joint.name.as_str());
        if expected == Some(name) {
            *used += 1;
            return Some(*used - 1);
        }
        let message = match expected {
            Some(expected) => format!("joint `{name}` is where `{expected}` is expected"),
            None => format!("joint `{name}` has no table [[joint]] of its own"),
        };
        self.problem(
            &format!("{path}.joint"),
            message,
            "joints appear once each, in the order of the [[joint]] tables",
        );
        None
    }

    /// The joints as the controller shows their positions.
    ///
    /// Always as many as there are tables, so that indices stay right: a joint whose part is wrong is kept without
    /// it.
    pub(super) fn joints(&mut self, file: &RobotFile) -> Vec<Joint> {
        if file.joint.is_empty() {
            self.problem(
                "chain",
                "the chain has no joint",
                "add [[joint]] tables and name them in `motions`",
            );
        }
        let mut joints = Vec::new();
        for (index, entry) in file.joint.iter().enumerate() {
            let path = format!("joint[{index}]");
            if file.joint[..index]
                .iter()
                .any(|earlier| earlier.name == entry.name)
            {
                let message = format!("another joint is called `{}`", entry.name);
                self.problem(
                    &format!("{path}.name"),
                    message,
                    "each joint needs a name of its own",
                );
            }
            self.units(&path, entry, &file.chain.motions);
            if entry.sign == 0 {
                self.problem(
                    &format!("{path}.sign"),
                    format!("joint {}: sign 0", entry.name),
                    "write 1 or -1",
                );
            }
            if entry.external && !file.joint[..index].iter().all(|before| before.external) {
                let message = format!("joint `{}` is behind a joint of the arm", entry.name);
                let hint = "external axes are the first joints of the robot";
                self.problem(&format!("{path}.external"), message, hint);
            }
            joints.push(Joint {
                name: entry.name.clone(),
                sign: if entry.sign < 0 {
                    Sign::Negative
                } else {
                    Sign::Positive
                },
                zero_offset: entry.zero_offset_deg.map_or(0.0, from_deg)
                    + entry.zero_offset_mm.map_or(0.0, from_mm),
                coupling: self.coupling(&path, entry, &file.joint[..index]),
                limits: self.limits(&path, entry),
                max_speed: entry
                    .max_speed_deg_per_s
                    .map(from_deg)
                    .or(entry.max_speed_mm_per_s.map(from_mm)),
            });
        }
        joints
    }

    /// A revolute joint is given in degrees, a prismatic one in millimetres.
    ///
    /// Decided by the motion that names the joint; a joint that no motion names is reported as such elsewhere.
    fn units(&mut self, path: &str, entry: &JointEntry, motions: &[MotionEntry]) {
        let motion = motions
            .iter()
            .find(|motion| motion.joint.as_ref() == Some(&entry.name));
        let Some(slides) = motion.map(|motion| motion.along.is_some()) else {
            return;
        };
        // In degrees or in millimetres, for each quantity.
        let quantities = [
            [
                ("zero_offset_deg", entry.zero_offset_deg.is_some()),
                ("zero_offset_mm", entry.zero_offset_mm.is_some()),
            ],
            [
                ("limits_deg", entry.limits_deg.is_some()),
                ("limits_mm", entry.limits_mm.is_some()),
            ],
            [
                ("max_speed_deg_per_s", entry.max_speed_deg_per_s.is_some()),
                ("max_speed_mm_per_s", entry.max_speed_mm_per_s.is_some()),
            ],
            [
                ("compliance_rad_per_n_m", entry.compliance_rad_per_n_m.is_some()),
                ("compliance_um_per_n", entry.compliance_um_per_n.is_some()),
            ],
            [
                (
                    "compliance_u_rad_per_n_m",
                    entry.compliance_u_rad_per_n_m.is_some(),
                ),
                ("compliance_u_um_per_n", entry.compliance_u_um_per_n.is_some()),
            ],
            [
                ("backlash_deg", entry.backlash_deg.is_some()),
                ("backlash_mm", entry.backlash_mm.is_some()),
            ],
            [
                ("backlash_u_deg", entry.backlash_u_deg.is_some()),
                ("backlash_u_mm", entry.backlash_u_mm.is_some()),
            ],
        ];
        let does = if slides { "slides" } else { "turns" };
        let mut refuse = |key: &str, hint: &str| {
            let message = format!("joint {} {does}: `{key}` does not fit it", entry.name);
            self.problem(&format!("{path}.{key}"), message, hint);
        };
        for [turning, sliding] in quantities {
            let ((wrong, given), (right, _)) = if slides {
                (turning, sliding)
            } else {
                (sliding, turning)
            };
            if given {
                refuse(wrong, &format!("write `{right}`"));
            }
        }
        if slides && entry.torque_curve_n_m_rad.is_some() {
            refuse("torque_curve_n_m_rad", "give it `compliance_um_per_n` instead");
        }
    }

    /// What `earlier` joints add to the count of this one.
    fn coupling(&mut self, path: &str, entry: &JointEntry, earlier: &[JointEntry]) -> Vec<Coupling> {
        let mut coupling = Vec::new();
        for (index, c) in entry.coupling.iter().enumerate() {
            match earlier.iter().position(|joint| joint.name == c.joint) {
                Some(joint) => coupling.push(Coupling {
                    joint,
                    factor: c.factor,
                }),
                None => {
                    let message = format!("joint {}: `{}` is not an earlier joint", entry.name, c.joint);
                    let hint = "only an earlier joint can add to a joint's position";
                    self.problem(&format!("{path}.coupling[{index}].joint"), message, hint);
                }
            }
        }
        coupling
    }

    /// Limits in rad or m.
    fn limits(&mut self, path: &str, entry: &JointEntry) -> Option<Limits> {
        let (limits, key, unit) = match (entry.limits_deg, entry.limits_mm) {
            (Some(deg), _) => (deg, "limits_deg", "deg"),
            (None, Some(mm)) => (mm, "limits_mm", "mm"),
            (None, None) => return None,
        };
        let [lower, upper] = limits;
        if lower >= upper {
            let message = format!(
                "joint {}: lower limit {lower} {unit} is not below upper limit {upper} {unit}",
                entry.name
            );
            self.problem(&format!("{path}.{key}"), message, "write [lower, upper]");
            return None;
        }
        let to_si = |value: f64| {
            if unit == "deg" {
                from_deg(value)
            } else {
                from_mm(value)
            }
        };
        Some(Limits {
            lower: to_si(lower),
            upper: to_si(upper),
        })
    }

    /// The compliance of every joint's drive, or `None` where the file gives none at all.
    ///
    /// rad/(N m), or m/N for a prismatic joint. Standard uncertainties that are not given are zero. `None` also where
    /// some joints have one and others have none, which is a problem of its own.
    pub(super) fn compliance(&mut self, file: &RobotFile) -> Option<Vec<JointCompliance>> {
        let mut known = Vec::new();
        for (index, entry) in file.joint.iter().enumerate() {
            let path = format!("joint[{index}]");
            // Where a torque curve replaces a compliance, its slope without load is given instead.
            let points = entry.torque_curve_n_m_rad.clone();
            let curve = points.and_then(|points| TorqueCurve::new(points).ok());
            let value = entry.compliance();
            if value.is_some() && entry.torque_curve_n_m_rad.is_some() {
                let message = format!("joint {}: both a compliance and a torque curve", entry.name);
                let hint = "keep one; `compliance_u_rad_per_n_m` stays with either";
                self.problem(&format!("{path}.torque_curve_n_m_rad"), message, hint);
            }
            let value = value.or(curve.map(|curve| curve.slope(0.0)));
            match (value, &entry.compliance_source) {
                (Some(value), Some(_)) => {
                    known.push(JointCompliance {
                        value,
                        standard_uncertainty: entry.compliance_uncertainty(),
                    });
                }
                (Some(_), None) => {
                    let message = format!("joint {}: its compliance names no source", entry.name);
                    self.problem(&path, message, "add compliance_source = \"...\"");
                }
                (None, _) => {}
            }
        }
        if !known.is_empty() && known.len() < file.joint.len() {
            let message = format!("{} of {} joints have a compliance", known.len(), file.joint.len());
            self.problem("joint", message, "give all of them (0 for a rigid joint) or none");
        }
        (known.len() == file.joint.len()).then_some(known)
    }

    /// The default branch of the robot.
    ///
    /// Front and elbow up where the file does not say.
    pub(super) fn nominal(&mut self, file: &RobotFile) -> BranchPattern {
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
}
