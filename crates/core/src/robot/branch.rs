//! Branches: the eight named postures of an arm (ABB: cfx; KUKA: S and T; FANUC: NUT/FUT; Yaskawa: form), and patterns.
//!
//! | word | meaning |
//! |---|---|
//! | front, back | wrist centre at x >= 0 or x < 0 in the frame turned by the first joint |
//! | elbow-up, elbow-down | elbow above or below the line shoulder - wrist, in base z |
//! | no-flip, flip | wrist bend psi3 >= 0 or < 0, about the arm's own +y, zero with the flange along the forearm |
//!
//! The flip of a spherical wrist turns joint axes 4 and 6 on themselves and does not change the compliance. For an arm
//! with three parallel axes it is another posture with another compliance.

use std::fmt;
use std::str::FromStr;

/// Side of the wrist centre in the frame turned by the first joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shoulder {
    /// Before the first axis.
    Front,
    /// Behind it: the arm reaches overhead.
    Back,
}

impl Shoulder {
    /// Front or back, from the coordinate `x` of the wrist centre in the turned frame.
    pub(super) fn at(x: f64) -> Shoulder {
        if x >= 0.0 { Shoulder::Front } else { Shoulder::Back }
    }
}

/// Side of the line shoulder - wrist on which the elbow is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Elbow {
    /// Above.
    Up,
    /// Below.
    Down,
}

/// Sign of the wrist bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wrist {
    /// Bend >= 0.
    NoFlip,
    /// Bend < 0.
    Flip,
}

impl Wrist {
    /// Flip or not, from the sine of the bend.
    pub(super) fn bent(sin_bend: f64) -> Wrist {
        if sin_bend >= 0.0 {
            Wrist::NoFlip
        } else {
            Wrist::Flip
        }
    }
}

/// One of the eight postures of an arm with named branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Branch {
    /// Front or back.
    pub shoulder: Shoulder,
    /// Elbow up or down.
    pub elbow: Elbow,
    /// Flip or no flip.
    pub wrist: Wrist,
}

impl Branch {
    /// All eight, front elbow-up no-flip first; each is followed by its flip.
    pub const ALL: [Branch; 8] = {
        use Elbow::{Down, Up};
        use Shoulder::{Back, Front};
        use Wrist::{Flip, NoFlip};
        const fn branch(shoulder: Shoulder, elbow: Elbow, wrist: Wrist) -> Branch {
            Branch {
                shoulder,
                elbow,
                wrist,
            }
        }
        [
            branch(Front, Up, NoFlip),
            branch(Front, Up, Flip),
            branch(Front, Down, NoFlip),
            branch(Front, Down, Flip),
            branch(Back, Up, NoFlip),
            branch(Back, Up, Flip),
            branch(Back, Down, NoFlip),
            branch(Back, Down, Flip),
        ]
    };
}

impl Branch {
    /// Its place in [`Branch::ALL`].
    pub(super) fn index(self) -> usize {
        4 * usize::from(self.shoulder == Shoulder::Back)
            + 2 * usize::from(self.elbow == Elbow::Down)
            + usize::from(self.wrist == Wrist::Flip)
    }
}

impl fmt::Display for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        BranchPattern::from(*self).fmt(f)
    }
}

/// A branch of which some words may be open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BranchPattern {
    /// Front or back, if given.
    pub shoulder: Option<Shoulder>,
    /// Elbow up or down, if given.
    pub elbow: Option<Elbow>,
    /// Flip or no flip, if given.
    pub wrist: Option<Wrist>,
}

impl BranchPattern {
    /// Front, elbow up, either wrist: the usual posture for work.
    pub const FRONT_ELBOW_UP: BranchPattern = BranchPattern {
        shoulder: Some(Shoulder::Front),
        elbow: Some(Elbow::Up),
        wrist: None,
    };

