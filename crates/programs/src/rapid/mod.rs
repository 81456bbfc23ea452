//! ABB RAPID: modules, `.mod`, `.prg`, `.sys`.
//!
//! | statement | read as |
//! |---|---|
//! | `MoveAbsJ` | a joint move to joint positions |
//! | `MoveJ`, `TriggJ`, `MoveJDO`, ... | a joint move to a pose with confdata |
//! | `MoveL`, `TriggL`, `ArcL`, `MoveLDO`, ... | a straight move |
//! | `MoveC`, `TriggC`, `ArcC`, `MoveCDO`, ... | a circular move |
//! | `CONST`, `PERS`, `VAR`, `name := ...`, `name.uframe := ...` | values of names |
//! | `Offs(p, x, y, z)`, `RelTool(p, x, y, z \Rx, \Ry, \Rz)` | a target with an offset |
//!
//! A target is `[[x, y, z], [q1, q2, q3, q4], [cf1, cf4, cf6, cfx], [eax_a, ...]]`, mm, real part first, relative to
//! the work object: uframe times oframe. cf is the quarter turn of axes 1, 4, 6 (floor of degrees / 90), returned as
//! `turns`; cfx is 4 rear + 2 lower + 1 flip. Speeds are mm/s. Stationary tools, work objects on the flange and program
//! displacements (`PDispOn`) are problems; external axes are kept in the text and are not joints in armill.
//!
//! `[recalled]`, not in a sample: `RelTool` rotates about x, then the new y, then the new z; the positions of tool and
//! zone in the arguments of process moves; `v100` is 100 mm/s.
//!
//! In reading order: `statement` (a module as statements), `value` (kinds of expressions), `names` (values of
//! names), `read` (statements), `expression` (how expressions are read), `motion`, `target` and `frames` (moves),
//! `spell` (a pose), `write` (programs to load).

mod expression;
mod frames;
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

/// Remarks begin with `!`; texts are in `"`.
const SYNTAX: Syntax = Syntax {
    remark: '!',
    quotes: &['"'],
};
