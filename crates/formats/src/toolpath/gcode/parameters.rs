//! Parameters: numbered, `#5221`, and named, `#<depth>`; those of a subroutine are its own.
//!
//! | numbers | meaning |
//! |---|---|
//! | 1 to 30 | of the subroutine: its arguments |
//! | 31 to 5000 | free |
//! | 5161 to 5166, 5181 to 5186 | places of G28 and G30, machine coordinates |
//! | 5210, 5211 to 5216 | whether G92 is in force, and its offset |
//! | 5220, 5221 to 5386 | active coordinate system; zeros and turns of all nine, 20 apart |
//! | 5400 to 5413, 5420 to 5428 | tool and position, only to be read |
//!
//! Lengths of 5161 to 5386 are in the unit of the machine. Names that begin with `_` belong to all, others to their
//! subroutine.
//!
//! Source: LinuxCNC documentation, G-code overview, section on parameters.

use std::collections::BTreeMap;

use super::refusal::Refusal;

/// The highest number.
pub(super) const LAST: usize = 5602;
/// Parameters of a subroutine.
pub(super) const LOCALS: usize = 30;
/// Only to be read.
pub(super) const READ_ONLY: std::ops::RangeInclusive<usize> = 5400..=5428;
/// Place of G28, and 20 on that of G30.
const HOME: usize = 5161;
/// Whether G92 is in force.
pub(super) const G92_FLAG: usize = 5210;
/// Number of the active coordinate system.
pub(super) const SYSTEM: usize = 5220;
/// How far the numbers of two coordinate systems are apart.
const SYSTEM_STRIDE: usize = 20;

/// More names than this are no program.
const MOST_NAMES: usize = 10_000;

/// Where the place of G28 (or G28.1), or that of G30, begins; codes in tenths.
pub(super) fn home_of(code: u16) -> usize {
    match code {
        280 | 281 => HOME,
        _ => HOME + 20,
    }
}

/// Where the zero of a coordinate system, 1 to 9, begins.
pub(super) fn zero_of(system: u8) -> usize {
    SYSTEM + 1 + SYSTEM_STRIDE * (usize::from(system) - 1)
}

/// Index of the rotation of a coordinate system, 1 to 9.
pub(super) fn turn_of(system: u8) -> usize {
    zero_of(system) + 9
}

/// Parameters of one call of a subroutine.
#[derive(Clone, Debug)]
struct Locals {
    numbered: [f64; LOCALS],
    named: BTreeMap<Vec<u8>, f64>,
}

impl Locals {
    fn new() -> Locals {
        Locals {
            numbered: [0.0; LOCALS],
            named: BTreeMap::new(),
        }
    }
}

/// All parameters of a program.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    numbered: Vec<f64>,
    named: BTreeMap<Vec<u8>, f64>,
    /// Of the subroutines being called, the last innermost.
    calls: Vec<Locals>,
    names: usize,
}

impl Parameters {
    /// All zero, G54 in force, outside of any subroutine.
    pub fn new() -> Parameters {
        let mut numbered = vec![0.0; LAST + 1];
        numbered[SYSTEM] = 1.0;
        Parameters {
            numbered,
            named: BTreeMap::new(),
            calls: vec![Locals::new()],
            names: 0,
        }
    }

    /// Those of the innermost call, or of the program.
    fn locals(&self) -> Option<&Locals> {
        self.calls.last()
    }

    /// The number of a parameter.
    ///
    /// # Errors
    /// A number that is not whole within 1e-4, or not from 1 to 5602.
    pub fn index(number: f64) -> Result<usize, Refusal> {
        let index = number.round();
        // As far as rounding of a computed number goes.
        if (number - index).abs() > 1e-4 || !(1.0..=LAST as f64).contains(&index) {
            return Err(Refusal::ParameterOutOfRange(number, LAST));
        }
        Ok(index as usize)
    }

    /// The value of a parameter; zero where it was never set.
    pub fn numbered(&self, index: usize) -> f64 {
        match (index, self.locals()) {
            (1..=LOCALS, Some(locals)) => locals.numbered[index - 1],
            _ => self.numbered.get(index).copied().unwrap_or_default(),
        }
    }

    pub fn set_numbered(&mut self, index: usize, value: f64) {
        if let (1..=LOCALS, Some(locals)) = (index, self.calls.last_mut()) {
            locals.numbered[index - 1] = value;
        } else if let Some(place) = self.numbered.get_mut(index) {
            *place = value;
        }
    }

    /// The value of a name; `None` where it was never set.
    pub fn named(&self, name: &[u8]) -> Option<f64> {
        match name.first() {
            Some(b'_') => self.named.get(name).copied(),
            _ => self.locals().and_then(|locals| locals.named.get(name).copied()),
        }
    }

    pub fn set_named(&mut self, name: &[u8], value: f64) -> Result<(), Refusal> {
        let names = match (name.first(), self.calls.last_mut()) {
            (Some(b'_'), _) | (_, None) => &mut self.named,
            (_, Some(locals)) => &mut locals.named,
        };
        if let Some(place) = names.get_mut(name) {
            *place = value;
            return Ok(());
        }
        if self.names >= MOST_NAMES {
            return Err(Refusal::TooManyNames { limit: MOST_NAMES });
        }
        self.names += 1;
        names.insert(name.to_vec(), value);
        Ok(())
    }

    /// Enters a subroutine with its arguments.
    pub fn enter(&mut self, arguments: &[f64]) {
        let mut locals = Locals::new();
        for (place, argument) in locals.numbered.iter_mut().zip(arguments) {
            *place = *argument;
        }
        self.calls.push(locals);
    }

    /// Leaves it again.
    pub fn leave(&mut self) {
        if self.calls.len() > 1 {
            let left = self.calls.pop();
            self.names -= left.map_or(0, |locals| locals.named.len());
        }
    }
}
