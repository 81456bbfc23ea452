//! Capsules around the collision meshes of a robot's links, as bodies of a robot file.
//!
//! | number | meaning |
//! |---|---|
//! | accuracy | bound of the largest distance of the surface of a capsule from its link: that of points of a grid on the capsule, and half the diagonal of its squares |
//! | volume ratio | volume of all capsules over that of all meshes; more than 1 although capsules may overlap |
//!
//! Ends are rounded to whole millimetres; then the diameter is the smallest whole millimetre with which the capsule contains every corner of its
//! part of the surface.

use std::path::Path;

use armill_core::clearance::enclosing::{about_axis, enclosing_capsules};
use armill_core::clearance::{ArmBody, Capsule, Mesh, Role, Segment, Shape};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{self, IsometryMatrix3, Point3, Vector3};
use armill_core::units::{from_mm, to_mm};
use armill_formats::robot::{BodyNote, RobotDescription};
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

use crate::body_answers::BodyDetails;
use crate::error::StudyError;
use crate::input::cell::links::LinkBodies;
use crate::robots;

/// Key of the source of the capsules.
const SOURCE: &str = "collision meshes";
/// Spacing of the grid on a capsule, m.
const SPACING: f64 = 0.004;
/// Accuracies are rounded up to a multiple of this, mm.
const ACCURACY_STEP_MM: f64 = 5.0;

/// Capsules around the links of a robot.
#[derive(Clone, Debug)]
pub struct EnclosedLinks {
    /// The robot, with the capsules as its bodies and their source alone.
    pub robot: RobotDescription,
    /// Volume of all capsules over that of all meshes; `None` where a mesh is open.
    pub volume_ratio: Option<f64>,
}

/// What came of it, as JSON.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EnclosedLinksAnswer {
    /// The file that was written; none if it was printed.
    pub file: Option<String>,
    /// The tables, if they were printed.
    pub text: Option<String>,
    /// The capsules.
    pub bodies: Vec<BodyDetails>,
    /// Volume of all capsules over that of all meshes; none where a mesh is open.
    pub volume_ratio: Option<f64>,
}

impl EnclosedLinks {
    /// At most `most` capsules around each collision mesh of the robot in this file.
    ///
    /// # Errors
    /// The problems of the file and of its meshes; a robot without meshes.
    pub fn of(file: &str, most: usize) -> Result<EnclosedLinks, StudyError> {
        let folder = Path::new(".");
        let mut robot = robots::find(file, folder)?;
        robot.bodies.clear();
        let found = LinkBodies::of(&robot, file, folder)?;
        if found.links.is_empty() {
            let message = found
                .notes
                .into_iter()
                .next()
                .unwrap_or_else(|| format!("`{file}` has no collision meshes"));
            return Err(StudyError::value(
                message,
                "a URDF or xacro whose collision meshes are in its folder",
            ));
        }
        let (mut bodies, mut body_notes) = (Vec::new(), Vec::new());
        let (mut of_capsules, mut of_meshes) = (0.0, Some(0.0));
        for link in &found.links {
            let Shape::Mesh(mesh) = &link.shape else { continue };
            let surface = in_attachment(mesh, &link.attachment_from_body);
            of_meshes = of_meshes
                .filter(|_| mesh.is_closed())
                .map(|sum| sum + volume(&surface));
            let earlier = found.links.iter().take_while(|other| !std::ptr::eq(*other, link));
            let before: usize = earlier.filter(|other| other.name == link.name).count() * most;
            let attachment_from_mesh: IsometryMatrix3<f64> = nalgebra::convert(link.attachment_from_body);
            let placed = link.shape.placed(&attachment_from_mesh);
            for (index, part) in enclosing_capsules(&surface, most).into_iter().enumerate() {
                let capsule = in_whole_millimetres(&part.capsule, &part.surface);
                let distance = |point: &Point3<f64>| placed.distance_of(point, f64::INFINITY);
                let farthest = points_on(&capsule).iter().map(distance).fold(0.0, f64::max);
                let bound_mm = to_mm(farthest + SPACING * std::f64::consts::FRAC_1_SQRT_2);
                of_capsules += volume_of(&capsule);
                bodies.push(ArmBody {
                    name: name_of(&link.name, before + index),
                    attachment: link.attachment,
                    attachment_from_body: Isometry::identity(),
                    shape: Shape::Capsule(capsule),
                    role: Role::Link,
                });
                body_notes.push(BodyNote {
                    accuracy_mm: Some((bound_mm / ACCURACY_STEP_MM).ceil() * ACCURACY_STEP_MM),
                    source: SOURCE.to_owned(),
                });
            }
        }
        robot.sources = vec![source_of(file)];
        robot.bodies = bodies;
        robot.body_notes = body_notes;
        robot.apart = Vec::new();
        Ok(EnclosedLinks {
            robot,
            volume_ratio: of_meshes.map(|meshes| of_capsules / meshes),
        })
    }

