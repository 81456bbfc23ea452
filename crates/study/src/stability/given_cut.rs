//! A cut given by options, without a study: checked as the table `[cut]` of a study that has these values.

use armill_formats::document::{Document, Problems};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::StudyError;
use crate::analysis::path::cut::{Cut, CutTable, resolve};
use crate::input::problem_log::ProblemLog;

/// The values of a cut; those that are left out are the defaults of a study.
#[derive(Clone, Debug, Default)]
pub struct GivenCut {
    /// Name of a material of the library.
    pub material: String,
    /// `up`, `down`, `centred` or `slot`.
    pub side: String,
    /// Diameter of the cutter.
    pub cutter_diameter_mm: f64,
    /// Number of its teeth.
    pub teeth: u32,
    /// Its helix.
    pub helix_deg: Option<f64>,
    /// Radius of its corner.
    pub corner_radius_mm: Option<f64>,
    /// Axial depth of cut.
    pub depth_mm: f64,
    /// Radial depth of cut.
    pub radial_mm: Option<f64>,
    /// Spindle speed.
    pub spindle_rpm: f64,
    /// Feed.
    pub feed_mm_per_min: f64,
}

/// The only table of these options.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct OptionsFile {
    cut: CutTable,
}

impl GivenCut {
    /// The cut.
    ///
    /// # Errors
    /// All problems of its values, each at its key in `[cut]`.
    pub fn resolve(&self) -> Result<Cut, StudyError> {
        let document = Document::parse("options", &self.as_text())?;
        let file: OptionsFile = document.read()?;
        let mut log = ProblemLog::new(&document, None);
        let cut = resolve(&mut log, &file.cut);
        Problems::from(log.problems).into_result()?;
        cut.ok_or_else(|| StudyError::value("the cut is not valid", "check its options"))
    }

    /// As a table of a study.
    fn as_text(&self) -> String {
        let mut lines = vec![
            "[cut]".to_owned(),
            format!("material = {}", quoted(&self.material)),
            format!("side = {}", quoted(&self.side)),
            format!("axial_depth_mm = {:?}", self.depth_mm),
            format!("spindle_rpm = {:?}", self.spindle_rpm),
            format!("feed_mm_per_min = {:?}", self.feed_mm_per_min),
            format!("cutter.diameter_mm = {:?}", self.cutter_diameter_mm),
            format!("cutter.flutes = {}", self.teeth),
        ];
        let given = [
            ("cutter.helix_deg", self.helix_deg),
            ("cutter.corner_radius_mm", self.corner_radius_mm),
            ("radial_depth_mm", self.radial_mm),
        ];
        let given = given.iter().filter_map(|(key, value)| Some((key, (*value)?)));
        lines.extend(given.map(|(key, value)| format!("{key} = {value:?}")));
        lines.join("\n")
    }
}

/// A text of a TOML document: the escapes of JSON are valid there.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slot() -> GivenCut {
        GivenCut {
            material: "aluminium-7075-t6".to_owned(),
            side: "slot".to_owned(),
            cutter_diameter_mm: 10.0,
            teeth: 2,
            depth_mm: 1.0,
            spindle_rpm: 9000.0,
            feed_mm_per_min: 1800.0,
            ..GivenCut::default()
        }
    }

    #[test]
    fn it_is_the_cut_of_a_study_with_these_values() {
        let cutting = slot().resolve().unwrap().cutting;
        assert_eq!(cutting.cutter.flutes(), 2);
        assert!((cutting.cutter.diameter() - 0.01).abs() < 1e-15 && (cutting.depth - 1e-3).abs() < 1e-15);
        assert!((cutting.feed.unwrap() - 0.03).abs() < 1e-15);
        assert!((cutting.spindle.unwrap() - 300.0 * std::f64::consts::PI).abs() < 1e-9);
    }

    #[test]
    fn all_problems_are_reported_together() {
        let wrong = GivenCut {
            cutter_diameter_mm: -3.0,
            teeth: 0,
            side: "above\"".to_owned(),
            ..slot()
        };
        let text = wrong.resolve().err().unwrap().to_string();
        for key in ["diameter_mm", "flutes", "side"] {
            assert!(text.contains(key), "{key}: {text}");
        }
        let unknown = GivenCut {
            material: "cheese".to_owned(),
            side: "up".to_owned(),
            ..slot()
        };
        let text = unknown.resolve().err().unwrap().to_string();
        assert!(
            text.contains("cheese") && text.contains("radial_depth_mm"),
            "{text}"
        );
    }
}
