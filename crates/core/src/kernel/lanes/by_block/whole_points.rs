//! Whole answers of arms and models that need more than the drives-only lanes, a block of points at a time: all named
//! branches, and the whole model.

use nalgebra::Vector3;

use super::written::{NO_LIMIT, SolvedAnswers};
use crate::frame::{Isometry, both_across};
use crate::kernel::answer::{ALIKE, AT_LIMIT, AnswerDetail, Slots};
use crate::kernel::lanes::branches::{BranchPlanes, BranchSolver, find_missed, singularity, state};
use crate::kernel::lanes::whole::{WholeAnswers, WholeModel};
use crate::kernel::question::{BranchChoice, Question};
use crate::numbers::{BLOCK, Backend, Plane};
use crate::robot::Branch;

/// Answers a block of points; one per thread.
pub(in crate::kernel) struct WholePoints<'q> {
    question: &'q Question<'q>,
    backend: Backend,
    tool_from_flange: Isometry,
    branches: BranchSolver,
    model: WholeModel,
    uncertainty_is_known: bool,
    answers: WholeAnswers,
    /// Two directions across the normal, then the normal, base.
    plane: [Vector3<f64>; 3],
    best: Best,
    /// Whether a flip changes nothing but the margins.
    flips_are_alike: bool,
    missed: Plane<f64>,
}

/// The best branch of each point so far.
struct Best {
    posture: BranchPlanes,
    /// Index of the branch.
    branch: [u8; BLOCK],
    /// Infinite where there is none.
    score: Plane<f64>,
}

