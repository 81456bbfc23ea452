//! A path on a part, evaluated at many placements of the part.
//!
//! In reading order: `points` (the path in planes), `weighed` (their deviation), `tally` (totals over the path),
//! `placer` (evaluates placements).

mod placer;
mod points;
mod tally;
mod weighed;

pub(in crate::kernel) use placer::Placer;
pub(in crate::kernel) use points::PlacementPoints;
pub(in crate::kernel) use tally::Tallied;
