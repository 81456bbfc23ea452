//! How controllers tell one posture from another: rear, lower arm, flip.
//!
//! | word | of ours ([`Branch`]) |
//! |---|---|
//! | rear | shoulder back |
//! | lower | elbow bent the other way: down in front, up behind |
//! | flip | wrist bend below zero |
//!
//! Controllers see the bending of the elbow from the side of the arm, so behind axis 1 it is upside down, where ours is up
//! or down in base z. Source: the posts of the six samples, whose postures are all in front; behind, `[recalled]` from the
//! makers' figures.

use armill_core::robot::{Branch, BranchPattern, Elbow, Shoulder, Wrist};

/// A posture in the words of controllers; `None` where nothing is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Configuration {
    /// The wrist centre is behind axis 1.
    pub rear: Option<bool>,
    /// The elbow is bent the other way.
    pub lower: Option<bool>,
    /// Axis 5 is bent the other way.
    pub flip: Option<bool>,
}

impl Configuration {
    /// Of one of our branches.
    pub fn of(branch: Branch) -> Configuration {
        let rear = branch.shoulder == Shoulder::Back;
        Configuration {
            rear: Some(rear),
            lower: Some((branch.elbow == Elbow::Down) != rear),
            flip: Some(branch.wrist == Wrist::Flip),
        }
    }

    /// As our branches are told; of the elbow nothing where the shoulder is not known.
    pub fn pattern(self) -> BranchPattern {
        let elbow = self.rear.zip(self.lower);
        BranchPattern {
            shoulder: self
                .rear
                .map(|rear| if rear { Shoulder::Back } else { Shoulder::Front }),
            elbow: elbow.map(|(rear, lower)| if rear == lower { Elbow::Up } else { Elbow::Down }),
            wrist: self
                .flip
                .map(|flip| if flip { Wrist::Flip } else { Wrist::NoFlip }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_branch_comes_back_from_the_words_of_controllers() {
        for branch in Branch::ALL {
            assert_eq!(Configuration::of(branch).pattern(), BranchPattern::from(branch));
        }
        assert_eq!(Configuration::default().pattern(), BranchPattern::default());
    }
}
