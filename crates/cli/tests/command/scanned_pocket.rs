//! The pocket of the examples: its part, a made-up scan with a known error, and what the journal of the arm takes from it.

use crate::cell::{Cell, number};

/// A vertex of the surface: position in mm, normal, deviation in um.
struct Vertex {
    at_mm: [f64; 3],
    normal: [f64; 3],
    deviation_um: f64,
}

/// The vertices of a PLY file with floats and three colours between them.
fn vertices(bytes: &[u8]) -> Vec<Vertex> {
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|at| at == end).unwrap() + end.len();
    let header = String::from_utf8_lossy(&bytes[..start]);
    let count = header
        .lines()
        .find_map(|line| line.strip_prefix("element vertex "))
        .unwrap();
    let columns: Vec<&str> = header
        .lines()
        .filter_map(|line| line.strip_prefix("property float "))
        .collect();
    let deviation = columns.iter().position(|name| *name == "deviation_um").unwrap();
    let row = 4 * columns.len() + 3;
    let of = |row: &[u8], column: usize| {
        let at = 4 * column + if column < 6 { 0 } else { 3 };
        f64::from(f32::from_le_bytes(row[at..at + 4].try_into().unwrap()))
    };
    let rows = bytes[start..].chunks_exact(row).take(count.parse().unwrap());
    rows.map(|row| Vertex {
        at_mm: [0, 1, 2].map(|axis| of(row, axis)),
        normal: [3, 4, 5].map(|axis| of(row, axis)),
        deviation_um: of(row, deviation),
    })
    .collect()
}

#[test]
fn a_known_error_of_the_pocket_is_found_again_and_its_scan_enters_a_journal() {
    let cell = Cell::new();
    cell.armill(&["new", "pocket", "--example", "r2000ic-pocket"])
        .fine();
    let study = std::fs::read_to_string(cell.at("pocket/study.toml")).unwrap();
    let coarse = study.replace("cell_mm = 0.5", "cell_mm = 1");
    assert_ne!(coarse, study);
    cell.file("pocket/study.toml", &coarse);
    let first = cell
        .armill(&["run", "pocket", "--json", "--no-pictures", "--out", "first"])
        .fine()
        .json();
    let part = &first["paths"][0]["machined_part"];
    let names: Vec<&str> = (part["features"].as_array().unwrap().iter())
        .map(|feature| feature["name"].as_str().unwrap())
        .collect();
    for name in ["bore", "floor", "wall at x = 80"] {
        assert!(names.iter().any(|of| of.starts_with(name)), "{name}: {names:?}");
    }
    // The marks of 3 teeth of a cutter of 10 mm at 1800 mm/min and 9000 rpm: 0.0667 mm a tooth.
    let marks = number(&part["feed_marks_um"]);
    let expected = 1e3 * (1800.0_f64 / 9000.0 / 3.0).powi(2) / (8.0 * 5.0);
    assert!(
        (marks - expected).abs() < 0.02 * expected,
        "{marks} of {expected}"
    );

    // Every 5th vertex of the floor and the walls, with a wave of 25 um.
    let surface = vertices(&std::fs::read(cell.at("first/pocket.part.ply")).unwrap());
    let is_of_face = |normal: &[f64; 3]| normal.iter().any(|part| part.abs() > 0.9999);
    let mut scan = String::from("x_mm,y_mm,z_mm\n");
    let mut squares = Vec::new();
    for vertex in surface
        .iter()
        .filter(|vertex| vertex.deviation_um.is_finite() && is_of_face(&vertex.normal))
        .step_by(5)
    {
        let wave = 25.0 * (std::f64::consts::TAU * vertex.at_mm[0] / 40.0).sin();
        let by_mm = (vertex.deviation_um + wave) / 1e3;
        let [x, y, z] = [0, 1, 2].map(|axis| vertex.at_mm[axis] + by_mm * vertex.normal[axis]);
        scan += &format!("{x},{y},{z}\n");
        squares.push(wave * wave);
    }
    cell.file("pocket/scan.csv", &scan);
    let with_scan = "cell_mm = 1\nscan = { file = \"scan.csv\", align = \"none\" }";
    cell.file("pocket/study.toml", coarse.replace("cell_mm = 1", with_scan));
    let second = cell
        .armill(&["run", "pocket", "--json", "--no-pictures", "--out", "second"])
        .fine()
        .json();
    let given = &second["paths"][0]["machined_part"]["scan"];
    let wave = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let left = number(&given["difference"]["rms_um"]);
    assert!((left - wave).abs() < 0.05 * wave, "{left} um of {wave}");
    assert!(number(&given["points"]) > 0.95 * squares.len() as f64, "{given}");
    // Without any of the joints the others explain less than all together, which leave the wave.
    let measured = number(&given["measured"]["rms_um"]);
    let all = 1.0 - (left / measured).powi(2);
    let contributions = given["contributions"].as_array().unwrap();
    for joint in contributions.iter().filter(|one| number(&one["rms_um"]) > 5.0) {
        let without = number(&joint["explained_without"]);
        assert!(without < all - 0.005, "{joint}, all {all}");
    }
    assert!(contributions.len() >= 7, "{contributions:?}");

    let rows = std::fs::read_to_string(cell.at("second/pocket.scan-points.csv")).unwrap();
    cell.file(
        "journal.toml",
        "format = 1\nrobot = \"fanuc/r2000ic\"\ntool_mm = [0, 90, 260]\n[[measurement]]\ndate = \"2026-11-28\"\ntemperature_c = 20\nkind = \"part\"\nfile = \"second/pocket.scan-points.csv\"\nu_um = 20\n",
    );
    let journal = cell.armill(&["journal", "journal.toml", "--json"]).fine().json();
    let measurement = &journal["measurements"][0];
    assert_eq!(
        number(&measurement["readings"]),
        (rows.lines().count() - 1) as f64
    );
    // The wave is what the arm cannot explain.
    let after = number(&measurement["after"]);
    assert!((0.3..2.0).contains(&after), "{measurement}");
}
