//! The Python module `armill._armill`: arrays and options in, the values of `armill_core` and `armill_study` out.
//!
//! | module | what it is |
//! |---|---|
//! | `robot` | the class `Robot`; `source`: where it comes from |
//! | `stands`, `postures`, `held` | what it answers about many joint positions or poses |
//! | `study`, `table` | the classes `Study` and `Result`; tables as Arrow |
//! | `judged` | the class `Judged`: a path wherever its part lies |
//! | `tool_path` | the class `ToolPath`: the moves of a program |
//! | `answer` | commands as functions, and the command itself |
//! | `arrays`, `poses` | numbers, poses and forces out of arrays, and back |
//! | `threads` | on which threads, without the lock of Python, until Ctrl-C |
//! | `arithmetic` | whether two machines give the same bits |
//! | `errors` | exceptions |
//!
//! It computes nothing: no mechanics, no units but SI on both sides.

// Options of Python are arguments by keyword.
#![allow(clippy::too_many_arguments)]

mod answer;
mod arithmetic;
mod arrays;
mod errors;
mod evaluation;
mod judged;
mod poses;
mod postures;
mod robot;
mod source;
mod stands;
mod study;
mod table;
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
    use crate::answer::{analysis, command, options};
    #[pymodule_export]
    use crate::arithmetic::arithmetic;
    #[pymodule_export]
    use crate::errors::{Cancelled, Fault, InputError};
    #[pymodule_export]
    use crate::evaluation::Held;
    #[pymodule_export]
    use crate::judged::Judged;
    #[pymodule_export]
    use crate::postures::Postures;
    #[pymodule_export]
    use crate::robot::Robot;
    #[pymodule_export]
    use crate::study::{Outcome, Study};
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::tool_path::{ToolPath, read_path};
}
