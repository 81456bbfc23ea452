//! All parts of a measured circle at once, by least squares.
//!
//! ```text
//! dr(a, s) = sum over terms of  value * term(a, s)  +  rest
//! ```
//!
//! over the profiles of all runs, about the set-up centre: there reversals are where the drives reverse. The
//! second-order effect of the position of the circle, `e^2/2R`, is subtracted before. A sample on a reversal is on
//! neither side of it and left out.
//!
//! Terms that are not distinguishable are named: with clockwise runs only, a radius that depends on the direction is a
//! radius. Of each such set the last term is left out, so that the first is the sum. A single term in its set has no
//! effect on the test: a reversal in a gap.

use nalgebra::{DMatrix, DVector};

use super::super::profile::Profile;
use super::super::run::CircularTest;
use super::samples::Samples;
use super::term::{Axis, ON_STEP, Reversal, Term, Wave};
use super::trust::covariance;
use crate::identify::Spread;

/// Options of the analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct PartsOptions {
    /// Angles where drives reverse.
    pub reversals: Vec<Reversal>,
    /// Maximum number of lobes; below 3 none.
    pub most_lobes: usize,
    /// Period of a cyclic error along either axis, m.
    pub period: Option<f64>,
}

/// One part, with its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The term.
    pub term: Term,
    /// m
    pub value: f64,
    /// Standard uncertainty, m: see `docs/theory/ballbar.md`.
    pub u: f64,
}

/// Parts of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// One per identifiable term.
    pub parts: Vec<Part>,
    /// Sets of terms of which only a sum is known, or a single one without effect; the last of each is not
    /// among the parts.
    pub together: Vec<Vec<Term>>,
    /// Covariance of radius and scale mismatch, m^2: over an arc they are correlated. 0 where one is not among the
    /// parts.
    pub scale_covariance: f64,
    /// Root mean square of the radial deviation without the radius and the offset of the fit, m.
    pub rms_before: f64,
    /// And of the residual of all parts, m.
    pub rms_after: f64,
    /// Number of samples of the profiles.
    pub samples: usize,
}

impl Parts {
    /// The part of a term, if it is identifiable.
    pub fn of(&self, term: Term) -> Option<&Part> {
        self.parts.iter().find(|part| part.term == term)
    }

    /// The part of a term, if it is identifiable separately: not a sum.
    pub fn alone(&self, term: Term) -> Option<&Part> {
        let in_sum = self.together.iter().any(|set| set.contains(&term));
        self.of(term).filter(|_| !in_sum)
    }
}

/// The parts of the test with options `requested`; `None` where there are fewer samples than terms, or for a period of
/// no length.
pub fn parts(test: &CircularTest, requested: &PartsOptions) -> Option<Parts> {
    let samples = Samples::of(test, &requested.reversals);
    let mut terms = all_terms(requested);
    let (rows, spread, together) = identifiable(&samples, &mut terms, requested, test.radius())?;
    let values = solved(&rows, &samples.deviation, &spread);
    let rest = &samples.deviation - &rows * &values;
    let freedom = rows.nrows() - rows.ncols();
    let covariance = covariance(&samples, &rows, &rest, &spread.covariance, freedom);
    let u: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
    let place = |term: Term| terms.iter().position(|of| *of == term);
    let scales = place(Term::Radius).zip(place(Term::ScaleMismatch));
    let scale_covariance = scales.map_or(0.0, |both| covariance[both]);
    // A step without samples on both sides depends on its assumed shape: it is used in the fit and not reported.
    let unseen = unseen(test, &requested.reversals);
    let found = terms
        .iter()
        .zip(values.iter().zip(&u))
        .filter(|(term, _)| !unseen.contains(term));
    let together = together.into_iter().chain(unseen.iter().map(|term| vec![*term]));
    let rms = |squares: f64| (squares / samples.at.len() as f64).sqrt();
    Some(Parts {
        parts: found
            .map(|(term, (value, u))| Part {
                term: *term,
                value: *value,
                u: *u,
            })
            .collect(),
        together: together.collect(),
        scale_covariance,
        rms_before: rms(about_circle(&samples, &terms, &rows, &values)),
        rms_after: rms(rest.norm_squared()),
        samples: samples.at.len(),
    })
}

