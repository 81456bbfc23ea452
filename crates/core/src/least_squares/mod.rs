//! Nonlinear least squares: `triangle` (any number of linear rows in little memory), `descent` (Levenberg and Marquardt).

mod descent;
mod triangle;

pub(crate) use descent::{Problem, descend};
pub(crate) use triangle::{Triangle, solve};
