//! State of a search, stored in a file, so that an interrupted search can continue.
//!
//! ```text
//! 1f3a...                    fingerprint of all input: another search does not continue from here
//! NAME  3fe0... 3fd5...      a finished round, and its best placement: the bits of its numbers
//! ```

use std::collections::BTreeMap;
use std::path::Path;

use armill_formats::file::ResultFolder;
use armill_study::error::StudyError;

/// Rounds that are done.
#[derive(Clone, Debug)]
pub struct Journal<'a> {
    kept_in: Option<&'a ResultFolder>,
    fingerprint: u64,
    rounds: BTreeMap<String, Vec<f64>>,
    /// Rounds that an earlier run had done.
    taken: usize,
}

/// The file.
const ROUNDS: &str = "place.rounds";

impl<'a> Journal<'a> {
    /// A journal without a file.
    pub fn none() -> Journal<'a> {
        Journal {
            kept_in: None,
            fingerprint: 0,
            rounds: BTreeMap::new(),
            taken: 0,
        }
    }

    /// One that is kept in the file `place.rounds` of this folder until its results are finished.
    pub fn kept_in(folder: &'a ResultFolder) -> Journal<'a> {
        Journal {
            kept_in: Some(folder),
            ..Journal::none()
        }
    }

    /// Loads the file, if it is of a search with this fingerprint.
    pub(super) fn take_up(&mut self, fingerprint: u64) {
        self.fingerprint = fingerprint;
        self.rounds = self
            .kept_in
            .and_then(|folder| read(&folder.path().join(ROUNDS), fingerprint))
            .unwrap_or_default();
    }

    /// Rounds that an earlier run had done and this one took.
    pub fn taken(&self) -> usize {
        self.taken
    }

    /// The result of this round: from the file, or computed and stored.
    ///
    /// # Errors
    /// Errors of the computation; a file that cannot be written.
    pub(super) fn round(
        &mut self,
        name: &str,
        work: impl FnOnce() -> Result<Vec<f64>, StudyError>,
    ) -> Result<Vec<f64>, StudyError> {
        if let Some(at) = self.rounds.get(name) {
            self.taken += 1;
            return Ok(at.clone());
        }
        let at = work()?;
        self.rounds.insert(name.to_owned(), at.clone());
        if let Some(folder) = self.kept_in {
            folder.write_for_now(ROUNDS, self.text().as_bytes())?;
        }
        Ok(at)
    }

    fn text(&self) -> String {
        let mut text = format!("{:016x}\n", self.fingerprint);
        for (name, at) in &self.rounds {
            let bits: String = at
                .iter()
                .map(|value| format!("\t{:016x}", value.to_bits()))
                .collect();
            text += &format!("{name}{bits}\n");
        }
        text
    }
}

/// The rounds in this file; `None` if it does not exist, is of another search, or is incomplete.
fn read(file: &Path, fingerprint: u64) -> Option<BTreeMap<String, Vec<f64>>> {
    let regular = file.symlink_metadata().is_ok_and(|found| found.is_file());
    let text = regular.then(|| std::fs::read_to_string(file).ok()).flatten()?;
    let mut lines = text.lines();
    if lines.next() != Some(&format!("{fingerprint:016x}")) {
        return None;
    }
    let round = |line: &str| {
        let (name, bits) = line.split_once('\t').unwrap_or((line, ""));
        let values = bits.split('\t').filter(|bits| !bits.is_empty());
        let values = values.map(|bits| {
            let value = f64::from_bits(u64::from_str_radix(bits, 16).ok()?);
            (bits.len() == DIGITS && (0.0..=1.0).contains(&value)).then_some(value)
        });
        Some((name.to_owned(), values.collect::<Option<_>>()?))
    };
    lines.map(round).collect()
}

/// Hexadecimal digits of a number's bits.
const DIGITS: usize = 16;

/// A fingerprint of numbers: FNV-1a over their bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fingerprint(u64);

impl Fingerprint {
    pub fn new() -> Fingerprint {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }

    pub fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    pub fn value(self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use armill_formats::file::Writer;

    use super::*;

    #[test]
    fn a_round_that_is_done_is_not_done_again() {
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("place", false).folder(folder.path()).unwrap();
        let mut journal = Journal::kept_in(&out);
        journal.take_up(7);
        let found = journal.round("valley 0", || Ok(vec![0.1 + 0.2, 1.0])).unwrap();
        let mut again = Journal::kept_in(&out);
        again.take_up(7);
        let kept = again.round("valley 0", || panic!("it is kept")).unwrap();
        assert_eq!(kept, found);
        assert_eq!((journal.taken(), again.taken()), (0, 1));
        // Another search starts from the beginning.
        let mut other = Journal::kept_in(&out);
        other.take_up(8);
        assert_eq!(other.round("valley 0", || Ok(vec![0.5])).unwrap(), [0.5]);
        out.finish().unwrap();
        assert!(!folder.path().join(ROUNDS).exists());
    }

    #[test]
    fn an_incomplete_file_is_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("place", true).folder(folder.path()).unwrap();
        for text in [
            "",
            "0000000000000007\nvalley\t3fe",
            "0000000000000007\nvalley\tno",
            "seven",
            "0000000000000007\nvalley\t4024000000000000",
        ] {
            std::fs::write(folder.path().join(ROUNDS), text).unwrap();
            let mut journal = Journal::kept_in(&out);
            journal.take_up(7);
            let at = journal.round("valley", || Ok(vec![0.25])).unwrap();
            assert_eq!(at, [0.25], "{text}");
        }
    }
}
