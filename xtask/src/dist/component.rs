//! What is built in: crates of the command, of the Python package and of the program of the browser, packages of the page, fonts.
//!
//! Crates are read off `cargo tree`, without those that only build or derive; packages of npm off the lock file of the
//! page, without those that only build it. A component is known by its package URL, such as `pkg:cargo/libm@0.2.16`.

use super::locked;
use crate::command::printed;
use crate::site;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Something that is built in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    pub name: String,
    pub version: String,
    /// As SPDX writes it; empty where the package does not state it.
    pub licence: String,
    /// Where its sources are; empty where it does not state it.
    pub repository: String,
    /// SHA-256 of its package, as the lock file has it.
    pub sha256: Option<String>,
    /// Package URLs of what it uses.
    pub uses: BTreeSet<String>,
    /// The folder of its licence; none for ours.
    pub folder: Option<PathBuf>,
}

/// All components by their package URLs.
pub type Components = BTreeMap<String, Component>;

/// The page uses these, and the crate that embeds it.
const PAGE_IN: &str = "armill-web";
/// Pictures use the fonts.
const FONTS_IN: &str = "armill-report";

/// Lists the packages of the page, one a line.
const PAGE_PACKAGES: &str = "web/dev/bundled.mjs";

/// Everything that is built in for any of these targets, or in the program of the browser.
///
/// # Errors
/// In a line: cargo or node does not answer, or the sources of a crate are not there.
pub fn all(targets: &[&str]) -> Result<Components, String> {
    let installed = crates_of(&["armill", "armill-py"], targets)?;
    let in_browser = crates_of(&["armill-browser"], &[site::TARGET])?;
    let mut components = read_tree(&(installed + &in_browser));
    let lock = fs::read_to_string("Cargo.lock").map_err(|error| format!("Cargo.lock: {error}"))?;
    let checksums = checksums(&lock).ok_or("Cargo.lock lists no packages")?;
    for (url, component) in &mut components {
        component.sha256 = checksums.get(url).cloned();
        // Ours have none.
        if component.sha256.is_some() {
            component.folder = Some(sources(&component.name, &component.version)?);
        }
    }
    let given = printed(Command::new("node").arg(PAGE_PACKAGES))?;
    add(
        &mut components,
        PAGE_IN,
        given.lines().filter_map(page_package).collect(),
    );
    add(
        &mut components,
        FONTS_IN,
        vec![("pkg:generic/dejavu-fonts@2.37".to_owned(), fonts())],
    );
    Ok(components)
}

/// The crates of these packages, for any of these targets, as [`read_tree`] reads them.
///
/// # Errors
/// In a line: cargo does not answer.
fn crates_of(packages: &[&str], targets: &[&str]) -> Result<String, String> {
    let mut tree = locked(&["tree", "--edges", "normal,no-proc-macro", "--prefix", "depth"]);
    tree.args(["--format", "{p}|{l}|{r}"])
        .args(packages.iter().flat_map(|package| ["--package", package]))
        .args(targets.iter().flat_map(|target| ["--target", target]));
    printed(&mut tree)
}

/// The components of `cargo tree --prefix depth --format '{p}|{l}|{r}'`.
fn read_tree(given: &str) -> Components {
    let mut components = Components::new();
    // The components above a line: at each depth the last one.
    let mut above: Vec<String> = Vec::new();
    for line in given.lines() {
        let digits = line.chars().take_while(char::is_ascii_digit).count();
        let (depth, line) = line.split_at(digits);
        let mut fields = line.trim_end_matches(" (*)").split('|');
        let mut words = fields.next().unwrap_or_default().split(' ');
        let (Ok(depth), Some(name), Some(version)) = (depth.parse::<usize>(), words.next(), words.next())
        else {
            continue;
        };
        let version = version.trim_start_matches('v');
        let url = cargo_url(name, version);
        above.truncate(depth);
        if let Some(user) = above.last().and_then(|user| components.get_mut(user)) {
            user.uses.insert(url.clone());
        }
        components.entry(url.clone()).or_insert_with(|| Component {
            name: name.to_owned(),
            version: version.to_owned(),
            // As it was written before SPDX had `OR`.
            licence: fields.next().unwrap_or_default().replace('/', " OR "),
            repository: fields.next().unwrap_or_default().to_owned(),
            ..Component::default()
        });
        above.push(url);
    }
    components
}

/// The package URL of a crate.
fn cargo_url(name: &str, version: &str) -> String {
    // A plus sign would be read as a blank.
    format!("pkg:cargo/{name}@{}", version.replace('+', "%2B"))
}

/// The checksums of `Cargo.lock` by package URLs.
fn checksums(lock: &str) -> Option<BTreeMap<String, String>> {
    let lock = DeTable::parse(lock).ok()?;
    let packages = lock.get_ref().get("package")?.get_ref().as_array()?;
    let checksum = |package: &Spanned<DeValue<'_>>| {
        let value = |key| package.get_ref().get(key)?.get_ref().as_str();
        Some((
            cargo_url(value("name")?, value("version")?),
            value("checksum")?.to_owned(),
        ))
    };
    Some(packages.iter().filter_map(checksum).collect())
}

