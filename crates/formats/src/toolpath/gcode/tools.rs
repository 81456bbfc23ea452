//! The tool table: a line for each tool, `T1 P1 Z0.5 D0.25 ;remark`.
//!
//! | word | meaning |
//! |---|---|
//! | `T` | number of the tool |
//! | `P` | its pocket, not used |
//! | `X Y Z A B C` | offset of its tip, in the unit of the machine, deg |
//! | `D` | its diameter, in the unit of the machine |
//! | `I J Q` | front angle, back angle and orientation of a turning tool |
//!
//! Source: LinuxCNC user manual, tool table format.

use std::collections::BTreeMap;

use super::canonical::Axes;
use crate::document::Problems;
use crate::document::lines::Lines;
use crate::toolpath::LengthUnit;
use crate::toolpath::direction::LARGEST;

/// A tool of the tool table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tool {
    /// Offset of its tip, in the unit of the table, deg.
    pub offset: Axes,
    /// In the unit of the table.
    pub diameter: f64,
    /// 1 to 9 for a turning tool, 0 for a mill.
    pub orientation: u8,
}

/// Tools by their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolTable {
    /// What its lengths are counted in: the unit of the machine.
    pub unit: LengthUnit,
    /// By number.
    pub tools: BTreeMap<u32, Tool>,
}

/// Longest table that is read, lines: no magazine comes near.
const MOST_TOOLS: usize = 10_000;

impl ToolTable {
    /// The table in this text; `path` is what problems show.
    ///
    /// Of two lines with one number the last counts; empty lines and remarks (`;`) are ignored.
    ///
    /// # Errors
    /// A line without `T`, an unknown word, an invalid number, more than 10000 tools.
    pub fn read(path: &str, text: &str, unit: LengthUnit) -> Result<ToolTable, Problems> {
        let mut lines = Lines::new(path, text.as_bytes());
        let mut table = ToolTable {
            unit,
            ..ToolTable::default()
        };
        let mut problems = Vec::new();
        while let Some(line) = lines.next()? {
            let words = line.text.split(';').next().unwrap_or_default();
            if words.trim().is_empty() {
                continue;
            }
            match tool(words) {
                Ok((number, tool)) => {
                    table.tools.insert(number, tool);
                }
                Err((place, message)) => {
                    let hint = "a line of a tool table is like `T1 P1 Z0.5 D0.25`";
                    problems.push(line.problem(path, place, message, hint));
                }
            }
            if table.tools.len() > MOST_TOOLS || problems.len() > MOST_TOOLS {
                let message = format!("more than {MOST_TOOLS} tools");
                let hint = "a tool table has one line for each place of the magazine";
                problems.push(line.problem(path, 0..line.text.len(), message, hint));
                break;
            }
        }
        Problems::from(problems).into_result()?;
        Ok(table)
    }
}

/// Bytes of the line, and what is wrong with them.
type Misread = (std::ops::Range<usize>, String);

/// Number and tool of a line; pocket, angles and axes U, V, W are ignored.
fn tool(line: &str) -> Result<(u32, Tool), Misread> {
    let mut number = None;
    let mut tool = Tool::default();
    for word in line.split_whitespace() {
        let start = word.as_ptr() as usize - line.as_ptr() as usize;
        let place = start..start + word.len();
        let Some(letter) = word.chars().next() else {
            continue;
        };
        let value = word
            .get(letter.len_utf8()..)
            .and_then(|digits| digits.parse::<f64>().ok())
            .filter(|value| value.abs() <= LARGEST);
        let Some(value) = value else {
            return Err((place, format!("`{word}` is not a word of a tool table")));
        };
        match letter.to_ascii_uppercase() {
            'T' if value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0 => {
                number = Some(value as u32);
            }
            'X' => tool.offset[0] = value,
            'Y' => tool.offset[1] = value,
            'Z' => tool.offset[2] = value,
            'A' => tool.offset[3] = value,
            'B' => tool.offset[4] = value,
            'C' => tool.offset[5] = value,
            'D' => tool.diameter = value,
            'Q' if (0.0..=9.0).contains(&value) => tool.orientation = value as u8,
            'P' | 'I' | 'J' | 'U' | 'V' | 'W' => {}
            _ => return Err((place, format!("`{word}` is not a word of a tool table"))),
        }
    }
    match number {
        Some(number) => Ok((number, tool)),
        None => Err((0..line.trim_end().len(), "a tool without its number".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_tool() {
        let table = ToolTable::read(
            "t.tbl",
            "T1 P1 Z0.5 D0.25;first\r\rt32 x-1 Q2\n",
            LengthUnit::Inch,
        )
        .unwrap();
        assert_eq!(table.tools[&1].offset[2], 0.5);
        assert_eq!(table.tools[&1].diameter, 0.25);
        assert_eq!(table.tools[&32].offset[0], -1.0);
        assert_eq!(table.tools[&32].orientation, 2);
    }

    #[test]
    fn all_problems_are_reported_with_their_positions() {
        let problems = ToolTable::read("t.tbl", "P1 Z2\nT1 Dx\nT2 !5\n", LengthUnit::Inch).unwrap_err();
        let lines: Vec<String> = problems.as_slice().iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "t.tbl:1:1: a tool without its number",
                "t.tbl:2:4: `Dx` is not a word of a tool table",
                "t.tbl:3:4: `!5` is not a word of a tool table",
            ]
        );
    }
}
