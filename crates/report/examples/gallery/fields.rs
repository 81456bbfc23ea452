//! Made-up deviation fields and the pictures of them.

use armill_report::{
    AxisLabels, CircleMm, ColourScale, DeviationMap, Grid, MapSeries, Marker, MarkerKind, Overlay, Panel,
    PointState, RectangleMm, RegionMap,
};

/// A field that looks like an arm's: soft far out and high up, out of reach beyond a sphere, a joint limit low on one
/// side.
fn grid(n: usize, distance_mm: f64) -> Grid {
    let lattice = |from: f64, to: f64| -> Vec<f64> {
        (0..n)
            .map(|k| from + (to - from) * k as f64 / (n - 1) as f64)
            .collect()
    };
    let (horizontal_mm, vertical_mm) = (lattice(400.0, -400.0), lattice(0.0, 800.0));
    let point = |y: f64, z: f64| {
        let reach = (distance_mm.powi(2) + y * y + (z - 300.0).powi(2)).sqrt();
        let value =
            6.0 + (reach / 105.0).powi(2) * 0.46 + 0.00009 * (y + 80.0).powi(2) + 9.0 * (z / 260.0).sin();
        if reach > 1040.0 {
            PointState::Unreachable
        } else if z < 170.0 && y < -0.9 * z - 180.0 {
            PointState::OutsideJointLimits(value)
        } else {
            PointState::Reached(value)
        }
    };
    let points = vertical_mm
        .iter()
        .flat_map(|z| horizontal_mm.iter().map(move |y| point(*y, *z)))
        .collect();
    Grid {
        horizontal_mm,
        vertical_mm,
        points,
    }
}

/// A vertical plate as seen from the tool side: y grows to the left.
fn axes() -> AxisLabels {
    AxisLabels {
        horizontal: "base y (mm)".into(),
        vertical: "along plate z' (mm)".into(),
    }
}

fn circle_mm(centre: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    (0..=96)
        .map(|k| {
            let (s, c) = (f64::from(k) * std::f64::consts::TAU / 96.0).sin_cos();
            [centre[0] + radius * c, centre[1] + radius * s]
        })
        .collect()
}

/// A map of `n` by `n` points at this distance.
fn map(n: usize, distance_mm: f64) -> DeviationMap {
    DeviationMap {
        title: format!("In-plane deviation on a vertical plate at x = {distance_mm:.0} mm"),
        subtitle: "Envelope of four feed directions, 120 N, elbow up; seen from the tool side".into(),
        grid: grid(n, distance_mm),
        axes: axes(),
        quantity: "in-plane deviation (µm)".into(),
        tolerance_um: Some(50.0),
        ..DeviationMap::default()
    }
}

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    let fine = DeviationMap {
        overlays: vec![Overlay {
            label: "circle of 300 mm".into(),
            points_mm: circle_mm([0.0, 350.0], 150.0),
        }],
        markers: vec![Marker {
            at_mm: [-80.0, 20.0],
            label: "best point".into(),
            kind: MarkerKind::Best,
            name: String::new(),
        }],
        ..map(81, 900.0)
    };
    let coarse = DeviationMap {
        show_grid_points: true,
        ..map(5, 900.0)
    };
    let grey = DeviationMap {
        scale: ColourScale::Cividis,
        tolerance_um: Some(500.0),
        ..map(21, 700.0)
    };
    let nothing = DeviationMap {
        grid: grid(9, 2000.0),
        ..map(9, 900.0)
    };
    let row = Grid {
        horizontal_mm: vec![0.0, 1.0, 2.0],
        vertical_mm: vec![5.0],
        points: vec![PointState::Reached(12.0); 3],
    };
    let region = RegionMap {
        title: "Permissible region on the plate at x = 900 mm".into(),
        subtitle: "Synthetic field; rectangle and circle are inside the region".into(),
        grid: grid(41, 900.0),
        spread_um: vec![4.0; 41 * 41],
        axes: axes(),
        tolerance_um: 50.0,
        show_iso_lines: true,
        rectangle: Some(RectangleMm {
            corner_mm: [-180.0, 20.0],
            opposite_mm: [90.0, 230.0],
        }),
        circle: Some(CircleMm {
            centre_mm: [-50.0, 140.0],
            radius_mm: 135.0,
        }),
    };
    let panel = |x: f64, n: usize| Panel {
        title: format!("x = {x:.0} mm"),
        note: format!("{:.0} % within", 130.0 - x / 10.0),
        grid: grid(n, x),
    };
    let sheet = MapSeries {
        title: "Distance series: in-plane deviation and permissible region".into(),
        subtitle: "Vertical plate, envelope of four feed directions, 120 N".into(),
        panels: [600.0, 800.0, 900.0, 1000.0, 1200.0].map(|x| panel(x, 21)).into(),
        columns: 5,
        axes: axes(),
        quantity: "in-plane deviation (µm)".into(),
        tolerance_um: Some(50.0),
        scale: ColourScale::Viridis,
        show_regions: true,
    };
    let many = MapSeries {
        title: "Volume in slices of 40 mm".into(),
        panels: (0..15).map(|k| panel(500.0 + 40.0 * f64::from(k), 15)).collect(),
        columns: 4,
        show_regions: false,
        ..sheet.clone()
    };
    vec![
        ("map_fine", fine.to_svg()),
        ("map_coarse", coarse.to_svg()),
        ("map_cividis", grey.to_svg()),
        ("map_unreachable", nothing.to_svg()),
        (
            "map_one_row",
            DeviationMap {
                grid: row,
                ..map(5, 900.0)
            }
            .to_svg(),
        ),
        ("region", region.to_svg()),
        ("sheet_distance", sheet.to_svg()),
        ("sheet_volume", many.to_svg()),
    ]
}
