//! Our own programs: what each word does to the path, and every refusal once.

mod program;

mod arcs;
mod compensation;
mod cycles;
mod flow;
mod frames;
mod lengths_and_paces;
mod refusals;
