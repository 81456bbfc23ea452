//! The gaps of all joints at once, from circular tests on one circle or several.
//!
//! ```text
//! least over b and the nuisance of every circle:   sum |dr - beside - nuisance - sum_i e_i(a, s; b_i)|^2
//! ```
//!
//! by Gauss-Newton steps, since a gap is crossed while its joint turns back. `beside` is what geometry and gravity of the
//! study move the tool by; the nuisance takes what a circle shows the same both ways (see `nuisance`).
//!
//! **Told apart.** The variance of a gap over what it would be if no other joint were looked for, with the nuisance taken
//! off, is its inflation: 1 of a joint that shows like no other. Above [`Asked::inflation`] (10 is the
//! usual rule of regression \[recalled\]) circles tell of sums of gaps rather than of this one, and errors of the columns,
//! since no gear has quite the play that is drawn here, grow as the noise does: such joints are named together, and not told.
//!
//! **Standard uncertainty.** With noise that is told `sigma^2 (J^T J)^-1`, else from residuals and repeated runs, as
//! for the parts of a circle (`parts::trust`).

use nalgebra::{DMatrix, DVector, SVD};

use super::super::parts::fit::Samples;
use super::super::parts::trust;
use super::super::run::{CircularTest, Direction, Run, RunError};
use super::circle::Followed;
use super::nuisance::{basis, without};

/// A circular test, and the arm that went round.
#[derive(Clone, Copy, Debug)]
pub struct Observed<'a> {
    /// Angles of the test are those of the circle.
    pub followed: &'a Followed,
    /// Its runs.
    pub test: &'a CircularTest,
}

/// What is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Joints whose gap is looked for; the others have none.
    pub joints: Vec<usize>,
    /// Lobes that a circle may have, the same both ways; 0: its radius alone, 2: place, scale and squareness too.
    pub most_lobes: usize,
    /// Standard deviation of a sample of a profile, m; `None` from the residuals.
    pub noise: Option<f64>,
    /// Greatest inflation of a variance that counts as told apart.
    pub inflation: f64,
}

/// Gaps whose variance is inflated more are not told apart, where nobody says otherwise.
pub const INFLATION: f64 = 10.0;
/// Lobes that are taken off each circle where nobody says how many.
pub const LOBES: usize = 6;

impl Asked {
    /// All joints of an arm that has so many.
    pub fn of_all(joints: usize) -> Asked {
        Asked {
            joints: (0..joints).collect(),
            most_lobes: LOBES,
            noise: None,
            inflation: INFLATION,
        }
    }
}

/// The gap of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Which joint.
    pub joint: usize,
    /// rad (m); below zero by noise, or where the link is ahead of its motor.
    pub gap: f64,
    /// Its standard uncertainty, same unit.
    pub u: f64,
}

/// What circles tell of the gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaps {
    /// Of each joint that was told apart.
    pub given: Vec<Gap>,
    /// Covariance of these, in their order.
    pub covariance: DMatrix<f64>,
    /// Sets of joints of which only a sum is seen.
    pub together: Vec<Vec<usize>>,
    /// Joints that do not show on any circle.
    pub unseen: Vec<usize>,
    /// Joints that show, each with the inflation of its variance; infinite where only a sum is seen.
    pub inflation: Vec<(usize, f64)>,
    /// The gaps that the fit ended with, one a joint of the arm: of joints that are together one of many that fit as well.
    pub fitted: Vec<f64>,
    /// Root mean square of what place, size and lobes of the circles leave, m.
    pub rms_before: f64,
    /// And of what the gaps leave of that, m.
    pub rms_after: f64,
    /// Samples of the profiles that were used.
    pub samples: usize,
}

impl Gaps {
    /// The gap of a joint, if it was told apart.
    pub fn of(&self, joint: usize) -> Option<&Gap> {
        self.given.iter().find(|gap| gap.joint == joint)
    }
}

/// A gap of 1 rad (m) that moves the radius by less than this (m, root mean square) does not show: of 1 mrad it is a
/// micrometre.
const LEAST_EFFECT: f64 = 1e-3;
/// A singular value of unit columns below this is a sum that is not seen: noise would make it larger than any gap.
const UNSEEN: f64 = 1e-3;
/// Gaps whose estimates hang together by more are named together.
const TOGETHER: f64 = 0.3;
/// Steps that change the radius by less have come to rest, m.
const SETTLED: f64 = 1e-12;
const MOST_ROUNDS: usize = 30;
/// A gap to begin with, rad (m).
const USUAL: f64 = 1e-4;
/// Residuals that differ by less, relative, are those of one rest.
const ALIKE: f64 = 1e-9;

