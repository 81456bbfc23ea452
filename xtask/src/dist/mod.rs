//! The release artifacts of a version: crates, Python wheel and its sources, a tarball with the command, lists of what is in them.
//!
//! | file | content |
//! |---|---|
//! | `armill-VERSION-TARGET.tar.gz` | command with its page, completions, manual pages, documentation, examples, licences |
//! | `armill_VERSION_ARCHITECTURE.deb` | the same as a Debian package |
//! | `armill-VERSION-....whl` | the Python package |
//! | `armill-VERSION.tar.gz` | its sources (sdist), of which the wheel is built |
//! | `conda/recipe.yaml` | the recipe of the conda package of these sources |
//! | `armill-site-VERSION.tar.gz` | the documentation and the live page without a server, for a web server |
//! | `armill-....crate` | the crates, as they would be published, each built from its package alone |
//! | `THIRD-PARTY-LICENSES.md` | every package that is built in, its licence, and the texts |
//! | `armill-VERSION.cdx.json` | the same as a bill of materials: CycloneDX 1.6 |
//! | `SHA256SUMS` | checksums of all |
//!
//! `tools`: what is needed, and gets installed; `component`: what is built in; `third_party`, `bill`: lists of it for
//! people and for programs; `program`: the command; `accompanying`: what goes with it; `tarball`; `debian`;
//! `source_package`; `wheel`; `conda`; `site`; `crates`.
//!
//! Linux with glibc: linked by zig against glibc 2.17, so that the command and the wheel run on any distribution since
//! 2014; with `--aarch64` also for that processor. Elsewhere, and with `--native`, the C library of this machine is the oldest
//! supported one. One commit gives the same tarball in any folder: names are sorted, times are that of the commit, paths of this
//! machine are cut.

mod accompanying;
mod bill;
mod component;
mod conda;
mod crates;
mod debian;
mod program;
mod site;
mod source_package;
mod tarball;
mod third_party;
mod tools;
mod wheel;

use crate::command::{cargo, printed};
use crate::{COULD_NOT_RUN, FOUND_WRONG, rustup, web};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};
use std::{env, fs, io};
use toml::de::DeTable;
use tools::Tools;

/// Description in the list of tasks.
pub const ABOUT: &str = "Builds the release artifacts: tarball, Debian package, wheel, sdist, site, crates, licences, SBOM: [--out DIR] [--lists] [--site] [--aarch64] [--native] [--allow-dirty].";

const HELP: &str = "\
Builds the release artifacts of this version: crates, Python wheel and its sources (sdist), conda recipe, a tarball and a
Debian package with the command, its completions, manual pages and documentation, the site (documentation, and the live page
without a server), the licences of all that is built in, a bill of materials (SBOM), checksums. What cannot be made on this
machine is listed with the reason.

usage: cargo xtask dist [--out DIR] [--lists] [--site] [--aarch64] [--native] [--allow-dirty]

  --out DIR      output folder; files of the same name are replaced [default: target/dist]
  --lists        licences and bill of materials alone, of the page as its packages are installed
  --site         the site alone, with the licences of what is in it
  --aarch64      tarball, Debian package and wheel also for Linux on aarch64, linked by zig
  --native       link against the C library of this machine, without zig: runs on systems as new as this one
  --allow-dirty  also with changes that are not committed

It takes from a quarter of an hour to an hour, and needs git, tar, Python 3.11 with venv, Node 20 with npm, rustup, and the network:
maturin, zig and auditwheel come from PyPI into target/dist-venv.
";

/// The other processor that Linux artifacts are made for.
const AARCH64: &str = "aarch64-unknown-linux-gnu";
/// Where the sources of the Python package are unpacked, in the folder of cargo.
const UNPACKED: &str = "dist-sources";
/// The default output folder.
const OUT: &str = "target/dist";

/// What was requested.
#[derive(Debug, PartialEq)]
struct Options {
    out: PathBuf,
    lists: bool,
    site: bool,
    aarch64: bool,
    native: bool,
    allow_dirty: bool,
}

