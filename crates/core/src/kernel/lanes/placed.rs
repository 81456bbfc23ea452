//! A path that lies on a part, judged in many places of the part: what a search for a placement asks.
//!
//! The points are held in the part's axes, a plane a number, and stay as they are; what changes from place to place is where
//! the arm stands as the part sees it. So a place costs the kernels alone.
//!
//! | of the points | shared by all | of each |
//! |---|---|---|
//! | orientation of the tool | solved once a place | a rotation a point |
//! | directions that count | turned once a place | turned into the arm's axes a point |
//! | wrenches | turned once a place | the rows of the compliance are turned to them |

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::aims;
use super::arm::Arm;
use super::backend::{Backend, Work};
use super::batch::{Batch, Scratch};
use super::block::{Aims, BLOCK, Plane, Planes, aim, planes, put, vector};
use super::envelope::lanes_of;
use super::flexibility::Flexibility;
use super::limits::CosineLimits;
use super::prepared::Prepared;
use super::real::Real;
use super::screws::Screws;
use super::solve::{Links, Postures, Solved, flag};
use super::steps::{FOUR, Second};
use super::vector::Vector;
use crate::kernel::placed::{Keeping, Lie, Pushes, Sighted, ToldIn};
use crate::kernel::question::Question;
use crate::robot::inverse::OrthoParallel;
use crate::spatial::Wrench;

/// What a posture that differs in more than the wrist's flip makes of the points.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::kernel) struct Tallied {
    /// Points where it does not stand: plain, and with the wrist flipped.
    pub lost: [usize; 2],
    /// Largest deviation that counts, m.
    pub worst: f64,
    /// Sum of them, m.
    pub sum: f64,
    /// Sum of what is above the limit, m.
    pub above: f64,
}

/// The points of a path in planes, and what pushes there.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Laid {
    count: usize,
    at: Vec<Planes<f64, 3>>,
    /// Empty where all are `still`.
    rotations: Vec<Planes<f64, 9>>,
    still: Matrix3<f64>,
    /// Empty where all are those of `steady`.
    along: Vec<Planes<f64, 6>>,
    steady: [Vector3<f64>; 2],
    told_in: ToldIn,
    cases: usize,
    /// Force and moment, case after case in each block; empty where all points share `cases_of_all`.
    wrenches: Vec<Planes<f64, 6>>,
    cases_of_all: Vec<Wrench>,
    moments: bool,
}

/// Judges places of a path; one a thread.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Placer {
    batch: Batch<f64>,
    /// The arm as the robot's base sees it.
    standing: Arm,
    /// Where the limits told by cosines want axis 5, tool axes.
    middle: Option<Vector3<f64>>,
    rows: Box<Planes<f64, 12>>,
    /// Least squared sine of the wrist's bend.
    bend2: f64,
    /// Deviations above it are summed, m.
    limit: f64,
}

impl Placer {
    /// For an arm of this form, which keeps away from its limits as `keeping` says.
    pub fn new(question: &Question<'_>, form: &OrthoParallel, keeping: &Keeping) -> Placer {
        let mut batch = Batch::new(question, form, Backend::fastest());
        let prepared = &mut batch.prepared;
        prepared.arm.keep_away(keeping.margin);
        prepared.cosines = CosineLimits::new(&prepared.arm);
        // The part is seldom turned as the arm is.
        prepared.turned = true;
        Placer {
            standing: prepared.arm.clone(),
            middle: prepared.cosines.as_ref().map(|cosines| cosines.tool_middle),
            batch,
            rows: Box::new(planes()),
            bend2: keeping.wrist.max(keeping.margin).sin().powi(2),
            limit: keeping.limit,
        }
    }

