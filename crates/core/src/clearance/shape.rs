//! The shapes of bodies, and the distance of two of them.
//!
//! Boxes, cylinders, capsules and closed meshes are solid; an open mesh is a surface. Lengths in m.

use std::sync::Arc;

use nalgebra::{IsometryMatrix3, Point3, Vector3};

use super::bounds::{Bounds, Capsule};
use super::convex::{Convex, Core};
use super::mesh::Mesh;
use super::nearest::{Nearest, Segment};

/// A shape in the frame of its body.
#[derive(Clone, Debug)]
pub enum Shape {
    /// All within a radius of a segment; a ball where its ends are the same.
    Capsule(Capsule),
    /// A cylinder with flat ends: its axis and its radius.
    Cylinder(Segment, f64),
    /// A box along the axes of the frame.
    Box(Bounds),
    /// A triangle mesh, shared by all that use it.
    Mesh(Arc<Mesh>),
}

/// A shape placed in a common frame.
#[derive(Clone, Debug)]
pub struct Placed {
    solid: Solid,
    hull: Capsule,
}

#[derive(Clone, Debug)]
enum Solid {
    Convex(Convex),
    Mesh {
        mesh: Arc<Mesh>,
        from_mesh: IsometryMatrix3<f64>,
        to_mesh: IsometryMatrix3<f64>,
    },
}

impl Shape {
    /// A capsule around it, in the frame of its body.
    pub fn hull(&self) -> Capsule {
        match self {
            Shape::Capsule(capsule) => *capsule,
            Shape::Cylinder(axis, radius) => Capsule {
                axis: *axis,
                radius: *radius,
            },
            Shape::Box(bounds) => around_box(bounds),
            Shape::Mesh(mesh) => *mesh.hull(),
        }
    }

    /// A capsule inside of it, in the frame of its body; of a mesh none is known.
    pub(super) fn inner(&self) -> Option<Capsule> {
        let (axis, radius) = match self {
            Shape::Capsule(capsule) => return Some(*capsule),
            Shape::Cylinder(axis, radius) => (*axis, *radius),
            Shape::Box(bounds) => (around_box(bounds).axis, bounds.half().min()),
            Shape::Mesh(_) => return None,
        };
        // Half balls at the ends, inside of them.
        let (middle, half) = (axis.middle(), axis.half_length());
        let radius = radius.min(half);
        let part = if half > 0.0 { 1.0 - radius / half } else { 0.0 };
        let end = |end: Point3<f64>| middle + (end - middle) * part;
        Some(Capsule {
            axis: Segment {
                from: end(axis.from),
                to: end(axis.to),
            },
            radius,
        })
    }

    /// The box around it, in the frame of its body.
    pub fn bounds(&self) -> Bounds {
        match self {
            Shape::Capsule(capsule) => capsule.bounds(),
            Shape::Cylinder(axis, radius) => {
                // An end is a disc: it reaches as far along an axis as that axis leans out of the cylinder's.
                let unit = (axis.to - axis.from).normalize();
                let reach = unit.map(|part| radius * (1.0 - part * part).max(0.0).sqrt());
                let ends = Bounds::of([axis.from, axis.to]);
                Bounds {
                    least: ends.least - reach,
                    greatest: ends.greatest + reach,
                }
            }
            Shape::Box(bounds) => *bounds,
            Shape::Mesh(mesh) => *mesh.bounds(),
        }
    }

