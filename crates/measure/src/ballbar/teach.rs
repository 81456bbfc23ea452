//! Two-step teaching: the corrected circle after a first test, and the comparison of a second test with the first.
//!
//! | column of the table | unit | meaning |
//! |---|---|---|
//! | `angle_deg` | deg | along the circle |
//! | `radius_mm`, `correction_um` | mm, um | radius to teach, and its difference from the nominal one |
//! | `x_mm`, `y_mm` | mm | the point from the centre, along the axes of the plane |

use std::f64::consts::TAU;

use armill_core::measure::ballbar::{Extreme, Taught, taught};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_study::StudyError;
use armill_study::measured::circular_test::MeasuredTest;
use armill_study::number::decimals;
use serde::Serialize;

use super::analyse::BallbarAnalysis;

/// A circle to teach.
#[derive(Clone, Debug, Serialize)]
pub struct TaughtAnswer {
    /// How many points.
    pub points: usize,
    /// Highest lobe that is corrected: as requested, or as many as the samples resolve.
    pub most_lobes: usize,
    /// Largest move of a point.
    pub largest_correction_um: f64,
    /// Circular deviation of all runs before, about their own centre.
    pub circular_before_um: Option<f64>,
    /// The expected value with the corrected circle.
    pub circular_expected_um: Option<f64>,
    /// Radial deviation about the least-squares centre before: least, greatest.
    pub radial_before_um: [f64; 2],
    /// The expected value.
    pub radial_expected_um: [f64; 2],
    /// Half of the largest difference between the directions, which cannot be corrected. None for one direction.
    pub stays_um: Option<f64>,
}

impl TaughtAnswer {
    /// Warnings before this circle is taught; `most_lobes` were requested.
    pub fn warnings(&self, most_lobes: usize) -> Vec<String> {
        let fewer = (self.most_lobes < most_lobes).then(|| {
            format!(
                "the corrected circle compensates {} lobes, not {most_lobes}: the samples are too far apart for more",
                self.most_lobes
            )
        });
        let worse = match (self.circular_before_um, self.circular_expected_um) {
            (Some(before), Some(expected)) if expected >= before => Some(format!(
                "do not teach this circle: the circularity would change from {before:.1} to {expected:.1} um; steps at reversals \
                 of joints are not lobes (`armill backlash` reports the joints)"
            )),
            _ => None,
        };
        fewer.into_iter().chain(worse).collect()
    }
}

/// The circle itself.
#[derive(Clone, Debug)]
pub struct TaughtCircle {
    /// Nominal radius, m.
    pub radius: f64,
    /// What is added to it at even angles from 0 on, m.
    pub corrections: Vec<f64>,
    found: Taught,
}

impl TaughtCircle {
    /// Radius to teach at an angle of the files (rad), m.
    pub fn radius_at(&self, angle: f64) -> f64 {
        self.radius + self.found.correction(angle)
    }

    /// A row a point, as CSV.
    ///
    /// # Errors
    /// A table that cannot be.
    pub fn csv(&self) -> Result<Vec<u8>, StudyError> {
        Ok(csv::write(&table(self.radius, &self.corrections)?))
    }
}

/// A previous test for comparison.
#[derive(Clone, Debug, Serialize)]
pub struct BeforeAnswer {
    /// Its files.
    pub files: Vec<String>,
    /// Each quantity, before and after.
    pub compared: Vec<ComparedQuantity>,
}

/// A quantity before and after.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedQuantity {
    /// What it is.
    pub what: &'static str,
    /// In the first test; none if it is not known.
    pub before_um: Option<f64>,
    /// In the second.
    pub after_um: Option<f64>,
    /// How much is left.
    pub left_percent: Option<f64>,
}

/// The corrected circle at `points` equally spaced angles with lobes up to `most_lobes`, or as many as the samples
/// resolve: its values and itself. For the test as reported: without outliers if these were excluded.
///
/// # Errors
/// Runs that are no full turns.
pub fn teach(
    shown: &BallbarAnalysis<'_>,
    points: usize,
    most_lobes: usize,
) -> Result<(TaughtAnswer, TaughtCircle), StudyError> {
    let found = taught(&shown.test, most_lobes).ok_or_else(|| {
        StudyError::value(
            "no circle can be taught from runs that leave a part of the turn open",
            "measure full turns",
        )
    })?;
    let um = |extremes: [Extreme; 2]| extremes.map(|extreme| to_um(extreme.deviation));
    let corrections: Vec<f64> = (0..points)
        .map(|k| found.correction(TAU * k as f64 / points as f64))
        .collect();
    let given = TaughtAnswer {
        points,
        most_lobes: found.lobes.harmonics.last().map_or(most_lobes, |lobe| lobe.waves),
        largest_correction_um: to_um(corrections.iter().map(|c| c.abs()).fold(0.0, f64::max)),
        circular_before_um: found.before.circular.ok().map(to_um),
        circular_expected_um: found.expected.circular.ok().map(to_um),
        radial_before_um: um(found.before.radial),
        radial_expected_um: um(found.expected.radial),
        stays_um: found.stays.map(to_um),
    };
    let circle = TaughtCircle {
        radius: shown.test.radius(),
        corrections,
        found,
    };
    Ok((given, circle))
}

