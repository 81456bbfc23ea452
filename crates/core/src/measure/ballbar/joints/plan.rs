//! Circles that make the backlash of all joints identifiable.
//!
//! Candidates are circles with centres in a box, in three planes of the base, of some radii; each with the tool against
//! the normal of its plane. Circles are taken one by one, each time the one with which
//!
//! ```text
//! log det(M / sigma^2 + 1 / prior^2)        M: sum over circles of P^T P, P the columns without nuisance
//! ```
//!
//! is greatest (D-optimal, as in `identify::plan`): first the sums that are not observable at all,
//! later the one with the greatest uncertainty. The result is reproducible.

use nalgebra::{DMatrix, Matrix3, Point2, Point3, Rotation3, UnitQuaternion, Vector3};
use rayon::prelude::*;

use super::super::run::Direction;
use super::circle::{Circle, Followed, NotFollowed, follow};
use super::fit::{EstimatedBacklash, Parted};
use super::nuisance::{basis, without};
use crate::frame::Isometry;
use crate::kernel::{AT_LIMIT, Question};
use crate::path::{Placing, Spin};
use crate::watch::{Cancelled, Watch};

/// Range of the candidate circles.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Middle of the box of centres, m, base.
    pub middle: Point3<f64>,
    /// Half of its sides, m.
    pub half: Vector3<f64>,
    /// Centres along each side, at least 1; an even number leaves the middle out.
    pub along: usize,
    /// Planes, by their normals.
    pub normals: Vec<Normal>,
    /// m
    pub radii: Vec<f64>,
}

/// Normal of a circle, along an axis of the base: the tool points opposite to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normal {
    /// Plane xy, up: the tool points down.
    Up,
    /// Plane yz, towards the robot: the tool points forwards.
    Back,
    /// Plane zx, -y: the tool points to +y.
    Right,
    /// Plane zx, +y: the tool points to -y.
    Left,
}

/// One candidate circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Its centre, m, base.
    pub centre: Point3<f64>,
    /// Its plane.
    pub normal: Normal,
    /// The circle in the cell.
    pub circle: Circle,
}

/// Input of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct CirclePlanOptions {
    /// Maximum number of further circles.
    pub count: usize,
    /// Joints whose backlash is to be estimated.
    pub joints: Vec<usize>,
    /// Lobes of a circle that are not backlash.
    pub most_lobes: usize,
    /// Greatest inflation of the variance of an identifiable backlash.
    pub inflation: f64,
    /// Standard deviation of a sample, m: half a degree apart, both ways, one run each.
    pub noise: f64,
}

/// A selected circle.
#[derive(Clone, Debug)]
pub struct Proposed {
    /// The candidate.
    pub candidate: Candidate,
    /// The arm along it, at [`STATIONS`] stations.
    pub followed: Followed,
    /// Expected result with it and all before.
    pub known: ExpectedUncertainty,
}

/// Expected result of several circles.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedUncertainty {
    /// Greatest inflation of a variance, of the joints with an effect; none where there is none, infinite where only a
    /// sum is observable.
    pub inflation: Option<f64>,
    /// Expected standard uncertainties of the identifiable joints; their backlash is the assumed one.
    pub estimates: Vec<EstimatedBacklash>,
    /// Sets of joints of which only a sum is observable.
    pub together: Vec<Vec<usize>>,
    /// Joints without an effect.
    pub unseen: Vec<usize>,
}

/// Circles to drive.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Expected result before; without circles no joint has an effect.
    pub begun: ExpectedUncertainty,
    /// In the order of their selection.
    pub circles: Vec<Proposed>,
    /// Number of candidates, and of those that the arm follows within its limits.
    pub candidates: [usize; 2],
}

/// Stations of a candidate.
pub const STATIONS: usize = 180;
/// The assumed backlash, rad (m).
const ASSUMED: f64 = 1e-4;
/// Prior standard uncertainty of a backlash, rad (m).
const PRIOR: f64 = 1e-3;
/// Samples of a measured circle, one way.
const SAMPLES: f64 = 720.0;
/// See [`super::fit`]: a backlash of 1 rad (m) that moves the radius by less (m) has no effect.
const LEAST_EFFECT: f64 = 1e-3;

impl Normal {
    /// All.
    pub const ALL: [Normal; 4] = [Normal::Up, Normal::Back, Normal::Right, Normal::Left];

    /// The plane by its two axes.
    pub fn plane(self) -> &'static str {
        match self {
            Normal::Up => "xy",
            Normal::Back => "yz",
            Normal::Right | Normal::Left => "zx",
        }
    }

    /// Axes of the part in base: z is the normal.
    fn axes(self) -> Matrix3<f64> {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let columns = match self {
            Normal::Up => [-y, x, z],
            Normal::Back => [-y, z, -x],
            Normal::Right => [x, z, -y],
            Normal::Left => [-x, z, y],
        };
        Matrix3::from_columns(&columns)
    }
}

impl Domain {
    /// All circles of it, centre by centre.
    pub fn candidates(&self) -> Vec<Candidate> {
        let along = self.along.max(1);
        let part = |index: usize| match along {
            1 => 0.0,
            _ => 2.0 * index as f64 / (along - 1) as f64 - 1.0,
        };
        let mut found = Vec::new();
        for index in 0..along.pow(3) {
            let at = Vector3::new(index / along / along, index / along % along, index % along);
            let centre = self.middle + self.half.component_mul(&at.map(part));
            for normal in &self.normals {
                found.extend(self.radii.iter().map(|radius| Candidate {
                    centre,
                    normal: *normal,
                    circle: circle(centre, *normal, *radius),
                }));
            }
        }
        found
    }
}

