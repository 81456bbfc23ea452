//! The Python module `armill._armill`: arrays and options in, results of `armill_core` and `armill_study` out.
//!
//! | module | contents |
//! |---|---|
//! | `robot_class` | the class `Robot`; `robot_uncertainty`: its uncertainties and springs; `robot_masses`: what depends on masses; `robot`: its arm and compliances; `source`: the text that it is made from |
//! | `samples` | the class `Samples`: samples of the uncertain inputs of a robot; `springs`: compliances or samples in place of those of a robot |
//! | `joint_positions`, `postures`, `evaluation` | results at many joint positions or poses; `joint_evaluation`: arrays of them |
//! | `study`, `outcome`, `table` | the classes `Study`, `Result` and `Table`; `table_columns`: columns as arrays |
//! | `placement_evaluations` | the class `PlacementEvaluations`: the cost of a path for many placements of its part |
//! | `tool_path` | the class `ToolPath`: the moves of a program |
//! | `answer` | commands as functions, and the command itself; `operands`, `robot_file`: robots and studies as files |
//! | `export` | a robot as the text of a file for other programs |
//! | `arrays`, `poses`, `results` | conversion of numbers, poses and forces from and to arrays |
//! | `html`, `containers` | tables for notebooks; results as dicts, data frames and data sets |
//! | `threads` | thread pools, release of the lock of Python, Ctrl-C |
//! | `arithmetic` | whether two machines give the same bits |
//! | `errors` | exceptions |
//!
//! It computes nothing: no mechanics, only SI units on both sides.

// Options of Python are arguments by keyword.
#![allow(clippy::too_many_arguments)]

mod answer;
mod arithmetic;
mod arrays;
mod containers;
mod errors;
mod evaluation;
mod export;
mod html;
mod joint_evaluation;
mod joint_positions;
mod operands;
mod outcome;
mod placement_evaluations;
mod poses;
mod postures;
mod results;
mod robot;
mod robot_class;
mod robot_file;
mod robot_masses;
mod robot_uncertainty;
mod samples;
mod source;
mod springs;
mod study;
mod table;
mod table_columns;
mod threads;
mod tool_path;

/// The native part of the package `armill`.
#[pyo3::pymodule]
mod _armill {
    /// The version of armill, which is that of the command.
    #[allow(non_upper_case_globals)]
    #[pymodule_export]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use crate::answer::{call, command, options};
    #[pymodule_export]
    use crate::arithmetic::arithmetic;
    #[pymodule_export]
    use crate::errors::{Cancelled, Fault, InputError};
    #[pymodule_export]
    use crate::evaluation::PoseEvaluations;
    #[pymodule_export]
    use crate::outcome::Outcome;
    #[pymodule_export]
    use crate::placement_evaluations::PlacementEvaluations;
    #[pymodule_export]
    use crate::postures::Postures;
    #[pymodule_export]
    use crate::robot::Robot;
    #[pymodule_export]
    use crate::robot_uncertainty::normal_draws;
    #[pymodule_export]
    use crate::samples::Samples;
    #[pymodule_export]
    use crate::study::Study;
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::tool_path::{ToolPath, read_path};
}
