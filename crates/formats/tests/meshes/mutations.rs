//! Mesh files with random errors: a mesh or a problem is returned, and nothing panics.

use armill_formats::mesh::{LARGEST_COORDINATE, read};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Good files, each with every part of its format.
const FILES: [(&str, &[u8]); 7] = [
    ("a.stl", include_bytes!("../seeds/cube.ascii.stl")),
    ("b.stl", include_bytes!("../seeds/tetrahedron.stl")),
    ("c.obj", include_bytes!("../seeds/cube.obj")),
    ("d.ply", include_bytes!("../seeds/cube.ascii.ply")),
    ("e.ply", include_bytes!("../seeds/cube.big.ply")),
    ("f.3mf", include_bytes!("../seeds/cubes.3mf")),
    ("g.dae", include_bytes!("../seeds/cubes.dae")),
];

/// Pieces that something may trip over.
const TRAPS: &[&str] = &[
    "0",
    "-1",
    "8",
    "4294967295",
    "99999999999999999999",
    "1e-320",
    "1e308",
    "nan",
    "inf",
    "",
    " ",
    "\n",
    "\r",
    "\0",
    "\u{feff}",
    "\\\n",
    "#",
    "/",
    "//",
    "solid",
    "endsolid",
    "facet",
    "endfacet",
    "vertex 0 0 0",
    "f 1 2 3 4 5 6 7 8",
    "v 0 0 0\n",
    "surf",
    "element face 4000000000\n",
    "property list uchar int a\n",
    "end_header\n",
    "binary_big_endian",
    "<",
    ">",
    "/>",
    "\"",
    "&x;",
    "<!--",
    "]]>",
    "<p>0 1 2</p>",
    "<ph>",
    "<skew>",
    "<instance_node url=\"#shared\"/>",
    "stride=\"0\"",
    "offset=\"63\"",
    "PK\u{3}\u{4}",
];

fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    }
}

/// Reads; a refusal says something, a mesh has finite coordinates and indices of its vertices.
fn outcome(path: &str, bytes: &[u8]) -> Result<(), TestCaseError> {
    match read(path, bytes) {
        Err(problems) => {
            prop_assert!(!problems.as_slice().is_empty());
            prop_assert!(
                problems
                    .as_slice()
                    .iter()
                    .all(|problem| !problem.message().trim().is_empty())
            );
            prop_assert!(problems.to_string().contains(path), "{}", problems);
        }
        Ok(mesh) => {
            let largest = mesh
                .vertices
                .as_flattened()
                .iter()
                .fold(0.0, |largest: f64, value| {
                    if value.is_nan() {
                        f64::NAN
                    } else {
                        largest.max(value.abs())
                    }
                });
            prop_assert!(largest <= LARGEST_COORDINATE, "{}", largest);
            let corners = mesh.triangles.iter().chain(&mesh.without_area).flatten();
            prop_assert!(
                corners
                    .clone()
                    .all(|corner| (*corner as usize) < mesh.vertices.len())
            );
            let report = mesh.report();
            prop_assert!(report.volume.is_finite() && report.area >= 0.0 && report.triangles > 0);
            prop_assert!(!report.is_closed || report.open_edges == 0);
        }
    }
    Ok(())
}

#[test]
fn the_files_that_are_mutated_are_good() {
    for (path, bytes) in FILES {
        let mesh = read(path, bytes).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(mesh.report().is_closed, "{path}");
        outcome(path, bytes).unwrap();
    }
}

#[test]
fn files_that_are_cut_anywhere_never_panic() {
    for (path, bytes) in FILES {
        for end in 0..bytes.len() {
            outcome(path, &bytes[..end]).unwrap();
        }
    }
}

#[test]
fn each_byte_changed_never_panics() {
    for (path, bytes) in FILES {
        for at in 0..bytes.len() {
            let mut changed = bytes.to_vec();
            for value in [0, 1, b' ', b'9', 0x7f, 0xff] {
                changed[at] = value;
                outcome(path, &changed).unwrap();
            }
        }
    }
}

proptest! {
    #![proptest_config(config(500, 23))]

    #[test]
    fn pieces_replaced_by_traps_never_panic(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..14, any::<prop::sample::Index>()), 1..4),
    ) {
        for (path, bytes) in FILES {
            let mut bytes = bytes.to_vec();
            for (at, length, trap) in &cuts {
                let start = at.index(bytes.len() + 1);
                let end = (start + length).min(bytes.len());
                bytes.splice(start..end, TRAPS[trap.index(TRAPS.len())].bytes());
            }
            outcome(path, &bytes)?;
        }
    }

    #[test]
    fn any_bytes_are_refused_or_read(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for (path, _) in FILES {
            outcome(path, &bytes)?;
        }
    }
}