    /// Whether `branch` matches the pattern.
    pub fn matches(&self, branch: Branch) -> bool {
        self.shoulder.is_none_or(|s| s == branch.shoulder)
            && self.elbow.is_none_or(|e| e == branch.elbow)
            && self.wrist.is_none_or(|w| w == branch.wrist)
    }

    /// This pattern with its open words taken from `other`.
    #[must_use]
    pub fn or(&self, other: BranchPattern) -> BranchPattern {
        BranchPattern {
            shoulder: self.shoulder.or(other.shoulder),
            elbow: self.elbow.or(other.elbow),
            wrist: self.wrist.or(other.wrist),
        }
    }
}

impl From<Branch> for BranchPattern {
    fn from(branch: Branch) -> BranchPattern {
        BranchPattern {
            shoulder: Some(branch.shoulder),
            elbow: Some(branch.elbow),
            wrist: Some(branch.wrist),
        }
    }
}

impl fmt::Display for BranchPattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shoulder = self.shoulder.map(|s| match s {
            Shoulder::Front => "front",
            Shoulder::Back => "back",
        });
        let elbow = self.elbow.map(|e| match e {
            Elbow::Up => "elbow-up",
            Elbow::Down => "elbow-down",
        });
        let wrist = self.wrist.map(|w| match w {
            Wrist::NoFlip => "no-flip",
            Wrist::Flip => "flip",
        });
        let words: Vec<&str> = [shoulder, elbow, wrist].into_iter().flatten().collect();
        f.write_str(if words.is_empty() { "any" } else { "" })?;
        f.write_str(&words.join(" "))
    }
}

/// A word that is not a branch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{word}` is not a branch: use words out of `front|back elbow-up|elbow-down flip|no-flip`, each pair at most once"
)]
pub struct UnknownBranch {
    /// The word, or the word said twice.
    pub word: String,
}

impl FromStr for BranchPattern {
    type Err = UnknownBranch;

