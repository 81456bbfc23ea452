//! The most likely values of all parameters, given all campaigns, and their covariance.
//!
//! ```text
//! least over x:  sum over campaigns k |r_k|^2 / s_k^2 + sum over parameters ((x - m) / sigma)^2
//! s_k^2 = |r_k|^2 / (m_k - g_k), not below 1        g_k = tr (C J_k' J_k) / s_k^2        C = (sum J_k' J_k / s_k^2 + diag 1 / sigma^2)^-1
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `r_k`, `J_k`, `m_k` | residuals of a campaign over their standard uncertainties, their derivatives, their number |
//! | `s_k` | how much larger the scatter of a campaign is than stated; the stated uncertainty is the least |
//! | `g_k` | number of parameters that the campaign determined |
//! | `m`, `sigma` | mean and standard deviation of a parameter before any measurement |
//! | `C` | covariance afterwards |
//!
//! Scales and values are iterated until the scales are constant. Base frames have no prior; a point or pivot that is to be found is known within
//! centimetres.
//!
//! Source: Gauss-Newton and normal approximation of a posterior, A. Gelman et al., Bayesian Data Analysis, 3rd ed. 2013, ch. 4; effective
//! numbers of parameters, D. MacKay, Bayesian interpolation, Neural Computation 4, 1992.

use nalgebra::{DMatrix, DVector};

use super::measurement::{Campaign, Observed};
use super::parameter::{Knowledge, Parameter};
use super::state::{Model, State, residual};
use crate::calibrate::{self, Arm, ParameterLocation, uncertain_motions};
use crate::least_squares::{Problem, Triangle, descend, solve};
use crate::robot::chain::Motion;
use crate::robot::{Robot, UncertainGeometry};

/// Rounds of scales and values, and the change of the scales that ends them.
const MOST_ROUNDS: usize = 40;
const SAME_SCALE: f64 = 1e-4;
/// Standard deviation of the coordinates of an approximate point or pivot, m.
const POINT: f64 = 0.02;

/// What is known of an arm after its measurements.
#[derive(Clone, Debug)]
pub struct Posterior {
    /// Before.
    pub prior: Vec<Knowledge>,
    /// After; deviations are the roots of the diagonal of the covariance.
    pub knowledge: Vec<Knowledge>,
    /// Covariance of the means of `knowledge`.
    pub covariance: DMatrix<f64>,
    /// One per campaign.
    pub campaigns: Vec<CampaignOutcome>,
}

/// How well a campaign agrees with the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CampaignOutcome {
    /// Number of measured numbers.
    pub rows: usize,
    /// Root mean square of the residuals over their stated uncertainties, with the values known before, frames fitted.
    pub before: f64,
    /// With the most likely values.
    pub after: f64,
    /// How much larger the scatter is than the stated uncertainty; 1 where it is not larger.
    pub scale: f64,
    /// Number of parameters that the campaign determined.
    pub determined: f64,
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No campaign.
    #[error("there are no measurements")]
    Nothing,
    /// A campaign of positions that a calibration refuses.
    #[error("measurement number {}: {error}", .index + 1)]
    Positions {
        /// From 0.
        index: usize,
        /// What is wrong.
        error: calibrate::Refusal,
    },
    /// A number of conditions other than that of poses, an uncertainty that is not above 0, or load tests of another robot.
    #[error("measurement number {}: {what}", .index + 1)]
    Unsound {
        /// From 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// The search diverged.
    #[error("no arm near the one known before explains these measurements; do they belong to this robot?")]
    NotFound,
}

