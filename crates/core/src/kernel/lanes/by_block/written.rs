//! Answers of a solved block, copied from planes to the slots of its points.

use nalgebra::Vector3;

use crate::kernel::answer::{Evaluation, Slots};
use crate::kernel::lanes::geometry::UNLIMITED;
use crate::kernel::lanes::load::Worst;
use crate::numbers::{BLOCK, Plane, Planes};
use crate::robot::{Branch, PostureName, Singularity};

/// Margins at least this large are those of joints without limits, rad.
pub(super) const NO_LIMIT: f64 = 0.5 * UNLIMITED;

/// Answers of a solved block.
pub(super) struct SolvedAnswers<'a> {
    /// Joint positions, rad.
    pub joints: &'a [Plane<f64>],
    /// Smallest distance to a joint limit, and the joint.
    pub margin: &'a Plane<f64>,
    pub nearest: &'a Plane<f64>,
    pub worst: &'a Worst<f64>,
    /// Standard uncertainty of the largest in-plane deviation, m; none where it is not known.
    pub uncertainty: Option<&'a Plane<f64>>,
    /// Of each load case, m, base.
    pub deviations: &'a [Planes<f64, 3>],
    pub shares: &'a [Plane<f64>],
}

impl SolvedAnswers<'_> {
    /// Fills the slots; `posture` gives the branch of a point and the singularity that it is near to, or none where
    /// lanes cannot decide. Returns for each point whether lanes decide it; slots of the other points have no
    /// evaluation and unspecified numbers.
    pub fn write(
        &self,
        slots: &mut Slots<'_>,
        posture: impl Fn(usize) -> Option<(Branch, Option<Singularity>)>,
    ) -> [bool; BLOCK] {
        let mut decided = [false; BLOCK];
        for (i, (point, decided)) in slots.points.iter_mut().zip(&mut decided).enumerate() {
            if let Some((branch, singularity)) = posture(i) {
                *decided = true;
                *point = Ok(self.evaluation(i, branch, singularity));
            }
        }
        interleave(self.joints, slots.joints);
        interleave(self.shares, slots.shares);
        for (case, [x, y, z]) in self.deviations.iter().enumerate() {
            let rows = slots.deviations.chunks_exact_mut(self.deviations.len());
            for (row, ((x, y), z)) in rows.zip(x.iter().zip(y).zip(z)) {
                row[case] = Vector3::new(*x, *y, *z);
            }
        }
        decided
    }

    fn evaluation(&self, index: usize, branch: Branch, singularity: Option<Singularity>) -> Evaluation {
        let worst = self.worst;
        let limited = self.margin[index] < NO_LIMIT;
        Evaluation {
            name: PostureName::Branch(branch),
            limit_margin: if limited {
                self.margin[index]
            } else {
                f64::INFINITY
            },
            limit_joint: if limited { self.nearest[index] as usize } else { 0 },
            singularity,
            worst_case: worst.case[index] as usize,
            in_plane: worst.in_plane[index],
            in_plane_uncertainty: self.uncertainty.map(|plane| plane[index]),
            normal: worst.normal[index],
            full: worst.full[index],
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
