//! The Debian package of the command: `armill_VERSION_ARCHITECTURE.deb`, made by dpkg-deb.
//!
//! ```text
//! usr/bin/armill                       the command, its page in it
//! usr/share/man/man1/                  manual pages
//! usr/share/bash-completion/ ...       completions of bash, zsh and fish, where these look for them
//! usr/share/doc/armill/                documents, examples, licences, bill of materials
//! ```
//!
//! Policy: <https://www.debian.org/doc/debian-policy/>. The needed version of the C library is read off the command.

use super::{Release, accompanying, copy, emptied, target_folder, write};
use crate::command::{printed, succeeded};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs, io};

/// Processors as rustc names them, and the architectures of Debian.
const ARCHITECTURES: &[(&str, &str)] = &[("x86_64", "amd64"), ("aarch64", "arm64")];

/// Shells, and where each looks for its script.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "usr/share/bash-completion/completions/armill"),
    ("zsh", "usr/share/zsh/vendor-completions/_armill"),
    ("fish", "usr/share/fish/vendor_completions.d/armill.fish"),
];

/// Where its documents are.
const DOCUMENTS: &str = "usr/share/doc/armill";

/// The address of the maintainer where the variable `DEBEMAIL` gives none: a name that is reserved for this.
const NO_ADDRESS: &str = "armill@example.invalid";

/// Makes the package of `command`; `runs` is the same command for this machine, which generates its help texts.
///
/// `Ok(Err(reason))` where it cannot be made here.
///
/// # Errors
/// In a line: a file cannot be copied; the command does not run; gzip or dpkg-deb fails.
pub fn package(
    release: &Release,
    command: &Path,
    runs: &Path,
    others: &[&Path],
) -> Result<Result<PathBuf, String>, String> {
    let Some(architecture) = architecture(&release.target) else {
        return Ok(Err(format!("Debian has no name for {}", release.target)));
    };
    if !has_dpkg_deb() {
        return Ok(Err("dpkg-deb is not installed (apt-get install dpkg)".to_owned()));
    }
    let root = target_folder().join("dist-debian").join(architecture);
    emptied(&root)?;
    let documents = root.join(DOCUMENTS);
    copy(command, &root.join("usr/bin/armill"))?;
    accompanying::documents(&documents, |file| file.starts_with("LICENSE"))?;
    for file in others {
        copy(file, &documents.join(file.file_name().unwrap_or_default()))?;
    }
    for (shell, file) in COMPLETIONS {
        accompanying::completions(runs, shell, &root.join(file))?;
    }
    let manual = root.join("usr/share/man/man1");
    accompanying::manual(runs, &manual)?;
    let licence = fs::read_to_string("LICENSE-MIT").map_err(|error| format!("LICENSE-MIT: {error}"))?;
    write(&documents.join("copyright"), &copyright(&licence))?;
    let date = printed(Command::new("date").args(["-uR", "-d", &format!("@{}", release.committed_s)]))?;
    write(
        &documents.join("changelog"),
        &changelog(&release.version, &maintainer(), date.trim()),
    )?;
    let mut compressed: Vec<PathBuf> =
        files_in(&manual).map_err(|error| format!("{}: {error}", manual.display()))?;
    compressed
        .extend(["changelog", "CHANGELOG.md", "THIRD-PARTY-LICENSES.md"].map(|file| documents.join(file)));
    succeeded(Command::new("gzip").arg("-9n").args(&compressed))?;
    let bytes = fs::read(command).map_err(|error| format!("{}: {error}", command.display()))?;
    let installed = printed(Command::new("du").args(["-sk", "--apparent-size"]).arg(&root))?;
    let installed_kib = installed.split_whitespace().next().unwrap_or("0");
    let text = control(
        &[
            ("Version", &release.version),
            ("Architecture", architecture),
            ("Maintainer", &maintainer()),
            ("Installed-Size", installed_kib),
        ],
        &needs(&bytes),
    );
    write_control(&root, &text)?;
    packed(release, &root, architecture).map(Ok)
}

