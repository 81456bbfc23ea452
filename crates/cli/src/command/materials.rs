//! `armill materials`: the material library, one line a material, or one with every set and what is used of them.

use armill_core::load::Together;
use armill_formats::material::{KienzleSet, Material, MechanisticSet};
use armill_study::{StudyError, library};
use serde_json::{Map, Value, json};

use crate::Outcome;
use crate::arguments::MaterialsArguments;
use crate::terminal::print;

pub(crate) fn run(arguments: &MaterialsArguments) -> Result<Outcome, StudyError> {
    let told = match (&arguments.name, arguments.json) {
        (None, as_json) => {
            let found = library::MATERIALS
                .iter()
                .map(|entry| Ok((entry.name, library::find_material(entry.name)?)));
            let found: Vec<(&str, Material)> = found.collect::<Result<_, StudyError>>()?;
            if as_json {
                Value::from_iter(found.iter().map(|(name, found)| row_as_json(name, found))).to_string()
            } else {
                table(&found)
            }
        }
        (Some(name), true) => as_json(name, &library::find_material(name)?).to_string(),
        (Some(name), false) => as_text(name, &library::find_material(name)?),
    };
    print(&told)?;
    Ok(Outcome::Fine)
}

fn table(found: &[(&str, Material)]) -> String {
    let width = |text: fn(&(&str, Material)) -> usize| found.iter().map(text).max().unwrap_or(0);
    let (name_width, title_width) = (
        width(|(name, _)| name.len()),
        width(|(_, found)| found.name.chars().count()),
    );
    let line = |(name, found): &(&str, Material)| {
        let mut laws = laws(found).map(|(law, sets)| match sets {
            0 => String::new(),
            1 => format!("{law} (1 set)"),
            sets => format!("{law} ({sets} sets)"),
        });
        if laws[0].is_empty() && !found.mechanistic.is_empty() {
            laws[0] = "mechanistic (no whole set)".to_owned();
        }
        let line = format!(
            "{name:name_width$}  {:title_width$}  {:<26}  {}",
            found.name, laws[0], laws[1]
        );
        line.trim_end().to_owned()
    };
    found.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Each law with the number of sets that forces are computed from.
fn laws(found: &Material) -> [(&'static str, usize); 2] {
    [
        ("mechanistic", found.mechanistic().map_or(0, |told| told.sets)),
        ("kienzle", found.kienzle().map_or(0, |told| told.sets)),
    ]
}

fn row_as_json(name: &str, found: &Material) -> Value {
    let [mechanistic, kienzle] = laws(found);
    json!({
        "name": name,
        "title": found.name,
        "mechanistic_sets": mechanistic.1,
        "kienzle_sets": kienzle.1,
    })
}

/// One set, or what is used of all: its title, and its numbers as they are read.
type Row = (String, Vec<String>);

/// Symbol, key in the material file, and size of its unit in SI.
type Coefficient = (&'static str, &'static str, f64);

/// Coefficients of the mechanistic law.
const MECHANISTIC: [Coefficient; 6] = [
    ("Ktc", "ktc_n_per_mm2", 1e6),
    ("Krc", "krc_n_per_mm2", 1e6),
    ("Kac", "kac_n_per_mm2", 1e6),
    ("Kte", "kte_n_per_mm", 1e3),
    ("Kre", "kre_n_per_mm", 1e3),
    ("Kae", "kae_n_per_mm", 1e3),
];
/// The same of Kienzle's law.
const KIENZLE: [Coefficient; 2] = [("kc1.1", "kc1_n_per_mm2", 1e6), ("mc", "mc_exponent", 1.0)];

fn as_text(name: &str, found: &Material) -> String {
    let mut lines = vec![format!("{} ({name})", found.name)];
    lines.extend(found.note.iter().cloned());
    if !found.mechanistic.is_empty() {
        lines.push(String::new());
        lines.push(
            "Mechanistic coefficients: Ktc, Krc, Kac of the chip (N/mm2), Kte, Kre, Kae of the edge (N/mm):"
                .to_owned(),
        );
        let mut rows: Vec<Row> = found.mechanistic.iter().map(mechanistic_row).collect();
        rows.push(match found.mechanistic() {
            Some(together) => used_row(&together, &MECHANISTIC),
            None => (
                "no force is computed from these: no set has all six".to_owned(),
                Vec::new(),
            ),
        });
        lines.extend(aligned(&MECHANISTIC.map(|(symbol, ..)| symbol), &rows));
        let notes = found
            .mechanistic
            .iter()
            .filter_map(|set| Some((&set.tool, set.note.as_ref()?)));
        lines.extend(notes.map(|(tool, note)| format!("  {tool}: {note}")));
    }
    if !found.kienzle.is_empty() {
        lines.push(String::new());
        lines.push("Kienzle values at 0 deg rake: kc1.1 (N/mm2), exponent mc:".to_owned());
        let mut rows: Vec<Row> = found.kienzle.iter().map(kienzle_row).collect();
        let together = found.kienzle();
        rows.extend(together.map(|together| used_row(&together, &KIENZLE)));
        lines.extend(aligned(&KIENZLE.map(|(symbol, ..)| symbol), &rows));
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

fn mechanistic_row(set: &MechanisticSet) -> Row {
    let numbers = set.coefficients.iter().zip(MECHANISTIC);
    let numbers =
        numbers.map(|(value, (_, _, per))| value.map_or("-".to_owned(), |value| plain(value / per)));
    (format!("{} [{}]", set.tool, set.source), numbers.collect())
}

fn kienzle_row(set: &KienzleSet) -> Row {
    let group = set.group.map(|group| format!("group {group}"));
    let words: Vec<String> = set.condition.iter().cloned().chain(group).collect();
    let title = format!("{} [{}]", words.join(", "), set.source);
    let numbers = [set.specific_force, set.exponent]
        .into_iter()
        .zip(KIENZLE)
        .map(|(value, (_, _, per))| plain(value / per));
    (title.trim_start().to_owned(), numbers.collect())
}

fn four_digits(value: f64) -> String {
    let unit = 10_f64.powf(value.abs().log10().floor() - 3.0);
    plain(if unit > 0.0 {
        (value / unit).round() * unit
    } else {
        value
    })
}

/// What stands for all sets, in the units of the file: mean, and standard deviation of one set among the others.
fn used<const N: usize>(together: &Together<N>, law: &[Coefficient; N]) -> [(f64, Option<f64>); N] {
    std::array::from_fn(|i| {
        let per = law[i].2;
        let u = together
            .covariance
            .map(|covariance| covariance[(i, i)].sqrt() / per);
        (together.mean[i] / per, u)
    })
}

fn used_row<const N: usize>(together: &Together<N>, law: &[Coefficient; N]) -> Row {
    let title = match together.sets {
        1 => "used: the one whole set".to_owned(),
        sets => format!("used: mean of {sets} whole sets"),
    };
    let numbers = used(together, law).map(|(mean, u)| match u {
        None => plain(mean),
        Some(u) => format!("{} ± {}", four_digits(mean), four_digits(u)),
    });
    (title, numbers.to_vec())
}

/// Rows below their heads: words to the left, numbers to the right.
fn aligned(heads: &[&str], rows: &[Row]) -> Vec<String> {
    let wide = |text: &str| text.chars().count();
    let with_numbers = rows.iter().filter(|(_, numbers)| !numbers.is_empty());
    let title_width = with_numbers.map(|(title, _)| wide(title)).max().unwrap_or(0);
    let widths: Vec<usize> = heads
        .iter()
        .enumerate()
        .map(|(k, head)| {
            let cells = rows.iter().filter_map(|(_, numbers)| numbers.get(k));
            cells.map(|cell| wide(cell)).max().unwrap_or(0).max(wide(head))
        })
        .collect();
    let line = |title: &str, cells: &[&str]| {
        let cells = cells.iter().zip(&widths);
        let cells: String = cells.map(|(cell, width)| format!("  {cell:>width$}")).collect();
        format!("  {title:title_width$}{cells}").trim_end().to_owned()
    };
    let told = rows.iter().map(|(title, numbers)| {
        let numbers: Vec<&str> = numbers.iter().map(String::as_str).collect();
        line(title, &numbers)
    });
    [line("", heads)].into_iter().chain(told).collect()
}

/// As many digits as the source has, at most three behind the point.
fn plain(value: f64) -> String {
    let rounded = (value * 1e3).round() / 1e3;
    format!("{rounded}")
}

fn as_json(name: &str, found: &Material) -> Value {
    let of_set = |keys: &[(&str, &str, f64)], values: &[Option<f64>]| -> Map<String, Value> {
        let keyed = keys.iter().zip(values);
        keyed
            .filter_map(|((_, key, per), value)| Some(((*key).to_owned(), json!(tidy((*value)? / per)))))
            .collect()
    };
    let mechanistic = found.mechanistic.iter().map(|set| {
        let mut row = of_set(&MECHANISTIC, &set.coefficients);
        row.insert("tool".to_owned(), json!(set.tool));
        row.insert("source".to_owned(), json!(set.source));
        row.insert("note".to_owned(), json!(set.note));
        Value::from(row)
    });
    let kienzle = found.kienzle.iter().map(|set| {
        let mut row = of_set(&KIENZLE, &[Some(set.specific_force), Some(set.exponent)]);
        row.insert("group".to_owned(), json!(set.group));
        row.insert("condition".to_owned(), json!(set.condition));
        row.insert("source".to_owned(), json!(set.source));
        Value::from(row)
    });
    json!({
        "name": name,
        "title": found.name,
        "note": found.note,
        "mechanistic": mechanistic.collect::<Vec<_>>(),
        "kienzle": kienzle.collect::<Vec<_>>(),
        "used": {
            "mechanistic": found.mechanistic().map(|together| used_as_json(&together, &MECHANISTIC)),
            "kienzle": found.kienzle().map(|together| used_as_json(&together, &KIENZLE)),
        },
        "sources": found.sources,
    })
}

/// `KEY` the mean, `spread_KEY` the standard deviation of one set among the others; none of a single set.
fn used_as_json<const N: usize>(together: &Together<N>, law: &[Coefficient; N]) -> Value {
    let mut told = Map::new();
    told.insert("sets".to_owned(), json!(together.sets));
    for ((_, key, _), (mean, u)) in law.iter().zip(used(together, law)) {
        told.insert((*key).to_owned(), json!(tidy(mean)));
        told.insert(format!("spread_{key}"), json!(u.map(tidy)));
    }
    Value::from(told)
}

/// Without what the change of units leaves behind the ninth decimal.
fn tidy(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}
