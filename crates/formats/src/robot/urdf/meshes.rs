//! The shapes that links of a URDF show: mesh files, each with its pose as the joints move.
//!
//! Boxes, cylinders and spheres are left out, and so are textures and colours. Joints that are not on the chain of the
//! robot are at zero, and so do those that mimic others.
//!
//! | element | means |
//! |---|---|
//! | `visual` | how the link looks |
//! | `collision` | a coarser shape of it, often in a plainer format |
//! | `origin` | where the shape is in its link |
//! | `mesh filename`, `scale` | the file, m where `scale` is 1 |

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::joints::{self, JointElement, Kind, origin, origin_of};
use super::tree;
use crate::document::{self, Problems};
use crate::xml::{self, children, numbers, required, tag};

/// More shapes than this are not accepted.
const MOST_MESHES: usize = 1000;

/// A mesh of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The link.
    pub link: String,
    /// The file as the URDF names it: a path, `package://PACKAGE/PATH`, `file://PATH`.
    pub file: String,
    /// Factors along its axes that make metres of it.
    pub scale: [f64; 3],
    /// Whether it is how the link looks, or its coarser shape for collisions.
    pub looks: bool,
    /// From the root link to the link.
    way: Vec<Hop>,
    link_from_mesh: Isometry,
}

/// One joint on the way to a link.
#[derive(Clone, Debug, PartialEq)]
struct Hop {
    name: String,
    origin: Isometry,
    moves: Option<(Unit<Vector3<f64>>, bool)>,
}

impl Mesh {
    /// Its position, its root link being the base, with the joint of each name at this position (rad, m); `None`: at
    /// zero.
    pub fn base_from_mesh(&self, position: impl Fn(&str) -> Option<f64>) -> Isometry {
        let through = |base: Isometry, hop: &Hop| {
            let at = position(&hop.name).unwrap_or(0.0);
            let moved = match hop.moves {
                None => Isometry::identity(),
                Some((axis, true)) => Translation3::from(axis.into_inner() * at).into(),
                Some((axis, false)) => Isometry::from_parts(
                    Translation3::identity(),
                    UnitQuaternion::from_axis_angle(&axis, at),
                ),
            };
            base * hop.origin * moved
        };
        self.way.iter().fold(Isometry::identity(), through) * self.link_from_mesh
    }
}

impl Mesh {
    /// Names of the joints on the way from the root link to its link.
    pub fn joints(&self) -> impl Iterator<Item = &str> {
        self.way.iter().map(|hop| hop.name.as_str())
    }
}

/// Every mesh of this URDF text, in the order of its links; `path` is what errors show.
///
/// # Errors
/// What is not XML, not a URDF or a tree with a loop; a mesh without a file, or numbers that are none.
pub fn meshes(path: &str, text: &str) -> Result<Vec<Mesh>, Problems> {
    let file = document::Source::new(path, text);
    let parsed = xml::parse(&file)?;
    let root = parsed.root_element();
    let elements = joints::read(&file, root)?;
    let tree = tree::Tree::new(&file, root, &elements)?;
    let (mut found, mut problems) = (Vec::new(), Vec::new());
    for link in children(root, "link") {
        let name = link.attribute("name").unwrap_or_default();
        let Some(way) = tree.path_from_root(name) else {
            continue;
        };
        let way: Vec<Hop> = way.into_iter().map(Hop::of).collect();
        for (element, looks) in [("visual", true), ("collision", false)] {
            for shape in children(link, element) {
                if found.len() == MOST_MESHES {
                    let message = format!("the file has more than {MOST_MESHES} meshes");
                    return Err(file.problem(tag(shape), message, None).into());
                }
                match mesh(&file, shape, name, looks, &way) {
                    Ok(mesh) => found.extend(mesh),
                    Err(wrong) => problems.extend(wrong),
                }
            }
        }
    }
    Problems::from(problems).into_result().map(|()| found)
}

/// The mesh of a `<visual>` or `<collision>`; none where it has another shape.
fn mesh(
    file: &document::Source,
    shape: Node<'_, '_>,
    link: &str,
    looks: bool,
    way: &[Hop],
) -> Result<Option<Mesh>, Problems> {
    let geometry = children(shape, "geometry").next();
    let Some(mesh) = geometry.and_then(|geometry| children(geometry, "mesh").next()) else {
        return Ok(None);
    };
    let (xyz, rpy) = match children(shape, "origin").next() {
        Some(origin) => origin_of(file, origin)?,
        None => ([0.0; 3], [0.0; 3]),
    };
    Ok(Some(Mesh {
        link: link.to_owned(),
        file: required(file, mesh, "filename")?.trim().to_owned(),
        scale: numbers(file, mesh, "scale", [1.0; 3])?,
        looks,
        way: way.to_vec(),
        link_from_mesh: from_xyz_and_fixed_angles(xyz.into(), rpy.into()),
    }))
}

