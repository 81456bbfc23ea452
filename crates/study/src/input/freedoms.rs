//! `posture.search.lean` and `posture.search.axes`: lean of the tool and external axes that a search may choose along a
//! path.

use std::ops::RangeInclusive;

use armill_core::optimize::{LeanRange, MOST_MOVING, MovingAxis, Steps};
use armill_core::path::RoundedEnd;
use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm, from_per_mm};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::problem_log::ProblemLog;
use crate::joint_unit::JointUnit;

/// Lean of the tool about the programmed axis.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeanTable {
    /// Least and greatest lead, towards the feed; 0 if left out.
    #[schemars(inner(range(min = -80.0, max = 80.0)))]
    pub lead_deg: Option<[f64; 2]>,
    /// Least and greatest tilt, to the left of the feed; 0 if left out.
    #[schemars(inner(range(min = -80.0, max = 80.0)))]
    pub tilt_deg: Option<[f64; 2]>,
    /// Step of either; 2.5 if left out.
    #[schemars(range(min = 0.1, max = 45.0))]
    pub step_deg: Option<f64>,
    /// Largest change of either along the path; 0.5 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub deg_per_mm: Option<f64>,
    /// Distance of neighbouring passes, for the height of the scallops between them.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub stepover_mm: Option<f64>,
    /// The end of the tool, where the study has no cut.
    pub cutter: Option<EndTable>,
}

/// The end of a tool with a rounded corner.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndTable {
    /// Its diameter.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub diameter_mm: f64,
    /// Radius of its corner: half the diameter is a ball nose.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub corner_radius_mm: f64,
}

/// An external axis that moves along the path.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisTable {
    /// Name of its joint: one that carries the robot, or one of the positioner.
    pub joint: String,
    /// First and last position of a prismatic joint; its limits if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub range_mm: Option<[f64; 2]>,
    /// Step between positions; 50 if left out.
    #[schemars(range(min = 0.1, max = 1e4))]
    pub step_mm: Option<f64>,
    /// Largest motion along the path; 1 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub mm_per_mm: Option<f64>,
    /// First and last position of a revolute joint; its limits if left out.
    #[schemars(inner(range(min = -1e4, max = 1e4)))]
    pub range_deg: Option<[f64; 2]>,
    /// Step between positions; 5 if left out.
    #[schemars(range(min = 0.01, max = 360.0))]
    pub step_deg: Option<f64>,
    /// Largest motion along the path; 1 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub deg_per_mm: Option<f64>,
    /// Whether it stands still within a cut and moves between cuts alone.
    #[serde(default)]
    pub still: bool,
}

/// The tool of an analysis, as far as it decides whether it may lean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolEnd {
    /// A cutter: diameter and corner radius, mm.
    Cutter(f64, f64),
    /// A drill.
    Drill,
    /// The study does not give it.
    NotGiven,
}

/// Steps of a lean (deg), of a prismatic (mm) and of a revolute axis (deg) where the study gives none.
const STEPS: (f64, f64, f64) = (2.5, 50.0, 5.0);
/// Change along the path of a lean (deg/mm) and of an external axis (mm/mm, deg/mm) where the study gives none.
const RATES: (f64, f64) = (0.5, 1.0);
/// Most values of an axis.
const MOST: f64 = 2000.0;
/// Rounding of a count of steps.
const ROUNDED: f64 = 1e-9;

