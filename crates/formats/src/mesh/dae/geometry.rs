//! The polygons of a geometry.
//!
//! ```text
//! triangles | polylist: input semantic="VERTEX" -> vertices: input semantic="POSITION" -> source: float_array
//! p: indices, as many for each corner as the inputs have offsets
//! ```

use std::collections::BTreeMap;

use roxmltree::Node;

use super::super::scene::Object;
use super::numbers::{coordinates, indices};
use crate::document::{Problems, Source};
use crate::xml::{children, tag};

/// More values for a corner than this are not accepted: position, normal, some textures and colours.
const MOST_OFFSETS: usize = 64;

/// The points and polygons of a `<geometry>`.
///
/// # Errors
/// References to nothing, lists of the wrong length, numbers that are not accepted.
pub(super) fn read(source: &Source, geometry: Node<'_, '_>) -> Result<Object, Problems> {
    let mut object = Object::default();
    let Some(mesh) = children(geometry, "mesh").next() else {
        // A spline or a convex hull of another geometry.
        return Ok(object);
    };
    let parts = Parts::new(mesh);
    // Where the points of a source begin and end in the object.
    let mut ranges: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for primitive in mesh.children().filter(Node::is_element) {
        let Some(layout) = layout(source, &parts, primitive)? else {
            continue;
        };
        let range = match ranges.get(layout.positions) {
            Some(range) => *range,
            None => {
                let start = object.points.len();
                object
                    .points
                    .extend(points(source, &parts, primitive, layout.positions)?);
                let range = [start, object.points.len()];
                ranges.insert(layout.positions, range);
                range
            }
        };
        polygons(source, primitive, &layout, range, &mut object)?;
    }
    Ok(object)
}

/// The parts of a mesh that others refer to, by their id; of several with one id the first.
struct Parts<'a, 'input> {
    sources: BTreeMap<&'a str, Node<'a, 'input>>,
    /// The input with the semantic POSITION of each `<vertices>`.
    positions: BTreeMap<&'a str, Option<Node<'a, 'input>>>,
}

impl<'a, 'input: 'a> Parts<'a, 'input> {
    fn new(mesh: Node<'a, 'input>) -> Parts<'a, 'input> {
        let (mut sources, mut positions) = (BTreeMap::new(), BTreeMap::new());
        for node in mesh.children().filter(Node::is_element) {
            match (node.tag_name().name(), node.attribute("id")) {
                ("source", Some(id)) => drop(sources.entry(id).or_insert(node)),
                ("vertices", Some(id)) => {
                    let is_position = |input: &Node<'_, '_>| input.attribute("semantic") == Some("POSITION");
                    let position = children(node, "input").find(is_position);
                    positions.entry(id).or_insert(position);
                }
                _ => {}
            }
        }
        Parts { sources, positions }
    }
}

/// How corners are grouped to polygons.
#[derive(Clone, Copy)]
enum Kind {
    /// Three each.
    Triangles,
    /// By the numbers in `<vcount>`.
    Counted,
    /// Each `<p>` is a polygon.
    Whole,
    /// Each `<p>` is a strip of triangles.
    Strip,
    /// Each `<p>` is a fan of triangles.
    Fan,
}

/// How a primitive refers to its points.
struct Layout<'a> {
    kind: Kind,
    /// Indices for each corner, and which of them is that of the point.
    stride: usize,
    offset: usize,
    /// The source of the points.
    positions: &'a str,
}

/// The inputs of a primitive; `None` for any other element, and for one without corners.
fn layout<'a>(
    source: &Source,
    parts: &Parts<'a, '_>,
    primitive: Node<'a, '_>,
) -> Result<Option<Layout<'a>>, Problems> {
    let kind = match primitive.tag_name().name() {
        "triangles" => Kind::Triangles,
        "polylist" => Kind::Counted,
        "polygons" => Kind::Whole,
        "tristrips" => Kind::Strip,
        "trifans" => Kind::Fan,
        _ => return Ok(None),
    };
    let refused =
        |node: Node<'_, '_>, message: String| Problems::from(source.problem(tag(node), message, None));
    let (mut stride, mut vertex) = (0, None);
    for input in children(primitive, "input") {
        let offset = input
            .attribute("offset")
            .map_or(Some(0), |text| text.trim().parse().ok());
        let offset = offset.filter(|offset| *offset < MOST_OFFSETS).ok_or_else(|| {
            refused(
                input,
                format!("the offset of an input is a number below {MOST_OFFSETS}"),
            )
        })?;
        stride = stride.max(offset + 1);
        if input.attribute("semantic") == Some("VERTEX") {
            vertex = Some((offset, reference(source, input)?));
        }
    }
    let Some((offset, vertices)) = vertex else {
        let is_empty = primitive
            .attribute("count")
            .is_none_or(|count| count.trim() == "0");
        return match is_empty {
            true => Ok(None),
            false => Err(refused(
                primitive,
                "there is no input with the semantic VERTEX".to_owned(),
            )),
        };
    };
    let position = parts.positions.get(vertices).copied().flatten();
    let position = position.ok_or_else(|| {
        refused(
            primitive,
            format!("`#{vertices}` has no input with the semantic POSITION"),
        )
    })?;
    Ok(Some(Layout {
        kind,
        stride,
        offset,
        positions: reference(source, position)?,
    }))
}

/// What the attribute `source` of an element refers to, without `#`.
fn reference<'a>(source: &Source, node: Node<'a, '_>) -> Result<&'a str, Problems> {
    let text = node.attribute("source").and_then(|text| text.strip_prefix('#'));
    text.ok_or_else(|| {
        let message = "the attribute `source` does not refer to an element of this file".to_owned();
        source.problem(tag(node), message, None).into()
    })
}

