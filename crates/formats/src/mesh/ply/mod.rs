//! PLY: elements with properties that the header lists, without a unit.
//!
//! | element, property | read as |
//! |---|---|
//! | `vertex`: `x`, `y`, `z` of any type | the vertices |
//! | `face`: list `vertex_indices` or `vertex_index` | a polygon; one with fewer than three corners is refused |
//! | `tristrips` | refused |
//! | any other | not used |
//!
//! Elements and properties may be in any order. `header`: what the file contains. `values`: its numbers, one after the
//! other, as text or as bytes of either order.
//!
//! Source: G. Turk, The PLY Polygon File Format (1994).

mod header;
mod values;

use header::{Content, Element, Property};
use values::{Fault, Values};

use super::assembly::{Assembly, Points, checked};
use super::text_lines::NUMBERS;
use super::triangle_mesh::{PointCloud, TriangleMesh};
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// Reads a PLY file; `name` is the path that problems show.
///
/// # Errors
/// See [`read`](super::format::read).
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let (header, lines) = header::read(name, bytes, Content::Mesh)?;
    let mut values = Values::new(bytes, lines, header.encoding);
    let mut problems = Vec::new();
    let mut points = Vec::new();
    let mut faces = None;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => points = vertices(name, element, &mut values, &mut problems)?,
            _ => {
                // Faces may precede the vertices: they are read afterwards.
                if element.name == "face" {
                    faces = Some((element, values.clone()));
                }
                for index in 0..element.count {
                    row(element, &mut values, |_, _| {})
                        .map_err(|fault| values.problem(name, element, index, fault))?;
                }
            }
        }
    }
    let is_at_end = values.is_at_end();
    let assembly = match faces {
        Some((element, values)) => polygons(name, element, values, &points, &mut problems),
        None => Assembly::default(),
    };
    Problems::from(problems).into_result()?;
    let mut mesh = assembly.finish(name)?;
    if !is_at_end {
        mesh.notes
            .push("what follows the last element of the header was not used".to_owned());
    }
    Ok(mesh)
}

/// The points of a PLY file, with or without faces; `name` is the path that problems show.
///
/// # Errors
/// As of [`read`], but faces are neither required nor read.
pub(super) fn read_points(name: &str, bytes: &[u8]) -> Result<PointCloud, Problems> {
    let (header, lines) = header::read(name, bytes, Content::Points)?;
    let mut values = Values::new(bytes, lines, header.encoding);
    let mut problems = Vec::new();
    let mut cloud = PointCloud::default();
    for element in &header.elements {
        if element.name == "vertex" {
            let start = values.clone();
            cloud.points = vertices(name, element, &mut values, &mut problems)?;
            cloud.normals = normals(element, start);
        } else {
            cloud.has_faces |= element.name == "face" && element.count > 0;
            // What follows the vertices is not used.
            if !cloud.points.is_empty() {
                continue;
            }
            for index in 0..element.count {
                row(element, &mut values, |_, _| {})
                    .map_err(|fault| values.problem(name, element, index, fault))?;
            }
        }
    }
    Problems::from(problems).into_result()?;
    Ok(cloud)
}

/// The properties `nx`, `ny`, `nz` of vertices that were read before.
fn normals(element: &Element, mut values: Values<'_>) -> Option<Vec<[f64; 3]>> {
    let names = ["nx", "ny", "nz"];
    let is_normal =
        |axis: usize, property: &Property| property.list_count.is_none() && property.name == names[axis];
    let place = |axis: usize| {
        element
            .properties
            .iter()
            .position(|property| is_normal(axis, property))
    };
    let places = [place(0)?, place(1)?, place(2)?];
    let mut normals = Vec::with_capacity(values.most_rows(element));
    for _ in 0..element.count {
        let mut normal = [0.0; 3];
        let each = |property: usize, value| {
            if let Some(axis) = places.iter().position(|place| *place == property) {
                normal[axis] = value;
            }
        };
        row(element, &mut values, each).ok()?;
        normals.push(normal);
    }
    Some(normals)
}

