//! Backlash of the joints in numbers with their units.
//!
//! Angles count from +y' of the plane towards z'; steps are outwards positive, whichever way round.

use armill_core::measure::ballbar::Direction;
use armill_core::measure::ballbar::joints::{Followed, Gap, JointReversal};
use armill_core::robot::Robot;
use serde::Serialize;

use super::circles::CircleAnalysis;
use super::estimate::Estimated;
use crate::file::circles::MeasuredCircle;
use crate::file::resolve::Study;

/// How much play each joint has.
#[derive(Clone, Debug, Serialize)]
pub struct BacklashAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Every circle that was measured, with what turns back on it.
    pub circles: Vec<CircleAnswer>,
    /// Every joint.
    pub joints: Vec<JointAnswer>,
    /// Sets of joints of which these circles tell a sum rather than each.
    pub not_identifiable: Vec<Vec<String>>,
    /// Correlation of the gaps that are told, in the order of `joints`.
    pub correlation_ratio: Vec<Vec<f64>>,
    /// Samples of all circles.
    pub samples: usize,
    /// Root mean square of what place, size and lobes of the circles leave.
    pub rms_before_um: f64,
    /// And of what the gaps leave of that.
    pub rms_after_um: f64,
    /// What a user must know, each a sentence.
    pub warnings: Vec<String>,
}

/// One circle.
#[derive(Clone, Debug, Serialize)]
pub struct CircleAnswer {
    /// Name of the path.
    pub analysis: String,
    /// What was measured on it; empty of one that is proposed.
    pub files: Vec<String>,
    /// Nominal radius.
    pub radius_mm: f64,
    /// Its centre, base.
    pub centre_mm: [f64; 3],
    /// Where joints turn back, by joint, then by angle.
    pub reversals: Vec<ReversalAnswer>,
}

/// A joint turns back.
#[derive(Clone, Debug, Serialize)]
pub struct ReversalAnswer {
    /// Which joint.
    pub joint: String,
    /// Where, both ways round.
    pub at_deg: f64,
    /// How far the radius steps outwards there by the gap that was found; none of a joint that was not told.
    pub step_um: Option<f64>,
    /// Where its link has crossed that gap clockwise; none where it turns back before.
    pub crossed_cw_deg: Option<f64>,
    /// Anticlockwise.
    pub crossed_ccw_deg: Option<f64>,
}

/// One joint.
#[derive(Clone, Debug, Serialize)]
pub struct JointAnswer {
    /// Its name.
    pub joint: String,
    /// `told`, `not told apart` or `does not show`.
    pub state: &'static str,
    /// The gap of a joint that turns.
    pub backlash_deg: Option<f64>,
    /// Its standard uncertainty.
    pub backlash_u_deg: Option<f64>,
    /// The gap of a joint that slides.
    pub backlash_mm: Option<f64>,
    /// Its standard uncertainty.
    pub backlash_u_mm: Option<f64>,
    /// Variance over what it would be if no other joint were looked for; none where it is not seen.
    pub inflation_ratio: Option<f64>,
    /// The gap that the robot file has, of a joint that turns.
    pub robot_file_deg: Option<f64>,
    /// Of a joint that slides.
    pub robot_file_mm: Option<f64>,
}

/// A gap below zero by more than this many standard uncertainties is none.
const BELOW_ZERO: f64 = 2.0;

