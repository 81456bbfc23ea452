//! What all measurements of one arm say together: geometry, compliances and backlash by Bayes.
//!
//! In reading order: [`parameter`] (what is uncertain, and what is known of it before), [`measurement`] (campaigns: positions of a
//! point, its distances from a pivot, load tests), `state` (an arm with values of all parameters, and the rows of a campaign there), [`posterior`] (the most likely
//! values with their covariance), [`work`] (the uncertainty of the deviation where the arm will work), [`next`](mod@next) (what to
//! measure next).
//!
//! `calibrate` and `identify` are the special cases of one kind of measurement; unlike them all measurements are used at once, each
//! with its own scatter, and what they do not determine stays as it was known before. Theory: `docs/theory/journal.md`.

pub mod measurement;
pub mod next;
pub mod parameter;
pub mod posterior;
mod state;
#[cfg(test)]
mod tests;
pub mod work;

pub use measurement::{Campaign, Condition, Distances, Known, Observed, Positions, pivot_of};
pub use next::{Candidate, Chosen, Instrument, Plan, next};
pub use parameter::{Knowledge, Parameter, PriorFactors, prior};
pub use posterior::{CampaignOutcome, Posterior, Refusal, update};
pub use work::{Work, WorkPoint};
