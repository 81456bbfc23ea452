//! Measured points and features of DMIS output (ISO 22093).
//!
//! | statement | use |
//! |---|---|
//! | `UNITS/MM,ANGDEC` | length of the file's unit: `MM`, `CM`, `M`, `INCH`, `FEET` |
//! | `FA(P1)=FEAT/POINT,CART,x,y,z,i,j,k` | a measured point with its normal |
//! | `F(P1)=FEAT/POINT,CART,x,y,z,i,j,k` | its nominal point |
//! | `PTDATA/CART,x,y,z,i,j,k`, `PTMEAS/CART,x,y,z,i,j,k` | a measured point without name |
//! | `FA(C1)=FEAT/CIRCLE,INNER,CART,x,y,z,i,j,k,diameter` | a feature; the same for `CYLNDR`, and `PLANE` without diameter |
//!
//! `$` at the end of a line continues a statement, `$$` begins a remark, other statements are not used. Points are in the part
//! coordinate system that is active there; changes of it are not followed and are noted.
//!
//! Source: ISO 22093, Dimensional Measuring Interface Standard \[recalled: no public file was found to confirm it\].

use std::collections::BTreeMap;

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::units::from_mm;

use super::measured::{
    EMPTY_HINT, MeasuredFeature, MeasuredFeatureKind, Scan, ScanFormat, ScanReadOptions, normal_of, point_of,
    unit_of,
};
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// What to do about a statement that is not read.
const STATEMENT_HINT: &str = "write points as POINT,CART,x,y,z,i,j,k";
/// Words with which a DMIS file begins.
const STARTS: [&[u8]; 6] = [b"DMISMN/", b"DMISMD/", b"UNITS/", b"FA(", b"$$", b"FILNAM/"];

/// Whether a file is DMIS by its ending or by its beginning.
pub(super) fn is_dmis(ending: &str, start: &[u8]) -> bool {
    matches!(ending, "dms" | "dmi" | "dmis" | "dmo") || STARTS.iter().any(|word| start.starts_with(word))
}

/// Reads the points of DMIS output.
///
/// # Errors
/// All problems of the file, at most 200.
pub(super) fn read(shown: &str, bytes: &[u8], given: &ScanReadOptions) -> Result<Scan, Problems> {
    let mut lines = Lines::new(shown, bytes);
    let mut reader = Reader {
        path: shown,
        given,
        factor: None,
        scan: Scan::empty(ScanFormat::Dmis),
        nominal: BTreeMap::new(),
        alignments: 0,
        commanded: 0,
    };
    let mut problems = Vec::new();
    while problems.len() < MOST_PROBLEMS {
        let Some(mut line) = lines.next()? else { break };
        while continues(&line.text)
            && let Some(next) = lines.next()?
        {
            let kept = line.text.trim_end().len() - 1;
            line.text.truncate(kept);
            line.text.push_str(&next.text);
            if line.text.len() > crate::document::lines::LONGEST_LINE {
                break;
            }
        }
        problems.extend(reader.statement(&line).err().into_iter().flatten());
    }
    Problems::from(problems).into_result()?;
    let scan = reader.finished();
    if scan.points.is_empty() && scan.features.is_empty() {
        return Err(Problem::of_file(
            shown,
            "this DMIS file has no measured points and no features",
            EMPTY_HINT,
        )
        .into());
    }
    Ok(scan.finished())
}

/// Whether the next line continues the statement.
fn continues(text: &str) -> bool {
    let text = text.trim_end();
    text.ends_with('$') && !text.ends_with("$$") && !text.trim_start().starts_with("$$")
}

struct Reader<'a> {
    path: &'a str,
    given: &'a ScanReadOptions,
    /// m; `None` before the first length.
    factor: Option<f64>,
    scan: Scan,
    /// Nominal points by their labels.
    nominal: BTreeMap<String, [f64; 6]>,
    alignments: usize,
    commanded: usize,
}

