//! A robot file with compliances that were identified in place of its own.
//!
//! Everything else stays as it is: order, remarks, spelling. Springs, covariance and model error of the file go, since
//! they belong to the compliances that are replaced; sources that no number names any more go with them.

use std::collections::BTreeSet;

use armill_core::robot::Axis;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value, value};

use crate::document::{Document, Problems};
use crate::robot::spring_tables::SpringKind;
use crate::sources;

/// What was identified of an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// Its compliances, one each.
    pub springs: Vec<IdentifiedSpring>,
    /// Covariance of those that turn, in their order, rad^2/(N m)^2; empty if it is not known.
    pub covariance: Vec<Vec<f64>>,
    /// How much tests miss by that were left out, as a fraction of what was measured; `None` if none were.
    pub model_error: Option<f64>,
    /// The tests they come from, for people.
    pub what: String,
    /// Where these tests are kept.
    pub place: String,
}

/// One compliance that was identified.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedSpring {
    /// `base`, a joint's name, or `flange`.
    pub at: String,
    /// Its direction.
    pub kind: SpringKind,
    /// rad/(N m), or m/N where it slides.
    pub compliance: f64,
    /// Standard uncertainty, same unit.
    pub standard_uncertainty: f64,
}

impl IdentifiedSpring {
    /// Whether its compliance is in rad/(N m), else m/N.
    fn turns(&self) -> bool {
        matches!(self.kind, SpringKind::Drive | SpringKind::About(_))
    }
}

/// Key of the source of identified numbers, in `[sources]` and in the tables.
const KEY: &str = "identified";
/// Larger model errors are not distinguished.
const MOST_PERCENT: f64 = 1000.0;
/// Heading of the note of the file that was there before.
const BEFORE_TESTS: &str = "Written before its compliances were identified from load tests.";
/// Digits kept of a compliance: far more than any test gives.
const DIGITS: usize = 7;

/// The robot file `text` (at `path`) with these compliances in place of its own.
///
/// A drive goes into the table of its joint and takes the place of a torque curve as well; a drive that is not among
/// `identified` keeps what the file has. All other springs become tables `[[spring]]`. The resulting file has been
/// read once more, so that it is one that `read` takes.
///
/// # Errors
/// A text that is not TOML; what no robot file may say once the compliances are in it, as when some joints have one
/// and others have none: such problems are at their place in the new text, reported as those of `path (identified)`.
pub fn with_springs(path: &str, text: &str, identified: &Identified) -> Result<String, Problems> {
    let Identified {
        springs,
        covariance,
        model_error,
        ..
    } = identified;
    let checked = Document::parse(path, text)?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    if let Some(note) = document.get("note").and_then(Item::as_str)
        && !note.ends_with(BEFORE_TESTS)
    {
        let note = format!("{} {BEFORE_TESTS}", note.trim_end());
        document.insert("note", value(note));
    }
    document.remove("spring");
    document.remove("covariance");
    document.remove("model_error");
    // `joint = [{ ... }]` is the same as tables of their own.
    if let Some(joint) = document.get_mut("joint")
        && let Ok(mut joints) = std::mem::take(joint).into_array_of_tables()
    {
        joints.iter_mut().for_each(|joint| set_drive(joint, springs));
        *joint = Item::ArrayOfTables(joints);
    }
    let mut others = ArrayOfTables::new();
    for spring in springs {
        match spring.kind {
            SpringKind::About(axis) => others.push(spring_table(spring, "about", axis)),
            SpringKind::Along(axis) => others.push(spring_table(spring, "along", axis)),
            SpringKind::Drive | SpringKind::PrismaticDrive => {}
        }
    }
    if !others.is_empty() {
        document.insert("spring", Item::ArrayOfTables(others));
    }
    // One spring alone has its standard uncertainty and shares nothing.
    if covariance.len() > 1 {
        let turning = springs.iter().filter(|spring| spring.turns());
        document.insert("covariance", covariance_table(turning, covariance));
    }
    if let Some(fraction) = model_error {
        let mut table = Table::new();
        let percent = (fraction * 1e4).round() / 1e2;
        table.insert("percent", value(percent.min(MOST_PERCENT)));
        table.insert("source", value(KEY));
        document.insert("model_error", Item::Table(table));
    }
    set_sources(&mut document, KEY, [&identified.what, &identified.place])?;
    let text = document.to_string();
    super::read(&format!("{path} (identified)"), "", &text)?;
    Ok(text)
}

