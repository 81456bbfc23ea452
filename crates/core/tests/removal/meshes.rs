//! The surface as triangles, against closed forms: volumes by the divergence theorem, areas, distances of vertices.

use std::collections::HashMap;
use std::f64::consts::PI;

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::removal::{
    DexelDirections, DexelPart, EndOrigin, RemovalError, StockSolid, SurfaceMesh, SurfacePoint, ToolMove,
    ToolSolid,
};
use rayon::ThreadPoolBuilder;

use super::{MM, at, block, cut, end_mill, moves};

/// Corners of a triangle, mm.
fn corners(mesh: &SurfaceMesh, triangle: [u32; 3]) -> [Vector3<f64>; 3] {
    triangle.map(|vertex| mesh.vertices[vertex as usize].coords / MM)
}

/// mm^3, by the divergence theorem.
fn volume(mesh: &SurfaceMesh) -> f64 {
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(mesh, *triangle);
        a.dot(&b.cross(&c)) / 6.0
    };
    mesh.triangles.iter().map(of).sum()
}

/// mm^2, of the triangles whose three corners fulfil a condition (mm).
fn area(mesh: &SurfaceMesh, is_part: impl Fn(&Vector3<f64>) -> bool) -> f64 {
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(mesh, *triangle);
        let counts = [a, b, c].iter().all(&is_part);
        if counts {
            (b - a).cross(&(c - a)).norm() / 2.0
        } else {
            0.0
        }
    };
    mesh.triangles.iter().map(of).sum()
}

/// Each edge belongs to two triangles in opposite directions, and all lists fit to each other.
fn assert_closed(mesh: &SurfaceMesh) {
    let mut edges: HashMap<[u32; 2], usize> = HashMap::new();
    for [a, b, c] in mesh.triangles.iter().copied() {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for ([from, to], count) in &edges {
        assert_eq!((*count, edges.get(&[*to, *from])), (1, Some(&1)));
    }
    assert_eq!(mesh.normals.len(), mesh.vertices.len());
    assert_eq!(mesh.point_starts.len(), mesh.vertices.len() + 1);
    assert!(
        mesh.normals
            .iter()
            .all(|normal| (normal.norm() - 1.0).abs() < 1e-12)
    );
}

/// Normals of moves of one tool in a box.
fn normal_of<'a>(
    tool: &'a ToolSolid,
    path: &'a [ToolMove],
) -> impl Fn(&SurfacePoint) -> Option<Unit<Vector3<f64>>> + Sync + 'a {
    |point| match point.origin {
        EndOrigin::Move(index) => path[index as usize].surface_normal(tool, 0.01 * MM, &point.position),
        EndOrigin::Stock(face) => StockSolid::Box([Point3::origin(); 2]).normal(face, &point.position),
    }
}

#[test]
fn a_box_is_exact_with_any_stride() {
    for directions in [DexelDirections::All, DexelDirections::Z] {
        for (cell, stride) in [(1.0, 1), (0.7, 1), (0.5, 3), (0.5, 7), (1.0, 1000)] {
            let part = block([12.0, 8.0, 5.0], cell, directions);
            let mesh = part
                .surface_mesh(stride, normal_of(&end_mill(1.0, 0.0, 1.0), &[]))
                .unwrap();
            assert_closed(&mesh);
            // Coordinates along dexels have single precision.
            assert!(
                (volume(&mesh) - 480.0).abs() < 1e-4,
                "{} {cell} {stride}",
                volume(&mesh)
            );
            let all = area(&mesh, |_| true);
            assert!((all - 2.0 * (96.0 + 60.0 + 40.0)).abs() < 1e-4, "{all}");
            // Eight corners and twelve edges: vertices on two faces or three.
            let faces = |vertex: &Point3<f64>| {
                let sizes = [12.0, 8.0, 5.0];
                let is_on = |k: usize| {
                    [0.0, sizes[k]]
                        .iter()
                        .any(|face| (vertex[k] / MM - face).abs() < 1e-5)
                };
                (0..3).filter(|k| is_on(*k)).count()
            };
            let on: Vec<usize> = mesh.vertices.iter().map(faces).collect();
            assert!(on.iter().all(|faces| *faces > 0));
            assert_eq!(on.iter().filter(|faces| **faces == 3).count(), 8);
        }
    }
}

