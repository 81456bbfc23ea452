//! What did a measurement of the path show, unloaded or under load?
//!
//! In reading order: [`ballbar`] (circular tests: the radius along a circle, both ways round).

pub mod ballbar;
