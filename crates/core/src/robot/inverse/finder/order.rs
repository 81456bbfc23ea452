//! The order of postures without names: the nearest first.

use super::{Finder, InverseSolution};

impl Finder<'_> {
    /// [`Finder::sort`], and keeps the chain positions for the pose that follows.
    pub(super) fn order(&mut self, near: Option<&[f64]>, most: usize) {
        self.sort(near, most);
        self.remember();
    }

    /// Sorts by distance from `near`, the previous posture, or home, and keeps `most` of them.
    pub(super) fn sort(&mut self, near: Option<&[f64]>, most: usize) {
        let mut ordered = std::mem::take(&mut self.ordered);
        let mut found = std::mem::take(&mut self.found);
        let before = near.is_none().then(|| self.before.first()).flatten();
        let from = near.unwrap_or(&self.home);
        let away = |found: &InverseSolution| -> f64 {
            match before {
                Some(theta) => {
                    let away = (0..theta.len()).map(|i| self.between(i, theta[i], &found.joints).powi(2));
                    away.sum()
                }
                None => found.joints.iter().zip(from).map(|(a, b)| (a - b).powi(2)).sum(),
            }
        };
        let lanes = self
            .lanes
            .iter()
            .copied()
            .map(Some)
            .chain(std::iter::repeat(None));
        ordered.extend(
            found
                .drain(..)
                .zip(lanes)
                .map(|(found, lane)| (away(&found), lane, found)),
        );
        ordered.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        self.spare.extend(
            ordered
                .drain(most.min(ordered.len())..)
                .map(|(.., found)| found.joints),
        );
        self.lanes.clear();
        self.lanes.extend(ordered.iter().filter_map(|(_, lane, _)| *lane));
        found.extend(ordered.drain(..).map(|(.., found)| found));
        (self.found, self.ordered) = (found, ordered);
        self.is_remembered = false;
    }

    /// Keeps the chain positions of the postures sorted last, for the pose that follows, if that has not been done.
    pub(super) fn remember(&mut self) {
        if std::mem::replace(&mut self.is_remembered, true) {
            return;
        }
        self.spare.append(&mut self.before);
        for found in &self.found {
            let mut theta = self.spare.pop().unwrap_or_default();
            theta.clear();
            let arm = self.arm.first..found.joints.len();
            theta.extend(arm.map(|joint| self.robot.theta(joint, &found.joints)));
            self.before.push(theta);
        }
    }
}
