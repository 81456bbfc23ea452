//! The programs, their tools and stocks.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::load::EndMillBody;
use armill_core::machined::{MachiningPath, PathTool, Stage};
use armill_core::nalgebra::{Point3, Rotation3, Vector3};
use armill_core::path::{Course, Operation, PathBuilder, Placing, Sampling, Spin, Step, Track};
use armill_core::removal::{DexelDirections, DexelPart, MoveRemoval, StockSolid, ToolSolid};
use armill_core::watch::Watch;
use armill_formats::toolpath::apt::{self, AptReadOptions};
use armill_formats::toolpath::gcode::{self, GcodeReadOptions, Rotaries};

use crate::MM;
use crate::moving_tool::{Body, MovingTool};

/// A program of the samples, or a part of it.
#[derive(Clone, Copy)]
pub struct Program {
    /// File in `toolpaths`.
    pub file: &'static str,
    /// Moves that are cut, from this one up to the other; tools are those of the program.
    pub moves: [usize; 2],
    /// Diameter, corner radius and length of a tool, mm. Diameter and corner of the program come first.
    pub tool_mm: [f64; 3],
    /// Two corners of the stock, mm.
    pub stock_mm: [[f64; 3]; 2],
    /// Side of a cell, mm. No plane of the program may go through dexels: they would be decided by rounding.
    pub cell_mm: f64,
    /// Angle about y from the frame of the program to the one that is cut in, deg.
    pub turned_deg: f64,
}

/// To the end of the program.
pub const END: usize = usize::MAX;

/// A carving in a block of 100 x 100 x 50 mm with a ball nose of 10 mm, as its remarks say.
pub const CARVING: Program = Program {
    file: "gcode/linuxcnc/nc_files/3D_Chips.ngc",
    moves: [0, END],
    tool_mm: [10.0, 5.0, 80.0],
    stock_mm: [[-50.0, -50.0, -50.0], [50.0, 50.0, 0.0]],
    cell_mm: 0.5,
    turned_deg: 0.0,
};
/// A plate of 350 x 150 x 10.5 mm: holes by a drill of 4 mm, here a flat end mill, then slots and outlines with flat end mills of 5, 6 and 8 mm.
pub const PLATE: Program = Program {
    file: "apt/parts-2021/basemach.apt",
    moves: [0, END],
    tool_mm: [5.0, 0.0, 60.0],
    stock_mm: [[0.0, 0.0, -10.5], [350.0, 150.0, 0.0]],
    cell_mm: 0.49,
    turned_deg: 0.0,
};
/// A block of 95 x 150 x 120 mm, cut from above and then from another side (3+2): flat end mills of 6 and 20 mm, many arcs.
pub const BLOCK: Program = Program {
    file: "apt/parts-tools/boss.apt",
    moves: [0, END],
    tool_mm: [6.0, 0.0, 250.0],
    stock_mm: [[0.0, 0.0, -120.0], [95.0, 150.0, 0.0]],
    cell_mm: 0.97,
    turned_deg: 0.0,
};
/// A support that is faced and drilled with the tool tilted by 10 deg (3+2).
pub const SUPPORT: Program = Program {
    file: "apt/parts-2025/Telemecanique-Tilt-Support1.apt",
    moves: [0, END],
    tool_mm: [16.0, 0.0, 90.0],
    stock_mm: [[0.0, 0.0, -30.0], [45.0, 40.0, 5.0]],
    cell_mm: 0.25,
    turned_deg: 0.0,
};
/// An impeller in five axes. The file names no tool: a ball nose of 4 mm; its stock is a block.
pub const IMPELLER: Program = Program {
    file: "gcode/linuxcnc/configs/sim/axis/vismach/5axis/table-rotary-tilting/demos/impeller-7bl-xyzac.ngc",
    moves: [0, END],
    tool_mm: [4.0, 2.0, 25.0],
    stock_mm: [[-40.0, -40.0, -5.0], [40.0, 40.0, 35.0]],
    cell_mm: 0.5,
    turned_deg: 0.0,
};

/// A program that was read.
pub struct Read {
    pub program: Program,
    /// Points, as armill cuts them.
    pub track: Track,
    pub tools: Vec<PathTool>,
    /// The same tools as a height map has them.
    pub bodies: Vec<(usize, EndMillBody)>,
    /// Moves up to the last cut, as the program has them; the line of a rapid is that of the next cut.
    pub moves: Vec<MovingTool>,
}

/// A part that was cut.
pub struct CutPart {
    pub part: DexelPart,
    pub stages: Vec<Stage>,
    pub removals: Vec<MoveRemoval>,
    /// m^3
    pub stock_volume: f64,
}

/// Chords of arcs, m.
pub const CHORD: f64 = 1e-6;

impl Program {
    /// Two corners of the stock, m.
    pub fn corners(&self) -> [Point3<f64>; 2] {
        self.stock_mm.map(|corner| Point3::from(corner) * MM)
    }

