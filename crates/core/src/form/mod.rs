//! Form, size and location of features from points of a part, after ISO 1101, ISO 12781, ISO 12780, ISO 12180 and ISO 14405-1.
//!
//! [`chebyshev`] (the unknowns with the least largest residual, with proof); [`line`](mod@line) (straightness), [`plane`]
//! (flatness, tilt, orientation), [`cylinder`] (least squares, minimum zone, inscribed, circumscribed, size, position),
//! [`slices`] (roundness along a cylinder), [`profile`] (profile of a surface). `neighbours`: points in the cells of a grid;
//! [`thickness`](mod@thickness) (of a wall), [`wavelengths`] (what a prediction explains). [`surface`] (nearest place on a mesh, with sign),
//! [`align`] (best fit to it), [`datum`] (3-2-1), [`superposition`](mod@superposition) (pairs of points). `error`: errors of all these.
//!
//! Points in m, in one frame. Theory: `docs/theory/form.md`.

pub mod align;
pub mod chebyshev;
pub mod cylinder;
pub mod datum;
mod error;
pub mod line;
mod neighbours;
pub mod plane;
pub mod profile;
pub mod slices;
pub mod superposition;
pub mod surface;
pub mod thickness;
pub mod wavelengths;

pub use align::{Alignment, AlignmentOptions, WeightedPoints, best_fit};
pub use chebyshev::{Minimax, ResidualSide, SupportRow, minimax};
pub use cylinder::{Cylinder, CylinderForm};
pub use datum::{DatumNormals, DatumTargets};
pub use error::FormError;
pub use line::Straightness;
pub use plane::{Flatness, PlaneDeparture};
pub use profile::{NormalDeviation, SurfaceProfile};
pub use slices::SliceRoundness;
pub use superposition::{Superposition, superposition};
pub use surface::NominalSurface;
pub use thickness::Thickness;
pub use wavelengths::AgreementByWavelength;
