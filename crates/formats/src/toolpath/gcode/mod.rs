//! G-code, ISO 6983 and RS-274/NGC as LinuxCNC speaks it: a modal interpreter, and what it gives as steps of a path.
//!
//! The words that are followed, ignored and refused, and the assumptions, are listed in
//! `docs/guide/tool-path-words.md`; `tests/toolpath/words.rs` tries each. What moves the tool and is not understood
//! refuses the program. Rotary words need tool-centre control and [`Rotaries`]: X, Y, Z are then the tip in the frame
//! of the part, and a table carries that frame with it.
//!
//! In reading order: `lines` and `block` take a program apart (`expression`, `groups`, `messages`); `interpreter` goes
//! through it (`flow`, `walk`, `subroutines`, `labels`); `execute` does a block upon the `machine` (`parameters`,
//! `offsets`, `motion`, `cycles`, `contour`, `cutter`) as [`canonical`] calls, or says its [`refusal`]; `steps` makes the
//! path of them, by [`rotaries`]. [`tools`] and [`read_options`] are inputs in addition to the program.
//!
//! Source: LinuxCNC documentation, G codes and O codes; Kramer, Proctor, Messina, The NIST RS274NGC Interpreter,
//! NISTIR 6556 (2000). Witness: the interpreter tests of LinuxCNC.

mod block;
mod contour;
mod cutter;
mod cycles;
mod execute;
mod expression;
mod flow;
mod groups;
mod labels;
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
pub mod read_options;
pub mod refusal;
pub mod rotaries;
pub mod tools;

use std::io::BufRead;

use armill_core::path::Step;

pub use self::canonical::Canonical;
pub use self::interpreter::interpret;
pub use self::read_options::{GcodeReadOptions, Lookup, Warning};
pub use self::refusal::{Fault, Refusal};
pub use self::rotaries::{Rotaries, Rotary};
pub use self::tools::{Tool, ToolTable};

use self::steps::Tracer;
use super::Summary;
use super::format::Format;
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
/// let options = gcode::GcodeReadOptions::default();
/// let summary = gcode::read("ring.ngc", program.as_bytes(), &options, &mut |step| steps.push(step))?;
/// assert_eq!((summary.cuts, summary.arcs), (2, 1));
///
/// let problems = gcode::read("bad.ngc", "G1 X1\n".as_bytes(), &options, &mut |_| {}).unwrap_err();
/// assert!(problems.to_string().contains("bad.ngc:1:1: G1 with a feed of zero"));
/// # Ok::<(), armill_formats::document::Problems>(())
/// ```
pub fn read(
    path: &str,
    mut reader: impl BufRead,
    requested: &GcodeReadOptions<'_>,
    out: &mut dyn FnMut(Step),
) -> Result<Summary, Problems> {
    let mut summary = Summary::new(Format::Gcode);
    let mut counted = |step: Step| {
        summary.count(&step);
        out(step);
    };
    let mut tracer = Tracer::new(requested, &mut counted);
    let mut found = interpret(&mut reader, requested, &mut |call, line| tracer.take(call, line));
    if !found.faults.is_empty() {
        return Err(found.faults.iter().map(|fault| problem(path, fault)).collect());
    }
    found.notes.join(&tracer.notes);
    let notes = found.notes.iter();
    summary.notes = notes
        .map(|(warning, noted)| format!("{} ({noted})", warning.meaning()))
        .collect();
    Ok(summary)
}

/// A fault at its place: in the program, or in the file of a subroutine.
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