    /// Its steps; `None` without the samples.
    fn steps(&self) -> Option<Vec<Step>> {
        let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return None;
        };
        let bytes = std::fs::read(Path::new(&samples).join("toolpaths").join(self.file)).unwrap();
        let mut steps = Vec::new();
        let mut out = |step: Step| steps.push(step);
        let read = match self.file.ends_with(".apt") {
            true => apt::read(self.file, bytes.as_slice(), &AptReadOptions::default(), &mut out),
            false => {
                let options = GcodeReadOptions {
                    rotaries: Some(Rotaries::table_ac()),
                    ..GcodeReadOptions::default()
                };
                gcode::read(self.file, bytes.as_slice(), &options, &mut out)
            }
        };
        read.unwrap_or_else(|problems| panic!("{problems}"));
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), self.turned_deg.to_radians());
        for step in &mut steps {
            if let Step::Move(next) = step {
                next.end = turn * next.end;
                next.axis = next.axis.map(|axis| turn * axis);
                if let Course::Arc(arc) = &mut next.course {
                    (arc.centre, arc.axis) = (turn * arc.centre, turn * arc.axis);
                }
            }
        }
        let mut number = 0;
        steps.retain(|step| {
            let is_move = matches!(step, Step::Move(_));
            number += usize::from(is_move);
            !is_move || (self.moves[0]..self.moves[1]).contains(&(number - 1))
        });
        Some(steps)
    }

    /// The tool of an operation.
    fn body(&self, operation: Option<&Operation>) -> EndMillBody {
        let [diameter, corner, _] = self.tool_mm.map(|mm| mm * MM);
        let diameter = operation
            .and_then(|operation| operation.diameter)
            .unwrap_or(diameter);
        let corner = operation
            .and_then(|operation| operation.corner_radius)
            .unwrap_or(corner);
        EndMillBody::new(diameter, corner.min(diameter / 2.0)).unwrap()
    }

    /// Read, in steps of at most `step` (m).
    pub fn read(&self, step: f64) -> Option<Read> {
        let steps = self.steps()?;
        let moves = self.moving_tools(&steps);
        let sampling = Sampling {
            chord_error: CHORD,
            step,
        };
        let mut builder = PathBuilder::new(sampling, 10_000_000);
        steps.into_iter().for_each(|step| builder.take(step));
        let path = builder.finish().unwrap();
        let mut bodies = vec![(0, self.body(None))];
        bodies.extend(
            path.operations
                .iter()
                .map(|(first, of)| (*first, self.body(Some(of)))),
        );
        let tools = bodies.iter().map(|(first, body)| PathTool {
            first: *first,
            cutting: ToolSolid::end_mill(body, self.tool_mm[2] * MM).unwrap(),
            clear: Vec::new(),
        });
        Some(Read {
            program: *self,
            tools: tools.collect(),
            bodies,
            track: Track {
                path,
                placing: Placing {
                    base_from_path: Isometry::identity(),
                    axis: Vector3::z_axis(),
                    keeps_axis: false,
                    spin: Spin::Fixed(0.0),
                },
                base_from_part: Isometry::identity(),
                spins: None,
                homes: None,
            },
            moves,
        })
    }

    /// The moves of these steps, up to the last cut. The first one only places the tool.
    fn moving_tools(&self, steps: &[Step]) -> Vec<MovingTool> {
        let body = |operation| {
            let body = self.body(operation);
            Body {
                radius: body.radius(),
                corner: body.corner_radius(),
                length: self.tool_mm[2] * MM,
            }
        };
        let (mut moves, mut current) = (Vec::<MovingTool>::new(), body(None));
        let mut last: Option<(Point3<f64>, _)> = None;
        let mut cuts = 0;
        for step in steps {
            let next = match step {
                Step::Operation(operation) => {
                    current = body(Some(operation));
                    continue;
                }
                Step::Command(_) => continue,
                Step::Move(next) => next,
            };
            let before = last.map_or(Vector3::z_axis(), |(_, axis)| axis);
            let axis = next.axis.unwrap_or(before);
            if let Some((start, _)) = last {
                let first = if last.is_some() { before } else { axis };
                moves.push(MovingTool::new(current, start, [first, axis], next));
                if next.pace.cuts() {
                    for rapid in &mut moves[cuts..] {
                        rapid.line = next.line;
                    }
                    cuts = moves.len();
                }
            }
            last = Some((next.end, axis));
        }
        moves.truncate(cuts);
        moves
    }
}

impl Read {
    /// How far a turning axis may be off, m.
    pub fn turn_tolerance(&self) -> f64 {
        0.02 * self.program.cell_mm * MM
    }

    /// The path with its tools.
    pub fn path(&self) -> MachiningPath<'_> {
        MachiningPath {
            track: &self.track,
            tools: &self.tools,
            turn_tolerance: self.turn_tolerance(),
        }
    }

    /// The part.
    pub fn cut(&self, directions: DexelDirections) -> CutPart {
        let corners = self.program.corners();
        let stock = DexelPart::new(&StockSolid::Box(corners), self.program.cell_mm * MM, directions).unwrap();
        let stages = self.path().stages(None);
        let stock_volume = stock.volume();
        let (part, removals) = self.path().cut(stock, &stages, Watch::NONE).unwrap();
        CutPart {
            part,
            stages,
            removals,
            stock_volume,
        }
    }
}
