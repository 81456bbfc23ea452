//! Form, size and location of features from points of a part, after ISO 1101, ISO 12781, ISO 12780, ISO 12180 and ISO 14405-1.
//!
//! [`chebyshev`] (the unknowns with the least largest residual, with proof); [`plane`] (flatness, tilt, orientation), [`line`](mod@line)
//! (straightness), [`cylinder`] (least squares, minimum zone, inscribed, circumscribed, size, position), [`profile`] (profile of
//! a surface). `error`: errors of all these.
//!
//! Points in m, in one frame. Theory: `docs/theory/form.md`.

pub mod chebyshev;
pub mod cylinder;
mod error;
pub mod line;
pub mod plane;
pub mod profile;

pub use chebyshev::{Minimax, ResidualSide, SupportRow, minimax};
pub use cylinder::{Cylinder, CylinderForm};
pub use error::FormError;
pub use line::Straightness;
pub use plane::{Flatness, PlaneDeparture};
pub use profile::SurfaceProfile;
