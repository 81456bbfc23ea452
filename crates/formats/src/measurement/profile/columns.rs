//! Quantity and unit of a column of a profile, and the point of a row.
//!
//! | column | meaning | units |
//! |---|---|---|
//! | `x_mm`, `y_mm`; `z_mm` too | coordinates, of any axes | `_mm`, `_um`, `_m`, `_in` |
//! | `angle_deg` or `theta_deg` | angle about the instrument's centre, counter-clockwise | `_deg`, `_rad` |
//! | `radius_mm` or `r_mm` | distance from the centre | `_mm`, `_um`, `_m`, `_in` |
//! | `deviation_um` or `radius_dev_um` | distance from the centre minus a radius given as an option | `_mm`, `_um`, `_m`, `_in` |
//!
//! Names and units are not case-sensitive.

pub use super::length_unit::{LengthUnit, NoUnit};
use super::measured::ProfileReadOptions;
use armill_core::units::{from_deg, from_mm, to_deg, to_mm};

/// Maximum coordinate, m: that of [`armill_core::roundness::Profile`].
const FARTHEST: f64 = 1e6;
/// Maximum angle: a thousand turns of an instrument, rad.
const MOST_TURNS: f64 = 1e3 * std::f64::consts::TAU;

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Coordinate x, y or z: 0, 1, 2.
    Coordinate(usize),
    /// Angle about the instrument's centre.
    Angle,
    /// Distance from the centre.
    Radius,
    /// Distance from the centre minus the given radius.
    Deviation,
}

/// A column: its quantity, and the factor from its unit to m or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    pub quantity: Quantity,
    pub factor: f64,
}

impl Quantity {
    /// The quantity of a name without its unit.
    fn of_name(name: &str) -> Option<Quantity> {
        Some(match name {
            "x" => Quantity::Coordinate(0),
            "y" => Quantity::Coordinate(1),
            "z" => Quantity::Coordinate(2),
            "angle" | "theta" | "phi" => Quantity::Angle,
            "radius" | "r" => Quantity::Radius,
            "deviation" | "radius_deviation" | "radius_dev" => Quantity::Deviation,
            _ => return None,
        })
    }

    /// Its units, for messages.
    fn units(self) -> &'static str {
        match self {
            Quantity::Angle => "deg or rad",
            _ => "mm, um, m or in",
        }
    }

    /// The factor to SI of a unit.
    fn factor(self, unit: &str) -> Option<f64> {
        match (self, unit) {
            (Quantity::Angle, "deg") => Some(from_deg(1f64)),
            (Quantity::Angle, "rad") => Some(1.0),
            (Quantity::Angle, _) => None,
            _ => unit.parse::<LengthUnit>().ok().map(LengthUnit::factor),
        }
    }
}

/// The column of a name that ends in its unit; `None` for an unknown name.
///
/// # Errors
/// A known name without a unit, or with a unit of another quantity: problem and hint.
pub(super) fn named(name: &str) -> Result<Option<Column>, (String, String)> {
    let lower = name.trim().to_lowercase();
    if let Some(quantity) = Quantity::of_name(&lower) {
        return Err((
            format!("no unit is given for `{name}`"),
            format!("end the name with its unit: {}", quantity.units()),
        ));
    }
    let Some((plain, unit)) = lower.rsplit_once('_') else {
        return Ok(None);
    };
    let Some(quantity) = Quantity::of_name(plain) else {
        return Ok(None);
    };
    match quantity.factor(unit) {
        Some(factor) => Ok(Some(Column { quantity, factor })),
        None => Err((
            format!("`{unit}` is not a unit of `{plain}`"),
            format!("known units are {}", quantity.units()),
        )),
    }
}

/// How a row gives a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Layout {
    /// From x and y.
    Plane,
    /// From x, y and z.
    Space,
    /// From angle and radius.
    Polar,
    /// From angle and deviation from this radius, m.
    Deviation(f64),
}