/// What is made, of what, and where.
#[derive(Clone)]
struct Release {
    version: String,
    /// The target triple: that of this machine, except for the artifacts of another processor.
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
    let prepared = options(arguments).and_then(|options| match options.lists {
        true => lists_alone(&options.out).map(|()| None),
        false => prepared(&options).map(|(release, others)| Some((options, release, others))),
    });
    let (options, release, others) = match prepared {
        Ok(Some(prepared)) => prepared,
        Ok(None) => return ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::from(COULD_NOT_RUN);
        }
    };
    let made = match options.site {
        true => site_alone(&release),
        false => made(&release, &others),
    };
    match made {
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
        lists: false,
        site: false,
        aarch64: false,
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
            "--lists" => options.lists = true,
            "--site" => options.site = true,
            "--aarch64" => options.aarch64 = true,
            "--native" => options.native = true,
            "--allow-dirty" => options.allow_dirty = true,
            _ => return Err(format!("`{argument}` is not known; see cargo xtask dist --help")),
        }
    }
    Ok(options)
}

/// Looks for all that is needed before anything is made; gives the release, and the same for other processors.
///
/// # Errors
/// All that is missing; changes that are not committed; a folder that cannot be made; a processor that zig cannot link for.
fn prepared(options: &Options) -> Result<(Release, Vec<Release>), String> {
    tools::missing()?;
    let changed = printed(Command::new("git").args(["status", "--porcelain"]))?;
    if !changed.is_empty() && !options.allow_dirty {
        return Err(format!(
            "there are changes that are not committed; commit them, or use --allow-dirty:\n{changed}"
        ));
    }
    let (version, target) = version_and_target()?;
    let committed_s = printed(Command::new("git").args(["log", "-1", "--format=%ct"]))?;
    fs::create_dir_all(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?;
    let zig = !options.native && target.ends_with("-linux-gnu");
    let other_targets = other_targets(options, zig, &target)?;
    for target in &other_targets {
        rustup::add_target(target)?;
    }
    let release = Release {
        version,
        committed_s: committed_s.trim().to_owned(),
        out: fs::canonicalize(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?,
        tools: tools::installed(zig)?,
        target,
    };
    let others = other_targets.iter().map(|target| Release {
        target: (*target).to_owned(),
        ..release.clone()
    });
    let others = others.collect();
    Ok((release, others))
}

/// The targets that are built in addition to that of this machine.
///
/// # Errors
/// In a line: they are requested, and nothing links for them.
fn other_targets(options: &Options, zig: bool, target: &str) -> Result<Vec<&'static str>, String> {
    match (options.aarch64, zig) {
        (false, _) => Ok(Vec::new()),
        (true, false) => {
            Err("--aarch64 links with zig: on Linux with glibc, and without --native".to_owned())
        }
        (true, true) if target == AARCH64 => Ok(Vec::new()),
        (true, true) => Ok(vec![AARCH64]),
    }
}

/// What was made, how long each step took, and what was left out.
#[derive(Default)]
struct Made {
    files: Vec<PathBuf>,
    times: Vec<(String, Duration)>,
    left_out: Vec<String>,
}

impl Made {
    /// Does a step and records its time.
    fn step<T>(&mut self, name: &str, step: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
        let begun = Instant::now();
        let done = step()?;
        self.times.push((name.to_owned(), begun.elapsed()));
        Ok(done)
    }
}

/// Makes everything, and prints the results, the times, and what was left out.
///
/// # Errors
/// In a line, of the step that failed.
fn made(release: &Release, others: &[Release]) -> Result<(), String> {
    let mut made = Made::default();
    made.step("page", || match web::build() {
        ExitCode::SUCCESS => Ok(()),
        _ => Err("the page was not built".to_owned()),
    })?;
    let [third_party, bill] = made.step("licences and bill of materials", || {
        let targets: Vec<&str> = [release]
            .into_iter()
            .chain(others)
            .map(|it| it.target.as_str())
            .collect();
        lists(&release.version, &targets, &release.out)
    })?;
    let sources = made.step("sources of the Python package", || {
        source_package::pack(release, &third_party)
    })?;
    let unpacked = source_package::unpacked(release, &sources)?;
    let recipe = conda::recipe(release, &sources)?;
    let mut runs = None;
    for release in [release].into_iter().chain(others) {
        let target = &release.target;
        let program = made.step(&format!("command, {target}"), || program::build(release))?;
        // Help texts come from the command that this machine can run.
        let runs: &Path = runs.get_or_insert_with(|| program.clone());
        let lists: [&Path; 2] = [&third_party, &bill];
        let tarball = made.step(&format!("tarball, {target}"), || {
            tarball::pack(release, &program, runs, &lists)
        })?;
        let debian = made.step(&format!("Debian package, {target}"), || {
            debian::package(release, &program, runs, &lists)
        })?;
        match debian {
            Ok(package) => made.files.push(package),
            Err(reason) => made.left_out.push(format!("Debian package, {target}: {reason}")),
        }
        let wheel = made.step(&format!("wheel, {target}"), || wheel::build(release, &unpacked))?;
        made.files.extend([tarball, wheel]);
    }
    if others.is_empty() && release.target != AARCH64 {
        let reason = "not requested (--aarch64)";
        made.left_out.push(format!(
            "tarball, Debian package and wheel for {AARCH64}: {reason}"
        ));
    }
    made.left_out
        .extend(NOT_MADE.iter().map(|line| (*line).to_owned()));
    let site = made.step("site", || site::pack(release, &third_party))?;
    let crates = made.step("crates", || crates::package(release))?;
    made.files.extend([sources, site, third_party, bill]);
    made.files.extend(crates);
    made.files.push(tarball::checksums(release, &made.files)?);
    made.files.push(recipe);
    made.print();
    Ok(())
}

/// Writes the licences and the bill of materials of what is built in for these targets; gives their paths.
///
/// # Errors
/// In a line: cargo or node does not answer; a file cannot be read or written.
fn lists(version: &str, targets: &[&str], out: &Path) -> Result<[PathBuf; 2], String> {
    let third_party = out.join(third_party::NAME);
    let bill = out.join(format!("armill-{version}.cdx.json"));
    let components = component::all(targets)?;
    write(&third_party, &third_party::page(version, targets, &components)?)?;
    write(&bill, &bill::text(version, &components))?;
    Ok([third_party, bill])
}

/// Writes the lists alone, for the target of this machine.
///
/// # Errors
/// In a line: as [`lists`]; no Rust; a folder that cannot be made.
fn lists_alone(out: &Path) -> Result<(), String> {
    let (version, target) = version_and_target()?;
    fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    lists(&version, &[&target], out).map(|_| ())
}

/// Makes the site alone, and prints its time and its file.
///
/// # Errors
/// In a line, of the step that failed.
fn site_alone(release: &Release) -> Result<(), String> {
    let mut made = Made::default();
    let [third_party, _] = lists(&release.version, &[&release.target], &release.out)?;
    let site = made.step("site", || site::pack(release, &third_party))?;
    made.files.push(site);
    made.print();
    Ok(())
}

/// The version of the workspace, and the target triple of this machine.
///
/// # Errors
/// In a line: Cargo.toml has no version; rustc does not answer.
fn version_and_target() -> Result<(String, String), String> {
    let rustc = printed(Command::new("rustc").arg("-vV"))?;
    let target = host(&rustc).ok_or("rustc -vV reports no host")?.to_owned();
    let manifest = fs::read_to_string("Cargo.toml").map_err(|error| format!("Cargo.toml: {error}"))?;
    let version = version(&manifest).ok_or("Cargo.toml has no version")?;
    Ok((version, target))
}

/// What is made elsewhere from the files made here.
const NOT_MADE: &[&str] = &[
    "conda package: it needs a conda channel; rattler-build build --recipe conda/recipe.yaml",
    "container image: it needs a container engine; podman build -f packaging/Containerfile .",
    "Windows and macOS: they need a machine of their own; cargo xtask targets checks the types here",
];

impl Made {
    /// Prints times, files, and what was left out.
    fn print(&self) {
        for (name, time) in &self.times {
            println!("{:>7.1} s  {name}", time.as_secs_f64());
        }
        for file in &self.files {
            let bytes = fs::metadata(file).map_or(0, |given| given.len());
            println!("{:>7.1} MB {}", bytes as f64 * 1e-6, file.display());
        }
        for line in &self.left_out {
            println!("not made: {line}");
        }
    }
}

impl Release {
    /// `command` with our programs first in its path, and with nothing of this machine in what it builds.
    fn building(&self, mut command: Command) -> Command {
        command
            .env("PATH", self.tools.path())
            // What is between two flags.
            .env("CARGO_ENCODED_RUSTFLAGS", self.remapped().join("\u{1f}"))
            // Some run in other folders.
            .env("CARGO_TARGET_DIR", absolute_target_folder())
            .env("SOURCE_DATE_EPOCH", &self.committed_s);
        command
    }

    /// Flags of the compiler after which no path of this machine is in what it builds.
    fn remapped(&self) -> Vec<String> {
        let unpacked = absolute_target_folder()
            .join(UNPACKED)
            .join(format!("armill-{}", self.version));
        // The last that fits decides.
        let folders = [
            (component::cargo_home(), "/cargo"),
            (env::current_dir().unwrap_or_default(), "/armill"),
            (unpacked, "/armill"),
        ];
        let flag =
            |(folder, name): (PathBuf, &str)| format!("--remap-path-prefix={}={name}", folder.display());
        folders.map(flag).into()
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

/// The same, also seen from other folders.
fn absolute_target_folder() -> PathBuf {
    env::current_dir().unwrap_or_default().join(target_folder())
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

/// Removes the folder that an earlier run left.
fn emptied(folder: &Path) -> Result<(), String> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(format!("{}: {error}", folder.display()))
        }
        _ => Ok(()),
    }
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
        let all = options_of(&[
            "--native",
            "--out",
            "there",
            "--allow-dirty",
            "--aarch64",
            "--lists",
            "--site",
        ])
        .unwrap();
        assert_eq!(all.out, Path::new("there"));
        assert!(all.native && all.allow_dirty && all.aarch64 && all.lists && all.site);
        let none = options_of(&[]).unwrap();
        assert_eq!(none.out, Path::new(OUT));
        assert!(!none.native && !none.allow_dirty && !none.aarch64 && !none.lists && !none.site);
        assert!(options_of(&["--fast"]).unwrap_err().contains("`--fast`"));
        assert!(options_of(&["--out"]).unwrap_err().contains("takes a folder"));
        assert!(
            options_of(&["--out", "--native"])
                .unwrap_err()
                .contains("takes a folder")
        );
    }

    #[test]
    fn another_processor_needs_zig_and_is_not_built_twice() {
        let options = options_of(&["--aarch64"]).unwrap();
        let x86_64 = "x86_64-unknown-linux-gnu";
        assert_eq!(other_targets(&options, true, x86_64).unwrap(), [AARCH64]);
        assert!(other_targets(&options, true, AARCH64).unwrap().is_empty());
        assert!(
            other_targets(&options, false, x86_64)
                .unwrap_err()
                .contains("zig")
        );
        let without = options_of(&[]).unwrap();
        assert!(other_targets(&without, false, x86_64).unwrap().is_empty());
    }

    #[test]
    fn help_names_every_option() {
        for option in [
            "--out",
            "--lists",
            "--site",
            "--aarch64",
            "--native",
            "--allow-dirty",
        ] {
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
