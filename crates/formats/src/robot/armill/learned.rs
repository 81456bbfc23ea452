//! A robot file with values of `[motion]` that were learnt from joint logs.
//!
//! Keys of the table that were not learnt stay as they are.

use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

use super::identified::set_sources;
use crate::document::{Document, Problems};
use crate::motion::MotionTable;

/// Key of the source.
const KEY: &str = "motion_log";

/// What was learnt of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct LearnedMotion {
    /// Learnt values; keys without one are not changed.
    pub table: MotionTable,
    /// How they were learnt, with their uncertainties, for people.
    pub what: String,
    /// Where the logs are kept.
    pub place: String,
}

/// The robot file `text` (at `path`) with these values in its table `motion`.
///
/// # Errors
/// A text that is not TOML, or no robot file with these values.
pub fn with_motion(path: &str, text: &str, learned: &LearnedMotion) -> Result<String, Problems> {
    let checked = Document::parse(path, text)?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    let given = &learned.table;
    let lists = [
        (
            "joint_acceleration_reached_deg_per_s2",
            &given.joint_acceleration_reached_deg_per_s2,
        ),
        ("lag_ms", &given.lag_ms),
        ("lag_u_ms", &given.lag_u_ms),
        ("motor_lead_s2", &given.motor_lead_s2),
    ];
    let numbers = [
        ("path_acceleration_mm_per_s2", given.path_acceleration_mm_per_s2),
        ("smoothing_ms", given.smoothing_ms),
        ("settling_ms", given.settling_ms),
    ];
    let motion = document
        .entry("motion")
        .or_insert_with(|| Item::Table(Table::new()))
        .as_table_like_mut();
    if let Some(motion) = motion {
        for (key, list) in lists {
            if let Some(list) = list {
                let list: Array = list.iter().map(|number| Value::from(*number)).collect();
                motion.insert(key, value(list));
            }
        }
        for (key, number) in numbers {
            if let Some(number) = number {
                motion.insert(key, value(number));
            }
        }
        motion.insert("source", value(KEY));
    }
    set_sources(&mut document, KEY, [&learned.what, &learned.place])?;
    let text = document.to_string();
    super::read(&format!("{path} (with motion)"), "", &text)?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = "format = 1\nname = \"Arm\"\n[chain]\nsource = \"own\"\nmotions = [{ about = \"z\", joint = \"A1\" }, { along = \"x\", length_mm = 500 }]\n\
        [[joint]]\nname = \"A1\"\nsign = 1\nsource = \"own\"\n[motion]\nshortest_blending_ms = 4\nsmoothing_ms = 10\n[sources.own]\nwhat = \"a\"\nwhere = \"b\"\nlicence = \"c\"\n";

    fn learned(lag_ms: Vec<f64>) -> LearnedMotion {
        LearnedMotion {
            table: MotionTable {
                smoothing_ms: Some(41.5),
                lag_ms: Some(lag_ms),
                ..MotionTable::default()
            },
            what: "learnt".to_owned(),
            place: "log.csv".to_owned(),
        }
    }

    #[test]
    fn learnt_values_replace_their_keys_and_others_stay() {
        let text = with_motion("arm.toml", ARM, &learned(vec![12.5])).unwrap_or_else(|p| panic!("{p}"));
        let read = super::super::read("arm.toml", "arm", &text).unwrap_or_else(|p| panic!("{p}"));
        let motion = read.motion.unwrap_or_default();
        assert_eq!(motion.smoothing_ms, Some(41.5));
        assert_eq!(motion.lag_ms.as_deref(), Some(&[12.5][..]));
        assert_eq!(motion.shortest_blending_ms, Some(4.0));
        assert_eq!(motion.source.as_deref(), Some(KEY));
        let again = with_motion("arm.toml", &text, &learned(vec![9.0])).unwrap_or_else(|p| panic!("{p}"));
        assert!(again.matches("[sources.motion_log]").count() == 1, "{again}");
    }

    #[test]
    fn values_that_no_robot_file_may_have_are_refused() {
        let refused = with_motion("arm.toml", ARM, &learned(vec![-1.0]))
            .unwrap_err()
            .to_string();
        assert!(refused.contains("lag_ms"), "{refused}");
    }
}