/// Takes the values of an element; `each` gets the index of a property and a value. Of lists all values, without their
/// number.
///
/// # Errors
/// What is not a number, or the end of the file.
fn row(element: &Element, values: &mut Values<'_>, mut each: impl FnMut(usize, f64)) -> Result<(), Fault> {
    values.begin_row();
    for (index, property) in element.properties.iter().enumerate() {
        match property.list_count {
            None => each(index, values.next(property.scalar)?),
            Some(count) => {
                for _ in 0..values.count(count)? {
                    each(index, values.next(property.scalar)?);
                }
            }
        }
    }
    values.end_row()
}

/// The vertices of the file.
///
/// # Errors
/// What makes the rest of the file unreadable; coordinates that are not accepted are collected.
fn vertices(
    name: &str,
    element: &Element,
    values: &mut Values<'_>,
    problems: &mut Vec<Problem>,
) -> Result<Vec<[f64; 3]>, Problems> {
    let axis_of = |property: &Property| match property.name.as_str() {
        _ if property.list_count.is_some() => None,
        "x" => Some(0),
        "y" => Some(1),
        "z" => Some(2),
        _ => None,
    };
    let axes: Vec<Option<usize>> = element.properties.iter().map(axis_of).collect();
    for axis in 0..3 {
        if !axes.contains(&Some(axis)) {
            let message = format!("the vertices have no property `{}`", ["x", "y", "z"][axis]);
            return Err(Problem::of_file(name, message, "export it again as a mesh").into());
        }
    }
    let mut points = Vec::with_capacity(values.most_rows(element));
    for index in 0..element.count {
        let mut point = [0.0; 3];
        let mut each = |property: usize, value| {
            if let Some(axis) = axes[property] {
                point[axis] = value;
            }
        };
        let taken = row(element, values, &mut each);
        taken.map_err(|fault| values.problem(name, element, index, fault))?;
        let wrong = point.iter().find_map(|value| checked(*value).err());
        if let Some(message) = wrong {
            problems.push(values.problem(name, element, index, Fault::Row(message, NUMBERS)));
            if problems.len() == MOST_PROBLEMS {
                return Err(Problems::from(std::mem::take(problems)));
            }
        }
        points.push(point);
    }
    Ok(points)
}

/// The polygons of the file; their problems are collected.
fn polygons(
    name: &str,
    element: &Element,
    mut values: Values<'_>,
    points: &[[f64; 3]],
    problems: &mut Vec<Problem>,
) -> Assembly {
    let mut assembly = Assembly::default();
    let is_corners = |property: &Property| {
        property.list_count.is_some() && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
    };
    let Some(corners_at) = element.properties.iter().position(is_corners) else {
        let message = "the faces have no list `vertex_indices`";
        problems.push(Problem::of_file(name, message, "export it again as a mesh"));
        return assembly;
    };
    let mut points = Points::new(points);
    let (mut indices, mut corners) = (Vec::new(), Vec::new());
    for index in 0..element.count {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        indices.clear();
        let mut each = |property: usize, value| {
            if property == corners_at {
                indices.push(value);
            }
        };
        // The same row was taken before.
        if row(element, &mut values, &mut each).is_err() {
            break;
        }
        let mut refuse = |message: String, hint| {
            problems.push(values.problem(name, element, index, Fault::Row(message, hint)));
        };
        corners.clear();
        let taken = indices.iter().try_for_each(|value| {
            // Whole numbers up to 2^32 are exact; no other value is the index of a point.
            let point = *value as usize;
            let vertex = (point as f64 == *value).then(|| points.vertex(point, &mut assembly));
            corners.push(vertex.flatten().ok_or(value)?);
            Ok::<(), &f64>(())
        });
        if let Err(value) = taken {
            let message = format!(
                "no vertex has the index {value}: the file has {} vertices",
                points.len()
            );
            refuse(message, "indices count from 0");
        } else if corners.len() < 3 {
            refuse(
                format!("a face with {} corners: at least 3 required", corners.len()),
                "export faces only",
            );
        } else if let Err(refusal) = assembly.polygon(&corners) {
            refuse(refusal.message(), refusal.hint());
            if refusal.is_final() {
                break;
            }
        }
    }
    assembly
}

#[cfg(test)]
mod tests;
