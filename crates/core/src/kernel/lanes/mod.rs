//! The closed form over lanes: ortho-parallel arms with spherical wrist, many poses at once.

mod aimed;
mod aims;
mod angle;
mod arm;
mod arrays;
mod backend;
mod batch;
mod block;
mod compliance;
mod deviation;
mod envelope;
mod flexibility;
mod forward;
mod limits;
mod points;
mod positions;
mod prepared;
mod real;
mod screws;
mod solve;
mod stance;
mod vector;

pub use arrays::{Arrays, Envelopes, Poses};
pub use backend::{Backend, Precision};
pub use batch::Batch;
pub(super) use points::{POINTS, Points};
pub use real::{Float, Real};
pub use solve::flag;
