//! A joint log, and how it is read.

use armill_core::units::to_ms;

use super::unit::{AngleUnit, TimeUnit};

/// A step of time above this number of usual steps is a gap.
const GAP: f64 = 5.0;
/// What a log has to contain.
pub(super) const HINT: &str =
    "use one row per instant, such as `time_s,J1_deg,J2_deg,J3_deg,J4_deg,J5_deg,J6_deg`";

/// Units for columns whose names give none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LogReadOptions {
    /// Unit of the time.
    pub time: Option<TimeUnit>,
    /// Unit of the positions.
    pub angle: Option<AngleUnit>,
}

/// Joint positions over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointLog {
    /// Number of joints.
    pub joints: usize,
    /// s, rising.
    pub times: Vec<f64>,
    /// Actual positions, rad, instant after instant; the commanded ones in a log without actual ones.
    pub positions: Vec<f64>,
    /// Commanded positions, rad, instant after instant, of a log that has both.
    pub commanded: Option<Vec<f64>>,
    /// Positions of the link encoders, rad, instant after instant, of a log that has them.
    pub link: Option<Vec<f64>>,
    /// Torques of the motors, N m, instant after instant, of a log that has them.
    pub torque: Option<Vec<f64>>,
    /// Number of the move at each instant.
    pub moves: Option<Vec<i64>>,
    /// Line of each instant, from 1.
    pub lines: Vec<usize>,
    /// Ignored columns.
    pub unused: Vec<String>,
    /// What to know of the log: units that were concluded, repeated times, gaps.
    pub notes: Vec<String>,
}

impl JointLog {
    /// Actual positions at an instant, rad.
    pub fn at(&self, index: usize) -> &[f64] {
        &self.positions[index * self.joints..][..self.joints]
    }

    /// Usual step of time, s: the median; 0 of a log of one instant.
    pub fn usual_step(&self) -> f64 {
        let mut steps: Vec<f64> = self.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }

    /// Notes the gaps.
    pub(super) fn note_gaps(&mut self) {
        let usual = self.usual_step();
        let steps = self.times.windows(2).map(|pair| pair[1] - pair[0]);
        let gaps: Vec<(usize, f64)> = steps
            .enumerate()
            .filter(|(_, step)| *step > GAP * usual)
            .collect();
        let Some((at, longest)) = gaps.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return;
        };
        self.notes.push(format!(
            "{} of more than {GAP} usual steps of {:.2} ms without an instant, the longest of {:.1} ms before line {}",
            if gaps.len() == 1 { "1 gap".to_owned() } else { format!("{} gaps", gaps.len()) },
            to_ms(usual),
            to_ms(longest),
            self.lines[at + 1]
        ));
    }
}
