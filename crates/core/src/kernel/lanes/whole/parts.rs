//! Screws of all drives and springs of a block, the torque of gravity on each, and what they add up to: the response of
//! the tool to any wrench.
//!
//! ```text
//! delta = C f + D m + g        C = sum c_k v_k v_k^T    D = sum c_k v_k z_k^T    g = sum c_k v_k tau_k
//! ```
//!
//! From the tool to the base: a part carries all masses between itself and the tool. Parts about the axes of one frame
//! are computed together, without a product by the frame's axes.

use nalgebra::Vector3;

use super::chain::FramePlanes;
use super::model::{Group, ModelConstants};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, vector};

/// A drive or spring at each point: its screw at the TCP (base), and the torque of gravity on it, N m (N).
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct PartPlanes<T> {
    pub linear: Planes<T, 3>,
    /// Not written for a part about an axis of its frame: see [`ModelConstants::angular`].
    pub angular: Planes<T, 3>,
    pub weight: Plane<T>,
}

impl<T: Float> PartPlanes<T> {
    /// A part of which nothing is known yet.
    pub fn unknown() -> PartPlanes<T> {
        PartPlanes {
            linear: planes(),
            angular: planes(),
            weight: [T::default(); BLOCK],
        }
    }
}

/// Displacement of the tool, base: per force (symmetric: xx, xy, xz, yy, yz, zz), m/N; per moment (row by row), 1/N; by
/// gravity, m.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct ResponsePlanes<T> {
    pub by_force: Planes<T, 6>,
    pub by_moment: Planes<T, 9>,
    pub by_gravity: Planes<T, 3>,
}

impl<T: Float> ResponsePlanes<T> {
    /// No response.
    pub fn none() -> ResponsePlanes<T> {
        ResponsePlanes {
            by_force: planes(),
            by_moment: planes(),
            by_gravity: planes(),
        }
    }

    /// The displacement of point `i` by a force, m.
    #[inline(always)]
    pub fn by<R: Real<Float = T>>(&self, force: Vector<R>, i: usize) -> Vector<R> {
        let a = &self.by_force;
        let (xx, xy, xz) = (R::load(a[0][i]), R::load(a[1][i]), R::load(a[2][i]));
        let (yy, yz, zz) = (R::load(a[3][i]), R::load(a[4][i]), R::load(a[5][i]));
        Vector::new(
            Vector::new(xx, xy, xz).dot(force),
            Vector::new(xy, yy, yz).dot(force),
            Vector::new(xz, yz, zz).dot(force),
        )
    }
}

/// Angular parts of part `k` at each point, base.
#[inline(always)]
pub(in crate::kernel::lanes) fn angular<'a, T>(
    model: &ModelConstants,
    frames: &'a [FramePlanes<T>],
    parts: &'a [PartPlanes<T>],
    k: usize,
) -> &'a Planes<T, 3> {
    let part = &model.parts[k];
    if part.about {
        &frames[part.rank].axes[part.axis]
    } else {
        &parts[k].angular
    }
}

/// Fills the response from the frames, which are in the order of ranks, without that to moments unless `MOMENTS`; and the
/// parts if `PARTS`.
pub(in crate::kernel::lanes) struct FindParts<'a, T, const MOMENTS: bool, const PARTS: bool> {
    pub model: &'a ModelConstants,
    pub frames: &'a [FramePlanes<T>],
    pub parts: &'a mut [PartPlanes<T>],
    pub response: &'a mut ResponsePlanes<T>,
}