/// The lean of this table; `None` where it is wrong, which is reported.
pub(super) fn lean(log: &mut ProblemLog<'_>, table: &LeanTable, tool: ToolEnd) -> Option<LeanRange> {
    let key = "posture.search.lean";
    if table.lead_deg.is_none() && table.tilt_deg.is_none() {
        let message = "neither `lead_deg` nor `tilt_deg` is given";
        log.problem(key, message, "such as lead_deg = [0, 20], tilt_deg = [-15, 15]");
        return None;
    }
    let given = table
        .cutter
        .map(|end| ToolEnd::Cutter(end.diameter_mm, end.corner_radius_mm));
    let (diameter, corner) = match (tool, given) {
        (ToolEnd::Drill, _) => {
            log.problem(key, "a drill does not lean", "remove `lean`");
            return None;
        }
        (ToolEnd::Cutter(..), Some(_)) => {
            let message = "the study has a cutter already";
            log.problem("posture.search.lean.cutter", message, "remove `lean.cutter`");
            return None;
        }
        (ToolEnd::Cutter(diameter, corner), None) | (_, Some(ToolEnd::Cutter(diameter, corner))) => {
            (diameter, corner)
        }
        _ => {
            let hint = "add lean.cutter = { diameter_mm = 12, corner_radius_mm = 6 }, or `cut`";
            log.problem(key, "the end of the tool is not known", hint);
            return None;
        }
    };
    if corner <= 0.0 || 2.0 * corner > diameter * (1.0 + ROUNDED) {
        let message = format!(
            "a tool of {diameter} mm with a corner radius of {corner} mm cannot lean: only a rounded corner can touch the surface"
        );
        let hint = "a ball or bull nose: a corner radius above 0, up to half the diameter";
        log.problem(key, message, hint);
        return None;
    }
    let step = table.step_deg.unwrap_or(STEPS.0);
    let mut of = |name: &str, range: Option<[f64; 2]>| match range {
        None => Some(Steps::one(0.0)),
        Some(range) => steps(log, &format!("{key}.{name}"), range, step, from_deg),
    };
    let leads = of("lead_deg", table.lead_deg);
    let tilts = of("tilt_deg", table.tilt_deg);
    Some(LeanRange {
        leads: leads?,
        tilts: tilts?,
        rate: from_per_mm(from_deg(table.deg_per_mm.unwrap_or(RATES.0))),
        end: RoundedEnd {
            radius: from_mm(0.5 * diameter),
            corner: from_mm(corner),
        },
        stepover: table.stepover_mm.map(from_mm),
    })
}

/// The external axes of these tables; `None` where one is wrong, which is reported.
pub(super) fn axes(log: &mut ProblemLog<'_>, tables: &[AxisTable], robot: &Robot) -> Option<Vec<MovingAxis>> {
    if tables.len() > MOST_MOVING {
        let message = format!("{} axes move along the path", tables.len());
        log.problem("posture.search.axes", message, &format!("at most {MOST_MOVING}"));
        return None;
    }
    let found: Vec<_> = tables
        .iter()
        .enumerate()
        .map(|(index, table)| {
            let key = format!("posture.search.axes[{index}]");
            let twice = tables[..index].iter().any(|other| other.joint == table.joint);
            if twice {
                let message = format!("joint `{}` is given twice", table.joint);
                log.problem(&format!("{key}.joint"), message, "one entry for each axis");
                return None;
            }
            axis(log, &key, table, robot)
        })
        .collect();
    found.into_iter().collect()
}

fn axis(log: &mut ProblemLog<'_>, key: &str, table: &AxisTable, robot: &Robot) -> Option<MovingAxis> {
    let joint = external_joint(log, key, table, robot)?;
    let unit = JointUnit::of(robot, joint);
    let (own, other) = match robot.slides(joint) {
        true => (table.in_mm(), table.in_deg()),
        false => (table.in_deg(), table.in_mm()),
    };
    if let Some(given) = other.given() {
        let kind = if robot.slides(joint) {
            "prismatic"
        } else {
            "revolute"
        };
        let message = format!(
            "joint `{}` is {kind}: its positions are in {}",
            table.joint, unit.name
        );
        let hint = format!("{} = ... in place of {given}", own.names[other.place_of(given)]);
        log.problem(&format!("{key}.{given}"), message, &hint);
        return None;
    }
    let range = range_inside(
        log,
        &format!("{key}.{}", own.names[0]),
        table,
        (own, robot, joint),
    )?;
    let step = own.step.unwrap_or(own.default_step);
    Some(MovingAxis {
        joint,
        positions: steps(log, &format!("{key}.{}", own.names[0]), range, step, |value| {
            unit.to_si(value)
        })?,
        rate: own.rate(),
        still: table.still,
    })
}

/// The keys of an axis in one unit.
#[derive(Clone, Copy)]
struct AxisKeys {
    names: [&'static str; 3],
    range: Option<[f64; 2]>,
    step: Option<f64>,
    per_mm: Option<f64>,
    default_step: f64,
    /// Rate in SI of one unit per mm.
    unit_per_mm: f64,
}

impl AxisTable {
    fn in_mm(&self) -> AxisKeys {
        AxisKeys {
            names: ["range_mm", "step_mm", "mm_per_mm"],
            range: self.range_mm,
            step: self.step_mm,
            per_mm: self.mm_per_mm,
            default_step: STEPS.1,
            unit_per_mm: 1.0,
        }
    }