/// What `campaigns` say of `robot`, of which `prior` was known before.
///
/// # Errors
/// See [`Refusal`].
pub fn update(robot: &Robot, prior: &[Knowledge], campaigns: &[Campaign]) -> Result<Posterior, Refusal> {
    if campaigns.is_empty() {
        return Err(Refusal::Nothing);
    }
    for (index, campaign) in campaigns.iter().enumerate() {
        sound(robot, campaign).map_err(|what| Refusal::Unsound { index, what })?;
    }
    let model = Model::new(robot, prior, campaigns);
    let start = model.with_means(placed(robot, campaigns)?);
    let mut scales = vec![1.0; campaigns.len()];
    let frames_only = Fit {
        model: &model,
        campaigns: campaigns.len(),
        scales: &scales.clone(),
        stiff: true,
    };
    let start = descend(&frames_only, start).ok_or(Refusal::NotFound)?;
    let rms = |state: &State<'_>, k: usize| {
        let residual = residual(&model.rows(state, k));
        residual.norm() / (residual.len().max(1) as f64).sqrt()
    };
    let before: Vec<f64> = (0..campaigns.len()).map(|k| rms(&start, k)).collect();
    let mut state = start;
    let mut determined = vec![0.0; campaigns.len()];
    let mut covariance = DMatrix::zeros(0, 0);
    for _ in 0..MOST_ROUNDS {
        let fit = Fit {
            model: &model,
            campaigns: campaigns.len(),
            scales: &scales,
            stiff: false,
        };
        state = descend(&fit, state).ok_or(Refusal::NotFound)?;
        let (r, z) = fit.triangle(&state).whole();
        covariance = solve(&r, &z, 0.0).ok_or(Refusal::NotFound)?.1;
        let next: Vec<f64> = (0..campaigns.len())
            .map(|k| {
                let rows = model.rows(&state, k);
                let jacobian = rows.columns(0, model.unknowns()) / scales[k];
                determined[k] = (&jacobian * &covariance).component_mul(&jacobian).sum();
                let free = (rows.nrows() as f64 - determined[k]).max(1.0);
                (residual(&rows).norm_squared() / free).sqrt().max(1.0)
            })
            .collect();
        let change = next
            .iter()
            .zip(&scales)
            .map(|(next, scale)| (next / scale - 1.0).abs())
            .fold(0.0, f64::max);
        scales = next;
        if change < SAME_SCALE {
            break;
        }
    }
    let count = prior.len();
    let covariance = covariance.view((0, 0), (count, count)).into_owned();
    if !covariance.iter().all(|entry| entry.is_finite()) {
        return Err(Refusal::NotFound);
    }
    let known = |(k, before): (usize, &Knowledge)| Knowledge {
        parameter: before.parameter,
        mean: state.values[k],
        deviation: covariance[(k, k)].max(0.0).sqrt(),
    };
    let outcome = |(k, campaign): (usize, &Campaign)| CampaignOutcome {
        rows: campaign.rows(),
        before: before[k],
        after: rms(&state, k),
        scale: scales[k],
        determined: determined[k],
    };
    Ok(Posterior {
        prior: prior.to_vec(),
        knowledge: prior.iter().enumerate().map(known).collect(),
        campaigns: campaigns.iter().enumerate().map(outcome).collect(),
        covariance,
    })
}

impl Posterior {
    /// Share of what is known of parameter `index` that came from the measurements instead of the prior, 0 to 1.
    pub fn from_measurements(&self, index: usize) -> f64 {
        let ratio = self.knowledge[index].deviation / self.prior[index].deviation;
        (1.0 - ratio * ratio).clamp(0.0, 1.0)
    }

    /// Uncertainty of the small motions of the chain; `None` if there are none.
    pub fn geometry(&self) -> Option<UncertainGeometry> {
        let unknown = |(row, known): (usize, &Knowledge)| match known.parameter {
            Parameter::Geometry(unknown) => Some((row, unknown)),
            Parameter::Drive(_) | Parameter::Backlash(_) => None,
        };
        let unknowns = self.knowledge.iter().enumerate().filter_map(unknown);
        uncertain_motions(unknowns, &self.covariance)
    }

    /// The small motions right after joint `joint`.
    pub fn motions_after(&self, joint: usize) -> Vec<Motion> {
        let mut found: Vec<(usize, Motion)> = (self.knowledge.iter())
            .filter_map(|known| match known.parameter {
                Parameter::Geometry(unknown) if unknown.place == ParameterLocation::After(joint) => {
                    Some((unknown.component, unknown.motion(known.mean)))
                }
                _ => None,
            })
            .collect();
        found.sort_by_key(|(component, _)| *component);
        found.into_iter().map(|(_, motion)| motion).collect()
    }
}

