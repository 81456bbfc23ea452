//! Where the labels of M98 stand in the lines that were read ahead.

use std::collections::BTreeMap;

/// Positions of labels of M98 in lines that were read ahead: no line is searched twice.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// Lines of each, in order.
    lines: BTreeMap<String, Vec<u32>>,
    /// The last line that was looked at.
    seen: u32,
}

impl Labels {
    /// How many of the lines from `next` on were looked at.
    pub fn unseen(&self, next: u32) -> usize {
        (self.seen + 1).saturating_sub(next) as usize
    }

    /// Takes note that this line was looked at, and of its label if it has one.
    pub fn see(&mut self, line: u32, label: Option<String>) {
        if let Some(label) = label {
            self.lines.entry(label).or_default().push(line);
        }
        self.seen = line;
    }

    /// The first line from `next` on that has this label.
    pub fn first(&self, label: &str, next: u32) -> Option<u32> {
        self.lines.get(label)?.iter().copied().find(|line| *line >= next)
    }
}
