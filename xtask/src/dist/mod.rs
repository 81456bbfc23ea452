//! The release artifacts of a version: crates, Python wheel, a tarball with the command, lists of what is in them.
//!
//! | file | content |
//! |---|---|
//! | `armill-VERSION-TARGET.tar.gz` | command with its page, completions, manual pages, documentation, examples, licences |
//! | `armill-VERSION-....whl` | the Python package |
//! | `armill-....crate` | the crates, as they would be published, each built from its package alone |
//! | `THIRD-PARTY-LICENSES.md` | every package that is built in, its licence, and the texts |
//! | `armill-VERSION.cdx.json` | the same as a bill of materials: CycloneDX 1.6 |
//! | `SHA256SUMS` | checksums of all |
//!
//! `tools`: what is needed, and gets installed; `component`: what is built in; `third_party`, `bill`: lists of it for
//! people and for programs; `program`: the command; `wheel`; `tarball`; `crates`.
//!
//! Linux with glibc: linked by zig against glibc 2.17, so that the command and the wheel run on any distribution since
//! 2014. Elsewhere, and with `--native`, the C library of this machine is the oldest supported one. One commit gives the same
//! tarball in any folder: names are sorted, times are that of the commit, paths of this machine are cut.

mod bill;
mod component;
mod crates;
mod program;
mod tarball;
mod third_party;
mod tools;
mod wheel;

use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG, web};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fs};
use toml::de::DeTable;
use tools::Tools;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the release artifacts: tarball, wheel, crates, licences, SBOM: [--out DIR] [--native] [--allow-dirty].";

const HELP: &str = "\
Builds the release artifacts of this version: crates, Python wheel, a tarball with the command, its completions, manual
pages and documentation, the licences of all that is built in, a bill of materials (SBOM), checksums.

usage: cargo xtask dist [--out DIR] [--native] [--allow-dirty]

  --out DIR      output folder; files of the same name are replaced [default: target/dist]
  --native       link against the C library of this machine, without zig: runs on systems as new as this one
  --allow-dirty  also with changes that are not committed

It takes from ten minutes to half an hour, and needs git, tar, Python 3 with venv, Node 20 with npm, and the network:
maturin and zig come from PyPI into target/dist-venv.
";

/// The default output folder.
const OUT: &str = "target/dist";

/// What was requested.
#[derive(Debug, PartialEq)]
struct Options {
    out: PathBuf,
    native: bool,
    allow_dirty: bool,
}

/// What is made, of what, and where.
struct Release {
    version: String,
    /// The target triple of this machine.
    target: String,
    /// When it was committed, s since 1970: the time of every file.
    committed_s: String,
    out: PathBuf,
    tools: Tools,
}

/// Makes all of it and lists it.
pub fn run(arguments: &[String]) -> ExitCode {
    if arguments
        .iter()
        .any(|argument| argument == "--help" || argument == "-h")
    {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let prepared = options(arguments).and_then(|options| prepared(&options));
    let release = match prepared {
        Ok(release) => release,
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::from(COULD_NOT_RUN);
        }
    };
    match made(&release) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(FOUND_WRONG)
        }
    }
}

/// The options that the arguments set.
///
/// # Errors
/// In a line: an argument that is not known, or lacks its value.
fn options(arguments: &[String]) -> Result<Options, String> {
    let mut options = Options {
        out: PathBuf::from(OUT),
        native: false,
        allow_dirty: false,
    };
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--out" => {
                let out = arguments.next().filter(|out| !out.starts_with('-'));
                options.out = out
                    .ok_or("--out takes a folder; see cargo xtask dist --help")?
                    .into();
            }
            "--native" => options.native = true,
            "--allow-dirty" => options.allow_dirty = true,
            _ => return Err(format!("`{argument}` is not known; see cargo xtask dist --help")),
        }
    }
    Ok(options)
}

