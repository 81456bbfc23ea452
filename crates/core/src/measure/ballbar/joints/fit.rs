//! Backlash of all joints at once, from circular tests on one circle or several.
//!
//! ```text
//! least over b and the nuisance of every circle:   sum |dr - unloaded - nuisance - sum_i e_i(a, s; b_i)|^2
//! ```
//!
//! by Gauss-Newton steps, since a backlash is crossed while its joint reverses. `unloaded` is the displacement by
//! geometry and gravity of the study; the nuisance is the part of a circle that is equal in both directions (see
//! `nuisance`).
//!
//! **Identifiability.** The variance of a backlash over its variance without the other joints, with the nuisance taken
//! off, is its inflation: 1 of a joint that is independent of all others. Above [`BacklashOptions::inflation`] (10 is
//! the usual rule of regression \[recalled\]) circles determine sums of backlashes rather than this one, and model
//! errors of the columns are amplified like the noise: such joints are named together, and not reported separately.
//!
//! **Standard uncertainty.** With given noise `sigma^2 (J^T J)^-1`, else from residuals and repeated runs, as
//! for the parts of a circle (`parts::trust`).

use nalgebra::{DMatrix, DVector, SVD};

use super::super::parts::samples::Samples;
use super::super::parts::trust;
use super::super::run::{CircularTest, Direction, Run, RunError};
use super::circle::Followed;
use super::joint_run::JointRun;
use super::nuisance::{basis, without};

/// A circular test, and the arm that followed the circle.
#[derive(Clone, Copy, Debug)]
pub struct Observed<'a> {
    /// The arm on the circle; angles of the test are those of the circle.
    pub followed: &'a Followed,
    /// Its runs.
    pub test: &'a CircularTest,
}

/// Options of the estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct BacklashOptions {
    /// Joints whose backlash is estimated; the others have none.
    pub joints: Vec<usize>,
    /// Lobes of a circle, equal in both directions; 0: its radius only, 2: position, scale and squareness too.
    pub most_lobes: usize,
    /// Standard deviation of a sample of a profile, m; `None` from the residuals.
    pub noise: Option<f64>,
    /// Greatest inflation of the variance of an identifiable backlash.
    pub inflation: f64,
}

/// Default of the greatest inflation of the variance.
pub const INFLATION: f64 = 10.0;
/// Default number of lobes that are removed from each circle.
pub const LOBES: usize = 6;

impl BacklashOptions {
    /// All joints of an arm with this number of them.
    pub fn of_all(joints: usize) -> BacklashOptions {
        BacklashOptions {
            joints: (0..joints).collect(),
            most_lobes: LOBES,
            noise: None,
            inflation: INFLATION,
        }
    }
}

/// The estimated backlash of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatedBacklash {
    /// Index of the joint.
    pub joint: usize,
    /// rad (m); negative by noise, or where the link is ahead of its motor.
    pub gap: f64,
    /// Its standard uncertainty, same unit.
    pub u: f64,
}

/// Result of the estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct BacklashFit {
    /// Of each identifiable joint.
    pub estimates: Vec<EstimatedBacklash>,
    /// Covariance of these, in their order.
    pub covariance: DMatrix<f64>,
    /// Sets of joints of which only a sum is observable.
    pub together: Vec<Vec<usize>>,
    /// Joints without an effect on any circle.
    pub unseen: Vec<usize>,
    /// Joints with an effect, each with the inflation of its variance; infinite where only a sum is observable.
    pub inflation: Vec<(usize, f64)>,
    /// The backlash of each joint at the end of the fit, one per joint of the arm: of joints in a set one of many equal
    /// fits.
    pub fitted: Vec<f64>,
    /// Root mean square of the residual of position, size and lobes of the circles, m.
    pub rms_before: f64,
    /// And of the residual with backlash, m.
    pub rms_after: f64,
    /// Number of samples of the profiles.
    pub samples: usize,
}

impl BacklashFit {
    /// The backlash of a joint, if it is identifiable.
    pub fn of(&self, joint: usize) -> Option<&EstimatedBacklash> {
        self.estimates.iter().find(|gap| gap.joint == joint)
    }
}

