//! The visual scene: nodes within nodes, each with its placement, and the geometries in them.

use std::collections::BTreeMap;

use armill_core::units::from_deg;
use roxmltree::Node;

use super::super::affine::Affine;
use super::super::scene::{Object, Scene};
use super::geometry;
use super::numbers::coordinates;
use crate::document::{MOST_PROBLEMS, Problems, Source};
use crate::xml::{children, tag};

/// Bytes of all nodes that are placed, those within others and those of libraries each time: seconds.
const MOST_NODE_BYTES: usize = 256 << 20;

/// Everything that the scene of the file places, and notes for the user.
///
/// # Errors
/// All problems of geometries; references to nothing, placements that are not accepted, too many of them.
pub(super) fn placed(source: &Source, root: Node<'_, '_>) -> Result<(Scene, Vec<String>), Problems> {
    let (mut geometries, mut problems) = (BTreeMap::new(), Vec::new());
    let mut nodes = BTreeMap::new();
    for node in root.descendants().filter(Node::is_element) {
        let id = node.attribute("id");
        match (node.tag_name().name(), id) {
            ("geometry", _) if problems.len() < MOST_PROBLEMS => match geometry::read(source, node) {
                Ok(object) => drop(geometries.insert(id.unwrap_or_default(), object)),
                Err(wrong) => problems.extend(wrong),
            },
            ("node", Some(id)) => drop(nodes.insert(id, node)),
            _ => {}
        }
    }
    Problems::from(problems).into_result()?;
    let mut walk = Walk {
        source,
        geometries,
        nodes,
        scene: Scene::default(),
        controllers: 0,
        bytes: 0,
    };
    let mut notes = Vec::new();
    match visual_scene(source, root)? {
        Some(scene) => {
            for node in children(scene, "node") {
                walk.node(node, &Affine::IDENTITY, 0)?;
            }
        }
        None => {
            notes
                .push("the file has no visual scene: every geometry is where its coordinates are".to_owned());
            walk.all_geometries(root)?;
        }
    }
    if walk.controllers > 0 {
        notes.push(format!(
            "{} geometries of controllers (skins) are left out",
            walk.controllers
        ));
    }
    Ok((walk.scene, notes))
}

/// The visual scene that `<scene>` names, or the first.
///
/// # Errors
/// A name that no visual scene has.
fn visual_scene<'a, 'input>(
    source: &Source,
    root: Node<'a, 'input>,
) -> Result<Option<Node<'a, 'input>>, Problems> {
    let in_library = |node: &Node<'a, 'input>| node.tag_name().name() == "visual_scene";
    let mut scenes = root.descendants().filter(in_library);
    let instance = root
        .children()
        .filter(|node| node.tag_name().name() == "scene")
        .flat_map(|scene| scene.children())
        .find(|node| node.tag_name().name() == "instance_visual_scene");
    match instance {
        None => Ok(scenes.next()),
        Some(instance) => {
            let name = target(source, instance)?;
            let found = scenes.find(|scene| scene.attribute("id") == Some(name));
            found.map(Some).ok_or_else(|| missing(source, instance, name))
        }
    }
}

/// What the attribute `url` of an element refers to, without `#`.
fn target<'a>(source: &Source, node: Node<'a, '_>) -> Result<&'a str, Problems> {
    node.attribute("url")
        .and_then(|url| url.trim().strip_prefix('#'))
        .ok_or_else(|| {
            let message = "the attribute `url` does not refer to an element of this file".to_owned();
            source.problem(tag(node), message, None).into()
        })
}

/// The problem of a name that nothing has.
fn missing(source: &Source, node: Node<'_, '_>, name: &str) -> Problems {
    let message = format!("nothing of this file has the id `{name}`");
    source.problem(tag(node), message, None).into()
}

/// What is wrong with an element, and a hint, as its problem.
fn refused_at(source: &Source, node: Node<'_, '_>, (message, hint): (String, &str)) -> Problems {
    source.problem(tag(node), message, Some(hint.to_owned())).into()
}

/// The nodes so far.
struct Walk<'a, 'input> {
    source: &'a Source,
    geometries: BTreeMap<&'a str, Object>,
    nodes: BTreeMap<&'a str, Node<'a, 'input>>,
    scene: Scene,
    /// Instances of controllers.
    controllers: usize,
    /// Bytes of the nodes so far.
    bytes: usize,
}