/// Looks for all that is needed before anything is made.
///
/// # Errors
/// All that is missing; changes that are not committed; a folder that cannot be made.
fn prepared(options: &Options) -> Result<Release, String> {
    tools::missing()?;
    let changed = printed(Command::new("git").args(["status", "--porcelain"]))?;
    if !changed.is_empty() && !options.allow_dirty {
        return Err(format!(
            "there are changes that are not committed; commit them, or use --allow-dirty:\n{changed}"
        ));
    }
    let rustc = printed(Command::new("rustc").arg("-vV"))?;
    let target = host(&rustc).ok_or("rustc -vV reports no host")?.to_owned();
    let manifest = fs::read_to_string("Cargo.toml").map_err(|error| format!("Cargo.toml: {error}"))?;
    let version = version(&manifest).ok_or("Cargo.toml has no version")?;
    let committed_s = printed(Command::new("git").args(["log", "-1", "--format=%ct"]))?;
    fs::create_dir_all(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?;
    let zig = !options.native && target.ends_with("-linux-gnu");
    Ok(Release {
        version,
        committed_s: committed_s.trim().to_owned(),
        out: fs::canonicalize(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?,
        tools: tools::installed(zig)?,
        target,
    })
}

/// Makes everything, and prints the results and the times.
///
/// # Errors
/// In a line, of the step that failed.
fn made(release: &Release) -> Result<(), String> {
    let mut times = Vec::new();
    let mut step = |name: &'static str, begun: Instant| times.push((name, begun.elapsed()));

    let begun = Instant::now();
    if web::build() != ExitCode::SUCCESS {
        return Err("the page was not built".to_owned());
    }
    step("page", begun);

    let begun = Instant::now();
    let components = component::all(release)?;
    let third_party = release.out.join(third_party::NAME);
    write(&third_party, &third_party::page(release, &components)?)?;
    let bill = release.out.join(format!("armill-{}.cdx.json", release.version));
    write(&bill, &bill::text(&release.version, &components))?;
    step("licences and bill of materials", begun);

    let begun = Instant::now();
    let program = program::build(release)?;
    step("command", begun);

    let begun = Instant::now();
    let tarball = tarball::pack(release, &program, &[&third_party, &bill])?;
    step("tarball", begun);

    let begun = Instant::now();
    let wheel = wheel::build(release, &third_party)?;
    step("wheel", begun);

    let begun = Instant::now();
    let crates = crates::package(release)?;
    step("crates", begun);

    let mut files = vec![tarball, wheel, third_party, bill];
    files.extend(crates);
    files.push(tarball::checksums(release, &files)?);
    for (name, time) in times {
        println!("{:>7.1} s  {name}", time.as_secs_f64());
    }
    for file in &files {
        let bytes = fs::metadata(file).map_or(0, |given| given.len());
        println!("{:>7.1} MB {}", bytes as f64 * 1e-6, file.display());
    }
    Ok(())
}

impl Release {
    /// `command` with our programs first in its path, and with nothing of this machine in what it builds.
    fn building(&self, mut command: Command) -> Command {
        let here = env::current_dir().unwrap_or_default();
        let cargo_home = component::cargo_home();
        // What is between two flags.
        let flags = format!(
            "--remap-path-prefix={}=/cargo\u{1f}--remap-path-prefix={}=/armill",
            cargo_home.display(),
            here.display()
        );
        command
            .env("PATH", self.tools.path())
            .env("CARGO_ENCODED_RUSTFLAGS", flags)
            .env("SOURCE_DATE_EPOCH", &self.committed_s);
        command
    }

    /// Where cargo puts what is built for the target in releases.
    fn built(&self) -> PathBuf {
        target_folder().join(&self.target).join("release")
    }
}

/// Where cargo builds.
fn target_folder() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from)
}

/// `cargo tree` and its like read the lock file as it is.
fn locked(arguments: &[&str]) -> Command {
    let mut command = cargo(arguments);
    command.arg("--locked");
    command
}

/// Writes a file of ours.
fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Copies a file into a place with a name.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    fs::copy(from, to).map_err(|error| format!("{}: {error}", from.display()))?;
    Ok(())
}

/// The target triple in the output of `rustc -vV`.
fn host(given: &str) -> Option<&str> {
    given.lines().find_map(|line| line.strip_prefix("host: "))
}

/// The version of the workspace in its Cargo.toml.
fn version(manifest: &str) -> Option<String> {
    let manifest = DeTable::parse(manifest).ok()?;
    let package = manifest.get_ref().get("workspace")?.get_ref().get("package")?;
    Some(package.get_ref().get("version")?.get_ref().as_str()?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options_of(words: &[&str]) -> Result<Options, String> {
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        options(&words)
    }

    #[test]
    fn options_are_read_and_others_refused() {
        let all = options_of(&["--native", "--out", "there", "--allow-dirty"]).unwrap();
        assert_eq!(all.out, Path::new("there"));
        assert!(all.native && all.allow_dirty);
        let none = options_of(&[]).unwrap();
        assert_eq!(none.out, Path::new(OUT));
        assert!(!none.native && !none.allow_dirty);
        assert!(options_of(&["--fast"]).unwrap_err().contains("`--fast`"));
        assert!(options_of(&["--out"]).unwrap_err().contains("takes a folder"));
        assert!(
            options_of(&["--out", "--native"])
                .unwrap_err()
                .contains("takes a folder")
        );
    }

    #[test]
    fn help_names_every_option() {
        for option in ["--out", "--native", "--allow-dirty"] {
            assert!(
                HELP.matches(option).count() >= 2 && ABOUT.contains(option),
                "{option}"
            );
        }
    }

    #[test]
    fn host_and_version_are_found() {
        let printed_text = "rustc 1.95.0\nbinary: rustc\nhost: x86_64-unknown-linux-gnu\nrelease: 1.95.0\n";
        assert_eq!(host(printed_text), Some("x86_64-unknown-linux-gnu"));
        let manifest = "[workspace]\nversion = \"9\"\n[workspace.package]\nversion = \"0.1.0\"\n";
        assert_eq!(version(manifest).unwrap(), "0.1.0");
        assert_eq!(version("[package]\nversion = \"1\"\n"), None);
    }
}