    /// What came of it, with `text` written to `file`.
    pub fn answer(&self, file: Option<String>, text: &str) -> EnclosedLinksAnswer {
        EnclosedLinksAnswer {
            text: file.is_none().then(|| text.to_owned()),
            file,
            bodies: BodyDetails::all_of(&self.robot),
            volume_ratio: self.volume_ratio,
        }
    }
}

/// The source of capsules around the meshes of this file.
fn source_of(file: &str) -> Source {
    let name = Path::new(file)
        .file_name()
        .map_or_else(|| file.into(), |name| name.to_string_lossy());
    Source {
        key: SOURCE.to_owned(),
        what: "capsules that enclose the collision meshes of the links, fitted by armill robots bodies"
            .to_owned(),
        place: format!("the meshes that {name} names"),
        licence: "that of the meshes".to_owned(),
    }
}

/// A name of its own for each capsule of a link.
fn name_of(link: &str, index: usize) -> String {
    match index {
        0 => link.to_owned(),
        index => format!("{link} {}", index + 1),
    }
}

/// The triangles of a mesh, in the frame of the attachment.
fn in_attachment(mesh: &Mesh, attachment_from_body: &Isometry) -> Vec<[Point3<f64>; 3]> {
    let triangles = mesh.triangles().iter();
    triangles
        .map(|triangle| triangle.0.map(|corner| attachment_from_body * corner))
        .collect()
}

/// Volume of a closed surface, m^3: that of the tetrahedra from the origin.
fn volume(surface: &[[Point3<f64>; 3]]) -> f64 {
    let six_times = |[a, b, c]: &[Point3<f64>; 3]| a.coords.dot(&b.coords.cross(&c.coords));
    surface.iter().map(six_times).sum::<f64>().abs() / 6.0
}

/// Volume of a capsule, m^3.
fn volume_of(capsule: &Capsule) -> f64 {
    let r = capsule.radius;
    std::f64::consts::PI * r * r * ((capsule.axis.to - capsule.axis.from).norm() + 4.0 / 3.0 * r)
}

/// The capsule with ends in whole millimetres around its part of the surface.
fn in_whole_millimetres(capsule: &Capsule, surface: &[[Point3<f64>; 3]]) -> Capsule {
    let whole = |point: Point3<f64>| from_mm(to_mm(point).map(f64::round));
    let axis = Segment {
        from: whole(capsule.axis.from),
        to: whole(capsule.axis.to),
    };
    let corners: Vec<Point3<f64>> = surface.iter().flatten().copied().collect();
    let diameter_mm = to_mm(2.0 * about_axis(axis, &corners).radius).ceil();
    Capsule {
        axis,
        radius: 0.5 * from_mm(diameter_mm),
    }
}