    fn from_str(text: &str) -> Result<BranchPattern, UnknownBranch> {
        fn set<T>(slot: &mut Option<T>, value: T, word: &str) -> Result<(), UnknownBranch> {
            match slot.replace(value) {
                None => Ok(()),
                Some(_) => Err(UnknownBranch {
                    word: word.to_owned(),
                }),
            }
        }
        let mut pattern = BranchPattern::default();
        for word in text.split_whitespace() {
            match word {
                "front" => set(&mut pattern.shoulder, Shoulder::Front, word)?,
                "back" => set(&mut pattern.shoulder, Shoulder::Back, word)?,
                "elbow-up" => set(&mut pattern.elbow, Elbow::Up, word)?,
                "elbow-down" => set(&mut pattern.elbow, Elbow::Down, word)?,
                "no-flip" => set(&mut pattern.wrist, Wrist::NoFlip, word)?,
                "flip" => set(&mut pattern.wrist, Wrist::Flip, word)?,
                _ => {
                    return Err(UnknownBranch {
                        word: word.to_owned(),
                    });
                }
            }
        }
        if pattern == BranchPattern::default() {
            return Err(UnknownBranch {
                word: text.to_owned(),
            });
        }
        Ok(pattern)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_branches_read_back() {
        for branch in Branch::ALL {
            let pattern: BranchPattern = branch.to_string().parse().unwrap();
            assert_eq!(
                Branch::ALL
                    .into_iter()
                    .filter(|b| pattern.matches(*b))
                    .collect::<Vec<_>>(),
                [branch]
            );
        }
    }

    #[test]
    fn open_words_match_both() {
        let pattern: BranchPattern = "elbow-down".parse().unwrap();
        assert_eq!(Branch::ALL.into_iter().filter(|b| pattern.matches(*b)).count(), 4);
        let completed = pattern.or(BranchPattern::FRONT_ELBOW_UP);
        assert_eq!(completed.to_string(), "front elbow-down");
    }

    #[test]
    fn unknown_doubled_and_missing_words_are_refused() {
        for (text, word) in [("front elbow", "elbow"), ("front back", "back"), ("", "")] {
            assert_eq!(text.parse::<BranchPattern>().unwrap_err().word, word);
        }
    }

    /// All patterns: each word given, its opposite given, or open.
    fn patterns() -> Vec<BranchPattern> {
        let mut all = Vec::new();
        for shoulder in [None, Some(Shoulder::Front), Some(Shoulder::Back)] {
            for elbow in [None, Some(Elbow::Up), Some(Elbow::Down)] {
                for wrist in [None, Some(Wrist::NoFlip), Some(Wrist::Flip)] {
                    all.push(BranchPattern {
                        shoulder,
                        elbow,
                        wrist,
                    });
                }
            }
        }
        all
    }

    #[test]
    fn every_pattern_but_the_open_one_reads_back() {
        assert_eq!(patterns().len(), 27);
        for pattern in patterns() {
            let text = pattern.to_string();
            if pattern == BranchPattern::default() {
                assert_eq!(text, "any");
                assert_eq!(text.parse::<BranchPattern>().unwrap_err().word, "any");
            } else {
                assert_eq!(text.parse(), Ok(pattern), "{text}");
                // Words may come in any order, with any blanks.
                let reversed: Vec<&str> = text.split(' ').rev().collect();
                assert_eq!(format!("  {} ", reversed.join("\t")).parse(), Ok(pattern));
            }
        }
    }

    #[test]
    fn a_pattern_with_open_words_matches_as_many_branches() {
        for pattern in patterns() {
            let said = pattern
                .to_string()
                .split(' ')
                .filter(|word| *word != "any")
                .count();
            let meant = Branch::ALL
                .into_iter()
                .filter(|branch| pattern.matches(*branch))
                .count();
            assert_eq!(meant, 8 >> said, "{pattern}");
        }
    }

    #[test]
    fn given_words_stay_and_open_ones_are_filled() {
        for own in patterns() {
            assert_eq!(own.or(BranchPattern::default()), own);
            assert_eq!(BranchPattern::default().or(own), own);
            for other in patterns() {
                let both = own.or(other);
                assert_eq!(both.shoulder, own.shoulder.or(other.shoulder));
                assert_eq!(both.elbow, own.elbow.or(other.elbow));
                assert_eq!(both.wrist, own.wrist.or(other.wrist));
                // Whatever both match, the pattern itself matches.
                let narrower = |branch: &Branch| !both.matches(*branch) || own.matches(*branch);
                assert!(Branch::ALL.iter().all(narrower));
            }
        }
    }

    #[test]
    fn branches_are_distinct_and_each_is_followed_by_its_flip() {
        for (i, a) in Branch::ALL.iter().enumerate() {
            assert!(Branch::ALL[..i].iter().all(|b| a != b));
        }
        for pair in Branch::ALL.chunks(2) {
            assert_eq!(
                (pair[0].shoulder, pair[0].elbow),
                (pair[1].shoulder, pair[1].elbow)
            );
            assert_eq!((pair[0].wrist, pair[1].wrist), (Wrist::NoFlip, Wrist::Flip));
        }
        assert!(BranchPattern::FRONT_ELBOW_UP.matches(Branch::ALL[0]));
    }

    #[test]
    fn zero_is_front_and_no_flip() {
        assert_eq!(
            (Shoulder::at(0.0), Shoulder::at(-1e-300)),
            (Shoulder::Front, Shoulder::Back)
        );
        assert_eq!(
            (Wrist::bent(0.0), Wrist::bent(-1e-300)),
            (Wrist::NoFlip, Wrist::Flip)
        );
    }

    #[test]
    fn the_message_of_an_unknown_word_lists_the_valid_ones() {
        let error = "front up".parse::<BranchPattern>().unwrap_err();
        assert_eq!(
            error.to_string(),
            "`up` is not a branch: use words out of `front|back elbow-up|elbow-down flip|no-flip`, each pair at most once"
        );
    }
}
