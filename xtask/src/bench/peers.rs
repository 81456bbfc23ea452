//! What the peers need: a virtual environment under `target/`, a C++ compiler, cmake.
//!
//! Pinocchio comes as a wheel that contains its C++ headers and those of Eigen and Boost; so does cmake.
//!
//! | thing | where | made from |
//! |---|---|---|
//! | virtual environment | `target/bench-venv` | `bench/python/requirements.txt`, reinstalled when that changes |
//! | armill's wheel | `target/bench-wheels` | the sources, for release |
//! | programs in C++ | `target/bench-...` | `bench/cpp/`, rebuilt when the source is newer |
//!
//! numba works on one thread and on all, the others on one. Nothing outside `target/` is installed.

use super::WORKLOAD;
use crate::command::printed;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

/// Where the packages of the peers are installed, and the list of them.
const VENV: &str = "target/bench-venv";
const WHEELS: &str = "target/bench-wheels";
const REQUIREMENTS: &str = "bench/python/requirements.txt";
const PINOCCHIO: CppPeer = CppPeer {
    source: "bench/cpp/pinocchio.cpp",
    program: "target/bench-pinocchio",
};
const BY_HAND: CppPeer = CppPeer {
    source: "bench/cpp/limit.cpp",
    program: "target/bench-limit",
};
/// Environment variables that limit the thread pools of numpy and others; the loops of numba say themselves.
const THREADS: &[&str] = &["OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"];

/// Makes the virtual environment, or brings it up to date.
///
/// # Errors
/// Why it cannot be had.
pub fn virtual_environment() -> Result<(), String> {
    let requested = fs::read_to_string(REQUIREMENTS).map_err(|problem| problem.to_string())?;
    // A copy of the list is next to what was installed from it.
    let installed = Path::new(VENV).join("requirements.txt");
    if fs::read_to_string(&installed).is_ok_and(|installed| installed == requested) {
        return Ok(());
    }
    eprintln!("installing into {VENV}: {}", packages(&requested).join(", "));
    printed(Command::new("python3").args(["-m", "venv", VENV]))?;
    printed(Command::new(in_venv("python")).args(["-m", "pip", "install", "--quiet", "-r", REQUIREMENTS]))?;
    fs::write(installed, requested).map_err(|problem| problem.to_string())
}

/// The peers in Python.
pub fn python() -> Command {
    let mut command = Command::new(in_venv("python"));
    command.args(["bench/python/peers.py", WORKLOAD]);
    command.envs(THREADS.iter().map(|name| (name, "1")));
    command.env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

/// armill's own Python package, built for release and installed.
///
/// # Errors
/// Why it cannot be built.
pub fn package() -> Result<Command, String> {
    let wheels = absolute(WHEELS)?;
    let _ = fs::remove_dir_all(&wheels);
    let mut build = Command::new(absolute(VENV)?.join("bin/maturin"));
    build.args(["build", "--release", "--out"]).arg(&wheels);
    printed(build.current_dir("python"))?;
    let mut install = Command::new(in_venv("python"));
    let arguments = "-m pip install -q --force-reinstall --no-deps --no-index --find-links";
    printed(install.args(arguments.split(' ')).arg(&wheels).arg("armill"))?;
    let mut command = Command::new(in_venv("python"));
    command.arg("bench/python/armill_package.py");
    command.envs(THREADS.iter().map(|name| (name, "1")));
    command.env("PYTHONDONTWRITEBYTECODE", "1");
    Ok(command)
}

/// A path of the repository that is valid in any folder.
fn absolute(path: &str) -> Result<PathBuf, String> {
    std::path::absolute(path).map_err(|problem| problem.to_string())
}

/// A source in C++ and the program made of it.
struct CppPeer {
    source: &'static str,
    /// The path of the program.
    program: &'static str,
}

impl CppPeer {
    /// Compiles it for this processor if it is not yet compiled, with these additional arguments.
    fn command(&self, arguments: impl FnOnce(&mut Command)) -> Result<Command, String> {
        let modified = |path: &str| fs::metadata(path).and_then(|file| file.modified()).ok();
        if modified(self.program) <= modified(self.source) {
            let mut compiler = Command::new("c++");
            // Warnings about the headers of other projects cannot be corrected here.
            compiler.args(["-std=c++17", "-O3", "-march=native", "-DNDEBUG", "-w"]);
            arguments(&mut compiler);
            printed(compiler.args([self.source, "-o", self.program]))?;
        }
        let mut command = Command::new(self.program);
        command.arg(WORKLOAD);
        Ok(command)
    }
}

/// Pinocchio in C++.
///
/// # Errors
/// Why it cannot be compiled.
pub fn pinocchio() -> Result<Command, String> {
    let include = headers().ok_or("the wheel has no headers")?;
    PINOCCHIO.command(|compiler| {
        // As Pinocchio's own build has it: a joint is one of more kinds than Boost's lists contain by default.
        compiler.args([
            "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
            "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
        ]);
        compiler.arg("-isystem").arg(&include);
        compiler.arg("-isystem").arg(include.join("eigen3"));
    })
}

/// The same work by hand, for one arm and one processor: what lanes could reach.
///
/// # Errors
/// Why it cannot be compiled.
pub fn by_hand() -> Result<Command, String> {
    BY_HAND.command(|compiler| {
        compiler.arg("-mprefer-vector-width=512");
    })
}

/// A cmake, if there is one: the virtual environment's or the system's.
pub fn cmake() -> Option<PathBuf> {
    let here = env::current_dir().unwrap_or_default().join(in_venv("cmake"));
    if here.is_file() {
        return Some(here);
    }
    let mut command = Command::new("cmake");
    let there = command
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    there.is_ok_and(|status| status.success()).then(|| "cmake".into())
}

/// The path of a program of the virtual environment.
fn in_venv(program: &str) -> PathBuf {
    Path::new(VENV).join("bin").join(program)
}

/// Where the wheels put their C++ headers; the Python version is in the path.
fn headers() -> Option<PathBuf> {
    let versions = fs::read_dir(Path::new(VENV).join("lib")).ok()?;
    versions
        .filter_map(Result::ok)
        .map(|version| version.path().join("site-packages/cmeel.prefix/include"))
        .find(|include| include.is_dir())
}

/// The lines that name a package.
fn packages(requirements: &str) -> Vec<&str> {
    requirements
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_name_no_package() {
        assert_eq!(packages("# why\nnumpy==2\npin==4\n"), ["numpy==2", "pin==4"]);
    }
}
