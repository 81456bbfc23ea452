//! What may be given in addition to cutter locations: the dialect and the unit.

use std::fmt;

use crate::toolpath::LengthUnit;

/// Whose cutter locations these are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// SolidWorks CAM: a GOTO without axis means 0,0,1.
    SolidWorks,
    /// Siemens NX: a GOTO without axis means the axis before.
    Nx,
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dialect::SolidWorks => "SolidWorks CAM",
            Dialect::Nx => "Siemens NX",
        })
    }
}

/// Options for a file that does not give these values.
#[derive(Clone, Copy, Debug, Default)]
pub struct AptReadOptions {
    /// The unit of a file without UNITS line; a file that has one keeps it.
    pub unit: Option<LengthUnit>,
    /// The dialect, whatever the file looks like.
    pub dialect: Option<Dialect>,
}