/// Adds the source `key` of numbers that were measured, with what and where, and removes those that no number names any
/// more.
pub(super) fn set_sources(
    document: &mut DocumentMut,
    key: &str,
    [what, place]: [&str; 2],
) -> Result<(), Problems> {
    let now = Document::parse("", &document.to_string())?;
    let named: BTreeSet<&str> = sources::named(&now).into_iter().map(|(_, key)| key).collect();
    if let Some(sources) = document.get_mut("sources").and_then(Item::as_table_like_mut) {
        let keys: Vec<String> = sources.iter().map(|(key, _)| key.to_owned()).collect();
        for key in keys.iter().filter(|key| !named.contains(key.as_str())) {
            sources.remove(key);
        }
        let mut entry = Table::new();
        for (key, content) in [
            ("what", what),
            ("where", place),
            ("licence", "your own measurement"),
        ] {
            entry.insert(key, value(content));
        }
        sources.insert(key, Item::Table(entry));
    }
    Ok(())
}

/// The drive that was identified into the table of its joint, in place of whatever the table says of compliance; a
/// joint without one stays as it is.
fn set_drive(joint: &mut Table, springs: &[IdentifiedSpring]) {
    let name = joint
        .get("name")
        .and_then(Item::as_str)
        .unwrap_or_default()
        .to_owned();
    let drive = |spring: &&IdentifiedSpring| {
        spring.at == name && matches!(spring.kind, SpringKind::Drive | SpringKind::PrismaticDrive)
    };
    let Some(spring) = springs.iter().find(drive) else {
        return;
    };
    for key in [
        "compliance_rad_per_n_m",
        "compliance_u_rad_per_n_m",
        "compliance_um_per_n",
        "compliance_u_um_per_n",
        "compliance_u_source",
        "torque_curve_n_m_rad",
        "torque_curve_falling_n_m_rad",
    ] {
        joint.remove(key);
    }
    set_compliance(joint, spring);
    joint.insert("compliance_source", value(KEY));
}

/// Compliance and standard uncertainty under the names of their unit: rad/(N m), or um/N, which is 1e-6 m/N.
fn set_compliance(table: &mut Table, spring: &IdentifiedSpring) {
    let (keys, scale) = if spring.turns() {
        (["compliance_rad_per_n_m", "compliance_u_rad_per_n_m"], 1.0)
    } else {
        (["compliance_um_per_n", "compliance_u_um_per_n"], 1e6)
    };
    table.insert(keys[0], Item::Value(number(spring.compliance * scale)));
    table.insert(keys[1], Item::Value(number(spring.standard_uncertainty * scale)));
}

/// A table `[[spring]]`; `word` is `about` or `along`.
fn spring_table(spring: &IdentifiedSpring, word: &str, axis: Axis) -> Table {
    let mut table = Table::new();
    table.insert("at", value(spring.at.as_str()));
    table.insert(word, value(axis.letter().to_string()));
    set_compliance(&mut table, spring);
    table.insert("source", value(KEY));
    table
}

/// The table `[covariance]`: `of` names the springs that turn as the file does elsewhere, then a row a line.
fn covariance_table<'a>(
    springs: impl Iterator<Item = &'a IdentifiedSpring>,
    covariance: &[Vec<f64>],
) -> Item {
    let mut table = Table::new();
    table.insert(
        "of",
        value(
            springs
                .map(|spring| spring.kind.name_at(&spring.at))
                .collect::<Array>(),
        ),
    );
    let mut rows = Array::new();
    for row in covariance {
        let mut row: Value = Value::Array(row.iter().map(|entry| number(*entry)).collect());
        row.decor_mut().set_prefix("\n  ");
        rows.push_formatted(row);
    }
    rows.set_trailing("\n");
    rows.set_trailing_comma(true);
    table.insert("matrix_rad2_per_n2_m2", value(rows));
    table.insert("source", value(KEY));
    Item::Table(table)
}

