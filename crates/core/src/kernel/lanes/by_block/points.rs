//! Whole answers, a block of points at a time, for maps, volumes and paths.

use nalgebra::Vector3;

use super::aimed::SolvedBlock;
use super::batch::Batch;
use super::posture_signs::FOUR;
use super::written::SolvedAnswers;
use crate::frame::{Isometry, both_across};
use crate::kernel::answer::{ALIKE, AT_LIMIT, Slots};
use crate::kernel::lanes::geometry::Second;
use crate::kernel::lanes::load::{OneCase, Shares, Worst};
use crate::kernel::lanes::numbers::{BLOCK, Backend, Plane, Planes, planes};
use crate::kernel::lanes::solve::{FindStances, Preference, Stances, flag};
use crate::kernel::lanes::whole::{WholeAnswers, WholeModel};
use crate::kernel::question::{BranchChoice, Question};
use crate::robot::inverse::OrthoParallel;
use crate::robot::{Branch, BranchPattern, Wrist};

/// Points in a block.
pub(in crate::kernel) const POINTS: usize = BLOCK;

/// Answers a block of points; one per thread.
pub(in crate::kernel) struct Points<'q> {
    question: &'q Question<'q>,
    batch: Batch<f64>,
    room: Box<Room>,
    /// For models with more than the drives.
    whole: Option<Box<Whole>>,
}

/// A whole model, its answers and the best posture so far.
struct Whole {
    model: WholeModel,
    answers: WholeAnswers,
    /// Two directions across the normal, then the normal, base.
    plane: [Vector3<f64>; 3],
    /// Of the best posture: joint positions, margin to the limits and its joint, flip.
    joints: Planes<f64, 6>,
    limits: Planes<f64, 3>,
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
    /// For an arm whose model is supported: only drives, or [`WholeModel`].
    pub fn new(question: &'q Question<'q>, arm: &OrthoParallel, whole: Option<WholeModel>) -> Points<'q> {
        let [first, second] = both_across(&question.normal);
        Points {
            question,
            whole: whole.map(|model| {
                Box::new(Whole {
                    answers: WholeAnswers::with(question.cases.len(), model.contributors()),
                    model,
                    plane: [first, second, question.normal.into_inner()],
                    joints: planes(),
                    limits: planes(),
                })
            }),
            batch: Batch::new(question, arm, Backend::fastest()),
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
                worst: Worst {
                    in_plane: [0.0; BLOCK],
                    normal: [0.0; BLOCK],
                    full: [0.0; BLOCK],
                    case: [0.0; BLOCK],
                    components: planes(),
                    wrench: planes(),
                },
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
                match self.whole.take() {
                    None => self.choose_least_envelope(),
                    Some(mut whole) => {
                        self.choose_least_whole(&mut whole);
                        self.whole = Some(whole);
                    }
                }
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
        let Some(whole) = &mut self.whole else {
            self.deviate();
            return;
        };
        let Whole {
            model,
            answers,
            plane,
            joints,
            limits,
        } = &mut **whole;
        let stances = &mut self.room.stances;
        if self.question.choice == BranchChoice::Best {
            stances.joints.clone_from(joints);
            let [room, joint, flip] = limits;
            stances.room.clone_from(room);
            stances.joint.clone_from(joint);
            stances.flip.clone_from(flip);
        }
        model.set_joints(&stances.joints);
        model.answer(self.question.cases, plane, &self.question.uncertainty, answers);
    }

    /// Fills the slots of the solved points. Returns for each point whether lanes decide it; slots of the other points
    /// have no evaluation and unspecified numbers.
    pub fn write(&self, slots: &mut Slots<'_>) -> [bool; POINTS] {
        let room = &*self.room;
        let (worst, uncertainty) = match &self.whole {
            Some(whole) => (&whole.answers.worst, &whole.answers.uncertainty),
            None => (&room.worst, &room.uncertainty),
        };
        let (deviations, shares) = match &self.whole {
            Some(whole) => (&whole.answers.deviations, whole.answers.shares.as_slice()),
            None => (&room.deviations, room.shares.as_slice()),
        };
        let SolvedBlock { postures, .. } = self.batch.solved();
        let solved = SolvedAnswers {
            flags: &postures.flags,
            stances: &room.stances,
            chosen: &room.chosen,
            score: &room.score,
            worst,
            uncertainty,
            deviations,
            shares,
            inside_limits: self.question.choice == BranchChoice::Best,
        };
        solved.write(slots)
    }

    /// Selects, of the postures inside limits, the first with the smallest envelope of the whole model. Points where a
    /// posture is undecided get none.
    fn choose_least_whole(&mut self, whole: &mut Whole) {
        self.room.score.fill(f64::INFINITY);
        self.batch.orient(Second::AtZero);
        let mut undecided = [false; BLOCK];
        for signs in FOUR {
            self.batch.solve(signs, false);
            for wrist in [Wrist::NoFlip, Wrist::Flip] {
                self.set_stance(preference(BranchPattern {
                    wrist: Some(wrist),
                    ..BranchPattern::default()
                }));
                let Whole {
                    model,
                    answers,
                    plane,
                    joints,
                    limits,
                } = whole;
                let SolvedBlock { postures, .. } = self.batch.solved();
                let Room {
                    stances,
                    chosen,
                    score,
                    ..
                } = &mut *self.room;
                model.set_joints(&stances.joints);
                model.envelope(self.question.cases, plane, answers);
                for i in 0..BLOCK {
                    let flags = postures.flags[i] as u32;
                    let reached = flags & flag::UNREACHABLE == 0;
                    undecided[i] |= reached && flags & flag::WRIST_UNDECIDED != 0;
                    let least = answers.worst.in_plane[i] < score[i] * (1.0 - ALIKE);
                    if reached && stances.room[i] >= -AT_LIMIT && least {
                        score[i] = answers.worst.in_plane[i];
                        (chosen[0][i], chosen[1][i]) = (signs[0], signs[1]);
                        for (kept, joint) in joints.iter_mut().zip(&stances.joints) {
                            kept[i] = joint[i];
                        }
                        limits[0][i] = stances.room[i];
                        limits[1][i] = stances.joint[i];
                        limits[2][i] = stances.flip[i];
                    }
                }
            }
        }
        for (score, undecided) in self.room.score.iter_mut().zip(undecided) {
            if undecided {
                *score = f64::INFINITY;
            }
        }
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
