//! Descents from many starts to one pose, some at once, in the order of the starts.

use super::super::chain::Chain;
use super::super::unreachable::Unreachable;
use super::descents_in_lanes::{Descended, DescentsInLanes, Reached};
use super::verify::Requested;

/// Descents to one pose.
#[derive(Clone, Debug)]
pub(super) struct Descents {
    lanes: DescentsInLanes,
    /// Of each start that has begun, its descent if that has ended.
    ended: Vec<Option<Descended>>,
}

impl Descents {
    /// For a chain of at most six joints.
    pub fn new(chain: &Chain) -> Descents {
        Descents {
            lanes: DescentsInLanes::new(chain),
            ended: Vec::new(),
        }
    }

    /// Forgets all descents, and goes to another pose.
    pub fn aim_at(&mut self, chain: &Chain, goal: &Requested) {
        self.lanes.aim_at(chain, goal);
        self.ended.clear();
    }

    /// Ends descents to the posture at these chain positions as soon as they lead there.
    pub fn know(&mut self, theta: &[f64]) {
        self.lanes.know(theta);
    }

    /// The descent from start `index` of `count`: its end, into `theta`. `start` fills the chain positions of a start.
    ///
    /// # Errors
    /// The error that remains where it does not reach the pose.
    pub fn from(
        &mut self,
        chain: &Chain,
        [index, count]: [usize; 2],
        start: impl Fn(usize, &mut [f64]),
        theta: &mut [f64],
    ) -> Result<Reached, Unreachable> {
        loop {
            // A lane without a descent would be computed as well.
            while self.ended.len() < count
                && let Some(lane) = self.lanes.free_lane()
            {
                start(self.ended.len(), theta);
                self.lanes.begin(lane, self.ended.len(), theta);
                self.ended.push(None);
            }
            if let Some(descended) = self.ended[index] {
                theta.copy_from_slice(&descended.theta[..theta.len()]);
                return descended.reached;
            }
            let ended = &mut self.ended;
            self.lanes
                .step(chain, |start, descended| ended[start] = Some(descended));
        }
    }
}
