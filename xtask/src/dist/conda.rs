//! The recipe of the conda package: `packaging/conda/recipe.yaml` with the source package of this release in it.
//!
//! rattler-build makes the package of it; it needs a conda channel, so that it is not run here.

use super::{Release, emptied, write};
use crate::command::printed;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The recipe of the repository.
const RECIPE: &str = "packaging/conda/recipe.yaml";
/// How the line of the source begins.
const SOURCE: &str = "  path: ";

/// Writes the recipe for the source package and gives its path.
///
/// # Errors
/// In a line: the recipe is for another version or has no source; a file cannot be read or written.
pub fn recipe(release: &Release, sources: &Path) -> Result<PathBuf, String> {
    let text = fs::read_to_string(RECIPE).map_err(|error| format!("{RECIPE}: {error}"))?;
    let sums = printed(Command::new("sha256sum").arg(sources))?;
    let sha256 = sums.split_whitespace().next().unwrap_or_default();
    let file = sources.file_name().unwrap_or_default().to_string_lossy();
    let text = with_source(&text, &release.version, &file, sha256)
        .map_err(|problem| format!("{RECIPE}: {problem}"))?;
    let folder = release.out.join("conda");
    emptied(&folder)?;
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let recipe = folder.join("recipe.yaml");
    write(&recipe, &text)?;
    Ok(recipe)
}

/// The recipe with a source package that is in the folder above.
fn with_source(recipe: &str, version: &str, file: &str, sha256: &str) -> Result<String, String> {
    if !recipe.contains(&format!("\n  version: \"{version}\"\n")) {
        return Err(format!("its version is not {version}"));
    }
    let (before, rest) = recipe
        .split_once(&format!("\n{SOURCE}"))
        .ok_or_else(|| format!("no line begins with `{SOURCE}`"))?;
    let (_, after) = rest.split_once('\n').unwrap_or((rest, ""));
    Ok(format!(
        "{before}\n{SOURCE}../{file}\n  sha256: {sha256}\n{after}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dist;

    fn of_repository(path: &str) -> String {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
    }

    #[test]
    fn the_recipe_has_version_and_requirements_of_the_package() {
        let recipe = of_repository(RECIPE);
        let version = dist::version(&of_repository("Cargo.toml")).unwrap();
        let filled = with_source(&recipe, &version, "armill-9.tar.gz", "0f").unwrap();
        assert!(
            filled.contains("source:\n  path: ../armill-9.tar.gz\n  sha256: 0f\n\nbuild:\n"),
            "{filled}"
        );
        assert_eq!(filled.matches("  path: ").count(), 1);
        let package = of_repository("python/pyproject.toml");
        for (written, needed) in [
            ("requires-python = \">=3.10\"", "- python >=3.10"),
            ("dependencies = [\"numpy>=1.23\"]", "- numpy >=1.23"),
            ("requires = [\"maturin>=1.9,<2\"]", "- maturin >=1.9,<2"),
        ] {
            assert!(package.contains(written), "pyproject.toml has no `{written}`");
            assert!(recipe.contains(needed), "the recipe has no `{needed}`");
        }
    }

    #[test]
    fn a_recipe_of_another_version_or_without_source_is_refused() {
        let recipe = "context:\n  version: \"0.1.0\"\nsource:\n  url: x\n";
        assert!(
            with_source(recipe, "0.2.0", "f", "0f")
                .unwrap_err()
                .contains("not 0.2.0")
        );
        assert!(
            with_source(recipe, "0.1.0", "f", "0f")
                .unwrap_err()
                .contains("no line")
        );
    }
}
