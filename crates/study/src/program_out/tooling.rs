//! Tool, spindle and coolant in a program: statements of the cell, otherwise a stop with a message, or a comment.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use armill_core::path::{Command, Operation, PlacedCommand, SampledPath};
use armill_core::units::to_mm;
use armill_formats::controller::ControllerTable;
use armill_programs::DraftStep;

/// What happens between two cuts.
#[derive(Clone, Debug, Default)]
pub(super) struct Change {
    /// At the end of the cut, before the tool retracts.
    pub at_cut: Vec<DraftStep>,
    /// Above the part.
    pub above: Vec<DraftStep>,
    /// Whether the tool is changed, at the home position if there is one.
    pub changes_tool: bool,
}

/// The state of tool, spindle and coolant while a program is written.
pub(super) struct Tooling<'a> {
    table: &'a ControllerTable,
    /// Speed of the spindle if the program gives none, rad/s.
    usual_spindle: Option<f64>,
    program: String,
    /// Tool number and diameter.
    tool: Option<(Option<u32>, Option<f64>)>,
    spindle: f64,
    is_coolant_on: bool,
    next_operation: usize,
    next_command: usize,
    notes: BTreeSet<&'static str>,
}

/// Speeds of the spindle that differ by less are the same, rad/s.
const SAME_SPEED: f64 = 1e-6;

const NO_SPINDLE: &str = "no spindle speed is given: the program does not start the spindle";
const STOPS_FOR_SPINDLE: &str = "the program stops for the operator to start the spindle; `spindle_on` of [controller] \
                                 has statements instead";
const STOPS_FOR_TOOL: &str = "the program stops for the operator to change the tool; `tool_change` of [controller] has \
                              statements instead";
const ONE_TCP: &str = "all tools of the program are written with the tool of the study: if their lengths differ, write \
                       one program for each tool";
const COOLANT: &str = "coolant is only a comment in the program: `coolant_on` and `coolant_off` of [controller] have \
                       statements instead";

impl<'a> Tooling<'a> {
    pub fn new(table: &'a ControllerTable, usual_spindle: Option<f64>, program: &str) -> Tooling<'a> {
        Tooling {
            table,
            usual_spindle,
            program: program.to_owned(),
            tool: None,
            spindle: 0.0,
            is_coolant_on: false,
            next_operation: 0,
            next_command: 0,
            notes: BTreeSet::new(),
        }
    }

    /// What must be known of the program, one sentence each.
    pub fn notes(&self) -> impl Iterator<Item = String> + '_ {
        self.notes.iter().map(|note| (*note).to_owned())
    }

    /// What happens between the cut that ends at point `before` and the one that starts at point `start`.
    pub fn at(&mut self, path: &SampledPath, before: Option<usize>, start: usize) -> Change {
        let mut change = Change::default();
        // A command directly after a cut belongs to its end: a dwell at the bottom of a hole.
        let (at_cut, above): (Vec<_>, Vec<_>) = self
            .commands_to(path, start)
            .into_iter()
            .partition(|placed| before.is_some() && placed.rapids == 0);
        change.at_cut = at_cut
            .into_iter()
            .flat_map(|placed| self.command(placed.command))
            .collect();
        // Of several operations without a cut only the last one is in effect.
        let last = self.operations_to(path, start).pop();
        let none = self.tool.is_none().then_some(NO_OPERATION);
        if let Some(operation) = last.or(none) {
            let (steps, changes_tool) = self.operation(&operation);
            change.above = steps;
            change.changes_tool = changes_tool;
        }
        let above = above.into_iter().flat_map(|placed| self.command(placed.command));
        change.above.extend(above);
        change
    }

    /// What happens inside a cut before point `index`.
    pub fn inside(&mut self, path: &SampledPath, index: usize) -> Vec<DraftStep> {
        let mut steps = Vec::new();
        for operation in self.operations_to(path, index) {
            steps.extend(self.operation(&operation).0);
        }
        for placed in self.commands_to(path, index) {
            steps.extend(self.command(placed.command));
        }
        steps
    }

