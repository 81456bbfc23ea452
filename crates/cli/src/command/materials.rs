//! `armill materials`: the material library, one line per material ([`MaterialRow`]), or one material with all sets and
//! the values used ([`MaterialDetails`]); as text or JSON on stdout.

use armill_study::materials::{KienzleDetails, MaterialDetails, MaterialRow, MechanisticDetails};
use armill_study::number::{decimals, digits};
use armill_study::{StudyError, library};

use crate::arguments::MaterialsArguments;
use crate::outcome::Outcome;
use crate::terminal::{Align, columns, print};

/// Prints the library or one material of it.
///
/// # Errors
/// An unknown name; stdout cannot be written.
pub(crate) fn run(arguments: &MaterialsArguments) -> Result<Outcome, StudyError> {
    print(&match &arguments.name {
        Some(name) => {
            let found = MaterialDetails::of(name, &library::find_material(name)?);
            if arguments.json {
                serde_json::to_string(&found)?
            } else {
                as_text(&found)
            }
        }
        None => {
            let rows = MaterialRow::all()?;
            if arguments.json {
                serde_json::to_string(&rows)?
            } else {
                table(&rows)
            }
        }
    })?;
    Ok(Outcome::Fine)
}

/// One line per material: name, title, and the number of complete sets for each law.
fn table(rows: &[MaterialRow]) -> String {
    let law = |law: &str, sets: usize| match sets {
        0 => String::new(),
        1 => format!("{law} (1 set)"),
        sets => format!("{law} ({sets} sets)"),
    };
    let cells = |row: &MaterialRow| {
        let mechanistic = if row.mechanistic_sets == 0 && row.mechanistic_listed > 0 {
            "mechanistic (no complete set)".to_owned()
        } else {
            law("mechanistic", row.mechanistic_sets)
        };
        vec![
            row.name.clone(),
            row.title.clone(),
            mechanistic,
            law("kienzle", row.kienzle_sets),
        ]
    };
    let cells: Vec<Vec<String>> = rows.iter().map(cells).collect();
    columns(&cells, &[Align::Left; 4]).join("\n")
}

/// All sets of one material by law, then the values used for forces, and the sources.
fn as_text(found: &MaterialDetails) -> String {
    let mut lines = vec![format!("{} ({})", found.title, found.name)];
    lines.extend(found.note.iter().cloned());
    if !found.mechanistic.is_empty() {
        lines.push(String::new());
        lines.push(
            "Mechanistic coefficients: Ktc, Krc, Kac of the chip (N/mm2), Kte, Kre, Kae of the edge (N/mm):"
                .to_owned(),
        );
        let mut rows = vec![heads(&["Ktc", "Krc", "Kac", "Kte", "Kre", "Kae"])];
        rows.extend(found.mechanistic.iter().map(mechanistic_row));
        rows.push(match &found.used.mechanistic {
            Some(used) => used_row(used.sets, &used.coefficients()),
            None => vec!["no forces can be computed from these: no set has all six coefficients".to_owned()],
        });
        lines.extend(indented(&rows));
        let notes = found
            .mechanistic
            .iter()
            .filter_map(|set| Some((&set.tool, set.note.as_ref()?)));
        lines.extend(notes.map(|(tool, note)| format!("  {tool}: {note}")));
    }
    if !found.kienzle.is_empty() {
        lines.push(String::new());
        lines.push("Kienzle values at 0 deg rake: kc1.1 (N/mm2), exponent mc:".to_owned());
        let mut rows = vec![heads(&["kc1.1", "mc"])];
        rows.extend(found.kienzle.iter().map(kienzle_row));
        let used = found.used.kienzle.iter();
        rows.extend(used.map(|used| used_row(used.sets, &used.values())));
        lines.extend(indented(&rows));
    }
    lines.push(String::new());
    lines.push("Sources:".to_owned());
    for source in &found.sources {
        lines.push(format!(
            "  {}: {} ({}); {}",
            source.key, source.what, source.place, source.licence
        ));
    }
    lines.join("\n")
}

/// Symbols over the columns of numbers.
fn heads(symbols: &[&str]) -> Vec<String> {
    let symbols = symbols.iter().map(|symbol| (*symbol).to_owned());
    [String::new()].into_iter().chain(symbols).collect()
}

/// Rows below their headings, text to the left, numbers to the right.
fn indented(rows: &[Vec<String>]) -> Vec<String> {
    let lines = columns(rows, &[Align::Left]);
    lines.iter().map(|line| format!("  {line}")).collect()
}

/// A set of coefficients with its tool and source; a dash for one that the source does not give.
fn mechanistic_row(set: &MechanisticDetails) -> Vec<String> {
    let numbers = set.coefficients();
    let numbers = numbers.map(|value| value.map_or("-".to_owned(), plain));
    let title = format!("{} [{}]", set.tool, set.source);
    [title].into_iter().chain(numbers).collect()
}

/// A pair of Kienzle values with its condition, group and source.
fn kienzle_row(set: &KienzleDetails) -> Vec<String> {
    let group = set.group.map(|group| format!("group {group}"));
    let words: Vec<String> = set.condition.iter().cloned().chain(group).collect();
    let title = format!("{} [{}]", words.join(", "), set.source);
    vec![
        title.trim_start().to_owned(),
        plain(set.kc1_n_per_mm2),
        plain(set.mc_exponent),
    ]
}

/// Values used for forces: means, and the standard deviation between the sets, in four digits.
fn used_row(sets: usize, numbers: &[(f64, Option<f64>)]) -> Vec<String> {
    let title = match sets {
        1 => "used: the only complete set".to_owned(),
        sets => format!("used: mean of {sets} complete sets"),
    };
    let numbers = numbers.iter().map(|(mean, spread)| match spread {
        None => plain(*mean),
        Some(spread) => format!("{} ± {}", plain(digits(*mean, 4)), plain(digits(*spread, 4))),
    });
    [title].into_iter().chain(numbers).collect()
}

/// As many digits as the source has, at most three decimals.
fn plain(value: f64) -> String {
    decimals(value, 3).to_string()
}
