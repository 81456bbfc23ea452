//! Backlash of the joints in numbers with their units.
//!
//! Angles are from +y' of the plane towards z'; steps are positive outwards, in both directions.

use armill_core::measure::ballbar::Direction;
use armill_core::measure::ballbar::joints::{EstimatedBacklash, Followed, JointReversal};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use armill_study::file::resolve::Study;
use serde::Serialize;

use super::circles::{BacklashEstimate, FollowedCircle};
use crate::data_check::SlipAnswer;

/// Backlash of each joint.
#[derive(Clone, Debug, Serialize)]
pub struct BacklashAnswer {
    /// Name of the robot.
    pub robot: String,
    /// All measured circles, with the joints that reverse on them.
    pub circles: Vec<CircleAnswer>,
    /// Every joint.
    pub joints: Vec<JointAnswer>,
    /// Sets of joints for which these circles only determine a sum.
    pub not_identifiable: Vec<Vec<String>>,
    /// Correlation of the identified backlashes, in the order of `joints`.
    pub correlation_ratio: Vec<Vec<f64>>,
    /// Samples of all circles.
    pub samples: usize,
    /// Root mean square residual of centre, radius and lobes of the circles.
    pub rms_before_um: f64,
    /// The same with backlash fitted too.
    pub rms_after_um: f64,
    /// The likely slip in the angles of the files.
    pub slip: Option<SlipAnswer>,
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
    /// Reversals, by joint, then by angle.
    pub reversals: Vec<ReversalAnswer>,
}

/// A reversal of a joint.
#[derive(Clone, Debug, Serialize)]
pub struct ReversalAnswer {
    /// Which joint.
    pub joint: String,
    /// Its angle, in both directions.
    pub at_deg: f64,
    /// Outward step of the radius there by the estimated backlash; none for a joint that was not identified.
    pub step_um: Option<f64>,
    /// Angle at which the link has crossed the backlash clockwise; none if the joint reverses before.
    pub crossed_cw_deg: Option<f64>,
    /// Anticlockwise.
    pub crossed_ccw_deg: Option<f64>,
}

/// One joint.
#[derive(Clone, Debug, Serialize)]
pub struct JointAnswer {
    /// Its name.
    pub joint: String,
    /// `identified`, `not separable` or `no effect`.
    pub state: &'static str,
    /// The backlash of a revolute joint.
    pub backlash_deg: Option<f64>,
    /// Its standard uncertainty.
    pub backlash_u_deg: Option<f64>,
    /// The backlash of a prismatic joint.
    pub backlash_mm: Option<f64>,
    /// Its standard uncertainty.
    pub backlash_u_mm: Option<f64>,
    /// Variance relative to that if no other joint were estimated; none if the joint has no effect.
    pub inflation_ratio: Option<f64>,
    /// The backlash in the robot file, of a revolute joint.
    pub robot_file_deg: Option<f64>,
    /// For a prismatic joint.
    pub robot_file_mm: Option<f64>,
}

/// A backlash below zero by more than this many standard uncertainties is not plausible.
const BELOW_ZERO: f64 = 2.0;

