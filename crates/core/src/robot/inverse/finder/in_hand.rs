//! Postures of an arm that holds the part: those of the arm, its joints from the flange back.

use super::super::super::branch::BranchPattern;
use super::super::super::unreachable::Unreachable;
use super::super::kind::in_opposite_order;
use super::{Finder, InverseSolution, InverseTarget};

impl Finder<'_> {
    /// The postures of the arm that holds the part, its joints from the flange back.
    pub(super) fn of_hand(
        &mut self,
        expected: &InverseTarget<'_>,
        pattern: BranchPattern,
        most: usize,
    ) -> Result<&[InverseSolution], Unreachable> {
        self.discard();
        if let Some((hand, of_arm)) = &mut self.hand {
            let near = expected.near.map(in_opposite_order);
            let home = expected.home.or(self.robot.rest()).map(in_opposite_order);
            let of_flange = InverseTarget {
                base_from_flange: hand.base_from_flange(&expected.base_from_flange),
                near: near.as_deref(),
                home: home.as_deref(),
            };
            let found = of_arm.find(&of_flange, pattern, most)?.iter();
            self.found.extend(found.map(|one| InverseSolution {
                joints: in_opposite_order(&one.joints),
                ..one.clone()
            }));
        }
        Ok(&self.found)
    }
}
