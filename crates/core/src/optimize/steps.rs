//! The values of a freedom that a search tries at each point.

/// Evenly spaced values: spins of the tool, angles of a lean, positions of an external axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The first, rad (m).
    pub first: f64,
    /// Step, rad (m); above zero.
    pub step: f64,
    /// Number of values, at least one.
    pub count: usize,
}

impl Steps {
    /// A freedom that is not used: this value alone.
    pub fn one(value: f64) -> Steps {
        Steps {
            first: value,
            step: 1.0,
            count: 1,
        }
    }

    /// Value number `index`, rad (m).
    pub fn at(&self, index: usize) -> f64 {
        self.first + self.step * index as f64
    }

    /// The last value, rad (m).
    pub fn last(&self) -> f64 {
        self.at(self.count - 1)
    }

    /// The same range in half the steps.
    pub(super) fn halved(&self) -> Steps {
        Steps {
            step: 0.5 * self.step,
            count: 2 * self.count - 1,
            ..*self
        }
    }

    /// Every `stride`-th value.
    pub(super) fn every(&self, stride: usize) -> Steps {
        Steps {
            step: self.step * stride as f64,
            count: (self.count - 1) / stride + 1,
            ..*self
        }
    }
}
