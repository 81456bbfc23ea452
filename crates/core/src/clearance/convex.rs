//! Convex bodies and the distance of two of them: the algorithm of Gilbert, Johnson and Keerthi (GJK).
//!
//! A convex body is all that is within a radius of its core: a point, a segment, a triangle, a box or a cylinder. The
//! distance of two cores is that of the origin from their difference; each iteration adds the support point `w`
//! against the present nearest point `v` of a simplex, and stops where the bounds meet:
//!
//! ```text
//! v . w / |v|  <=  distance  <=  |v|
//! ```
//!
//! Lengths in m, all in one frame. The bounds meet within 1e-10 m, or as near as rounding permits: 1e-7 m for cylinders of a
//! metre. Source: Gilbert, Johnson & Keerthi 1988, *A fast procedure for
//! computing the distance between complex objects in three-dimensional space*, IEEE J. Robotics and Automation 4:193;
//! the simplex as in Ericson 2005, *Real-Time Collision Detection*, section 9.5.

use nalgebra::{IsometryMatrix3, Point3, Vector3};

use super::nearest::{Nearest, Segment, Triangle};

/// Bounds of a distance that are as near as this (m) are one.
const BOUNDS: f64 = 1e-10;
/// Most iterations; boxes and cylinders of a metre take at most some 40.
const MOST_ITERATIONS: usize = 200;

/// The core of a convex body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Core {
    /// A segment; a point where its ends are the same.
    Segment(Segment),
    /// A triangle.
    Triangle(Triangle),
    /// A box: its centre, and half its edges.
    Box {
        /// The centre.
        centre: Point3<f64>,
        /// Vectors from the centre to the centres of three faces, perpendicular to each other.
        half_edges: [Vector3<f64>; 3],
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// Its axis, from end to end; not a point.
        axis: Segment,
        /// Its radius, m.
        radius: f64,
    },
}

/// A convex body: all within `radius` of its core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convex {
    /// The core.
    pub core: Core,
    /// The radius around it, m.
    pub radius: f64,
}

impl Core {
    /// Its point farthest along `direction`.
    pub(super) fn support(&self, direction: &Vector3<f64>) -> Point3<f64> {
        let farther = |a: Point3<f64>, b: Point3<f64>| {
            if direction.dot(&(b - a)) > 0.0 { b } else { a }
        };
        match self {
            Core::Segment(segment) => farther(segment.from, segment.to),
            Core::Triangle(Triangle([a, b, c])) => farther(farther(*a, *b), *c),
            Core::Box { centre, half_edges } => half_edges.iter().fold(*centre, |point, edge| {
                point + edge * if direction.dot(edge) < 0.0 { -1.0 } else { 1.0 }
            }),
            Core::Cylinder { axis, radius } => {
                let along = axis.to - axis.from;
                let off_axis =
                    |vector: &Vector3<f64>| vector - along * (vector.dot(&along) / along.norm_squared());
                // Twice: what rounding leaves along the axis would be enlarged with what is short across it.
                let across = off_axis(&off_axis(direction));
                let length = across.norm();
                let end = farther(axis.from, axis.to);
                // Along its axis every point of the end is as far.
                if length > 1e-12 * direction.norm() {
                    end + across * (radius / length)
                } else {
                    end
                }
            }
        }
    }

    /// A point inside of it.
    pub fn inner_point(&self) -> Point3<f64> {
        match self {
            Core::Segment(segment) => segment.middle(),
            Core::Triangle(Triangle([a, b, c])) => Point3::from((a.coords + b.coords + c.coords) / 3.0),
            Core::Box { centre, .. } => *centre,
            Core::Cylinder { axis, .. } => axis.middle(),
        }
    }

    /// In another frame.
    fn moved(&self, by: &IsometryMatrix3<f64>) -> Core {
        match self {
            Core::Segment(segment) => Core::Segment(segment.moved(by)),
            Core::Triangle(triangle) => Core::Triangle(triangle.moved(by)),
            Core::Box { centre, half_edges } => Core::Box {
                centre: by * centre,
                half_edges: half_edges.map(|edge| by.rotation * edge),
            },
            Core::Cylinder { axis, radius } => Core::Cylinder {
                axis: axis.moved(by),
                radius: *radius,
            },
        }
    }
}

