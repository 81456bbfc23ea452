//! The same program with other poses: targets are rewritten, everything else is kept byte for byte.
//!
//! If several moves end at the same target in the text, it can only be moved to one position; different new positions
//! are an error. A target may also depend on another one that is moved, through a missing component, a frame or an
//! offset: [`RobotProgram::check_rewritten`] reads the new files and compares every move.

use armill_core::frame::Isometry;
use armill_core::units::to_um;

use super::languages::{read_as, spell};
use super::program::{Frame, Motion, RobotProgram, Spelled, Target};
use super::spelling::Respelling;
use super::text::ProgramText;

/// New end of a move: frame to tool, in the frame of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Index of the move.
    pub index: usize,
    /// Its target.
    pub target: Isometry,
    /// Via point of a circular move.
    pub via: Option<Isometry>,
}

/// Why a program cannot be rewritten with these poses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RewriteError {
    /// The target of the move is given in joints.
    #[error("line {line}: the target is given in joints and cannot be moved")]
    Joints {
        /// Line of the move.
        line: u32,
    },
    /// The target of the move is stored on the controller.
    #[error("line {line}: the program does not give the position of `{name}`, therefore it cannot be moved")]
    Elsewhere {
        /// Line of the move.
        line: u32,
        /// Name of the target in the program.
        name: String,
    },
    /// Two moves end at the same target, but with different new positions.
    #[error(
        "the moves of lines {lines:?} end at the same target, but need positions {apart_um:.1} um apart; give each \
         move its own target"
    )]
    Shared {
        /// Lines of the two moves.
        lines: [u32; 2],
        /// Distance, um.
        apart_um: f64,
    },
    /// After rewriting, the move does not end at its new position.
    #[error(
        "line {line}: the move would end {apart_um:.1} um from its position, because its target depends on one that \
         was moved; give it its own target"
    )]
    Leans {
        /// Line of the move.
        line: u32,
        /// Distance, um.
        apart_um: f64,
    },
    /// The new files do not give a program with the same moves.
    #[error("the rewritten program has other moves than the original one")]
    Unlike,
}

/// Tolerances of a rewritten pose. Position, m: half of the third decimal of mm in each direction; orientation, as the
/// largest difference of an entry of the rotation matrix: half of the third decimal of deg in three angles.
const WRITTEN: [f64; 2] = [1e-6, 3e-5];

/// Positions closer than this are the same: half of the last digit of controllers, m.
const SAME_PLACE: f64 = 0.5e-6;

impl RobotProgram {
    /// The files, names and bytes, with the targets of these moves rewritten. An unchanged orientation is not
    /// rewritten.
    ///
    /// The indices in `moved` must be those of moves of this program.
    ///
    /// # Errors
    /// See [`RewriteError`].
    pub fn with_poses(&self, moved: &[Moved]) -> Result<Vec<(String, Vec<u8>)>, RewriteError> {
        let mut edits = Vec::with_capacity(moved.len());
        for one in moved {
            let of = &self.moves[one.index];
            if let (Motion::Circular { via }, Some(pose)) = (&of.motion, one.via) {
                edits.push(Edit::of(via, pose, of.line)?);
            }
            edits.push(Edit::of(&of.target, one.target, of.line)?);
        }
        edits.sort_by_key(|edit| (edit.spelled.text, edit.spelled.bytes.start));
        for pair in edits.windows(2) {
            let [one, other] = pair else { continue };
            let apart = (one.pose.translation.vector - other.pose.translation.vector).norm();
            if one.spelled == other.spelled && apart > SAME_PLACE {
                return Err(RewriteError::Shared {
                    lines: [one.line, other.line],
                    apart_um: to_um(apart),
                });
            }
        }
        edits.dedup_by(|one, other| one.spelled == other.spelled);
        let files = self.texts.iter().enumerate().map(|(index, file)| {
            let mut text = String::with_capacity(file.text().len());
            let mut done = 0;
            for edit in edits.iter().filter(|edit| edit.spelled.text == index) {
                let bytes = &edit.spelled.bytes;
                text.push_str(&file.text()[done..bytes.start]);
                let before = &file.text()[bytes.clone()];
                spell(self.language, &edit.pose, edit.respelling, before, &mut text);
                done = bytes.end;
            }
            text.push_str(&file.text()[done..]);
            (file.name().to_owned(), file.encoded(&text))
        });
        Ok(files.collect())
    }

