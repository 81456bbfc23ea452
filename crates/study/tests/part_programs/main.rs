//! Programs of real parts, cut three times: by the dexels of a part, by the height map of a stock where the tool is upright, and by points that are tested one by one.
//!
//! [`program`]: the programs, their tools and stocks. [`moving_tool`]: a tool on a move, and whether it reaches a point. [`points`]: points of a stock, and the
//! first move that removes each. Both share no code with the removal of the core: moves are those of the program, with whole arcs.
//! [`volumes`]: volumes of parts and moves. [`engagement`]: depth, width and volume at points of a path.
//!
//! Real files, in the folder that `ARMILL_SAMPLES` names; without it nothing is checked, and the tests say so.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod engagement;
mod moving_tool;
mod points;
mod program;
mod volumes;

/// A cubic millimetre in m^3.
const MM3: f64 = 1e-9;
/// A millimetre in m.
const MM: f64 = 1e-3;
