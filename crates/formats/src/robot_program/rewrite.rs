//! The same program with other poses: what spells a target is spelled anew, all else stays byte for byte.
//!
//! A target that stands in the text once and is gone to by several moves can be moved to one place only: where they ask
//! for different ones, that is an error, not a compromise.

use armill_core::frame::Isometry;

use super::program::{Motion, RobotProgram, Spelled, Target};

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
}

/// Two places nearer to each other than this are one: half the last digit that controllers keep, m.
const SAME_PLACE: f64 = 0.5e-6;

impl RobotProgram {
    /// The files with the targets of these moves spelled anew.
    ///
    /// # Errors
    /// See [`RewriteError`].
    pub fn with_poses(&self, moved: &[Moved]) -> Result<Vec<(String, Vec<u8>)>, RewriteError> {
        let mut edits: Vec<(&Spelled, Isometry, u32)> = Vec::with_capacity(moved.len());
        for one in moved {
            let of = &self.moves[one.index];
            if let (Motion::Circular { via }, Some(pose)) = (&of.motion, one.via) {
                edits.push((spelled(via, of.line)?, pose, of.line));
            }
            edits.push((spelled(&of.target, of.line)?, one.target, of.line));
        }
        edits.sort_by_key(|(spelled, _, _)| (spelled.text, spelled.bytes.start));
        for pair in edits.windows(2) {
            let [(one, at, line), (other, there, other_line)] = pair else {
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
            for (spelled, pose, _) in edits.iter().filter(|(spelled, ..)| spelled.text == index) {
                text.push_str(&file.text()[done..spelled.bytes.start]);
                self.language
                    .spell(pose, &file.text()[spelled.bytes.clone()], &mut text);
                done = spelled.bytes.end;
            }
            text.push_str(&file.text()[done..]);
            (file.name().to_owned(), file.encoded(&text))
        });
        Ok(files.collect())
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
