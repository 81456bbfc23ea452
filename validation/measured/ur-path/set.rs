//! A path of a UR arm, passed three times forth and back, by a laser tracker. See README.md.

use std::io::BufReader;

use armill_core::measure::passes::{Passes, distance_from, evenly};
use armill_core::nalgebra::Vector3;
use armill_core::units::to_um;
use armill_formats::measurement::trace;

use crate::measured::{Comparison, Samples, Stated};

/// Points of a pass that are compared.
const POINTS: usize = 501;
/// Points at each end that are left out: there passes begin and end in different places.
const ENDS: usize = 5;

/// Distances of all passes from the first one.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let passes = passes(samples);
    let first = &passes.forth[0];
    let row = |quantity: &str, passes: &[Vec<Vector3<f64>>]| {
        let points = passes.iter().flat_map(|pass| {
            let points = evenly(pass, POINTS);
            points[ENDS..POINTS - ENDS].to_vec()
        });
        Comparison {
            quantity: quantity.to_owned(),
            model: "first pass forth".to_owned(),
            unit: "um",
            errors: points.map(|point| to_um(distance_from(&point, first))).collect(),
            stated: Stated::Nothing,
        }
    };
    vec![
        row("the other passes forth", &passes.forth[1..]),
        row("the passes back", &passes.back),
    ]
}

fn passes(samples: &Samples) -> Passes {
    let path = samples.path("ur-path-tracker/Trajektoriezw1u2_vel50.txt");
    let shown = path.display().to_string();
    let file = std::fs::File::open(&path).unwrap_or_else(|error| panic!("{shown}: {error}"));
    let traces = trace::read(&shown, BufReader::new(file)).unwrap_or_else(|error| panic!("{error}"));
    let mut all = Passes::default();
    for run in &traces.runs {
        all.extend(Passes::of(&run.points));
    }
    all
}