    /// What happens after the last cut.
    pub fn at_end(&mut self, path: &SampledPath) -> Change {
        let mut change = Change::default();
        for placed in self.commands_to(path, usize::MAX) {
            let steps = self.command(placed.command);
            match placed.rapids {
                0 => change.at_cut.extend(steps),
                _ => change.above.extend(steps),
            }
        }
        change.above.extend(self.stop_spindle());
        if self.is_coolant_on {
            change.above.extend(self.command(Command::Coolant(false)));
        }
        change
    }

    /// The operations up to the one that begins at point `index`.
    fn operations_to(&mut self, path: &SampledPath, index: usize) -> Vec<Operation> {
        let rest = path.operations.iter().skip(self.next_operation);
        let begun: Vec<Operation> = rest
            .take_while(|(first, _)| *first <= index)
            .map(|(_, operation)| operation.clone())
            .collect();
        self.next_operation += begun.len();
        begun
    }

    /// The commands up to point `index`.
    fn commands_to(&mut self, path: &SampledPath, index: usize) -> Vec<PlacedCommand> {
        let rest = path.commands.iter().skip(self.next_command);
        let due: Vec<PlacedCommand> = rest
            .take_while(|placed| placed.points <= index)
            .copied()
            .collect();
        self.next_command += due.len();
        due
    }

    /// The statements that begin an operation, and whether the tool changes.
    fn operation(&mut self, operation: &Operation) -> (Vec<DraftStep>, bool) {
        let spindle = operation.spindle.or(self.usual_spindle).unwrap_or(0.0);
        let tool = (operation.tool, operation.diameter);
        let is_first = self.tool.is_none();
        let differs = self.tool.is_some_and(|before| is_other(before, tool));
        let has_statements = self.table.tool_change.is_some();
        let changes_tool = differs || (is_first && has_statements && tool.0.is_some());
        let mut steps = Vec::new();
        if changes_tool && !is_first {
            steps.extend(self.stop_spindle());
            if self.is_coolant_on {
                steps.extend(self.command(Command::Coolant(false)));
            }
        }
        if operation.line > 0 || operation.name.is_some() {
            steps.push(DraftStep::Comment(described(operation, spindle)));
        }
        self.tool = Some(tool);
        let mut message = Vec::new();
        if changes_tool {
            if differs {
                self.notes.insert(ONE_TCP);
            }
            match &self.table.tool_change {
                Some(lines) => steps.extend(self.statements(lines, operation, spindle)),
                None => {
                    self.notes.insert(STOPS_FOR_TOOL);
                    message.push(format!("Fit {}", tool_words(operation)));
                }
            }
        }
        self.start_spindle(spindle, operation, &mut steps, &mut message);
        if !message.is_empty() {
            steps.push(DraftStep::Stop(format!("{}, then continue", message.join(", "))));
        }
        (steps, changes_tool)
    }

    /// Starts the spindle, or changes its speed; what the operator must do is added to `message`.
    fn start_spindle(
        &mut self,
        spindle: f64,
        operation: &Operation,
        steps: &mut Vec<DraftStep>,
        message: &mut Vec<String>,
    ) {
        if spindle == 0.0 {
            if self.spindle == 0.0 && operation.spindle.is_none() {
                self.notes.insert(NO_SPINDLE);
            }
            steps.extend(self.stop_spindle());
            return;
        }
        if (spindle - self.spindle).abs() < SAME_SPEED {
            return;
        }
        self.spindle = spindle;
        let lines = match spindle > 0.0 {
            true => &self.table.spindle_on,
            false => &self.table.spindle_on_counter_clockwise,
        };
        match lines {
            Some(lines) => steps.extend(self.statements(lines, operation, spindle)),
            None => {
                self.notes.insert(STOPS_FOR_SPINDLE);
                message.push(format!("start the spindle: {}", spindle_words(spindle)));
            }
        }
    }

    fn stop_spindle(&mut self) -> Vec<DraftStep> {
        if self.spindle == 0.0 {
            return Vec::new();
        }
        self.spindle = 0.0;
        match &self.table.spindle_off {
            Some(lines) => lines.iter().cloned().map(DraftStep::Statement).collect(),
            None => vec![DraftStep::Stop("Stop the spindle, then continue".to_owned())],
        }
    }

