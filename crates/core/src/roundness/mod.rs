//! Roundness: reference circles of a profile of measured points, and the deviations from them.
//!
//! [`least_squares`](mod@least_squares): the circle nearest to points. [`profile`]: a valid set of points, scaled by
//! its radius. `circumscribed`: the smallest circle about them. `search`: the global optimum of the centre, with proof;
//! [`zone`] and `inscribed` use it: the narrowest ring that contains the points, the largest circle between them.
//! [`polar`]: deviations over the angle; [`outlier`]: outliers of the profile; `filter` and `harmonics`: its waves.
//! [`plane`]: points in space, projected on their plane. `reach`: the nearest and farthest point; `error`: errors of
//! all these.
//!
//! Names after ISO 12181: LSCI, MZCI, MCCI and MICI are the four reference circles, RONt the peak to valley about one.
//! Theory: `docs/theory/roundness.md`.

mod circumscribed;
mod error;
mod filter;
mod harmonics;
mod inscribed;
pub mod least_squares;
pub mod outlier;
pub mod plane;
pub mod polar;
pub mod profile;
mod reach;
mod search;
pub mod zone;

pub use error::RoundnessError;
pub use harmonics::Harmonic;
pub use least_squares::{ReferenceCircle, least_squares};
pub use plane::Plane;
pub use polar::{Gap, Polar};
pub use profile::Profile;
pub use zone::Zone;
