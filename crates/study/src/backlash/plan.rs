//! Circles to drive, so that the gaps of all joints are told apart.

use armill_core::measure::ballbar::joints::fit::INFLATION;
use armill_core::measure::ballbar::joints::plan::Known;
use armill_core::measure::ballbar::joints::{Domain, Followed, Normal, PlanAsked, Proposed, propose};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::watch::Watch;
use serde::Serialize;

use super::circles::{circles, followed, question};
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::number::decimals;
use crate::run::runner;

/// How it is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanWanted {
    /// Circles of the study that are driven anyway, the first with the middle of the box; all where none is named.
    pub analyses: Vec<String>,
    /// How many circles more.
    pub count: usize,
    /// Half of the box of centres, m.
    pub half: [f64; 3],
    /// m; that of the first circle, and one and a half of it, where none is named.
    pub radii: Vec<f64>,
    /// Lobes of a circle that are no backlash.
    pub most_lobes: usize,
    /// Standard deviation of a sample, m.
    pub noise: f64,
}

/// Circles to drive.
#[derive(Clone, Debug, Serialize)]
pub struct PlanAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Where centres were looked for: two corners, base.
    pub box_mm: [[f64; 3]; 2],
    /// Centres along each side.
    pub along: usize,
    /// Planes.
    pub planes: Vec<&'static str>,
    /// Radii.
    pub radii_mm: Vec<f64>,
    /// Circles that were looked at.
    pub candidates: usize,
    /// Of these the ones that the arm follows within its limits, in the branch of the study.
    pub followed: usize,
    /// Noise of a sample that uncertainties are told for.
    pub noise_um: f64,
    /// Circles of the study.
    pub begun: Vec<String>,
    /// What these tell.
    pub known: KnownAnswer,
    /// Circles to drive beside them, the one that tells most first.
    pub circles: Vec<ProposedAnswer>,
}

/// A circle to drive.
#[derive(Clone, Debug, Serialize)]
pub struct ProposedAnswer {
    /// Its plane, by two axes of the base.
    pub plane: &'static str,
    /// Base.
    pub centre_mm: [f64; 3],
    /// Turns of the part frame about the fixed axes x, y, z, as `plane.rotation_deg` of a study.
    pub rotation_deg: [f64; 3],
    /// Its radius.
    pub radius_mm: f64,
    /// Joints that turn back on it, each with how often.
    pub reversals: Vec<TurnsAnswer>,
    /// What is known with it and all before.
    pub known: KnownAnswer,
}

/// A joint on a circle.
#[derive(Clone, Debug, Serialize)]
pub struct TurnsAnswer {
    /// Which.
    pub joint: String,
    /// How often it turns back.
    pub times: usize,
}

/// What circles tell.
#[derive(Clone, Debug, Serialize)]
pub struct KnownAnswer {
    /// Joints that are told apart, with the standard uncertainty to expect.
    pub joints: Vec<ExpectedAnswer>,
    /// Sets of joints of which a sum is told.
    pub not_identifiable: Vec<Vec<String>>,
    /// Joints that do not move the radius.
    pub unseen: Vec<String>,
    /// Greatest variance over what it would be if no other joint were looked for; none where a sum alone is seen.
    pub inflation_ratio: Option<f64>,
}

/// One joint.
#[derive(Clone, Debug, Serialize)]
pub struct ExpectedAnswer {
    /// Which.
    pub joint: String,
    /// Standard uncertainty of the gap of a joint that turns.
    pub backlash_u_deg: Option<f64>,
    /// Of a joint that slides.
    pub backlash_u_mm: Option<f64>,
}

/// Centres along each side of the box.
const ALONG: usize = 3;
/// A second radius, of the first.
const WIDER: f64 = 1.5;

