//! How round is it: which circles belong to a profile of measured points, and how far do the points lie off them?
//!
//! [`least_squares`](mod@least_squares): the circle nearest to points. [`profile`]: points that a circle can be put to, in
//! radii of it. `circumscribed`: the smallest circle about them. `search`: the best centre of all, with proof;
//! [`zone`] and `inscribed` ask for it: the narrowest ring that holds the points, the largest circle between them.
//! [`polar`]: deviations over the angle; [`outlier`]: what is not of the profile; `filter` and `harmonics`: their waves.
//! [`plane`]: points in space, seen in their plane. `error`: what keeps any of these from being told.
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
mod search;
pub mod zone;

pub use error::RoundnessError;
pub use harmonics::Harmonic;
pub use least_squares::{ReferenceCircle, least_squares};
pub use plane::Plane;
pub use polar::{Gap, Polar};
pub use profile::Profile;
pub use zone::Zone;
