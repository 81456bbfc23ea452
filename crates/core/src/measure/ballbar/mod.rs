//! Circular tests with a ball-bar.
//!
//! In reading order: [`run`] (the measured radii), [`profile`] (a run as radii over the angle), [`centre`] (centre of
//! the circle), [`quantities`](mod@quantities) (G, F, D and H of ISO 230-4), [`difference`] (between runs, between
//! directions), [`lobes`](mod@lobes) (waves of n times a turn), [`outlier`] (dirt), [`parts`] (scale, squareness, steps
//! at reversals: each with its uncertainty), [`taught`](mod@taught) (the circle to teach instead), [`joints`]
//! (reversals and backlash of the joints of an arm).
//!
//! Theory, signs and limits of the method: `docs/theory/ballbar.md`.

pub mod centre;
pub mod difference;
pub mod joints;
pub mod lobes;
pub mod outlier;
pub mod parts;
pub mod profile;
pub mod quantities;
pub mod run;
pub mod taught;

pub use centre::{Centre, least_squares_centre};
pub use difference::{Difference, Span, between_directions, repeats};
pub use lobes::{Lobes, lobes, most_lobes};
pub use outlier::{Outlier, outliers};
pub use profile::Profile;
pub use quantities::{Extreme, Quantities, hysteresis, mean_bidirectional, quantities};
pub use run::{CircularTest, Direction, Run, RunError};
pub use taught::{Taught, taught};