/// The gaps that `observed` circles tell; `None` where they have fewer samples than there are unknowns.
///
/// # Errors
/// A test that is no test of its circle: radii farther off than half the radius.
///
/// # Panics
/// If the circles are of arms with different numbers of joints, or there is none.
pub fn gaps(observed: &[Observed<'_>], requested: &Asked) -> Result<Option<Gaps>, RunError> {
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
        observed,
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

/// The samples of one circle, without what is no backlash by the study.
fn samples_of(observed: &Observed<'_>) -> Result<Samples, RunError> {
    let run = |run: &Run| {
        let left = run.samples().map(|(a, dr)| (a, dr - observed.followed.beside(a)));
        let (angle, deviation) = left.unzip();
        Run::new(run.direction(), angle, deviation)
    };
    let runs = observed.test.runs().iter().map(run).collect::<Result<_, _>>()?;
    Ok(Samples::of(
        &CircularTest::new(observed.test.radius(), runs)?,
        &[],
    ))
}

/// All samples, and what is taken off them.
struct Sight<'a> {
    observed: &'a [Observed<'a>],
    samples: Samples,
    /// Where the samples of each circle begin, and how many they are.
    rows: Vec<(usize, usize)>,
    bases: Vec<DMatrix<f64>>,
}

impl Sight<'_> {
    fn solve(&self, requested: &Asked, fixed: usize) -> Gaps {
        let joints = self.observed[0].followed.joint_count();
        let first = self.columns(&requested.joints, &vec![0.0; joints]);
        let count = self.samples.at.len() as f64;
        let shows = |column: usize| first.column(column).norm() / count.sqrt() > LEAST_EFFECT;
        let (seen, unseen): (Vec<usize>, Vec<usize>) = (0..requested.joints.len()).partition(|k| shows(*k));
        let [seen, unseen] = [seen, unseen]
            .map(|places| -> Vec<usize> { places.into_iter().map(|place| requested.joints[place]).collect() });
        let before = self.left(&vec![0.0; joints]);
        let from = |start: Vec<f64>| self.settle(&seen, start, requested.inflation);
        let first = from(vec![0.0; joints]);
        // Where crossings alone tell joints apart there is a second rest with a gap below zero.
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
            None => trust::covariance(
                &self.samples,
                (&parted.columns, &rest),
                (&parted.inverse, freedom),
            ),
        };
        let given: Vec<usize> = (0..seen.len())
            .filter(|place| !parted.together.iter().any(|set| set.contains(place)))
            .collect();
        let rms = |of: &DVector<f64>| (of.norm_squared() / count).sqrt();
        Gaps {
            given: given
                .iter()
                .map(|place| Gap {
                    joint: seen[*place],
                    gap: fitted[seen[*place]],
                    u: covariance[(*place, *place)].sqrt(),
                })
                .collect(),
            covariance: covariance.select_columns(&given).select_rows(&given),
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

    /// Gauss-Newton steps from these gaps: where they end, what they leave, and the columns there.
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

    /// What gaps of this size leave of the samples, without the nuisance.
    fn left(&self, gaps: &[f64]) -> DVector<f64> {
        let mut left = self.samples.deviation.clone();
        for (joint, gap) in gaps.iter().enumerate().filter(|(_, gap)| **gap != 0.0) {
            left -= self.column(|followed, way, angles| followed.effect((joint, *gap), way, angles));
        }
        self.without_nuisance(&DMatrix::from_columns(&[left]))
            .column(0)
            .into_owned()
    }

    /// How the samples grow with the gaps of these joints, without the nuisance.
    fn columns(&self, joints: &[usize], gaps: &[f64]) -> DMatrix<f64> {
        let column = |joint: &usize| {
            let at = (*joint, gaps[*joint]);
            self.column(|followed, way, angles| followed.slope(at, way, angles))
        };
        let columns: Vec<DVector<f64>> = joints.iter().map(column).collect();
        match columns.is_empty() {
            true => DMatrix::zeros(self.samples.at.len(), 0),
            false => self.without_nuisance(&DMatrix::from_columns(&columns)),
        }
    }

    /// One value a sample, run by run.
    fn column(&self, of: impl Fn(&Followed, Direction, &[f64]) -> Vec<f64>) -> DVector<f64> {
        let begins = self.samples.begins.windows(2);
        let circles = self.observed.iter().zip(&self.samples.runs);
        let followed = circles.flat_map(|(observed, runs)| std::iter::repeat_n(observed.followed, *runs));
        let values = begins.zip(followed).flat_map(|(ends, followed)| {
            let samples = &self.samples.at[ends[0]..ends[1]];
            let angles: Vec<f64> = samples.iter().map(|(angle, _)| *angle).collect();
            samples
                .first()
                .map_or_else(Vec::new, |(_, way)| of(followed, *way, &angles))
        });
        DVector::from_vec(values.collect())
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

/// Gaps of gears as they are, of the joints that show.
fn start_of(seen: &[usize], joints: usize) -> Vec<f64> {
    let gap = |joint: usize| if seen.contains(&joint) { USUAL } else { 0.0 };
    (0..joints).map(gap).collect()
}

/// Columns, with what of them can be told apart.
pub(super) struct Parted {
    columns: DMatrix<f64>,
    /// Inverse of their normal matrix, on the sums that are seen.
    pub inverse: DMatrix<f64>,
    /// Of each column; infinite where only a sum is seen.
    pub inflation: Vec<f64>,
    /// Sets of places that are told as a sum rather than each.
    pub together: Vec<Vec<usize>>,
}

impl Parted {
    /// Of columns that each show something.
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
        let right = svd.v_t.expect("asked for").transpose();
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
        // Sums that are seen hardly or not at all join those that have a part in them.
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

/// Which of the `lost` go together: those that hang together by more than [`TOGETHER`] in `joins`, a covariance; one that is
/// left alone hangs together with many, with each a little.
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
