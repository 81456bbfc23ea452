//! Axes of the measurement as directions of the feed frame.
//!
//! ```text
//! direction in the feed frame = F direction in the axes of the measurement       F: one entry of 1 or -1 in each row and column, det F = 1
//! ```
//!
//! Two axes determine the third, as both frames are right-handed. Without an assignment X is along the feed, Y to its left, Z from part to spindle.

use armill_core::nalgebra::{Matrix3, Vector3};
use armill_study::StudyError;

const HINT: &str = "two or three axes such as X=x,Y=-z: measured axis = direction of the feed frame (x along the feed, y to its left, z from part to spindle)";

/// Directions of the measured axes X, Y, Z.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes {
    /// `F`.
    pub feed_from_measured: Matrix3<f64>,
    /// In words, such as `X = x, Y = -z, Z = y`.
    pub words: String,
}

impl Axes {
    /// Of assignments such as `X=x`, `Y=-z`.
    ///
    /// # Errors
    /// What is not an assignment; an axis or direction that occurs twice; fewer than two axes; a left-handed assignment.
    pub fn parse(assignments: &[String]) -> Result<Axes, StudyError> {
        let wrong = |message: String| StudyError::value(format!("--axes: {message}"), HINT);
        let mut columns: [Option<Vector3<f64>>; 3] = [None; 3];
        for text in assignments {
            let found = text
                .split_once('=')
                .and_then(|(from, to)| Some((axis(from)?, axis(to)?)));
            let Some(([from, _], [to, sign])) = found.filter(|([_, sign], _)| *sign > 0) else {
                return Err(wrong(format!("`{text}` is not an assignment of an axis")));
            };
            let mut direction = Vector3::zeros();
            direction[index(to)] = f64::from(sign);
            if columns[index(from)].is_some() {
                return Err(wrong(format!("the axis of `{text}` is assigned twice")));
            }
            if columns.iter().flatten().any(|other| other.dot(&direction) != 0.0) {
                return Err(wrong(format!("the direction of `{text}` is assigned twice")));
            }
            columns[index(from)] = Some(direction);
        }
        let [x, y, z] = columns;
        let all = match (x, y, z) {
            (Some(x), Some(y), Some(z)) => [x, y, z],
            (Some(x), Some(y), None) => [x, y, x.cross(&y)],
            (Some(x), None, Some(z)) => [x, z.cross(&x), z],
            (None, Some(y), Some(z)) => [y.cross(&z), y, z],
            _ => return Err(wrong("fewer than two axes are assigned".to_owned())),
        };
        let feed_from_measured = Matrix3::from_columns(&all);
        if feed_from_measured.determinant() < 0.0 {
            return Err(wrong("the three directions are left-handed".to_owned()));
        }
        Ok(Axes {
            words: words(&all),
            feed_from_measured,
        })
    }
}

/// Number (0 to 2) and sign of an axis such as `x`, `-Z`.
fn axis(text: &str) -> Option<[i32; 2]> {
    let text = text.trim();
    let (letter, sign) = match text.strip_prefix('-') {
        Some(letter) => (letter, -1),
        None => (text.strip_prefix('+').unwrap_or(text), 1),
    };
    let number = ["x", "y", "z"]
        .iter()
        .position(|name| letter.eq_ignore_ascii_case(name))?;
    Some([i32::try_from(number).ok()?, sign])
}

fn index(number: i32) -> usize {
    usize::try_from(number).unwrap_or(0)
}

fn words(all: &[Vector3<f64>; 3]) -> String {
    let each = ["X", "Y", "Z"].into_iter().zip(all).map(|(from, to)| {
        let largest = to.iamax();
        let sign = if to[largest] < 0.0 { "-" } else { "" };
        format!("{from} = {sign}{}", ["x", "y", "z"][largest])
    });
    each.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Axes, String> {
        let words: Vec<String> = text.split(',').map(str::to_owned).collect();
        Axes::parse(&words).map_err(|error| error.to_string())
    }

    #[test]
    fn two_axes_determine_the_third_by_the_right_hand() {
        let found = parsed("X=x,Y=-z").unwrap();
        assert_eq!(found.words, "X = x, Y = -z, Z = y");
        let turned = found.feed_from_measured * Vector3::new(1.0, 2.0, 3.0);
        assert_eq!(turned, Vector3::new(1.0, 3.0, -2.0));
        for text in ["X=x,Z=y", "Y=-z,Z=y", "Z=y,x=x,Y=-Z", "X=+x,Y=-z,Z=y"] {
            assert_eq!(parsed(text).unwrap(), found, "{text}");
        }
    }

    #[test]
    fn what_is_no_assignment_of_axes_is_refused() {
        for (text, said) in [
            ("X=x", "fewer than two"),
            ("X=x,X=y", "axis of `X=y` is assigned twice"),
            ("X=x,Y=-x", "direction of `Y=-x` is assigned twice"),
            ("X=x,Y=y,Z=-z", "left-handed"),
            ("X=x,Y", "`Y` is not an assignment"),
            ("X=a,Y=y", "`X=a` is not"),
            ("-X=x,Y=y", "`-X=x` is not"),
            ("", "`` is not"),
        ] {
            let error = parsed(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
