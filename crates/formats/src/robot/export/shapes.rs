//! Shapes of links as elements of URDF, SDF and MJCF.
//!
//! A capsule is a cylinder and two spheres in URDF, which has no capsule. A shape of another kind than capsule, cylinder, box and mesh file is
//! left out: bodies that are meshes in memory have no file.

use armill_core::clearance::Shape;
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};

use super::bodies::{BodyShape, Geometry};
use super::spelling::{attribute, number, vector};

/// A primitive shape, placed: its z axis is that of a cylinder or capsule.
#[derive(Clone, Debug)]
pub(super) enum Primitive {
    /// Lengths of its edges, m.
    Box(Vector3<f64>),
    /// Radius, and distance of its flat ends, m.
    Cylinder(f64, f64),
    /// Radius, and distance of the centres of its round ends, m.
    Capsule(f64, f64),
    /// Radius, m.
    Sphere(f64),
    /// File, scale, and whether it is how the link looks.
    Mesh(String, [f64; 3], bool),
}

/// The shapes of a body, each in the frame of the body.
pub(super) fn primitives(shape: &BodyShape) -> Option<(Isometry, Primitive)> {
    let placed = |here: Isometry, primitive| Some((shape.body_from_shape * here, primitive));
    match &shape.geometry {
        Geometry::Mesh { file, scale, looks } => placed(
            Isometry::identity(),
            Primitive::Mesh(file.clone(), *scale, *looks),
        ),
        Geometry::Solid(Shape::Box(bounds)) => {
            let centre = Isometry::from_parts(bounds.centre().into(), UnitQuaternion::identity());
            placed(centre, Primitive::Box(bounds.half() * 2.0))
        }
        Geometry::Solid(Shape::Capsule(capsule)) => {
            let (here, length) = along(&capsule.axis.from, &capsule.axis.to);
            match length > 0.0 {
                true => placed(here, Primitive::Capsule(capsule.radius, length)),
                false => placed(here, Primitive::Sphere(capsule.radius)),
            }
        }
        Geometry::Solid(Shape::Cylinder(axis, radius)) => {
            let (here, length) = along(&axis.from, &axis.to);
            placed(here, Primitive::Cylinder(*radius, length))
        }
        Geometry::Solid(Shape::Mesh(_)) => None,
    }
}

/// The frame in the middle between two points, its z axis along both; and their distance.
fn along(from: &Point3<f64>, to: &Point3<f64>) -> (Isometry, f64) {
    let axis = to - from;
    let length = axis.norm();
    let turn = match length > 0.0 {
        // Half a turn about x where the axis is opposite to z.
        true => UnitQuaternion::rotation_between(&Vector3::z(), &axis)
            .unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI)),
        false => UnitQuaternion::identity(),
    };
    let middle = Point3::from((from.coords + to.coords) * 0.5);
    (Isometry::from_parts(middle.into(), turn), length)
}

/// `<geometry>` elements of URDF with the pose of each; several for a capsule.
pub(super) fn urdf_geometry(pose: &Isometry, primitive: &Primitive) -> Vec<(Isometry, String)> {
    let one = |inner: String| vec![(*pose, format!("<geometry>{inner}</geometry>"))];
    match primitive {
        Primitive::Box(edges) => one(format!("<box size=\"{}\"/>", vector(edges))),
        Primitive::Cylinder(radius, length) => one(cylinder(*radius, *length)),
        Primitive::Sphere(radius) => one(sphere(*radius)),
        Primitive::Mesh(file, scale, _) => {
            let scale = match scale {
                [1.0, 1.0, 1.0] => String::new(),
                scale => format!(" scale=\"{}\"", scale.map(number).join(" ")),
            };
            one(format!("<mesh filename=\"{}\"{scale}/>", attribute(file)))
        }
        Primitive::Capsule(radius, length) => {
            let end = |at: f64| {
                let here = Isometry::translation(0.0, 0.0, at);
                (pose * here, format!("<geometry>{}</geometry>", sphere(*radius)))
            };
            let half = 0.5 * length;
            let middle = (
                *pose,
                format!("<geometry>{}</geometry>", cylinder(*radius, *length)),
            );
            vec![middle, end(-half), end(half)]
        }
    }
}

fn cylinder(radius: f64, length: f64) -> String {
    format!(
        "<cylinder radius=\"{}\" length=\"{}\"/>",
        number(radius),
        number(length)
    )
}

fn sphere(radius: f64) -> String {
    format!("<sphere radius=\"{}\"/>", number(radius))
}
