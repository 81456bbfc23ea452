//! A triangle mesh with a tree of boxes: distances to convex bodies, to points and to other meshes.
//!
//! A closed mesh is a solid: what is inside of it touches it. An open mesh is a surface only.
//!
//! Each node of the tree has a box around its triangles; subtrees whose bound exceeds the nearest distance found so far are left
//! out. Distances in m, in the frame of the mesh; exact but for rounding.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Vector3};

use super::bounds::{Bounds, Capsule};
use super::convex::{Convex, Core, rounded};
use super::enclosing::roughly_enclosing_capsule;
use super::nearest::{Nearest, Triangle};

/// Most triangles of a leaf of the tree.
const LEAF: usize = 2;

/// Most triangles of a mesh in pieces, in addition to four of each triangle.
const MOST_PIECES: f64 = 50_000.0;

/// Directions of the rays that decide whether a point is inside: not along edges and faces of usual parts.
const RAYS: [Vector3<f64>; 3] = [
    Vector3::new(0.577_1, 0.288_3, 0.764_1),
    Vector3::new(-0.411_7, 0.831_9, 0.372_3),
    Vector3::new(0.313_1, -0.517_3, 0.796_5),
];

/// A triangle mesh.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// In the order of the leaves.
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    hull: Capsule,
    closed: bool,
}

/// A place on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPoint {
    /// Index of its triangle in [`Mesh::triangles`].
    pub triangle: usize,
    /// The place, m.
    pub at: Point3<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// The first triangle of a leaf, else the first of two children, one after the other.
    first: u32,
    /// Triangles of a leaf; 0 of an inner node.
    count: u32,
}

/// What is inside of a node of the tree.
pub(super) enum Inside<'a> {
    /// Two nodes.
    Nodes([u32; 2]),
    /// Triangles.
    Triangles(&'a [Triangle]),
}

impl Mesh {
    /// The mesh of these triangles, m; `closed` if they enclose a solid. `None` without any triangle.
    ///
    /// Not checked: that a closed mesh has no open edge.
    pub fn new(triangles: Vec<[Point3<f64>; 3]>, closed: bool) -> Option<Mesh> {
        if triangles.is_empty() || u32::try_from(2 * triangles.len()).is_err() {
            return None;
        }
        let mut triangles: Vec<Triangle> = triangles.into_iter().map(Triangle).collect();
        let mut nodes = vec![Node {
            bounds: Bounds::EMPTY,
            first: 0,
            count: triangles.len() as u32,
        }];
        let mut open = vec![0_usize];
        while let Some(index) = open.pop() {
            let (start, count) = (nodes[index].first as usize, nodes[index].count as usize);
            let own = &mut triangles[start..start + count];
            nodes[index].bounds = Bounds::of(own.iter().flat_map(|triangle| triangle.0));
            if count <= LEAF {
                continue;
            }
            let centres = Bounds::of(own.iter().map(centre));
            let axis = centres.half().imax();
            let middle = count / 2;
            own.select_nth_unstable_by(middle, |a, b| centre(a)[axis].total_cmp(&centre(b)[axis]));
            let children = nodes.len();
            for (first, count) in [(start, middle), (start + middle, count - middle)] {
                nodes.push(Node {
                    bounds: Bounds::EMPTY,
                    first: first as u32,
                    count: count as u32,
                });
            }
            nodes[index].first = children as u32;
            nodes[index].count = 0;
            open.extend([children, children + 1]);
        }
        let points: Vec<_> = triangles.iter().flat_map(|triangle| triangle.0).collect();
        let hull = roughly_enclosing_capsule(&points)?;
        Some(Mesh {
            triangles,
            nodes,
            hull,
            closed,
        })
    }

