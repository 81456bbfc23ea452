//! The same program with other poses: targets are rewritten, everything else is kept byte for byte.
//!
//! A target that occurs once in the text and is the end of several moves can only be moved to one position. Different
//! positions for it are an error. The same applies to a target that depends on a moved one through a missing component,
//! a frame or an offset: [`RobotProgram::check_rewritten`] reads the new files and compares every move.

use armill_core::frame::Isometry;

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
         was moved; give it \
         its own target"
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

/// Tolerance of a rewritten position, m: half of the third decimal of mm in every direction; and, as the
/// largest entry of a rotation matrix, half of the third decimal of deg in three angles.
const WRITTEN: [f64; 2] = [1e-6, 3e-5];

/// Positions closer than this are the same: half of the last digit of controllers, m.
const SAME_PLACE: f64 = 0.5e-6;

impl RobotProgram {
    /// The files with rewritten targets of these moves. An unchanged orientation is not rewritten.
    ///
    /// # Errors
    /// See [`RewriteError`].
    pub fn with_poses(&self, moved: &[Moved]) -> Result<Vec<(String, Vec<u8>)>, RewriteError> {
        let mut edits: Vec<(&Spelled, (Isometry, Respelling), u32)> = Vec::with_capacity(moved.len());
        for one in moved {
            let of = &self.moves[one.index];
            if let (Motion::Circular { via }, Some(pose)) = (&of.motion, one.via) {
                edits.push((spelled(via, of.line)?, (pose, respelling_of(via, &pose)), of.line));
            }
            let respelling = respelling_of(&of.target, &one.target);
            edits.push((spelled(&of.target, of.line)?, (one.target, respelling), of.line));
        }
        edits.sort_by_key(|(spelled, _, _)| (spelled.text, spelled.bytes.start));
        for pair in edits.windows(2) {
            let [(one, (at, _), line), (other, (there, _), other_line)] = pair else {
                continue;
            };
            let apart = (at.translation.vector - there.translation.vector).norm();
            if one == other && apart > SAME_PLACE {
                return Err(RewriteError::Shared {
                    lines: [*line, *other_line],
                    apart_um: apart * 1e6,
                });
            }
        }
        edits.dedup_by(|one, other| one.0 == other.0);
        let files = self.texts.iter().enumerate().map(|(index, file)| {
            let mut text = String::with_capacity(file.text().len());
            let mut done = 0;
            for (spelled, (pose, respelling), _) in edits.iter().filter(|(spelled, ..)| spelled.text == index)
            {
                text.push_str(&file.text()[done..spelled.bytes.start]);
                spell(
                    self.language,
                    (pose, *respelling),
                    &file.text()[spelled.bytes.clone()],
                    &mut text,
                );
                done = spelled.bytes.end;
            }
            text.push_str(&file.text()[done..]);
            (file.name().to_owned(), file.encoded(&text))
        });
        Ok(files.collect())
    }
}

impl RobotProgram {
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

/// The new part of this target.
fn respelling_of(target: &Target, moved: &Isometry) -> Respelling {
    let turned = |pose: &Isometry| (pose.rotation.inverse() * moved.rotation).vector().norm();
    match target.pose() {
        Some(pose) if turned(pose) < SAME_TURN => Respelling::Place,
        _ => Respelling::Pose,
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
            apart_um: apart * 1e6,
        }),
    }
}

fn spelled(target: &Target, line: u32) -> Result<&Spelled, RewriteError> {
    match target {
        Target::Pose { spelled, .. } => Ok(spelled),
        Target::Joints(_) => Err(RewriteError::Joints { line }),
        Target::Elsewhere { name } => Err(RewriteError::Elsewhere {
            line,
            name: name.clone(),
        }),
    }
}