    fn in_deg(&self) -> AxisKeys {
        AxisKeys {
            names: ["range_deg", "step_deg", "deg_per_mm"],
            range: self.range_deg,
            step: self.step_deg,
            per_mm: self.deg_per_mm,
            default_step: STEPS.2,
            unit_per_mm: from_per_mm(from_deg(1.0)),
        }
    }
}

impl AxisKeys {
    /// The first of these keys that the table gives.
    fn given(&self) -> Option<&'static str> {
        let given = [self.range.is_some(), self.step.is_some(), self.per_mm.is_some()];
        let mut names = self.names.into_iter().zip(given);
        names.find(|(_, given)| *given).map(|(name, _)| name)
    }

    fn place_of(&self, name: &str) -> usize {
        self.names.iter().position(|own| *own == name).unwrap_or_default()
    }

    /// Largest motion along the path, m/m (rad/m).
    fn rate(&self) -> f64 {
        self.per_mm.unwrap_or(RATES.1) * self.unit_per_mm
    }
}

/// The external axis of this name.
fn external_joint(log: &mut ProblemLog<'_>, key: &str, table: &AxisTable, robot: &Robot) -> Option<usize> {
    let found = robot.joints().iter().position(|joint| joint.name == table.joint);
    let external = found.filter(|joint| robot.is_external(*joint));
    if external.is_some() {
        return external;
    }
    let message = match found {
        Some(_) => format!(
            "joint `{}` of robot `{}` is not an external axis",
            table.joint,
            robot.name()
        ),
        None => format!("robot `{}` has no joint `{}`", robot.name(), table.joint),
    };
    let names: Vec<&str> = robot
        .external_axes()
        .map(|joint| robot.joints()[joint].name.as_str())
        .collect();
    let hint = match names.is_empty() {
        true => {
            "an external axis is a joint of `[positioner]`, or one in front of the six of the robot: a prismatic one, or \
             one with external = true in the robot file; this robot has none"
                .to_owned()
        }
        false => format!("its external axes: {}", names.join(", ")),
    };
    log.problem(&format!("{key}.joint"), message, &hint);
    None
}

/// The range of an axis in its own unit, inside the limits of its joint.
fn range_inside(
    log: &mut ProblemLog<'_>,
    key: &str,
    table: &AxisTable,
    (own, robot, joint): (AxisKeys, &Robot, usize),
) -> Option<[f64; 2]> {
    let unit = JointUnit::of(robot, joint);
    let limits = robot.joints()[joint].limits;
    let limits = limits.map(|limits| [limits.lower, limits.upper].map(|limit| limit * unit.scale));
    match (own.range, limits) {
        (Some([first, last]), Some([lower, upper])) => {
            if first < lower - ROUNDED || last > upper + ROUNDED {
                let message = format!(
                    "the range from {first} to {last} {unit} is not inside the limits of joint `{}`, {} to {} {unit}",
                    table.joint,
                    tidy(lower),
                    tidy(upper),
                    unit = unit.name
                );
                log.problem(key, message, "bounds inside those of the joint");
                return None;
            }
            Some([first, last])
        }
        (Some(range), None) => Some(range),
        (None, Some(limits)) => Some(limits.map(tidy)),
        (None, None) => {
            let message = format!("joint `{}` has no limits", table.joint);
            let hint = match robot.slides(joint) {
                true => "give range_mm = [0, 3000]",
                false => "give range_deg = [-180, 180]",
            };
            log.problem(key, message, hint);
            None
        }
    }
}

/// A limit without the rounding of its conversion to SI and back.
fn tidy(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// Values from the first to at most the last of a range.
fn steps(
    log: &mut ProblemLog<'_>,
    key: &str,
    [first, last]: [f64; 2],
    step: f64,
    to_si: impl Fn(f64) -> f64,
) -> Option<Steps> {
    let count = ((last - first) / step + ROUNDED).floor() + 1.0;
    let permitted: RangeInclusive<f64> = 1.0..=MOST;
    if !permitted.contains(&count) {
        let (message, hint) = match first > last {
            true => (
                format!("the range goes from {first} to {last}"),
                "the least value, then the greatest".to_owned(),
            ),
            false => (
                format!("the range from {first} to {last} has {count} steps"),
                format!("a larger step: at most {MOST}"),
            ),
        };
        log.problem(key, message, &hint);
        return None;
    }
    Some(Steps {
        first: to_si(first),
        step: to_si(step),
        count: count as usize,
    })
}