impl<T: Float, const MOMENTS: bool, const PARTS: bool> Work<T> for FindParts<'_, T, MOMENTS, PARTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindParts {
            model,
            frames,
            parts,
            response,
        } = self;
        *response = ResponsePlanes::none();
        let tcp = &frames[frames.len() - 1].origin;
        let (mut mass, mut moment): (f64, Planes<T, 3>) = (0.0, planes());
        let mut carried = planes();
        let mut rank = frames.len();
        let mut next = 0;
        while rank > 0 {
            rank -= 1;
            let frame = &frames[rank];
            let mut force = Vector3::zeros();
            if let Some(g) = &model.acceleration {
                let before = mass;
                mass += add_masses::<R>(model, rank, frame, tcp, &mut moment);
                force = g * mass;
                if mass != before {
                    let g = Vector::<R>::of(g);
                    for i in 0..BLOCK {
                        R::step();
                        put(&mut carried, i, vector::<R>(&moment, i).cross(g));
                    }
                }
            }
            while next < model.groups.len() && model.groups[next].rank == rank {
                let group = &model.groups[next];
                let own = &mut parts[group.first..group.first + group.count];
                let place = Place {
                    model,
                    group,
                    frame,
                    tcp,
                    force: &force,
                    moment: &carried,
                };
                match (group.about, group.count) {
                    (false, _) => general::<R, MOMENTS>(&place, own, response),
                    (true, 1) => about::<R, 1, MOMENTS, PARTS>(&place, own, response),
                    (true, 2) => about::<R, 2, MOMENTS, PARTS>(&place, own, response),
                    (true, _) => about::<R, 3, MOMENTS, PARTS>(&place, own, response),
                }
                next += 1;
            }
        }
    }
}

/// Adds the moments (kg m) of the masses at `rank` about the TCP and returns the masses, kg.
#[inline(always)]
fn add_masses<R: Real>(
    model: &ModelConstants,
    rank: usize,
    frame: &FramePlanes<R::Float>,
    tcp: &Planes<R::Float, 3>,
    moment: &mut Planes<R::Float, 3>,
) -> f64 {
    let mut mass = 0.0;
    let mut m = 0;
    while m < model.masses.len() {
        let one = &model.masses[m];
        m += 1;
        if one.rank != rank {
            continue;
        }
        mass += one.mass;
        let (centre, heavy) = (Vector::<R>::of(&one.centre), R::of(one.mass));
        for i in 0..BLOCK {
            R::step();
            let x = vector::<R>(&frame.axes[0], i);
            let y = vector::<R>(&frame.axes[1], i);
            let z = vector::<R>(&frame.axes[2], i);
            let away = vector::<R>(&frame.origin, i) - vector::<R>(tcp, i);
            let at = x.mul_add(centre.x, y.mul_add(centre.y, z.mul_add(centre.z, away)));
            let so_far = vector::<R>(moment, i);
            put(moment, i, at.mul_add(heavy, so_far));
        }
    }
    mass
}

/// Where the parts of a group are, and the weight that they carry: force, N, and moment at the TCP, N m, base.
struct Place<'a, T> {
    model: &'a ModelConstants,
    group: &'a Group,
    frame: &'a FramePlanes<T>,
    tcp: &'a Planes<T, 3>,
    force: &'a Vector3<f64>,
    moment: &'a Planes<T, 3>,
}

/// `N` parts about axes of their frame.
#[inline(always)]
fn about<R: Real, const N: usize, const MOMENTS: bool, const PARTS: bool>(
    place: &Place<'_, R::Float>,
    parts: &mut [PartPlanes<R::Float>],
    response: &mut ResponsePlanes<R::Float>,
) {
    let Some(parts) = parts.first_chunk_mut::<N>() else {
        return;
    };
    let (frame, tcp, moment) = (place.frame, place.tcp, place.moment);
    let force = Vector::<R>::of(place.force);
    let mut axes = [&frame.axes[0]; N];
    let mut c = [R::of(0.0); N];
    let mut n = 0;
    while n < N {
        let constants = &place.model.parts[place.group.first + n];
        axes[n] = &frame.axes[constants.axis];
        c[n] = R::of(constants.compliance);
        n += 1;
    }
    for i in 0..BLOCK {
        R::step();
        let lever = vector::<R>(tcp, i) - vector::<R>(&frame.origin, i);
        let carried = vector::<R>(moment, i);
        let mut sum = Sum::load::<MOMENTS>(response, i);
        let mut n = 0;
        while n < N {
            let angular = vector::<R>(axes[n], i);
            let linear = angular.cross(lever);
            let weight = linear.dot(force) + angular.dot(carried);
            if PARTS {
                put(&mut parts[n].linear, i, linear);
                parts[n].weight[i] = weight.store();
            }
            sum.add::<MOMENTS>(linear, angular, c[n], weight);
            n += 1;
        }
        sum.store::<MOMENTS>(response, i);
    }
}

