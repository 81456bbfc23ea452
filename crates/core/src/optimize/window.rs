//! The settings that a search tries at each point of a path: all of them, or those near a chain found before.
//!
//! With spin, lean and external axes together all settings would be too many: 72 spins, 9 leads, 9 tilts and 30 positions
//! of a rail are 175 000, with eight postures each. A first search therefore uses large steps at a part of the points;
//! each further search uses half the steps, within two of them of the chain before, until the steps are those demanded.
//! Its chain is the best near that of the search before, not of all settings.

use std::f64::consts::TAU;

use super::freedoms::MOST_MOVING;
use super::grid::{AXES, Grid, Shift, UNSHIFTED};
use super::posture_search::PostureSearch;
use super::steps::Steps;

/// Steps to either side of the chain before, first, and where that leads nowhere.
const HALF_WIDTHS: [usize; 2] = [2, 4];
/// Rounding of a full circle, rad.
const ROUNDED: f64 = 1e-9;

/// A setting: spin, lead and tilt (rad), positions of external axes (m, rad).
pub(super) type Setting = [f64; AXES];

/// The settings tried at each point: a part of the lattice of all settings, which are multiples of a step.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// All that the search permits, in the demanded steps.
    whole: [Steps; AXES],
    /// How many demanded steps a step of this window is.
    strides: [usize; AXES],
    /// Index of the first value along each axis at every point of the path; `None`: all settings.
    firsts: Option<Vec<Shift>>,
    /// Steps to either side of the chain before.
    half_width: usize,
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
            firsts: None,
            half_width: HALF_WIDTHS[0],
        }
    }

    /// All settings of a search.
    pub fn all(search: &PostureSearch) -> Window {
        Window::coarse(search, [usize::MAX; AXES])
    }

    /// All spins of a search, with lean and external axes of this setting.
    pub fn of_spins_at(search: &PostureSearch, setting: &Setting) -> Window {
        let mut window = Window::all(search);
        let others = window.whole.iter_mut().zip(setting).skip(1);
        others.for_each(|(steps, value)| *steps = Steps::one(*value));
        window
    }

    /// Half the steps, near this chain: its setting at every point of the path.
    pub fn halved(&self, chain: &[Setting]) -> Window {
        Window {
            strides: self.strides.map(|stride| stride.div_ceil(2)),
            half_width: HALF_WIDTHS[0],
            ..self.clone()
        }
        .near(chain)
    }

    /// The same steps, farther from the chain.
    pub fn widened(&self, chain: &[Setting]) -> Window {
        Window {
            half_width: HALF_WIDTHS[1],
            ..self.clone()
        }
        .near(chain)
    }

    fn near(self, chain: &[Setting]) -> Window {
        let first = |axis: usize, value: f64| {
            let steps = self.steps(axis);
            let width = steps.count.min(2 * self.half_width + 1);
            if width == steps.count {
                return 0;
            }
            let first = ((value - steps.first) / steps.step).round() as isize - self.half_width as isize;
            match axis == 0 && self.goes_around() {
                true => first,
                false => first.clamp(0, (steps.count - width) as isize),
            }
        };
        let firsts = chain
            .iter()
            .map(|setting| std::array::from_fn(|axis| first(axis, setting[axis])));
        Window {
            firsts: Some(firsts.collect()),
            ..self
        }
    }

    /// Whether only settings near a chain are tried.
    pub fn is_near_a_chain(&self) -> bool {
        self.firsts.is_some()
    }

    /// Whether its steps are the demanded ones.
    pub fn is_finest(&self) -> bool {
        self.strides.iter().all(|stride| *stride == 1)
    }

    /// The step along each axis, rad (m).
    pub fn step(&self, axis: usize) -> f64 {
        self.steps(axis).step
    }

    /// Whether all spins that the search permits are tried, in its own steps, and nothing else.
    pub fn is_of_spins(&self) -> bool {
        self.grid().codes_are_bytes() && self.firsts.is_none()
    }

    /// The grid of the settings at a point.
    pub fn grid(&self) -> Grid {
        let counts = std::array::from_fn(|axis| self.width(axis));
        Grid::new(counts, self.width(0) == self.steps(0).count && self.goes_around())
    }

    /// The shift of the settings at point `to` from those at point `from`, an earlier one.
    pub fn shift(&self, from: usize, to: usize) -> Shift {
        match &self.firsts {
            Some(firsts) => std::array::from_fn(|axis| firsts[to][axis] - firsts[from][axis]),
            None => UNSHIFTED,
        }
    }

    /// All values along an axis, in the steps of this window.
    fn steps(&self, axis: usize) -> Steps {
        self.whole[axis].every(self.strides[axis])
    }

    /// Number of values that are tried along an axis.
    fn width(&self, axis: usize) -> usize {
        let count = self.steps(axis).count;
        match self.firsts {
            Some(_) => count.min(2 * self.half_width + 1),
            None => count,
        }
    }

    /// Whether the spins are a full circle.
    fn goes_around(&self) -> bool {
        let spins = self.steps(0);
        (spins.step * spins.count as f64 - TAU).abs() < ROUNDED
    }

    /// The values that are tried along an axis at point `index`.
    pub fn tried(&self, axis: usize, index: usize) -> Steps {
        let steps = self.steps(axis);
        let first = self.firsts.as_ref().map_or(0, |firsts| firsts[index][axis]);
        Steps {
            first: steps.first + steps.step * first as f64,
            count: self.width(axis),
            ..steps
        }
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
