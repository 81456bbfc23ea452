//! How much of measured deviations a prediction explains, overall and by wavelength along the surface.
//!
//! ```text
//! explained share   1 - var(m - p) / var(m)
//! slope, correlation of m over p:   cov(m, p) / var(p),   cov(m, p) / sqrt(var(m) var(p))
//! low-pass of a field f at x:   sum of g f / sum of g,   g = exp(-pi (r / (a L))^2),  a = sqrt(ln 2 / pi)
//! bands: long = low-pass(L1);  middle = low-pass(L2) - low-pass(L1);  short = f - low-pass(L2)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m`, `p` | measured and predicted deviation | m |
//! | `r` | distance of two points in space | m |
//! | `L`, `L1 > L2` | cut-off wavelengths: half of the amplitude passes | m |
//!
//! The filter is that of ISO 16610-61 as a weighted mean over the points, so that patches may have any outline; near their edge
//! it is one-sided and passes less exactly. It is cut off at 1.5 a L (9e-4 of it is beyond). Where cells of 0.15 a L have many
//! points, their means are used: 0.8 % less passes at the cut-off. Valid for patches that are flat or bend with a radius above the cut-off.
//!
//! Uncertainties of slope and correlation are those of a jackknife that leaves out blocks with an edge of L1: deviations
//! at neighbouring points are not independent, and formulas for independent points would give too small values.
//! Source: ISO 16610-61:2015; B. Efron, C. Stein, The jackknife estimate of variance, Annals of Statistics 9, 1981.

use nalgebra::Point3;
use rayon::prelude::*;

use super::error::FormError;
use super::neighbours::Neighbours;
use super::plane::known;

/// `sqrt(ln 2 / pi)`: half of the amplitude passes at the cut-off.
const HALF: f64 = 0.469_718_639_349_825_65;
/// Where the kernel ends, in `a L`.
const END: f64 = 1.5;
/// Cells of the means, in `a L`.
const CELL: f64 = 0.15;
/// Fewer blocks than this give no uncertainty.
const LEAST_BLOCKS: usize = 6;

/// Measured and predicted deviation at points of a patch.
#[derive(Clone, Copy, Debug)]
pub struct DeviationPairs<'a> {
    /// m
    pub points: &'a [Point3<f64>],
    /// Measured deviation of each point, m.
    pub measured: &'a [f64],
    /// Predicted deviation of each point, m.
    pub predicted: &'a [f64],
}

/// How far a prediction agrees with a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictionAgreement {
    /// Variance of the measured deviations, m^2.
    // unit: m^2
    pub variance: f64,
    /// Explained share of it: 1 of a perfect prediction, 0 of its mean, below 0 of a worse one. `None` without variance.
    pub explained: Option<f64>,
    /// Slope of measured over predicted; `None` where the prediction does not vary.
    pub slope: Option<f64>,
    /// Correlation; `None` where either does not vary.
    pub correlation: Option<f64>,
}

/// Agreement overall and by bands of wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgreementByWavelength {
    /// Of all wavelengths.
    pub overall: PredictionAgreement,
    /// Longer than the first cut-off.
    pub long: PredictionAgreement,
    /// Between both.
    pub middle: PredictionAgreement,
    /// Shorter than the second.
    pub short: PredictionAgreement,
    /// Standard uncertainty of the overall slope; `None` with too few blocks.
    pub slope_uncertainty: Option<f64>,
    /// Standard uncertainty of the overall correlation.
    pub correlation_uncertainty: Option<f64>,
}

/// Agreement of measured and predicted deviations, by wavelengths above `cut_offs[0]`, above `cut_offs[1]`, and below it (m).
///
/// # Errors
/// Fewer than three points, lists of different lengths, values that are not finite; cut-offs that are not above 0 and
/// descending.
pub fn agreement_by_wavelength(
    pairs: &DeviationPairs<'_>,
    cut_offs: [f64; 2],
) -> Result<AgreementByWavelength, FormError> {
    known(pairs.points, 3)?;
    for list in [pairs.measured, pairs.predicted] {
        if list.len() != pairs.points.len() {
            return Err(FormError::Lengths {
                needed: pairs.points.len(),
                given: list.len(),
            });
        }
        if let Some(index) = list.iter().position(|d| !d.is_finite()) {
            return Err(FormError::NotFinite { index });
        }
    }
    let [long, short] = cut_offs;
    // A cut-off in nm has no more cells than fit a whole number.
    if !(short > 1e-9 && short < long && long.is_finite()) {
        return Err(FormError::Length { value: short });
    }
    let fields: Vec<[f64; 2]> = pairs
        .measured
        .iter()
        .zip(pairs.predicted)
        .map(|(m, p)| [*m, *p])
        .collect();
    let [low, high] = cut_offs.map(|cut_off| low_pass(pairs.points, &fields, cut_off));
    let difference = |one: &[[f64; 2]], other: &[[f64; 2]]| -> Vec<[f64; 2]> {
        one.iter()
            .zip(other)
            .map(|(a, b)| [a[0] - b[0], a[1] - b[1]])
            .collect()
    };
    let all = Moments::of(&fields);
    let blocks = blocks(pairs.points, &fields, long);
    Ok(AgreementByWavelength {
        overall: all.agreement(),
        long: Moments::of(&low).agreement(),
        middle: Moments::of(&difference(&high, &low)).agreement(),
        short: Moments::of(&difference(&fields, &high)).agreement(),
        slope_uncertainty: jackknife(&all, &blocks, |agreement| agreement.slope),
        correlation_uncertainty: jackknife(&all, &blocks, |agreement| agreement.correlation),
    })
}