    /// Checks that the moves in the files of [`RobotProgram::with_poses`] end at the new poses, and all other moves at
    /// the same poses as before, in the same frames, within the written decimals.
    ///
    /// # Errors
    /// [`RewriteError::Leans`] and [`RewriteError::Unlike`].
    pub fn check_rewritten(&self, moved: &[Moved], files: &[(String, Vec<u8>)]) -> Result<(), RewriteError> {
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = read_as(self.language, texts.collect()).map_err(|_| RewriteError::Unlike)?;
        if again.moves.len() != self.moves.len() {
            return Err(RewriteError::Unlike);
        }
        let mut requested = vec![None; self.moves.len()];
        for one in moved {
            requested[one.index] = Some(one);
        }
        for ((of, found), requested) in self.moves.iter().zip(&again.moves).zip(requested) {
            let via = |motion: &Motion| match motion {
                Motion::Circular { via } => via.pose().copied(),
                Motion::Joint | Motion::Linear => None,
            };
            let ends = [
                (
                    found.target.pose().copied(),
                    requested.map(|one| one.target),
                    of.target.pose().copied(),
                ),
                (
                    via(&found.motion),
                    requested.and_then(|one| one.via),
                    via(&of.motion),
                ),
            ];
            for (found_end, requested, before) in ends {
                let (Some(end), Some(expected)) = (found_end, requested.or(before)) else {
                    continue;
                };
                compare(in_base(&found.frame, end), in_base(&of.frame, expected), of.line)?;
            }
        }
        Ok(())
    }
}

/// Orientations that differ by less are the same: sine of half the angle.
const SAME_TURN: f64 = 1e-12;

/// A new pose of a target, at its position in the text.
struct Edit<'a> {
    spelled: &'a Spelled,
    pose: Isometry,
    respelling: Respelling,
    /// Line of the move.
    line: u32,
}

impl Edit<'_> {
    /// The edit that gives this target of the move of a line a new pose.
    fn of(target: &Target, pose: Isometry, line: u32) -> Result<Edit<'_>, RewriteError> {
        match target {
            Target::Pose {
                pose: before,
                spelled,
                ..
            } => {
                let turned = (before.rotation.inverse() * pose.rotation).vector().norm();
                let respelling = match turned < SAME_TURN {
                    true => Respelling::Place,
                    false => Respelling::Pose,
                };
                Ok(Edit {
                    spelled,
                    pose,
                    respelling,
                    line,
                })
            }
            Target::Joints(_) => Err(RewriteError::Joints { line }),
            Target::Elsewhere { name } => Err(RewriteError::Elsewhere {
                line,
                name: name.clone(),
            }),
        }
    }
}

/// In the base if the frame is given, otherwise in the frame.
fn in_base(frame: &Frame, pose: Isometry) -> Isometry {
    match frame {
        Frame::Given(frame) => frame * pose,
        Frame::Numbered(_) | Frame::Unknown => pose,
    }
}

fn compare(found: Isometry, expected: Isometry, line: u32) -> Result<(), RewriteError> {
    let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
    let apart = (found.translation.vector - expected.translation.vector).norm();
    let turned = (matrix(&found) - matrix(&expected)).amax();
    // Rounding of large coordinates.
    let rounding = expected.translation.vector.norm() * 1e-12;
    match apart < WRITTEN[0] + rounding && turned < WRITTEN[1] {
        true => Ok(()),
        false => Err(RewriteError::Leans {
            line,
            apart_um: to_um(apart),
        }),
    }
}
