//! `posture.search.lean` and `posture.search.axes`: lean of the tool and external axes that a search may choose along a
//! path.

use std::ops::RangeInclusive;

use armill_core::optimize::{LeanRange, MOST_MOVING, MovingAxis, Steps};
use armill_core::path::RoundedEnd;
use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm, from_per_mm, to_mm};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::problem_log::ProblemLog;

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
    /// Name of its joint in the robot file: a prismatic joint that carries the robot.
    pub joint: String,
    /// First and last position; the limits of the joint if left out.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub range_mm: Option<[f64; 2]>,
    /// Step between positions; 50 if left out.
    #[schemars(range(min = 0.1, max = 1e4))]
    pub step_mm: Option<f64>,
    /// Largest motion along the path; 1 if left out.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub mm_per_mm: Option<f64>,
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

/// Steps of a lean and of a rail where the study gives none.
const STEPS: (f64, f64) = (2.5, 50.0);
/// Change along the path of a lean (deg/mm) and of a rail (mm/mm) where the study gives none.
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
    let names = |external: bool| {
        let joints = robot.joints().iter().enumerate();
        let named = joints.filter(move |(joint, _)| !external || robot.is_external(*joint));
        named.map(|(_, joint)| joint.name.as_str()).collect::<Vec<_>>()
    };
    let found = robot.joints().iter().position(|joint| joint.name == table.joint);
    let external = found.filter(|joint| robot.is_external(*joint));
    let Some(joint) = external else {
        let message = match found {
            Some(_) => format!(
                "joint `{}` of robot `{}` is not an external axis",
                table.joint,
                robot.name()
            ),
            None => format!("robot `{}` has no joint `{}`", robot.name(), table.joint),
        };
        let hint = match names(true) {
            external if external.is_empty() => {
                "an external axis is a prismatic joint in front of the six of the robot; this robot has none"
                    .to_owned()
            }
            external => format!("its external axes: {}", external.join(", ")),
        };
        log.problem(&format!("{key}.joint"), message, &hint);
        return None;
    };
    let limits = robot.joints()[joint].limits;
    let range = match (table.range_mm, limits) {
        (Some([first, last]), Some(limits)) => {
            let [lower, upper] = [limits.lower, limits.upper].map(to_mm);
            let outside = first < lower - ROUNDED || last > upper + ROUNDED;
            if outside {
                let message = format!(
                    "the range from {first} to {last} mm is not inside the limits of joint `{}`, {lower} to {upper} mm",
                    table.joint
                );
                log.problem(
                    &format!("{key}.range_mm"),
                    message,
                    "bounds inside those of the joint",
                );
                return None;
            }
            [first, last]
        }
        (Some(range), None) => range,
        (None, Some(limits)) => [limits.lower, limits.upper].map(to_mm),
        (None, None) => {
            let message = format!("joint `{}` has no limits", table.joint);
            log.problem(key, message, "give range_mm = [0, 3000]");
            return None;
        }
    };
    let step = table.step_mm.unwrap_or(STEPS.1);
    Some(MovingAxis {
        joint,
        positions: steps(log, &format!("{key}.range_mm"), range, step, from_mm)?,
        rate: table.mm_per_mm.unwrap_or(RATES.1),
        still: table.still,
    })
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
