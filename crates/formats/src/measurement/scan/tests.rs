use armill_core::nalgebra::{Point3, Vector3};

use super::*;
use crate::measurement::profile::LengthUnit;
use crate::measurement::workbook::tests::workbook_of;

fn of(name: &str, text: &str) -> Result<Scan, String> {
    read(name, text.as_bytes(), &ScanReadOptions::default()).map_err(|problems| problems.to_string())
}

fn near(points: &[Point3<f64>], expected: &[[f64; 3]]) {
    assert_eq!(points.len(), expected.len());
    for (own, expected) in points.iter().zip(expected) {
        assert!(
            (own - Point3::from(*expected)).norm() < 1e-15,
            "{own} {expected:?}"
        );
    }
}

const TWO: [[f64; 3]; 2] = [[1e-3, -2.5e-3, 3e-3], [4e-3, 5e-3, 6e-3]];

#[test]
fn rows_are_read_whatever_separates_them() {
    for text in [
        "1 -2.5 3\n4 5 6\n",
        "\u{feff}# scan\r\n1\t-2.5\t3\r\n\r\n4\t5\t6\r\n",
        "1,-2.5,3\n4,5,6\n",
        "1;-2,5;3\n4;5;6\n",
        "1,0 -2,5 3,0\n4 5 6\n",
        "// a remark\n% another\nexported points\n1 -2.5 3\n! inside\n4 5 6\n",
        "2\n1 -2.5 3 255 0 17\n4 5 6 0 0 0\n",
        "1 -2.5 3 0.5\n4 5 6 0.7\n",
    ] {
        let found = of("a.xyz", text).unwrap();
        near(&found.points, &TWO);
        assert_eq!(found.format, ScanFormat::Rows, "{text}");
        assert!(found.normals.is_empty() && found.names.is_empty() && found.nominal.is_empty());
        assert_eq!(found.notes, ["no unit is given: mm assumed"]);
    }
    let inches = ScanReadOptions {
        unit: Some(LengthUnit::Inch),
    };
    let found = read("a.asc", b"1 2 3\n", &inches).unwrap();
    near(&found.points, &[[0.0254, 0.0508, 0.0762]]);
    assert!(found.notes.is_empty());
}

#[test]
fn three_numbers_of_length_one_behind_a_point_are_its_normal() {
    let found = of("a.xyz", "1 -2.5 3 0 0.6 -0.8\n4 5 6 0 0 0\n").unwrap();
    near(&found.points, &TWO);
    assert_eq!(found.normals, [Some(Vector3::new(0.0, 0.6, -0.8)), None]);
    assert!(
        found
            .notes
            .contains(&"1 points have no normal of length 1".to_owned())
    );
}

#[test]
fn tables_are_read_by_their_names() {
    for text in [
        "x_mm,y_mm,z_mm\n1,-2.5,3\n4,5,6\n",
        "X [um];label;Y [um];Z [um]\n1000;P1;-2500;3000\n4000;P2;5000;6000\n",
        "exported by a machine\nX Y Z\n1 -2.5 3\n4 5 6\n",
        "//X Y Z Intensity\n1 -2.5 3 7\n4 5 6 7\n",
        "Feature\tActual X (mm)\tActual Y (mm)\tActual Z (mm)\nA\t1\t-2,5\t3\nB\t4\t5\t6\n",
    ] {
        near(&of("a.csv", text).unwrap().points, &TWO);
    }
    let text = "name,x_mm,y_mm,z_mm,nx,ny,nz,nom_x_mm,nom_y_mm,nom_z_mm,dev_um\n\
                P1,1,-2.5,3,0,0,1,1,-2.5,2.99,10\nP2,4,5,6,0,0,1,,,,\nP3,,,,,,,7,8,9,\n";
    let found = of("cmm.csv", text).unwrap();
    near(&found.points, &TWO);
    assert_eq!(found.names, ["P1", "P2"]);
    assert_eq!(found.normals, [Some(Vector3::z()); 2]);
    near(&[found.nominal[0].unwrap()], &[[1e-3, -2.5e-3, 2.99e-3]]);
    assert_eq!((found.nominal[1], found.deviations[1]), (None, None));
    assert!((found.deviations[0].unwrap() - 10e-6).abs() < 1e-18);
    assert_eq!(found.notes, ["1 rows without a measured point"]);
}

