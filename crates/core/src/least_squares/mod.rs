//! Least squares: `triangle` (any number of linear rows in little memory), `descent` (nonlinear, Levenberg and Marquardt), `rigid` (displacement and rotation
//! between two sets of points).

mod descent;
mod rigid;
mod triangle;

pub(crate) use descent::{Problem, descend};
pub(crate) use rigid::superposed;
pub(crate) use triangle::{Triangle, solve};
