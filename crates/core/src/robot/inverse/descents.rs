//! Descents from many starts to one pose, eight at once, in the order of the starts.

use super::super::chain::Chain;
use super::super::unreachable::Unreachable;
use super::descents_in_lanes::{Descended, DescentsInLanes};
use super::verify::Requested;

/// Descents to one pose.
#[derive(Clone, Debug)]
pub(super) struct Descents {
    eight: DescentsInLanes,
    /// Of each start that has begun, its descent if that has ended.
    ended: Vec<Option<Descended>>,
}

impl Descents {
    /// For a chain of at most six joints.
    pub fn new(chain: &Chain) -> Descents {
        Descents {
            eight: DescentsInLanes::new(chain),
            ended: Vec::new(),
        }
    }

    /// Forgets all descents, and goes to another pose.
    pub fn aim_at(&mut self, goal: &Requested) {
        self.eight.aim_at(goal);
        self.ended.clear();
    }

    /// The descent from start `index`, where all starts before `certain` will be asked for: its end, into `theta`. `start`
    /// fills the chain positions of a start.
    ///
    /// # Errors
    /// The error that remains where it does not reach the pose.
    pub fn from(
        &mut self,
        chain: &Chain,
        index: usize,
        certain: usize,
        start: impl Fn(usize, &mut [f64]),
        theta: &mut [f64],
    ) -> Result<(), Unreachable> {
        let certain = certain.max(index + 1);
        loop {
            while self.ended.len() < certain
                && let Some(lane) = self.eight.free_lane()
            {
                start(self.ended.len(), theta);
                self.eight.begin(lane, self.ended.len(), theta);
                self.ended.push(None);
            }
            if let Some(descended) = self.ended[index] {
                theta.copy_from_slice(&descended.theta[..theta.len()]);
                return descended.reached;
            }
            let ended = &mut self.ended;
            self.eight
                .step(chain, |start, descended| ended[start] = Some(descended));
        }
    }
}
