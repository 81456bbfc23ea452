//! Plans of circles by which the backlash of all joints can be separated.

use armill_core::measure::ballbar::joints::fit::INFLATION;
use armill_core::measure::ballbar::joints::plan::ExpectedUncertainty;
use armill_core::measure::ballbar::joints::{CirclePlanOptions, Domain, Followed, Normal, Proposed, propose};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use armill_core::watch::Watch;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::number::decimals;
use serde::Serialize;

use super::circles::{circles, followed, question};

/// Options of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanOptions {
    /// Circles of the study that are measured in any case, the first at the centre of the box; all if none is named.
    pub analyses: Vec<String>,
    /// Number of additional circles.
    pub count: usize,
    /// Half the size of the box of centres, m.
    pub half: [f64; 3],
    /// m; that of the first circle and 1.5 times it, if empty.
    pub radii: Vec<f64>,
    /// Lobes of a circle that are not caused by backlash.
    pub most_lobes: usize,
    /// Standard deviation of a sample, m.
    pub noise: f64,
}

/// Circles to measure.
#[derive(Clone, Debug, Serialize)]
pub struct PlanAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Box in which centres were searched: two corners, base.
    pub box_mm: [[f64; 3]; 2],
    /// Centres along each side.
    pub along: usize,
    /// Planes.
    pub planes: Vec<&'static str>,
    /// Radii.
    pub radii_mm: Vec<f64>,
    /// Number of circles searched.
    pub candidates: usize,
    /// Number of these that the robot can follow within its joint limits, in the branch of the study.
    pub followed: usize,
    /// Noise of a sample for the expected uncertainties.
    pub noise_um: f64,
    /// Circles of the study.
    pub begun: Vec<String>,
    /// What these determine.
    pub known: IdentifiabilityAnswer,
    /// Additional circles, the most informative first.
    pub circles: Vec<ProposedAnswer>,
}

/// A circle to drive.
#[derive(Clone, Debug, Serialize)]
pub struct ProposedAnswer {
    /// Its plane, by two axes of the base.
    pub plane: &'static str,
    /// Base.
    pub centre_mm: [f64; 3],
    /// Rotations of the part frame about the fixed axes x, y, z, as `plane.rotation_deg` of a study.
    pub rotation_deg: [f64; 3],
    /// Its radius.
    pub radius_mm: f64,
    /// Joints that reverse on it, each with the number of reversals.
    pub reversals: Vec<TurnsAnswer>,
    /// What is known with it and all before.
    pub known: IdentifiabilityAnswer,
}

/// A joint on a circle.
#[derive(Clone, Debug, Serialize)]
pub struct TurnsAnswer {
    /// Which.
    pub joint: String,
    /// Number of its reversals.
    pub times: usize,
}

/// What circles determine.
#[derive(Clone, Debug, Serialize)]
pub struct IdentifiabilityAnswer {
    /// Joints that are identified, with the expected standard uncertainty.
    pub joints: Vec<ExpectedAnswer>,
    /// Sets of joints of which only a sum is determined.
    pub not_identifiable: Vec<Vec<String>>,
    /// Joints that do not move the radius.
    pub unseen: Vec<String>,
    /// Greatest variance relative to that if no other joint were estimated; none if only a sum is determined.
    pub inflation_ratio: Option<f64>,
}

/// One joint.
#[derive(Clone, Debug, Serialize)]
pub struct ExpectedAnswer {
    /// Which.
    pub joint: String,
    /// Standard uncertainty of the backlash of a revolute joint.
    pub backlash_u_deg: Option<f64>,
    /// For a prismatic joint.
    pub backlash_u_mm: Option<f64>,
}

/// Centres along each side of the box.
const ALONG: usize = 3;
/// A second radius, of the first.
const WIDER: f64 = 1.5;

/// The circles that separate the joints.
///
/// # Errors
/// No circle in the study; one that the robot cannot follow.
pub fn plan(study: &Study, expected: &PlanOptions, watch: Watch<'_>) -> Result<PlanAnswer, StudyError> {
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
    let runner = Runner::new(&study.robot.robot, watch)?;
    let robot = runner.robot;
    let requested = CirclePlanOptions {
        count: expected.count,
        joints: (0..robot.joints().len()).collect(),
        most_lobes: expected.most_lobes,
        inflation: INFLATION,
        noise: expected.noise,
    };
    let found = propose(
        &question(&runner, first),
        &domain.candidates(),
        &along,
        &requested,
        watch,
    )?;
    let corner = |sign: f64| {
        let at = domain.middle + domain.half * sign;
        [at.x, at.y, at.z].map(to_mm)
    };
    let mut planes: Vec<&'static str> = domain.normals.iter().map(|normal| normal.plane()).collect();
    planes.dedup();
    Ok(PlanAnswer {
        robot: robot.name().to_owned(),
        box_mm: [corner(-1.0), corner(1.0)],
        along: ALONG,
        planes,
        radii_mm: domain.radii.iter().map(to_mm).collect(),
        candidates: found.candidates[0],
        followed: found.candidates[1],
        noise_um: to_um(expected.noise),
        begun: begun.iter().map(|circle| circle.name.to_owned()).collect(),
        known: known(robot, &found.begun),
        circles: found.circles.iter().map(|one| proposed(robot, one)).collect(),
    })
}

/// How many circles [`plan`] looks at.
///
/// # Errors
/// See [`circles`].
pub fn candidate_count(study: &Study, expected: &PlanOptions) -> Result<usize, StudyError> {
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
        centre_mm: [candidate.centre.x, candidate.centre.y, candidate.centre.z].map(to_mm),
        rotation_deg: [roll, pitch, yaw].map(|turn| decimals(to_deg(turn), 9)),
        radius_mm: to_mm(candidate.circle.radius),
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

fn known(robot: &Robot, known: &ExpectedUncertainty) -> IdentifiabilityAnswer {
    let name = |joint: &usize| robot.joints()[*joint].name.clone();
    IdentifiabilityAnswer {
        joints: (known.estimates.iter())
            .map(|gap| {
                let slides = robot.slides(gap.joint);
                ExpectedAnswer {
                    joint: name(&gap.joint),
                    backlash_u_deg: (!slides).then(|| to_deg(gap.u)),
                    backlash_u_mm: slides.then_some(to_mm(gap.u)),
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