/// The points of the source of this name.
fn points(
    source: &Source,
    parts: &Parts<'_, '_>,
    primitive: Node<'_, '_>,
    name: &str,
) -> Result<Vec<[f64; 3]>, Problems> {
    let found = parts.sources.get(name).copied();
    let array = found.and_then(|node| children(node, "float_array").next());
    let (Some(found), Some(array)) = (found, array) else {
        let message = format!("the source `#{name}` with a float_array is missing");
        return Err(source.problem(tag(primitive), message, None).into());
    };
    let values = coordinates(source, array)?;
    let accessor = children(found, "technique_common")
        .next()
        .and_then(|technique| children(technique, "accessor").next());
    let of_accessor = |attribute: &str, default: usize| {
        let text = accessor.and_then(|accessor| accessor.attribute(attribute));
        text.map_or(Some(default), |text| text.trim().parse::<usize>().ok())
    };
    let (stride, offset) = (of_accessor("stride", 3), of_accessor("offset", 0));
    let (Some(stride), Some(offset)) = (stride.filter(|stride| *stride >= 3), offset) else {
        let message = "an accessor of points has a stride of at least 3".to_owned();
        return Err(source
            .problem(tag(accessor.unwrap_or(found)), message, None)
            .into());
    };
    let announced = of_accessor("count", values.len() / stride);
    let values = values.get(offset..).unwrap_or_default();
    let points: Vec<[f64; 3]> = values
        .chunks(stride)
        .filter_map(|chunk| chunk.first_chunk::<3>().copied())
        .collect();
    match announced {
        Some(count) if count <= points.len() => Ok(points),
        _ => {
            let message = format!(
                "the array has {} points, fewer than its accessor announces",
                points.len()
            );
            let hint = "the file is cut short: export it again".to_owned();
            Err(source.problem(tag(array), message, Some(hint)).into())
        }
    }
}

/// Adds the polygons of a primitive; `[first, end]` are those points of the object that it may refer to.
fn polygons(
    source: &Source,
    primitive: Node<'_, '_>,
    layout: &Layout<'_>,
    [first, end]: [usize; 2],
    object: &mut Object,
) -> Result<(), Problems> {
    let counts = match (layout.kind, children(primitive, "vcount").next()) {
        (Kind::Counted, Some(node)) => indices(source, node)?,
        _ => Vec::new(),
    };
    for node in primitive.children().filter(Node::is_element) {
        // A polygon with holes has its outer side in a `<ph>`.
        if node.tag_name().name() == "ph" {
            let hint = "export triangles".to_owned();
            let message = "a polygon with holes is not read".to_owned();
            return Err(source.problem(tag(node), message, Some(hint)).into());
        }
        if node.tag_name().name() != "p" {
            continue;
        }
        let refused = |message: String| Problems::from(source.problem(tag(node), message, None));
        let indices = indices(source, node)?;
        let stride = layout.stride;
        if !indices.len().is_multiple_of(stride) {
            let message = format!("{} indices are not {stride} for each corner", indices.len());
            return Err(refused(message));
        }
        let point = |corner: &[usize]| {
            let index = corner[layout.offset];
            let point = index.checked_add(first).filter(|point| *point < end);
            let message = || format!("no point has the index {index}: the source has {}", end - first);
            point.map(|point| point as u32).ok_or_else(|| refused(message()))
        };
        let corners: Vec<u32> = indices
            .chunks_exact(stride)
            .map(point)
            .collect::<Result<_, _>>()?;
        add(layout.kind, &counts, &corners, object).map_err(refused)?;
    }
    Ok(())
}

/// Adds the polygons of a `<p>` with these corners.
///
/// # Errors
/// Corners that are not grouped to polygons, polygons of fewer than three: what is wrong.
fn add(kind: Kind, counts: &[usize], corners: &[u32], object: &mut Object) -> Result<(), String> {
    let mut polygon = |corners: &[u32]| match corners.len() {
        0..3 => Err(format!(
            "a polygon with {} corners: at least 3 required",
            corners.len()
        )),
        _ => {
            object.polygon(corners);
            Ok(())
        }
    };
    let triangles = corners.windows(3);
    match kind {
        Kind::Triangles if !corners.len().is_multiple_of(3) => {
            Err(format!("{} corners are not a multiple of 3", corners.len()))
        }
        Kind::Triangles => corners.chunks_exact(3).try_for_each(polygon),
        Kind::Whole => polygon(corners),
        Kind::Counted => {
            let sum = counts
                .iter()
                .fold(0, |sum: usize, count| sum.saturating_add(*count));
            if sum != corners.len() {
                let count = corners.len();
                return Err(format!(
                    "the numbers in <vcount> add up to {sum} corners, but <p> has {count}"
                ));
            }
            let mut rest = corners;
            counts.iter().try_for_each(|count| {
                let (next, behind) = rest.split_at(*count);
                rest = behind;
                polygon(next)
            })
        }
        // Every second triangle of a strip turns the other way.
        Kind::Strip => triangles
            .enumerate()
            .try_for_each(|(index, three)| match index % 2 {
                0 => polygon(three),
                _ => polygon(&[three[1], three[0], three[2]]),
            }),
        // The first window begins with the common corner itself.
        Kind::Fan => {
            let mut triangles = triangles;
            triangles.try_for_each(|three| polygon(&[corners[0], three[1], three[2]]))
        }
    }
}