    /// What each of front elbow-up, front elbow-down, back elbow-up and back elbow-down makes of the points where the part
    /// lies so; goes on after a block with those that `worth` says yes to.
    pub fn judge(
        &mut self,
        laid: &Laid,
        lie: &Lie,
        mut worth: impl FnMut(usize, &Tallied) -> bool,
    ) -> [Tallied; 4] {
        self.stand(laid, lie);
        let still = laid.rotations.is_empty();
        let mut tallied = [Tallied::default(); 4];
        let mut open = std::array::from_fn(|four| worth(four, &tallied[four]));
        for (block, at) in laid.at.iter().enumerate() {
            if open == [false; 4] {
                break;
            }
            self.batch.place(at.each_ref());
            if let Some(rotations) = laid.rotations.get(block) {
                self.batch.scratch.rotations = *rotations;
                self.batch.orient(Second::InTheMiddle);
            }
            let used = BLOCK.min(laid.count - block * BLOCK);
            let mut reached = None;
            for four in (0..FOUR.len()).filter(|four| open[*four]) {
                let signs = FOUR[four];
                self.batch.solve_after(reached == Some(signs[0]), signs, still);
                reached = Some(signs[0]);
                self.batch.limit(still);
                self.weigh(laid, block);
                let Scratch {
                    postures, in_plane, ..
                } = &*self.batch.scratch;
                self.batch.backend.run(Tally {
                    postures,
                    deviation: in_plane,
                    used,
                    bend2: self.bend2,
                    limit: self.limit,
                    out: &mut tallied[four],
                });
            }
            open = std::array::from_fn(|four| open[four] && worth(four, &tallied[four]));
        }
        tallied
    }

    /// The least deviation at each point, of all turns of the tool and all branches that are open, into `least`; infinite where
    /// none stands.
    pub fn least_of_each(
        &mut self,
        laid: &Laid,
        (lie, spins): (&Lie, &[f64]),
        open: [bool; 8],
        least: &mut Vec<f64>,
    ) {
        let still = laid.rotations.is_empty();
        least.clear();
        for (block, at) in laid.at.iter().enumerate() {
            let mut best = [f64::INFINITY; BLOCK];
            for spin in spins {
                let turned = Lie {
                    spin: lie.spin + spin,
                    ..*lie
                };
                self.stand(laid, &turned);
                self.batch.place(at.each_ref());
                if let Some(rotations) = laid.rotations.get(block) {
                    self.batch.scratch.rotations = *rotations;
                    self.batch.orient(Second::InTheMiddle);
                }
                let mut reached = None;
                for four in (0..FOUR.len()).filter(|four| open[2 * four] || open[2 * four + 1]) {
                    let signs = FOUR[four];
                    self.batch.solve_after(reached == Some(signs[0]), signs, still);
                    reached = Some(signs[0]);
                    self.batch.limit(still);
                    self.weigh(laid, block);
                    let Scratch {
                        postures, in_plane, ..
                    } = &*self.batch.scratch;
                    self.batch.backend.run(Lesser {
                        postures,
                        deviation: in_plane,
                        open: [open[2 * four], open[2 * four + 1]],
                        bend2: self.bend2,
                        best: &mut best,
                    });
                }
            }
            let used = BLOCK.min(laid.count - block * BLOCK);
            least.extend_from_slice(&best[..used]);
        }
    }

