//! Whole answers of ortho-parallel arms whose model is the drives alone, a block of points at a time, for maps, volumes
//! and paths.

use super::aimed::SolvedBlock;
use super::batch::Batch;
use super::posture_signs::FOUR;
use super::written::SolvedAnswers;
use crate::frame::Isometry;
use crate::kernel::answer::{AT_LIMIT, Slots};
use crate::kernel::lanes::geometry::Second;
use crate::kernel::lanes::load::{OneCase, Shares, Worst};
use crate::kernel::lanes::solve::{FindStances, Preference, Stances, flag};
use crate::kernel::question::{BranchChoice, Question};
use crate::numbers::{BLOCK, Backend, Plane, Planes, planes};
use crate::robot::inverse::OrthoParallel;
use crate::robot::{Branch, BranchPattern, Elbow, Shoulder, Singularity, Wrist};

/// Points in a block.
pub(in crate::kernel) const POINTS: usize = BLOCK;

/// Answers a block of points; one per thread.
pub(in crate::kernel) struct Points<'q> {
    question: &'q Question<'q>,
    batch: Batch<f64>,
    uncertainty_is_known: bool,
    room: Box<Room>,
}

#[repr(C, align(64))]
struct Room {
    stances: Stances<f64>,
    /// Signs of the best posture so far and its score; infinite where there is none.
    chosen: Planes<f64, 2>,
    score: Plane<f64>,
    worst: Worst<f64>,
    shares: Planes<f64, 6>,
    uncertainty: Plane<f64>,
    /// Of each load case; last, because its size is not a multiple of a cache line.
    deviations: Vec<Planes<f64, 3>>,
}