/// The estimate for `study`.
pub(super) fn answer(study: &Study, found: &BacklashEstimate<'_>) -> BacklashAnswer {
    let (robot, gaps) = (&study.robot.robot, &found.gaps);
    let name = |joint: usize| robot.joints()[joint].name.clone();
    let names = |set: &Vec<usize>| set.iter().map(|joint| name(*joint)).collect();
    let given = gaps.estimates.len();
    let correlation =
        |i: usize, k: usize| gaps.covariance[(i, k)] / (gaps.estimates[i].u * gaps.estimates[k].u);
    let mut warnings: Vec<String> = (found.circles.iter())
        .flat_map(|of| of.measured.notes.clone())
        .collect();
    for FollowedCircle { measured, .. } in &found.circles {
        if !measured.test.is_bidirectional() {
            warnings.push(format!(
                "{}: only one direction: backlash is separated from smooth deviations only by its steps",
                measured.analysis
            ));
        }
    }
    for set in &gaps.together {
        let names: Vec<String> = set.iter().map(|joint| name(*joint)).collect();
        let alone = if names.len() == 1 { " from the others" } else { "" };
        warnings.push(format!(
            "not separable by these circles: {}{alone}; `--circles` searches for circles that separate them",
            names.join(", ")
        ));
    }
    for joint in &gaps.unseen {
        warnings.push(format!(
            "{} has no effect on the radius on these circles",
            name(*joint)
        ));
    }
    for gap in gaps.estimates.iter().filter(|gap| gap.gap < -BELOW_ZERO * gap.u) {
        warnings.push(format!(
            "{}: the backlash is below zero: check the angles of the files (zero_deg, mirrored), their direction and the sign of the radii, or the link is ahead of its motor",
            name(gap.joint)
        ));
    }
    BacklashAnswer {
        robot: robot.name().to_owned(),
        circles: (found.circles.iter())
            .map(|of| of_circle(robot, of, |joint: usize| gaps.of(joint).copied()))
            .collect(),
        joints: (0..robot.joints().len())
            .map(|joint| of_joint(study, found, joint))
            .collect(),
        not_identifiable: gaps.together.iter().map(names).collect(),
        correlation_ratio: (0..given)
            .map(|i| (0..given).map(|k| correlation(i, k)).collect())
            .collect(),
        samples: gaps.samples,
        rms_before_um: to_um(gaps.rms_before),
        rms_after_um: to_um(gaps.rms_after),
        slip: None,
        warnings,
    }
}

fn of_circle(
    robot: &Robot,
    of: &FollowedCircle<'_>,
    given: impl Fn(usize) -> Option<EstimatedBacklash>,
) -> CircleAnswer {
    let (measured, followed) = (of.measured, &of.followed);
    let centre = of.circle.centre();
    CircleAnswer {
        analysis: measured.analysis.clone(),
        files: measured.files.clone(),
        radius_mm: to_mm(followed.radius),
        centre_mm: [centre.x, centre.y, centre.z].map(to_mm),
        reversals: (followed.reversals.iter())
            .map(|at| of_reversal(robot, at, followed, given(at.joint)))
            .collect(),
    }
}

fn of_reversal(
    robot: &Robot,
    at: &JointReversal,
    followed: &Followed,
    gap: Option<EstimatedBacklash>,
) -> ReversalAnswer {
    let crossed = |way| gap.and_then(|gap| followed.crossed(at, gap.gap, way));
    ReversalAnswer {
        joint: robot.joints()[at.joint].name.clone(),
        at_deg: to_deg(at.angle),
        step_um: gap.map(|gap| to_um(followed.step(at, gap.gap))),
        crossed_cw_deg: crossed(Direction::Clockwise).map(to_deg),
        crossed_ccw_deg: crossed(Direction::Anticlockwise).map(to_deg),
    }
}

fn of_joint(study: &Study, found: &BacklashEstimate<'_>, joint: usize) -> JointAnswer {
    let (robot, gaps) = (&study.robot.robot, &found.gaps);
    let slides = robot.slides(joint);
    let given = gaps.of(joint);
    let deg = |value: f64| (!slides).then(|| to_deg(value));
    let mm = |value: f64| slides.then_some(to_mm(value));
    // All circles are of one robot; any of them determines the structure.
    let of_file = found.circles.first().and_then(|of| {
        let structure = &of.circle.path.setting.model.structure;
        structure
            .joints_with_backlash()
            .find(|(of, _)| *of == joint)
            .map(|(_, gap)| gap.gap)
    });
    let inflation = gaps.inflation.iter().find(|(of, _)| *of == joint);
    JointAnswer {
        joint: robot.joints()[joint].name.clone(),
        state: match given {
            Some(_) => "identified",
            None if gaps.unseen.contains(&joint) => "no effect",
            None => "not separable",
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