/// A number with the digits that are kept, written as `5.946000e-7`.
fn number(of: f64) -> Value {
    let text = format!("{of:.*e}", DIGITS - 1);
    text.parse().unwrap_or_else(|_| Value::from(of))
}

/// [`with_springs`] for compliances given by a user, with the covariance of those that turn, which may be empty: their source is `given`, with
/// `what` in the words of the user.
///
/// # Errors
/// As [`with_springs`].
pub fn with_given_springs(
    path: &str,
    text: &str,
    given: (Vec<IdentifiedSpring>, Vec<Vec<f64>>),
    what: &str,
) -> Result<String, Problems> {
    let (springs, covariance) = given;
    let identified = Identified {
        springs,
        covariance,
        model_error: None,
        what: what.to_owned(),
        place: NOT_STATED.to_owned(),
    };
    let written = with_springs(path, text, &identified)?;
    let checked = Document::parse(path, &written)?;
    let mut document: DocumentMut = written
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    let note = document.get("note").and_then(Item::as_str);
    let before = note.and_then(|note| note.strip_suffix(BEFORE_TESTS));
    if let Some(before) = before.map(|before| before.trim_end().to_owned()) {
        document.insert("note", value(before));
    }
    if let Some(joints) = document.get_mut("joint").and_then(Item::as_array_of_tables_mut) {
        for joint in joints.iter_mut() {
            if joint.get("compliance_source").and_then(Item::as_str) == Some(KEY) {
                joint.insert("compliance_source", value(GIVEN_KEY));
            }
        }
    }
    if let Some(covariance) = document.get_mut("covariance").and_then(Item::as_table_like_mut) {
        covariance.insert("source", value(GIVEN_KEY));
    }
    if let Some(sources) = document.get_mut("sources").and_then(Item::as_table_like_mut)
        && let Some(mut entry) = sources.remove(KEY)
    {
        if let Some(entry) = entry.as_table_like_mut() {
            entry.insert("licence", value(NOT_STATED));
        }
        sources.insert(GIVEN_KEY, entry);
    }
    let text = document.to_string();
    super::read(&format!("{path} (given)"), "", &text)?;
    Ok(text)
}