/// One part with any direction.
#[inline(always)]
fn general<R: Real, const MOMENTS: bool>(
    place: &Place<'_, R::Float>,
    parts: &mut [PartPlanes<R::Float>],
    response: &mut ResponsePlanes<R::Float>,
) {
    let (frame, tcp, moment) = (place.frame, place.tcp, place.moment);
    let force = Vector::<R>::of(place.force);
    let constants = &place.model.parts[place.group.first];
    let c = R::of(constants.compliance);
    let (along, about) = (
        Vector::<R>::of(&constants.linear),
        Vector::<R>::of(&constants.angular),
    );
    let part = &mut parts[0];
    for i in 0..BLOCK {
        R::step();
        let x = vector::<R>(&frame.axes[0], i);
        let y = vector::<R>(&frame.axes[1], i);
        let z = vector::<R>(&frame.axes[2], i);
        let lever = vector::<R>(tcp, i) - vector::<R>(&frame.origin, i);
        let angular = x.mul_add(about.x, y.mul_add(about.y, z.scaled(about.z)));
        let linear = x.mul_add(along.x, y.mul_add(along.y, z.scaled(along.z)));
        let linear = linear + angular.cross(lever);
        let weight = linear.dot(force) + angular.dot(vector::<R>(moment, i));
        put(&mut part.angular, i, angular);
        put(&mut part.linear, i, linear);
        part.weight[i] = weight.store();
        let mut sum = Sum::load::<MOMENTS>(response, i);
        sum.add::<MOMENTS>(linear, angular, c, weight);
        sum.store::<MOMENTS>(response, i);
    }
}

/// The response of one lane.
pub(super) struct Sum<R> {
    by_force: [R; 6],
    by_moment: [Vector<R>; 3],
    by_gravity: Vector<R>,
}

impl<R: Real> Sum<R> {
    #[inline(always)]
    pub fn load<const MOMENTS: bool>(from: &ResponsePlanes<R::Float>, i: usize) -> Sum<R> {
        let zero = R::of(0.0);
        let mut sum = Sum {
            by_force: [zero; 6],
            by_moment: [Vector::new(zero, zero, zero); 3],
            by_gravity: vector::<R>(&from.by_gravity, i),
        };
        let mut k = 0;
        while k < 6 {
            sum.by_force[k] = R::load(from.by_force[k][i]);
            k += 1;
        }
        if MOMENTS {
            let mut row = 0;
            while row < 3 {
                sum.by_moment[row] = vector::<R>(&from.by_moment[3 * row..3 * row + 3], i);
                row += 1;
            }
        }
        sum
    }

    #[inline(always)]
    pub fn store<const MOMENTS: bool>(&self, to: &mut ResponsePlanes<R::Float>, i: usize) {
        let mut k = 0;
        while k < 6 {
            to.by_force[k][i] = self.by_force[k].store();
            k += 1;
        }
        if MOMENTS {
            let mut row = 0;
            while row < 3 {
                put(&mut to.by_moment[3 * row..3 * row + 3], i, self.by_moment[row]);
                row += 1;
            }
        }
        put(&mut to.by_gravity, i, self.by_gravity);
    }

    /// Adds a part with this screw and compliance that carries this weight.
    #[inline(always)]
    pub fn add<const MOMENTS: bool>(&mut self, v: Vector<R>, angular: Vector<R>, c: R, weight: R) {
        let w = v.scaled(c);
        let a = &mut self.by_force;
        a[0] = w.x.mul_add(v.x, a[0]);
        a[1] = w.x.mul_add(v.y, a[1]);
        a[2] = w.x.mul_add(v.z, a[2]);
        a[3] = w.y.mul_add(v.y, a[3]);
        a[4] = w.y.mul_add(v.z, a[4]);
        a[5] = w.z.mul_add(v.z, a[5]);
        if MOMENTS {
            self.by_moment[0] = angular.mul_add(w.x, self.by_moment[0]);
            self.by_moment[1] = angular.mul_add(w.y, self.by_moment[1]);
            self.by_moment[2] = angular.mul_add(w.z, self.by_moment[2]);
        }
        self.by_gravity = w.mul_add(weight, self.by_gravity);
    }
}
