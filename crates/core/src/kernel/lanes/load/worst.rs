//! The largest deviations of the load cases of a point.

use std::ops::Range;

use nalgebra::Vector3;

use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, planes, put, vector};

/// The largest deviations of the cases so far, and the case that decides; `in_plane` and `full` are squares until the
/// last case is taken.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Worst<T> {
    pub in_plane: Plane<T>,
    /// Along the normal, of the case where it is largest in size.
    pub normal: Plane<T>,
    pub full: Plane<T>,
    pub case: Plane<T>,
    /// In-plane components of the deciding case, along the plane's two directions.
    pub components: Planes<T, 2>,
    /// Its force and moment, in the axes of the load.
    pub wrench: Planes<T, 6>,
}

impl<T: Float> Worst<T> {
    /// Before any case.
    pub fn none() -> Worst<T> {
        Worst {
            in_plane: [T::default(); BLOCK],
            normal: [T::default(); BLOCK],
            full: [T::default(); BLOCK],
            case: [T::default(); BLOCK],
            components: planes(),
            wrench: planes(),
        }
    }
}

/// One load case in every lane, and the plane that its deviation is split on.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct CaseLanes<R> {
    index: R,
    first: bool,
    last: bool,
    pub force: Vector<R>,
    pub moment: Vector<R>,
    plane: [Vector<R>; 3],
}

impl<R: Real> CaseLanes<R> {
    /// The first of these cases; `plane` is two directions across the normal, then the normal.
    #[inline(always)]
    pub fn new(
        cases: Range<usize>,
        force: &Vector3<f64>,
        moment: &Vector3<f64>,
        plane: &[Vector3<f64>; 3],
    ) -> Self {
        CaseLanes {
            index: R::of(cases.start as f64),
            first: cases.start == 0,
            last: cases.len() == 1,
            force: Vector::of(force),
            moment: Vector::of(moment),
            plane: [
                Vector::of(&plane[0]),
                Vector::of(&plane[1]),
                Vector::of(&plane[2]),
            ],
        }
    }

    /// Takes the deviation of point `i` under this case into the worst so far; the moment only if `MOMENTS`.
    #[inline(always)]
    pub fn take<const MOMENTS: bool>(&self, delta: Vector<R>, i: usize, worst: &mut Worst<R::Float>) {
        let zero = R::of(0.0);
        let [first, second, normal] = self.plane;
        let (a, b, n) = (delta.dot(first), delta.dot(second), delta.dot(normal));
        let in_plane = a.mul_add(a, b * b);
        let full = n.mul_add(n, in_plane);
        // Nothing is smaller in size than the deviation of the first case.
        let most = R::either(self.first, R::of(-1.0), R::load(worst.in_plane[i]));
        let more = in_plane > most;
        let most = R::either(more, in_plane, most);
        worst.in_plane[i] = if self.last { most.sqrt() } else { most }.store();
        worst.case[i] = R::either(more, self.index, R::load(worst.case[i])).store();
        let normal_so_far = R::either(self.first, zero, R::load(worst.normal[i]));
        worst.normal[i] = R::either(n.abs() > normal_so_far.abs(), n, normal_so_far).store();
        let full = full.max(R::either(self.first, zero, R::load(worst.full[i])));
        worst.full[i] = if self.last { full.sqrt() } else { full }.store();
        worst.components[0][i] = R::either(more, a, R::load(worst.components[0][i])).store();
        worst.components[1][i] = R::either(more, b, R::load(worst.components[1][i])).store();
        let so_far = vector::<R>(&worst.wrench[0..3], i);
        put(&mut worst.wrench[0..3], i, choose(more, self.force, so_far));
        if MOMENTS {
            let so_far = vector::<R>(&worst.wrench[3..6], i);
            put(&mut worst.wrench[3..6], i, choose(more, self.moment, so_far));
        }
    }
}

#[inline(always)]
fn choose<R: Real>(condition: bool, yes: Vector<R>, no: Vector<R>) -> Vector<R> {
    Vector::new(
        R::either(condition, yes.x, no.x),
        R::either(condition, yes.y, no.y),
        R::either(condition, yes.z, no.z),
    )
}
