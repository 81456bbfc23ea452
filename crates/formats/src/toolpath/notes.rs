//! Ignored words and assumptions: number of occurrences, and the first line.
//!
//! A program of any length may skip the same word many times: one note reports it. Kinds are listed in their
//! own order (`Ord`), not in that of the program, so that the same program gives the same notes.

use std::collections::BTreeMap;
use std::fmt;

/// How often each thing of a kind came, and the line of its first time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notes<K>(BTreeMap<K, Noted>);

/// How often something came; shown as `twice, first in line 7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noted {
    /// How often.
    pub count: u64,
    /// The line of the first time, from 1.
    pub first_line: u32,
}

impl<K> Default for Notes<K> {
    fn default() -> Notes<K> {
        Notes(BTreeMap::new())
    }
}

impl<K: Ord + Copy> Notes<K> {
    /// Takes over what another counted behind the first.
    ///
    /// The first lines are those of the first where both counted.
    pub(super) fn join(&mut self, other: &Notes<K>) {
        for (key, noted) in other.iter() {
            self.0
                .entry(*key)
                .and_modify(|known| known.count += noted.count)
                .or_insert(noted);
        }
    }
}

impl<K: Ord> Notes<K> {
    /// Counts one more.
    pub(super) fn count(&mut self, key: K, line: u32) {
        let first = Noted {
            count: 0,
            first_line: line,
        };
        self.0.entry(key).or_insert(first).count += 1;
    }

    /// Each with its count and the line of its first time.
    pub fn iter(&self) -> impl Iterator<Item = (&K, Noted)> {
        self.0.iter().map(|(key, noted)| (key, *noted))
    }

    /// How many different things were counted.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether this one was counted.
    pub(super) fn has(&self, key: &K) -> bool {
        self.0.contains_key(key)
    }
}

impl fmt::Display for Noted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            1 => f.write_str("once")?,
            2 => f.write_str("twice")?,
            more => write!(f, "{more} times")?,
        }
        write!(f, ", first in line {}", self.first_line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_two_are_added_and_the_first_line_stays() {
        let (mut one, mut other) = (Notes::default(), Notes::default());
        one.count('a', 3);
        one.count('a', 5);
        other.count('a', 9);
        other.count('b', 4);
        one.join(&other);
        let said: Vec<String> = one.iter().map(|(key, noted)| format!("{key} {noted}")).collect();
        assert_eq!(said, ["a 3 times, first in line 3", "b once, first in line 4"]);
    }
}
