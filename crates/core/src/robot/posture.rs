//! Postures: the ways an arm can hold one tool pose, their names, and why there may be none.
//!
//! | word | meaning |
//! |---|---|
//! | front, back | wrist centre at x >= 0 or x < 0 in the frame turned by the first joint |
//! | elbow-up, elbow-down | elbow above or below the line shoulder - wrist, in base z |
//! | no-flip, flip | wrist bend psi3 >= 0 or < 0, about the arm's own +y, zero with the flange along the forearm |
//!
//! The flip turns joint axes 4 and 6 on themselves and leaves the compliance unchanged.

use std::fmt;
use std::str::FromStr;

use crate::frame::Isometry;
use crate::spatial::Twist;

/// Where the wrist centre lies seen from the turned base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shoulder {
    /// Before the first axis.
    Front,
    /// Behind it: the arm reaches overhead.
    Back,
}

impl Shoulder {
    /// Front or back, from the place `x` of the wrist centre before the first axis.
    pub(super) fn at(x: f64) -> Shoulder {
        if x >= 0.0 { Shoulder::Front } else { Shoulder::Back }
    }
}

/// On which side of the line shoulder - wrist the elbow lies.
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

/// One of the eight postures of an arm whose branches have names.
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

impl fmt::Display for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        BranchPattern::from(*self).fmt(f)
    }
}

/// What tells a posture from the others of its pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PostureName {
    /// One of eight branches.
    Branch(Branch),
    /// Of a chain whose branches have no names: the side of the middle on which each joint stands.
    Sides(Sides),
}

impl PostureName {
    /// The branch, if it is one.
    pub fn branch(self) -> Option<Branch> {
        match self {
            PostureName::Branch(branch) => Some(branch),
            PostureName::Sides(_) => None,
        }
    }
}

impl fmt::Display for PostureName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PostureName::Branch(branch) => branch.fmt(f),
            PostureName::Sides(sides) => sides.fmt(f),
        }
    }
}

/// For each joint, base to flange, whether it stands at or above (`+`) or below (`-`) the middle of its range.
///
/// It depends on the joint positions alone. Two postures of one pose nearly always differ in it, but need not.
/// Joints beyond the thirty-second are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sides {
    joints: u8,
    above: u32,
}

impl Sides {
    /// The sides of these joint positions (rad, m) from the middles of the ranges.
    pub fn of(joints: &[f64], middles: &[f64]) -> Sides {
        let bits = joints.iter().zip(middles).take(32);
        Sides {
            joints: bits.len() as u8,
            above: bits
                .enumerate()
                .map(|(i, (q, middle))| u32::from(q >= middle) << i)
                .sum(),
        }
    }
}

impl fmt::Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = |i: u8| if self.above >> i & 1 == 1 { '+' } else { '-' };
        f.write_str(&(0..self.joints).map(sign).collect::<String>())
    }
}

/// A branch of which some words may be left open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BranchPattern {
    /// Front or back, if said.
    pub shoulder: Option<Shoulder>,
    /// Elbow up or down, if said.
    pub elbow: Option<Elbow>,
    /// Flip or no flip, if said.
    pub wrist: Option<Wrist>,
}

impl BranchPattern {
    /// Front, elbow up, either wrist: how most arms stand before their work.
    pub const FRONT_ELBOW_UP: BranchPattern = BranchPattern {
        shoulder: Some(Shoulder::Front),
        elbow: Some(Elbow::Up),
        wrist: None,
    };

    /// Whether `branch` is one of those meant.
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

/// A word that names no branch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{word}` names no branch: write words out of `front|back elbow-up|elbow-down flip|no-flip`, each pair at most once"
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

/// A place where a joint or two lose their effect: the posture is valid, its neighbours are far away in
/// joint space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// Wrist centre near the first axis.
    Shoulder,
    /// Arm stretched or folded.
    Elbow,
    /// Axes 4 and 6 in line; parallel, of an arm with three parallel axes.
    Wrist,
    /// Some joints do nearly the same: of a chain whose singularities have no names.
    Dependent,
}

impl Singularity {
    /// One word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Singularity::Shoulder => "shoulder",
            Singularity::Elbow => "elbow",
            Singularity::Wrist => "wrist",
            Singularity::Dependent => "dependent",
        }
    }
}

impl fmt::Display for Singularity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Singularity::Shoulder => "shoulder: wrist centre near the first axis",
            Singularity::Elbow => "elbow: arm stretched or folded",
            Singularity::Wrist => "wrist: axes 4 and 6 nearly in line",
            Singularity::Dependent => "dependent: some joints do nearly the same",
        })
    }
}