    /// The same surface in triangles with edges of about `edge`, m, or longer ones where these are too many.
    pub(super) fn in_pieces(&self, mut edge: f64) -> Option<Mesh> {
        let pieces = |triangle: &Triangle, edge: f64| {
            let length = triangle.longest_edge() / edge;
            1.0 + length + triangle.area_vector().norm() / (edge * edge)
        };
        let all = |edge: f64| -> f64 { self.triangles.iter().map(|triangle| pieces(triangle, edge)).sum() };
        while edge < self.bounds().half().norm()
            && all(edge) > MOST_PIECES + 4.0 * self.triangles.len() as f64
        {
            edge *= 2.0;
        }
        let mut open = self.triangles.clone();
        let mut small = Vec::with_capacity(open.len());
        while let Some(triangle) = open.pop() {
            match triangle.longest_edge() > edge {
                true => open.extend(triangle.halves()),
                false => small.push(triangle.0),
            }
        }
        Mesh::new(small, self.closed)
    }

    /// Its triangles, m, in an order of its own.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Whether it encloses a solid.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The box around it.
    pub fn bounds(&self) -> &Bounds {
        &self.nodes[0].bounds
    }

    /// A capsule around it.
    pub fn hull(&self) -> &Capsule {
        &self.hull
    }

    /// Its point farthest along `direction`.
    pub fn farthest_along(&self, direction: &Vector3<f64>) -> Point3<f64> {
        let mut farthest = (f64::NEG_INFINITY, self.bounds().centre());
        let reach = |index: u32| self.nodes[index as usize].bounds.extent(direction)[1];
        let mut open = vec![(-reach(0), 0_u32)];
        while let Some((least, index)) = open.pop() {
            if -least <= farthest.0 {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count == 0 {
                let children = [node.first, node.first + 1].map(|child| (-reach(child), child));
                open.extend(farther_first(children));
                continue;
            }
            for corner in self.leaf(node).iter().flat_map(|triangle| triangle.0) {
                let along = direction.dot(&corner.coords);
                if along > farthest.0 {
                    farthest = (along, corner);
                }
            }
        }
        farthest.1
    }

    /// The ball around a node of the tree, in the frame of the mesh: centre and radius. Node 0 is around all.
    pub(super) fn ball(&self, node: u32) -> (Point3<f64>, f64) {
        let bounds = &self.nodes[node as usize].bounds;
        (bounds.centre(), bounds.half().norm())
    }

    /// What is inside of a node.
    pub(super) fn inside(&self, node: u32) -> Inside<'_> {
        let node = &self.nodes[node as usize];
        match node.count {
            0 => Inside::Nodes([node.first, node.first + 1]),
            _ => Inside::Triangles(self.leaf(node)),
        }
    }

    fn leaf(&self, node: &Node) -> &[Triangle] {
        &self.triangles[node.first as usize..][..node.count as usize]
    }

    /// Whether a point is inside of a closed mesh; `false` of an open one.
    pub fn contains(&self, point: &Point3<f64>) -> bool {
        if !self.closed || self.bounds().distance_of(point) > 0.0 {
            return false;
        }
        let inside = RAYS
            .iter()
            .filter(|ray| self.crossings(point, ray) % 2 == 1)
            .count();
        2 * inside > RAYS.len()
    }