    /// Lets the arm stand as a part that lies so sees it.
    fn stand(&mut self, laid: &Laid, lie: &Lie) {
        let prepared = &mut self.batch.prepared;
        let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), lie.spin);
        prepared.arm.arm_from_base = self.standing.arm_from_base * lie.base_from_part;
        prepared.arm.lever = spin * self.standing.lever;
        prepared.arm.tool_from_axis_6 = spin * self.standing.tool_from_axis_6;
        prepared.arm.tool_from_axis_5 = spin * self.standing.tool_from_axis_5;
        if let (Some(cosines), Some(middle)) = (&mut prepared.cosines, self.middle) {
            cosines.tool_middle = spin * middle;
        }
        let from_part = prepared.arm.arm_from_base_rotation();
        let from_told = told_axes(laid.told_in, &from_part, &self.standing);
        prepared.cases.clear();
        let turned = |w: &Wrench| [from_told * w.force, from_told * w.moment];
        prepared.cases.extend(laid.cases_of_all.iter().map(turned));
        prepared.moments = laid.moments;
        let [first, second] = laid.steady.map(|along| from_part * along);
        prepared.plane = [first, second, Vector3::zeros()];
        if laid.rotations.is_empty() {
            let second = match &prepared.cosines {
                Some(cosines) => cosines.tool_middle,
                None => prepared.arm.tool_from_axis_5,
            };
            aims::still(prepared, &laid.still, &second, &mut self.batch.scratch.aims);
        }
    }

    /// Deviation that counts at the points of the solved block, into the scratch.
    fn weigh(&mut self, laid: &Laid, block: usize) {
        let still = laid.rotations.is_empty();
        let batch = &mut self.batch;
        if laid.along.is_empty() && laid.wrenches.is_empty() {
            batch.largest(still, None);
            return;
        }
        let prepared = &batch.prepared;
        let Scratch {
            aims,
            postures,
            in_plane,
            ..
        } = &mut *batch.scratch;
        let steady;
        let along = match laid.along.get(block) {
            Some(along) => along,
            None => {
                steady = filled(|_| six(laid.steady));
                &steady
            }
        };
        let arm_from_part = prepared.arm.arm_from_base_rotation();
        let rows = &mut *self.rows;
        macro_rules! rows_of_each {
            ($still:literal, $moments:literal) => {
                batch.backend.run(RowsOfEach::<$still, $moments> {
                    prepared,
                    arm_from_part: &arm_from_part,
                    along,
                    aims,
                    postures,
                    rows,
                })
            };
        }
        match (still, prepared.moments) {
            (true, false) => rows_of_each!(true, false),
            (true, true) => rows_of_each!(true, true),
            (false, false) => rows_of_each!(false, false),
            (false, true) => rows_of_each!(false, true),
        }
        let shared: Vec<Planes<f64, 6>>;
        let wrenches = match laid.wrenches.is_empty() {
            false => &laid.wrenches[block * laid.cases..][..laid.cases],
            true => {
                let planes_of = |w: &Wrench| filled(|_| six([w.force, w.moment]));
                shared = laid.cases_of_all.iter().map(planes_of).collect();
                &shared
            }
        };
        batch.backend.run(LargestOfEach {
            told_from_arm: &told_axes(laid.told_in, &arm_from_part, &self.standing).transpose(),
            moments: prepared.moments,
            wrenches,
            rows,
            deviation: in_plane,
        });
    }
}

/// Axes that wrenches are told in, in the arm's.
fn told_axes(told: ToldIn, arm_from_part: &Matrix3<f64>, standing: &Arm) -> Matrix3<f64> {
    match told {
        ToldIn::Part => *arm_from_part,
        ToldIn::Base => standing.arm_from_base_rotation(),
    }
}

impl Laid {
    /// These points under what pushes there.
    pub fn new(points: &[Sighted], pushes: &Pushes) -> Laid {
        let rotation = |point: &Sighted| *point.part_from_tool.rotation.to_rotation_matrix().matrix();
        let still = points.first().map_or_else(Matrix3::identity, rotation);
        let steady = points.first().map_or([Vector3::zeros(); 2], |point| point.along);
        let is_still = points.iter().all(|point| rotation(point) == still);
        let is_steady = points.iter().all(|point| point.along == steady);
        let of_all = pushes.wrenches.len() == pushes.cases;
        let mut laid = Laid {
            count: points.len(),
            at: Vec::new(),
            rotations: Vec::new(),
            still,
            along: Vec::new(),
            steady,
            told_in: pushes.told_in,
            cases: pushes.cases,
            wrenches: Vec::new(),
            cases_of_all: if of_all {
                pushes.wrenches.clone()
            } else {
                Vec::new()
            },
            moments: pushes.wrenches.iter().any(|w| w.moment != Vector3::zeros()),
        };
        for (block, points) in points.chunks(BLOCK).enumerate() {
            // The rest of a block repeats its last point.
            let last = points.len() - 1;
            let point = |i: usize| &points[i.min(last)];
            laid.at
                .push(filled(|i| point(i).part_from_tool.translation.vector.into()));
            if !is_still {
                // Columns of the transpose are rows of the rotation.
                let rows = |i: usize| rotation(point(i)).transpose();
                laid.rotations.push(filled(|i| {
                    let rows = rows(i);
                    std::array::from_fn(|k| rows[k])
                }));
            }
            if !is_steady {
                laid.along.push(filled(|i| six(point(i).along)));
            }
            for case in 0..if of_all { 0 } else { pushes.cases } {
                let wrench = |i: usize| pushes.wrenches[(block * BLOCK + i.min(last)) * pushes.cases + case];
                laid.wrenches
                    .push(filled(|i| six([wrench(i).force, wrench(i).moment])));
            }
        }
        laid
    }
}

