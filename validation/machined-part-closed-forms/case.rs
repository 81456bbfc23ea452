//! Parts that come out of simple paths with a constant displacement of the tool, against closed forms. See README.md.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `delta` | displacement of the tool | mm |
//! | `n` | normal of the nominal surface, out of the material | - |
//! | `r`, `p` | radius of a ball nose, distance of its passes | mm |

use armill_core::frame::Isometry;
use armill_core::load::EndMillBody;
use armill_core::machined::{
    CutBy, MachiningPath, MadePart, PartComparison, PathTool, SearchReach, Stage, SurfaceDeviation,
    TipDeviation,
};
use armill_core::path::{Course, Move, Pace, PathBuilder, Placing, Sampling, Spin, Step, Track};
use armill_core::removal::{DexelDirections, DexelPart, StockSolid, ToolSolid};
use armill_core::spatial::Twist;
use armill_core::watch::Watch;
use nalgebra::{Matrix3, Point3, Vector3};

use crate::check::{Check, ErrorBound, worst};

const REFERENCE: &str = "closed form";
/// m
const MM: f64 = 1e-3;
/// Side of a cell, mm.
const CELL: f64 = 0.4;
/// Displacement of the tool, mm.
const DELTA: [f64; 3] = [0.04, -0.05, 0.03];
/// Two corners of the stock, mm.
const STOCK: [[f64; 3]; 2] = [[0.0, -20.0, -10.0], [60.0, 20.0, 0.0]];

/// A place, mm; a rapid leads to it, or a cut.
struct To([f64; 3], Pace);

const CUT: Pace = Pace::Feed(0.02);

/// A path and its tool.
struct Machining {
    track: Track,
    tools: [PathTool; 1],
}

/// The tool of this diameter and corner (mm) through these places.
fn machining([diameter, corner]: [f64; 2], places: &[To]) -> Option<Machining> {
    let sampling = Sampling {
        chord_error: 1e-6,
        step: 2.0 * MM,
    };
    let mut builder = PathBuilder::new(sampling, 100_000);
    for (To(place, pace), line) in places.iter().zip(1..) {
        builder.take(Step::Move(Move {
            end: Point3::from(*place) * MM,
            axis: None,
            spin: None,
            course: Course::Line,
            pace: *pace,
            line,
        }));
    }
    let body = EndMillBody::new(diameter * MM, corner * MM).ok()?;
    Some(Machining {
        track: Track {
            path: builder.finish().ok()?,
            placing: Placing {
                base_from_path: Isometry::identity(),
                axis: Vector3::z_axis(),
                keeps_axis: true,
                spin: Spin::Fixed(0.0),
            },
            base_from_part: Isometry::identity(),
            spins: None,
            homes: None,
        },
        tools: [PathTool {
            first: 0,
            cutting: ToolSolid::end_mill(&body, 30.0 * MM).ok()?,
            clear: Vec::new(),
        }],
    })
}

impl Machining {
    fn path(&self) -> MachiningPath<'_> {
        MachiningPath {
            track: &self.track,
            tools: &self.tools,
            turn_tolerance: 1e-7,
        }
    }

    fn displaced(&self) -> Vec<Stage> {
        let deviation = TipDeviation {
            twist: Twist {
                linear: Vector3::from(DELTA) * MM,
                angular: Vector3::zeros(),
            },
            covariance: Matrix3::zeros(),
        };
        self.path().stages(Some(&vec![Some(deviation); self.track.len()]))
    }

    /// The points of its surface, displaced against programmed.
    fn surface(&self) -> Option<Vec<SurfaceDeviation>> {
        let corners = STOCK.map(|corner| Point3::from(corner) * MM);
        let stock = DexelPart::new(&StockSolid::Box(corners), CELL * MM, DexelDirections::All).ok()?;
        let (programmed, displaced) = (self.path().stages(None), self.displaced());
        let cut = |stages| Some(self.path().cut(stock.clone(), stages, Watch::NONE).ok()?.0);
        let (nominal, part) = (cut(&programmed)?, cut(&displaced)?);
        let made = |dexels, stages| MadePart {
            dexels,
            stock: StockSolid::Box(corners),
            cut_by: Some(CutBy {
                stages,
                tools: &self.tools,
                turn_tolerance: 1e-7,
            }),
        };
        let reach = SearchReach {
            most: 5.0 * MM,
            cell: CELL * MM,
        };
        let comparison = PartComparison::new(made(&part, &displaced), made(&nominal, &programmed), reach);
        Some(comparison.surface(Watch::NONE).ok()?.points)
    }

    /// Height of the displaced surface over points of the z dexels, mm, with their place across the passes.
    fn heights(&self) -> Option<Vec<[f64; 2]>> {
        let corners = STOCK.map(|corner| Point3::from(corner) * MM);
        let stock = DexelPart::new(&StockSolid::Box(corners), CELL * MM, DexelDirections::Z).ok()?;
        let (part, _) = self.path().cut(stock, &self.displaced(), Watch::NONE).ok()?;
        let grid = part.grids().last()?;
        let column = grid.cells()[0] / 2;
        let height = |row| {
            let top = grid.material([column, row]).last()?.ends[1];
            Some([grid.at([column, row])[1] / MM, top / MM])
        };
        (0..grid.cells()[1]).map(height).collect()
    }
}

