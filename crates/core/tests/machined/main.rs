//! The part as it comes out, by the public interface: parts whose surface is known in closed form.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod displaced;
mod nominal_mesh;
mod rapids;

use armill_core::frame::Isometry;
use armill_core::load::EndMillBody;
use armill_core::machined::{
    CutBy, MachiningPath, MadePart, PartComparison, PathTool, SearchReach, SurfaceComparison, TipDeviation,
};
use armill_core::nalgebra::{Matrix3, Point3, Vector3};
use armill_core::path::{Course, Move, Pace, PathBuilder, Placing, SampledPath, Sampling, Spin, Step, Track};
use armill_core::removal::{DexelDirections, DexelPart, StockSolid, ToolSolid};
use armill_core::spatial::Twist;
use armill_core::watch::Watch;

/// A millimetre in m.
pub const MM: f64 = 1e-3;
/// Size of a cell, m.
pub const CELL: f64 = 0.5 * MM;

/// A point given in mm.
pub fn at(x: f64, y: f64, z: f64) -> Point3<f64> {
    Point3::new(x, y, z) * MM
}

/// A track with a rapid to the first of these places (mm) and cuts to the others, in steps of 1 mm.
pub fn track(base_from_path: Isometry, places: &[[f64; 3]]) -> Track {
    let mut builder = PathBuilder::new(
        Sampling {
            chord_error: 1e-6,
            step: MM,
        },
        10_000,
    );
    for (number, place) in places.iter().enumerate() {
        builder.take(Step::Move(Move {
            end: at(place[0], place[1], place[2]),
            axis: None,
            spin: None,
            course: Course::Line,
            pace: if number == 0 {
                Pace::Rapid
            } else {
                Pace::Feed(0.02)
            },
            line: number as u32 + 1,
        }));
    }
    let path: SampledPath = builder.finish().unwrap();
    Track {
        path,
        placing: Placing {
            base_from_path,
            axis: Vector3::z_axis(),
            keeps_axis: true,
            spin: Spin::Fixed(0.0),
        },
        base_from_part: base_from_path,
        spins: None,
        homes: None,
    }
}

/// An end mill from the first point on, mm.
pub fn end_mill(diameter: f64, corner: f64) -> PathTool {
    let body = EndMillBody::new(diameter * MM, corner * MM).unwrap();
    PathTool {
        first: 0,
        cutting: ToolSolid::end_mill(&body, 30.0 * MM).unwrap(),
        clear: Vec::new(),
    }
}

/// A block between two corners, mm.
pub fn block(low: [f64; 3], high: [f64; 3]) -> DexelPart {
    let [low, high] = [low, high].map(|[x, y, z]| at(x, y, z));
    DexelPart::new(&StockSolid::Box([low, high]), CELL, DexelDirections::All).unwrap()
}

/// The same deviation at every point: displacement in mm and rotation in rad, base.
pub fn everywhere(track: &Track, linear: [f64; 3], angular: [f64; 3]) -> Vec<Option<TipDeviation>> {
    let twist = Twist {
        linear: Vector3::from(linear) * MM,
        angular: Vector3::from(angular),
    };
    vec![
        Some(TipDeviation {
            twist,
            covariance: Matrix3::zeros(),
        });
        track.len()
    ]
}

/// The surface that comes out of a block with these deviations, compared with the one as programmed.
pub fn surface(
    track: &Track,
    tool: PathTool,
    stock: &DexelPart,
    deviations: &[Option<TipDeviation>],
) -> SurfaceComparison {
    let tools = [tool];
    let path = MachiningPath {
        track,
        tools: &tools,
        turn_tolerance: 1e-7,
    };
    let (programmed, displaced) = (path.stages(None), path.stages(Some(deviations)));
    let (nominal, _) = path.cut(stock.clone(), &programmed, Watch::NONE).unwrap();
    let (part, _) = path.cut(stock.clone(), &displaced, Watch::NONE).unwrap();
    let made = |dexels, stages| MadePart {
        dexels,
        stock: StockSolid::Box(stock.corners()),
        cut_by: Some(CutBy {
            stages,
            tools: &tools,
            turn_tolerance: 1e-7,
        }),
    };
    let reach = SearchReach {
        most: 5.0 * MM,
        cell: CELL,
    };
    let comparison = PartComparison::new(made(&part, &displaced), made(&nominal, &programmed), reach);
    comparison.surface(Watch::NONE).unwrap()
}