#[test]
fn the_first_sheet_of_a_workbook_is_a_table() {
    let text =
        |place: &str, value: &str| format!(r#"<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>"#);
    let cell = |place: &str, value: &str| format!(r#"<c r="{place}"><v>{value}</v></c>"#);
    let row = |number: usize, cells: [String; 4]| format!(r#"<row r="{number}">{}</row>"#, cells.concat());
    let sheet = |y: &str| {
        format!(
            r#"<?xml version="1.0"?><worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>{}{}{}</sheetData></worksheet>"#,
            row(
                1,
                [
                    text("A1", "Name"),
                    text("B1", "X [mm]"),
                    text("C1", "Y [mm]"),
                    text("D1", "Z [mm]")
                ]
            ),
            row(
                2,
                [
                    text("A2", "P1"),
                    cell("B2", "1"),
                    cell("C2", "-2.5"),
                    cell("D2", "3")
                ]
            ),
            row(
                3,
                [text("A3", "P2"), cell("B3", "4"), text("C3", y), cell("D3", "6")]
            ),
        )
    };
    let found = read("a.xlsx", &workbook_of(&sheet("5")), &ScanReadOptions::default()).unwrap();
    near(&found.points, &TWO);
    assert_eq!(
        (found.format, found.names),
        (ScanFormat::Workbook, vec!["P1".to_owned(), "P2".to_owned()])
    );
    let problems = read("a.xlsx", &workbook_of(&sheet("x")), &ScanReadOptions::default()).unwrap_err();
    assert!(
        problems.to_string().contains("a.xlsx:3:6: `x` is not a number"),
        "{problems}"
    );
}

const CUBE_CORNER: &str =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

#[test]
fn point_clouds_and_meshes_give_vertices_and_normals() {
    let cloud = format!("{CUBE_CORNER}end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
    let found = of("a.ply", &cloud).unwrap();
    near(
        &found.points,
        &[[0.0; 3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 1e-3]],
    );
    assert!(found.normals.is_empty());
    let with = format!(
        "{CUBE_CORNER}property float nx\nproperty float ny\nproperty float nz\nend_header\n\
         0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 9\n"
    );
    let found = of("a.ply", &with).unwrap();
    assert_eq!(
        found.normals,
        [Some(Vector3::z()), Some(Vector3::z()), Some(Vector3::z()), None]
    );
    let faces = format!(
        "{CUBE_CORNER}element face 3\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
         3 0 1 2\n3 0 2 3\n3 0 3 1\n"
    );
    let found = of("a.ply", &faces).unwrap();
    // Around the corner: the three faces x = 0, y = 0, z = 0 of equal area.
    let mean = Vector3::repeat(1.0).normalize();
    assert!(
        (found.normals[0].unwrap() - mean).norm() < 1e-12,
        "{:?}",
        found.normals
    );
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\nendloop\nendfacet\nendsolid\n";
    let found = of("a.stl", stl).unwrap();
    assert_eq!((found.points.len(), found.normals[1]), (3, Some(Vector3::z())));
}

const QIF: &str = r#"<?xml version="1.0"?><QIFDocument>
<FileUnits><PrimaryUnits><LinearUnit><UnitConversion><Factor>0.001</Factor></UnitConversion></LinearUnit></PrimaryUnits></FileUnits>
<PointFeatureNominal id="3"><Location>1 -2.5 2.99</Location><Normal>0 0 1</Normal></PointFeatureNominal>
<PointFeatureItem id="4"><FeatureNominalId>3</FeatureNominalId><FeatureName>P1</FeatureName></PointFeatureItem>
<PointFeatureActual id="5"><FeatureItemId>4</FeatureItemId><Location>1 -2.5 3</Location></PointFeatureActual>
<EdgePointFeatureActual id="6"><Location>4 5 6</Location><Normal>0 1 0</Normal></EdgePointFeatureActual>
<CylinderFeatureActual id="7"><Axis><AxisPoint>1 2 3</AxisPoint><Direction>0 0 2</Direction></Axis><Diameter>8.5</Diameter><Form>0.012</Form>
</CylinderFeatureActual></QIFDocument>"#;

#[test]
fn points_of_qif_have_names_normals_and_nominal_points() {
    let found = of("a.qif", QIF).unwrap();
    near(&found.points, &TWO);
    assert_eq!(found.names, ["P1", ""]);
    assert_eq!(found.normals, [Some(Vector3::z()), Some(Vector3::y())]);
    near(&[found.nominal[0].unwrap()], &[[1e-3, -2.5e-3, 2.99e-3]]);
    let [bore] = found.features.as_slice() else {
        panic!("{:?}", found.features)
    };
    assert_eq!(
        (bore.kind, bore.direction),
        (MeasuredFeatureKind::Cylinder, Some(Vector3::z()))
    );
    assert!((bore.diameter.unwrap() - 8.5e-3).abs() < 1e-15 && (bore.form.unwrap() - 12e-6).abs() < 1e-18);
}

#[test]
fn points_of_dmis_have_names_normals_and_nominal_points() {
    let text = "$$ report\nDMISMN/'out',05.0\nUNITS/MM,ANGDEC\nF(P1)=FEAT/POINT,CART,1,-2.5,2.99,0,0,1\n\
                FA(P1)=FEAT/POINT,CART,1.0,-2.5,$\n 3.0,0,0,1\nPTDATA/CART,4,5,6\n\
                FA(C1)=FEAT/CIRCLE,INNER,CART,10,20,0,0,0,1,8.5\nFA(PL)=FEAT/PLANE,CART,0,0,1,0,0,1\nENDFIL\n";
    let found = of("a.dms", text).unwrap();
    near(&found.points, &TWO);
    assert_eq!(found.names, ["P1", ""]);
    assert_eq!(found.normals, [Some(Vector3::z()), None]);
    near(&[found.nominal[0].unwrap()], &[[1e-3, -2.5e-3, 2.99e-3]]);
    assert_eq!(found.features.len(), 2);
    assert!((found.features[0].diameter.unwrap() - 8.5e-3).abs() < 1e-15);
    let program = of("a.dmi", "UNITS/INCH,ANGDEC\nPTMEAS/CART,1,0,0,0,0,1\n").unwrap();
    near(&program.points, &[[0.0254, 0.0, 0.0]]);
    assert!(
        program.notes[0].contains("commanded points"),
        "{:?}",
        program.notes
    );
}

#[test]
fn problems_are_reported_with_their_positions() {
    for (name, text, part) in [
        ("a.xyz", "", "the file has no points"),
        ("a.xyz", "only words\n", "1:1: neither numbers nor names"),
        ("a.xyz", "1 2 3\n1 x 3\n", "2:3: `x` is not a number"),
        ("a.xyz", "1 2 3\n1 2\n", "2:1: 2 numbers in a row"),
        ("a.xyz", "1 2 3\n1 2 inf\n", "2:5: `inf` is not a number"),
        ("a.xyz", "1 2 3\n1 2 1e12\n", "2:1: a coordinate of"),
        (
            "a.xyz",
            "3\n1 2 3\n1 2 4\n",
            "1:1: the first line specifies 3 points, but 2 follow",
        ),
        (
            "a.csv",
            "x_mm,y_mm,z_kg\n1,2,3\n",
            "1:11: `kg` is not a unit of `z`",
        ),
        ("a.csv", "x_mm,y_mm,b\n1,2,3\n", "1:1: no column `z_mm`"),
        (
            "a.csv",
            "x_mm,y_mm,z_mm,X_um\n1,2,3,4\n",
            "1:16: `X_um` repeats an earlier column",
        ),
        ("a.csv", "x_mm,y_mm,z_mm\n1,,3\n", "2:1: a coordinate is missing"),
        (
            "a.csv",
            "x_mm,y_mm,z_mm\n1,2\n",
            "2:1: 2 cells, but the table has 3 columns",
        ),
        ("a.csv", "x_mm,y_mm,z_mm\n", "the file has no points"),
        ("a.qif", "<QIFDocument/>", "no measured points and no features"),
        ("a.qif", "<html/>", "`html` is not a QIF document"),
        (
            "a.qif",
            &QIF.replace("1 -2.5 3<", "1 a 3<"),
            "the location is not three numbers",
        ),
        ("a.dmis", "UNITS/ELL\n", "1:1: `ELL` is not a unit of length"),
        (
            "a.dmis",
            "FA(P)=FEAT/POINT,POL,1,2,3\n",
            "coordinates are not Cartesian",
        ),
        ("a.dmis", "FA(P)=FEAT/POINT,CART,1,b,3\n", "`b` is not a number"),
        (
            "a.dmis",
            "FA(P)=FEAT/POINT,CART,1,3\n",
            "2 numbers: at least 3 required",
        ),
        ("a.dmis", "$$ nothing\n", "no measured points and no features"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
            "no property `y`",
        ),
    ] {
        let given = of(name, text).unwrap_err();
        assert!(
            given.contains(part) && given.contains("help: "),
            "{text}: {given}"
        );
    }
    let given = of("a.xyz", "1 2 3\n1 x 3\n1 2 3\ny 2 3\n4\n").unwrap_err();
    for place in ["a.xyz:2:3:", "a.xyz:4:1:", "a.xyz:5:1:"] {
        assert!(given.contains(place), "{given}");
    }
}

#[test]
fn a_unit_that_contradicts_the_file_is_refused() {
    let inches = ScanReadOptions {
        unit: Some(LengthUnit::Inch),
    };
    for (name, text, part) in [
        (
            "a.csv",
            "x_mm,y_mm,z_mm\n1,2,3\n",
            "the columns state their units",
        ),
        ("a.qif", QIF, "QIF files state their unit"),
        ("a.dmis", "UNITS/MM\nPTDATA/CART,1,2,3\n", "the file is in MM"),
    ] {
        let given = read(name, text.as_bytes(), &inches).unwrap_err().to_string();
        assert!(given.contains(part), "{given}");
    }
    let same = ScanReadOptions {
        unit: Some(LengthUnit::Millimetre),
    };
    assert!(read("a.dmis", b"UNITS/MM\nPTDATA/CART,1,2,3\n", &same).is_ok());
}

/// The results of the QIF widget of the standard: six points with nominal points, features in mm.
#[test]
fn samples_of_the_standard_are_read() {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        return;
    };
    let folder = Path::new(&samples).join("measurements/qif/_legacy/qif-2.1/samples");
    let widget = folder.join("QIF Widget/WIDGET_QIF_RESULTS.QIF");
    if !widget.exists() {
        return;
    }
    let found = read_file(&widget, "widget.qif", &ScanReadOptions::default()).unwrap();
    assert_eq!(found.points.len(), 6);
    near(&found.points[..1], &[[-5.584e-3, 27.902e-3, -104.726e-3]]);
    let nominal = found.nominal[0].unwrap();
    assert!((nominal.z + 0.105).abs() < 1e-12, "{nominal}");
    assert_eq!(
        (found.names[0].as_str(), found.normals[0]),
        ("BACK_FACE", Some(-Vector3::z()))
    );
    assert!(
        found
            .features
            .iter()
            .any(|feature| feature.kind == MeasuredFeatureKind::Plane)
    );
}

/// Bytes of good files are changed, dropped and doubled at random: whatever is read is valid, nothing stops.
#[test]
fn damaged_files_are_read_or_refused() {
    let faces = format!(
        "{CUBE_CORNER}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n"
    );
    let mut state = 1_u64;
    let mut next = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for (name, text) in [
        ("a.xyz", "3\n1 -2.5 3 0 0.6 -0.8\n4,5 5 6 0 0 1\n7 8 9 0 0 1\n"),
        (
            "a.csv",
            "name;X [um];y_mm;z_in;nx;ny;nz;nom_x;dev_um\nP;1000;2,5;3;0;0;1;4;5\n\"Q\";4;5;6;;;;;\n",
        ),
        ("a.qif", QIF),
        (
            "a.dmis",
            "UNITS/MM\nF(P)=FEAT/POINT,CART,1,2,3,0,0,1\nFA(P)=FEAT/POINT,CART,1,2,$\n3,0,0,1\nFA(C)=FEAT/CIRCLE,INNER,CART,1,2,3,0,0,1,4\n",
        ),
        ("a.ply", &faces),
    ] {
        for _ in 0..2000 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=next(4) {
                let at = next(bytes.len());
                match next(4) {
                    0 => bytes[at] = next(256) as u8,
                    1 => drop(bytes.remove(at)),
                    2 => bytes.insert(at, b",; \t\n-$(<=/e9"[next(13)]),
                    _ => bytes.truncate(at.max(1)),
                }
                if bytes.is_empty() {
                    break;
                }
            }
            let Ok(found) = read(name, &bytes, &ScanReadOptions::default()) else {
                continue;
            };
            assert!(
                found
                    .points
                    .iter()
                    .all(|p| p.coords.iter().all(|x| x.abs() <= 1e4))
            );
            assert!(
                found
                    .normals
                    .iter()
                    .flatten()
                    .all(|normal| (normal.norm() - 1.0).abs() < 1e-9)
            );
            for count in [
                found.normals.len(),
                found.nominal.len(),
                found.deviations.len(),
                found.names.len(),
            ] {
                assert!(count == 0 || count == found.points.len());
            }
        }
    }
}
