//! The same program with other poses: what spells a target is spelled anew, all else stays byte for byte.
//!
//! A target that stands in the text once and is gone to by several moves can be moved to one place only: where they ask
//! for different ones, that is an error, not a compromise. So is a target that counts from another one that moves, by a
//! component left out, as a frame, or as a step from there: [`RobotProgram::check_rewritten`] reads the new files and
//! compares every move.

use armill_core::frame::Isometry;

use super::program::{Frame, Motion, RobotProgram, Spelled, Target};
use super::spelling::Anew;
use super::text::ProgramText;

/// Where a move shall go instead: frame to tool, in the frame that its targets count in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Which move.
    pub index: usize,
    /// Its target.
    pub target: Isometry,
    /// On the way of a circular move.
    pub via: Option<Isometry>,
}

/// Why a program cannot be written with these poses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RewriteError {
    /// The target of the move is told in joints.
    #[error("line {line}: the target is told in joints, which is left as it is")]
    Joints {
        /// Line of the move.
        line: u32,
    },
    /// The target of the move stands on the controller.
    #[error("line {line}: the program does not tell where `{name}` is, so that it cannot be moved")]
    Elsewhere {
        /// Line of the move.
        line: u32,
        /// What the program calls the target.
        name: String,
    },
    /// Two moves go to one target and shall go to different places.
    #[error(
        "the moves of lines {lines:?} go to one target, which would have to lie at places {apart_um:.1} um apart; give each \
         move a target of its own"
    )]
    Shared {
        /// Lines of the two moves.
        lines: [u32; 2],
        /// How far apart, um.
        apart_um: f64,
    },
    /// Read again, the move does not go where it should.
    #[error(
        "line {line}: the move would go {apart_um:.1} um beside its place, for its target counts from one that was moved; give it a \
         target of its own"
    )]
    Leans {
        /// Line of the move.
        line: u32,
        /// How far, um.
        apart_um: f64,
    },
    /// The new files do not read as a program with the same moves.
    #[error("the program that was written has other moves than the one that was read")]
    Unlike,
}

/// What was written lies so near to what was asked for, m: half the third decimal of mm in every direction; and, as the
/// largest entry of a rotation matrix, half the third decimal of deg, of three angles.
const WRITTEN: [f64; 2] = [1e-6, 3e-5];

/// Two places nearer to each other than this are one: half the last digit that controllers keep, m.
const SAME_PLACE: f64 = 0.5e-6;

impl RobotProgram {
    /// The files with the targets of these moves spelled anew; an orientation that stays is left as it is spelled.
    ///
    /// # Errors
    /// See [`RewriteError`].
    pub fn with_poses(&self, moved: &[Moved]) -> Result<Vec<(String, Vec<u8>)>, RewriteError> {
        let mut edits: Vec<(&Spelled, (Isometry, Anew), u32)> = Vec::with_capacity(moved.len());
        for one in moved {
            let of = &self.moves[one.index];
            if let (Motion::Circular { via }, Some(pose)) = (&of.motion, one.via) {
                edits.push((spelled(via, of.line)?, (pose, anew(via, &pose)), of.line));
            }
            let anew = anew(&of.target, &one.target);
            edits.push((spelled(&of.target, of.line)?, (one.target, anew), of.line));
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
            for (spelled, (pose, anew), _) in edits.iter().filter(|(spelled, ..)| spelled.text == index) {
                text.push_str(&file.text()[done..spelled.bytes.start]);
                self.language
                    .spell((pose, *anew), &file.text()[spelled.bytes.clone()], &mut text);
                done = spelled.bytes.end;
            }
            text.push_str(&file.text()[done..]);
            (file.name().to_owned(), file.encoded(&text))
        });
        Ok(files.collect())
    }
}

impl RobotProgram {
    /// That the files of [`RobotProgram::with_poses`] go where they should: those moves to the new poses, all others to the
    /// same as before, in the same frames, as far as the digits written tell.
    ///
    /// # Errors
    /// [`RewriteError::Leans`] and [`RewriteError::Unlike`].
    pub fn check_rewritten(&self, moved: &[Moved], files: &[(String, Vec<u8>)]) -> Result<(), RewriteError> {
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = self
            .language
            .read(texts.collect())
            .map_err(|_| RewriteError::Unlike)?;
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
                (via(&found.motion), requested.and_then(|one| one.via), via(&of.motion)),
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

/// Orientations that differ by less are one: sine of half the angle.
const SAME_TURN: f64 = 1e-12;

/// What of this target is new.
fn anew(target: &Target, moved: &Isometry) -> Anew {
    let turned = |pose: &Isometry| (pose.rotation.inverse() * moved.rotation).vector().norm();
    match target.pose() {
        Some(pose) if turned(pose) < SAME_TURN => Anew::Place,
        _ => Anew::Pose,
    }
}

/// In the base where the frame is told, else in the frame.
fn in_base(frame: &Frame, pose: Isometry) -> Isometry {
    match frame {
        Frame::Told(frame) => frame * pose,
        Frame::Numbered(_) | Frame::EvaluateError => pose,
    }
}

fn compare(found: Isometry, expected: Isometry, line: u32) -> Result<(), RewriteError> {
    let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
    let apart = (found.translation.vector - expected.translation.vector).norm();
    let turned = (matrix(&found) - matrix(&expected)).amax();
    // Of places far out the last digits of the number itself.
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
