//! A plane with its grid.

use armill_core::workpiece::Grid;

use crate::input::setting::Setting;

/// A plane with its grid.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// How the points are evaluated.
    pub setting: Setting,
    /// Which points.
    pub grid: Grid,
}
