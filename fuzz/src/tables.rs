//! Requirements on the journal of an arm, on tables of conditions, bodies and numbers, and their good inputs.

use std::sync::OnceLock;

use armill_core::robot::Robot;
use armill_formats::measurement::{bodies, conditions, journal, numbers};
use armill_study::library;
use rawzip::{CompressionMethod, ZipArchiveWriter};

use crate::fixtures::seeds;
use crate::verdicts::refused;

/// A robot with six joints.
fn robot() -> &'static Robot {
    static ROBOT: OnceLock<Robot> = OnceLock::new();
    ROBOT.get_or_init(|| {
        let found = library::robot("yaskawa/mh12").expect("it is in the library");
        found.expect("every robot of the library reads").robot
    })
}

/// The journal of an arm.
pub fn journal(bytes: &[u8]) {
    match journal::read("journal.toml", bytes) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert!(found.tool_point.iter().all(|value| value.is_finite()));
            let finite = |own: &journal::Entry| {
                own.temperature_c.is_finite() && own.point.iter().all(|value| value.is_finite())
            };
            assert!(found.measurements.iter().all(finite));
        }
    }
}

/// Loads and directions at poses.
pub fn conditions(bytes: &[u8]) {
    let robot = robot();
    match conditions::read("conditions.csv", bytes, robot) {
        Err(problems) => refused(&problems),
        Ok(rows) => {
            assert!(!rows.is_empty());
            for row in rows {
                assert_eq!(row.joints.len(), robot.joints().len());
                assert!(
                    row.joints
                        .iter()
                        .chain(&row.condition.directions)
                        .all(|value| value.is_finite())
                );
                let wrench = row.condition.wrench;
                assert!(
                    wrench
                        .force
                        .iter()
                        .chain(&wrench.moment)
                        .all(|value| value.is_finite())
                );
            }
        }
    }
}

/// Poses of a body.
pub fn bodies(bytes: &[u8]) {
    match bodies::read("bodies.csv", bytes, robot()) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            assert!(!found.positions.is_empty());
            assert!(found.positions.iter().flatten().all(|value| value.is_finite()));
            assert!(
                found
                    .rotations
                    .is_none_or(|rotations| rotations.len() == found.positions.len())
            );
            assert!(
                found
                    .joints
                    .is_none_or(|joints| joints.len() == found.positions.len())
            );
        }
    }
}

/// A table of numbers, or a workbook.
pub fn numbers(bytes: &[u8]) {
    for columns in [numbers::Columns::First(2), numbers::Columns::Last(3)] {
        match numbers::read("numbers", bytes, columns) {
            Err(problems) => refused(&problems),
            Ok(rows) => {
                let (numbers::Columns::First(count) | numbers::Columns::Last(count)) = columns;
                assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == count));
                assert!(rows.iter().flatten().all(|value| value.is_finite()));
            }
        }
    }
}

/// The sheet of a workbook, which is not compressed.
pub fn sheet(bytes: &[u8]) {
    numbers(&workbook(bytes).expect("an archive in memory is written"));
}

/// Journals with every kind of measurement.
pub fn journals() -> Vec<Vec<u8>> {
    seeds(&[
        "format = 1\nrobot = \"yaskawa/mh12\"\ntool_mm = [0, 0, 150]\n[prior]\nlength_mm = 1\nangle_deg = 0.1\nfactor = 2\n\
         [[measurement]]\ndate = \"2026-11-24\"\ntemperature_c = 21.5\nkind = \"part\"\nfile = \"part.csv\"\nu_um = 20\n\
         [[measurement]]\ndate = \"2026-11-25\"\ntemperature_c = 22\nkind = \"tracker\"\nfile = \"t.csv\"\nu_um = 15\npoint_mm = [0, 0, 100]\nnote = \"n\"\n\
         [[measurement]]\ndate = \"2026-11-26\"\ntemperature_c = 22\nkind = \"load-tests\"\nfile = \"l.csv\"\n",
    ])
}

/// Tables of conditions of both separators.
pub fn condition_tables() -> Vec<Vec<u8>> {
    seeds(&[
        "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fz_kn,my_n_m,q2_direction\n0,1,2,3,4,5,6,0.1,7,-1\n0,1,2,3,4,5,,,,\n",
        "S_deg;L_deg;U_deg;R_deg;B_deg;T_deg;S_direction\n0;1,5;2;3;4;5;1\n",
    ])
}

/// Tables of bodies with quaternions, matrices and joints.
pub fn body_tables() -> Vec<Vec<u8>> {
    seeds(&[
        "x_mm,y_mm,z_mm,q0,q1,q2,q3,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n1,2,3,1,0,0,0,1,2,3,4,5,6\n",
        "X [mm];Y [mm];Z [in];qw;qx;qy;qz\n1,5;2;3;0;1;0;0\n",
        "theta_1,theta_2,theta_3,theta_4,theta_5,theta_6,m_00,m_01,m_02,m_03,m_10,m_11,m_12,m_13,m_20,m_21,m_22,m_23\n0,0,0,0,0,0,1,0,0,10,0,1,0,20,0,0,1,30\n",
    ])
}

/// Tables of numbers with every separator, and a workbook.
pub fn number_tables() -> Vec<Vec<u8>> {
    let mut all = seeds(&[
        "a b c\n1 2.5 -3e0\n  4 5 6\n",
        "# t\n1,2,3,\n4,5,6\n",
        "1;2,5;3\n",
        "P1\t1\t2\t3\n",
    ]);
    all.extend(sheets().iter().filter_map(|sheet| workbook(sheet).ok()));
    all
}

/// Sheets with numbers and texts.
pub fn sheets() -> Vec<Vec<u8>> {
    seeds(&[
        "<worksheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><dimension ref=\"A1:D3\"/><sheetData>\
         <row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>J1</t></is></c></row>\
         <row r=\"2\"><c r=\"A2\"><v>1.5</v></c><c r=\"B2\"><v>-2</v></c><c r=\"C2\"><v>3</v></c></row>\
         <row r=\"3\"><c r=\"A3\"><v>1</v></c><c r=\"B3\" t=\"str\"><v>2,5</v></c><c r=\"D3\"><v>4</v></c></row></sheetData></worksheet>",
    ])
}

/// A workbook with this sheet.
fn workbook(sheet: &[u8]) -> Result<Vec<u8>, rawzip::Error> {
    const TYPES: &str = "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"/>";
    const RELATIONS: &str = "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"r1\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>";
    const BOOK: &str = "<workbook xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\" xmlns:r=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships\"><sheets><sheet name=\"S\" sheetId=\"1\" r:id=\"r1\"/></sheets></workbook>";
    const SHEETS: &str = "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"r1\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet\" Target=\"worksheets/sheet1.xml\"/></Relationships>";
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, text) in [
        ("[Content_Types].xml", TYPES.as_bytes()),
        ("_rels/.rels", RELATIONS.as_bytes()),
        ("xl/workbook.xml", BOOK.as_bytes()),
        ("xl/_rels/workbook.xml.rels", SHEETS.as_bytes()),
        ("xl/worksheets/sheet1.xml", sheet),
    ] {
        let new = archive.new_file(name);
        let (mut entry, config) = new.compression_method(CompressionMethod::STORE).start()?;
        let mut writer = config.wrap(&mut entry);
        std::io::Write::write_all(&mut writer, text)?;
        let (_, descriptor) = writer.finish()?;
        entry.finish(descriptor)?;
    }
    archive.finish()?;
    Ok(bytes)
}