impl Reader<'_> {
    fn factor(&mut self) -> f64 {
        match self.factor {
            Some(factor) => factor,
            None => {
                let factor = unit_of(self.given, &mut self.scan);
                *self.factor.insert(factor)
            }
        }
    }

    fn statement(&mut self, line: &Line) -> Result<(), Problems> {
        let text = line.text.trim();
        if text.starts_with("$$") {
            return Ok(());
        }
        let (label, statement) = match text.split_once('=') {
            Some((label, statement)) => (label.trim(), statement.trim()),
            None => ("", text),
        };
        let Some((major, rest)) = statement.split_once('/') else {
            return Ok(());
        };
        let major = major.trim().to_uppercase();
        let words: Vec<&str> = rest.split(',').map(str::trim).collect();
        match (major.as_str(), label_of(label)) {
            ("UNITS", _) => self.unit(line, &words),
            ("FEAT", Some(label)) => self.feature(line, &label, &words),
            ("PTDATA", _) => {
                let values = self.point(line, &words)?;
                self.add(line, values, String::new())
            }
            ("PTMEAS", _) => {
                self.commanded += 1;
                let values = self.point(line, &words)?;
                self.add(line, values, String::new())
            }
            ("DATSET" | "ROTATE" | "TRANS" | "RECALL", _) => {
                self.alignments += 1;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn unit(&mut self, line: &Line, words: &[&str]) -> Result<(), Problems> {
        let word = words.first().copied().unwrap_or_default().to_uppercase();
        let metres = match word.as_str() {
            "MM" => from_mm(1.0),
            "CM" => from_mm(10.0),
            "M" => 1.0,
            "INCH" => from_mm(25.4),
            "FEET" => from_mm(304.8),
            _ => {
                let message = format!("`{word}` is not a unit of length");
                return Err(self.refused(line, message, "known units are MM, CM, M, INCH and FEET"));
            }
        };
        if let Some(unit) = self.given.unit
            && (unit.factor() - metres).abs() > 1e-9 * metres
        {
            let message = format!("the unit {unit} was specified, but the file is in {word}");
            return Err(self.refused(line, message, "leave out the unit"));
        }
        self.factor = Some(metres);
        Ok(())
    }

    fn refused(&self, line: &Line, message: String, hint: &str) -> Problems {
        line.problem(self.path, 0..line.text.len(), message, hint).into()
    }

    /// Up to `count` numbers after the word `CART`; those that are missing are 0 from the fourth on.
    fn numbers(&self, line: &Line, words: &[&str], least: usize) -> Result<[f64; 7], Problems> {
        let Some(at) = words.iter().position(|word| word.eq_ignore_ascii_case("CART")) else {
            return Err(self.refused(line, "coordinates are not Cartesian".to_owned(), STATEMENT_HINT));
        };
        let mut values = [0.0; 7];
        let given = &words[at + 1..];
        if given.len() < least {
            let message = format!("{} numbers: at least {least} required", given.len());
            return Err(self.refused(line, message, STATEMENT_HINT));
        }
        for (value, word) in values.iter_mut().zip(given) {
            let number = word.parse().ok().filter(|number: &f64| number.is_finite());
            *value = number
                .ok_or_else(|| self.refused(line, format!("`{word}` is not a number"), STATEMENT_HINT))?;
        }
        Ok(values)
    }

    /// Coordinates (m) and normal of a point.
    fn point(&mut self, line: &Line, words: &[&str]) -> Result<[f64; 6], Problems> {
        let factor = self.factor();
        let [x, y, z, i, j, k, _] = self.numbers(line, words, 3)?;
        Ok([x * factor, y * factor, z * factor, i, j, k])
    }

    fn add(&mut self, line: &Line, values: [f64; 6], name: String) -> Result<(), Problems> {
        let [x, y, z, normal @ ..] = values;
        let refused = |message| {
            line.problem(
                self.path,
                0..line.text.len(),
                message,
                "check the unit of the file",
            )
        };
        let point = point_of([x, y, z]).map_err(refused)?;
        let nominal = self.nominal.get(&name).copied();
        let place = nominal
            .map(|[x, y, z, ..]| point_of([x, y, z]))
            .transpose()
            .map_err(refused)?;
        let own = normal_of(normal);
        self.scan.points.push(point);
        self.scan.nominal.push(place);
        self.scan
            .normals
            .push(own.or_else(|| nominal.and_then(|[_, _, _, normal @ ..]| normal_of(normal))));
        self.scan.deviations.push(None);
        self.scan.names.push(name);
        Ok(())
    }

    fn feature(&mut self, line: &Line, label: &Label, words: &[&str]) -> Result<(), Problems> {
        let kind = words.first().copied().unwrap_or_default().to_uppercase();
        let kind = match kind.as_str() {
            "POINT" => {
                let values = self.point(line, words)?;
                if label.is_actual {
                    return self.add(line, values, label.name.clone());
                }
                self.nominal.insert(label.name.clone(), values);
                return Ok(());
            }
            "CIRCLE" => MeasuredFeatureKind::Circle,
            "CYLNDR" => MeasuredFeatureKind::Cylinder,
            "PLANE" => MeasuredFeatureKind::Plane,
            _ => return Ok(()),
        };
        if !label.is_actual {
            return Ok(());
        }
        let factor = self.factor();
        let least = if kind == MeasuredFeatureKind::Plane { 6 } else { 7 };
        let [x, y, z, i, j, k, diameter] = self.numbers(line, words, least)?;
        self.scan.features.push(MeasuredFeature {
            name: label.name.clone(),
            kind,
            at: Some(Point3::new(x, y, z) * factor),
            direction: Vector3::new(i, j, k).try_normalize(0.0),
            diameter: (kind != MeasuredFeatureKind::Plane).then_some(diameter * factor),
            form: None,
        });
        Ok(())
    }

    fn finished(mut self) -> Scan {
        if self.alignments > 1 {
            let note = format!(
                "{} changes of the part coordinate system were not followed",
                self.alignments
            );
            self.scan.notes.push(note);
        }
        if self.commanded > 0 {
            let note = format!(
                "{} points are from PTMEAS: in a measuring program these are commanded points",
                self.commanded
            );
            self.scan.notes.push(note);
        }
        self.scan
    }
}

/// Label of a feature.
struct Label {
    name: String,
    is_actual: bool,
}

/// The name in `F(name)` or `FA(name)`.
fn label_of(text: &str) -> Option<Label> {
    let (kind, rest) = text.split_once('(')?;
    let name = rest.split_once(')')?.0.trim().to_owned();
    let is_actual = match kind.trim().to_uppercase().as_str() {
        "FA" => true,
        "F" => false,
        _ => return None,
    };
    Some(Label { name, is_actual })
}