/// A package of the page, from a line of [`PAGE_PACKAGES`], with its package URL.
fn page_package(line: &str) -> Option<(String, Component)> {
    let fields: Vec<&str> = line.split('|').collect();
    let [name, version, licence, repository, path] = fields.as_slice() else {
        return None;
    };
    let component = Component {
        name: (*name).to_owned(),
        version: (*version).to_owned(),
        licence: (*licence).to_owned(),
        repository: (*repository).to_owned(),
        folder: Some(Path::new("web").join(path)),
        ..Component::default()
    };
    Some((
        format!("pkg:npm/{}@{version}", name.replace('@', "%40")),
        component,
    ))
}

/// The fonts of pictures; a file next to them describes them.
fn fonts() -> Component {
    Component {
        name: "DejaVu fonts".to_owned(),
        version: "2.37".to_owned(),
        licence: "Bitstream-Vera".to_owned(),
        repository: "https://dejavu-fonts.github.io".to_owned(),
        folder: Some(PathBuf::from("crates/report/fonts")),
        ..Component::default()
    }
}

/// Adds components that a crate of ours uses.
fn add(components: &mut Components, user: &str, added: Vec<(String, Component)>) {
    let urls: Vec<String> = added.iter().map(|(url, _)| url.clone()).collect();
    if let Some(user) = components.values_mut().find(|component| component.name == user) {
        user.uses.extend(urls);
    }
    components.extend(added);
}

/// Where cargo keeps what it fetched.
pub fn cargo_home() -> PathBuf {
    let home = || Some(PathBuf::from(env::var_os("HOME")?).join(".cargo"));
    env::var_os("CARGO_HOME")
        .map(PathBuf::from)
        .or_else(home)
        .unwrap_or_default()
}

/// The unpacked sources of a crate.
fn sources(name: &str, version: &str) -> Result<PathBuf, String> {
    let registries = cargo_home().join("registry/src");
    let missing = || {
        let place = registries.display();
        format!("the sources of {name} {version} are not in {place}: cargo fetch --locked")
    };
    let mut folders = fs::read_dir(&registries).map_err(|_| missing())?;
    folders
        .find_map(|registry| {
            let folder = registry.ok()?.path().join(format!("{name}-{version}"));
            folder.is_dir().then_some(folder)
        })
        .ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TREE: &str = "\
0armill v0.1.0 (/somewhere/crates/cli)|Apache-2.0 OR MIT|
1armill-web v0.1.0 (/somewhere/crates/web)|Apache-2.0 OR MIT|
2toml v1.2.1+spec-1.1.0|MIT/Apache-2.0|https://example.org/toml
3serde v1.0.2|MIT|https://example.org/serde
1serde v1.0.2|MIT|https://example.org/serde (*)

0armill-py v0.1.0 (/somewhere/crates/py)|Apache-2.0 OR MIT|
1serde v1.0.2|MIT|https://example.org/serde (*)
";

    #[test]
    fn a_tree_lists_each_component_once_and_what_uses_it() {
        let components = read_tree(TREE);
        let urls: Vec<&str> = components.keys().map(String::as_str).collect();
        let toml = "pkg:cargo/toml@1.2.1%2Bspec-1.1.0";
        let serde = "pkg:cargo/serde@1.0.2";
        let web = "pkg:cargo/armill-web@0.1.0";
        assert_eq!(
            urls,
            [
                "pkg:cargo/armill-py@0.1.0",
                web,
                "pkg:cargo/armill@0.1.0",
                serde,
                toml
            ]
        );
        let uses = |url: &str| {
            components[url]
                .uses
                .iter()
                .map(String::as_str)
                .collect::<Vec<_>>()
        };
        assert_eq!(uses("pkg:cargo/armill@0.1.0"), [web, serde]);
        assert_eq!(uses("pkg:cargo/armill-py@0.1.0"), [serde]);
        assert_eq!((uses(web), uses(toml)), (vec![toml], vec![serde]));
        assert_eq!(components[toml].licence, "MIT OR Apache-2.0");
        assert_eq!(components[serde].repository, "https://example.org/serde");
    }

    #[test]
    fn checksums_are_those_of_the_very_version() {
        let lock = "version = 4\n\n[[package]]\nname = \"a\"\nversion = \"1.0.0\"\nsource = \"r\"\nchecksum = \"0f\"\n\
                    dependencies = [\n \"b\",\n]\n\n[[package]]\nname = \"armill\"\nversion = \"0.1.0\"\n";
        let found: Vec<_> = checksums(lock).unwrap().into_iter().collect();
        assert_eq!(found, [("pkg:cargo/a@1.0.0".to_owned(), "0f".to_owned())]);
    }

    #[test]
    fn packages_of_the_page_are_used_by_the_crate_that_embeds_it() {
        let mut components = read_tree(TREE);
        let given = "@scope/three|0.187.0|MIT|https://example.org/three|node_modules/@scope/three\n\n";
        add(
            &mut components,
            PAGE_IN,
            given.lines().filter_map(page_package).collect(),
        );
        let url = "pkg:npm/%40scope/three@0.187.0";
        assert!(components["pkg:cargo/armill-web@0.1.0"].uses.contains(url));
        let folder = components[url].folder.clone().unwrap();
        assert_eq!(folder, Path::new("web/node_modules/@scope/three"));
    }
}
