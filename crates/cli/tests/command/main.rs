//! The command as a user meets it: one program with all its tests, so that it is linked once.
//!
//! `cell` is where they run. What a user meets first: `new_and_robots`, `shell`, `documents` (every page is run).
//! Commands: `run`,
//! `pose`, `place`, `advise`, `springs`, `assumed`, `robots_check`, `import`, `export`, `bodies`, `masses`, `materials`, `identify`, `calibrate`, `learn`, `journal`, `tracker`,
//! `forces`, `roundness`, `ballbar`, `budget`, `path_accuracy`, `motion`, `frf`, `receptance`, `stability`, `compare`, `clearance`, `restricted_space`, `holes`, `unloaded` (backlash). What goes
//! wrong: `refused`, `guarded` (files of the user), `hostile` (numbers and bytes),
//! `terminal`, `killed`, `rough` (places and inputs), `slips` (mistakes that are easily made). `without_masses`: an arm whose links have none.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod advise;
mod assumed;
mod backlash;
mod ballbar;
mod bodies;
mod budget;
mod calibrate;
mod cell;
mod clearance;
mod compare;
mod compensate;
mod disturbed_jobs;
mod documents;
mod drives;
mod export;
mod forces;
mod frf;
mod guarded;
mod holes;
#[cfg(target_os = "linux")]
mod hostile;
mod identify;
mod import;
mod journal;
#[cfg(unix)]
mod killed;
mod learn;
mod machined_part;
mod masses;
mod materials;
mod modes;
mod motion;
mod new_and_robots;
mod path_accuracy;
mod pictures;
mod place;
mod place_in_cell;
mod pose;
mod posture;
mod receptance;
mod refused;
mod restricted_space;
mod robots_check;
mod rough;
mod roundness;
mod rounds;
mod run;
mod scanned_pocket;
mod serve;
mod shell;
mod slips;
mod springs;
mod stability;
mod terminal;
mod tracker;
mod unloaded;
#[path = "../../../study/tests/shared/without_masses.rs"]
mod without_masses;
