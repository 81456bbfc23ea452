//! The crates as they would be published: packed by cargo, each unpacked again and built from its package alone.
//!
//! They depend on each other, and none is in a registry yet: cargo packs and builds all of them together.

use super::{Release, copy, emptied, locked, target_folder};
use crate::command::succeeded;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// In the order of their dependencies: so they would be published too.
const CRATES: &[&str] = &[
    "armill-core",
    "armill-formats",
    "armill-programs",
    "armill-report",
    "armill-study",
    "armill-measure",
    "armill-plan",
    "armill-api",
    "armill-web",
    "armill",
];

/// Packs and builds all of them, and gives the paths of the packages.
///
/// # Errors
/// In a line: one cannot be packed, or does not build on its own.
pub fn package(release: &Release) -> Result<Vec<PathBuf>, String> {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    if let Some(home) = home.or_else(|| env::home_dir().map(|home| home.join(".cargo"))) {
        forget_unpacked(&home, &release.version)?;
    }
    let mut command = locked(&["package"]);
    command.args(CRATES.iter().flat_map(|name| ["-p", name]));
    // The built page is of no commit; what else is not was refused before, or allowed.
    command.arg("--allow-dirty");
    succeeded(&mut command)?;
    let mut packages = Vec::new();
    for name in CRATES {
        let file = format!("{name}-{}.crate", release.version);
        let package = release.out.join(&file);
        copy(&target_folder().join("package").join(&file), &package)?;
        packages.push(package);
    }
    Ok(packages)
}

/// Removes what cargo unpacked of packages of this version before: it would be built in place of the new ones.
fn forget_unpacked(cargo_home: &Path, version: &str) -> Result<(), String> {
    let Ok(registries) = fs::read_dir(cargo_home.join("registry/src")) else {
        return Ok(());
    };
    // The registry that cargo makes of packages is a folder: its name begins with that of no host.
    let of_packages = registries
        .flatten()
        .filter(|registry| registry.file_name().to_string_lossy().starts_with('-'));
    for registry in of_packages {
        for name in CRATES {
            emptied(&registry.path().join(format!("{name}-{version}")))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The manifest of each folder of `crates/`.
    fn manifests() -> Vec<String> {
        let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
        let folders = fs::read_dir(crates).unwrap();
        folders
            .map(|folder| fs::read_to_string(folder.unwrap().path().join("Cargo.toml")).unwrap())
            .collect()
    }

    #[test]
    fn every_crate_is_published_or_marked_as_unpublished() {
        for manifest in manifests() {
            let name = manifest.lines().find_map(|line| line.strip_prefix("name = \""));
            let name = name.unwrap().trim_end_matches('"');
            let private = manifest.contains("\npublish = false\n");
            assert_ne!(CRATES.contains(&name), private, "{name}");
            // What a package needs on its own.
            for line in ["\ndescription = ", "\nreadme.workspace", "\ninclude = ["] {
                assert!(private || manifest.contains(line), "{name} has no{line}");
            }
        }
    }

    #[test]
    fn only_our_packages_of_this_version_are_forgotten() {
        let home = env::temp_dir().join(format!("armill-cargo-home-{}", std::process::id()));
        let all = [
            "-0f/armill-core-1.2.0",
            "-0f/armill-core-1.3.0",
            "-0f/other-1.2.0",
            "index.crates.io-1/armill-core-1.2.0",
        ];
        let path = |name: &str| home.join("registry/src").join(name);
        for name in all {
            fs::create_dir_all(path(name)).unwrap();
        }
        forget_unpacked(&home, "1.2.0").unwrap();
        assert_eq!(all.map(|name| path(name).is_dir()), [false, true, true, true]);
        fs::remove_dir_all(&home).unwrap();
        forget_unpacked(&home, "1.2.0").unwrap();
    }

    #[test]
    fn no_crate_precedes_one_that_it_needs() {
        for manifest in manifests() {
            let name = manifest.lines().find_map(|line| line.strip_prefix("name = \""));
            let name = name.unwrap().trim_end_matches('"');
            let Some(place) = CRATES.iter().position(|listed| *listed == name) else {
                continue;
            };
            for later in &CRATES[place..] {
                let named = format!("\n{later}.workspace = true");
                assert!(!manifest.contains(&named), "{name} needs {later}");
            }
        }
    }
}
