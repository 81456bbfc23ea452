//! What smoothing loses of a chain of postures.

use crate::map::{Obstacle, ObstacleKind};

/// Obstacles on the smoothed chain where that of the lattice has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Lost {
    /// All, also points nearer to a limit or a body than demanded.
    pub all: usize,
    /// Those that no margin prevents: points out of reach, joints that jump or are too slow.
    pub by_smoothing: usize,
}

impl Lost {
    /// Counts these.
    pub fn of(obstacles: impl Iterator<Item = Obstacle>) -> Lost {
        obstacles.fold(Lost::default(), |lost, Obstacle { kind, .. }| {
            let has_margin = matches!(
                kind,
                ObstacleKind::OutsideLimits { .. } | ObstacleKind::InCollision { .. }
            );
            Lost {
                all: lost.all + 1,
                by_smoothing: lost.by_smoothing + usize::from(!has_margin),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_collision_or_outside_limits_count_as_lost_but_not_by_smoothing() {
        let of = |kinds: &[ObstacleKind]| {
            let all = kinds.iter().enumerate();
            Lost::of(all.map(|(index, kind)| Obstacle { index, kind: *kind }))
        };
        let near = [
            ObstacleKind::InCollision { missing: 0.002 },
            ObstacleKind::OutsideLimits {
                joint: 1,
                margin: -0.01,
            },
        ];
        let jump = ObstacleKind::Jump { joint: 4, by: 1.2 };
        assert_eq!(of(&[]), Lost::default());
        assert_eq!((of(&near).all, of(&near).by_smoothing), (2, 0));
        let with = of(&[near[0], jump, ObstacleKind::Unreachable]);
        assert_eq!((with.all, with.by_smoothing), (3, 2));
    }
}
