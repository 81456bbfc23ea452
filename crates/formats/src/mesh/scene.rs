//! Objects with their placements, as one mesh: what 3MF and COLLADA have in common.
//!
//! A file of some kB may place objects that place objects, and so on: numbers of placements and of placed points are
//! limited.

use super::affine::Affine;
use super::assembly::{Assembly, MOST_TRIANGLES, Points, REDUCE, checked};
use super::triangle_mesh::TriangleMesh;
use crate::document::Problems;

/// Objects within objects: assemblies have fewer than ten levels.
pub(super) const MOST_LEVELS: usize = 64;
/// Placements of objects, those of assemblies included.
const MOST_PLACEMENTS: usize = 100_000;
/// Points of all placed objects: three for each triangle.
const MOST_POINTS: usize = 3 * MOST_TRIANGLES;

/// Points and polygons in the axes of an object.
#[derive(Default)]
pub(super) struct Object {
    pub points: Vec<[f64; 3]>,
    /// Indices of points, polygon after polygon.
    corners: Vec<u32>,
    /// Where each polygon ends in `corners`.
    ends: Vec<usize>,
}

impl Object {
    /// Adds a polygon of these points; not checked: that they exist, which the reader does where it knows the place.
    pub fn polygon(&mut self, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len());
    }

    /// How many polygons there are.
    pub fn polygons(&self) -> usize {
        self.ends.len()
    }
}

/// The mesh of the objects that are placed so far.
#[derive(Default)]
pub(super) struct Scene {
    assembly: Assembly,
    placements: usize,
    points: usize,
}

impl Scene {
    /// Counts a placement: of an object or of an assembly.
    ///
    /// # Errors
    /// Too many placements, or too many levels above this one: what is wrong, and a hint.
    pub fn enter(&mut self, level: usize) -> Result<(), (String, &'static str)> {
        self.placements += 1;
        if level > MOST_LEVELS {
            let message = format!("objects are placed in one another over more than {MOST_LEVELS} levels");
            return Err((message, "an object must not contain itself"));
        }
        if self.placements > MOST_PLACEMENTS {
            let message = format!("more than {MOST_PLACEMENTS} placements of objects");
            return Err((message, REDUCE));
        }
        Ok(())
    }

    /// Adds an object at its place. Where the placement mirrors, polygons are reversed: outside remains outside.
    ///
    /// # Errors
    /// Coordinates that are not accepted, a polygon without triangles, too many points or triangles: what is wrong, and
    /// a hint.
    pub fn place(&mut self, object: &Object, placement: &Affine) -> Result<(), (String, &'static str)> {
        self.points += object.points.len();
        if self.points > MOST_POINTS {
            return Err((
                format!("the placed objects have more than {MOST_POINTS} points"),
                REDUCE,
            ));
        }
        let mut placed = Vec::with_capacity(object.points.len());
        for (index, point) in object.points.iter().enumerate() {
            let point = placement.place(*point);
            for value in point {
                checked(value).map_err(|message| {
                    (
                        format!("point {index} as placed: {message}"),
                        "check the transforms of the file",
                    )
                })?;
            }
            placed.push(point);
        }
        let mut points = Points::new(&placed);
        let (mut polygon, mirrors) = (Vec::new(), placement.mirrors());
        let mut start = 0;
        for (index, end) in object.ends.iter().enumerate() {
            polygon.clear();
            let corners = object.corners[start..*end].iter();
            polygon.extend(corners.filter_map(|corner| points.vertex(*corner as usize, &mut self.assembly)));
            if mirrors {
                polygon.reverse();
            }
            let added = self.assembly.polygon(&polygon);
            added.map_err(|refusal| {
                (
                    format!("polygon {}: {}", index + 1, refusal.message()),
                    refusal.hint(),
                )
            })?;
            start = *end;
        }
        Ok(())
    }

    /// The mesh.
    ///
    /// # Errors
    /// No triangle with an area.
    pub fn finish(self, name: &str) -> Result<TriangleMesh, Problems> {
        self.assembly.finish(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Object {
        let mut object = Object {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            ..Object::default()
        };
        object.polygon(&[0, 1, 2]);
        object
    }

    #[test]
    fn a_mirrored_object_keeps_its_outside() {
        let mut scene = Scene::default();
        let mut mirror = Affine::IDENTITY;
        mirror.0[0][0] = -1.0;
        scene.place(&triangle(), &mirror).unwrap();
        let mesh = scene.finish("a").unwrap();
        let corners = mesh.corners(mesh.triangles[0]);
        assert_eq!(corners, [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0; 3]]);
    }

    #[test]
    fn placements_that_exceed_a_limit_are_refused() {
        let mut scene = Scene::default();
        assert!(scene.enter(MOST_LEVELS).is_ok() && scene.enter(MOST_LEVELS + 1).is_err());
        assert!((2..MOST_PLACEMENTS).all(|_| scene.enter(0).is_ok()));
        let (message, _) = scene.enter(0).unwrap_err();
        assert_eq!(message, "more than 100000 placements of objects");
        let mut far = Affine::IDENTITY;
        far.0[2][3] = 2e9;
        let (message, _) = scene.place(&triangle(), &far).unwrap_err();
        assert_eq!(
            message,
            "point 0 as placed: 2e9 exceeds the largest coordinate of 1e9 file units"
        );
        let wide = Object {
            points: vec![[0.0; 3]; MOST_POINTS / 2 + 1],
            ..Object::default()
        };
        assert!(scene.place(&wide, &Affine::IDENTITY).is_ok());
        assert!(scene.place(&wide, &Affine::IDENTITY).is_err());
    }
}