impl Segment {
    /// In another frame.
    pub fn moved(&self, by: &IsometryMatrix3<f64>) -> Segment {
        Segment {
            from: by * self.from,
            to: by * self.to,
        }
    }
}

impl Convex {
    /// In another frame.
    pub fn moved(&self, by: &IsometryMatrix3<f64>) -> Convex {
        Convex {
            core: self.core.moved(by),
            radius: self.radius,
        }
    }

    /// The nearest points of two convex bodies.
    pub fn nearest(&self, other: &Convex) -> Nearest {
        let found = self.nearest_within(other, f64::INFINITY);
        found.expect("without a limit there is a nearest pair")
    }

    /// The same, if they are not farther apart than `limit`, m.
    pub fn nearest_within(&self, other: &Convex, limit: f64) -> Option<Nearest> {
        let cores = self.nearest_of_cores(other, limit + self.radius + other.radius)?;
        Some(rounded(cores, self.radius, other.radius)).filter(|found| found.distance <= limit)
    }

    /// The nearest points of both cores; `None` only where they are farther apart than `limit`, m.
    fn nearest_of_cores(&self, other: &Convex, limit: f64) -> Option<Nearest> {
        match (&self.core, &other.core) {
            (Core::Segment(first), Core::Segment(second)) => Some(first.nearest(second)),
            (Core::Segment(segment), Core::Triangle(triangle)) => Some(triangle.nearest_to_segment(segment)),
            (Core::Triangle(triangle), Core::Segment(segment)) => {
                Some(triangle.nearest_to_segment(segment).swapped())
            }
            (Core::Triangle(first), Core::Triangle(second)) => Some(first.nearest(second)),
            (first, second) => cores_within(first, second, limit),
        }
    }
}

/// The nearest points of bodies with these radii around their cores.
pub(super) fn rounded(cores: Nearest, first: f64, second: f64) -> Nearest {
    let [from, to] = cores.points;
    let distance = cores.distance - first - second;
    if distance <= 0.0 || cores.distance == 0.0 {
        // Inside of both: between the points of the cores in the ratio of the radii.
        let both = first + second;
        let fraction = if both > 0.0 { first / both } else { 0.0 };
        return Nearest::touching(from + (to - from) * fraction);
    }
    let direction = (to - from) / cores.distance;
    Nearest {
        distance,
        points: [from + direction * first, to - direction * second],
    }
}

/// A point of the difference of two cores, with those that it comes from.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    first: Point3<f64>,
    second: Point3<f64>,
    /// `first - second`.
    difference: Vector3<f64>,
}

impl Vertex {
    fn towards(direction: &Vector3<f64>, first: &Core, second: &Core) -> Vertex {
        let (first, second) = (first.support(direction), second.support(&-direction));
        Vertex {
            first,
            second,
            difference: first - second,
        }
    }
}

/// At most four vertices, and the weights of the point of their hull that is nearest to the origin.
#[derive(Clone, Copy, Debug)]
struct Simplex {
    vertices: [Vertex; 4],
    weights: [f64; 4],
    count: usize,
}

impl Simplex {
    fn of(vertices: &[Vertex], weights: &[f64]) -> Simplex {
        let mut simplex = Simplex {
            vertices: [vertices[0]; 4],
            weights: [0.0; 4],
            count: 0,
        };
        for (vertex, weight) in vertices.iter().zip(weights) {
            if *weight > 0.0 {
                simplex.vertices[simplex.count] = *vertex;
                simplex.weights[simplex.count] = *weight;
                simplex.count += 1;
            }
        }
        simplex
    }

    /// Its point nearest to the origin.
    fn point(&self) -> Vector3<f64> {
        let both = self.vertices.iter().zip(&self.weights).take(self.count);
        both.fold(Vector3::zeros(), |sum, (vertex, weight)| {
            sum + vertex.difference * *weight
        })
    }

    fn nearest(&self) -> Nearest {
        let both = || self.vertices.iter().zip(&self.weights).take(self.count);
        let first = both().fold(Vector3::zeros(), |sum, (vertex, weight)| {
            sum + vertex.first.coords * *weight
        });
        let second = both().fold(Vector3::zeros(), |sum, (vertex, weight)| {
            sum + vertex.second.coords * *weight
        });
        Nearest::between(first.into(), second.into())
    }