/// A row a point.
fn table(radius: f64, corrections: &[f64]) -> Result<Table, StudyError> {
    let angle = |k: usize| TAU * k as f64 / corrections.len() as f64;
    let column = |name: &str, unit: &str, (decimals, of): (u8, &dyn Fn(usize) -> f64)| Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
        description: String::new(),
        decimals: Some(decimals),
        data: ColumnData::Float((0..corrections.len()).map(of).collect()),
    };
    let taught = |k: usize| radius + corrections[k];
    let columns = vec![
        column("angle_deg", "deg", (6, &|k| to_deg(angle(k)))),
        column("radius_mm", "mm", (6, &|k| to_mm(taught(k)))),
        column("correction_um", "um", (3, &|k| to_um(corrections[k]))),
        column("x_mm", "mm", (6, &|k| to_mm(taught(k) * angle(k).cos()))),
        column("y_mm", "mm", (6, &|k| to_mm(taught(k) * angle(k).sin()))),
    ];
    Ok(Table::new("taught", columns)?)
}

/// Comparison of the previous test with another.
///
/// # Errors
/// Tests of different circles: radius, plane or feed.
pub fn before(before: &BallbarAnalysis<'_>, after: &BallbarAnalysis<'_>) -> Result<BeforeAnswer, StudyError> {
    same_circle(before.measured, after.measured)?;
    let g = |found: &BallbarAnalysis<'_>, direction: usize| {
        found.directions[direction].and_then(|of| of.circular.ok())
    };
    let both =
        |found: &BallbarAnalysis<'_>| found.all.circular.ok().filter(|_| found.test.is_bidirectional());
    let f = |found: &BallbarAnalysis<'_>, end: usize| Some(found.all.radial[end].deviation);
    let compared = |what: &'static str, of: &dyn Fn(&BallbarAnalysis<'_>) -> Option<f64>| {
        let [before, after] = [before, after].map(|found| of(found).map(to_um));
        let left = before.zip(after).filter(|(before, _)| *before != 0.0);
        ComparedQuantity {
            what,
            before_um: before,
            after_um: after,
            left_percent: left.map(|(before, after)| 100.0 * (after / before).abs()),
        }
    };
    Ok(BeforeAnswer {
        files: before.measured.files.clone(),
        compared: vec![
            compared("G CW", &|found| g(found, 0)),
            compared("G CCW", &|found| g(found, 1)),
            compared("G(b)", &both),
            compared("F max", &|found| f(found, 1)),
            compared("F min", &|found| f(found, 0)),
            compared("D", &|found| found.mean_bidirectional),
            compared("H", &|found| found.hysteresis),
        ],
    })
}

/// Refuses to compare tests of different circles; values that one of them lacks are not compared.
fn same_circle(before: &MeasuredTest, after: &MeasuredTest) -> Result<(), StudyError> {
    let [one, other] = [before, after].map(|of| of.test.radius());
    let mm = |radius: f64| format!("{} mm", to_mm(radius));
    let feed = |feed: f64| format!("{} mm/min", decimals(feed * 60e3, 3));
    let feeds = before.feed.zip(after.feed);
    let planes = before.plane.as_ref().zip(after.plane.as_ref());
    let differing = [
        ((one - other).abs() > 1e-9 * other).then(|| ("nominal radius", mm(one), mm(other))),
        (planes.filter(|(one, other)| one != other))
            .map(|(one, other)| ("plane", one.clone(), other.clone())),
        feeds
            .filter(|(one, other)| (one - other).abs() > 1e-9 * other)
            .map(|(one, other)| ("feed", feed(one), feed(other))),
    ];
    match differing.into_iter().flatten().next() {
        None => Ok(()),
        Some((what, one, other)) => Err(StudyError::value(
            format!("--before: the {what} was {one}, but is {other} now"),
            "tests of one circle are compared, in the same plane and at the same feed",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warns_of_a_corrected_circle_that_is_worse() {
        let given = |expected: Option<f64>| TaughtAnswer {
            points: 72,
            most_lobes: 15,
            largest_correction_um: 22.5,
            circular_before_um: Some(158.4),
            circular_expected_um: expected,
            radial_before_um: [-80.0, 78.4],
            radial_expected_um: [-90.0, 79.6],
            stays_um: Some(77.8),
        };
        let worse = given(Some(169.6)).warnings(15);
        assert!(
            worse[0]
                .starts_with("do not teach this circle: the circularity would change from 158.4 to 169.6 um")
        );
        assert!(given(Some(34.9)).warnings(15).is_empty());
        assert!(given(None).warnings(15).is_empty());
        assert!(given(Some(34.9)).warnings(30)[0].contains("compensates 15 lobes, not 30"));
    }
}
