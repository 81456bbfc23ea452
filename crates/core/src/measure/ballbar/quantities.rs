//! The quantities of ISO 230-4: circular deviation, radial deviation, mean bidirectional radial deviation, hysteresis.
//!
//! | symbol | definition | centre |
//! |---|---|---|
//! | `G` | least radial distance of two concentric circles with all samples between them | its own: minimum zone |
//! | `F` | greatest and least `r - R`, outwards positive | the reference centre of the samples |
//! | `D` | radius of the least-squares circle of both directions, minus `R` | its own |
//! | `H` | largest difference of the radius between the directions at one angle; older editions | that of the samples |
//!
//! The standard requires one run of a full turn in each direction. With several runs of a direction `G` and `F` include
//! all samples, `D` and `H` are of their mean. With a part of a turn `G` and `F` refer to that arc, `D` is not
//! reported.
//!
//! Source: scope of ISO 230-4:2005 for the list; definitions \[recalled\].

use std::f64::consts::TAU;

use nalgebra::Point2;

use super::centre::least_squares_centre;
use super::difference::between_directions;
use super::profile::{self, wrapped};
use super::run::{CircularTest, Run};
use crate::roundness::{Profile, RoundnessError};

/// A radial deviation with its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// m, outwards positive.
    pub deviation: f64,
    /// From 0 to below a turn, rad.
    pub angle: f64,
}

/// Quantities of several runs together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantities {
    /// Circular deviation G (minimum zone), m.
    ///
    /// # Errors
    /// Samples without a narrowest ring: at one point, or on an arc too short for its form.
    pub circular: Result<f64, RoundnessError>,
    /// Radial deviation F: least, greatest.
    pub radial: [Extreme; 2],
    /// The least measured part of a turn among the runs, rad: a whole one if there is no gap.
    pub arc: f64,
}

/// G and F of all samples of these runs of `test` together; `None` of no runs.
pub fn quantities(test: &CircularTest, runs: &[&Run]) -> Option<Quantities> {
    let samples = || runs.iter().flat_map(|run| run.samples());
    let extreme = |(angle, deviation): (f64, f64)| Extreme {
        deviation,
        angle: wrapped(angle),
    };
    let least = samples().min_by(|a, b| a.1.total_cmp(&b.1)).map(extreme)?;
    let greatest = samples().max_by(|a, b| a.1.total_cmp(&b.1)).map(extreme)?;
    let place = |(a, dr): (f64, f64)| Point2::new(a.cos(), a.sin()) * (test.radius() + dr);
    let places: Vec<Point2<f64>> = samples().map(place).collect();
    Some(Quantities {
        circular: Profile::new(places)
            .and_then(|profile| profile.minimum_zone())
            .map(|zone| zone.peak_to_valley()),
        radial: [least, greatest],
        arc: runs
            .iter()
            .map(|run| profile::Profile::of(run).arc())
            .fold(TAU, f64::min),
    })
}

/// Mean bidirectional radial deviation D, m; `None` unless there are full turns both ways.
pub fn mean_bidirectional(test: &CircularTest) -> Option<f64> {
    let full = test
        .runs()
        .iter()
        .all(|run| profile::Profile::of(run).arc() >= TAU);
    let centre = least_squares_centre(test).filter(|_| full && test.is_bidirectional());
    centre.map(|centre| centre.radius - test.radius())
}

/// Hysteresis H, m: the largest difference of the mean radius between the directions; `None` where only one was
/// measured, or no angle in both directions.
pub fn hysteresis(test: &CircularTest) -> Option<f64> {
    between_directions(test).span().map(|span| span.largest.abs())
}
