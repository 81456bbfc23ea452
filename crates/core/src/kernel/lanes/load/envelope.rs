//! Largest in-plane deviation of all load cases for a posture: the minimum for maps and placement searches.
//!
//! First every point's 2 x 3 (with moments 2 x 6) compliance in the plane, then the cases one after the other.

use super::flexibility::Flexibility;
use crate::kernel::lanes::geometry::{Aims, Prepared, aim};
use crate::kernel::lanes::solve::{Links, Postures, Screws, Solved};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, lanes_of, put, vector};

/// Multiple of the deciding case's index in a state: the flags are below it.
pub(in crate::kernel::lanes) const CASE: u32 = 1024;

/// In-plane rows of the compliance: two for forces, two for moments.
pub(in crate::kernel::lanes) struct Rows<'a, T, const STILL: bool, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    pub rows: &'a mut Planes<T, 12>,
}

impl<T: Float, const STILL: bool, const MOMENTS: bool> Work<T> for Rows<'_, T, STILL, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        let compliance = lanes_of::<R>(&self.prepared.compliance);
        let [first, second, _] = &self.prepared.plane;
        let (first, second) = (Vector::of(first), Vector::of(second));
        for i in 0..BLOCK {
            R::step();
            let aim = aim::<R, STILL>(self.aims, i);
            let solved = Solved::load(self.postures, i);
            let screws = Screws::new(&links, &aim, &solved);
            let flexibility = Flexibility::new::<MOMENTS>(&screws, &compliance);
            put(&mut self.rows[0..3], i, flexibility.times(first));
            put(&mut self.rows[3..6], i, flexibility.times(second));
            if MOMENTS {
                put(&mut self.rows[6..9], i, flexibility.transposed_d_times(first));
                put(&mut self.rows[9..12], i, flexibility.transposed_d_times(second));
            }
        }
    }
}

/// The largest in-plane deviation of all cases, and which case decides.
pub(in crate::kernel::lanes) struct Largest<'a, T, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub rows: &'a Planes<T, 12>,
    pub postures: &'a Postures<T>,
    pub in_plane: &'a mut Plane<T>,
    /// Index of the deciding case, times [`CASE`].
    pub case: &'a mut Plane<T>,
    /// That and the flags.
    pub state: &'a mut Plane<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for Largest<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        // Squares of the deviation until the last four cases are in.
        let cases = &self.prepared.cases;
        let mut first = 0;
        while first < cases.len() {
            let of_four: [Case<R>; 4] = [
                Case::new(cases, first),
                Case::new(cases, first + 1),
                Case::new(cases, first + 2),
                Case::new(cases, first + 3),
            ];
            let last = first + 4 >= cases.len();
            for i in 0..BLOCK {
                R::step();
                let rows = [vector::<R>(&self.rows[0..3], i), vector(&self.rows[3..6], i)];
                let (mut most, mut which) = if first == 0 {
                    (R::of(-1.0), R::of(0.0))
                } else {
                    (R::load(self.in_plane[i]), R::load(self.case[i]))
                };
                let mut k = 0;
                while k < 4 {
                    let case = &of_four[k];
                    let mut along = [rows[0].dot(case.force), rows[1].dot(case.force)];
                    if MOMENTS {
                        along[0] = along[0] + vector::<R>(&self.rows[6..9], i).dot(case.moment);
                        along[1] = along[1] + vector::<R>(&self.rows[9..12], i).dot(case.moment);
                    }
                    let square = along[0].mul_add(along[0], along[1] * along[1]);
                    let more = square > most;
                    most = R::either(more, square, most);
                    which = R::either(more, case.index, which);
                    k += 1;
                }
                self.in_plane[i] = if last { most.sqrt() } else { most }.store();
                self.case[i] = which.store();
                self.state[i] = (which + R::load(self.postures.flags[i])).store();
            }
            first += 4;
        }
    }
}

/// One load case in every lane.
#[derive(Clone, Copy)]
struct Case<R> {
    force: Vector<R>,
    moment: Vector<R>,
    /// Its index times [`CASE`].
    index: R,
}

impl<R: Real> Case<R> {
    /// Case `index`; the last one again where there are no more.
    #[inline(always)]
    fn new(cases: &[[nalgebra::Vector3<f64>; 2]], index: usize) -> Self {
        let index = index.min(cases.len() - 1);
        Case {
            force: Vector::of(&cases[index][0]),
            moment: Vector::of(&cases[index][1]),
            index: R::of(f64::from(CASE) * index as f64),
        }
    }
}
