//! Postures in robot programs: rear, lower arm, flip.
//!
//! | word | [`Branch`] |
//! |---|---|
//! | rear | shoulder back |
//! | lower | elbow bent the other way: down in front, up behind |
//! | flip | wrist bend below zero |
//!
//! Controllers define the elbow bend as seen from the side of the arm, so it is upside down behind axis 1. armill
//! defines it as up or down in base z. Source: the posts of the six samples, whose postures are all in front; behind,
//! `[recalled]` from the makers' figures.

use armill_core::robot::{Branch, BranchPattern, Elbow, Shoulder, Wrist};

/// A posture in the terms of controllers; `None` if it is not given.
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
    /// The configuration of a branch.
    pub fn of(branch: Branch) -> Configuration {
        let rear = branch.shoulder == Shoulder::Back;
        Configuration {
            rear: Some(rear),
            lower: Some((branch.elbow == Elbow::Down) != rear),
            flip: Some(branch.wrist == Wrist::Flip),
        }
    }

    /// As a branch pattern; without the elbow if the shoulder is not known.
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
    fn every_branch_survives_conversion_to_a_configuration() {
        for branch in Branch::ALL {
            assert_eq!(Configuration::of(branch).pattern(), BranchPattern::from(branch));
        }
        assert_eq!(Configuration::default().pattern(), BranchPattern::default());
    }
}
