//! Order of the uncertain inputs of load and tool.

/// The inputs: amount of the load, three forces, length of the tool.
pub(super) const INPUTS: usize = 5;
pub(super) const AMOUNT: usize = 0;
pub(super) const FORCES: usize = 1;
pub(super) const LENGTH: usize = 4;
