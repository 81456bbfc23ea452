//! The mesh files of the links of a robot, if its file names them.
//!
//! A URDF names mesh files, most often as `package://PACKAGE/PATH`. They are searched in the folder of the URDF and in
//! the folders above it, up to the folder of the study; never outside of both. If one mesh is missing, none is given: an
//! incomplete arm would be misleading.

use std::path::{Component, Path, PathBuf};

use armill_formats::input;
use armill_formats::mesh::MeshFormat;
use armill_formats::robot::format::Format;
use armill_formats::robot::urdf::meshes::{Mesh, meshes};

/// A mesh of a link and its file.
#[derive(Clone, Debug)]
pub struct LinkMesh {
    /// The mesh, as the robot file names it.
    pub mesh: Mesh,
    /// Its file: a real path.
    pub path: PathBuf,
}

/// The meshes of the links of a robot.
#[derive(Clone, Debug)]
pub enum LinkMeshes {
    /// Its file names none.
    None,
    /// A file that is named is not there, or cannot be used; as named.
    Missing(String),
    /// Those of each link.
    Found(Vec<LinkMesh>),
}

/// Which meshes of a link are used where it has both kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preferred {
    /// How it looks; STL files alone, which the page can draw.
    Looks,
    /// Its coarser shape for collisions, of any format.
    Collision,
}

impl Preferred {
    /// Whether a file can be used.
    fn fits(self, path: &Path) -> bool {
        match (self, MeshFormat::of_path(path)) {
            (_, Some(MeshFormat::Stl)) => true,
            (Preferred::Collision, Some(_)) => true,
            (Preferred::Looks, _) | (_, None) => false,
        }
    }
}

impl LinkMeshes {
    /// Those that the file of this robot names. For a link without usable meshes of the preferred kind, the others are used.
    pub fn of(robot: &str, folder: &Path, preferred: Preferred) -> LinkMeshes {
        let Some((all, places)) = named(robot, folder) else {
            return LinkMeshes::None;
        };
        let mut links: Vec<&str> = all.iter().map(|mesh| mesh.link.as_str()).collect();
        links.dedup();
        let mut found = Vec::new();
        for link in links {
            let of = |looks: bool| -> Option<Vec<LinkMesh>> {
                let own = all.iter().filter(|mesh| mesh.link == link && mesh.looks == looks);
                let own: Option<Vec<LinkMesh>> = own
                    .map(|mesh| {
                        let path = places.find(&mesh.file, preferred)?;
                        Some(LinkMesh {
                            mesh: mesh.clone(),
                            path,
                        })
                    })
                    .collect();
                own.filter(|own| !own.is_empty())
            };
            let looks = preferred == Preferred::Looks;
            match of(looks).or_else(|| of(!looks)) {
                Some(own) => found.extend(own),
                None => {
                    let file = all.iter().find(|mesh| mesh.link == link);
                    return LinkMeshes::Missing(file.map_or_else(String::new, |mesh| mesh.file.clone()));
                }
            }
        }
        match found.is_empty() {
            true => LinkMeshes::None,
            false => LinkMeshes::Found(found),
        }
    }
}

/// The meshes that the file of a robot names, whether they are there or not; none of a robot without such a file.
pub fn named_meshes(robot: &str, folder: &Path) -> Vec<Mesh> {
    named(robot, folder).map_or_else(Vec::new, |(meshes, _)| meshes)
}

/// The meshes that the file of a robot names, and where they may be; none of a robot of another format, or without a file of its own, such
/// as one of the library.
fn named(robot: &str, folder: &Path) -> Option<(Vec<Mesh>, Places)> {
    let path = folder.join(robot);
    let format = |text: &str| Format::of(Path::new(robot), text);
    let bytes = path.is_file().then(|| input::read(&path).ok()).flatten()?;
    let text = String::from_utf8_lossy(&bytes);
    let urdf = match format(&text)? {
        Format::Urdf => text.into_owned(),
        Format::Xacro => expanded(&path, &text)?,
        _ => return None,
    };
    Some((meshes(robot, &urdf).ok()?, Places::of(&path, folder)?))
}

/// The URDF of a xacro file; none if it cannot be expanded.
#[cfg(feature = "xacro")]
fn expanded(path: &Path, text: &str) -> Option<String> {
    use armill_formats::robot::xacro;

    Some(xacro::expand_with_meshes(path, text).ok()?.urdf)
}

/// This build does not read xacro.
#[cfg(not(feature = "xacro"))]
fn expanded(_: &Path, _: &str) -> Option<String> {
    None
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
    fn find(&self, file: &str, preferred: Preferred) -> Option<PathBuf> {
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
            .find(|real| self.may_be_read(real, preferred))
    }

    /// Whether this real path is a usable mesh inside of the permitted folders, and not hidden.
    fn may_be_read(&self, real: &Path, preferred: Preferred) -> bool {
        let mesh = preferred.fits(real);
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
        let paths = match LinkMeshes::of("arm/urdf/arm.urdf", &cell, Preferred::Looks) {
            LinkMeshes::Found(found) => Some(found.into_iter().map(|found| found.path).collect()),
            _ => None,
        };
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
        let found = LinkMeshes::of("arm/urdf/arm.urdf", &cell, Preferred::Looks);
        assert!(matches!(found, LinkMeshes::Missing(file) if file == "near.stl"));
    }

    #[test]
    fn a_robot_of_the_library_shows_none() {
        let found = LinkMeshes::of("yaskawa/mh12", Path::new("."), Preferred::Looks);
        assert!(matches!(found, LinkMeshes::None));
    }
}
