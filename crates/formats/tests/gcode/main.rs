//! G-code programs: those of LinuxCNC against its own interpreter, and our own.

mod programs;
mod samples;
