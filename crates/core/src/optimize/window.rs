//! The settings that a search tries at each point of a path: all of them, or those near a chain found before.
//!
//! With spin, lean and external axes together all settings would be too many: 72 spins, 9 leads, 9 tilts and 30 positions
//! of a rail are 175 000, with eight postures each. A first search therefore uses large steps at a part of the points;
//! each further search uses half the steps, within two of them of the chain before, until the steps are those demanded.
//! Its chain is the best near that of the search before, not of all settings.

use std::f64::consts::TAU;

use super::freedoms::MOST_MOVING;
use super::grid::{AXES, Grid};
use super::posture::PostureSearch;
use super::steps::Steps;

/// Steps to either side of the chain before, first, and where that leads nowhere.
const BESIDE: [usize; 2] = [2, 4];
/// Beyond a range by rounding, rad (m).
const ROUNDED: f64 = 1e-9;

/// A setting: spin, lead and tilt (rad), positions of external axes (m, rad).
pub(super) type Setting = [f64; AXES];

/// The settings tried at each point.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// All that the search permits, in the demanded steps.
    whole: [Steps; AXES],
    /// How many demanded steps a step of this window is.
    strides: [usize; AXES],
    /// The chain before, at every point of the path; `None`: all settings.
    centres: Option<Vec<Setting>>,
    /// Steps to either side of it.
    beside: usize,
}

impl Window {
    /// All settings of a search, in steps so large that there are at most these numbers along each axis.
    pub fn coarse(search: &PostureSearch, most: [usize; AXES]) -> Window {
        let whole = steps_of(search);
        let strides = std::array::from_fn(|axis| {
            let mut stride = 1;
            while whole[axis].every(stride).count > most[axis] {
                stride *= 2;
            }
            stride
        });
        Window {
            whole,
            strides,
            centres: None,
            beside: BESIDE[0],
        }
    }

    /// All settings of a search.
    pub fn all(search: &PostureSearch) -> Window {
        Window::coarse(search, [usize::MAX; AXES])
    }

    /// All spins of a search, with lean and external axes of this setting.
    pub fn of_spins_at(search: &PostureSearch, setting: &Setting) -> Window {
        let mut window = Window::all(search);
        for axis in 1..AXES {
            window.whole[axis] = Steps::one(setting[axis]);
        }
        window
    }

    /// Half the steps, near this chain.
    pub fn halved(&self, chain: Vec<Setting>) -> Window {
        Window {
            strides: self.strides.map(|stride| stride.div_ceil(2)),
            centres: Some(chain),
            beside: BESIDE[0],
            ..*self
        }
    }

    /// The same steps, farther from the chain.
    pub fn widened(&self) -> Window {
        Window {
            beside: BESIDE[1],
            ..self.clone()
        }
    }

    /// Whether only settings near a chain are tried.
    pub fn is_near_a_chain(&self) -> bool {
        self.centres.is_some()
    }

    /// Whether its steps are the demanded ones.
    pub fn is_finest(&self) -> bool {
        self.strides.iter().all(|stride| *stride == 1)
    }

    /// The step along each axis, rad (m).
    pub fn step(&self, axis: usize) -> f64 {
        self.whole[axis].step * self.strides[axis] as f64
    }

    /// Whether all spins that the search permits are tried, in its own steps, and nothing else.
    pub fn is_of_spins(&self) -> bool {
        self.grid().codes_are_bytes() && self.centres.is_none()
    }

    /// The grid of the settings at a point.
    pub fn grid(&self) -> Grid {
        let counts = std::array::from_fn(|axis| self.tried(axis, 0).count);
        Grid::new(counts, self.centres.is_none() && self.goes_around())
    }

    /// Whether the spins are a full circle.
    fn goes_around(&self) -> bool {
        let spins = self.whole[0].every(self.strides[0]);
        (spins.step * spins.count as f64 - TAU).abs() < ROUNDED
    }

    /// The values that are tried along an axis at point `index`, some of which may be [outside](Window::permits) the
    /// range.
    pub fn tried(&self, axis: usize, index: usize) -> Steps {
        let coarse = self.whole[axis].every(self.strides[axis]);
        match &self.centres {
            Some(centres) if self.whole[axis].count > 1 => Steps {
                first: centres[index][axis] - coarse.step * self.beside as f64,
                step: coarse.step,
                count: 2 * self.beside + 1,
            },
            _ => coarse,
        }
    }

    /// Whether the search permits this value along an axis.
    pub fn permits(&self, axis: usize, value: f64) -> bool {
        let whole = &self.whole[axis];
        let full = axis == 0 && (whole.step * whole.count as f64 - TAU).abs() < ROUNDED;
        full || (value >= whole.first - ROUNDED && value <= whole.last() + ROUNDED)
    }

    /// The setting with these indices at point `index`.
    pub fn setting(&self, indices: [usize; AXES], index: usize) -> Setting {
        std::array::from_fn(|axis| self.tried(axis, index).at(indices[axis]))
    }
}

/// The values along each axis.
fn steps_of(search: &PostureSearch) -> [Steps; AXES] {
    let mut steps = [Steps::one(0.0); AXES];
    steps[0] = search.spins;
    if let Some(lean) = &search.lean {
        steps[1] = lean.leads;
        steps[2] = lean.tilts;
    }
    for (axis, moving) in search.axes.iter().enumerate().take(MOST_MOVING) {
        steps[3 + axis] = moving.positions;
    }
    steps
}
