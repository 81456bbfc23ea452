//! What may move, as numbers from 0 to 1, and the place that they mean. The formula is in
//! [`armill_study::file::placement`].

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::kernel::PartPlacement;
use armill_core::nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};
use armill_core::optimize::ToolTurn;
use armill_core::units::{from_deg, from_mm, to_deg, to_mm};
use armill_study::file::placement::PlaceTable;
use armill_study::input::setting::Setting;
use armill_study::number::decimals;
use schemars::JsonSchema;
use serde::Serialize;

/// Numbers that place a part and its tool.
pub(super) const DEGREES: usize = 8;

/// Permitted placements of the part.
#[derive(Clone, Debug)]
pub(super) struct Freedom {
    /// The reference frame of the study.
    base_from_reference: Isometry,
    /// Axes of the part, without their tilt if the plane is given by it.
    axes: UnitQuaternion<f64>,
    /// Whether the plane is given by its tilt.
    by_tilt: bool,
    turn: ToolTurn,
    /// Whether the rail may move.
    rail: bool,
    /// Least and greatest of each degree of freedom, m and rad; the same if it is fixed.
    bounds: [[f64; 2]; DEGREES],
}

/// A placement, in terms of the study.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlaceAnswer {
    /// `plane.centre_mm`.
    pub centre_mm: [f64; 3],
    /// `plane.tilt_deg`, if the plane is given by it.
    pub tilt_deg: Option<f64>,
    /// `plane.rotation_deg`, otherwise.
    pub rotation_deg: Option<[f64; 3]>,
    /// Spin of the tool about its axis, relative to that of the study.
    pub spin_deg: f64,
    /// Position of the rail, if it is free.
    pub rail_mm: Option<f64>,
}

/// A degree that was free.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FreeAnswer {
    /// Its key in the study, with the unit of the numbers.
    pub degree: &'static str,
    /// Least value.
    // unit: that of its degree
    pub least: f64,
    /// Greatest value.
    // unit: that of its degree
    pub greatest: f64,
    /// The value at the best placement.
    // unit: that of its degree
    pub value: f64,
    /// Whether it is at one of its bounds: wider bounds may allow a better placement.
    pub at_bound: bool,
}

impl Freedom {
    /// For a path with `setting` and its rail at `rail` (m), with the spin of the tool as in `turn`, within the
    /// bounds of `table`.
    pub fn new(setting: &Setting, rail: f64, turn: ToolTurn, table: &PlaceTable) -> Freedom {
        let base_from_reference = setting.base_from_reference;
        let reference_from_part = base_from_reference.inverse() * setting.plane.base_from_part;
        let tilt = setting.tilt.unwrap_or(0.0);
        let at = reference_from_part.translation.vector;
        let here = [at.x, at.y, at.z, 0.0, tilt, 0.0, 0.0, rail];
        let mut bounds = here.map(|value| [value, value]);
        for (bounds, (key, reported)) in bounds.iter_mut().zip(table.bounds()) {
            if let Some(reported) = reported {
                *bounds = reported.map(|value| match key.ends_with("_mm") {
                    true => from_mm(value),
                    false => from_deg(value),
                });
            }
        }
        Freedom {
            base_from_reference,
            axes: about(Vector3::y_axis(), -tilt) * reference_from_part.rotation,
            by_tilt: setting.tilt.is_some(),
            turn,
            rail: table.rail_mm.is_some(),
            bounds,
        }
    }

    /// How many degrees are free.
    pub fn count(&self) -> usize {
        self.free().count()
    }

    /// The free degrees, with their bounds, m and rad.
    pub fn free(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        let all = self.bounds.iter().copied().enumerate();
        all.filter(|(_, [least, greatest])| least < greatest)
    }

    /// The values of all degrees, m and rad, where the free ones have these parts of their ranges.
    pub fn values(&self, at: &[f64]) -> [f64; DEGREES] {
        let mut values = self.bounds.map(|[least, _]| least);
        for ((degree, [least, greatest]), part) in self.free().zip(at) {
            values[degree] = least + (greatest - least) * part;
        }
        values
    }

    /// The part at these values, in the reference frame of the study.
    fn reference_from_part(&self, [x, y, z, heading, tilt, roll, ..]: [f64; DEGREES]) -> Isometry {
        let rotation = about(Vector3::z_axis(), heading)
            * about(Vector3::y_axis(), tilt)
            * self.axes
            * about(Vector3::z_axis(), roll);
        Isometry::from_parts(Translation3::new(x, y, z), rotation)
    }

    /// The place where the free degrees have these parts of their ranges.
    pub fn part_placement(&self, at: &[f64]) -> PartPlacement {
        self.placement_of(self.values(at))
    }

    /// The place where the degrees have these values, m and rad.
    pub fn placement_of(&self, values: [f64; DEGREES]) -> PartPlacement {
        let base_from_part = self.base_from_reference * self.reference_from_part(values);
        let [.., spin, rail] = values;
        PartPlacement {
            rail: self.rail.then_some(rail),
            ..self.turn.placement(base_from_part, spin)
        }
    }

    /// The free degrees there.
    pub fn reported(&self, at: &[f64]) -> Vec<FreeAnswer> {
        let values = self.values(at);
        let reported = |(degree, bounds): (usize, [f64; 2])| {
            let unit = |value: f64| match is_angle(degree) {
                true => to_deg(value),
                false => to_mm(value),
            };
            let [least, greatest] = bounds;
            let edge = 1e-3 * (greatest - least);
            FreeAnswer {
                degree: NAMES[degree],
                least: decimals(unit(least), 4),
                greatest: decimals(unit(greatest), 4),
                value: decimals(unit(values[degree]), 4),
                at_bound: values[degree] < least + edge || values[degree] > greatest - edge,
            }
        };
        self.free().map(reported).collect()
    }

    /// The same placement in terms of the study.
    pub fn answer(&self, at: &[f64]) -> PlaceAnswer {
        let values = self.values(at);
        let [x, y, z, heading, tilt, roll, spin, rail] = values;
        let by_tilt = self.by_tilt && heading == 0.0 && roll == 0.0;
        let rotation = fixed_angles(&self.reference_from_part(values).rotation);
        // A tenth of a micrometre: finer than a part can be placed.
        let reported = |value: f64| decimals(value, 4) + 0.0;
        let deg = |angle: f64| reported(to_deg(angle));
        PlaceAnswer {
            centre_mm: [x, y, z].map(|value| reported(to_mm(value))),
            tilt_deg: by_tilt.then(|| deg(tilt)),
            rotation_deg: (!by_tilt).then(|| rotation.map(deg).into()),
            spin_deg: deg(spin),
            rail_mm: self.rail.then(|| reported(to_mm(rail))),
        }
    }
}

/// The keys of the degrees in a study.
pub(super) const NAMES: [&str; DEGREES] = [
    "x_mm",
    "y_mm",
    "z_mm",
    "heading_deg",
    "tilt_deg",
    "roll_deg",
    "spin_deg",
    "rail_mm",
];

/// Whether this degree is an angle.
pub(super) fn is_angle(degree: usize) -> bool {
    NAMES[degree].ends_with("_deg")
}

fn about(axis: Unit<Vector3<f64>>, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&axis, angle)
}
