//! Samples of the uncertain inputs of an arm, and the deviation of the tool for each of them (JCGM 101:2008).
//!
//! In reading order: `quantile` (normal distribution), `sobol_numbers` and [`draws`] (random and quasi-random numbers of a seed), [`inputs`]
//! (independent standard normal inputs of an arm, and the arm with a sample of them), [`spring_sums`] (many samples of compliances at many joint
//! positions), [`deviations`] (all sources of deviation).

pub mod deviations;
pub mod draws;
pub mod inputs;
mod quantile;
mod sobol_numbers;
pub mod spring_sums;

pub use deviations::SampledDeviations;
pub use draws::{Draws, MOST_DIMENSIONS, Method};
pub use inputs::{InputSource, InputSpace, SampledArm, SampledInput};
pub use spring_sums::{SpringSums, TermSlots};