impl<'q> WholePoints<'q> {
    /// For this question, with backlash and geometry where shares are computed; none if its arm has no named branches,
    /// or a part that lanes do not know.
    pub fn of(question: &'q Question<'q>, detail: AnswerDetail) -> Option<WholePoints<'q>> {
        let backend = Backend::fastest();
        let model = match detail {
            AnswerDetail::Shares => WholeModel::of(&question.arm, backend)?,
            AnswerDetail::DeviationsAlone => WholeModel::by_load(&question.arm, backend)?,
        };
        let by_load_alone =
            detail == AnswerDetail::DeviationsAlone || !question.arm.model.has_unloaded_deviation();
        let [first, second] = both_across(&question.normal);
        let branches = BranchSolver::of(question, backend)?;
        // The best posture outside the range of a rail has none: the reason is stated one point after the other.
        if question.choice == BranchChoice::Best && !branches.rail_is_inside() {
            return None;
        }
        Some(WholePoints {
            question,
            backend,
            tool_from_flange: question.arm.flange_from_tool.inverse(),
            branches,
            answers: WholeAnswers::with(question.cases.len(), model.contributors()),
            model,
            uncertainty_is_known: question.arm.has_known_uncertainty(),
            plane: [first, second, question.normal.into_inner()],
            best: Best {
                posture: BranchPlanes::of(question.arm.robot.joints().len()),
                branch: [0; BLOCK],
                score: [f64::INFINITY; BLOCK],
            },
            flips_are_alike: question.arm.model.is_drives_alone()
                && by_load_alone
                && question.arm.robot.inverse().flips_are_alike(),
            missed: [0.0; BLOCK],
        })
    }

    /// Computes the answers at these poses, at most a block; [`WholePoints::write`] copies them.
    pub fn solve(&mut self, poses: &[Isometry]) {
        self.branches.aim_at(poses, &self.tool_from_flange);
        self.best.score.fill(f64::INFINITY);
        self.best.posture.state.fill(state::UNREACHED);
        match self.question.choice {
            BranchChoice::Best => {
                for (index, branch) in Branch::ALL.into_iter().enumerate() {
                    self.take_less(index, branch);
                }
            }
            BranchChoice::Of(pattern) => {
                let matching = Branch::ALL.into_iter().enumerate();
                for (index, branch) in matching.filter(|(_, branch)| pattern.matches(*branch)) {
                    self.take_roomier(index, branch);
                }
            }
        }
        self.count_rail();
        self.model.set_joints(&self.best.posture.joints);
        self.verify();
        self.model.answer(
            self.question.cases,
            &self.plane,
            &self.question.uncertainty,
            &mut self.answers,
        );
    }

    /// Takes this branch where it is inside the limits and its envelope is smaller than that of the best so far; of two
    /// flips that are alike the one with the larger margin.
    fn take_less(&mut self, index: usize, branch: Branch) {
        let found = self.branches.solve(branch);
        if found.state.iter().all(|state| *state == state::UNREACHED) {
            return;
        }
        self.model.set_joints(&found.joints);
        self.model
            .envelope(self.question.cases, &self.plane, &mut self.answers);
        let (in_plane, best) = (&self.answers.worst.in_plane, &mut self.best);
        for i in 0..BLOCK {
            let reached = found.state[i] == state::REACHED;
            let unknown = reached && !self.model.is_stable(i);
            best.undecided(if unknown { state::UNDECIDED } else { found.state[i] }, i);
            let flips_the_best = index % 2 == 1 && usize::from(best.branch[i]) == index - 1;
            let less = if self.flips_are_alike && flips_the_best && best.score[i].is_finite() {
                found.margin[i].min(NO_LIMIT) > best.posture.margin[i].min(NO_LIMIT)
            } else {
                in_plane[i] < best.score[i] * (1.0 - ALIKE)
            };
            if reached && found.margin[i] >= -AT_LIMIT && less {
                best.take(index, in_plane[i], found, i);
            }
        }
    }

    /// Takes this branch where its margin to the limits is larger than that of the best so far.
    fn take_roomier(&mut self, index: usize, branch: Branch) {
        let found = self.branches.solve(branch);
        for i in 0..BLOCK {
            self.best.undecided(found.state[i], i);
            let score = -found.margin[i].min(NO_LIMIT);
            if found.state[i] == state::REACHED && score < self.best.score[i] {
                self.best.take(index, score, found, i);
            }
        }
    }

    /// Takes the joints of a rail into the margins of the chosen postures.
    fn count_rail(&mut self) {
        let BranchPlanes { margin, nearest, .. } = &mut self.best.posture;
        let first = self.branches.first();
        for nearest in nearest.iter_mut() {
            *nearest += first as f64;
        }
        if let Some((joint, of_rail)) = self.branches.rail_margin() {
            for (margin, nearest) in margin.iter_mut().zip(nearest) {
                if of_rail <= *margin {
                    (*margin, *nearest) = (of_rail, joint as f64);
                }
            }
        }
    }

    /// Makes points undecided that forward kinematics does not confirm.
    fn verify(&mut self) {
        self.backend.run(find_missed(
            self.branches.targets(),
            self.model.flange(),
            &mut self.missed,
        ));
    }

    /// Fills the slots of the solved points, as `Points::write` does.
    pub fn write(&self, slots: &mut Slots<'_>) -> [bool; BLOCK] {
        let Best {
            posture,
            branch,
            score,
        } = &self.best;
        let solved = SolvedAnswers {
            joints: &posture.joints,
            margin: &posture.margin,
            nearest: &posture.nearest,
            worst: &self.answers.worst,
            uncertainty: self.uncertainty_is_known.then_some(&self.answers.uncertainty),
            deviations: &self.answers.deviations,
            shares: &self.answers.shares,
        };
        solved.write(slots, |i| {
            let known = self.missed[i] == 0.0 && self.model.is_stable(i);
            let decided = posture.state[i] == state::REACHED && score[i].is_finite() && known;
            decided.then(|| {
                let branch = Branch::ALL[usize::from(branch[i])];
                (branch, singularity(posture.singularity[i]))
            })
        })
    }
}

impl Best {
    /// Notes that a branch is undecided at point `i`: no other is the best then.
    fn undecided(&mut self, found: f64, i: usize) {
        if found == state::UNDECIDED {
            self.score[i] = f64::NEG_INFINITY;
            self.posture.state[i] = state::UNDECIDED;
        }
    }

    fn take(&mut self, branch: usize, score: f64, found: &BranchPlanes, i: usize) {
        self.score[i] = score;
        self.branch[i] = branch as u8;
        self.posture.take(found, i);
    }
}