/// Writes the description, and the checksums that `dpkg --verify` reads.
fn write_control(root: &Path, text: &str) -> Result<(), String> {
    let mut installed = Vec::new();
    all_files(root, root, &mut installed).map_err(|error| format!("{}: {error}", root.display()))?;
    installed.sort();
    let sums = printed(Command::new("md5sum").args(&installed).current_dir(root))?;
    let folder = root.join("DEBIAN");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    write(&folder.join("control"), text)?;
    write(&folder.join("md5sums"), &sums)
}

/// Packs the folder with the rights and owners that a package has.
fn packed(release: &Release, root: &Path, architecture: &str) -> Result<PathBuf, String> {
    succeeded(Command::new("chmod").args(["-R", "u=rwX,go=rX"]).arg(root))?;
    let package = release
        .out
        .join(format!("armill_{}_{architecture}.deb", release.version));
    let mut dpkg = Command::new("dpkg-deb");
    dpkg.args(["--root-owner-group", "-Zxz", "--build"])
        .arg(root)
        .arg(&package)
        .env("SOURCE_DATE_EPOCH", &release.committed_s);
    succeeded(&mut dpkg)?;
    Ok(package)
}

fn has_dpkg_deb() -> bool {
    let mut command = Command::new("dpkg-deb");
    command
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The name that Debian gives to the processor of a target; none for another C library than glibc.
fn architecture(target: &str) -> Option<&'static str> {
    let processor = target.strip_suffix("-unknown-linux-gnu")?;
    let found = ARCHITECTURES.iter().find(|(name, _)| *name == processor);
    found.map(|(_, architecture)| *architecture)
}

/// Who publishes it, with the address that Debian's own tools use.
fn maintainer() -> String {
    let address = env::var("DEBEMAIL").unwrap_or_else(|_| NO_ADDRESS.to_owned());
    format!("The armill authors <{address}>")
}

/// The packages that a program needs: the C library as new as the newest symbol that it uses, and the unwinder of gcc.
fn needs(program: &[u8]) -> String {
    const SYMBOLS: &[u8] = b"GLIBC_2.";
    let minor = |rest: &[u8]| {
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit());
        digits.fold(0, |number: u32, digit| {
            number.saturating_mul(10).saturating_add(u32::from(digit - b'0'))
        })
    };
    let found = program.windows(SYMBOLS.len()).enumerate();
    let newest = found
        .filter(|(_, bytes)| *bytes == SYMBOLS)
        .map(|(at, bytes)| minor(&program[at + bytes.len()..]))
        .max()
        .unwrap_or(0);
    let unwinder = b"libgcc_s.so.1";
    match program.windows(unwinder.len()).any(|bytes| bytes == unwinder) {
        true => format!("libc6 (>= 2.{newest}), libgcc-s1"),
        false => format!("libc6 (>= 2.{newest})"),
    }
}

/// The description of the package.
fn control(fields: &[(&str, &str)], needs: &str) -> String {
    let fields: String = fields
        .iter()
        .map(|(name, value)| format!("{name}: {value}\n"))
        .collect();
    format!(
        "Package: armill\n{fields}Depends: {needs}\nSection: science\nPriority: optional\n\
         Description: machining error of industrial robots\n \
         armill predicts, explains and helps to reduce the error of milling, drilling\n \
         and grinding with an industrial robot, in micrometres, with the uncertainty\n \
         of each number: maps, regions within a tolerance, tool paths, postures,\n \
         placement and compensation. Robots, materials, examples and the live page\n \
         of `armill serve` are built in.\n"
    )
}

