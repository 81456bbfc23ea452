//! AT and RT of made-up runs against closed forms. See README.md.

use armill_core::measure::path_accuracy::{PathAccuracy, path_accuracy};
use nalgebra::Vector3;

use crate::check::{Check, ErrorBound, worst};

const CLOSED: &str = "closed form";
const COMPUTED: &str = "independent computation";
const RADIUS: f64 = 0.1;
const RUNS: u32 = 5;

/// Radius beyond the nominal one and height of run `j` at the angle `a`, m.
fn off(j: u32, a: f64) -> [f64; 2] {
    let run = f64::from(j);
    let lifted = f64::from(j % 2) * 4.0 * a.sin();
    [
        1e-6 * (20.0 + 5.0 * run + 10.0 * (3.0 * a + run).sin()),
        1e-6 * (8.0 * (2.0 * a).cos() + 3.0 * run - 6.0 + lifted),
    ]
}

/// Run `j`, from before the first point to behind the last.
fn run(j: u32) -> Vec<Vector3<f64>> {
    let count = 20_000 + 1_237 * j;
    (0..=count)
        .map(|k| {
            let a = -0.08 + 5.4 * f64::from(k) / f64::from(count);
            let [wider, z] = off(j, a);
            Vector3::new((RADIUS + wider) * a.cos(), (RADIUS + wider) * a.sin(), z)
        })
        .collect()
}

/// An arc of 300 degrees, a point every 5.
fn arc() -> Option<PathAccuracy> {
    let commanded: Vec<Vector3<f64>> = (0..=60)
        .map(|k| (f64::from(k) * 5.0).to_radians())
        .map(|a| Vector3::new(RADIUS * a.cos(), RADIUS * a.sin(), 0.0))
        .collect();
    let runs: Vec<_> = (0..RUNS).map(run).collect();
    let mut found = path_accuracy(&commanded, &runs).ok()?;
    // The tangent at an end is that of its segment, not of the arc.
    found.points.retain(|point| (1..60).contains(&point.index));
    Some(found)
}

/// Offsets of 1, 2 and 6 um next to a line, sampled every 3, 7 and 11 mm.
fn line() -> Option<[f64; 2]> {
    let commanded: Vec<Vector3<f64>> = (0..=50).map(|k| Vector3::x() * f64::from(k) * 0.01).collect();
    let run = |step: f64, y: f64| -> Vec<Vector3<f64>> {
        let count = (0.55 / step) as u32;
        (0..=count)
            .map(|k| Vector3::new(-0.02 + f64::from(k) * step, y, 0.0))
            .collect()
    };
    let found = path_accuracy(&commanded, &[run(3e-3, 1e-6), run(7e-3, 2e-6), run(11e-3, 6e-6)]).ok()?;
    Some([found.accuracy()?.1, found.repeatability()?.1])
}

/// AT and RT, and where they are.
pub fn checks() -> Vec<Check> {
    let found = arc();
    let of = |(place, value): (usize, f64)| Some((found.as_ref()?.points[place].index, value * 1e6));
    let at = found.as_ref().and_then(PathAccuracy::accuracy).and_then(of);
    let rt = found.as_ref().and_then(PathAccuracy::repeatability).and_then(of);
    let mean = found.as_ref().map_or(f64::NAN, |found| {
        let sum: f64 = found.points.iter().map(|point| point.offset.norm()).sum();
        sum / found.points.len() as f64 * 1e6
    });
    let computed = |what: &str, error: f64| {
        let gap = ErrorBound {
            worst: worst([error]),
            tolerance: 1e-3,
            unit: "um",
        };
        Check::printed(what, COMPUTED, gap, 5)
    };
    let value = |given: Option<(usize, f64)>| given.map_or(f64::NAN, |(_, value)| value);
    let places = [at, rt].map(|given| given.map(|(index, _)| 5 * index));
    let [line_at, line_rt] = line().unwrap_or([f64::NAN; 2]);
    vec![
        computed("AT of five runs around an arc: 32.9154 um", value(at) - 32.9154),
        computed("RT of these: 37.1100 um", value(rt) - 37.1100),
        computed("mean of AT over their points: 30.4499 um", mean - 30.4499),
        Check::none_wrong(
            "positions of AT and RT: 5 and 200 deg",
            COMPUTED,
            places
                .iter()
                .zip([Some(5), Some(200)])
                .filter(|(found, there)| **found != *there)
                .count(),
        ),
        Check::computed(
            "AT and RT of three runs next to a line: 3 and 5 um",
            CLOSED,
            ErrorBound {
                worst: worst([line_at - 3e-6, line_rt - 5e-6]),
                tolerance: 1e-12,
                unit: "m",
            },
        ),
    ]
}
