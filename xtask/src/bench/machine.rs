//! On what a run was made: processor, cores, system, compilers.
//!
//! Read from `/proc/cpuinfo` and from what programs say of themselves; elsewhere than on Linux the processor
//! stays unknown. A program that is not there is reported as `not there`.

use std::fs;
use std::process::Command;
use std::thread::available_parallelism;

/// One line a fact.
pub fn lines() -> Vec<String> {
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let cores = available_parallelism().map_or(1, usize::from);
    vec![
        format!(
            "processor: {}, {cores} cores to use, {}",
            field(&cpuinfo, "model name").unwrap_or("unknown"),
            vectors(field(&cpuinfo, "flags").unwrap_or_default())
        ),
        format!("system: {}", first_line("uname", &["-sr"])),
        format!("Rust: {}", first_line("rustc", &["--version"])),
        format!("C++: {}", first_line("c++", &["--version"])),
        format!("Python: {}", first_line("python3", &["--version"])),
    ]
}

/// The value of `name : value` in /proc/cpuinfo.
fn field<'a>(cpuinfo: &'a str, name: &str) -> Option<&'a str> {
    let lines = cpuinfo.lines().filter_map(|line| line.split_once(':'));
    lines
        .into_iter()
        .find(|(key, _)| key.trim() == name)
        .map(|(_, value)| value.trim())
}

/// The widest vectors that the flags name.
fn vectors(flags: &str) -> &'static str {
    let has = |flag: &str| flags.split_whitespace().any(|word| word == flag);
    if has("avx512f") {
        "AVX-512"
    } else if has("avx2") {
        "AVX2"
    } else {
        "no AVX2"
    }
}

/// The first line that a program prints.
fn first_line(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
    let text = text.unwrap_or_default();
    text.lines().next().unwrap_or("not there").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_and_vectors_are_read() {
        let cpuinfo = "model name\t: Fast 9000\nflags\t\t: fma avx2\n";
        assert_eq!(field(cpuinfo, "model name"), Some("Fast 9000"));
        assert_eq!(vectors("fma avx2"), "AVX2");
        assert_eq!(vectors("avx2 avx512f"), "AVX-512");
    }
}
