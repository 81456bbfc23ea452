//! What each command does: options into a question, the answer of `armill-study` onto stdout, in words or as JSON.
//!
//! A file a command: `run`, `check`, `compare`, `new`, `robots` (a folder, for its own commands), `materials`, `pose`, `posture`, `place`, `advise`, `compensate`, `identify`, `calibrate`,
//! `forces`, `roundness`, `ballbar`, `backlash`, `budget`, `pose_accuracy`, `path_accuracy`, `serve`, `completions`, `man`. `poses`: options of measured poses. `program`: options of a program of the robot. `numbers`: what an option that takes numbers refuses. `drawing`: pictures that were asked for.
//!
//! Each command has one function `run(&Arguments) -> Result<Outcome, StudyError>`: it finds robot or study,
//! makes the question from the options (numbers checked, mm and degrees into SI), asks `armill_study`, writes
//! the files that were asked for, and prints the answer last. So a file that cannot be written is told before
//! an answer that would seem complete. The functions called `as_text` or `..._text` make words out of an answer
//! and compute no more than the length of a vector or a percentage.

pub(crate) mod advise;
pub(crate) mod backlash;
pub(crate) mod ballbar;
pub(crate) mod budget;
pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod compensate;
pub(crate) mod completions;
pub(crate) mod forces;
pub(crate) mod identify;
pub(crate) mod man;
pub(crate) mod materials;
pub(crate) mod new;
pub(crate) mod path_accuracy;
pub(crate) mod place;
pub(crate) mod pose;
pub(crate) mod pose_accuracy;
pub(crate) mod posture;
pub(crate) mod robots;
pub(crate) mod roundness;
pub(crate) mod run;
pub(crate) mod serve;

mod drawing;
mod numbers;
mod poses;
mod program;
