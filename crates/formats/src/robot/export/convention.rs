//! Conventions of Denavit-Hartenberg tables.

use std::str::FromStr;

/// A convention of Denavit-Hartenberg parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DhConvention {
    /// `Rz(theta) Tz(d) Tx(a) Rx(alpha)`.
    #[default]
    Standard,
    /// `Rx(alpha) Tx(a) Rz(theta) Tz(d)`.
    Modified,
    /// `Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)`.
    Hayati,
}

impl DhConvention {
    /// Every convention.
    pub const ALL: [DhConvention; 3] = [
        DhConvention::Standard,
        DhConvention::Modified,
        DhConvention::Hayati,
    ];

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            DhConvention::Standard => "standard",
            DhConvention::Modified => "modified",
            DhConvention::Hayati => "hayati",
        }
    }

    /// The product of a row.
    pub(super) fn product(self) -> &'static str {
        match self {
            DhConvention::Standard => "Rz(theta) Tz(d) Tx(a) Rx(alpha)",
            DhConvention::Modified => "Rx(alpha) Tx(a) Rz(theta) Tz(d)",
            DhConvention::Hayati => "Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)",
        }
    }
}

impl FromStr for DhConvention {
    type Err = String;

    /// The convention of this name.
    ///
    /// # Errors
    /// Another name; the message lists those that there are.
    fn from_str(name: &str) -> Result<DhConvention, String> {
        let found = DhConvention::ALL.into_iter().find(|known| known.name() == name);
        found.ok_or_else(|| {
            let names = DhConvention::ALL.map(DhConvention::name).join(", ");
            format!("`{name}` is none of {names}")
        })
    }
}