#[test]
fn a_pocket_with_sharp_edges_is_exact() {
    // A slot of 10 x 4 mm through a block of 60 x 40 x 20 mm; no wall is on the lattice.
    let tool = end_mill(10.0, 0.0, 30.0);
    let path = moves(
        &[at(-10.0, 20.1, 16.03), at(70.0, 20.1, 16.03)],
        Vector3::z_axis(),
    );
    let (part, _) = cut(block([60.0, 40.0, 20.0], 0.5, DexelDirections::All), &path, &tool);
    for stride in [1, 2, 5] {
        let mesh = part.surface_mesh(stride, normal_of(&tool, &path)).unwrap();
        assert_closed(&mesh);
        let expected = 60.0 * 40.0 * 20.0 - 10.0 * 3.97 * 60.0;
        assert!(
            (volume(&mesh) / expected - 1.0).abs() < 1e-6,
            "{stride}: {}",
            volume(&mesh)
        );
        let whole = 2.0 * (60.0 * 40.0 + 60.0 * 20.0 + 40.0 * 20.0) + 2.0 * 60.0 * 3.97 - 2.0 * 10.0 * 3.97;
        assert!((area(&mesh, |_| true) / whole - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_hole_has_its_volume_area_and_radius() {
    let (radius, depth) = (6.0, 7.0);
    let tool = end_mill(2.0 * radius, 0.0, 30.0);
    let path = moves(
        &[at(10.2, 9.9, 20.0), at(10.2, 9.9, 10.0 - depth)],
        Vector3::z_axis(),
    );
    for cell in [0.4, 0.2] {
        let (part, _) = cut(
            block([20.0, 20.0, 10.0], cell, DexelDirections::All),
            &path,
            &tool,
        );
        let mesh = part.surface_mesh(1, normal_of(&tool, &path)).unwrap();
        assert_closed(&mesh);
        // A polygon of chords or tangents of the length of a diagonal of a cell: less than its height c^2 / (8 r) away.
        let away = 2.0 * cell * cell / (8.0 * radius);
        let rho = |vertex: &Vector3<f64>| (vertex.x - 10.2).hypot(vertex.y - 9.9);
        let is_wall =
            |vertex: &Vector3<f64>| (rho(vertex) - radius).abs() < away && vertex.z > 10.0 - depth - 1e-4;
        let mut on_wall = 0;
        for vertex in mesh.vertices.iter().map(|vertex| vertex.coords / MM) {
            let inner =
                vertex.z > 10.0 - depth + 1e-4 && vertex.z < 10.0 - 1e-4 && rho(&vertex) < radius + 1.0;
            if inner {
                assert!((rho(&vertex) - radius).abs() < away, "{}", rho(&vertex) - radius);
                on_wall += 1;
            }
        }
        assert!(on_wall > 500);
        let expected = 4000.0 - PI * radius * radius * depth;
        assert!(
            (volume(&mesh) - expected).abs() < 2.0 * PI * radius * depth * away,
            "{}",
            volume(&mesh) - expected
        );
        // The wall from the floor to the top; the angle between its triangles and the cylinder is below c / r.
        let wall = area(&mesh, is_wall) / (2.0 * PI * radius * depth);
        assert!((wall - 1.0).abs() < (cell / radius).powi(2), "{wall}");
    }
}

#[test]
fn a_groove_of_a_ball_nose_is_round() {
    let radius = 5.0;
    let tool = end_mill(2.0 * radius, radius, 30.0);
    // Across both axes of the lattice.
    let path = moves(&[at(-20.0, -13.0, 7.0), at(50.0, 43.0, 7.0)], Vector3::z_axis());
    let along = Vector3::new(70.0, 56.0, 0.0).normalize();
    let cell = 0.25;
    for stride in [1, 2, 4] {
        let (part, _) = cut(
            block([30.0, 30.0, 10.0], cell, DexelDirections::All),
            &path,
            &tool,
        );
        let mesh = part.surface_mesh(stride, normal_of(&tool, &path)).unwrap();
        assert_closed(&mesh);
        let lattice = cell * f64::from(stride as u32);
        let mut in_groove = 0;
        for (vertex, normal) in mesh.vertices.iter().zip(&mesh.normals) {
            let off = vertex.coords / MM - Vector3::new(-20.0, -13.0, 12.0);
            let off = off - along * along.dot(&off);
            let place = vertex.coords / MM;
            let face = [place.x, 30.0 - place.x, place.y, 30.0 - place.y, 10.0 - place.z];
            let inner = face.into_iter().fold(f64::INFINITY, f64::min);
            if inner > 1e-6 && off.norm() < radius + 1.0 {
                let away = (off.norm() - radius).abs();
                // The sharp edge of material at a face may be between dexels: then the mesh ends up to half a lattice before it.
                let bound = if inner > lattice {
                    in_groove += 1;
                    3.0 * lattice * lattice / (8.0 * radius)
                } else {
                    0.5 * lattice
                };
                assert!(away < bound, "{stride} {away} {place:?}");
                assert!(inner <= lattice || normal.dot(&-off.normalize()) > (lattice / radius).cos());
            }
        }
        assert!(in_groove > 200, "{in_groove}");
    }
}

/// A ball of triangles; its true normals are given.
fn ball(part_cell: f64, directions: DexelDirections) -> DexelPart {
    let (radius, count) = (8.0, 200);
    let point = |i: usize, j: usize| {
        let (polar, around) = (
            PI * i as f64 / count as f64,
            2.0 * PI * (j % (2 * count)) as f64 / (2 * count) as f64,
        );
        let ring = if i == count { 0.0 } else { polar.sin() };
        at(
            radius * ring * around.cos(),
            radius * ring * around.sin(),
            radius * polar.cos(),
        )
    };
    let mut triangles = Vec::new();
    for i in 0..count {
        for j in 0..2 * count {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            let two = [[a, b, c], [a, c, d]];
            let kept = two
                .into_iter()
                .filter(|[a, b, c]| (b - a).cross(&(c - a)).norm() > 1e-15);
            triangles.extend(kept.map(armill_core::clearance::Triangle));
        }
    }
    DexelPart::new(&StockSolid::Mesh(&triangles), part_cell * MM, directions).unwrap()
}

#[test]
fn a_ball_has_its_volume_and_area() {
    let radius = 8.0;
    for (directions, stride) in [
        (DexelDirections::All, 1),
        (DexelDirections::All, 2),
        (DexelDirections::Z, 1),
    ] {
        let part = ball(0.4, directions);
        let normal = |point: &SurfacePoint| Unit::try_new(point.position.coords, 0.0);
        let mesh = part.surface_mesh(stride, normal).unwrap();
        assert_closed(&mesh);
        let lattice = 0.4 * f64::from(stride as u32);
        let (expected, surface) = (
            4.0 / 3.0 * PI * radius * radius * radius,
            4.0 * PI * radius * radius,
        );
        let away = match directions {
            DexelDirections::All => 3.0 * lattice * lattice / (8.0 * radius),
            // Walls of z dexels alone are up to half a cell away.
            DexelDirections::Z => 0.5 * 2_f64.sqrt() * lattice,
        };
        for vertex in &mesh.vertices {
            let off = vertex.coords.norm() / MM - radius;
            assert!(off.abs() < away, "{directions:?} {stride}: {off}");
        }
        let volume = volume(&mesh);
        assert!(
            (volume / expected - 1.0).abs() < 3.0 * lattice * lattice / (8.0 * radius) * surface / expected,
            "{volume}"
        );
        if directions == DexelDirections::All {
            let relative = area(&mesh, |_| true) / surface - 1.0;
            assert!(relative.abs() < (lattice / radius).powi(2), "{relative}");
        }
    }
}

/// A path in all directions with a tilted tool.
fn random_path() -> Vec<ToolMove> {
    let mut state = 12_345_u64;
    let mut number = |low: f64, high: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let points: Vec<Point3<f64>> = (0..30)
        .map(|_| at(number(0.0, 20.0), number(0.0, 20.0), number(4.0, 14.0)))
        .collect();
    let mut path = moves(&points, Vector3::z_axis());
    for motion in &mut path {
        let axis = Unit::new_normalize(Vector3::new(number(-1.0, 1.0), number(-1.0, 1.0), 1.0));
        motion.axes = [axis; 2];
    }
    path
}

#[test]
fn random_cuts_are_closed_and_have_the_volume_of_the_part() {
    let path = random_path();
    for (diameter, corner) in [(3.0, 1.5), (2.0, 0.0), (4.0, 0.6)] {
        let tool = end_mill(diameter, corner, 12.0);
        for directions in [DexelDirections::All, DexelDirections::Z] {
            let (part, _) = cut(block([20.0, 20.0, 14.0], 0.25, directions), &path, &tool);
            for stride in [1, 2, 3] {
                let mesh = part.surface_mesh(stride, normal_of(&tool, &path)).unwrap();
                assert_closed(&mesh);
                assert_eq!(mesh.triangles.len(), part.mesh_triangles(stride).unwrap());
                let lattice = 0.25 * f64::from(stride as u32);
                let (found, expected) = (volume(&mesh), part.volume() / MM.powi(3));
                // What is lost at thin walls and edges is of either sign; the surface is never farther away than a cell.
                let bound = 0.05 * lattice * area(&mesh, |_| true);
                assert!(
                    (found - expected).abs() < bound,
                    "{directions:?} {stride}: {found} {expected} {bound}"
                );
                // Single dexels have a point at each crossing but those where dexels disagree.
                if directions == DexelDirections::All {
                    let without = mesh.triangles.len() / 2 - mesh.points.len();
                    assert!(
                        without * 1000 <= mesh.points.len(),
                        "{without} of {}",
                        mesh.points.len()
                    );
                }
            }
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_mesh() {
    let (path, tool) = (random_path(), end_mill(3.0, 1.5, 12.0));
    let (part, _) = cut(block([20.0, 20.0, 14.0], 0.5, DexelDirections::All), &path, &tool);
    let run = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| part.surface_mesh(1, normal_of(&tool, &path)).unwrap())
    };
    let mesh = run(1);
    assert!(mesh.triangles.len() > 10_000);
    for threads in [2, 5] {
        assert!(run(threads) == mesh);
    }
}

#[test]
fn a_stride_is_the_least_with_this_number_of_triangles() {
    let (path, tool) = (random_path(), end_mill(3.0, 1.5, 12.0));
    let (part, _) = cut(block([20.0, 20.0, 14.0], 0.5, DexelDirections::All), &path, &tool);
    for most in [20_000, 5_000, 1_000, 100] {
        let stride = part.mesh_stride(most).unwrap();
        assert!(part.mesh_triangles(stride).unwrap() <= most);
        assert!(stride == 1 || part.mesh_triangles(stride - 1).unwrap() > most);
    }
    assert_eq!(part.mesh_stride(0).unwrap(), 40);
    assert_eq!(part.surface_mesh(0, |_| None), Err(RemovalError::NoStride));
    let thin = StockSolid::Box([Point3::origin(), Point3::new(0.01, 1e-6, 1.0)]);
    let fine = DexelPart::new(&thin, 1e-6, DexelDirections::Z).unwrap();
    let refused = fine.mesh_triangles(1).unwrap_err().to_string();
    assert_eq!(
        refused,
        "the lattice of the mesh has 1.000e10 points in a layer: the maximum is 2.0e8; use a larger stride or cell"
    );
}

#[test]
fn nothing_left_is_a_mesh_without_triangles() {
    let path = moves(&[at(-20.0, 5.0, -1.0), at(30.0, 5.0, -1.0)], Vector3::z_axis());
    let (part, _) = cut(
        block([10.0, 10.0, 5.0], 0.5, DexelDirections::All),
        &path,
        &end_mill(30.0, 0.0, 20.0),
    );
    let mesh = part.surface_mesh(1, |_| None).unwrap();
    assert!(mesh.triangles.is_empty() && mesh.vertices.is_empty());
    assert_eq!(mesh.vertex_values(&[]), []);
}

#[test]
fn a_vertex_has_the_mean_of_the_values_of_its_points() {
    let part = block([10.0, 10.0, 5.0], 0.5, DexelDirections::All);
    let mesh = part.surface_mesh(1, |_| None).unwrap();
    // The height of points, and none on the floor.
    let heights: Vec<f64> = mesh
        .points
        .iter()
        .map(|point| {
            if point.position.z > 0.0 {
                point.position.z
            } else {
                f64::NAN
            }
        })
        .collect();
    for (vertex, value) in mesh.vertex_values(&heights).into_iter().enumerate() {
        let points = mesh
            .points_of(vertex)
            .iter()
            .map(|point| heights[*point as usize]);
        let known: Vec<f64> = points.filter(|height| height.is_finite()).collect();
        assert!(!mesh.points_of(vertex).is_empty() && mesh.points_of(vertex).len() <= 4);
        let expected = (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64);
        assert_eq!(value, expected);
    }
    assert!(mesh.points_of(mesh.vertices.len()).is_empty());
}
