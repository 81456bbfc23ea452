//! Pictures of a search: deviation against margin, and the surroundings of the best placement.

use armill_core::kernel::PartPlacement;
use armill_core::optimize::{Placeable, PlacementObjective, RankBy};
use armill_core::units::{to_deg, to_um};
use armill_core::watch::{Cancelled, Watch};
use armill_report::{AxisLabels, Cell, CellMap, Marker, MarkerKind, PathPlot, Series};
use armill_study::output::Picture;

use super::answer::PlacementAnswer;
use super::freedom::{DEGREES, is_angle};
use super::search::{Searched, Spot};

/// Cells of a section along its longer side.
const CELLS: usize = 61;

/// The best placement for each margin; `None` for fewer than two.
pub(super) fn front(answer: &PlacementAnswer, limit: f64) -> Option<Picture> {
    if answer.by_margin.len() < 2 {
        return None;
    }
    let drawing = PathPlot {
        title: format!("{}: deviation against margin", answer.analysis),
        subtitle: "the best placement with this margin of every joint to its limits, of the elbow to stretched, of the wrist to straight".to_owned(),
        position_label: "margin (deg)".to_owned(),
        quantity: quantity(answer),
        series: vec![Series {
            name: "best placement".to_owned(),
            position: answer.by_margin.iter().map(|at| at.margin_deg).collect(),
            deviation_um: answer.by_margin.iter().map(|at| at.cost_um).collect(),
        }],
        envelope: None,
        tolerance_um: Some(to_um(limit)),
    };
    Some(Picture {
        name: "placement-margin".to_owned(),
        caption: "The best placement for each margin to joint limits and singularities.".to_owned(),
        svg: drawing.to_svg(),
    })
}

impl Searched<'_> {
    /// The surroundings of `best`, over two free degrees at a time: the first two positions and the first two angles.
    pub(super) fn sections(
        &self,
        best: &Spot,
        answer: &PlacementAnswer,
        watch: Watch<'_>,
    ) -> Result<Vec<Picture>, Cancelled> {
        let free: Vec<(usize, [f64; 2])> = self.freedom.free().collect();
        let of_kind = |angles: bool| {
            let all = free.iter().enumerate();
            let mut of = all.filter(move |(_, (degree, _))| is_angle(*degree) == angles);
            Some([of.next()?.0, of.next()?.0])
        };
        let mut pairs: Vec<[usize; 2]> = [of_kind(false), of_kind(true)].into_iter().flatten().collect();
        if pairs.is_empty() && free.len() >= 2 {
            pairs.push([0, 1]);
        }
        pairs
            .into_iter()
            .map(|pair| self.section(best, answer, pair, watch))
            .collect()
    }

    fn section(
        &self,
        best: &Spot,
        answer: &PlacementAnswer,
        pair: [usize; 2],
        watch: Watch<'_>,
    ) -> Result<Picture, Cancelled> {
        let free: Vec<(usize, [f64; 2])> = self.freedom.free().collect();
        let parts: Vec<f64> = (0..CELLS).map(|k| k as f64 / (CELLS - 1) as f64).collect();
        let mut placements: Vec<PartPlacement> = Vec::with_capacity(CELLS * CELLS);
        for across in &parts {
            for up in &parts {
                let mut at = best.at.clone();
                (at[pair[0]], at[pair[1]]) = (*across, *up);
                placements.push(self.freedom.part_placement(&at));
            }
        }
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        // Sections show the cost in micrometres, whatever places are compared by.
        let objective = PlacementObjective {
            rank_by: RankBy::Nominal,
            ..self.some.objective
        };
        let scores = Placeable {
            objective,
            ..self.some
        }
        .scores(&placements, None, quiet)?;
        let cells = scores.iter().map(|score| match score {
            Some(score) if score.unreachable == 0 => Cell::Deviation(to_um(score.cost)),
            _ => Cell::PointsUnreachable,
        });
        let scale = |which: usize| {
            let (degree, [least, greatest]) = free[pair[which]];
            let unit = if is_angle(degree) { to_deg(1.0_f64) } else { 1e3 };
            move |part: f64| (least + (greatest - least) * part) * unit
        };
        let names = pair.map(|which| WORDS[free[which].0]);
        let found = [0, 1].map(|which| scale(which)(best.at[pair[which]]));
        let drawing = CellMap {
            title: format!("{}: around the best placement", answer.analysis),
            subtitle: match (self.some.path.len(), self.all.path.len()) {
                (some, all) if some < all => {
                    format!(
                        "all other values fixed; {some} of {all} points, the best branch at each placement"
                    )
                }
                _ => "all other values fixed; the best branch at each placement".to_owned(),
            },
            quantity: quantity(answer),
            labels: AxisLabels {
                horizontal: names[0].1.to_owned(),
                vertical: names[1].1.to_owned(),
            },
            across: parts.iter().map(|part| scale(0)(*part)).collect(),
            up: parts.iter().map(|part| scale(1)(*part)).collect(),
            cells: cells.collect(),
            marks: vec![Marker {
                at_mm: found,
                label: "best".to_owned(),
                kind: MarkerKind::Best,
                name: String::new(),
            }],
            ..CellMap::default()
        };
        Ok(Picture {
            name: format!("placement-{}-{}", names[0].0, names[1].0),
            caption: format!("Deviation over {} and {}.", names[0].0, names[1].0),
            svg: drawing.to_svg(),
        })
    }
}

/// A degree in a file name, and as an axis.
const WORDS: [(&str, &str); DEGREES] = [
    ("x", "x of the plane's centre (mm)"),
    ("y", "y of the plane's centre (mm)"),
    ("z", "z of the plane's centre (mm)"),
    ("heading", "heading (deg)"),
    ("tilt", "tilt (deg)"),
    ("roll", "rotation about the normal (deg)"),
    ("spin", "spin of the tool (deg)"),
    ("rail", "rail (mm)"),
];

/// The objective.
fn quantity(answer: &PlacementAnswer) -> String {
    let which = match answer.objective {
        "worst" => "largest",
        "mean" => "mean",
        _ => "mean excess of",
    };
    format!("{which} {} deviation (µm)", answer.component)
}
