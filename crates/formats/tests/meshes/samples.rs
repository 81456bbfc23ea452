//! The benchmark for robotic milling in restricted spaces: one body of 156 triangles, in m.

use armill_formats::mesh::{MeshUnit, likely_unit, read};

use crate::samples_folder::samples;

/// Bounds, area and volume by trimesh 4 and numpy; the sides are those of its README (1.30 m x 1.03 m), with supports.
///
/// SolidWorks wrote some zeros as 6e-18: with them 30 edges would be open.
#[test]
fn the_restricted_space_is_a_closed_body_in_metres() {
    let Some(folder) = samples("collision/restricted-space") else {
        return;
    };
    let bytes = std::fs::read(folder.join("SDG1V7sim350_400E1.STL")).unwrap();
    assert!(
        bytes.starts_with(b"stlbn"),
        "a binary file without the word `solid`"
    );
    let mesh = read("SDG1V7sim350_400E1.STL", &bytes).unwrap();
    let report = mesh.report();
    assert_eq!((report.triangles, mesh.vertices.len()), (156, 80));
    assert!(report.is_closed && report.is_oriented, "{report:?}");
    let near = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
    assert!(near(report.volume, 0.2620569596320999), "{report:?}");
    assert!(near(report.area, 9.996076324627577), "{report:?}");
    // As single-precision numbers.
    assert_eq!(report.min, [0.0, 0.0, -f64::from(0.68_f32)]);
    assert_eq!(report.max, [1.3_f32, 1.03, 0.48].map(f64::from));
    assert_eq!((mesh.unit, mesh.collapsed), (None, 0));
    assert_eq!(likely_unit(mesh.longest_side()), Some(MeshUnit::METRE));
}