/// A backlash of 1 rad (m) that moves the radius by less than this (m, root mean square) has no effect: for 1 mrad it
/// is a micrometre.
const LEAST_EFFECT: f64 = 1e-3;
/// A singular value of unit columns below this is a sum that is not observable: noise would make it larger than any
/// backlash.
const UNSEEN: f64 = 1e-3;
/// Estimates with a greater correlation are named together.
const TOGETHER: f64 = 0.3;
/// Steps that change the radius by less have converged, m.
const SETTLED: f64 = 1e-12;
const MOST_ROUNDS: usize = 30;
/// Initial backlash, rad (m).
const USUAL: f64 = 1e-4;
/// Residuals that differ by less, relative, belong to one minimum.
const ALIKE: f64 = 1e-9;

/// The backlash of the joints on the `observed` circles; `None` where they have fewer samples than there are unknowns.
///
/// # Errors
/// A test that does not belong to its circle: radii that differ by more than half the radius.
///
/// # Panics
/// If the circles are of arms with different numbers of joints, or there is none.
pub fn fit_backlash(
    observed: &[Observed<'_>],
    requested: &BacklashOptions,
) -> Result<Option<BacklashFit>, RunError> {
    let circles: Vec<Samples> = observed.iter().map(samples_of).collect::<Result<_, _>>()?;
    let rows: Vec<(usize, usize)> = circles
        .iter()
        .scan(0, |begin, circle| {
            let count = circle.at.len();
            *begin += count;
            Some((*begin - count, count))
        })
        .collect();
    let samples = Samples::joined(&circles);
    let bases: Vec<DMatrix<f64>> = circles
        .iter()
        .map(|circle| {
            let angles: Vec<f64> = circle.at.iter().map(|(angle, _)| *angle).collect();
            basis(&angles, requested.most_lobes)
        })
        .collect();
    let sight = Sight {
        joints: joint_runs(observed, &samples),
        samples,
        rows,
        bases,
    };
    let fixed: usize = sight.bases.iter().map(DMatrix::ncols).sum();
    if sight.samples.at.len() <= fixed + requested.joints.len() {
        return Ok(None);
    }
    Ok(Some(sight.solve(requested, fixed)))
}

/// The samples of one circle, without the parts of the study that are not backlash.
fn samples_of(observed: &Observed<'_>) -> Result<Samples, RunError> {
    let run = |run: &Run| {
        let left = run
            .samples()
            .map(|(a, dr)| (a, dr - observed.followed.unloaded_at(a)));
        let (angle, deviation) = left.unzip();
        Run::new(run.direction(), angle, deviation)
    };
    let runs = observed.test.runs().iter().map(run).collect::<Result<_, _>>()?;
    Ok(Samples::of(
        &CircularTest::new(observed.test.radius(), runs)?,
        &[],
    ))
}

/// Every joint along every run of the samples, by joint, then by run.
fn joint_runs(observed: &[Observed<'_>], samples: &Samples) -> Vec<Vec<JointRun>> {
    let circles = observed.iter().zip(&samples.runs);
    let followed: Vec<&Followed> = circles
        .flat_map(|(observed, runs)| std::iter::repeat_n(observed.followed, *runs))
        .collect();
    let runs: Vec<(&Followed, Direction, Vec<f64>)> = samples
        .begins
        .windows(2)
        .zip(followed)
        .filter_map(|(ends, followed)| {
            let samples = &samples.at[ends[0]..ends[1]];
            let (_, direction) = samples.first()?;
            Some((
                followed,
                *direction,
                samples.iter().map(|(angle, _)| *angle).collect(),
            ))
        })
        .collect();
    let of_joint = |joint| -> Vec<JointRun> {
        let along = |(followed, direction, angles): &(&Followed, Direction, Vec<f64>)| {
            JointRun::of(followed, joint, *direction, angles)
        };
        runs.iter().map(along).collect()
    };
    (0..observed[0].followed.joint_count()).map(of_joint).collect()
}

/// All samples, and the parts that are removed from them.
struct Sight {
    /// Every joint along every run, by joint, then by run.
    joints: Vec<Vec<JointRun>>,
    samples: Samples,
    /// First sample of each circle, and their number.
    rows: Vec<(usize, usize)>,
    bases: Vec<DMatrix<f64>>,
}

impl Sight {
    fn solve(&self, requested: &BacklashOptions, fixed: usize) -> BacklashFit {
        let joints = self.joints.len();
        let first = self.columns(&requested.joints, &vec![0.0; joints]);
        let count = self.samples.at.len() as f64;
        let shows = |column: usize| first.column(column).norm() / count.sqrt() > LEAST_EFFECT;
        let (seen, unseen): (Vec<usize>, Vec<usize>) = (0..requested.joints.len()).partition(|k| shows(*k));
        let [seen, unseen] = [seen, unseen].map(|places| -> Vec<usize> {
            places.into_iter().map(|place| requested.joints[place]).collect()
        });
        let before = self.left(&vec![0.0; joints]);
        let from = |start: Vec<f64>| self.settle(&seen, start, requested.inflation);
        let first = from(vec![0.0; joints]);
        // Where only crossings distinguish joints there is a second minimum with a negative backlash.
        let upright = from(first.0.iter().map(|gap| gap.abs()).collect());
        let alike = from(start_of(&seen, joints));
        let (fitted, rest, parted) = [first, upright, alike]
            .into_iter()
            .reduce(|best, next| match next.1.norm() < best.1.norm() * (1.0 - ALIKE) {
                true => next,
                false => best,
            })
            .expect("three of them");
        let freedom = self.samples.at.len() - fixed - seen.len();
        let covariance = match requested.noise {
            Some(noise) => &parted.inverse * (noise * noise),
            None => trust::covariance(&self.samples, &parted.columns, &rest, &parted.inverse, freedom),
        };
        let reported: Vec<usize> = (0..seen.len())
            .filter(|place| !parted.together.iter().any(|set| set.contains(place)))
            .collect();
        let rms = |of: &DVector<f64>| (of.norm_squared() / count).sqrt();
        BacklashFit {
            estimates: reported
                .iter()
                .map(|place| EstimatedBacklash {
                    joint: seen[*place],
                    gap: fitted[seen[*place]],
                    u: covariance[(*place, *place)].sqrt(),
                })
                .collect(),
            covariance: covariance.select_columns(&reported).select_rows(&reported),
            together: (parted.together.iter())
                .map(|set| set.iter().map(|place| seen[*place]).collect())
                .collect(),
            unseen,
            inflation: seen.iter().copied().zip(parted.inflation).collect(),
            fitted,
            rms_before: rms(&before),
            rms_after: rms(&rest),
            samples: self.samples.at.len(),
        }
    }

    /// Gauss-Newton steps from these backlashes: the end, the residual, and the columns there.
    fn settle(&self, seen: &[usize], mut gaps: Vec<f64>, inflation: f64) -> (Vec<f64>, DVector<f64>, Parted) {
        let mut rest = self.left(&gaps);
        let mut parted = Parted::of(self.columns(seen, &gaps), inflation);
        for _ in 0..MOST_ROUNDS {
            let step = &parted.inverse * parted.columns.tr_mul(&rest);
            for (joint, by) in seen.iter().zip(step.iter()) {
                gaps[*joint] += by;
            }
            rest = self.left(&gaps);
            let moved = (&parted.columns * &step).amax();
            parted = Parted::of(self.columns(seen, &gaps), inflation);
            if moved < SETTLED {
                break;
            }
        }
        (gaps, rest, parted)
    }

    /// Residual of the samples with these backlashes, without the nuisance.
    fn left(&self, gaps: &[f64]) -> DVector<f64> {
        let mut left = self.samples.deviation.clone();
        for (joint, gap) in gaps.iter().enumerate().filter(|(_, gap)| **gap != 0.0) {
            left -= self.column(joint, |run| run.effect(*gap));
        }
        self.without_nuisance(&DMatrix::from_columns(&[left]))
            .column(0)
            .into_owned()
    }

    /// Derivatives of the samples by the backlash of these joints, without the nuisance.
    fn columns(&self, joints: &[usize], gaps: &[f64]) -> DMatrix<f64> {
        let column = |joint: &usize| self.column(*joint, |run| run.slope(gaps[*joint]));
        let columns: Vec<DVector<f64>> = joints.iter().map(column).collect();
        match columns.is_empty() {
            true => DMatrix::zeros(self.samples.at.len(), 0),
            false => self.without_nuisance(&DMatrix::from_columns(&columns)),
        }
    }

    /// One value per sample, run by run.
    fn column(&self, joint: usize, of: impl Fn(&JointRun) -> Vec<f64>) -> DVector<f64> {
        DVector::from_vec(self.joints[joint].iter().flat_map(of).collect())
    }

    fn without_nuisance(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut left = columns.clone();
        for ((begin, count), basis) in self.rows.iter().zip(&self.bases) {
            let mut own = left.rows_mut(*begin, *count);
            let cleared = without(basis, &own.clone_owned());
            own.copy_from(&cleared);
        }
        left
    }
}

/// Typical backlash of gears, of the joints with an effect.
fn start_of(seen: &[usize], joints: usize) -> Vec<f64> {
    let gap = |joint: usize| if seen.contains(&joint) { USUAL } else { 0.0 };
    (0..joints).map(gap).collect()
}

/// Columns, with their identifiability.
pub(super) struct Parted {
    columns: DMatrix<f64>,
    /// Inverse of their normal matrix, on the observable sums.
    pub inverse: DMatrix<f64>,
    /// Of each column; infinite where only a sum is observable.
    pub inflation: Vec<f64>,
    /// Sets of indices of which only a sum is reported.
    pub together: Vec<Vec<usize>>,
}

impl Parted {
    /// Of columns that each have an effect.
    pub fn of(columns: DMatrix<f64>, most_inflation: f64) -> Parted {
        let count = columns.ncols();
        if count == 0 {
            return Parted {
                inverse: DMatrix::zeros(0, 0),
                inflation: Vec::new(),
                together: Vec::new(),
                columns,
            };
        }
        let length: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
        let unit = DMatrix::from_fn(columns.nrows(), count, |i, k| columns[(i, k)] / length[k]);
        // The triangle has the singular values of the columns, and is small.
        let svd = SVD::new(unit.qr().r(), false, true);
        let right = svd.v_t.expect("requested").transpose();
        let mut inverse = DMatrix::zeros(count, count);
        let mut is_sum = vec![false; count];
        for (value, sum) in svd.singular_values.iter().zip(right.column_iter()) {
            if *value > UNSEEN {
                inverse += sum * sum.transpose() / (value * value);
            } else {
                let parts = is_sum.iter_mut().zip(sum.iter());
                parts.for_each(|(is_sum, part)| *is_sum |= part.abs() > UNSEEN);
            }
        }
        let inflation: Vec<f64> = (0..count)
            .map(|k| if is_sum[k] { f64::INFINITY } else { inverse[(k, k)] })
            .collect();
        let lost: Vec<usize> = (0..count).filter(|k| inflation[*k] > most_inflation).collect();
        // Sums that are hardly observable join the columns that are part of them.
        let floor = UNSEEN * UNSEEN;
        let weak = svd.singular_values.iter().zip(right.column_iter());
        let joins: DMatrix<f64> = weak.fold(DMatrix::zeros(count, count), |joins, (value, sum)| {
            joins + sum * sum.transpose() / (value * value).max(floor)
        });
        let scaled = DMatrix::from_fn(count, count, |i, k| inverse[(i, k)] / (length[i] * length[k]));
        Parted {
            together: sets(&lost, &joins),
            inverse: scaled,
            inflation,
            columns,
        }
    }
}

/// Groups of the `lost`: those with a correlation above [`TOGETHER`] in `joins`, a covariance; one that is
/// left alone is correlated with many, with each a little.
fn sets(lost: &[usize], joins: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let hang = |i: usize, k: usize| joins[(i, k)].abs() / (joins[(i, i)] * joins[(k, k)]).sqrt();
    let mut found: Vec<Vec<usize>> = Vec::new();
    for place in lost {
        let (near, far): (Vec<_>, Vec<_>) = found
            .into_iter()
            .partition(|set: &Vec<usize>| set.iter().any(|other| hang(*place, *other) > TOGETHER));
        found = far;
        let mut set: Vec<usize> = near.into_iter().flatten().chain([*place]).collect();
        set.sort_unstable();
        found.push(set);
    }
    found.sort();
    found
}
