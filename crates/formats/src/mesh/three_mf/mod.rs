//! 3MF: a zip archive with XML models.
//!
//! | part | read as |
//! |---|---|
//! | `_rels/.rels` | which part is the model; `3D/3dmodel.model` if it does not say so |
//! | `model unit` | the unit: micron, millimeter (default), centimeter, inch, foot, meter |
//! | `object`: `mesh` | points and triangles |
//! | `object`: `components` | other objects, each with its transform, also of other parts (production extension) |
//! | `build`: `item` | the objects that are there, each with its transform |
//! | objects of type `support`, `solidsupport` | left out |
//!
//! `package`: parts of the archive, unpacked. `model`: one XML model. Models are read as a stream of elements, since a
//! tree of millions of them would take gigabytes.
//!
//! Source: 3MF Consortium, 3D Manufacturing Format, Core Specification 1.3; Production Extension 1.1.

mod model;
mod package;

use std::collections::BTreeMap;

use model::{Content, Model, Placed};
use package::Package;

use super::affine::Affine;
use super::scene::Scene;
use super::triangle_mesh::TriangleMesh;
use super::unit::MeshUnit;
use crate::document::{Problem, Problems};

/// No file has more models: one for each object.
const MOST_MODELS: usize = 10_000;

/// Reads a 3MF file; `name` is the path that problems show.
///
/// # Errors
/// See [`read`](super::format::read).
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Problems> {
    let mut package = Package::open(name, bytes)?;
    let root = package.model_path(name)?;
    let models = models(name, &mut package, &root)?;
    let mut build = Build {
        name,
        models: &models,
        scene: Scene::default(),
        left_out: 0,
    };
    let Some(model) = models.get(&root) else {
        return Err(Problem::of_file(name, "the archive has no model", "export it again as 3MF").into());
    };
    for item in &model.items {
        build.place(item, &root, &Affine::IDENTITY, 0)?;
    }
    let (left_out, scene) = (build.left_out, build.scene);
    let mut mesh = scene.finish(name)?;
    mesh.unit = Some(model.unit.unwrap_or_else(MeshUnit::millimetre));
    if left_out > 0 {
        mesh.notes
            .push(format!("{left_out} support structures of the file are left out"));
    }
    Ok(mesh)
}

/// The model `root` and all that it refers to, by path.
fn models(name: &str, package: &mut Package<'_>, root: &str) -> Result<BTreeMap<String, Model>, Problems> {
    let mut models = BTreeMap::new();
    let mut required = vec![root.to_owned()];
    while let Some(path) = required.pop() {
        if models.contains_key(&path) {
            continue;
        }
        if models.len() == MOST_MODELS {
            let message = format!("more than {MOST_MODELS} models in one archive");
            return Err(Problem::of_file(name, message, "split it").into());
        }
        let model = model::read(name, &path, &package.part(name, &path)?)?;
        let placed =
            model
                .items
                .iter()
                .chain(model.objects.values().flat_map(|object| match &object.content {
                    Content::Components(placed) => placed.as_slice(),
                    Content::Mesh(_) => &[],
                }));
        required.extend(placed.filter_map(|placed| placed.path.clone()));
        models.insert(path, model);
    }
    // Lengths of all models have the unit of the first.
    let unit = |model: &Model| model.unit.map_or(MeshUnit::millimetre(), |unit| unit);
    if let Some(first) = models.get(root)
        && let Some((path, _)) = models.iter().find(|(_, model)| unit(model) != unit(first))
    {
        let message = format!("the model `{path}` has another unit than `{root}`");
        return Err(Problem::of_file(name, message, "export it again in one unit").into());
    }
    Ok(models)
}

/// The objects of the build, as far as they are placed.
struct Build<'a> {
    name: &'a str,
    models: &'a BTreeMap<String, Model>,
    scene: Scene,
    /// Placements of supports.
    left_out: usize,
}

impl Build<'_> {
    /// Adds an item or component of the model `path`, which is in an assembly at `outer`, at level `level`.
    fn place(&mut self, placed: &Placed, path: &str, outer: &Affine, level: usize) -> Result<(), Problems> {
        let refused = |(message, hint): (String, &str)| {
            let message = format!("`{path}`, line {}: object {}: {message}", placed.line, placed.id);
            Problems::from(Problem::of_file(self.name, message, hint))
        };
        self.scene.enter(level).map_err(refused)?;
        let path = placed.path.as_deref().unwrap_or(path);
        let object = self
            .models
            .get(path)
            .and_then(|model| model.objects.get(&placed.id));
        let Some(object) = object else {
            let message = format!("`{path}` has no such object");
            return Err(refused((message, "the file is damaged: export it again")));
        };
        if object.is_support {
            self.left_out += 1;
            return Ok(());
        }
        let placement = outer.after(&placed.transform);
        match &object.content {
            Content::Mesh(mesh) => self.scene.place(mesh, &placement).map_err(refused),
            Content::Components(inner) => inner
                .iter()
                .try_for_each(|inner| self.place(inner, path, &placement, level + 1)),
        }
    }
}

#[cfg(test)]
mod tests;