fn circle(centre: Point3<f64>, normal: Normal, radius: f64) -> Circle {
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(normal.axes()));
    Circle {
        placing: Placing {
            base_from_path: Isometry::from_parts(centre.coords.into(), turn),
            axis: Vector3::z_axis(),
            keeps_axis: true,
            spin: Spin::Fixed(0.0),
        },
        centre: Point2::origin(),
        radius,
    }
}

/// Circles of `candidates` in addition to those already `begun`, in the branch of `question`.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn propose(
    question: &Question<'_>,
    candidates: &[Candidate],
    begun: &[Followed],
    requested: &CirclePlanOptions,
    watch: Watch<'_>,
) -> Result<Plan, Cancelled> {
    let reached: Vec<(Candidate, Followed, DMatrix<f64>)> = candidates
        .par_iter()
        .map(|candidate| {
            let quiet = Watch {
                finished: &|_| (),
                ..watch
            };
            let followed = follow(question, &candidate.circle, STATIONS, quiet);
            (watch.finished)(1);
            match followed {
                Ok(followed) if followed.limit_margin >= -AT_LIMIT => {
                    let information = information(&followed, requested);
                    Ok(Some((*candidate, followed, information)))
                }
                Err(NotFollowed::Cancelled(cancelled)) => Err(cancelled),
                Ok(_) | Err(NotFollowed::Unreachable { .. } | NotFollowed::Jumps { .. }) => Ok(None),
            }
        })
        .filter_map(Result::transpose)
        .collect::<Result<_, _>>()?;
    let joints = requested.joints.len();
    let zero = DMatrix::zeros(joints, joints);
    let mut sum: DMatrix<f64> = begun
        .iter()
        .fold(zero, |sum, one| sum + information(one, requested));
    let before = known(&sum, requested);
    let mut chosen: Vec<usize> = Vec::new();
    let mut circles = Vec::new();
    while chosen.len() < requested.count {
        let free = (0..reached.len()).filter(|place| !chosen.contains(place));
        let gains = free.map(|place| (place, log_determinant(&(&sum + &reached[place].2), requested)));
        // The first of equal ones.
        let best = gains.reduce(|best, next| if next.1 > best.1 { next } else { best });
        let Some((place, _)) = best else { break };
        let (candidate, followed, own) = &reached[place];
        sum += own;
        chosen.push(place);
        circles.push(Proposed {
            candidate: *candidate,
            followed: followed.clone(),
            known: known(&sum, requested),
        });
    }
    Ok(Plan {
        begun: before,
        circles,
        candidates: [candidates.len(), reached.len()],
    })
}

/// `P^T P` of a circle in both directions, with [`SAMPLES`] samples each.
fn information(followed: &Followed, requested: &CirclePlanOptions) -> DMatrix<f64> {
    let pitch = std::f64::consts::TAU / STATIONS as f64;
    // Half a pitch off the axes, where most joints reverse.
    let angles: Vec<f64> = (0..STATIONS).map(|k| (k as f64 + 0.5) * pitch).collect();
    let both: Vec<f64> = angles.iter().chain(&angles).copied().collect();
    let columns = DMatrix::from_fn(both.len(), requested.joints.len(), |_, _| 0.0);
    let columns = requested
        .joints
        .iter()
        .enumerate()
        .fold(columns, |mut columns, (k, joint)| {
            let ways = Direction::BOTH.map(|way| followed.slope(*joint, ASSUMED, way, &angles));
            columns.set_column(k, &nalgebra::DVector::from_vec(ways.concat()));
            columns
        });
    let left = without(&basis(&both, requested.most_lobes), &columns);
    left.tr_mul(&left) * (SAMPLES / STATIONS as f64)
}

fn log_determinant(information: &DMatrix<f64>, requested: &CirclePlanOptions) -> f64 {
    let count = information.nrows();
    let all = information / requested.noise.powi(2) + DMatrix::identity(count, count) / PRIOR.powi(2);
    all.cholesky()
        .map_or(f64::NEG_INFINITY, |root| root.l().diagonal().map(f64::ln).sum())
}

/// Expected result of this information.
fn known(information: &DMatrix<f64>, requested: &CirclePlanOptions) -> ExpectedUncertainty {
    let samples = 2.0 * SAMPLES;
    let shows = |k: &usize| (information[(*k, *k)] / samples).sqrt() > LEAST_EFFECT;
    let (seen, unseen): (Vec<usize>, Vec<usize>) = (0..requested.joints.len()).partition(shows);
    let own = information.select_columns(&seen).select_rows(&seen);
    // Any root of the information has the singular values of the columns.
    let eigen = own.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    let columns = DMatrix::from_diagonal(&roots) * eigen.eigenvectors.transpose();
    let parted = Parted::of(columns, requested.inflation);
    let reported = (0..seen.len()).filter(|place| !parted.together.iter().any(|set| set.contains(place)));
    ExpectedUncertainty {
        inflation: parted.inflation.iter().copied().reduce(f64::max),
        estimates: reported
            .map(|place| EstimatedBacklash {
                joint: requested.joints[seen[place]],
                gap: ASSUMED,
                u: requested.noise * parted.inverse[(place, place)].sqrt(),
            })
            .collect(),
        together: (parted.together.iter())
            .map(|set| set.iter().map(|place| requested.joints[seen[*place]]).collect())
            .collect(),
        unseen: unseen.into_iter().map(|place| requested.joints[place]).collect(),
    }
}
