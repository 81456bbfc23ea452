//! Deviation of points with separate directions or wrenches, given in the part's axes.
//!
//! First the compliance along the directions of each point, then the cases one after the other; as `envelope` does for
//! points that share both.

use nalgebra::Matrix3;

use crate::kernel::lanes::geometry::{Aims, Prepared, aim};
use crate::kernel::lanes::load::Flexibility;
use crate::kernel::lanes::solve::{Links, Postures, Screws, Solved};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, lanes_of, put, vector};

/// Rows of the compliance along the directions of each point, arm axes.
pub(super) struct RowsOfEach<'a, T, const STILL: bool, const MOMENTS: bool> {
    pub prepared: &'a Prepared,
    pub arm_from_part: &'a Matrix3<f64>,
    /// Two directions, part axes.
    pub along: &'a Planes<T, 6>,
    pub aims: &'a Aims<T>,
    pub postures: &'a Postures<T>,
    pub rows: &'a mut Planes<T, 12>,
}

impl<T: Float, const STILL: bool, const MOMENTS: bool> Work<T> for RowsOfEach<'_, T, STILL, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
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
pub(super) struct LargestOfEach<'a, T> {
    pub wrench_from_arm: &'a Matrix3<f64>,
    pub moments: bool,
    /// Case after case.
    pub wrenches: &'a [Planes<T, 6>],
    /// Turned to the axes of the wrenches on the way.
    pub rows: &'a mut Planes<T, 12>,
    pub deviation: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for LargestOfEach<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let turn = Turn::<R>::new(self.wrench_from_arm);
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
        self.deviation.fill(T::default());
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
