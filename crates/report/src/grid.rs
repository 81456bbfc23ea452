//! The grid of points behind every map: axis values in mm and the state of each point.
//!
//! ```text
//! vertical_mm[ny-1]  p[(ny-1) nx] ...        p[ny nx - 1]
//!       ...                                                  drawn unchanged here: row 0 at the bottom
//! vertical_mm[0]     p[0]         p[1] ...   p[nx - 1]
//!               horizontal_mm[0]  [1]  ...   [nx - 1]
//! ```

use armill_core::marching_squares::ScalarField;

/// What is known at one grid point. A point out of reach is a state, not a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointState {
    /// Reached within the joint limits; the value in um.
    Reached(f64),
    /// Reached only beyond a joint limit; the value in um there. Such points are drawn with their value and
    /// hatched.
    OutsideJointLimits(f64),
    /// Out of reach: without a posture, and therefore without a value.
    Unreachable,
}

impl PointState {
    /// The value in um, if the point has one; a value that is not finite counts as none.
    pub fn value_um(self) -> Option<f64> {
        match self {
            Self::Reached(v) | Self::OutsideJointLimits(v) => Some(v).filter(|v| v.is_finite()),
            Self::Unreachable => None,
        }
    }
}

/// Points of a plane on a rectangular lattice; the steps need not be equal.
///
/// Any values may be given: a grid that cannot be drawn (axes that do not rise or fall steadily, less than 2 x
/// 2 points, a wrong number of points, none with a value) gives a picture that says so.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Values of the horizontal axis in mm from left to right, rising or falling.
    pub horizontal_mm: Vec<f64>,
    /// Values of the vertical axis in mm from bottom to top, rising or falling.
    pub vertical_mm: Vec<f64>,
    /// The points, row by row from the bottom, each row from left to right.
    pub points: Vec<PointState>,
}

impl Grid {
    /// Why this grid cannot be drawn as a map, or nothing if it can.
    pub(crate) fn obstacle(&self) -> Option<String> {
        let (nx, ny) = (self.horizontal_mm.len(), self.vertical_mm.len());
        if nx == 0 || ny == 0 {
            return Some("There is nothing to draw: the grid has no points.".to_owned());
        }
        if self.points.len() != nx * ny {
            let given = self.points.len();
            return Some(format!(
                "The grid has {nx} x {ny} points, but {given} values were given."
            ));
        }
        if nx < 2 || ny < 2 {
            let reached = self.values_um().count();
            let range = crate::axis::extent(self.values_um()).map_or_else(String::new, |(low, high)| {
                format!(
                    ", from {} to {} µm",
                    crate::axis::three_digits(low),
                    crate::axis::three_digits(high)
                )
            });
            return Some(format!(
                "A map needs at least 2 x 2 points; this grid has {nx} x {ny} ({reached} reached{range})."
            ));
        }
        if !(is_steady(&self.horizontal_mm) && is_steady(&self.vertical_mm)) {
            return Some("The axis values of the grid neither rise steadily nor fall steadily.".to_owned());
        }
        if self.values_um().next().is_none() {
            return Some(format!("None of the {} points is within reach.", nx * ny));
        }
        None
    }

    /// The same points, each value higher by `times` its own part of `by_um`. Not checked: that there is one
    /// part for each point; points without one are lost.
    pub(crate) fn raised(&self, by_um: &[f64], times: f64) -> Grid {
        let raise = |(point, by): (&PointState, &f64)| match point {
            PointState::Reached(value) => PointState::Reached(value + times * by),
            PointState::OutsideJointLimits(value) => PointState::OutsideJointLimits(value + times * by),
            PointState::Unreachable => PointState::Unreachable,
        };
        Grid {
            points: self.points.iter().zip(by_um).map(raise).collect(),
            ..self.clone()
        }
    }

    /// Samples of these points, one each, in their order.
    pub(crate) fn sampled<'a>(&'a self, samples: &'a [f64]) -> ScalarField<'a, f64> {
        ScalarField {
            x: &self.horizontal_mm,
            y: &self.vertical_mm,
            values: samples,
        }
    }

    /// The finite values in um.
    pub(crate) fn values_um(&self) -> impl Iterator<Item = f64> + '_ {
        self.points.iter().filter_map(|p| p.value_um())
    }

    /// Whether some point has no value.
    pub(crate) fn has_unreachable(&self) -> bool {
        self.points.iter().any(|p| p.value_um().is_none())
    }

    /// Whether some point is reached only beyond a joint limit.
    pub(crate) fn has_outside_limits(&self) -> bool {
        self.points
            .iter()
            .any(|p| matches!(p, PointState::OutsideJointLimits(_)) && p.value_um().is_some())
    }
}

/// Whether values rise steadily or fall steadily, and all are finite; equal neighbours do neither.
pub(crate) fn is_steady(values: &[f64]) -> bool {
    values.iter().all(|v| v.is_finite())
        && (values.windows(2).all(|w| w[1] > w[0]) || values.windows(2).all(|w| w[1] < w[0]))
}
