//! ABB RAPID: modules, `.mod`, `.prg`, `.sys`.
//!
//! | statement | what it becomes |
//! |---|---|
//! | `MoveAbsJ` | a move of the joints, to joints |
//! | `MoveJ`, `TriggJ`, `MoveJDO`, ... | a move of the joints, to a pose with confdata |
//! | `MoveL`, `TriggL`, `ArcL`, `MoveLDO`, ... | a straight move |
//! | `MoveC`, `TriggC`, `ArcC`, `MoveCDO`, ... | a circular move |
//! | `CONST`, `PERS`, `VAR`, `name := ...`, `name.uframe := ...` | what later names stand for |
//! | `Offs(p, x, y, z)`, `RelTool(p, x, y, z \Rx, \Ry, \Rz)` | a place beside another |
//!
//! A target is `[[x, y, z], [q1, q2, q3, q4], [cf1, cf4, cf6, cfx], [eax_a, ...]]`, mm, real part first; it counts in the work
//! object: uframe times oframe. cf is the quarter turn of axes 1, 4, 6 (floor of degrees / 90), told as `turns`; cfx is 4
//! rear + 2 lower + 1 flip. Speeds are mm/s. Tools that stand still, work objects on the flange and program displacements
//! (`PDispOn`) are problems; external axes stay in the text and are no joints here.
//!
//! `[recalled]`, not in a sample: `RelTool` turns about x, then the new y, then the new z; where tool and zone stand among the
//! arguments of process moves; `v100` is 100 mm/s.
//!
//! In reading order: `value` expressions; `names` what names stand for; `statement` takes text apart; `read`, `motion`,
//! `target`, `kept` what statements do; `spell` a pose; `write` the program out.

mod kept;
mod motion;
mod names;
mod read;
mod spell;
mod statement;
mod target;
mod value;
mod write;

pub use self::read::read;
pub(super) use self::spell::spell;
pub use self::write::write;

use super::tokens::Syntax;

/// Remarks from `!` on; texts in `"`.
const SYNTAX: Syntax = Syntax {
    remark: '!',
    quotes: &['"'],
};