impl<'q> Points<'q> {
    /// For an arm whose model is the drives alone.
    pub fn new(question: &'q Question<'q>, arm: &OrthoParallel) -> Points<'q> {
        Points {
            question,
            batch: Batch::new(question, arm, Backend::fastest()),
            uncertainty_is_known: question.arm.has_known_uncertainty(),
            room: Box::new(Room {
                stances: Stances {
                    joints: planes(),
                    room: [0.0; BLOCK],
                    joint: [0.0; BLOCK],
                    flip: [0.0; BLOCK],
                    linear: planes(),
                    axes: planes(),
                },
                chosen: planes(),
                score: [0.0; BLOCK],
                deviations: vec![planes(); question.cases.len()],
                worst: Worst::none(),
                shares: planes(),
                uncertainty: [0.0; BLOCK],
            }),
        }
    }

    /// Computes the answers at these poses, at most [`POINTS`]; [`Points::write`] copies them.
    pub fn solve(&mut self, poses: &[Isometry]) {
        self.batch.aim_at(poses);
        let preference = match self.question.choice {
            BranchChoice::Best => {
                self.choose_least_envelope();
                Preference {
                    plain: 0.0,
                    flipped: 0.0,
                }
            }
            BranchChoice::Of(pattern) => {
                let preference = preference(pattern);
                self.choose_most_room(pattern, preference);
                preference
            }
        };
        self.batch.solve_each(&self.room.chosen);
        self.set_stance(preference);
        self.deviate();
    }

    /// Fills the slots of the solved points. Returns for each point whether lanes decide it; slots of the other points
    /// have no evaluation and unspecified numbers.
    pub fn write(&self, slots: &mut Slots<'_>) -> [bool; POINTS] {
        let Room {
            stances,
            chosen,
            score,
            worst,
            shares,
            uncertainty,
            deviations,
        } = &*self.room;
        let SolvedBlock { postures, .. } = self.batch.solved();
        let solved = SolvedAnswers {
            joints: &stances.joints,
            margin: &stances.room,
            nearest: &stances.joint,
            worst,
            uncertainty: self.uncertainty_is_known.then_some(uncertainty),
            deviations,
            shares,
        };
        let inside_limits = self.question.choice == BranchChoice::Best;
        solved.write(slots, |i| {
            let flags = postures.flags[i] as u32;
            let unknown = flags & (flag::UNREACHABLE | flag::WRIST_UNDECIDED) != 0;
            // The envelope tested the limits by cosines; exactly at a limit the angles may differ.
            let at_the_edge = inside_limits && stances.room[i] < -AT_LIMIT;
            let decided = !(unknown || at_the_edge || score[i].is_infinite());
            decided.then(|| (branch(chosen, &stances.flip, i), singularity(flags)))
        })
    }

    /// Selects, of the postures inside limits, the one with the smallest envelope.
    fn choose_least_envelope(&mut self) {
        let Room { chosen, score, .. } = &mut *self.room;
        score.fill(f64::INFINITY);
        self.batch.orient(Second::InTheMiddle);
        for (four, signs) in FOUR.into_iter().enumerate() {
            let (in_plane, flags) = self.batch.envelope_in_turn(four);
            for i in 0..BLOCK {
                let flags = flags[i] as u32;
                let outside = flag::OUTSIDE_LIMITS | flag::OUTSIDE_LIMITS_FLIPPED;
                let usable = flags & flag::UNREACHABLE == 0 && flags & outside != outside;
                if usable && in_plane[i] < score[i] {
                    score[i] = in_plane[i];
                    (chosen[0][i], chosen[1][i]) = (signs[0], signs[1]);
                }
            }
        }
        self.batch.orient(Second::AtZero);
    }

    /// Selects, of the postures that match, the one with the largest margin to its limits.
    fn choose_most_room(&mut self, pattern: BranchPattern, preference: Preference) {
        let matching: Vec<[f64; 2]> = FOUR
            .into_iter()
            .zip(Branch::ALL.chunks(2))
            .filter(|(_, pair)| pair.iter().any(|branch| pattern.matches(*branch)))
            .map(|(signs, _)| signs)
            .collect();
        self.batch.orient(Second::AtZero);
        if let [only] = matching[..] {
            self.room.score.fill(0.0);
            self.room.chosen = [[only[0]; BLOCK], [only[1]; BLOCK]];
            return;
        }
        self.room.score.fill(f64::INFINITY);
        for signs in matching {
            self.batch.solve(signs, false);
            self.set_stance(preference);
            let SolvedBlock { postures, .. } = self.batch.solved();
            let Room {
                stances,
                chosen,
                score,
                ..
            } = &mut *self.room;
            for i in 0..BLOCK {
                let reached = postures.flags[i] as u32 & flag::UNREACHABLE == 0;
                if reached && -stances.room[i] < score[i] {
                    score[i] = -stances.room[i];
                    (chosen[0][i], chosen[1][i]) = (signs[0], signs[1]);
                }
            }
        }
    }

    fn set_stance(&mut self, preference: Preference) {
        self.batch.position(false);
        let SolvedBlock {
            prepared,
            aims,
            postures,
            positions,
            backend,
        } = self.batch.solved();
        let stances = &mut self.room.stances;
        if prepared.moments {
            backend.run(FindStances::<f64, true> {
                prepared,
                aims,
                postures,
                positions,
                preference,
                stances,
            });
        } else {
            backend.run(FindStances::<f64, false> {
                prepared,
                aims,
                postures,
                positions,
                preference,
                stances,
            });
        }
    }

    fn deviate(&mut self) {
        let SolvedBlock {
            prepared, backend, ..
        } = self.batch.solved();
        let Room {
            stances,
            deviations,
            worst,
            shares,
            uncertainty,
            ..
        } = &mut *self.room;
        for (case, deviation) in deviations.iter_mut().enumerate() {
            if prepared.moments {
                backend.run(OneCase::<f64, true> {
                    prepared,
                    stances,
                    case,
                    deviation,
                    worst,
                });
            } else {
                backend.run(OneCase::<f64, false> {
                    prepared,
                    stances,
                    case,
                    deviation,
                    worst,
                });
            }
        }
        if prepared.moments {
            backend.run(Shares::<f64, true> {
                prepared,
                stances,
                worst,
                shares,
                uncertainty,
            });
        } else {
            backend.run(Shares::<f64, false> {
                prepared,
                stances,
                worst,
                shares,
                uncertainty,
            });
        }
    }
}

/// Larger than the margin of any joint: a posture preferred by it is always selected.
const ALWAYS: f64 = 1e9;

fn preference(pattern: BranchPattern) -> Preference {
    match pattern.wrist {
        Some(Wrist::NoFlip) => Preference {
            plain: ALWAYS,
            flipped: 0.0,
        },
        Some(Wrist::Flip) => Preference {
            plain: 0.0,
            flipped: ALWAYS,
        },
        None => Preference {
            plain: 0.0,
            flipped: 0.0,
        },
    }
}

fn branch(signs: &Planes<f64, 2>, flip: &Plane<f64>, index: usize) -> Branch {
    Branch {
        shoulder: if signs[0][index] > 0.0 {
            Shoulder::Front
        } else {
            Shoulder::Back
        },
        elbow: if signs[1][index] > 0.0 {
            Elbow::Up
        } else {
            Elbow::Down
        },
        wrist: if flip[index] > 0.0 {
            Wrist::Flip
        } else {
            Wrist::NoFlip
        },
    }
}

fn singularity(flags: u32) -> Option<Singularity> {
    if flags & flag::NEAR_WRIST != 0 {
        Some(Singularity::Wrist)
    } else if flags & flag::NEAR_ELBOW != 0 {
        Some(Singularity::Elbow)
    } else if flags & flag::NEAR_SHOULDER != 0 {
        Some(Singularity::Shoulder)
    } else {
        None
    }
}