    fn command(&mut self, command: Command) -> Vec<DraftStep> {
        match command {
            Command::Dwell(seconds) => vec![DraftStep::Dwell(seconds)],
            Command::Stop => vec![DraftStep::Stop(format!("Stop of the program {}", self.program))],
            Command::Coolant(on) if on == self.is_coolant_on => Vec::new(),
            Command::Coolant(on) => {
                self.is_coolant_on = on;
                let lines = match on {
                    true => &self.table.coolant_on,
                    false => &self.table.coolant_off,
                };
                match lines {
                    Some(lines) => lines.iter().cloned().map(DraftStep::Statement).collect(),
                    None => {
                        self.notes.insert(COOLANT);
                        vec![DraftStep::Comment(format!(
                            "coolant {}",
                            if on { "on" } else { "off" }
                        ))]
                    }
                }
            }
        }
    }

    /// Statements of the cell with the values of their placeholders.
    fn statements(&self, lines: &[String], operation: &Operation, spindle: f64) -> Vec<DraftStep> {
        let tool = operation.tool.unwrap_or_default().to_string();
        let diameter = format!("{:.3}", to_mm(operation.diameter.unwrap_or_default()));
        let name: String = operation
            .name
            .iter()
            .flat_map(|name| name.chars())
            .map(|c| {
                if c.is_ascii_alphanumeric() || c == '_' {
                    c
                } else {
                    '_'
                }
            })
            .collect();
        let rpm = format!("{:.0}", rpm(spindle));
        let with_values = |line: &String| {
            line.replace("{tool}", &tool)
                .replace("{diameter_mm}", &diameter)
                .replace("{operation}", &name)
                .replace("{rpm}", &rpm)
        };
        lines
            .iter()
            .map(|line| DraftStep::Statement(with_values(line)))
            .collect()
    }
}

/// A path without operations.
const NO_OPERATION: Operation = Operation {
    name: None,
    tool: None,
    diameter: None,
    corner_radius: None,
    spindle: None,
    depths: None,
    line: 0,
};

/// Whether two operations have different tools: other numbers, or other diameters.
fn is_other(before: (Option<u32>, Option<f64>), now: (Option<u32>, Option<f64>)) -> bool {
    let numbers = before.0.zip(now.0).is_some_and(|(a, b)| a != b);
    let diameters = before
        .1
        .zip(now.1)
        .is_some_and(|(a, b)| (a - b).abs() > SAME_DIAMETER);
    numbers || diameters
}

/// Diameters that differ by less are the same, m.
const SAME_DIAMETER: f64 = 1e-6;

fn rpm(spindle: f64) -> f64 {
    spindle.abs() * 60.0 / TAU
}

fn spindle_words(spindle: f64) -> String {
    let sense = if spindle > 0.0 {
        "clockwise"
    } else {
        "counter-clockwise"
    };
    format!("{:.0} rpm {sense}", rpm(spindle))
}

fn tool_words(operation: &Operation) -> String {
    let number = operation
        .tool
        .map_or_else(|| "the tool".to_owned(), |number| format!("tool {number}"));
    let diameter = operation
        .diameter
        .map(|diameter| format!(" of {:.3} mm", to_mm(diameter)));
    let name = operation.name.as_ref().map(|name| format!(" ({name})"));
    format!(
        "{number}{}{}",
        diameter.unwrap_or_default(),
        name.unwrap_or_default()
    )
}

