//! The command `armill`: see the library of this package.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(armill::command(std::env::args_os()))
}
