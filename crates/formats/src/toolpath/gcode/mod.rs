//! G-code, ISO 6983 and RS-274/NGC as LinuxCNC speaks it: a modal interpreter, and what it gives as steps of a path.
//!
//! | understood | words |
//! |---|---|
//! | motion | G0 G1, G2 G3 (I J K, R, P turns, helices, full circles), G73 G81 to G86 G88 G89 with R Q P L, G80 |
//! | planes, units | G17 G18 G19, G20 G21 (may change), G90 G91, G90.1 G91.1, G98 G99 |
//! | feed | G93 (inverse time), G94, G95 (per revolution), F; G61 G61.1 G64 are noted |
//! | offsets | G54 to G59.3, G10 L1 L2 L10 L11 L20 (with turn R), G52, G92 to G92.3, G53, G28 G30 (G28.1 G30.1) |
//! | tool | T M6 M61, G43 G43.1 G43.2 G49, G40 G41 G42 G41.1 G42.1 in the XY and ZX planes |
//! | tool axis | G43.4, M128, M428, TRAORI with A B C and [`Rotaries`]; G43.5 with I J K; off: G49 M129 M429 TRAFOOF |
//! | spindle | S M3 M4 M5, G97 |
//! | program | M0 M1 M2 M30 M60 M98 M99 `%` `/` N, comments, parameters, expressions, O-words |
//! | passed over | M7 to M9, M19, M48 to M53; with a warning: M62 to M68 and M100 to M999 |
//!
//! | refused | because |
//! |---|---|
//! | A B C that stand turned in a cut without tool-centre control | where the tip is depends on the machine |
//! | G5 to G6.3 | splines and NURBS are not expanded |
//! | G33 G76 G7 G8 G96, tools with an orientation under G41 | lathes |
//! | G38.2 to G38.5 | where a probe stops is not in the program |
//! | G53.1 to G53.6, G68.2 to G69 | tilted planes need the machine's kinematics |
//! | G74 G87, M70 to M73, U V W, `@ ^` | not understood |
//! | every other G, M and word | unknown |
//!
//! Under tool-centre control X, Y, Z are the tip in the frame of the part; a table carries that frame with it.
//!
//! Taken for granted, each with a warning: the unit before G20 or G21; stored places of G28 and G30 at machine zero;
//! program zero at machine zero for moves in machine coordinates, which may not cut. A program begins at X0 Y0 Z0. F in
//! the block of G20 or G21 is in the new unit.
//!
//! Source: LinuxCNC documentation, G codes and O codes; Kramer, Proctor, Messina, The NIST RS274NGC Interpreter,
//! NISTIR 6556 (2000). Witness: the interpreter tests of LinuxCNC.

mod block;
mod cutter;
mod cycles;
mod execute;
mod expression;
mod flow;
mod groups;
mod lines;
mod machine;
mod messages;
mod motion;
mod offsets;
mod parameters;
mod steps;
mod subroutines;
mod walk;

pub mod canonical;
pub mod interpreter;
pub mod options;
pub mod refusal;
pub mod rotaries;
pub mod summary;
pub mod tools;

use std::io::BufRead;

use armill_core::path::Step;

pub use self::canonical::Canonical;
pub use self::interpreter::interpret;
pub use self::options::{Options, Warning, Warnings};
pub use self::refusal::{Fault, Refusal};
pub use self::rotaries::{Rotaries, Rotary};
pub use self::summary::Summary;
pub use self::tools::{Tool, ToolTable};

use self::steps::Tracer;
use crate::document::{Problem, Problems, Source};

/// Gives `out` the steps of a program while it is read; `path` is what problems show.
///
/// The steps are in the work coordinate system of the first cut. Programs of any length are followed: only subroutines
/// and loops are kept.
///
/// # Errors
/// Every block that is refused, up to 100; the steps given before are then of no use.
///
/// ```
/// use armill_formats::toolpath::gcode;
///
/// let program = "G21 G90 T1 M6 S6000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG2 I10\nM2\n";
/// let mut steps = Vec::new();
/// let options = gcode::Options::default();
/// let summary = gcode::read("ring.ngc", &mut program.as_bytes(), &options, &mut |step| steps.push(step))?;
/// assert_eq!((summary.cuts, summary.arcs), (2, 1));
///
/// let problems = gcode::read("bad.ngc", &mut "G1 X1\n".as_bytes(), &options, &mut |_| {}).unwrap_err();
/// assert!(problems.to_string().contains("bad.ngc:1:1: G1 with a feed of zero"));
/// # Ok::<(), armill_formats::document::Problems>(())
/// ```
pub fn read(
    path: &str,
    reader: &mut dyn BufRead,
    options: &Options<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut tracer = Tracer::new(options, out);
    let told = interpret(reader, options, &mut |call, line| tracer.take(call, line));
    if !told.faults.is_empty() {
        return Err(told.faults.iter().map(|fault| problem(path, fault)).collect());
    }
    let mut summary = tracer.summary;
    summary.lines = told.lines;
    summary.warnings = told.warnings;
    summary.warnings.join(&tracer.warnings);
    Ok(summary)
}

fn problem(path: &str, fault: &Fault) -> Problem {
    let source = Source::new(fault.file.as_deref().unwrap_or(path), &fault.text);
    source
        .problem(
            fault.place.clone(),
            fault.refusal.to_string(),
            fault.refusal.hint(),
        )
        .in_file(fault.line as usize, fault.offset)
}