/// The quantities in the order in which [`Layout::point`] uses their values.
const IN_ORDER: [Quantity; 6] = [
    Quantity::Coordinate(0),
    Quantity::Coordinate(1),
    Quantity::Coordinate(2),
    Quantity::Angle,
    Quantity::Radius,
    Quantity::Deviation,
];

impl Layout {
    /// The layout of rows with these columns; `requested` gives the radius to which deviations refer.
    ///
    /// # Errors
    /// Columns that give no point, or more than one; a radius that is missing, unused or not above 0: problem and
    /// hint.
    pub fn of(
        columns: &[Quantity],
        requested: &ProfileReadOptions,
    ) -> Result<Layout, (String, &'static str)> {
        let has = IN_ORDER.map(|quantity| columns.contains(&quantity));
        let layout = match has {
            [true, true, false, false, false, false] => Layout::Plane,
            [true, true, true, false, false, false] => Layout::Space,
            [false, false, false, true, true, false] => Layout::Polar,
            [false, false, false, true, false, true] => {
                let Some(radius_mm) = requested.radius_mm.or(requested.else_radius_mm) else {
                    let message = "deviations need the radius to which they refer".to_owned();
                    return Err((message, "give it (option `radius_mm`)"));
                };
                if !(radius_mm > 0.0 && from_mm(radius_mm) <= FARTHEST) {
                    let message = format!("a radius of {radius_mm} mm is not above 0 mm, or exceeds 1e9 mm");
                    return Err((message, "give the radius at which the deviation is 0"));
                }
                return Ok(Layout::Deviation(from_mm(radius_mm)));
            }
            _ => {
                let message = "these columns do not give points of a profile".to_owned();
                return Err((message, COLUMNS_HINT));
            }
        };
        match requested.radius_mm {
            Some(radius_mm) => {
                let message = format!(
                    "a radius of {radius_mm} mm was specified, but no column contains deviations from it"
                );
                Err((message, "leave out the radius"))
            }
            None => Ok(layout),
        }
    }

    /// The point of a row from its values in SI units, by [`Quantity`]; z is 0 in a plane.
    ///
    /// # Errors
    /// A value outside its range, with its quantity: problem and range.
    pub fn point(self, value: impl Fn(Quantity) -> f64) -> Result<[f64; 3], (Quantity, String)> {
        let coordinate = |axis: usize| {
            let quantity = Quantity::Coordinate(axis);
            match value(quantity) {
                at if at.abs() <= FARTHEST => Ok(at),
                at => Err((quantity, format!("a coordinate of {at} m exceeds {FARTHEST} m"))),
            }
        };
        let around = |quantity: Quantity, radius: f64| {
            let angle = value(Quantity::Angle);
            if angle.abs() > MOST_TURNS {
                let message = format!("an angle of {} deg exceeds 1000 turns", to_deg(angle));
                return Err((Quantity::Angle, message));
            }
            if !(radius > 0.0 && radius <= FARTHEST) {
                let message = format!(
                    "a radius of {} mm is not above 0 mm, or exceeds 1e9 mm",
                    to_mm(radius)
                );
                return Err((quantity, message));
            }
            let (sin, cos) = angle.sin_cos();
            Ok([radius * cos, radius * sin, 0.0])
        };
        match self {
            Layout::Plane => Ok([coordinate(0)?, coordinate(1)?, 0.0]),
            Layout::Space => Ok([coordinate(0)?, coordinate(1)?, coordinate(2)?]),
            Layout::Polar => around(Quantity::Radius, value(Quantity::Radius)),
            Layout::Deviation(radius) => around(Quantity::Deviation, radius + value(Quantity::Deviation)),
        }
    }

    /// Whether its points are in space.
    pub fn is_space(self) -> bool {
        self == Layout::Space
    }
}

/// Columns that give points.
pub(super) const COLUMNS_HINT: &str = "name the columns `x_mm,y_mm`, `x_mm,y_mm,z_mm`, `angle_deg,radius_mm`, or \
                                       `angle_deg,deviation_um` together with the option `radius_mm`";