/// Points of a capsule's surface: none of it is farther from the nearest of them than half the diagonal of squares of the spacing.
fn points_on(capsule: &Capsule) -> Vec<Point3<f64>> {
    let Capsule { axis, radius } = capsule;
    let along = axis.to - axis.from;
    let length = along.norm();
    let unit = along.try_normalize(0.0).unwrap_or_else(Vector3::z);
    let across = unit
        .cross(&if unit.x.abs() < 0.7 {
            Vector3::x()
        } else {
            Vector3::y()
        })
        .normalize();
    let other = unit.cross(&across);
    // The meridian: a quarter circle, the line, a quarter circle; walked in equal steps.
    let quarter = std::f64::consts::FRAC_PI_2 * radius;
    let steps = ((2.0 * quarter + length) / SPACING).ceil().max(1.0);
    let mut points = Vec::new();
    for step in 0..=steps as usize {
        let way = (2.0 * quarter + length) * step as f64 / steps;
        let (height, out) = if way < quarter {
            let angle = way / radius;
            (-radius * angle.cos(), radius * angle.sin())
        } else if way <= quarter + length {
            (way - quarter, *radius)
        } else {
            let angle = (way - quarter - length) / radius;
            (length + radius * angle.sin(), radius * angle.cos())
        };
        let around = (std::f64::consts::TAU * out / SPACING).ceil().max(1.0);
        for turn in 0..around as usize {
            let (sin, cos) = (std::f64::consts::TAU * turn as f64 / around).sin_cos();
            points.push(axis.from + unit * height + (across * cos + other * sin) * out);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capsule(length: f64) -> Capsule {
        Capsule {
            axis: Segment {
                from: Point3::new(0.1, 0.2, -0.3),
                to: Point3::new(0.1, 0.2 + length, -0.3),
            },
            radius: 0.05,
        }
    }

    #[test]
    fn points_are_on_the_capsule_and_near_every_other_point_of_it() {
        for length in [0.0, 0.12] {
            let own = capsule(length);
            let points = points_on(&own);
            for point in &points {
                let distance = (own.axis.nearest_to_point(point) - point).norm();
                assert!((distance - 0.05).abs() < 1e-12, "{distance}");
            }
            // Directions that are not those of the grid.
            for k in 0..200 {
                let angle = f64::from(k) * 2.399_963;
                let z = 1.0 - (f64::from(k) + 0.5) / 100.0;
                let r = (1.0 - z * z).max(0.0).sqrt();
                let direction = Vector3::new(r * angle.cos(), z, r * angle.sin());
                let end = if z > 0.0 { own.axis.to } else { own.axis.from };
                let on = end + direction * 0.05;
                let nearest = points
                    .iter()
                    .map(|point| (point - on).norm())
                    .fold(f64::INFINITY, f64::min);
                assert!(
                    nearest <= SPACING * std::f64::consts::FRAC_1_SQRT_2 + 1e-12,
                    "{nearest}"
                );
            }
        }
    }

    #[test]
    fn volumes_of_a_tetrahedron_and_a_ball() {
        let [o, x, y, z] = [[1.0; 3], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]].map(Point3::from);
        let surface = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
        assert!((volume(&surface) - 1.0 / 6.0).abs() < 1e-12);
        assert!(
            (volume_of(&capsule(0.0)) - 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3)).abs() < 1e-15
        );
    }

    #[test]
    fn whole_millimetres_still_contain_every_corner() {
        let corners = [[0.0013, 0.0, 0.0], [0.1, 0.0337, 0.01], [0.05, -0.02, 0.0371]].map(Point3::from);
        let tight = about_axis(
            Segment {
                from: corners[0],
                to: corners[1],
            },
            &corners,
        );
        let whole = in_whole_millimetres(&tight, &[corners]);
        for corner in &corners {
            let distance = (whole.axis.nearest_to_point(corner) - corner).norm();
            assert!(distance <= whole.radius + 1e-12 && whole.radius < tight.radius + 0.002);
        }
    }
}
