//! Canonical calls as steps of a path: one frame, m, m/s, rad/s.
//!
//! `q = Rz(-turn0) (m - g5x0) - g92_0`, `m = g5x + Rz(turn) (p + g92)`: the frame of the path is the work coordinate
//! system of the first cut, and later systems are brought into it. The length of the tool has no part in it: `p` is
//! the tip.
//!
//! | symbol | meaning |
//! |---|---|
//! | `p`, `q` | tip in the coordinates of the program and of the path, m |
//! | `m` | the same in machine coordinates, but for the length of the tool, m |
//! | `g5x0`, `turn0`, `g92_0` | offsets in force at the first cut |

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use armill_core::nalgebra::{Point3, Rotation3, Unit, Vector2, Vector3};
use armill_core::path::{Arc, Command, Course, Move, Operation, Pace, Step};
use armill_core::units::from_deg;

use super::canonical::{ArcFeed, Axes, Canonical};
use super::contour::sweep;
use super::parameters;
use super::read_options::{GcodeReadOptions, Warning};
use super::refusal::Refusal;
use super::rotaries::{Rotaries, Rotary};
use crate::toolpath::LengthUnit;
use crate::toolpath::notes::Notes;

/// Rotary axes closer to zero than this, deg, are at zero.
const AT_ZERO: f64 = 1e-9;
/// Work coordinate systems by number.
const SYSTEMS: [&str; 10] = [
    "G53", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

/// Pose of the program's coordinate system, m and rad.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    /// 1 for G54.
    system: u8,
    /// `g5x`, m.
    zero: Vector3<f64>,
    /// Of X and Y about Z, rad.
    turn: f64,
    /// `g92`, m.
    shift: Vector3<f64>,
}

impl Frame {
    /// From the turned system to the machine.
    fn rotation(&self) -> Rotation3<f64> {
        Rotation3::from_axis_angle(&Vector3::z_axis(), self.turn)
    }

    /// `m` of `p`.
    fn in_machine(&self, p: Point3<f64>) -> Point3<f64> {
        self.rotation() * (p + self.shift) + self.zero
    }

    /// `p` of `m`.
    fn in_program(&self, m: Point3<f64>) -> Point3<f64> {
        self.rotation().inverse() * (m - self.zero) - self.shift
    }
}

/// Where a move ends: the tip in coordinates of the program and of the path, and the tool there.
#[derive(Clone, Copy)]
struct Tip {
    /// m.
    p: Point3<f64>,
    /// m.
    q: Point3<f64>,
    /// Towards the spindle, in the frame of the path; `None` without tool-centre control.
    axis: Option<Unit<Vector3<f64>>>,
}

/// Turns canonical calls into steps.
pub(super) struct Tracer<'a> {
    out: &'a mut dyn FnMut(Step),
    rotaries: Option<&'a Rotaries>,
    /// Systems whose zeros are given.
    systems_measured: [bool; 10],
    /// Of tools by number, m.
    diameters: BTreeMap<u32, f64>,
    /// Unit of lengths in calls.
    unit: LengthUnit,
    /// That in force.
    frame: Frame,
    /// That of the first cut, or of the last move before.
    path: Option<Frame>,
    /// Whether a cut has come, after which the frame of the path stays.
    cut: bool,
    /// The tip in coordinates of the program and of the path.
    at: Option<(Point3<f64>, Point3<f64>)>,
    /// The tool at the last move.
    axis: Option<Unit<Vector3<f64>>>,
    /// Whether tool-centre control is on.
    centre: bool,
    /// Tool axis given as a vector, of any length.
    vector: Option<Vector3<f64>>,
    /// Whether the next move is counted in machine coordinates.
    in_machine: bool,
    /// m/min, or m per revolution.
    feed: f64,
    per_revolution: bool,
    /// Revolutions per minute.
    speed: f64,
    /// 1 clockwise, -1 counterclockwise, 0 stopped; `None` before it is given.
    sense: Option<f64>,
    /// In the spindle.
    tool: Option<u32>,
    /// Tool and spindle (rad/s) of the one at hand.
    operation: Option<(Option<u32>, Option<f64>)>,
    pub notes: Notes<Warning>,
}

