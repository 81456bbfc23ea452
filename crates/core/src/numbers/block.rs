//! Planes of numbers that stay in the first cache.

use super::real::{Float, Real};
use super::vector::Vector;

/// Points in a block: whole vectors of every back end and whole cache lines, for a vector across two lines is read
/// and written at half the speed (structs of planes start on a line). Few enough that what one loop works on stays
/// in the first cache; not a power of two, or many planes at once would meet in one set of it.
pub(crate) const BLOCK: usize = 80;

/// One number a point.
pub(crate) type Plane<T> = [T; BLOCK];

/// `N` numbers a point.
pub(crate) type Planes<T, const N: usize> = [Plane<T>; N];

/// Planes of zeros.
pub(crate) fn planes<T: Float, const N: usize>() -> Planes<T, N> {
    [[T::default(); BLOCK]; N]
}

/// Reads a vector from three planes.
#[inline(always)]
pub(crate) fn vector<R: Real>(planes: &[Plane<R::Float>], i: usize) -> Vector<R> {
    Vector::new(
        R::load(planes[0][i]),
        R::load(planes[1][i]),
        R::load(planes[2][i]),
    )
}

/// Writes a vector to three planes.
#[inline(always)]
pub(crate) fn put<R: Real>(planes: &mut [Plane<R::Float>], i: usize, v: Vector<R>) {
    planes[0][i] = v.x.store();
    planes[1][i] = v.y.store();
    planes[2][i] = v.z.store();
}

/// Copies the first values into a plane; the remaining lanes repeat the last one.
pub(crate) fn fill<T: Copy>(plane: &mut Plane<T>, from: &[T]) {
    let used = from.len().min(BLOCK);
    plane[..used].copy_from_slice(&from[..used]);
    if let Some(last) = from.last() {
        plane[used..].fill(*last);
    }
}