fn six([a, b]: [Vector3<f64>; 2]) -> [f64; 6] {
    [a.x, a.y, a.z, b.x, b.y, b.z]
}

fn filled<const N: usize>(of: impl Fn(usize) -> [f64; N]) -> Planes<f64, N> {
    let mut all: Planes<f64, N> = planes();
    for i in 0..BLOCK {
        for (plane, value) in all.iter_mut().zip(of(i)) {
            plane[i] = value;
        }
    }
    all
}

/// Rows of the compliance along the directions of each point, arm axes.
struct RowsOfEach<'a, const STILL: bool, const MOMENTS: bool> {
    prepared: &'a Prepared,
    arm_from_part: &'a Matrix3<f64>,
    /// Two directions, part axes.
    along: &'a Planes<f64, 6>,
    aims: &'a Aims<f64>,
    postures: &'a Postures<f64>,
    rows: &'a mut Planes<f64, 12>,
}

impl<const STILL: bool, const MOMENTS: bool> Work<f64> for RowsOfEach<'_, STILL, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let turn = Turn::<R>::new(self.arm_from_part);
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, STILL>(self.aims, i);
            let solved = Solved::load(self.postures, i);
            let screws = Screws::new(&links, &aim, &solved);
            let flexibility = Flexibility::new::<MOMENTS>(&screws, &compliance);
            let first = turn.of(vector(&self.along[0..3], i));
            let second = turn.of(vector(&self.along[3..6], i));
            put(&mut self.rows[0..3], i, flexibility.times(first));
            put(&mut self.rows[3..6], i, flexibility.times(second));
            if MOMENTS {
                put(&mut self.rows[6..9], i, flexibility.transposed_d_times(first));
                put(&mut self.rows[9..12], i, flexibility.transposed_d_times(second));
            }
        }
    }
}

/// The largest deviation of the wrenches of each point.
struct LargestOfEach<'a> {
    told_from_arm: &'a Matrix3<f64>,
    moments: bool,
    /// Case after case.
    wrenches: &'a [Planes<f64, 6>],
    /// Turned to the axes of the wrenches on the way.
    rows: &'a mut Planes<f64, 12>,
    deviation: &'a mut Plane<f64>,
}

impl Work<f64> for LargestOfEach<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let turn = Turn::<R>::new(self.told_from_arm);
        let used = if self.moments { 4 } else { 2 };
        let mut row = 0;
        while row < used {
            let planes = &mut self.rows[3 * row..3 * row + 3];
            for i in 0..BLOCK {
                R::step();
                put(planes, i, turn.of(vector::<R>(planes, i)));
            }
            row += 1;
        }
        self.deviation.fill(0.0);
        for wrench in self.wrenches {
            for i in 0..BLOCK {
                R::step();
                let force = vector::<R>(&wrench[0..3], i);
                let mut a = vector::<R>(&self.rows[0..3], i).dot(force);
                let mut b = vector::<R>(&self.rows[3..6], i).dot(force);
                if self.moments {
                    let moment = vector::<R>(&wrench[3..6], i);
                    a = a + vector::<R>(&self.rows[6..9], i).dot(moment);
                    b = b + vector::<R>(&self.rows[9..12], i).dot(moment);
                }
                let square = a.mul_add(a, b * b);
                let before = R::load(self.deviation[i]);
                self.deviation[i] = R::either(square > before, square, before).store();
            }
        }
        for i in 0..BLOCK {
            R::step();
            self.deviation[i] = R::load(self.deviation[i]).sqrt().store();
        }
    }
}

