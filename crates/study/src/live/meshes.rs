//! The meshes of the robot, if its file names them.
//!
//! A URDF names mesh files, most often as `package://PACKAGE/PATH`. They are searched in the folder of the URDF and in
//! the folders above it, up to the folder of the study; never outside of both. For a link whose visual mesh has another
//! format, its collision mesh is used. If one mesh is missing, none is drawn: an incomplete arm would be misleading.

use std::path::{Component, Path, PathBuf};

use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_formats::input;
use armill_formats::robot::format::Format;
use armill_formats::robot::urdf::meshes::{Mesh, meshes};
use armill_formats::robot::xacro;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::StudyError;
use crate::file::resolve::Parsed;
use crate::live::StudyText;
use crate::number::without_rounding;

/// The extension of meshes that a page can draw.
const ENDING: &str = "stl";

/// A shape of a link, in base.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DrawnMesh {
    /// Its link.
    pub link: String,
    /// Its file, as in the robot file.
    pub file: String,
    /// Millimetres for one unit of the file, along its axes.
    pub scale_mm: [f64; 3],
    /// Its position.
    pub xyz_mm: [f64; 3],
    /// Its orientation, unit quaternion.
    pub quaternion_wxyz: [f64; 4],
}

/// The shapes of a robot, each with its file.
pub(super) struct Shapes(Vec<(Mesh, PathBuf)>);

impl Shapes {
    /// Those that the file of this robot names; none if it names none, or if one is missing.
    pub(super) fn of(robot: &str, folder: &Path) -> Shapes {
        Shapes(found(robot, folder).unwrap_or_default())
    }

    /// The meshes at these joint positions (rad, m).
    pub(super) fn drawn(&self, robot: &Robot, q: &[f64]) -> Vec<DrawnMesh> {
        let position = |name: &str| {
            let index = robot.joints().iter().position(|joint| joint.name == name)?;
            q.get(index).copied()
        };
        let one = |(mesh, _): &(Mesh, PathBuf)| {
            let at = mesh.base_from_mesh(position);
            let turn = at.rotation.coords;
            DrawnMesh {
                link: mesh.link.clone(),
                file: mesh.file.clone(),
                scale_mm: mesh.scale.map(to_mm),
                xyz_mm: at.translation.vector.map(|m| without_rounding(to_mm(m))).into(),
                quaternion_wxyz: [turn.w, turn.x, turn.y, turn.z].map(without_rounding),
            }
        };
        self.0.iter().map(one).collect()
    }
}

/// The bytes of this mesh of the study's robot, by its name in the robot file.
///
/// # Errors
/// A text that is not a study; a robot that names no such mesh, or whose file is missing or too large.
pub fn mesh_bytes(text: StudyText<'_>, file: &str) -> Result<Vec<u8>, StudyError> {
    let robot = Parsed::of(text.shown, text.bytes)?.file.robot;
    let Shapes(shapes) = Shapes::of(&robot, text.folder);
    let named = shapes.into_iter().find(|(mesh, _)| mesh.file == file);
    let bytes = named.and_then(|(_, path)| input::read(&path).ok());
    bytes.ok_or_else(|| {
        let message = format!("the robot has no mesh `{file}`");
        StudyError::value(
            message,
            "mesh files must be in the folder of the URDF or in the folder of the study",
        )
    })
}

/// The meshes of the links, with their files.
fn found(robot: &str, folder: &Path) -> Option<Vec<(Mesh, PathBuf)>> {
    let path = folder.join(robot);
    let format = |text: &str| Format::of(Path::new(robot), text);
    // A robot without a file of its own, such as one of the library, names no meshes.
    let bytes = path.is_file().then(|| input::read(&path).ok()).flatten()?;
    let text = String::from_utf8_lossy(&bytes);
    let urdf = match format(&text)? {
        Format::Urdf => text.into_owned(),
        Format::Xacro => xacro::expand(&path, &text).ok()?.urdf,
        _ => return None,
    };
    let all = meshes(robot, &urdf).ok()?;
    let places = Places::of(&path, folder)?;
    let mut links: Vec<&str> = all.iter().map(|mesh| mesh.link.as_str()).collect();
    links.dedup();
    let of_link = |link: &str| {
        let of = |looks: bool| -> Option<Vec<(Mesh, PathBuf)>> {
            let own = all.iter().filter(|mesh| mesh.link == link && mesh.looks == looks);
            let own: Vec<_> = own
                .map(|mesh| Some((mesh.clone(), places.find(&mesh.file)?)))
                .collect::<Option<_>>()?;
            (!own.is_empty()).then_some(own)
        };
        of(true).or_else(|| of(false))
    };
    let found: Option<Vec<_>> = links.into_iter().map(of_link).collect();
    found.map(|found| found.into_iter().flatten().collect())
}

/// Where meshes may be.
struct Places {
    /// The folder of the URDF and those above it up to that of the study, nearest first.
    folders: Vec<PathBuf>,
    /// Folders that every file must be inside of: real paths.
    roots: [PathBuf; 2],
}