    /// The simplex of its vertices and this one, reduced to those that carry the nearest point: all four where the origin
    /// is inside of a tetrahedron.
    fn with(&self, vertex: Vertex) -> Simplex {
        let mut all = self.vertices;
        all[self.count] = vertex;
        match self.count {
            1 => edge(&all[0], &all[1]),
            2 => face(&all[0], &all[1], &all[2]),
            _ => tetrahedron(&all),
        }
    }
}

fn edge(a: &Vertex, b: &Vertex) -> Simplex {
    let along = b.difference - a.difference;
    let square = along.norm_squared();
    let t = if square > 0.0 {
        (-a.difference.dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    Simplex::of(&[*a, *b], &[1.0 - t, t])
}

fn face(a: &Vertex, b: &Vertex, c: &Vertex) -> Simplex {
    // The projection of the origin, from the products of two edges: rounding stays small where corners are near each other.
    let (ab, ac) = (b.difference - a.difference, c.difference - a.difference);
    let (bb, bc, cc) = (ab.norm_squared(), ab.dot(&ac), ac.norm_squared());
    let (to_b, to_c) = (-ab.dot(&a.difference), -ac.dot(&a.difference));
    let determinant = bb * cc - bc * bc;
    if determinant > 0.0 {
        let of_b = (to_b * cc - to_c * bc) / determinant;
        let of_c = (to_c * bb - to_b * bc) / determinant;
        let weights = [1.0 - of_b - of_c, of_b, of_c];
        if weights.iter().all(|weight| *weight >= 0.0) {
            return Simplex::of(&[*a, *b, *c], &weights);
        }
    }
    nearest_of([edge(a, b), edge(b, c), edge(c, a)])
}

fn tetrahedron(all: &[Vertex; 4]) -> Simplex {
    let [a, b, c, d] = all.map(|vertex| vertex.difference);
    let volume = (b - a).cross(&(c - a)).dot(&(d - a));
    // Signed volumes with the origin in place of each vertex.
    let parts = [
        b.cross(&c).dot(&d),
        -a.cross(&c).dot(&d),
        a.cross(&b).dot(&d),
        -a.cross(&b).dot(&c),
    ];
    let largest = [a, b, c, d].iter().map(Vector3::norm).fold(0.0, f64::max);
    // A flat tetrahedron has no inside that rounding could tell.
    let flat = volume.abs() <= 1e-12 * largest.powi(3);
    if !flat && parts.iter().all(|part| part * volume > 0.0) {
        let sum: f64 = parts.iter().sum();
        return Simplex::of(all, &parts.map(|part| part / sum));
    }
    let [a, b, c, d] = all;
    nearest_of([face(a, b, c), face(a, b, d), face(a, c, d), face(b, c, d)])
}

fn nearest_of<const N: usize>(all: [Simplex; N]) -> Simplex {
    let mut best = all[0];
    for one in &all[1..] {
        if one.point().norm_squared() < best.point().norm_squared() {
            best = *one;
        }
    }
    best
}

/// The nearest points of two cores; `None` where a gap proves that they are farther apart than `limit`, m.
fn cores_within(first: &Core, second: &Core, limit: f64) -> Option<Nearest> {
    let start = first.inner_point() - second.inner_point();
    let start = if start == Vector3::zeros() {
        Vector3::x()
    } else {
        start
    };
    let mut simplex = Simplex::of(&[Vertex::towards(&-start, first, second)], &[1.0]);
    let mut v = simplex.point();
    let mut lower = 0.0_f64;
    for _ in 0..MOST_ITERATIONS {
        let distance = v.norm();
        if distance <= BOUNDS {
            return Some(Nearest::touching(simplex.nearest().points[0]));
        }
        let vertex = Vertex::towards(&-v, first, second);
        lower = lower.max(v.dot(&vertex.difference) / distance);
        if lower > limit {
            return None;
        }
        if distance - lower <= BOUNDS {
            break;
        }
        let next = simplex.with(vertex);
        if next.count == 4 {
            return Some(Nearest::touching(next.nearest().points[0]));
        }
        let nearer = next.point();
        // Rounding can keep the simplex from coming nearer; then the bounds are as near as they come.
        if nearer.norm_squared() >= v.norm_squared() {
            break;
        }
        (simplex, v) = (next, nearer);
    }
    Some(simplex.nearest())
}

#[cfg(test)]
mod tests;