fn described(operation: &Operation, spindle: f64) -> String {
    let spindle = match spindle == 0.0 {
        true => String::new(),
        false => format!(", {}", spindle_words(spindle)),
    };
    format!("line {}: {}{spindle}", operation.line, tool_words(operation))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn operation(tool: u32, rpm: f64) -> Operation {
        Operation {
            tool: Some(tool),
            diameter: Some(0.006 * f64::from(tool)),
            spindle: Some(rpm * TAU / 60.0),
            line: 7,
            ..Operation::default()
        }
    }

    /// Two tools, coolant, a dwell at the end of the first cut of ten points.
    fn path() -> SampledPath {
        let placed = |points, rapids, command| PlacedCommand {
            points,
            rapids,
            command,
        };
        SampledPath {
            operations: vec![(0, operation(1, 12000.0)), (10, operation(2, 3000.0))],
            commands: vec![
                placed(0, 1, Command::Coolant(true)),
                placed(10, 0, Command::Dwell(0.5)),
                placed(10, 2, Command::Coolant(false)),
                placed(10, 2, Command::Coolant(true)),
            ],
            ..SampledPath::default()
        }
    }

    fn words(steps: &[DraftStep]) -> Vec<String> {
        let word = |step: &DraftStep| match step {
            DraftStep::Comment(text) => format!("; {text}"),
            DraftStep::Stop(text) => format!("STOP {text}"),
            DraftStep::Dwell(seconds) => format!("DWELL {seconds}"),
            DraftStep::Statement(text) => text.clone(),
            DraftStep::Move(_) => "MOVE".to_owned(),
        };
        steps.iter().map(word).collect()
    }

    #[test]
    fn without_statements_of_the_cell_the_program_stops_with_messages() {
        let (table, path) = (ControllerTable::default(), path());
        let mut tooling = Tooling::new(&table, None, "PART");
        let first = tooling.at(&path, None, 0);
        assert!(!first.changes_tool && first.at_cut.is_empty());
        assert_eq!(
            words(&first.above),
            [
                "; line 7: tool 1 of 6.000 mm, 12000 rpm clockwise",
                "STOP start the spindle: 12000 rpm clockwise, then continue",
                "; coolant on",
            ]
        );
        let second = tooling.at(&path, Some(9), 10);
        assert!(second.changes_tool);
        assert_eq!(words(&second.at_cut), ["DWELL 0.5"]);
        assert_eq!(
            words(&second.above),
            [
                "STOP Stop the spindle, then continue",
                "; coolant off",
                "; line 7: tool 2 of 12.000 mm, 3000 rpm clockwise",
                "STOP Fit tool 2 of 12.000 mm, start the spindle: 3000 rpm clockwise, then continue",
                "; coolant on",
            ]
        );
        let end = tooling.at_end(&path);
        assert_eq!(
            words(&end.above),
            ["STOP Stop the spindle, then continue", "; coolant off"]
        );
        assert_eq!(tooling.notes().count(), 4);
    }

    #[test]
    fn statements_of_the_cell_have_the_values_of_their_placeholders() {
        let lines = |lines: &[&str]| Some(lines.iter().map(|line| (*line).to_owned()).collect());
        let table = ControllerTable {
            tool_change: lines(&["TOOL({tool}, {diameter_mm})"]),
            spindle_on: lines(&["S={rpm}", "ON"]),
            spindle_off: lines(&["OFF"]),
            coolant_on: lines(&["C1"]),
            coolant_off: lines(&["C0"]),
            ..ControllerTable::default()
        };
        let path = path();
        let mut tooling = Tooling::new(&table, None, "PART");
        let first = words(&tooling.at(&path, None, 0).above);
        assert_eq!(first[1..], ["TOOL(1, 6.000)", "S=12000", "ON", "C1"]);
        let second = tooling.at(&path, Some(9), 10);
        let second = words(&second.above);
        assert_eq!(second[..2], ["OFF", "C0"]);
        assert_eq!(second[3..], ["TOOL(2, 12.000)", "S=3000", "ON", "C1"]);
        assert_eq!(words(&tooling.at_end(&path).above), ["OFF", "C0"]);
    }

    #[test]
    fn a_path_without_spindle_speed_says_so_and_one_of_the_cut_starts_it() {
        let (table, path) = (ControllerTable::default(), SampledPath::default());
        let mut tooling = Tooling::new(&table, None, "PART");
        assert!(tooling.at(&path, None, 0).above.is_empty());
        assert_eq!(tooling.notes().collect::<Vec<_>>(), [NO_SPINDLE]);
        let mut tooling = Tooling::new(&table, Some(100.0 * TAU), "PART");
        let first = words(&tooling.at(&path, None, 0).above);
        assert_eq!(
            first,
            ["STOP start the spindle: 6000 rpm clockwise, then continue"]
        );
    }
}