/// Why a tool pose has no posture, and by how much it misses. Lengths m, angles rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreachable {
    /// The wrist centre is `by` farther from the shoulder than the stretched arm.
    TooFar {
        /// m
        by: f64,
    },
    /// The wrist centre is `by` nearer to the shoulder than the folded arm.
    TooNear {
        /// m
        by: f64,
    },
    /// The wrist centre is `by` inside the lateral offset about the first axis.
    InsideLateralOffset {
        /// m
        by: f64,
    },
    /// No start of a search led to the pose, which may still be within reach; the nearest that was found misses it by
    /// `by` and `turned`.
    NotFound {
        /// m
        by: f64,
        /// rad
        turned: f64,
    },
    /// The closed form gave a posture whose forward kinematics misses the pose by `by`: a broken geometry.
    Unverified {
        /// m
        by: f64,
    },
    /// Every posture asked for leaves the range of a joint; in the least bad one, joint `joint` by `by`.
    OutsideLimits {
        /// Index of the joint, from 0.
        joint: usize,
        /// rad (m for a sliding joint)
        by: f64,
    },
    /// A posture holds the pose, but under this load case the arm finds no stable rest.
    Unstable {
        /// Index of the load case, from 0.
        case: usize,
    },
}

impl Unreachable {
    /// By how much it misses, m; rad where a turning joint is outside its limits.
    pub fn amount(&self) -> f64 {
        match *self {
            Unreachable::TooFar { by }
            | Unreachable::TooNear { by }
            | Unreachable::InsideLateralOffset { by }
            | Unreachable::NotFound { by, .. }
            | Unreachable::Unverified { by }
            | Unreachable::OutsideLimits { by, .. } => by,
            Unreachable::Unstable { .. } => f64::INFINITY,
        }
    }

    /// One word for tables.
    pub fn reason(&self) -> &'static str {
        match self {
            Unreachable::TooFar { .. } => "too_far",
            Unreachable::TooNear { .. } => "too_near",
            Unreachable::InsideLateralOffset { .. } => "inside_lateral_offset",
            Unreachable::NotFound { .. } => "not_found",
            Unreachable::Unverified { .. } => "unverified",
            Unreachable::OutsideLimits { .. } => "outside_joint_limits",
            Unreachable::Unstable { .. } => "unstable",
        }
    }
}

impl fmt::Display for Unreachable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unreachable::TooFar { by } => {
                write!(
                    f,
                    "out of reach: the wrist centre is {:.1} mm beyond the stretched arm",
                    by * 1e3
                )
            }
            Unreachable::TooNear { by } => {
                write!(
                    f,
                    "too near: the wrist centre is {:.1} mm inside the folded arm",
                    by * 1e3
                )
            }
            Unreachable::InsideLateralOffset { by } => {
                write!(
                    f,
                    "too near: the wrist centre is {:.1} mm inside the lateral offset",
                    by * 1e3
                )
            }
            Unreachable::NotFound { by, turned } => {
                write!(
                    f,
                    "no posture was found, which does not prove that there is none: the nearest misses by {:.1} mm and {:.2} deg",
                    by * 1e3,
                    turned.to_degrees()
                )
            }
            Unreachable::Unverified { by } => {
                write!(
                    f,
                    "the inverse kinematics misses the pose by {:.6} mm: no posture is given",
                    by * 1e3
                )
            }
            Unreachable::OutsideLimits { joint, by } => write!(
                f,
                "no posture inside the joint limits: the least bad one leaves the range of joint number {} by {:.1} deg",
                joint + 1,
                by.to_degrees()
            ),
            Unreachable::Unstable { case } => write!(
                f,
                "the arm finds no stable rest under load case {}: it buckles, or is far too soft for this load",
                case + 1
            ),
        }
    }
}

/// One way to hold the tool at a pose.
#[derive(Clone, Debug)]
pub struct Posture {
    /// Its name.
    pub name: PostureName,
    /// Joint positions `q`, rad (m), in the controller's counting.
    pub joints: Vec<f64>,
    /// The tool it holds.
    pub base_from_tool: Isometry,
    /// Screw of every joint at the TCP, base basis, per unit of chain position.
    pub screws: Vec<Twist>,
    /// Near which singularity it stands, if any.
    pub singularity: Option<Singularity>,
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
}
