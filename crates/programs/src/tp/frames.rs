//! Frames and tools in a program: registers that are set number by number and then assigned to a frame.

use std::collections::BTreeMap;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use super::position::Position;
use super::statement::index;
use crate::program::{Frame, FrameKind};
use crate::spelling::number;

/// Their names, also in German listings.
const NAMES: [(FrameKind, &str); 4] = [
    (FrameKind::Reference, "UFRAME"),
    (FrameKind::Tool, "UTOOL"),
    (FrameKind::Reference, "BENUTZER"),
    (FrameKind::Tool, "WKZ"),
];

/// Registers, known frames and tools, and the selected ones.
#[derive(Debug, Default)]
pub(super) struct Frames {
    registers: BTreeMap<u32, [Option<f64>; 6]>,
    known: [BTreeMap<u32, Isometry>; 2],
    chosen: [Option<u32>; 2],
}

impl Frames {
    /// Evaluates an assignment, `PR[9,1]=1.5` or `UFRAME_NUM=2`. Returns whether it was one of these.
    pub fn assign(&mut self, said: &str, positions: &BTreeMap<u32, Position>) -> bool {
        let Some((left, right)) = said.split_once('=') else {
            return false;
        };
        let (left, right) = (left.trim(), right.trim());
        for (kind, name) in NAMES {
            if let Some((at, "")) = index(left, name) {
                let pose = single(right, "PR").and_then(|register| self.pose(register));
                match (single_index(&at), pose) {
                    (Some(at), Some(pose)) => {
                        self.known[kind as usize].insert(at, pose);
                    }
                    (Some(at), None) => {
                        self.known[kind as usize].remove(&at);
                    }
                    // The index is not known.
                    (None, _) => self.known[kind as usize].clear(),
                }
                return true;
            }
            let begin = left.get(..name.len()).unwrap_or_default();
            let behind = left.get(name.len()..).unwrap_or_default().trim_start_matches('[');
            if begin.eq_ignore_ascii_case(name)
                && behind
                    .get(..4)
                    .is_some_and(|word| word.eq_ignore_ascii_case("_NUM"))
            {
                self.chosen[kind as usize] = right.parse().ok();
                return true;
            }
        }
        let Some((at, "")) = index(left, "PR") else {
            return false;
        };
        match at.as_slice() {
            [register, element] => self.set_element([register, element], right),
            [register] => match register.parse::<u32>() {
                Ok(register) => {
                    let copied = single(right, "PR").and_then(|other| self.registers.get(&other).copied());
                    let taught = single(right, "P").and_then(|other| positions.get(&other)?.values);
                    let values = copied.or_else(|| taught.map(|values| values.map(Some)));
                    self.registers.insert(register, values.unwrap_or_default());
                }
                Err(_) => self.registers.clear(),
            },
            _ => {}
        }
        true
    }

    fn set_element(&mut self, [register, element]: [&str; 2], right: &str) {
        let Ok(register) = register.parse::<u32>() else {
            // Any of them may have been set.
            self.registers.clear();
            return;
        };
        let values = self.registers.entry(register).or_default();
        match element.parse::<usize>() {
            Ok(element) => {
                if let Some(value) = element.checked_sub(1).and_then(|at| values.get_mut(at)) {
                    let plain = right.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
                    *value = number(plain.unwrap_or(right));
                }
            }
            Err(_) => *values = [None; 6],
        }
    }

    fn pose(&self, register: u32) -> Option<Isometry> {
        let values = self.registers.get(&register)?;
        let values: Option<Vec<f64>> = values.iter().copied().collect();
        Convention::Fanuc.pose(&values?).ok()
    }

    /// Number of the selected frame or tool.
    pub fn chosen(&self, kind: FrameKind) -> Option<u32> {
        self.chosen[kind as usize]
    }

    /// The frame or tool with this number; the selected one if the position has no number.
    pub fn get(&self, kind: FrameKind, own: Option<u32>) -> Frame {
        match own.or(self.chosen(kind)) {
            None => Frame::Unknown,
            Some(0) => Frame::Given(Isometry::identity()),
            Some(number) => self.known[kind as usize]
                .get(&number)
                .map_or(Frame::Numbered(number), |pose| Frame::Given(*pose)),
        }
    }
}

/// The number in `NAME[number]` with nothing after it.
fn single(said: &str, name: &str) -> Option<u32> {
    let (at, behind) = index(said, name)?;
    behind.is_empty().then(|| single_index(&at)).flatten()
}

fn single_index(at: &[&str]) -> Option<u32> {
    match at {
        [one] => one.parse().ok(),
        _ => None,
    }
}
