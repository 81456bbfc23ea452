//! How round does the tool go, and why not rounder? Circular tests with a ball-bar.
//!
//! In reading order: [`run`] (what was measured), [`profile`] (a run as radii over the angle), [`centre`] (where the circle
//! lies), [`quantities`](mod@quantities) (G, F, D and H of ISO 230-4), [`difference`] (between runs, between directions), [`lobes`](mod@lobes)
//! (how much goes round n times a turn), [`outlier`] (dirt), [`parts`] (scale, squareness, steps at reversals: each with its uncertainty),
//! [`taught`](mod@taught) (the circle to teach instead), [`joints`] (which joints of an arm turn back where, and with how much play).
//!
//! Theory, signs and what the numbers leave out: `docs/theory/ballbar.md`.

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
