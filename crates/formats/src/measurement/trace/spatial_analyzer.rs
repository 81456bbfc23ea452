//! Points of a laser tracker as SpatialAnalyzer exports them: text, one point a line.
//!
//! ```text
//! // SpatialAnalyzer SA 2024.2 ( x64 )
//! // Points Relative to Coordinate Frame 'A::WORLD'
//! // AXES = CARTESIAN: X,  Y,  Z (mm)
//! Part,  P1,  0,  2255.522602,  -2602.980201,  -275.082531,  02/12/25 16:52:45
//! ```
//!
//! | cell | meaning |
//! |---|---|
//! | 1, 2 | collection and group; together the name of the run |
//! | 3 | name of the point; points are in the order of the file |
//! | 4 to 6 | Cartesian coordinates in the unit of the header |
//! | 7 | time stamp, in seconds; not read: stamps are given when points are stored, not when they are measured |
//!
//! Source: exports of SpatialAnalyzer 2024.2; other columns of other versions are not known and refused.

use std::io::BufRead;

use armill_core::nalgebra::Vector3;

use super::super::profile::LengthUnit;
use super::runs::{FARTHEST, LIMIT, Traces};
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::{cells, number};

/// Cells of a point: without and with a time stamp.
const CELLS: [usize; 2] = [6, 7];
const HINT: &str = "export points as text with collection, group, point, X, Y, Z";

/// Whether this is the first line of an export.
pub(super) fn is_export(line: &Line) -> bool {
    line.text.trim_start().starts_with("//")
}

/// The points of an export that begins with `line`.
///
/// # Errors
/// All problems of the file, at most 200.
pub(super) fn read(path: &str, line: Line, mut lines: Lines<impl BufRead>) -> Result<Traces, Problems> {
    let mut found = Traces::default();
    let mut problems: Vec<Problem> = Vec::new();
    let (mut factor, mut count) = (None, 0);
    let mut next = Some(line);
    while let Some(line) = next {
        if let Some(comment) = line.text.trim_start().strip_prefix("//") {
            match axes(comment) {
                Some(Ok(unit)) => factor = Some(unit),
                Some(Err(message)) => {
                    let hint = "export Cartesian coordinates in mm, m or in";
                    problems.push(line.problem(path, 0..line.text.len(), message, hint));
                }
                None => {}
            }
        } else if let Some(factor) = factor {
            match point(path, &line, factor) {
                Ok((run, point)) if count < LIMIT.most => {
                    count += 1;
                    found.take(run, point, line.number);
                }
                Ok(_) => {
                    problems.push(LIMIT.exceeded(path, &line));
                    break;
                }
                Err(wrong) => problems.extend(wrong),
            }
        } else if problems.is_empty() {
            let message = "a point before the line with axes and unit";
            let hint = "the header has a line like `// AXES = CARTESIAN: X,  Y,  Z (mm)`";
            return Err(line.problem(path, 0..line.text.len(), message, hint).into());
        }
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        next = match lines.next_row() {
            Ok(next) => next,
            Err(wrong) => {
                problems.extend(wrong);
                break;
            }
        };
    }
    Problems::from(problems).into_result()?;
    match found.runs.is_empty() {
        true => Err(Problem::of_file(path, "the file has no points", HINT).into()),
        false => Ok(found),
    }
}

/// The factor to m of the axes that a comment states; `None` if it states none.
fn axes(comment: &str) -> Option<Result<f64, String>> {
    let (key, stated) = comment.split_once('=')?;
    if !key.trim().eq_ignore_ascii_case("axes") {
        return None;
    }
    let stated = stated.trim();
    if !stated.to_ascii_lowercase().starts_with("cartesian") {
        return Some(Err(format!("axes `{stated}` are not Cartesian")));
    }
    let unit = stated.rsplit_once('(').and_then(|(_, rest)| rest.split_once(')'));
    let name = unit.map_or("", |(unit, _)| unit.trim());
    let known = name.to_ascii_lowercase().parse::<LengthUnit>();
    Some(
        known
            .map(LengthUnit::factor)
            .map_err(|_| format!("`{name}` is not a unit of length")),
    )
}