impl Places {
    fn of(urdf: &Path, study: &Path) -> Option<Places> {
        let urdf_folder = urdf.canonicalize().ok()?.parent()?.to_owned();
        let study = if study.as_os_str().is_empty() {
            Path::new(".")
        } else {
            study
        };
        let root = study.canonicalize().ok()?;
        let inside = |folder: &&Path| folder.starts_with(&root) || *folder == urdf_folder;
        Some(Places {
            folders: urdf_folder
                .ancestors()
                .take_while(inside)
                .map(Path::to_owned)
                .collect(),
            roots: [root, urdf_folder],
        })
    }

    /// The file of that name; none if it is not there, of another kind, or outside.
    fn find(&self, file: &str) -> Option<PathBuf> {
        let (path, packed) = match file.split_once("://") {
            Some(("package" | "model", path)) => (path, true),
            Some(("file", path)) => (path, false),
            Some(_) => return None,
            None => (file, false),
        };
        let path = Path::new(path);
        // The package may be a folder, or a folder that contains that of the URDF.
        let without = path.components().skip(1).collect::<PathBuf>();
        let ways = if packed { vec![path, &without] } else { vec![path] };
        let tries = self
            .folders
            .iter()
            .flat_map(|folder| ways.iter().map(|way| folder.join(way)));
        tries
            .filter_map(|path| path.canonicalize().ok())
            .find(|real| self.may_be_read(real))
    }

    /// Whether this real path is a mesh inside of the permitted folders, and not hidden.
    fn may_be_read(&self, real: &Path) -> bool {
        let mesh = real
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING));
        let plain = |below: &Path| {
            below.components().all(|part| match part {
                Component::Normal(name) => !name.to_string_lossy().starts_with('.'),
                _ => false,
            })
        };
        let inside = self
            .roots
            .iter()
            .any(|root| real.strip_prefix(root).is_ok_and(plain));
        mesh && inside && real.is_file()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A study, and files outside of it that no robot may show.
    fn cell(file: &str) -> (tempfile::TempDir, Option<Vec<PathBuf>>) {
        let outer = tempfile::tempdir().unwrap();
        let cell = outer.path().join("cell");
        for folder in ["arm/urdf", "arm/meshes", "parts"] {
            std::fs::create_dir_all(cell.join(folder)).unwrap();
        }
        for path in [
            "arm/meshes/a.STL",
            "arm/urdf/near.stl",
            "parts/b.stl",
            "parts/b.txt",
            "parts/.c.stl",
            "../secret.stl",
        ] {
            std::fs::write(cell.join(path), "solid\nendsolid\n").unwrap();
        }
        let urdf = format!(
            "<robot name='r'><link name='a'><visual><geometry><mesh filename='{file}'/></geometry></visual></link><link name='b'/>\
             <joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>"
        );
        std::fs::write(cell.join("arm/urdf/arm.urdf"), urdf).unwrap();
        let found = found("arm/urdf/arm.urdf", &cell);
        let paths = found.map(|found| found.into_iter().map(|(_, path)| path).collect());
        (outer, paths)
    }

    #[test]
    fn a_mesh_is_found_next_to_the_urdf_and_below_the_study() {
        for (file, at) in [
            ("near.stl", "arm/urdf/near.stl"),
            ("../meshes/a.STL", "arm/meshes/a.STL"),
            ("package://arm/meshes/a.STL", "arm/meshes/a.STL"),
            ("package://arm_support/meshes/a.STL", "arm/meshes/a.STL"),
            ("package://parts/b.stl", "parts/b.stl"),
        ] {
            let (outer, found) = cell(file);
            let expected = outer.path().join("cell").join(at).canonicalize().unwrap();
            assert_eq!(found, Some(vec![expected]), "{file}");
        }
    }

    #[test]
    fn nothing_outside_hidden_or_of_another_kind_is_found() {
        let secret = |outer: &tempfile::TempDir| outer.path().join("secret.stl").display().to_string();
        for file in [
            "../../../secret.stl",
            "package://x/../../../../secret.stl",
            "package://../secret.stl",
            "parts/b.txt",
            "package://parts/.c.stl",
            "package://parts/b.txt",
            "http://127.0.0.1/a.stl",
            "none.stl",
            "",
            "/etc/passwd",
        ] {
            assert_eq!(cell(file).1, None, "{file}");
        }
        let (outer, _) = cell("near.stl");
        assert_eq!(cell(&secret(&outer)).1, None);
        assert_eq!(cell(&format!("file://{}", secret(&outer))).1, None);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_out_is_not_followed() {
        let (outer, _) = cell("near.stl");
        let cell = outer.path().join("cell");
        std::fs::remove_file(cell.join("arm/urdf/near.stl")).unwrap();
        std::os::unix::fs::symlink(outer.path().join("secret.stl"), cell.join("arm/urdf/near.stl")).unwrap();
        assert!(found("arm/urdf/arm.urdf", &cell).is_none());
    }

    #[test]
    fn a_robot_of_the_library_shows_none() {
        assert!(Shapes::of("yaskawa/mh12", Path::new(".")).0.is_empty());
    }
}
