//! The columns of the vibration: of all points that a series has it for.

use std::f64::consts::TAU;

use armill_core::units::{to_mm, to_um};

use super::points::{PointVibration, SeriesVibration};
use crate::analysis::numbers::Numbers;
use crate::analysis::quantity::Quantity;
use crate::analysis::vibration_quantity::{AMPLITUDE, LOWEST_MODE, STABLE_DEPTH, SURFACE_ERROR};

/// A value of a point, in the unit of its quantity.
type Value = fn(&PointVibration) -> Option<f64>;

/// Every quantity of the vibration.
const VALUES: [(&Quantity, Value); 4] = [
    (&LOWEST_MODE, |point| point.lowest.map(|lowest| lowest / TAU)),
    (&STABLE_DEPTH, |point| {
        point.cut.map(|cut| to_mm(cut.stable_depth()))
    }),
    (&AMPLITUDE, |point| {
        point.cut?.forced.map(|forced| to_um(forced.amplitude))
    }),
    (&SURFACE_ERROR, |point| point.cut?.forced?.wall.map(to_um)),
];

/// The columns of a series: of the quantities that some of its points have.
pub fn columns<'a>(series: Option<&SeriesVibration>) -> Vec<Numbers<'a>> {
    let Some(series) = series else {
        return Vec::new();
    };
    let has = |value: &Value| series.points.iter().flatten().any(|point| value(point).is_some());
    let column = |(quantity, value): (&'static Quantity, Value)| Numbers {
        quantity,
        name: quantity.key.to_owned(),
        fill: Box::new(move |rows, points, values| {
            let at = |index: usize| value(rows.vibration?.points.get(index)?.as_ref()?);
            values.extend(points.map(at));
        }),
    };
    VALUES
        .into_iter()
        .filter(|(_, value)| has(value))
        .map(column)
        .collect()
}
