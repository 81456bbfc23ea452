//! The steps of a batch, each on its current block: aim, solve, bend, evaluate, report.
//!
//! Each hands planes of the scratch to one compiled loop; which one follows from the question.

use nalgebra::Vector3;

use super::arrays::Poses;
use super::batch::{Batch, Scratch};
use super::posture_signs::FOUR;
use crate::kernel::lanes::geometry::{Aims, CosineLimits, Orientations, Places, Second, aim_still};
use crate::kernel::lanes::load::{Compliances, Largest, Rows};
use crate::kernel::lanes::solve::{LimitsByCosines, LimitsByPositions, Position, Postures, Reach, Solve};
use crate::numbers::{BLOCK, Backend, Plane, Planes, Precision, fill, planes};

impl<T: Precision> Batch<T> {
    /// Fills the block's aims with the poses from `first` on and returns their number; the remaining lanes repeat the
    /// last.
    pub(super) fn aim(&mut self, poses: &Poses<'_, T>, first: usize, second: Second) -> usize {
        let (Poses::Still { at, .. } | Poses::Free { at, .. }) = poses;
        let used = BLOCK.min(at[0].len() - first);
        let whole = at.map(|plane| plane[first..].first_chunk());
        if let [Some(x), Some(y), Some(z)] = whole {
            self.place([x, y, z]);
        } else {
            let mut places: Planes<T, 3> = planes();
            for (plane, from) in places.iter_mut().zip(at) {
                fill(plane, &from[first..]);
            }
            self.place(places.each_ref());
        }
        match poses {
            Poses::Still { base_from_tool, .. } if first == 0 => {
                let second = self.second(second);
                aim_still(
                    &self.prepared,
                    base_from_tool.matrix(),
                    &second,
                    &mut self.scratch.aims,
                );
            }
            Poses::Still { .. } => {}
            Poses::Free { rotations, .. } => {
                for (plane, from) in self.scratch.rotations.iter_mut().zip(rotations) {
                    fill(plane, &from[first..first + used]);
                }
                self.orient(second);
            }
        }
        used
    }

    fn second(&self, second: Second) -> Vector3<f64> {
        match (second, &self.prepared.cosines) {
            (Second::InTheMiddle, Some(cosines)) => cosines.tool_middle,
            _ => self.prepared.arm.tool_from_axis_5,
        }
    }

    pub(in crate::kernel::lanes) fn place(&mut self, at: [&Plane<T>; 3]) {
        let (prepared, aims) = (&self.prepared, &mut self.scratch.aims);
        if prepared.turned {
            self.backend.run(Places::<T, true> { prepared, at, aims });
        } else {
            self.backend.run(Places::<T, false> { prepared, at, aims });
        }
    }

    /// Turns the block's rotations into its aims.
    pub(in crate::kernel::lanes) fn orient(&mut self, second: Second) {
        let second = &self.second(second);
        let Scratch { aims, rotations, .. } = &mut *self.scratch;
        let prepared = &self.prepared;
        self.backend.run(Orientations {
            prepared,
            rotations,
            second,
            aims,
        });
    }

    /// Solves the aimed block with these signs everywhere.
    pub(in crate::kernel::lanes) fn solve(&mut self, signs: [f64; 2], still: bool) {
        self.solve_after(false, signs, still);
    }

    /// Solves the aimed block for one of [`FOUR`] after the other; true where the shoulder is that of the one before.
    pub(super) fn solve_in_turn(&mut self, four: usize, still: bool) -> bool {
        let same_shoulder = four > 0 && FOUR[four - 1][0] == FOUR[four][0];
        self.solve_after(same_shoulder, FOUR[four], still);
        same_shoulder
    }

    /// Solves the aimed block with these signs everywhere; the shoulder may be that of the time before.
    pub(in crate::kernel::lanes) fn solve_after(
        &mut self,
        same_shoulder: bool,
        [shoulder, elbow]: [f64; 2],
        still: bool,
    ) {
        if !same_shoulder {
            self.sign(0, shoulder);
            self.reach(still);
        }
        self.sign(1, elbow);
        self.bend(still);
    }

    /// Solves the aimed block with the signs that its postures have.
    pub(super) fn solve_signed(&mut self, still: bool) {
        self.reach(still);
        self.bend(still);
    }

    /// Gives all postures one sign of shoulder (0) or elbow (1).
    fn sign(&mut self, which: usize, sign: f64) {
        let (plane, sign) = (&mut self.scratch.postures.signs[which], T::from_f64(sign));
        // Filled from call to call, unless the signs change.
        if plane.iter().any(|one| *one != sign) {
            plane.fill(sign);
        }
    }