/// The licences in the format of Debian: <https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/>.
fn copyright(mit: &str) -> String {
    let lines = mit.lines().map(str::trim_end);
    let mut owner = "The armill authors";
    let mut terms = String::new();
    for line in lines.skip_while(|line| line.is_empty() || *line == "MIT License") {
        match line.strip_prefix("Copyright (c) ") {
            Some(found) => owner = found,
            None if line.is_empty() => terms += " .\n",
            None => terms += &format!(" {line}\n"),
        }
    }
    let terms = terms.trim_start_matches(" .\n");
    format!(
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\
         Upstream-Name: armill\n\
         Comment: Licences of the crates, packages and fonts that are built in are in\n \
         THIRD-PARTY-LICENSES.md.gz in this folder.\n\n\
         Files: *\nCopyright: {owner}\nLicense: Apache-2.0 or Expat\n\n\
         License: Apache-2.0\n On Debian systems, the text of the Apache License, version 2.0, is in\n \
         /usr/share/common-licenses/Apache-2.0.\n\n\
         License: Expat\n{terms}"
    )
}

/// The list of changes in the format of Debian; it refers to ours.
fn changelog(version: &str, maintainer: &str, date: &str) -> String {
    format!(
        "armill ({version}) unstable; urgency=medium\n\n  * Version {version}; changes are in CHANGELOG.md.gz.\n\n -- {maintainer}  {date}\n"
    )
}

/// The files of one folder.
fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        files.push(entry?.path());
    }
    files.sort();
    Ok(files)
}

/// All files below a folder, by their paths from `root`.
fn all_files(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for path in files_in(folder)? {
        if path.is_dir() {
            all_files(root, &path, files)?;
        } else {
            files.push(path.strip_prefix(root).unwrap_or(&path).to_owned());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_have_the_architecture_of_debian() {
        assert_eq!(architecture("x86_64-unknown-linux-gnu"), Some("amd64"));
        assert_eq!(architecture("aarch64-unknown-linux-gnu"), Some("arm64"));
        assert_eq!(architecture("x86_64-unknown-linux-musl"), None);
        assert_eq!(architecture("aarch64-apple-darwin"), None);
    }

    #[test]
    fn the_newest_symbol_decides_on_the_c_library() {
        assert_eq!(
            needs(b"\0GLIBC_2.2.5\0GLIBC_2.17\0GLIBC_2.3\0"),
            "libc6 (>= 2.17)"
        );
        let with_unwinder = b"GLIBC_2.34\0libgcc_s.so.1\0libc.so.6";
        assert_eq!(needs(with_unwinder), "libc6 (>= 2.34), libgcc-s1");
    }

    #[test]
    fn a_description_has_its_fields_and_indented_text() {
        let text = control(
            &[("Version", "0.1.0"), ("Architecture", "amd64")],
            "libc6 (>= 2.17)",
        );
        for line in [
            "Package: armill",
            "Version: 0.1.0",
            "Architecture: amd64",
            "Depends: libc6 (>= 2.17)",
        ] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
        let (_, description) = text.split_once("Description: ").unwrap();
        assert!(
            description
                .lines()
                .skip(1)
                .all(|line| line.starts_with(' ') && line.len() <= 80)
        );
    }

    #[test]
    fn the_copyright_file_has_owner_and_terms() {
        let mit = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../LICENSE-MIT")).unwrap();
        let text = copyright(&mit);
        assert!(
            text.contains("The armill authors\nLicense: Apache-2.0 or Expat\n"),
            "{text}"
        );
        let (_, terms) = text.split_once("License: Expat\n").unwrap();
        assert!(terms.starts_with(" Permission is hereby granted"), "{terms}");
        assert!(terms.lines().all(|line| line.starts_with(' ')), "{terms}");
    }

    #[test]
    fn a_list_of_changes_ends_with_maintainer_and_date() {
        let text = changelog("0.1.0", "A <a@b>", "Sat, 28 Nov 2026 12:00:00 +0000");
        assert!(text.starts_with("armill (0.1.0) unstable;"));
        assert!(text.ends_with(" -- A <a@b>  Sat, 28 Nov 2026 12:00:00 +0000\n"));
    }
}
