//! The commands: options to a call of `armill-study`, its result to stdout, as text or JSON.
//!
//! One file per command: `run`, `check`, `compare`, `new`, `robots` (a folder, for its subcommands), `export`, `materials`,
//! `pose` (`pose_subject`: a robot, or the cell of a study), `posture`, `place`, `advise`, `compensate`, `identify`, `calibrate`, `learn`, `journal`, `tracker`, `forces`, `roundness`, `ballbar`,
//! `backlash`, `budget`, `pose_accuracy`, `path_accuracy`, `motion`, `drives`, `frf`, `modes`, `receptance`, `stability`, `serve`, `completions`, `man`. `poses`: options of measured
//! poses. `program`: options of a robot program. `drawing`: writes requested pictures.
//!
//! Each command has one function `run(&Arguments) -> Result<Outcome, StudyError>`: it finds robot or study,
//! converts the options (numbers checked, mm and degrees to SI), calls `armill_study`, writes
//! the requested files, and prints the result last. An error in writing a file is therefore reported before
//! a result that would seem complete. The functions `as_text` or `..._text` format a result
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
pub(crate) mod drives;
pub(crate) mod export;
pub(crate) mod forces;
pub(crate) mod frf;
pub(crate) mod identify;
pub(crate) mod journal;
pub(crate) mod learn;
pub(crate) mod man;
pub(crate) mod materials;
pub(crate) mod modes;
pub(crate) mod motion;
pub(crate) mod new;
pub(crate) mod path_accuracy;
pub(crate) mod place;
pub(crate) mod pose;
pub(crate) mod pose_accuracy;
mod pose_subject;
pub(crate) mod posture;
pub(crate) mod receptance;
pub(crate) mod robots;
pub(crate) mod roundness;
pub(crate) mod run;
pub(crate) mod serve;
pub(crate) mod stability;
pub(crate) mod tracker;

mod drawing;
mod poses;
mod program;