    fn reach(&mut self, still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch { aims, postures, .. } = &mut *self.scratch;
        if still {
            backend.run(Reach::<T, true> {
                prepared,
                aims,
                postures,
            });
        } else {
            backend.run(Reach::<T, false> {
                prepared,
                aims,
                postures,
            });
        }
    }

    fn bend(&mut self, still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch { aims, postures, .. } = &mut *self.scratch;
        if still {
            backend.run(Solve::<T, true> {
                prepared,
                aims,
                postures,
            });
        } else {
            backend.run(Solve::<T, false> {
                prepared,
                aims,
                postures,
            });
        }
    }

    /// Envelope of the solved block, joint limits flagged; without a place to go it stays in the scratch.
    pub(super) fn envelope(&mut self, still: bool, to: Option<[&mut Plane<T>; 2]>) {
        self.limit(still);
        self.largest(still, to);
    }

    /// Flags the joint limits of the solved block, plain and flipped.
    pub(in crate::kernel::lanes) fn limit(&mut self, still: bool) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch {
            aims,
            postures,
            positions,
            ..
        } = &mut *self.scratch;
        match &prepared.cosines {
            Some(limits) if still => limit_by_cosines::<T, true>(backend, limits, aims, postures),
            Some(limits) => limit_by_cosines::<T, false>(backend, limits, aims, postures),
            None => {
                backend.run(Position {
                    prepared,
                    aims,
                    postures,
                    same_shoulder: false,
                    positions,
                });
                backend.run(LimitsByPositions { positions, postures });
            }
        }
    }

    /// Largest deviation of the load cases in the solved block; without a place to go it stays in the scratch.
    pub(in crate::kernel::lanes) fn largest(&mut self, still: bool, to: Option<[&mut Plane<T>; 2]>) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch {
            aims,
            postures,
            in_plane,
            case,
            state,
            out,
            ..
        } = &mut *self.scratch;
        let Some(rows) = out.first_chunk_mut() else { return };
        match (still, prepared.moments) {
            (true, false) => backend.run(Rows::<T, true, false> {
                prepared,
                aims,
                postures,
                rows,
            }),
            (true, true) => backend.run(Rows::<T, true, true> {
                prepared,
                aims,
                postures,
                rows,
            }),
            (false, false) => backend.run(Rows::<T, false, false> {
                prepared,
                aims,
                postures,
                rows,
            }),
            (false, true) => backend.run(Rows::<T, false, true> {
                prepared,
                aims,
                postures,
                rows,
            }),
        }
        let [in_plane, state] = to.unwrap_or([in_plane, state]);
        if prepared.moments {
            backend.run(Largest::<T, true> {
                prepared,
                rows,
                postures,
                in_plane,
                case,
                state,
            });
        } else {
            backend.run(Largest::<T, false> {
                prepared,
                rows,
                postures,
                in_plane,
                case,
                state,
            });
        }
    }

    pub(super) fn compliance(&mut self) {
        let (prepared, backend) = (&self.prepared, self.backend);
        let Scratch {
            aims, postures, out, ..
        } = &mut *self.scratch;
        let Some(out) = out.first_chunk_mut() else { return };
        if prepared.turned {
            backend.run(Compliances::<T, true> {
                prepared,
                aims,
                postures,
                out,
            });
        } else {
            backend.run(Compliances::<T, false> {
                prepared,
                aims,
                postures,
                out,
            });
        }
    }

    /// Joint positions of the solved block; joint 1 is reused for the same shoulder.
    pub(in crate::kernel::lanes) fn position(&mut self, same_shoulder: bool) {
        let Scratch {
            aims,
            postures,
            positions,
            ..
        } = &mut *self.scratch;
        let prepared = &self.prepared;
        self.backend.run(Position {
            prepared,
            aims,
            postures,
            same_shoulder,
            positions,
        });
    }
}

/// Flags the joint limits, tested by cosines.
fn limit_by_cosines<T: Precision, const STILL: bool>(
    backend: Backend,
    limits: &CosineLimits,
    aims: &Aims<T>,
    postures: &mut Postures<T>,
) {
    match (limits.swivels, limits.askew) {
        (true, true) => backend.run(LimitsByCosines::<T, STILL, true, true> {
            limits,
            aims,
            postures,
        }),
        (true, false) => backend.run(LimitsByCosines::<T, STILL, true, false> {
            limits,
            aims,
            postures,
        }),
        (false, true) => backend.run(LimitsByCosines::<T, STILL, false, true> {
            limits,
            aims,
            postures,
        }),
        (false, false) => backend.run(LimitsByCosines::<T, STILL, false, false> {
            limits,
            aims,
            postures,
        }),
    }
}