/// Both fields without wavelengths below the cut-off, m.
fn low_pass(points: &[Point3<f64>], fields: &[[f64; 2]], cut_off: f64) -> Vec<[f64; 2]> {
    let width = HALF * cut_off;
    // Means of small cells: place, fields, number of points.
    let mut places = Vec::new();
    let mut means = Vec::new();
    for group in Neighbours::new(points, CELL * width).groups() {
        let count = group.len() as f64;
        let (mut place, mut mean) = (nalgebra::Vector3::zeros(), [0.0; 2]);
        for (_, index) in group {
            place += points[*index as usize].coords;
            (0..2).for_each(|k| mean[k] += fields[*index as usize][k]);
        }
        places.push(Point3::from(place / count));
        means.push((mean, count));
    }
    let cells = Neighbours::new(&places, END * width);
    let at = |point: &Point3<f64>| {
        let (mut sum, mut weights) = ([0.0; 2], 0.0);
        cells.visit(point, |index, square| {
            let weight = (-std::f64::consts::PI * square / (width * width)).exp();
            let (mean, count) = means[index];
            (0..2).for_each(|k| sum[k] += weight * mean[k]);
            weights += weight * count;
        });
        sum.map(|sum| sum / weights)
    };
    points.par_iter().map(at).collect()
}

/// Sums over pairs.
#[derive(Clone, Copy, Default)]
struct Moments {
    count: f64,
    sums: [f64; 2],
    /// m m, p p, m p
    products: [f64; 3],
}

impl Moments {
    fn of(fields: &[[f64; 2]]) -> Moments {
        let mut moments = Moments::default();
        for [m, p] in fields {
            moments.count += 1.0;
            moments.sums[0] += m;
            moments.sums[1] += p;
            for (product, by) in moments.products.iter_mut().zip([m * m, p * p, m * p]) {
                *product += by;
            }
        }
        moments
    }

    fn without(&self, other: &Moments) -> Moments {
        Moments {
            count: self.count - other.count,
            sums: [0, 1].map(|k| self.sums[k] - other.sums[k]),
            products: [0, 1, 2].map(|k| self.products[k] - other.products[k]),
        }
    }

    fn agreement(&self) -> PredictionAgreement {
        let n = self.count;
        let [m, p] = self.sums.map(|sum| sum / n);
        let [mm, pp, mp] = self.products.map(|product| product / n);
        // Below rounding there is no variance.
        let above_rounding =
            |square: f64, mean: f64| Some(square - mean * mean).filter(|v| *v > 1e-13 * square);
        let (measured, predicted) = (above_rounding(mm, m), above_rounding(pp, p));
        let both = mp - m * p;
        let rest = (mm - m * m) - 2.0 * both + (pp - p * p);
        PredictionAgreement {
            variance: measured.unwrap_or(0.0),
            explained: measured.map(|variance| 1.0 - rest.max(0.0) / variance),
            slope: predicted.map(|variance| both / variance),
            correlation: measured
                .zip(predicted)
                .map(|(m, p)| (both / (m * p).sqrt()).clamp(-1.0, 1.0)),
        }
    }
}

/// The sums of each block with this edge, m.
fn blocks(points: &[Point3<f64>], fields: &[[f64; 2]], edge: f64) -> Vec<Moments> {
    let of = |group: &[([i64; 3], u32)]| {
        let own: Vec<[f64; 2]> = group.iter().map(|entry| fields[entry.1 as usize]).collect();
        Moments::of(&own)
    };
    Neighbours::new(points, edge).groups().map(of).collect()
}

/// Standard uncertainty of a value by leaving out one block after the other.
fn jackknife(
    all: &Moments,
    blocks: &[Moments],
    value: impl Fn(&PredictionAgreement) -> Option<f64>,
) -> Option<f64> {
    let count = blocks.len();
    if count < LEAST_BLOCKS {
        return None;
    }
    let values: Vec<f64> =
        (blocks.iter().map(|block| value(&all.without(block).agreement()))).collect::<Option<_>>()?;
    let mean = values.iter().sum::<f64>() / count as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some((squares * (count - 1) as f64 / count as f64).sqrt())
}

#[cfg(test)]
mod tests;