    /// The shape where its body is.
    pub fn placed(&self, frame_from_body: &IsometryMatrix3<f64>) -> Placed {
        let convex = |core: Core, radius: f64| Solid::Convex(Convex { core, radius }.moved(frame_from_body));
        let solid = match self {
            Shape::Capsule(capsule) => convex(Core::Segment(capsule.axis), capsule.radius),
            Shape::Cylinder(axis, radius) => convex(
                Core::Cylinder {
                    axis: *axis,
                    radius: *radius,
                },
                0.0,
            ),
            Shape::Box(bounds) => {
                let half = bounds.half();
                let half_edges = [0, 1, 2].map(|axis| {
                    let mut edge = Vector3::zeros();
                    edge[axis] = half[axis];
                    edge
                });
                convex(
                    Core::Box {
                        centre: bounds.centre(),
                        half_edges,
                    },
                    0.0,
                )
            }
            Shape::Mesh(mesh) => Solid::Mesh {
                mesh: mesh.clone(),
                from_mesh: *frame_from_body,
                to_mesh: frame_from_body.inverse(),
            },
        };
        Placed {
            solid,
            hull: self.hull().moved(frame_from_body),
        }
    }
}

/// The capsule along the longest edge of a box.
fn around_box(bounds: &Bounds) -> Capsule {
    let (centre, half) = (bounds.centre(), bounds.half());
    let longest = half.imax();
    let mut along = Vector3::zeros();
    along[longest] = half[longest];
    Capsule {
        axis: Segment {
            from: centre - along,
            to: centre + along,
        },
        radius: (half - along).norm(),
    }
}

impl Placed {
    /// A capsule around it.
    pub fn hull(&self) -> &Capsule {
        &self.hull
    }

    /// The nearest points of two shapes, that of this one first; `None` where they are farther apart than `limit`, m.
    pub fn nearest(&self, other: &Placed, limit: f64) -> Option<Nearest> {
        match (&self.solid, &other.solid) {
            (Solid::Convex(first), Solid::Convex(second)) => first.nearest_within(second, limit),
            (
                Solid::Convex(body),
                Solid::Mesh {
                    mesh,
                    from_mesh,
                    to_mesh,
                },
            ) => {
                let found = mesh.nearest_to_convex(&body.moved(to_mesh), &self.hull.moved(to_mesh), limit)?;
                Some(found.moved(from_mesh))
            }
            (Solid::Mesh { .. }, Solid::Convex(_)) => other.nearest(self, limit).map(Nearest::swapped),
            (
                Solid::Mesh {
                    mesh,
                    from_mesh,
                    to_mesh,
                },
                Solid::Mesh {
                    mesh: others,
                    from_mesh: from_others,
                    ..
                },
            ) => {
                let found = mesh.nearest_to_mesh(others, &(to_mesh * from_others), limit)?;
                Some(found.moved(from_mesh))
            }
        }
    }

    /// Its point farthest along a unit vector.
    pub(super) fn farthest_along(&self, direction: &Vector3<f64>) -> Point3<f64> {
        match &self.solid {
            Solid::Convex(Convex { core, radius }) => core.support(direction) + direction * *radius,
            Solid::Mesh {
                mesh,
                from_mesh,
                to_mesh,
            } => from_mesh * mesh.farthest_along(&(to_mesh.rotation * direction)),
        }
    }

    /// Distance of a point from the shape, m; 0 inside, `limit` where it is above that.
    pub fn distance_of(&self, point: &Point3<f64>, limit: f64) -> f64 {
        let ball = Placed::ball(*point, 0.0);
        ball.nearest(self, limit).map_or(limit, |found| found.distance)
    }

    /// A ball.
    fn ball(centre: Point3<f64>, radius: f64) -> Placed {
        let axis = Segment {
            from: centre,
            to: centre,
        };
        Placed {
            solid: Solid::Convex(Convex {
                core: Core::Segment(axis),
                radius,
            }),
            hull: Capsule { axis, radius },
        }
    }

    /// A point of the shape; of a mesh a corner.
    pub(super) fn inner_point(&self) -> Point3<f64> {
        match &self.solid {
            Solid::Convex(convex) => convex.core.inner_point(),
            Solid::Mesh { mesh, from_mesh, .. } => from_mesh * mesh.triangles()[0].0[0],
        }
    }
}

impl Nearest {
    /// In another frame.
    pub(super) fn moved(self, by: &IsometryMatrix3<f64>) -> Nearest {
        Nearest {
            points: self.points.map(|point| by * point),
            ..self
        }
    }
}