/// The circles of which the joints are told apart.
///
/// # Errors
/// No circle in the study to begin with; one that the arm does not follow.
pub fn plan(study: &Study, expected: &PlanWanted, watch: Watch<'_>) -> Result<PlanAnswer, StudyError> {
    let begun = circles(study, &expected.analyses)?;
    let along = (begun.iter())
        .map(|circle| followed(study, circle, Watch::NONE))
        .collect::<Result<Vec<Followed>, _>>()?;
    let first = &begun[0];
    let domain = Domain {
        middle: first.centre(),
        half: Vector3::from(expected.half),
        along: ALONG,
        normals: Normal::ALL.to_vec(),
        radii: match &expected.radii[..] {
            [] => vec![first.circle.radius, WIDER * first.circle.radius],
            given => given.to_vec(),
        },
    };
    let runner = runner(study, watch)?;
    let robot = runner.robot;
    let requested = PlanAsked {
        count: expected.count,
        joints: (0..robot.joints().len()).collect(),
        most_lobes: expected.most_lobes,
        inflation: INFLATION,
        noise: expected.noise,
    };
    let found = propose(
        &question(&runner, first),
        (&domain.candidates(), &along),
        &requested,
        watch,
    )?;
    let corner = |sign: f64| {
        let at = domain.middle + domain.half * sign;
        [at.x, at.y, at.z].map(|m| m * 1e3)
    };
    let mut planes: Vec<&'static str> = domain.normals.iter().map(|normal| normal.plane()).collect();
    planes.dedup();
    Ok(PlanAnswer {
        robot: robot.name().to_owned(),
        box_mm: [corner(-1.0), corner(1.0)],
        along: ALONG,
        planes,
        radii_mm: domain.radii.iter().map(|m| m * 1e3).collect(),
        candidates: found.candidates[0],
        followed: found.candidates[1],
        noise_um: expected.noise * 1e6,
        begun: begun.iter().map(|circle| circle.name.to_owned()).collect(),
        known: known(robot, &found.begun),
        circles: found.circles.iter().map(|one| proposed(robot, one)).collect(),
    })
}

/// How many circles [`plan`] looks at.
///
/// # Errors
/// See [`circles`].
pub fn candidate_count(study: &Study, expected: &PlanWanted) -> Result<usize, StudyError> {
    circles(study, &expected.analyses)?;
    let radii = if expected.radii.is_empty() {
        2
    } else {
        expected.radii.len()
    };
    Ok(ALONG.pow(3) * Normal::ALL.len() * radii)
}

fn proposed(robot: &Robot, one: &Proposed) -> ProposedAnswer {
    let candidate = &one.candidate;
    let (roll, pitch, yaw) = candidate.circle.placing.base_from_path.rotation.euler_angles();
    let times = |joint: usize| {
        let turns = one.followed.reversals.iter();
        turns.filter(|reversal| reversal.joint == joint).count()
    };
    ProposedAnswer {
        plane: candidate.normal.plane(),
        centre_mm: [candidate.centre.x, candidate.centre.y, candidate.centre.z].map(|m| m * 1e3),
        rotation_deg: [roll, pitch, yaw].map(|turn| decimals(turn.to_degrees(), 9)),
        radius_mm: candidate.circle.radius * 1e3,
        reversals: (0..robot.joints().len())
            .map(|joint| TurnsAnswer {
                joint: robot.joints()[joint].name.clone(),
                times: times(joint),
            })
            .filter(|turns| turns.times > 0)
            .collect(),
        known: known(robot, &one.known),
    }
}

fn known(robot: &Robot, known: &Known) -> KnownAnswer {
    let name = |joint: &usize| robot.joints()[*joint].name.clone();
    KnownAnswer {
        joints: (known.given.iter())
            .map(|gap| {
                let slides = robot.slides(gap.joint);
                ExpectedAnswer {
                    joint: name(&gap.joint),
                    backlash_u_deg: (!slides).then(|| gap.u.to_degrees()),
                    backlash_u_mm: slides.then_some(gap.u * 1e3),
                }
            })
            .collect(),
        not_identifiable: (known.together.iter())
            .map(|set| set.iter().map(name).collect())
            .collect(),
        unseen: known.unseen.iter().map(name).collect(),
        inflation_ratio: known.inflation.filter(|ratio| ratio.is_finite()),
    }
}