fn sound(robot: &Robot, campaign: &Campaign) -> Result<(), &'static str> {
    let joints = robot.joints().len();
    match campaign {
        Campaign::Positions(positions) => {
            let u = positions.standard_uncertainty;
            if positions.conditions.len() != positions.poses.len() {
                return Err("it has another number of conditions than of poses");
            }
            if positions
                .conditions
                .iter()
                .any(|condition| condition.directions.len() != joints)
            {
                return Err("it has another number of directions than the robot has joints");
            }
            if positions.poses.iter().any(|pose| pose.joints.len() != joints) {
                return Err("it has another number of joints than the robot");
            }
            if let Observed::AlongNormals(normals) = &positions.observed {
                if normals.len() != positions.poses.len() {
                    return Err("it has another number of normals than of poses");
                }
                if positions.poses.iter().any(|pose| pose.rotation.is_some()) {
                    return Err("it has normals and rotations: the position of a surface has no rotation");
                }
                if !normals.iter().all(|normal| (normal.norm() - 1.0).abs() < 1e-6) {
                    return Err("it has a normal that is not a unit vector");
                }
            }
            if let Observed::Distances(distances) = &positions.observed {
                let is_sound = |length: &f64| *length > 0.0 && length.is_finite();
                if distances.lengths.len() != positions.poses.len() || distances.lengths.len() < 2 {
                    return Err("it has another number of distances than of poses, or fewer than two");
                }
                if !distances.lengths.iter().all(is_sound) || !distances.pivot.iter().all(|at| at.is_finite())
                {
                    return Err("it has a distance that is not above 0, or a pivot that is not finite");
                }
            }
            match u > 0.0 && u.is_finite() {
                true => Ok(()),
                false => Err("its standard uncertainty is not above 0"),
            }
        }
        Campaign::LoadTests(tests) => {
            let readings = || tests.iter().flat_map(|test| &test.readings);
            if tests.iter().any(|test| test.joints.len() != joints) {
                return Err("it has another number of joints than the robot");
            }
            match readings().all(|reading| reading.standard_uncertainty > 0.0) && readings().next().is_some()
            {
                true => Ok(()),
                false => Err("it has no readings, or one whose standard uncertainty is not above 0"),
            }
        }
    }
}

/// The nominal arm between the frames of each campaign of positions.
fn placed<'a>(robot: &'a Robot, campaigns: &[Campaign]) -> Result<Vec<Arm<'a>>, Refusal> {
    let mut arms = Vec::new();
    for (index, campaign) in campaigns.iter().enumerate() {
        if let Campaign::Positions(positions) = campaign {
            let placed = positions.placed(robot);
            let [base, point] = placed.map_err(|error| Refusal::Positions { index, error })?;
            arms.push(Arm::nominal(robot, base, point));
        }
    }
    Ok(arms)
}

/// All campaigns and the prior as a problem of least squares.
struct Fit<'m, 'a> {
    model: &'m Model<'a>,
    campaigns: usize,
    scales: &'m [f64],
    /// Whether the parameters of the arm stay as known before: only frames are found.
    stiff: bool,
}

/// Part of the prior deviation that a parameter may move while it is to stay.
const STIFF: f64 = 1e-6;

impl<'a> Fit<'_, 'a> {
    /// Rows of the prior: its weights, and the distance of the state from its means.
    fn prior_rows(&self, state: &State<'a>) -> DMatrix<f64> {
        let (count, last) = (self.model.prior.len(), self.model.unknowns());
        let points = self.model.points(state);
        let mut rows = DMatrix::zeros(count + points.len(), last + 1);
        let part = if self.stiff { STIFF } else { 1.0 };
        for (row, (known, value)) in self.model.prior.iter().zip(&state.values).enumerate() {
            rows[(row, row)] = 1.0 / (part * known.deviation);
            rows[(row, last)] = (known.mean - value) / (part * known.deviation);
        }
        for (k, (column, moved)) in points.into_iter().enumerate() {
            rows[(count + k, column)] = 1.0 / POINT;
            rows[(count + k, last)] = -moved / POINT;
        }
        rows
    }
}

impl<'a> Problem for Fit<'_, 'a> {
    type State = State<'a>;

    fn triangle(&self, state: &State<'a>) -> Triangle {
        let mut triangle = Triangle::new(self.model.unknowns());
        for (k, scale) in (0..self.campaigns).zip(self.scales) {
            triangle.take(&(self.model.rows(state, k) / *scale));
        }
        triangle.take(&self.prior_rows(state));
        triangle
    }

    fn cost(&self, state: &State<'a>) -> f64 {
        let of =
            |(k, scale): (usize, &f64)| residual(&self.model.rows(state, k)).norm_squared() / (scale * scale);
        let campaigns: f64 = (0..self.campaigns).zip(self.scales).map(of).sum();
        let prior: DVector<f64> = residual(&self.prior_rows(state));
        campaigns + prior.norm_squared()
    }

    fn changed(&self, state: &State<'a>, by: &[f64]) -> State<'a> {
        self.model.changed(state, by)
    }
}