/// What was found in `study`.
pub(super) fn answer(study: &Study, found: &Estimated<'_>) -> BacklashAnswer {
    let (robot, gaps) = (&study.robot.robot, &found.gaps);
    let name = |joint: usize| robot.joints()[joint].name.clone();
    let names = |set: &Vec<usize>| set.iter().map(|joint| name(*joint)).collect();
    let given = gaps.given.len();
    let correlation = |i: usize, k: usize| gaps.covariance[(i, k)] / (gaps.given[i].u * gaps.given[k].u);
    let mut warnings: Vec<String> = (found.circles.iter())
        .flat_map(|(measured, ..)| measured.notes.clone())
        .collect();
    for (measured, ..) in &found.circles {
        if !measured.test.is_bidirectional() {
            warnings.push(format!(
                "{}: one way round alone: gaps are told from what is smooth by their steps only",
                measured.analysis
            ));
        }
    }
    for set in &gaps.together {
        let names: Vec<String> = set.iter().map(|joint| name(*joint)).collect();
        let alone = if names.len() == 1 { " from the others" } else { "" };
        warnings.push(format!(
            "not told apart by these circles: {}{alone}; `--circles` looks for circles that do",
            names.join(", ")
        ));
    }
    for joint in &gaps.unseen {
        warnings.push(format!(
            "{} does not move the radius on these circles",
            name(*joint)
        ));
    }
    for gap in gaps.given.iter().filter(|gap| gap.gap < -BELOW_ZERO * gap.u) {
        warnings.push(format!(
            "{}: the gap is below zero: its link is ahead of its motor, or the angles of the files are not those of the circle",
            name(gap.joint)
        ));
    }
    BacklashAnswer {
        robot: robot.name().to_owned(),
        circles: (found.circles.iter())
            .map(|(measured, circle, followed)| {
                let given = |joint: usize| gaps.of(joint).copied();
                of_circle(robot, (measured, circle, followed), given)
            })
            .collect(),
        joints: (0..robot.joints().len())
            .map(|joint| of_joint(study, found, joint))
            .collect(),
        not_identifiable: gaps.together.iter().map(names).collect(),
        correlation_ratio: (0..given)
            .map(|i| (0..given).map(|k| correlation(i, k)).collect())
            .collect(),
        samples: gaps.samples,
        rms_before_um: gaps.rms_before * 1e6,
        rms_after_um: gaps.rms_after * 1e6,
        warnings,
    }
}

fn of_circle(
    robot: &Robot,
    (measured, circle, followed): (&MeasuredCircle, &CircleAnalysis<'_>, &Followed),
    given: impl Fn(usize) -> Option<Gap>,
) -> CircleAnswer {
    let centre = circle.centre();
    CircleAnswer {
        analysis: measured.analysis.clone(),
        files: measured.files.clone(),
        radius_mm: followed.radius * 1e3,
        centre_mm: [centre.x, centre.y, centre.z].map(|m| m * 1e3),
        reversals: (followed.reversals.iter())
            .map(|at| of_reversal(robot, (at, followed), given(at.joint)))
            .collect(),
    }
}

fn of_reversal(
    robot: &Robot,
    (at, followed): (&JointReversal, &Followed),
    gap: Option<Gap>,
) -> ReversalAnswer {
    let crossed = |way| gap.and_then(|gap| followed.crossed(at, gap.gap, way));
    ReversalAnswer {
        joint: robot.joints()[at.joint].name.clone(),
        at_deg: at.angle.to_degrees(),
        step_um: gap.map(|gap| followed.step(at, gap.gap) * 1e6),
        crossed_cw_deg: crossed(Direction::Clockwise).map(f64::to_degrees),
        crossed_ccw_deg: crossed(Direction::Anticlockwise).map(f64::to_degrees),
    }
}

fn of_joint(study: &Study, found: &Estimated<'_>, joint: usize) -> JointAnswer {
    let (robot, gaps) = (&study.robot.robot, &found.gaps);
    let slides = robot.slides(joint);
    let given = gaps.of(joint);
    let deg = |value: f64| (!slides).then(|| value.to_degrees());
    let mm = |value: f64| slides.then_some(value * 1e3);
    // All circles are of one robot, so the structure of any tells its file.
    let of_file = found.circles.first().and_then(|(_, circle, _)| {
        let structure = &circle.path.setting.model.structure;
        structure
            .gaps()
            .find(|(of, _)| *of == joint)
            .map(|(_, gap)| gap.gap)
    });
    let inflation = gaps.inflation.iter().find(|(of, _)| *of == joint);
    JointAnswer {
        joint: robot.joints()[joint].name.clone(),
        state: match given {
            Some(_) => "told",
            None if gaps.unseen.contains(&joint) => "does not show",
            None => "not told apart",
        },
        backlash_deg: given.and_then(|gap| deg(gap.gap)),
        backlash_u_deg: given.and_then(|gap| deg(gap.u)),
        backlash_mm: given.and_then(|gap| mm(gap.gap)),
        backlash_u_mm: given.and_then(|gap| mm(gap.u)),
        inflation_ratio: inflation
            .map(|(_, ratio)| *ratio)
            .filter(|ratio| ratio.is_finite()),
        robot_file_deg: of_file.and_then(deg),
        robot_file_mm: of_file.and_then(mm),
    }
}