    /// How many triangles the ray from `point` crosses.
    fn crossings(&self, point: &Point3<f64>, ray: &Vector3<f64>) -> usize {
        let mut count = 0;
        let mut open = vec![0_u32];
        while let Some(index) = open.pop() {
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds, point, ray) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.first, node.first + 1]);
                continue;
            }
            count += self
                .leaf(node)
                .iter()
                .filter(|triangle| is_crossed(triangle, point, ray))
                .count();
        }
        count
    }

    /// The place on the mesh that is nearest to `point`; `None` where none is within `limit`, m.
    pub fn nearest_to_point(&self, point: &Point3<f64>, limit: f64) -> Option<MeshPoint> {
        let mut found = None;
        let mut least = limit;
        // A node leaves one more than it takes: as many as the tree is deep.
        let mut open = Vec::with_capacity(64);
        open.push((self.bounds().distance_of(point), 0_u32));
        while let Some((bound, index)) = open.pop() {
            if bound > least || (found.is_some() && bound >= least) {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count == 0 {
                let children = [node.first, node.first + 1]
                    .map(|child| (self.nodes[child as usize].bounds.distance_of(point), child));
                open.extend(farther_first(children));
                continue;
            }
            for (k, triangle) in self.leaf(node).iter().enumerate() {
                let at = triangle.nearest_to_point(point);
                let distance = (at - point).norm();
                if distance < least || (found.is_none() && distance <= least) {
                    least = distance;
                    found = Some(MeshPoint {
                        triangle: node.first as usize + k,
                        at,
                    });
                }
            }
        }
        found
    }

    /// The nearest points of a convex body (in the frame of the mesh) and this mesh, that of the body first; `None`
    /// where they are farther apart than `limit`, m.
    pub fn nearest_to_convex(&self, body: &Convex, hull: &Capsule, limit: f64) -> Option<Nearest> {
        let inner = body.core.inner_point();
        if self.contains(&inner) {
            return Some(Nearest::touching(inner));
        }
        let ends = [hull.axis.from, hull.axis.to];
        let mut best = Best::within(limit);
        let mut open = vec![(hull.bound_to(self.bounds()), 0_u32)];
        while let Some((bound, index)) = open.pop() {
            let node = &self.nodes[index as usize];
            let reach = hull.extent(&best.direction)[1];
            if best.excludes(bound) || best.excludes(node.bounds.extent(&best.direction)[0] - reach) {
                continue;
            }
            if node.count == 0 {
                let children = [node.first, node.first + 1]
                    .map(|child| (hull.bound_to(&self.nodes[child as usize].bounds), child));
                open.extend(farther_first(children));
                continue;
            }
            for triangle in self.leaf(node) {
                let reach = hull.extent(&best.direction)[1];
                if best.excludes(triangle.extent(&best.direction)[0] - reach)
                    || best.excludes(triangle.gap(&ends) - hull.radius)
                {
                    continue;
                }
                best.take(match &body.core {
                    Core::Segment(segment) => rounded(triangle.nearest_to_segment(segment), body.radius, 0.0),
                    _ => body.nearest(&Convex {
                        core: Core::Triangle(*triangle),
                        radius: 0.0,
                    }),
                });
                if best.touches() {
                    return best.found;
                }
            }
        }
        best.found
    }

    /// The nearest points of this mesh and another one, whose frame is at `from_other`; in the frame of this mesh; `None`
    /// where they are farther apart than `limit`, m.
    pub fn nearest_to_mesh(
        &self,
        other: &Mesh,
        from_other: &IsometryMatrix3<f64>,
        limit: f64,
    ) -> Option<Nearest> {
        let theirs = from_other * other.triangles[0].0[0];
        if self.contains(&theirs) {
            return Some(Nearest::touching(theirs));
        }
        let ours = self.triangles[0].0[0];
        if other.contains(&from_other.inverse_transform_point(&ours)) {
            return Some(Nearest::touching(ours));
        }
        let frames = Frames::of(from_other);
        let mut best = Best::within(limit);
        let mut open = vec![(frames.bound(self.bounds(), other.bounds()), 0_u32, 0_u32)];
        while let Some((bound, own, others)) = open.pop() {
            let (first, second) = (&self.nodes[own as usize], &other.nodes[others as usize]);
            if best.excludes(bound)
                || best.excludes(frames.gap(&first.bounds, &second.bounds, &best.direction))
            {
                continue;
            }
            if first.count > 0 && second.count > 0 {
                for theirs in other.leaf(second) {
                    let theirs = theirs.moved(from_other);
                    for ours in self.leaf(first) {
                        let direction = &best.direction;
                        if best.excludes(theirs.extent(direction)[0] - ours.extent(direction)[1])
                            || best.excludes(ours.gap(&theirs.0))
                            || best.excludes(theirs.gap(&ours.0))
                        {
                            continue;
                        }
                        best.take(ours.nearest(&theirs));
                        if best.touches() {
                            return best.found;
                        }
                    }
                }
                continue;
            }
            // The larger one of two inner nodes is opened.
            let opens_first = second.count > 0
                || (first.count == 0 && first.bounds.half().norm() > second.bounds.half().norm());
            let children = if opens_first {
                [first.first, first.first + 1].map(|child| {
                    let bound = frames.bound(&self.nodes[child as usize].bounds, &second.bounds);
                    (bound, (child, others))
                })
            } else {
                [second.first, second.first + 1].map(|child| {
                    let bound = frames.bound(&first.bounds, &other.nodes[child as usize].bounds);
                    (bound, (own, child))
                })
            };
            open.extend(farther_first(children).map(|(bound, nodes)| (bound, nodes.0, nodes.1)));
        }
        best.found
    }
}

