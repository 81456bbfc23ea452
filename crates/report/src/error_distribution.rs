//! How many of the poses are met within how much? One step line a model, for each set of poses.
//!
//! ```text
//!  share of   │        ┌──────────   after: half of them within 0.2 mm
//!  poses (%)  │      ┌─┘     ┌────   before (dashed)
//!             │    ┌─┘   ┌───┘
//!             └──────────────────
//!               distance (mm)
//! ```
//!
//! A set has one colour; its last model is solid, those before it are dashed. The mean of each line is in the legend.

use crate::chart::Chart;
use crate::colour::category;
use crate::legend::Entry;
use crate::page::{BORDER_PX, Heading};
use crate::plane::AxisLabels;
use crate::svg::{Point, Style};

/// Width and height of the chart.
const AREA_PX: [f64; 2] = [540.0, 300.0];

/// Poses of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSet {
    /// Name for the legend.
    pub name: String,
    /// Models, the best last.
    pub models: Vec<ModelErrors>,
}

/// Errors of the poses of a set by one model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelErrors {
    /// Name for the legend, such as `before`.
    pub name: String,
    /// Distance of each pose; a value that is not finite is left out.
    pub errors_mm: Vec<f64>,
}

/// The input of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorDistribution {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Label of the horizontal axis with unit.
    pub quantity: String,
    /// The sets.
    pub sets: Vec<ErrorSet>,
}

/// Dashes of the models before the last.
const DASHES: [&str; 2] = ["5 4", "1.5 3"];

/// One step line.
struct Steps {
    /// Rising.
    sizes: Vec<f64>,
    style: Style,
    label: String,
}

impl ErrorDistribution {
    /// The picture as a complete SVG document; no poses gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let all = self.steps();
        let most = all
            .iter()
            .filter_map(|steps| steps.sizes.last())
            .fold(0.0, |most: f64, size| most.max(*size));
        if most <= 0.0 {
            return heading.notice("There is nothing to draw: no pose has an error.");
        }
        let chart = Chart::with_axis_room(AREA_PX, [0.0, 1.03 * most], [0.0, 100.0]);
        let mut page = heading.page(chart.area.right() + BORDER_PX + 8.0);
        let chart = chart.lowered_to(page.top_px + 4.0);
        let labels = AxisLabels {
            horizontal: self.quantity.clone(),
            vertical: "poses within it (%)".to_owned(),
        };
        chart.draw_axes(&mut page.svg, &labels);
        page.svg.clipped(chart.area, |svg| {
            for steps in &all {
                svg.polyline(&corners(&steps.sizes, &chart), &steps.style);
            }
        });
        let entries: Vec<Entry> = all
            .iter()
            .map(|steps| Entry::line(steps.style.clone(), steps.label.clone()))
            .collect();
        page.finish_with_legend(&entries, [chart.area.x, chart.area.bottom() + 50.0])
    }

    fn steps(&self) -> Vec<Steps> {
        let of = |(k, set): (usize, &ErrorSet)| {
            let colour = category(k);
            let line = |what: &str, values: &[f64], style: Style| {
                let mut sizes: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
                sizes.sort_by(f64::total_cmp);
                let mean = sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
                Steps {
                    label: format!("{}, {what}: mean {mean:.3} mm", set.name),
                    sizes,
                    style,
                }
            };
            let last = set.models.len().saturating_sub(1);
            let style = |place: usize| match DASHES.get(place) {
                _ if place == last => Style::line(colour, 2.2),
                Some(dashes) => Style::line(colour, 1.6).dashed(dashes).opacity(0.8),
                None => Style::line(colour, 1.2),
            };
            let models = set.models.iter().enumerate();
            models
                .map(|(place, model)| line(&model.name, &model.errors_mm, style(place)))
                .collect::<Vec<_>>()
        };
        let all = self.sets.iter().enumerate().flat_map(of);
        all.filter(|steps| !steps.sizes.is_empty()).collect()
    }
}

/// From zero up at every size, and on to the right edge.
fn corners(sizes: &[f64], chart: &Chart) -> Vec<Point> {
    let percent = |count: usize| 100.0 * count as f64 / sizes.len() as f64;
    let mut corners = vec![chart.at([0.0, 0.0])];
    for (k, size) in sizes.iter().enumerate() {
        corners.push(chart.at([*size, percent(k)]));
        corners.push(chart.at([*size, percent(k + 1)]));
    }
    corners.push(chart.at([chart.high[0], 100.0]));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_has_two_lines_that_end_at_all_poses() {
        let picture = ErrorDistribution {
            sets: vec![ErrorSet {
                name: "validation".to_owned(),
                models: vec![
                    ModelErrors {
                        name: "before".to_owned(),
                        errors_mm: vec![0.5, f64::NAN, 1.0],
                    },
                    ModelErrors {
                        name: "after".to_owned(),
                        errors_mm: vec![0.1, 0.2, 0.3],
                    },
                ],
            }],
            ..ErrorDistribution::default()
        };
        let svg = picture.to_svg();
        // A line and its key each.
        assert_eq!(svg.matches("stroke-dasharray=\"5 4\"").count(), 2, "before");
        assert_eq!(svg.matches("stroke-width=\"2.2\"").count(), 2, "after");
        assert!(svg.contains("validation, before: mean 0.750 mm") && svg.contains("after: mean 0.200 mm"));
        assert!(!svg.contains("NaN"));
        assert!(
            ErrorDistribution::default()
                .to_svg()
                .contains("no pose has an error")
        );
    }

    #[test]
    fn half_of_the_poses_are_at_fifty_percent() {
        let chart = Chart::with_axis_room(AREA_PX, [0.0, 4.0], [0.0, 100.0]);
        let line = corners(&[1.0, 3.0], &chart);
        assert_eq!(line[2], chart.at([1.0, 50.0]));
        assert_eq!(line.last().copied(), Some(chart.at([4.0, 100.0])));
    }
}
