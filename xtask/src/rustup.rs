//! The standard library of Rust for another target, installed by rustup.

use std::process::{Command, Stdio};

/// Installs the standard library for a target where it is missing.
///
/// # Errors
/// In a line: rustup is not installed, does not know the target, or cannot download it.
pub fn add_target(target: &str) -> Result<(), String> {
    eprintln!("installing the standard library for {target}, if it is missing");
    let added = Command::new("rustup")
        .args(["target", "add", target])
        .stderr(Stdio::null())
        .status();
    match added.is_ok_and(|status| status.success()) {
        true => Ok(()),
        false => Err(format!(
            "the standard library for {target} is missing: rustup target add {target} (https://rustup.rs)"
        )),
    }
}