/// A rotation in every lane.
#[derive(Clone, Copy)]
struct Turn<R> {
    rows: [Vector<R>; 3],
}

impl<R: Real> Turn<R> {
    #[inline(always)]
    fn new(m: &Matrix3<f64>) -> Self {
        let row = |k: usize| Vector::new(R::of(m[(k, 0)]), R::of(m[(k, 1)]), R::of(m[(k, 2)]));
        Turn {
            rows: [row(0), row(1), row(2)],
        }
    }

    #[inline(always)]
    fn of(&self, v: Vector<R>) -> Vector<R> {
        Vector::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }
}

/// Keeps the lesser deviation of each point, where a posture stands plain or flipped.
struct Lesser<'a> {
    postures: &'a Postures<f64>,
    deviation: &'a Plane<f64>,
    /// Whether the plain posture and the flipped one may be taken.
    open: [bool; 2],
    bend2: f64,
    best: &'a mut Plane<f64>,
}

impl Work<f64> for Lesser<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let limits = [flag::OUTSIDE_LIMITS, flag::OUTSIDE_LIMITS_FLIPPED];
        let [plain, flipped] = limits.map(|limit| (NEVER | limit) as i32);
        let (flags, bend2) = (&self.postures.flags, self.postures.bend2());
        for i in 0..BLOCK {
            R::step();
            let bits = flags[i] as i32;
            let stands = (((bits & plain) == 0) & self.open[0]) | (((bits & flipped) == 0) & self.open[1]);
            let counts = stands & (bend2[i] >= self.bend2) & (self.deviation[i] < self.best[i]);
            self.best[i] = if counts { self.deviation[i] } else { self.best[i] };
        }
    }
}

/// A posture so flagged stands in no case.
const NEVER: u32 = flag::UNREACHABLE | flag::WRIST_UNDECIDED | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;

/// Adds a block to what is told of a posture.
struct Tally<'a> {
    postures: &'a Postures<f64>,
    deviation: &'a Plane<f64>,
    used: usize,
    bend2: f64,
    limit: f64,
    out: &'a mut Tallied,
}

/// Sums are taken this many at a time, always the same ones together.
const SIDE: usize = 16;

impl Work<f64> for Tally<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let never = NEVER as i32;
        let (plain, flipped) = (flag::OUTSIDE_LIMITS as i32, flag::OUTSIDE_LIMITS_FLIPPED as i32);
        let mut lost = [[0_i32; SIDE]; 2];
        let (mut worst, mut sum, mut above) = ([0.0; SIDE], [0.0; SIDE], [0.0; SIDE]);
        let (flags, bend2) = (&self.postures.flags, self.postures.bend2());
        for first in (0..BLOCK).step_by(SIDE) {
            for k in 0..SIDE {
                R::step();
                let i = first + k;
                let here = i < self.used;
                let bits = flags[i] as i32;
                let bent = bend2[i] >= self.bend2;
                let stands = ((bits & never) == 0) & bent;
                lost[0][k] += i32::from(here & !(stands & ((bits & plain) == 0)));
                lost[1][k] += i32::from(here & !(stands & ((bits & flipped) == 0)));
                let counts = here & stands;
                let deviation = if counts { self.deviation[i] } else { 0.0 };
                worst[k] = if deviation > worst[k] { deviation } else { worst[k] };
                sum[k] += deviation;
                let more = deviation - self.limit;
                above[k] += if more > 0.0 { more } else { 0.0 };
            }
        }
        for flip in 0..2 {
            self.out.lost[flip] += lost[flip].iter().sum::<i32>() as usize;
        }
        self.out.worst = worst.iter().copied().fold(self.out.worst, f64::max);
        self.out.sum += sum.iter().sum::<f64>();
        self.out.above += above.iter().sum::<f64>();
    }
}