/// The nearest points found so far.
struct Best {
    found: Option<Nearest>,
    limit: f64,
    /// From the first body to the second, unit; zero while nothing is found. Whatever lies beyond the found distance along it
    /// cannot be nearer.
    direction: Vector3<f64>,
}

impl Best {
    fn within(limit: f64) -> Best {
        Best {
            found: None,
            limit,
            direction: Vector3::zeros(),
        }
    }

    /// Whether bodies at least this far apart are of no use.
    fn excludes(&self, bound: f64) -> bool {
        bound > self.limit || (self.found.is_some() && bound >= self.limit)
    }

    fn take(&mut self, found: Nearest) {
        if self.excludes(found.distance) {
            return;
        }
        let [from, to] = found.points;
        self.limit = found.distance;
        self.direction = (to - from).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        self.found = Some(found);
    }

    fn touches(&self) -> bool {
        self.found.is_some_and(|found| found.distance == 0.0)
    }
}

/// Two frames of meshes.
struct Frames {
    from_other: IsometryMatrix3<f64>,
    to_other: IsometryMatrix3<f64>,
    turn: Matrix3<f64>,
    back: Matrix3<f64>,
}

impl Frames {
    fn of(from_other: &IsometryMatrix3<f64>) -> Frames {
        let turn = from_other.rotation.matrix().abs();
        Frames {
            from_other: *from_other,
            to_other: from_other.inverse(),
            back: turn.transpose(),
            turn,
        }
    }

    /// A lower bound of the distance between whatever is in a box of this mesh and in a box of the other, m.
    fn bound(&self, own: &Bounds, others: &Bounds) -> f64 {
        let here = own.distance(&others.moved(&self.from_other, &self.turn));
        let there = own.moved(&self.to_other, &self.back).distance(others);
        here.max(there)
    }

    /// The gap between them along a direction of this mesh's frame.
    fn gap(&self, own: &Bounds, others: &Bounds, direction: &Vector3<f64>) -> f64 {
        let there = self.to_other.rotation * direction;
        let offset = direction.dot(&self.from_other.translation.vector);
        others.extent(&there)[0] + offset - own.extent(direction)[1]
    }
}

/// In the order of a stack: the nearer one is taken first.
fn farther_first<T: Copy>(children: [(f64, T); 2]) -> [(f64, T); 2] {
    let [first, second] = children;
    if first.0 <= second.0 {
        [second, first]
    } else {
        children
    }
}

fn centre(triangle: &Triangle) -> Point3<f64> {
    let [a, b, c] = triangle.0;
    Point3::from((a.coords + b.coords + c.coords) / 3.0)
}

/// Whether the ray meets the box.
fn meets(bounds: &Bounds, from: &Point3<f64>, ray: &Vector3<f64>) -> bool {
    let (mut near, mut far) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (one, other) = (
            (bounds.least[axis] - from[axis]) / ray[axis],
            (bounds.greatest[axis] - from[axis]) / ray[axis],
        );
        near = near.max(one.min(other));
        far = far.min(one.max(other));
    }
    near <= far
}

/// Whether the ray crosses the triangle (Moller & Trumbore 1997, *Fast, minimum storage ray/triangle intersection*).
fn is_crossed(triangle: &Triangle, from: &Point3<f64>, ray: &Vector3<f64>) -> bool {
    let [a, b, c] = triangle.0;
    let (ab, ac) = (b - a, c - a);
    let p = ray.cross(&ac);
    let determinant = ab.dot(&p);
    if determinant == 0.0 {
        return false;
    }
    let s = from - a;
    let u = s.dot(&p) / determinant;
    let q = s.cross(&ab);
    let v = ray.dot(&q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(&q) / determinant > 0.0
}

#[cfg(test)]
mod tests;