impl<'a> Tracer<'a> {
    /// Before the first call; a system is known if one of its parameters is given.
    pub fn new(requested: &'a GcodeReadOptions<'_>, out: &'a mut dyn FnMut(Step)) -> Tracer<'a> {
        let mut systems_measured = [false; 10];
        for (system, measured) in (0_u8..).zip(&mut systems_measured).skip(1) {
            let first = parameters::zero_of(system);
            *measured = (first..first + 10).any(|index| {
                u16::try_from(index).is_ok_and(|index| requested.parameters.contains_key(&index))
            });
        }
        let diameters = requested.tools.iter().flat_map(|table| {
            let unit = table.unit.metres();
            table
                .tools
                .iter()
                .map(move |(number, tool)| (*number, tool.diameter * unit))
        });
        Tracer {
            out,
            rotaries: requested.rotaries.as_ref(),
            systems_measured,
            diameters: diameters.collect(),
            unit: requested.unit,
            frame: Frame {
                system: 1,
                zero: Vector3::zeros(),
                turn: 0.0,
                shift: Vector3::zeros(),
            },
            path: None,
            cut: false,
            at: None,
            axis: None,
            centre: false,
            vector: None,
            in_machine: false,
            feed: 0.0,
            per_revolution: false,
            speed: 0.0,
            sense: None,
            tool: None,
            operation: None,
            notes: Notes::default(),
        }
    }

    /// The next call and its line.
    ///
    /// # Errors
    /// A cut whose position is not known: between systems that are not given, in machine coordinates, with a rotary
    /// axis away from zero and no tool-centre control; rotary axes that are not described.
    pub fn take(&mut self, call: Canonical, line: u32) -> Result<(), Refusal> {
        match call {
            Canonical::StraightTraverse(end) => {
                self.straight(end, Pace::Rapid, line)?;
            }
            Canonical::StraightFeed(end) => {
                let pace = self.pace(line);
                self.straight(end, pace, line)?;
            }
            Canonical::ArcFeed(arc) => self.arc(&arc, line)?,
            Canonical::UseLengthUnits(unit) => self.unit = unit,
            Canonical::SetG5xOffset(system, zero) => {
                // A value for the active system, or different from zero: the system is known.
                let again = system == self.frame.system && self.path.is_some();
                self.frame.zero = self.lengths(&zero);
                self.frame.system = system;
                if let Some(measured) = self.systems_measured.get_mut(usize::from(system)) {
                    *measured |= again || self.frame.zero != Vector3::zeros();
                }
            }
            Canonical::SetG92Offset(shift) => self.frame.shift = self.lengths(&shift),
            Canonical::SetXyRotation(degrees) => self.frame.turn = from_deg(degrees),
            Canonical::SetFeedMode { per_revolution } => self.per_revolution = per_revolution,
            Canonical::SetFeedRate(rate) | Canonical::FeedRateInNewUnit(rate) => {
                self.feed = rate * self.unit.metres();
            }
            Canonical::SetToolTableEntry { tool, diameter, .. } => {
                self.diameters.insert(tool, diameter * self.unit.metres());
            }
            Canonical::ChangeTool(tool) => self.tool = Some(tool),
            Canonical::SetSpindleSpeed(speed) => self.speed = speed,
            Canonical::StartSpindleClockwise => self.sense = Some(1.0),
            Canonical::StartSpindleCounterclockwise => self.sense = Some(-1.0),
            Canonical::StopSpindleTurning => self.sense = self.sense.map(|_| 0.0),
            Canonical::ToolCentreControl { on } => {
                self.centre = on;
                self.vector = None;
            }
            Canonical::ToolAxis(axis) => self.vector = Some(Vector3::from(axis)),
            Canonical::MachineCoordinates => self.in_machine = true,
            Canonical::Coolant { on } => (self.out)(Step::Command(Command::Coolant(on))),
            Canonical::Dwell(seconds) if seconds > 0.0 => {
                (self.out)(Step::Command(Command::Dwell(seconds)));
            }
            Canonical::ProgramStop => (self.out)(Step::Command(Command::Stop)),
            _ => {}
        }
        Ok(())
    }

    /// X, Y, Z in m.
    fn lengths(&self, of: &Axes) -> Vector3<f64> {
        Vector3::new(of[0], of[1], of[2]) * self.unit.metres()
    }

    /// Speed of a cut; unknown if the feed is zero, or per revolution of a stopped spindle.
    fn pace(&mut self, line: u32) -> Pace {
        const MINUTE: f64 = 60.0;
        let per_minute = if self.per_revolution {
            let turning = self.sense.unwrap_or_default().abs() * self.speed;
            if turning == 0.0 {
                self.notes.count(Warning::SpindleStopped, line);
            }
            self.feed * turning
        } else {
            self.feed
        };
        if per_minute > 0.0 {
            Pace::Feed(per_minute / MINUTE)
        } else {
            Pace::Unknown
        }
    }

    /// The tip in coordinates of the path.
    fn in_path(&self, p: Point3<f64>) -> Point3<f64> {
        match self.path {
            Some(path) if path != self.frame => path.in_program(self.frame.in_machine(p)),
            _ => p,
        }
    }

    /// A direction of the program's frame in that of the path: offsets do not move it, turns do.
    fn direction_in_path(&self, of: Unit<Vector3<f64>>) -> Unit<Vector3<f64>> {
        match self.path {
            Some(path) if path.turn != self.frame.turn => {
                let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), self.frame.turn - path.turn);
                turn * of
            }
            _ => of,
        }
    }

    /// Before every move: determines its frame, and whether it is known.
    ///
    /// Until the first cut the frame of the path follows that of the program.
    fn settle(&mut self, pace: Pace, rotary: [f64; 3], line: u32) -> Result<(), Refusal> {
        let measured = |system: u8| {
            let index = usize::from(system);
            self.systems_measured.get(index).copied().unwrap_or_default()
        };
        if std::mem::take(&mut self.in_machine) && !measured(self.frame.system) {
            if pace.cuts() {
                return Err(Refusal::MachineCut);
            }
            self.notes.count(Warning::MachineZeroAssumed, line);
        }
        if pace.cuts() {
            if let Some(path) = self
                .path
                .filter(|path| self.cut && path.system != self.frame.system)
            {
                let (first, now) = (path.system, self.frame.system);
                if !measured(first) || !measured(now) {
                    let name = |system: u8| SYSTEMS.get(usize::from(system)).copied().unwrap_or_default();
                    return Err(Refusal::SystemUnknown(name(now), name(first)));
                }
            }
            let turned = rotary
                .iter()
                .zip(['A', 'B', 'C'])
                .find(|(angle, _)| angle.abs() > AT_ZERO);
            if let (false, Some((angle, axis))) = (self.centre, turned) {
                return Err(Refusal::RotaryCut { axis, angle: *angle });
            }
        }
        if !self.cut {
            self.path = Some(self.frame);
            if let Some((p, q)) = &mut self.at {
                // What came before counts from here on as if it had been in this frame.
                *p = *q;
            }
        }
        self.cut |= pace.cuts();
        Ok(())
    }

    /// The tool in the frame of the path.
    ///
    /// A vector takes precedence over rotary axes; with all of them at zero the tool is along Z on any machine.
    fn tool_axis(&mut self, rotary: [f64; 3]) -> Result<Option<Unit<Vector3<f64>>>, Refusal> {
        if !self.centre {
            return Ok(None);
        }
        let axis = match (self.vector, self.rotaries) {
            (Some(vector), _) => Unit::new_normalize(vector),
            (None, rotaries) => {
                for (axis, (angle, letter)) in [Rotary::A, Rotary::B, Rotary::C]
                    .into_iter()
                    .zip(rotary.into_iter().zip(['A', 'B', 'C']))
                {
                    if angle.abs() <= AT_ZERO {
                        continue;
                    }
                    match rotaries {
                        None => return Err(Refusal::RotariesUnknown { axis: letter }),
                        Some(rotaries) if !rotaries.has(axis) => {
                            return Err(Refusal::RotaryAbsent { axis: letter });
                        }
                        Some(_) => {}
                    }
                }
                rotaries.map_or(Vector3::z_axis(), |rotaries| rotaries.tool_axis(rotary))
            }
        };
        Ok(Some(self.direction_in_path(axis)))
    }

    /// A line; one that neither moves nor turns the tool gives no step.
    fn straight(&mut self, end: Axes, pace: Pace, line: u32) -> Result<(), Refusal> {
        let rotary = [end[3], end[4], end[5]];
        self.settle(pace, rotary, line)?;
        let axis = self.tool_axis(rotary)?;
        let p = Point3::from(self.lengths(&end));
        let q = self.in_path(p);
        // Nothing moves, but what the program calls this place may have changed.
        if self.at.is_some_and(|(_, before)| before == q) && axis == self.axis {
            self.at = Some((p, q));
            return Ok(());
        }
        self.step(pace, Tip { p, q, axis }, Course::Line, line);
        Ok(())
    }

    /// An arc; without a move before it one from the program's zero is assumed, and noted.
    fn arc(&mut self, arc: &ArcFeed, line: u32) -> Result<(), Refusal> {
        let pace = self.pace(line);
        self.settle(pace, arc.rotary, line)?;
        let axis = self.tool_axis(arc.rotary)?;
        let [first, second, across] = arc.plane.axes();
        if self.at.is_none() {
            self.notes.count(Warning::StartAssumed, line);
            let p = Point3::origin();
            let q = self.in_path(p);
            self.step(Pace::Rapid, Tip { p, q, axis }, Course::Line, line);
        }
        // The start in the current coordinates: as given by the program, or computed again if they have changed
        // since.
        let from = match (self.at, self.path) {
            (Some((p, q)), Some(path)) if path != self.frame => {
                let again = self.frame.in_program(path.in_machine(q));
                if self.in_path(p) == q { p } else { again }
            }
            (at, _) => at.map_or(Point3::origin(), |(p, _)| p),
        };
        let unit = self.unit.metres();
        let mut end = Vector3::zeros();
        (end[first], end[second], end[across]) = (arc.end[0] * unit, arc.end[1] * unit, arc.across * unit);
        // The height of the centre is not given: that of the start is used, from which a helix climbs.
        let mut centre = Point3::origin();
        (centre[first], centre[second], centre[across]) =
            (arc.centre[0] * unit, arc.centre[1] * unit, from[across]);
        let arm = |of: &Point3<f64>| Vector2::new(of[first] - centre[first], of[second] - centre[second]);
        let p = Point3::from(end);
        let turns = f64::from(arc.turns.abs() - 1);
        let swept = sweep(arm(&from), arm(&p), arc.sense()) + TAU * turns;
        let mut normal = Vector3::zeros();
        normal[across] = f64::from(arc.sense().sign());
        let course = Course::Arc(Arc {
            centre: self.in_path(centre),
            axis: self.direction_in_path(Unit::new_unchecked(normal)),
            sweep: swept,
        });
        let q = self.in_path(p);
        self.step(pace, Tip { p, q, axis }, course, line);
        Ok(())
    }

    /// Gives a move, and before it the operation that it begins.
    fn step(&mut self, pace: Pace, tip: Tip, course: Course, line: u32) {
        let Tip { p, q, axis } = tip;
        self.operate(pace, line);
        self.at = Some((p, q));
        self.axis = axis;
        let next = Move {
            end: q,
            axis,
            spin: None,
            course,
            pace,
            line,
        };
        (self.out)(Step::Move(next));
    }

    /// A new operation where the tool is another, or the spindle turns otherwise in a cut.
    fn operate(&mut self, pace: Pace, line: u32) {
        let spindle = self.sense.map(|sense| sense * self.speed * TAU / 60.0);
        let now = (self.tool, spindle);
        let same = self
            .operation
            .is_some_and(|(tool, spindle)| tool == now.0 && (spindle == now.1 || !pace.cuts()));
        if same {
            return;
        }
        self.operation = Some(now);
        let diameter = self.tool.and_then(|tool| self.diameters.get(&tool)).copied();
        (self.out)(Step::Operation(Operation {
            name: self.tool.map(|tool| format!("T{tool}")),
            tool: self.tool,
            diameter: diameter.filter(|diameter| *diameter > 0.0),
            spindle,
            line,
            ..Operation::default()
        }));
    }
}
