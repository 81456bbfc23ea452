//! What moves the tool away from where it was asked to be?
//!
//! Every source is a module of the same shape: parameters, deviation, sensitivity, tests. `predict.rs` adds
//! them in a visible row.

pub mod elastic;