impl Hop {
    fn of(joint: &JointElement) -> Hop {
        let axis = Unit::try_new(Vector3::from(joint.axis), 1e-12);
        let slides = joint.kind == Kind::Sliding;
        Hop {
            name: joint.name.clone(),
            origin: origin(joint),
            moves: match joint.kind {
                Kind::Turning | Kind::Sliding => axis.map(|axis| (axis, slides)),
                Kind::Fixed | Kind::Other(_) => None,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use armill_core::robot::forward::forward;

    use super::*;

    const ARM: &str = r#"<robot name="two">
      <link name="foot"><visual><geometry><mesh filename="package://two/foot.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>
      <link name="rod">
        <visual><origin xyz="0 0 0.1" rpy="0 1.5707963267948966 0"/><geometry><mesh filename="rod.dae"/></geometry></visual>
        <visual><geometry><box size="1 1 1"/></geometry></visual>
        <collision><geometry><mesh filename="rod.stl"/></geometry></collision>
      </link>
      <link name="lid"><visual><geometry><mesh filename="lid.stl"/></geometry></visual></link>
      <link name="hand"><visual><geometry><mesh filename="hand.stl"/></geometry></visual></link>
      <joint name="turn" type="revolute"><parent link="foot"/><child link="rod"/><origin xyz="0 0 0.5" rpy="0.3 0 0"/><axis xyz="0.6 0 0.8"/><limit lower="-1" upper="1"/></joint>
      <joint name="open" type="revolute"><parent link="foot"/><child link="lid"/><origin xyz="1 0 0"/><limit lower="-1" upper="1"/></joint>
      <joint name="slide" type="prismatic"><parent link="rod"/><child link="hand"/><origin xyz="0 0.2 0"/><axis xyz="0 -1 0"/><limit lower="-1" upper="1"/></joint>
    </robot>"#;

    #[test]
    fn every_mesh_is_found_with_its_scale_and_kind() {
        let found = meshes("two.urdf", ARM).unwrap();
        let given: Vec<_> = found
            .iter()
            .map(|m| (m.link.as_str(), m.file.as_str(), m.scale[0], m.looks))
            .collect();
        let expected = [
            ("foot", "package://two/foot.stl", 0.001, true),
            ("rod", "rod.dae", 1.0, true),
            ("rod", "rod.stl", 1.0, false),
            ("lid", "lid.stl", 1.0, true),
            ("hand", "hand.stl", 1.0, true),
        ];
        assert_eq!(given, expected);
    }

    #[test]
    fn a_mesh_at_the_flange_link_is_at_the_flange_of_the_chain() {
        // The witness is the chain that the reader makes of the same file.
        let robot = super::super::read("two.urdf", "two", ARM).unwrap().robot;
        let hand = meshes("two.urdf", ARM).unwrap().pop().unwrap();
        for q in [[0.0, 0.0], [0.4, -0.3], [-0.9, 0.7]] {
            let position = |name: &str| {
                robot
                    .joints()
                    .iter()
                    .position(|joint| joint.name == name)
                    .map(|i| q[i])
            };
            let (mesh, flange) = (
                hand.base_from_mesh(position),
                forward(&robot, &q).base_from_flange,
            );
            let turned = mesh.rotation.to_rotation_matrix().matrix() - flange.rotation.matrix();
            let moved = mesh.translation.vector - flange.translation.vector;
            assert!(moved.norm() + turned.norm() < 1e-12);
        }
    }

    #[test]
    fn links_off_the_chain_are_at_zero_and_the_origin_of_a_shape_is_applied() {
        let found = meshes("two.urdf", ARM).unwrap();
        let lid = found[3].base_from_mesh(|name| (name != "open").then_some(0.7));
        assert_eq!(lid.translation.vector, Vector3::new(1.0, 0.0, 0.0));
        let rod = found[1].base_from_mesh(|_| None);
        let expected = from_xyz_and_fixed_angles(Vector3::new(0.0, 0.0, 0.5), Vector3::new(0.3, 0.0, 0.0))
            * from_xyz_and_fixed_angles(
                Vector3::new(0.0, 0.0, 0.1),
                Vector3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0),
            );
        let apart = rod.inverse() * expected;
        assert!(apart.translation.vector.norm() + apart.rotation.angle() < 1e-12);
    }

    #[test]
    fn every_error_is_reported_at_its_place() {
        let text = ARM
            .replace("filename=\"lid.stl\"", "file=\"lid.stl\"")
            .replace("scale=\"0.001 0.001 0.001\"", "scale=\"small\"");
        let problems = meshes("two.urdf", &text).unwrap_err();
        assert_eq!(
            problems
                .as_slice()
                .iter()
                .map(document::Problem::line)
                .collect::<Vec<_>>(),
            [2, 8]
        );
        assert!(meshes("two.urdf", "<robot").is_err());
    }
}
