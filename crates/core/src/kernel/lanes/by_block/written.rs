//! Answers of a solved block, copied from planes to the slots of its points.

use nalgebra::Vector3;

use crate::kernel::answer::{AT_LIMIT, Evaluation, Slots};
use crate::kernel::lanes::geometry::UNLIMITED;
use crate::kernel::lanes::load::Worst;
use crate::kernel::lanes::numbers::{BLOCK, Plane, Planes};
use crate::kernel::lanes::solve::{Stances, flag};
use crate::robot::{Branch, Elbow, PostureName, Shoulder, Singularity, Wrist};

/// Answers of a solved block.
pub(super) struct SolvedAnswers<'a> {
    /// Bits of [`flag`].
    pub flags: &'a Plane<f64>,
    pub stances: &'a Stances<f64>,
    /// Signs of the selected posture and its score; infinite where there is none.
    pub chosen: &'a Planes<f64, 2>,
    pub score: &'a Plane<f64>,
    pub worst: &'a Worst<f64>,
    /// Standard uncertainty of the largest in-plane deviation, m.
    pub uncertainty: &'a Plane<f64>,
    /// Of each load case, m, base.
    pub deviations: &'a [Planes<f64, 3>],
    pub shares: &'a [Plane<f64>],
    /// Whether postures were selected inside their limits.
    pub inside_limits: bool,
}

impl SolvedAnswers<'_> {
    /// Fills the slots. Returns for each point whether lanes decide it; slots of the other points have no evaluation and
    /// unspecified numbers.
    pub fn write(&self, slots: &mut Slots<'_>) -> [bool; BLOCK] {
        let mut decided = [false; BLOCK];
        for (i, (point, decided)) in slots.points.iter_mut().zip(&mut decided).enumerate() {
            *decided = self.is_decided(i);
            if *decided {
                *point = Ok(self.evaluation(i));
            }
        }
        interleave(&self.stances.joints, slots.joints);
        interleave(self.shares, slots.shares);
        for (case, [x, y, z]) in self.deviations.iter().enumerate() {
            let rows = slots.deviations.chunks_exact_mut(self.deviations.len());
            for (row, ((x, y), z)) in rows.zip(x.iter().zip(y).zip(z)) {
                row[case] = Vector3::new(*x, *y, *z);
            }
        }
        decided
    }

    fn is_decided(&self, index: usize) -> bool {
        let flags = self.flags[index] as u32;
        let unknown = flags & (flag::UNREACHABLE | flag::WRIST_UNDECIDED) != 0;
        // The envelope tested the limits by cosines; exactly at a limit the angles may differ.
        let at_the_edge = self.inside_limits && self.stances.room[index] < -AT_LIMIT;
        !(unknown || at_the_edge || self.score[index].is_infinite())
    }

    fn evaluation(&self, index: usize) -> Evaluation {
        let (stances, worst) = (self.stances, self.worst);
        let limited = stances.room[index] < 0.5 * UNLIMITED;
        Evaluation {
            name: PostureName::Branch(self.branch(index)),
            limit_margin: if limited {
                stances.room[index]
            } else {
                f64::INFINITY
            },
            limit_joint: if limited { stances.joint[index] as usize } else { 0 },
            singularity: singularity(self.flags[index] as u32),
            worst_case: worst.case[index] as usize,
            in_plane: worst.in_plane[index],
            in_plane_uncertainty: self.uncertainty[index],
            normal: worst.normal[index],
            full: worst.full[index],
        }
    }

    fn branch(&self, index: usize) -> Branch {
        Branch {
            shoulder: if self.chosen[0][index] > 0.0 {
                Shoulder::Front
            } else {
                Shoulder::Back
            },
            elbow: if self.chosen[1][index] > 0.0 {
                Elbow::Up
            } else {
                Elbow::Down
            },
            wrist: if self.stances.flip[index] > 0.0 {
                Wrist::Flip
            } else {
                Wrist::NoFlip
            },
        }
    }
}

/// Copies planes to rows, one row for each point.
fn interleave(planes: &[Plane<f64>], rows: &mut [f64]) {
    let width = planes.len();
    let (sixes, others) = planes.as_chunks::<6>();
    for (first, six) in sixes.iter().enumerate() {
        for (row, i) in rows.chunks_exact_mut(width).zip(0..BLOCK) {
            row[6 * first..][..6].copy_from_slice(&six.each_ref().map(|plane| plane[i]));
        }
    }
    for (k, plane) in others.iter().enumerate() {
        for (row, value) in rows.chunks_exact_mut(width).zip(plane) {
            row[6 * sixes.len() + k] = *value;
        }
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
