//! An entry of the list of quantities: what a number of a point is, and where it comes from.

/// A quantity of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Its key in tables and results, which ends in its unit.
    pub key: &'static str,
    /// Unit of its values.
    pub unit: Option<&'static str>,
    /// Significant decimals in text formats: a nanometre of deviation, a degree of 1e-6 (some 0.02 um at an arm's
    /// length), a position as given.
    pub decimals: u8,
    /// What it is, for people.
    pub words: &'static str,
    /// Where it comes from; none of a quantity that is an input.
    pub origin: Option<Origin>,
}

/// Where a quantity comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The file that computes it, below `crates/`.
    pub file: &'static str,
    /// The function there, behind the name of its type if it has one.
    pub function: &'static str,
    /// The page of `docs/theory/` with its equations; none if no page has them yet.
    pub theory: Option<&'static str>,
    /// The folder of `validation/` that compares it with the numbers of others; none if nothing does yet.
    pub validation: Option<&'static str>,
}
