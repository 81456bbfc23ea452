//! COLLADA (DAE) 1.4 and 1.5: geometries that the visual scene places.
//!
//! | element | read as |
//! |---|---|
//! | `asset/unit meter` | the unit; 1 m if it is left out |
//! | `asset/up_axis` | not applied, with a note unless it is `Z_UP` |
//! | `scene/instance_visual_scene` | the scene; the first of the file if it is left out |
//! | `node`: `matrix`, `translate`, `rotate`, `scale` | its placement, in their order |
//! | `instance_geometry`, `instance_node` | a geometry, a further node |
//! | `triangles`, `polylist`, `polygons`, `tristrips`, `trifans` | polygons |
//! | `instance_controller`, lines, cameras, lights, materials | not used; controllers with a note |
//!
//! `up_axis` is not applied since RViz, MoveIt and Drake do not apply it to meshes of a URDF, whose makers adapt their
//! files to that; the unit is applied by all of them.
//!
//! `geometry`: polygons of a geometry. `nodes`: the scene. `numbers`: the text of an element as numbers.
//!
//! Source: Khronos Group, COLLADA 1.4.1 Digital Asset Schema Specification (2008); RViz, issue 1045 and
//! `mesh_loader.cpp` (`AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION`).

mod geometry;
mod nodes;
mod numbers;

use roxmltree::Node;

use super::triangle_mesh::TriangleMesh;
use super::unit::MeshUnit;
use crate::document::{Problems, Source};
use crate::xml::{self, children};

/// Reads a COLLADA file; `name` is the path that problems show.
///
/// # Errors
/// See [`read`](super::format::read).
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let source = Source::new(name, &String::from_utf8_lossy(bytes));
    let document = xml::parse(&source)?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        let message = format!("<{}> is not a COLLADA file", root.tag_name().name());
        return Err(source.problem(xml::tag(root), message, None).into());
    }
    let asset = children(root, "asset").next();
    let unit = unit(&source, asset)?;
    let (scene, mut notes) = nodes::placed(&source, root)?;
    let mut mesh = scene.finish(name)?;
    let up_axis = asset.and_then(|asset| children(asset, "up_axis").next());
    let up_axis = up_axis.and_then(|axis| axis.text()).map_or("Y_UP", str::trim);
    if up_axis != "Z_UP" {
        notes.push(format!(
            "up_axis is {up_axis}: it is not applied, as RViz does not for meshes of a URDF"
        ));
    }
    mesh.notes = notes;
    mesh.unit = Some(unit);
    Ok(mesh)
}

/// The unit of the file.
///
/// # Errors
/// A length that is not a number, or not that of a unit.
fn unit(source: &Source, asset: Option<Node<'_, '_>>) -> Result<MeshUnit, Problems> {
    let Some(unit) = asset.and_then(|asset| children(asset, "unit").next()) else {
        return Ok(MeshUnit::METRE);
    };
    let [metres] = xml::numbers(source, unit, "meter", [1.0])?;
    MeshUnit::of_metres(metres).ok_or_else(|| {
        let message = format!("a unit of {metres} m is not accepted: from 1e-9 to 1e6 m");
        source
            .problem(xml::value_place(unit, "meter"), message, None)
            .into()
    })
}

#[cfg(test)]
mod tests;
