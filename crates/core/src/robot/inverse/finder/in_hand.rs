//! Postures of an arm that holds the part: those of the arm, its joints from the flange back.

use super::super::super::branch::BranchPattern;
use super::super::super::hand::in_opposite_order;
use super::super::super::unreachable::Unreachable;
use super::{Finder, InverseSolution, InverseTarget};

impl Finder<'_> {
    /// The postures whose branch matches, at most so many without names.
    pub(super) fn in_hand(
        &mut self,
        expected: &InverseTarget<'_>,
        pattern: BranchPattern,
        most: usize,
    ) -> Result<&[InverseSolution], Unreachable> {
        self.discard();
        let Some((hand, holding)) = self.robot.hand().zip(self.holding.as_mut()) else {
            return Ok(&self.found);
        };
        let near = expected.near.map(in_opposite_order);
        let home = expected.home.or(self.robot.rest()).map(in_opposite_order);
        let of_flange = InverseTarget {
            base_from_flange: hand.base_from_mount * expected.base_from_flange.inverse(),
            near: near.as_deref(),
            home: home.as_deref(),
        };
        let found = holding.find(&of_flange, pattern, most)?.iter();
        self.found.extend(found.map(|one| InverseSolution {
            joints: in_opposite_order(&one.joints),
            ..one.clone()
        }));
        Ok(&self.found)
    }
}
