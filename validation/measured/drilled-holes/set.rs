//! FANUC R-2000iC: 20 drilled holes, each place predicted from the three others. See README.md.

use crate::drilled_holes::{HOLES, Hole, POSTURES, at};
use crate::measured::{Comparison, NORMAL_95, Samples, Stated};

/// One quantity of a hole, and the size that a model gives it up to a factor.
type Model<'a> = &'a dyn Fn(&Hole) -> f64;

/// Increase of the speed and diameter, by the compliance along the drill and by their mean.
pub fn comparisons(_: &Samples) -> Vec<Comparison> {
    let root = |hole: &Hole| at(hole).1.sqrt();
    let one = |_: &Hole| 1.0;
    let increase = |hole: &Hole| hole.surge - hole.feed;
    let oversize = |hole: &Hole| hole.diameter - NOMINAL_DIAMETER;
    let mut rows = Vec::new();
    for (quantity, unit, measured) in [
        (
            "increase of the speed at breakthrough, places held out",
            "mm/s",
            &increase as Model<'_>,
        ),
        ("diameter over 10 mm, places held out", "mm", &oversize),
    ] {
        for (model, by) in [
            ("mean of the other places", &one as Model<'_>),
            ("root of the compliance along the drill", &root),
        ] {
            let (errors, coverage) = without_its_place(measured, by);
            rows.push(Comparison {
                quantity: quantity.to_owned(),
                model: model.to_owned(),
                unit,
                errors,
                stated: Stated::Coverage(coverage),
            });
        }
    }
    rows
}

/// Diameter of the drill, mm.
const NOMINAL_DIAMETER: f64 = 10.0;

/// Errors of `measured` by a multiple of `by`, whose factor and scatter are those of the other places, and the fraction within 95 %.
fn without_its_place(measured: Model<'_>, by: Model<'_>) -> (Vec<f64>, f64) {
    let places = HOLES.chunks_exact(POSTURES);
    let mut errors = Vec::new();
    let mut within = 0.0;
    for (k, place) in places.clone().enumerate() {
        let others: Vec<&Hole> = places
            .clone()
            .enumerate()
            .filter(|(j, _)| *j != k)
            .flat_map(|(_, holes)| holes)
            .collect();
        let [factor, u_factor, scatter] = factor(&others, measured, by);
        for hole in place {
            let error = measured(hole) - factor * by(hole);
            let u = (scatter * scatter + (u_factor * by(hole)).powi(2)).sqrt();
            within += f64::from(error.abs() <= NORMAL_95 * u);
            errors.push(error);
        }
    }
    let count = errors.len() as f64;
    (errors, within / count)
}

/// Least squares of `measured = factor by`: the factor, its standard uncertainty, the scatter.
fn factor(holes: &[&Hole], measured: Model<'_>, by: Model<'_>) -> [f64; 3] {
    let sum = |of: &dyn Fn(&Hole) -> f64| holes.iter().map(|hole| of(hole)).sum::<f64>();
    let square = sum(&|hole| by(hole).powi(2));
    let factor = sum(&|hole| by(hole) * measured(hole)) / square;
    let left = sum(&|hole| (measured(hole) - factor * by(hole)).powi(2));
    let scatter = (left / (holes.len() as f64 - 1.0)).sqrt();
    [factor, scatter / square.sqrt(), scatter]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formula_of_the_page_is_that_of_all_holes() {
        let all: Vec<&Hole> = HOLES.iter().collect();
        // Per root of 1 um/N.
        let root = |hole: &Hole| (at(hole).1 * 1e6).sqrt();
        let found = factor(&all, &|hole| hole.surge - hole.feed, &root);
        // Factor, its standard uncertainty, scatter.
        let printed = [48.9, 5.2, 34.3];
        for (found, printed) in found.iter().zip(printed) {
            assert!((found - printed).abs() < 0.05, "{found} {printed}");
        }
    }
}