/// The residuals of a fit without cyclic error, with its rows; see [`super::cyclic`].
pub(super) fn rest_without_cyclic(
    test: &CircularTest,
    requested: &PartsOptions,
) -> Option<(Samples, DMatrix<f64>, DVector<f64>)> {
    let requested = PartsOptions {
        period: None,
        ..requested.clone()
    };
    let samples = Samples::of(test, &requested.reversals);
    let mut terms = all_terms(&requested);
    let (rows, spread, _) = identifiable(&samples, &mut terms, &requested, test.radius())?;
    let values = solved(&rows, &samples.deviation, &spread);
    let rest = &samples.deviation - &rows * &values;
    Some((samples, rows, rest))
}

/// Reversals with no step that a run has samples on both sides of.
fn unseen(test: &CircularTest, reversals: &[Reversal]) -> Vec<Term> {
    let profiles: Vec<Profile> = test.runs().iter().map(Profile::of).collect();
    // At a sample a profile is known even where a gap begins.
    let both_sides = |angle: f64| [angle - 2.0 * ON_STEP, angle + 2.0 * ON_STEP];
    let is_seen = |angle: f64| {
        let both = |profile: &Profile| both_sides(angle).iter().all(|side| profile.at(*side).is_some());
        profiles.iter().any(both)
    };
    let reversals = reversals.iter().enumerate();
    reversals
        .filter(|(_, reversal)| !reversal.steps.iter().any(|step| is_seen(step.angle)))
        .map(|(index, _)| Term::Reversal(index))
        .collect()
}

/// Every requested term, in the order of the results.
fn all_terms(requested: &PartsOptions) -> Vec<Term> {
    let mut terms = vec![
        Term::Radius,
        Term::Offset(Axis::A),
        Term::Offset(Axis::B),
        Term::ScaleMismatch,
        Term::Squareness,
    ];
    terms.extend((0..requested.reversals.len()).map(Term::Reversal));
    terms.extend([Term::DirectionRadius, Term::ServoMismatch]);
    terms.extend(
        (3..=requested.most_lobes).flat_map(|n| [Wave::Cosine, Wave::Sine].map(|wave| Term::Lobes(n, wave))),
    );
    if requested.period.is_some() {
        for axis in [Axis::A, Axis::B] {
            terms.extend([Wave::Cosine, Wave::Sine].map(|wave| Term::Cyclic(axis, wave)));
        }
    }
    terms
}

/// Rows of the identifiable terms, and their spread; removes the others from `terms` and returns the sets.
fn identifiable(
    samples: &Samples,
    terms: &mut Vec<Term>,
    requested: &PartsOptions,
    radius: f64,
) -> Option<(DMatrix<f64>, Spread, Vec<Vec<Term>>)> {
    let turns = requested
        .period
        .map_or(0.0, |period| std::f64::consts::TAU * radius / period);
    if !turns.is_finite() {
        return None;
    }
    let mut sets = Vec::new();
    // Each round removes a term.
    loop {
        if terms.is_empty() || samples.at.len() <= terms.len() {
            return None;
        }
        let rows = DMatrix::from_fn(samples.at.len(), terms.len(), |row, column| {
            let (angle, direction) = samples.at[row];
            terms[column].at(angle, direction, &requested.reversals, turns)
        });
        let spread = Spread::of(&rows, &DMatrix::zeros(0, terms.len()), &vec![true; terms.len()]);
        let Some(set) = spread.together.first() else {
            return Some((rows, spread, sets));
        };
        sets.push(set.iter().map(|index| terms[*index]).collect());
        terms.remove(*set.last()?);
    }
}

/// Least squares through the covariance, with one refinement for rounding.
fn solved(rows: &DMatrix<f64>, right: &DVector<f64>, spread: &Spread) -> DVector<f64> {
    let first = &spread.covariance * rows.tr_mul(right);
    let left = right - rows * &first;
    first + &spread.covariance * rows.tr_mul(&left)
}

/// Squares of the deviation about the circle of the fit: without its radius and its position.
fn about_circle(samples: &Samples, terms: &[Term], rows: &DMatrix<f64>, values: &DVector<f64>) -> f64 {
    let circle = DVector::from_fn(values.len(), |index, _| match terms[index] {
        Term::Radius | Term::Offset(_) => values[index],
        _ => 0.0,
    });
    (&samples.deviation - rows * circle).norm_squared()
}
