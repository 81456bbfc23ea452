//! Prediction and measurement by undulations per revolution: two bars for each, and the phase between them.
//!
//! ```text
//!  amplitude (µm) │ ▌▒
//!                 │ ▌▒   ▌▒  ▒
//!                 └──2────3──4──   waves a turn
//!                   5°  -80°       phase of the second beyond the first
//! ```
//!
//! Where either amplitude is less than a twentieth of the largest, or no phase is given, it is left out.

use crate::colour::{GRID, INK, MUTED, category};
use crate::font::{BODY_PX, SMALL_PX};
use crate::legend::{Entry, Key};
use crate::page::{BORDER_PX, Heading};
use crate::svg::{Rect, Style, Text};
use crate::ticks::Ticks;

/// Room left of the axis, height of the chart, width of a wave, of all and of a bar.
const LEFT_PX: f64 = 66.0;
const AREA_HEIGHT_PX: f64 = 220.0;
const WAVE_PX: f64 = 48.0;
const LEAST_WIDTH_PX: f64 = 420.0;
const BAR_PX: f64 = 15.0;
/// Waves of less than this part of the largest have no meaningful phase.
const LITTLE: f64 = 0.05;

/// One wave of both.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveBar {
    /// Waves a turn.
    pub waves: usize,
    /// Amplitude of the first.
    pub measured_um: f64,
    /// Of the second.
    pub predicted_um: f64,
    /// Phase of the second beyond the first, where both are there.
    pub phase_difference_deg: Option<f64>,
}

/// The input of a picture of waves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaveBars {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// Names of both curves: `part`, `predicted`.
    pub names: [String; 2],
    /// The waves from left to right.
    pub waves: Vec<WaveBar>,
}

impl WaveBars {
    /// The picture as a complete SVG document; no waves gives a picture that says so.
    pub fn to_svg(&self) -> String {
        let heading = Heading::new(&self.title, &self.subtitle);
        let sizes = self
            .waves
            .iter()
            .flat_map(|wave| [wave.measured_um, wave.predicted_um]);
        let most = sizes.filter(|um| um.is_finite()).fold(0.0, f64::max);
        if most <= 0.0 {
            return heading.notice("There is nothing to draw: there are no waves.");
        }
        let width = (WAVE_PX * self.waves.len() as f64).max(LEAST_WIDTH_PX);
        let mut page = heading.page(LEFT_PX + width + BORDER_PX);
        let area = Rect {
            x: LEFT_PX,
            y: page.top_px + 8.0,
            w: width,
            h: AREA_HEIGHT_PX,
        };
        let y = |um: f64| area.bottom() - um / (1.06 * most) * area.h;
        let ticks = Ticks::about(5.0, [0.0, 1.06 * most]);
        for um in &ticks.at {
            page.svg
                .line([area.x, y(*um)], [area.right(), y(*um)], &Style::line(GRID, 1.0));
            let at = [area.x - 7.0, y(*um) + 4.0];
            page.svg.text(at, &ticks.label(*um), &Text::new(SMALL_PX).end());
        }
        let middle = [BORDER_PX + BODY_PX, area.centre()[1]];
        page.svg.text(
            middle,
            "amplitude (µm)",
            &Text::new(BODY_PX).middle().turned(-90.0),
        );
        for (k, wave) in self.waves.iter().enumerate() {
            let centre = area.x + width * (k as f64 + 0.5) / self.waves.len() as f64;
            let both = [(wave.measured_um, -BAR_PX), (wave.predicted_um, 0.0)];
            for (index, (um, from)) in both.into_iter().enumerate().filter(|(_, (um, _))| um.is_finite()) {
                let bar = Rect {
                    x: centre + from,
                    y: y(um.max(0.0)),
                    w: BAR_PX,
                    h: area.bottom() - y(um.max(0.0)),
                };
                page.svg.rect(bar, &Style::fill(COLOURS[index]()));
            }
            let under = |line: f64| [centre, area.bottom() + line];
            page.svg.text(
                under(16.0),
                &wave.waves.to_string(),
                &Text::new(SMALL_PX).middle(),
            );
            let least = LITTLE * most;
            let given = wave
                .phase_difference_deg
                .filter(|deg| deg.is_finite() && wave.measured_um > least && wave.predicted_um > least);
            if let Some(deg) = given {
                let phase = format!("{deg:+.0}°");
                let text = Text::new(SMALL_PX).middle().colour(MUTED);
                page.svg.text(under(31.0), &phase, &text);
            }
        }
        let ends = [[area.x, area.bottom()], [area.right(), area.bottom()]];
        page.svg.line(ends[0], ends[1], &Style::line(INK, 1.2));
        let named = "undulations per revolution; below: phase of the prediction relative to the part";
        page.svg.text(
            [area.x, area.bottom() + 50.0],
            named,
            &Text::new(SMALL_PX).colour(MUTED),
        );
        let entry = |index: usize| {
            Entry::new(
                Key::Field(Style::fill(COLOURS[index]())),
                self.names[index].clone(),
            )
        };
        page.finish_with_legend(&[entry(0), entry(1)], [area.x, area.bottom() + 62.0])
    }
}

/// Of the first bar and of the second.
const COLOURS: [fn() -> &'static str; 2] = [|| category(2), || category(0)];

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(waves: usize, [measured_um, predicted_um]: [f64; 2]) -> WaveBar {
        WaveBar {
            waves,
            measured_um,
            predicted_um,
            phase_difference_deg: Some(-12.4),
        }
    }

    #[test]
    fn strong_waves_show_their_phase_and_weak_ones_do_not() {
        let mut bars = WaveBars {
            names: ["part".to_owned(), "predicted".to_owned()],
            waves: vec![wave(2, [40.0, 38.0]), wave(3, [1.0, 20.0])],
            ..WaveBars::default()
        };
        assert_eq!(bars.to_svg().matches("-12°").count(), 1);
        bars.waves[0].phase_difference_deg = None;
        assert!(!bars.to_svg().contains("-12°"));
        bars.waves[1].measured_um = f64::NAN;
        assert!(!bars.to_svg().contains("NaN"));
        bars.waves.clear();
        assert!(bars.to_svg().contains("There is nothing to draw"));
    }
}
