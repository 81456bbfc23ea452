//! Pictures and reports of robot machining deviations: plain values in, SVG, PNG or one HTML file out.
//!
//! Each picture is a struct of what to draw with a `to_svg`; it does not depend on robots. The same input gives the
//! same bytes, and input that cannot be drawn (no points, nothing reached, a value that is not a number) gives a
//! picture that says so.
//!
//! | question | picture |
//! |---|---|
//! | how large is the deviation over a plane? | [`DeviationMap`] |
//! | where is it within the tolerance, what part fits there? | [`RegionMap`] |
//! | how does that change with distance or tilt? | [`MapSeries`] |
//! | in which direction does the tool deviate along a path? | [`VectorField`] |
//! | how large is it along the path, how round is a circle, predicted or measured? | [`PathPlot`], [`PolarPlot`] |
//! | what does a ball-bar test show, by direction of travel? | [`BallbarPlot`] |
//! | where on a tool path, seen from above? | [`TrackMap`] |
//! | what becomes of a corner of a path? | [`PathDetail`] |
//! | what is the deviation of each hole? | [`HoleMap`] |
//! | what depth and feed meet the tolerance? | [`ProcessMap`] |
//! | up to which depth is a cut stable? | [`StabilityPlot`] |
//! | how far does a tool move by a harmonic force? | [`FrfPlot`] |
//! | how far does a joint twist under the torque of its motor? | [`TorsionPlot`] |
//! | how may the tool be turned along the path; what is around a place? | [`CellMap`] |
//! | what was measured, and what became of it? | [`ForcePlot`] |
//! | which cell meets the tolerance? | [`Comparison`] |
//! | what are the contributions to an error; do they explain the measurement, wave by wave? | [`BudgetBars`], [`WaveBars`] |
//! | how many poses are met within how much? | [`ErrorDistribution`] |
//! | what does each joint contribute? | [`ShareBars`] |
//! | in which direction is the arm compliant? | [`StiffnessEllipse`] |
//! | how far is the surface of the part from the nominal one? | [`PartView`] |
//! | what is the posture of the arm? | [`ArmDrawing`] |
//! | which bodies does it have, and how near are they to what is in the way? | [`CellView`] |
//!
//! How a picture is made: the values are checked (values that cannot be drawn give a notice), scales and
//! levels are chosen from them, the page is begun with its title block, the drawing is written as SVG from back
//! to front, axes and legend close it. Lengths on the picture are pixels with y downwards; values keep the unit
//! in their name: mm along axes of planes, um for deviations, s, deg and um/N where a name says so. Text is set
//! in the two embedded fonts (DejaVu Sans, regular and bold), whose widths are known here, so that labels keep
//! clear of each other.
//!
//! With the feature `png` the module `raster` turns a picture into pixels. `html` joins pictures, tables and
//! sources into one file. The example `gallery` draws every picture from synthetic values.

mod grid;
mod hole_map;
mod map;
mod map_series;
mod region;

mod ballbar_plot;
mod force_plot;
mod frf_plot;
mod path_detail;
mod path_plot;
mod polar_plot;
mod process_map;
mod stability_plot;
mod torsion_plot;
mod track;
mod vector_field;

mod budget_bars;
mod comparison;
mod ellipse;
mod error_distribution;
mod shares;
mod wave_bars;

mod arm;
mod part_view;
mod shaded;

pub mod html;
#[cfg(feature = "png")]
pub mod raster;

mod cell_map;
mod chart;
mod colour_bar;
mod field;
mod levels;
mod levels_drawing;
mod line;
mod line_label;
mod log_axis;
mod marker;
mod rows;
mod sections;
mod surface;
mod tolerance;

mod arrow;
mod axis;
mod colour;
mod error;
mod font;
mod legend;
mod page;
mod plane;
mod svg;
mod ticks;

pub use arm::{ArmDrawing, ArmJoint, ArmPosture, BodyKind, CellBody, CellView, NearestPair, View};
pub use ballbar_plot::{BallbarPlot, BallbarTrace, RayMark, Sense};
pub use budget_bars::{BudgetBar, BudgetBars, BudgetGroup};
pub use cell_map::{Cell, CellMap};
pub use colour::ColourScale;
pub use comparison::{ComparedCell, Comparison};
pub use ellipse::StiffnessEllipse;
pub use error::ReportError;
pub use error_distribution::{ErrorDistribution, ErrorSet, ModelErrors};
pub use force_plot::{Envelope, ForcePlot, ForceTrace};
pub use frf_plot::{FrfCurve, FrfPlot, FrfStyle};
pub use grid::{Grid, PointState};
pub use hole_map::{HoleMap, HoleMark};
pub use map::{DeviationMap, Overlay};
pub use map_series::{MapSeries, Panel};
pub use marker::{Marker, MarkerKind};
pub use part_view::{PartView, PlaceMark};
pub use path_detail::{NamedLine, PathDetail};
pub use path_plot::{PathPlot, Series};
pub use plane::{AxisLabels, Growth};
pub use polar_plot::{PolarPlot, RadialReference, RadialSeries};
pub use process_map::ProcessMap;
pub use region::{CircleMm, RectangleMm, RegionMap};
pub use shares::{ShareBar, ShareBars};
pub use stability_plot::StabilityPlot;
pub use torsion_plot::{TorsionPanel, TorsionPlot};
pub use track::{Stretch, TrackMap};
pub use vector_field::{Arrow, ArrowCase, VectorField};
pub use wave_bars::{WaveBar, WaveBars};