/// Key of the source of compliances given by a user.
const GIVEN_KEY: &str = "given";
/// Place and licence of such a source.
const NOT_STATED: &str = "not stated";

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "# A lever.\nformat = 1\nname = \"lever\"\n\n[chain]\nsource = \"drawing\"\n\
        motions = [{ about = \"z\", joint = \"A\" }, { along = \"x\", joint = \"B\" }]\n\n\
        [[joint]]\nname = \"A\" # turns\nsign = 1\nsource = \"drawing\"\ncompliance_rad_per_n_m = 1e-3\n\
        compliance_source = \"guess\"\n\n[[joint]]\nname = \"B\"\nsign = 1\nsource = \"drawing\"\n\
        compliance_um_per_n = 1\ncompliance_source = \"guess\"\n\n\
        [sources.drawing]\nwhat = \"lengths\"\nwhere = \"here\"\nlicence = \"ours\"\n\n\
        [sources.guess]\nwhat = \"a guess\"\nwhere = \"nowhere\"\nlicence = \"ours\"\n";

    fn spring(at: &str, kind: SpringKind, compliance: f64) -> IdentifiedSpring {
        IdentifiedSpring {
            at: at.to_owned(),
            kind,
            compliance,
            standard_uncertainty: 0.1 * compliance,
        }
    }

    fn identified(springs: &[IdentifiedSpring], covariance: &[[f64; 2]]) -> Identified {
        Identified {
            springs: springs.to_vec(),
            covariance: covariance.iter().map(|row| row.to_vec()).collect(),
            model_error: Some(0.0942),
            what: "43 tests".to_owned(),
            place: "tests.csv".to_owned(),
        }
    }

    #[test]
    fn drives_are_replaced_and_the_file_reads_with_them() {
        let springs = [
            spring("A", SpringKind::Drive, 2.5e-6),
            spring("B", SpringKind::PrismaticDrive, 3e-8),
        ];
        let text = with_springs("lever.toml", FILE, &identified(&springs, &[])).unwrap();
        assert!(
            text.starts_with("# A lever.\n") && text.contains("# turns"),
            "{text}"
        );
        assert!(!text.contains("guess"), "{text}");
        let read = super::super::read("lever.toml", "lever", &text).unwrap();
        assert!((read.robot.structure().model_error - 0.0942).abs() < 1e-12);
        let compliance = read.robot.compliance().unwrap();
        assert!((compliance[0].value - 2.5e-6).abs() < 1e-18, "{text}");
        assert!((compliance[1].value - 3e-8).abs() < 1e-18, "{text}");
        assert!(
            (compliance[1].standard_uncertainty - 3e-9).abs() < 1e-18,
            "{text}"
        );
        assert_eq!(
            read.joint_notes[0].compliance_source.as_deref(),
            Some("identified")
        );
    }

    #[test]
    fn a_model_error_replaces_the_previous_one_and_is_removed_where_none_is_known() {
        let drives = [
            spring("A", SpringKind::Drive, 2.5e-6),
            spring("B", SpringKind::PrismaticDrive, 3e-8),
        ];
        let of = |text: &str, model_error| {
            let found = Identified {
                model_error,
                ..identified(&drives, &[])
            };
            with_springs("lever.toml", text, &found).unwrap()
        };
        let read = |text: &str| {
            let read = super::super::read("lever.toml", "lever", text).unwrap();
            (read.robot.structure().model_error * 100.0, read.note)
        };
        let first = of(
            &FILE.replace("name = \"lever\"", "name = \"lever\"\nnote = \"Soft.\""),
            Some(0.26),
        );
        let second = of(&first, Some(1e4));
        let third = of(&second, None);
        let note = Some(format!("Soft. {BEFORE_TESTS}"));
        assert_eq!(read(&first), (26.0, note.clone()));
        assert_eq!(read(&second), (MOST_PERCENT, note.clone()));
        assert_eq!(read(&third), (0.0, note));
        assert_eq!(third.matches("sources.identified").count(), 1, "{third}");
    }

    #[test]
    fn drives_identified_together_keep_their_covariance() {
        let two = FILE.replace("compliance_um_per_n = 1", "compliance_rad_per_n_m = 1e-3");
        let two = two.replace(
            "{ along = \"x\", joint = \"B\" }",
            "{ about = \"x\", joint = \"B\" }",
        );
        let springs = [
            spring("A", SpringKind::Drive, 2.5e-6),
            spring("B", SpringKind::Drive, 3e-6),
        ];
        let known = identified(&springs, &[[1e-14, 4e-15], [4e-15, 9e-14]]);
        let text = with_springs("lever.toml", &two, &known).unwrap();
        let read = super::super::read("lever.toml", "lever", &text).unwrap();
        let known = read.robot.structure().covariance.clone().unwrap();
        assert_eq!(known[(0, 1)], 4e-15);
        assert!(read.robot.structure().springs.is_empty());
    }

    #[test]
    fn other_springs_are_in_separate_tables_with_their_covariance() {
        let springs = [
            spring("A", SpringKind::Drive, 2.5e-6),
            spring("A", SpringKind::About(Axis::X), 1e-7),
            spring("flange", SpringKind::Along(Axis::Z), 2e-8),
        ];
        let known = identified(&springs, &[[1e-14, -2e-16], [-2e-16, 1e-16]]);
        let text = with_springs("lever.toml", FILE, &known).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let springs = table["spring"].as_array().unwrap();
        assert_eq!(springs[0]["about"].as_str(), Some("x"));
        assert_eq!(springs[1]["compliance_um_per_n"].as_float(), Some(2e-2));
        assert_eq!(table["covariance"]["of"].to_string(), "[\"A\", \"A about x\"]");
        assert_eq!(
            table["covariance"]["matrix_rad2_per_n2_m2"][1][0].as_float(),
            Some(-2e-16)
        );
        let read = super::super::read("lever.toml", "lever", &text).unwrap();
        let known = read.robot.structure().covariance.clone().unwrap();
        // Drives first, then springs: A, B, A about x, flange along z. 7 digits are written.
        assert_eq!(known.shape(), (4, 4));
        assert!((known[(0, 0)] - 1e-14).abs() < 1e-20 && (known[(2, 2)] - 1e-16).abs() < 1e-22);
        assert!((known[(0, 2)] + 2e-16).abs() < 1e-22 && known[(0, 3)] == 0.0);
        assert!((read.robot.structure().springs[1].compliance.value - 2e-8).abs() < 1e-14);
        // Identified once more, nothing of the first time is left.
        let drives = [
            spring("A", SpringKind::Drive, 1e-6),
            spring("B", SpringKind::PrismaticDrive, 3e-8),
        ];
        let again = with_springs("lever.toml", &text, &identified(&drives, &[])).unwrap();
        assert!(
            !again.contains("spring") && !again.contains("covariance"),
            "{again}"
        );
    }

    #[test]
    fn a_torque_curve_is_removed_with_the_compliance_that_it_replaced() {
        let curves = "torque_curve_n_m_rad = [[0, 0], [10, 1e-5]]\ntorque_curve_falling_n_m_rad = [[0, 0], [10, 2e-5]]";
        let curved = FILE.replace("compliance_rad_per_n_m = 1e-3", curves);
        let springs = [spring("A", SpringKind::Drive, 2.5e-6)];
        let text = with_springs("lever.toml", &curved, &identified(&springs, &[])).unwrap();
        assert!(!text.contains("torque_curve"), "{text}");
        let robot = super::super::read("lever.toml", "lever", &text).unwrap().robot;
        assert!(
            (robot.compliance().unwrap()[0].value - 2.5e-6).abs() < 1e-18,
            "{text}"
        );
    }

    #[test]
    fn joints_in_one_line_each_are_joints_as_well() {
        let start = FILE.find("[[joint]]").unwrap();
        let end = FILE.find("[sources").unwrap();
        let joints = r#"joint = [
  { name = "A", sign = 1, source = "drawing", compliance_rad_per_n_m = 1e-3, compliance_source = "drawing" },
  { name = "B", sign = 1, source = "drawing", compliance_um_per_n = 1, compliance_source = "drawing" },
]
"#;
        let inline = FILE[..start].replace("format = 1\n", &format!("format = 1\n{joints}")) + &FILE[end..];
        let inline = inline.split("[sources.guess]").next().unwrap();
        let springs = [spring("B", SpringKind::PrismaticDrive, 3e-8)];
        let text = with_springs("lever.toml", inline, &identified(&springs, &[])).unwrap();
        let robot = super::super::read("lever.toml", "lever", &text).unwrap().robot;
        assert!(
            (robot.compliance().unwrap()[1].value - 3e-8).abs() < 1e-18,
            "{text}"
        );
    }

    #[test]
    fn refuses_what_the_reader_would_refuse() {
        let bare = FILE
            .replace(
                "compliance_rad_per_n_m = 1e-3\ncompliance_source = \"guess\"\n",
                "",
            )
            .replace("compliance_um_per_n = 1\ncompliance_source = \"guess\"\n", "");
        let bare = bare.split("[sources.guess]").next().unwrap();
        let springs = [spring("A", SpringKind::Drive, 2.5e-6)];
        let problems = with_springs("lever.toml", bare, &identified(&springs, &[])).unwrap_err();
        let given = problems.to_string();
        assert!(
            given.contains("lever.toml (identified):") && given.contains("1 of 2 joints have a compliance"),
            "{given}"
        );
    }
}