/// The largest difference of a deviation from `delta . n` at points that are kept, mm.
fn along_normals(machining: Option<Machining>, kept: impl Fn(&Vector3<f64>) -> bool) -> f64 {
    let surface = machining
        .and_then(|machining| machining.surface())
        .unwrap_or_default();
    let points = surface.iter().filter(|point| kept(&(point.position.coords / MM)));
    worst(points.map(|point| point.deviation / MM - Vector3::from(DELTA).dot(&point.normal)))
}

/// A slot, a groove, a hole and the scallops of parallel passes.
pub fn checks() -> Vec<Check> {
    let [slot, groove] = [0.0, 5.0].map(|corner| {
        let places = [To([5.0, 0.0, -5.0], Pace::Rapid), To([55.0, 0.0, -5.0], CUT)];
        machining([10.0, corner], &places)
    });
    // Away from ends and edges by more than a cell and the displacement.
    let in_slot = along_normals(slot, |at| {
        (11.0..49.0).contains(&at.x) && (at.y.abs() < 4.5 || (-4.4..-0.6).contains(&at.z))
    });
    let in_groove = along_normals(groove, |at| (11.0..49.0).contains(&at.x) && at.z < -0.6);
    let hole = [To([30.0, 0.0, 5.0], Pace::Rapid), To([30.0, 0.0, -15.0], CUT)];
    let in_hole = along_normals(machining([8.0, 0.0], &hole), |at| (-9.4..-0.6).contains(&at.z));

    // Passes of a ball of 10 mm at y = -10, -8, ... 10 mm: the tip at -3 mm.
    let mut places = Vec::new();
    for pass in -5_i32..=5 {
        let y = 2.0 * f64::from(pass);
        places.extend([
            To([0.0, y, 5.0], Pace::Rapid),
            To([0.0, y, -3.0], CUT),
            To([60.0, y, -3.0], CUT),
        ]);
    }
    let [_, over, up] = DELTA;
    let heights = machining([10.0, 5.0], &places).and_then(|machining| machining.heights());
    let between = heights
        .unwrap_or_default()
        .into_iter()
        .filter(|[y, _]| y.abs() < 9.0);
    let scallops = between.map(|[y, height]| {
        let from_pass = (y - over) - 2.0 * ((y - over) / 2.0).round();
        height - (-3.0 + up + 5.0 - (25.0 - from_pass * from_pass).sqrt())
    });
    // Errors in mm, tolerances in um.
    let row = |what: &str, worst: f64, tolerance: f64| {
        let bound = ErrorBound {
            worst: 1e3 * worst,
            tolerance,
            unit: "um",
        };
        Check::printed(what, REFERENCE, bound, 2)
    };
    vec![
        row(
            "slot of a displaced flat end mill, floor and walls: displacement along the normal",
            in_slot,
            0.1,
        ),
        row(
            "groove of a displaced ball nose: displacement along the normal",
            in_groove,
            2.0,
        ),
        row(
            "hole of a displaced tool: displacement along the normal",
            in_hole,
            2.0,
        ),
        row(
            "scallops of displaced passes of a ball nose, r - sqrt(r^2 - y^2)",
            worst(scallops),
            0.1,
        ),
    ]
}
