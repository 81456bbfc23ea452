//! Pictures and reports of robot machining deviations: plain values in, SVG, PNG or one HTML file out.
//!
//! Each picture is a struct of what to draw with a `to_svg`; it knows nothing of robots beyond that. The same input gives the same bytes,
//! and input that cannot be drawn (no points, nothing reached, a value that is not a number) gives a picture that says so.
//!
//! | question | picture |
//! |---|---|
//! | how large is the deviation over a plane? | [`DeviationMap`] |
//! | where does it keep within the limit, what part fits there? | [`RegionMap`] |
//! | how does that change with distance or tilt? | [`Sheet`] |
//! | which way is the tool pushed along a path? | [`VectorField`] |
//! | how large is it along the path, how round is a circle? | [`PathPlot`], [`PolarPlot`] |
//! | how large is it along a tool path, on top of the part? | [`TrackMap`] |
//! | how deep and how fast may a cut go? | [`ProcessMap`] |
//! | what was measured, and what became of it? | [`ForcePlot`] |
//! | which joint is to blame? | [`ShareBars`] |
//! | in which direction does the arm yield? | [`StiffnessEllipse`] |
//! | how does the arm stand? | [`ArmDrawing`] |

mod grid;
mod map;
mod region;
mod sheet;

mod force_plot;
mod path_plot;
mod polar_plot;
mod process_map;
mod track;
mod vector_field;

mod ellipse;
mod shares;

mod arm;

pub mod html;
#[cfg(feature = "png")]
pub mod raster;

mod chart;
mod colour_bar;
mod contours;
mod field;
mod levels;
mod line_label;
mod surface;

mod advances;
mod axis;
mod colour;
mod error;
mod font;
mod page;
mod plane;
mod svg;

pub use arm::{ArmDrawing, ArmJoint, Posture, View};
pub use colour::ColourScale;
pub use ellipse::StiffnessEllipse;
pub use error::ReportError;
pub use force_plot::{Envelope, ForcePlot, ForceTrace};
pub use grid::{Grid, PointState};
pub use map::{DeviationMap, Marker, MarkerKind, Overlay};
pub use path_plot::{PathPlot, Series};
pub use plane::AxisLabels;
pub use polar_plot::{PolarPlot, RadialSeries};
pub use process_map::ProcessMap;
pub use region::{CircleMm, RectangleMm, RegionMap};
pub use shares::{Arrangement, ShareBar, ShareBars};
pub use sheet::{Panel, Sheet};
pub use track::{Stretch, TrackMap};
pub use vector_field::{Arrow, ArrowCase, Growth, VectorField};