impl<'a, 'input> Walk<'a, 'input> {
    /// A node, which is in another one that is placed at `outer`.
    fn node(&mut self, node: Node<'a, 'input>, outer: &Affine, level: usize) -> Result<(), Problems> {
        let refused = |fault| refused_at(self.source, node, fault);
        self.scene.enter(level).map_err(refused)?;
        self.bytes += node.range().len();
        if self.bytes > MOST_NODE_BYTES {
            let message = format!("the placed nodes have more than {MOST_NODE_BYTES} bytes");
            return Err(refused((message, "place each node once")));
        }
        let mut placement = *outer;
        for step in node.children().filter(Node::is_element) {
            if let Some(moved) = transform(self.source, step)? {
                placement = placement.after(&moved);
            }
        }
        if !placement.is_finite() {
            let message = "the placement of this node is not finite".to_owned();
            return Err(refused((message, "check its transforms")));
        }
        for inner in node.children().filter(Node::is_element) {
            match inner.tag_name().name() {
                "node" => self.node(inner, &placement, level + 1)?,
                "instance_node" => {
                    let name = target(self.source, inner)?;
                    let found = self.nodes.get(name).copied();
                    let found = found.ok_or_else(|| missing(self.source, inner, name))?;
                    self.node(found, &placement, level + 1)?;
                }
                "instance_geometry" => {
                    let name = target(self.source, inner)?;
                    let object = self.geometries.get(name);
                    let object = object.ok_or_else(|| missing(self.source, inner, name))?;
                    let added = self.scene.place(object, &placement);
                    added.map_err(|(message, hint)| {
                        refused_at(
                            self.source,
                            inner,
                            (format!("geometry `{name}`: {message}"), hint),
                        )
                    })?;
                }
                "instance_controller" => self.controllers += 1,
                _ => {}
            }
        }
        Ok(())
    }

    /// Every geometry, without a scene.
    fn all_geometries(&mut self, root: Node<'_, '_>) -> Result<(), Problems> {
        for (name, object) in &self.geometries {
            let added = self.scene.place(object, &Affine::IDENTITY);
            added.map_err(|(message, hint)| {
                refused_at(self.source, root, (format!("geometry `{name}`: {message}"), hint))
            })?;
        }
        Ok(())
    }
}

/// The transform that an element of a node is; `None` for any other element.
///
/// # Errors
/// Another number of values than required; `skew` and `lookat`, which are not read.
fn transform(source: &Source, step: Node<'_, '_>) -> Result<Option<Affine>, Problems> {
    let name = step.tag_name().name();
    let required = match name {
        "matrix" => 16,
        "translate" | "scale" => 3,
        "rotate" => 4,
        "skew" | "lookat" => {
            let message = format!("<{name}> is not read");
            let hint = "export the transform as a matrix".to_owned();
            return Err(source.problem(tag(step), message, Some(hint)).into());
        }
        _ => return Ok(None),
    };
    let values = coordinates(source, step)?;
    if values.len() != required {
        let message = format!("<{name}> with {} numbers: {required} required", values.len());
        return Err(source.problem(tag(step), message, None).into());
    }
    let mut moved = Affine::IDENTITY;
    match name {
        "matrix" => {
            for (row, numbers) in moved.0.iter_mut().zip(values.chunks_exact(4)) {
                row.copy_from_slice(numbers);
            }
        }
        "translate" => (0..3).for_each(|axis| moved.0[axis][3] = values[axis]),
        "scale" => (0..3).for_each(|axis| moved.0[axis][axis] = values[axis]),
        _ => moved = rotation([values[0], values[1], values[2]], from_deg(values[3])),
    }
    Ok(Some(moved))
}

/// The rotation about an axis of any length through the origin, by an angle in rad (Rodrigues); none about an axis of
/// length 0.
fn rotation(axis: [f64; 3], angle: f64) -> Affine {
    let length = axis.iter().map(|value| value * value).sum::<f64>().sqrt();
    if length == 0.0 {
        return Affine::IDENTITY;
    }
    let [x, y, z] = axis.map(|value| value / length);
    let (s, c) = angle.sin_cos();
    let d = 1.0 - c;
    Affine([
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0.0],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0.0],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0.0],
    ])
}