/// Run and point of a line, m.
fn point(path: &str, line: &Line, factor: f64) -> Result<(String, Vector3<f64>), Problems> {
    let found = cells(&line.text, ',');
    if !CELLS.contains(&found.len()) {
        let message = format!("{} cells, but a point has 6, or 7 with a time stamp", found.len());
        return Err(line.problem(path, 0..line.text.len(), message, HINT).into());
    }
    let (mut point, mut problems) = (Vector3::zeros(), Vec::new());
    for (axis, cell) in found[3..6].iter().enumerate() {
        let text = cell.text.trim();
        let mut refuse = |message: String, hint: &str| {
            problems.push(line.problem(path, cell.span.clone(), message, hint));
        };
        match number(text, ',').filter(|value| value.is_finite()) {
            None => refuse(
                format!("`{text}` is not a number"),
                "remove points that were not measured",
            ),
            Some(value) if (value * factor).abs() > FARTHEST => refuse(
                format!("a length of {} m exceeds {FARTHEST} m", value * factor),
                "check the unit in the header",
            ),
            Some(value) => point[axis] = value * factor,
        }
    }
    Problems::from(problems).into_result()?;
    Ok((
        format!("{} {}", found[0].text.trim(), found[1].text.trim()),
        point,
    ))
}

#[cfg(test)]
mod tests {
    use super::super::read;

    const HEAD: &str = "// SpatialAnalyzer SA 2024.2 ( x64 )  \r\n// Points Relative to Coordinate Frame 'A::WORLD'\r\n// AXES = CARTESIAN: X,  Y,  Z (mm)\r\n";

    #[test]
    fn points_are_read_in_the_unit_of_the_header_and_groups_are_runs() {
        let text = format!(
            "{HEAD}Path,  P1,  0,  1000.5,  -2,  3,  02/12/25 16:52:45\r\nPath,  P1,  1,  1001,  -2,  3\r\n\r\nPath,  P2,  0,  7,  8,  9\r\n"
        );
        let found = read("sa.txt", text.as_bytes()).unwrap();
        let names: Vec<&str> = found.runs.iter().map(|run| run.run.as_str()).collect();
        assert_eq!(names, ["Path P1", "Path P2"]);
        assert_eq!((found.runs[0].points.len(), found.runs[0].lines[1]), (2, 5));
        assert!((found.runs[0].points[0].x - 1.0005).abs() < 1e-15);
        let inches = text.replace("(mm)", "(in)");
        let found = read("sa.txt", inches.as_bytes()).unwrap();
        assert!((found.runs[1].points[0].y - 8.0 * 0.0254).abs() < 1e-15);
    }

    #[test]
    fn problems_have_their_positions() {
        let refused = |text: &str| read("sa.txt", text.as_bytes()).unwrap_err().to_string();
        let both = refused(&format!(
            "{HEAD}a, b, 0, x, 2, 3\na, b, 1, 2\na, b, 2, 1e9, 0, 0\n"
        ));
        for said in [
            "sa.txt:4:",
            "`x` is not a number",
            "sa.txt:5:1",
            "4 cells",
            "exceeds 10000 m",
        ] {
            assert!(both.contains(said), "{said}: {both}");
        }
        assert!(refused("// AXES = POLAR: R (mm)\na, b, 0, 1, 2, 3\n").contains("are not Cartesian"));
        assert!(refused("// AXES = CARTESIAN: X, Y, Z (furlong)\n").contains("`furlong` is not a unit"));
        assert!(refused("// nothing\na, b, 0, 1, 2, 3\n").contains("before the line with axes"));
        assert!(refused(HEAD).contains("no points"));
    }
}
