//! Seeds and dictionary of a target, written as files where libFuzzer looks for them.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use crate::targets::Target;

/// A longer input is cut by libFuzzer: the limit that `cargo xtask fuzz` sets.
const LONGEST_BYTES: u64 = 64 << 10;
/// Folders within one another that are looked through for samples.
const DEEPEST: usize = 6;
/// More samples than this only slow the start down.
const MOST_SAMPLES: usize = 500;

/// Writes `corpus/TARGET/` and `dictionaries/TARGET.dict` in `folder`.
///
/// # Errors
/// An error of the operating system on a file.
pub fn write(target: &Target, folder: &Path) -> io::Result<()> {
    let corpus = folder.join("corpus").join(target.name);
    fs::create_dir_all(&corpus)?;
    for (index, seed) in (target.seeds)().iter().enumerate() {
        fs::write(corpus.join(format!("seed-{index:03}")), seed)?;
    }
    let mut samples = Vec::new();
    if let Some(folder) = env::var_os("ARMILL_SAMPLES") {
        collect(Path::new(&folder), target.endings, DEEPEST, &mut samples)?;
    }
    samples.sort();
    for (index, sample) in samples.iter().take(MOST_SAMPLES).enumerate() {
        fs::copy(sample, corpus.join(format!("sample-{index:03}")))?;
    }
    let dictionaries = folder.join("dictionaries");
    fs::create_dir_all(&dictionaries)?;
    let lines: String = target.words().iter().map(|word| line(word)).collect();
    fs::write(dictionaries.join(format!("{}.dict", target.name)), lines)
}

/// The files below `folder` with one of the endings that are short enough.
fn collect(folder: &Path, endings: &[&str], levels: usize, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let (path, kind) = (entry.path(), entry.file_type()?);
        if kind.is_dir() && levels > 0 {
            collect(&path, endings, levels - 1, found)?;
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        let requested = ending.is_some_and(|ending| endings.contains(&ending.to_lowercase().as_str()));
        if kind.is_file() && requested && entry.metadata()?.len() <= LONGEST_BYTES {
            found.push(path);
        }
    }
    Ok(())
}

/// A word as libFuzzer reads it: in quotes, all but plain characters as `\xAB`.
fn line(word: &str) -> String {
    let mut line = String::from("\"");
    for byte in word.bytes() {
        match byte {
            b'"' | b'\\' => line.extend(['\\', char::from(byte)]),
            b' '..=b'~' => line.push(char::from(byte)),
            _ => line += &format!("\\x{byte:02X}"),
        }
    }
    line + "\"\n"
}
