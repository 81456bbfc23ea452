//! Made-up inputs, sound and unsound, for each picture.

use armill_report::{
    ArmDrawing, ArmJoint, ArmPosture, Arrow, ArrowCase, AxisLabels, BallbarPlot, BallbarTrace, CircleMm,
    ComparedCell, Comparison, DeviationMap, Envelope, ForcePlot, ForceTrace, Grid, HoleMap, HoleMark,
    MapSeries, Marker, MarkerKind, Overlay, Panel, PathPlot, PointState, PolarPlot, ProcessMap, RadialSeries,
    RectangleMm, RegionMap, Series, ShareBar, ShareBars, StiffnessEllipse, Stretch, TrackMap, VectorField,
    View,
};

pub const NASTY: &str = "a <&\"> 'b' \u{1}";

pub fn grid(nx: usize, ny: usize, value: impl Fn(f64, f64) -> PointState) -> Grid {
    let horizontal_mm: Vec<f64> = (0..nx).map(|i| 100.0 - 50.0 * i as f64).collect();
    let vertical_mm: Vec<f64> = (0..ny).map(|j| 50.0 * j as f64).collect();
    let points = vertical_mm
        .iter()
        .flat_map(|z| horizontal_mm.iter().map(|y| value(*y, *z)))
        .collect();
    Grid {
        horizontal_mm,
        vertical_mm,
        points,
    }
}

pub fn map(grid: Grid) -> DeviationMap {
    DeviationMap {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        grid,
        axes: AxisLabels {
            horizontal: NASTY.into(),
            vertical: NASTY.into(),
        },
        quantity: NASTY.into(),
        tolerance_um: Some(50.0),
        overlays: vec![Overlay {
            label: NASTY.into(),
            points_mm: vec![[0.0, 0.0], [f64::NAN, 1.0], [9.0, 9.0]],
        }],
        show_grid_points: true,
        ..DeviationMap::default()
    }
}

pub fn region(grid: Grid) -> RegionMap {
    RegionMap {
        title: NASTY.into(),
        grid,
        tolerance_um: 50.0,
        show_iso_lines: true,
        rectangle: Some(RectangleMm {
            corner_mm: [-50.0, 10.0],
            opposite_mm: [50.0, 90.0],
        }),
        circle: Some(CircleMm {
            centre_mm: [0.0, 50.0],
            radius_mm: 25.0,
        }),
        ..RegionMap::default()
    }
}

pub fn slope(y: f64, z: f64) -> PointState {
    PointState::Reached(20.0 + 0.3 * (100.0 - y) + 0.05 * z)
}

pub fn arm() -> ArmDrawing {
    let joint = |name: &str, origin_mm, axis| ArmJoint {
        name: name.into(),
        origin_mm,
        axis,
    };
    ArmDrawing {
        title: NASTY.into(),
        posture: ArmPosture {
            base_mm: [0.0; 3],
            joints: vec![
                joint(NASTY, [0.0; 3], [0.0, 0.0, 1.0]),
                joint("L", [150.0, 0.0, 500.0], [0.0, 1.0, 0.0]),
                joint("U", [200.0, 0.0, 1200.0], [0.0, 1.0, 0.0]),
                joint("B", [900.0, 0.0, 1200.0], [0.0, 1.0, 0.0]),
            ],
            flange_mm: [1000.0, 0.0, 1200.0],
            tool_mm: [1100.0, 0.0, 1200.0],
        },
        plate_mm: Some([
            [1100.0, -9.0, 0.0],
            [1100.0, 9.0, 0.0],
            [1100.0, 9.0, 9.0],
            [1100.0, -9.0, 9.0],
        ]),
        path_mm: vec![
            [1100.0, 0.0, 1200.0],
            [1100.0, f64::NAN, 0.0],
            [1100.0, 100.0, 1200.0],
        ],
        ..ArmDrawing::default()
    }
}

pub fn bars(shares_um: Vec<f64>) -> ShareBars {
    let bar = ShareBar {
        label: NASTY.repeat(9),
        total_um: Some(shares_um.iter().sum()),
        total_uncertainty_um: Some(2.0),
        shares_um,
    };
    ShareBars {
        title: NASTY.into(),
        parts: vec![NASTY.into()],
        bars: vec![bar],
        ..ShareBars::default()
    }
}

/// A cell of this size next to a valid one.
pub fn comparison(um: Option<f64>) -> Comparison {
    let cell = |um: Option<f64>| ComparedCell {
        label: NASTY.repeat(9),
        note: NASTY.into(),
        mean_um: um.map(|um| 0.5 * um),
        p95_um: um,
        largest_um: um,
        largest_uncertainty_um: um,
        tolerance_um: um.or(Some(f64::INFINITY)),
        result: NASTY.into(),
    };
    Comparison {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        quantity: NASTY.into(),
        result: NASTY.into(),
        cells: vec![cell(um), cell(Some(12.0))],
    }
}

/// A hole of this size next to a valid one and one without a position.
pub fn hole_map(um: Option<f64>) -> HoleMap {
    let hole = |at_mm: [f64; 2], um: Option<f64>| HoleMark {
        is_rejected: false,
        at_mm,
        error_um: [um.unwrap_or(f64::NAN), 1.0],
        deviation_um: um,
        name: NASTY.into(),
    };
    HoleMap {
        title: NASTY.into(),
        quantity: NASTY.into(),
        tolerance_um: Some(10.0),
        holes: vec![
            hole([0.0, 0.0], um),
            hole([50.0, 20.0], Some(12.0)),
            hole([f64::NAN, 0.0], Some(12.0)),
        ],
        ..HoleMap::default()
    }
}

pub fn path_plot(deviation_um: Vec<f64>) -> PathPlot {
    let position = (0..deviation_um.len()).map(|k| k as f64).collect();
    PathPlot {
        series: vec![Series {
            name: NASTY.into(),
            position,
            deviation_um,
        }],
        tolerance_um: Some(50.0),
        ..PathPlot::default()
    }
}

pub fn polar(radial_um: Vec<f64>) -> PolarPlot {
    let angle_deg = (0..radial_um.len()).map(|k| 10.0 * k as f64).collect();
    PolarPlot {
        series: vec![RadialSeries {
            name: NASTY.into(),
            angle_deg,
            radial_um,
        }],
        ..PolarPlot::default()
    }
}

pub fn ballbar(radial_um: Vec<f64>) -> BallbarPlot {
    let angle_deg = (0..radial_um.len()).map(|k| 10.0 * k as f64).collect();
    BallbarPlot {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        horizontal: NASTY.into(),
        traces: vec![BallbarTrace {
            name: NASTY.into(),
            angle_deg,
            radial_um,
            start_deg: Some(f64::NAN),
            ..BallbarTrace::default()
        }],
        ..BallbarPlot::default()
    }
}

pub fn field(arrows: Vec<Arrow>) -> VectorField {
    VectorField {
        cases: vec![ArrowCase {
            name: NASTY.into(),
            arrows,
        }],
        ..VectorField::default()
    }
}

pub fn ellipse(compliance_um_per_n: [[f64; 2]; 2]) -> StiffnessEllipse {
    StiffnessEllipse {
        title: NASTY.into(),
        compliance_um_per_n,
        ..StiffnessEllipse::default()
    }
}

pub fn sheet(grids: Vec<Grid>) -> MapSeries {
    let panels = grids.into_iter().map(|grid| Panel {
        title: NASTY.into(),
        note: "n".into(),
        grid,
    });
    MapSeries {
        panels: panels.collect(),
        tolerance_um: Some(50.0),
        show_regions: true,
        columns: 4,
        ..MapSeries::default()
    }
}

pub fn track(deviation_um: Vec<f64>) -> TrackMap {
    let marker = |at_mm, kind| Marker {
        at_mm,
        label: NASTY.into(),
        kind,
        name: NASTY.into(),
    };
    let at = |k: usize| [10.0 * k as f64, 7.0 * (k % 2) as f64];
    TrackMap {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        quantity: NASTY.into(),
        tolerance_um: Some(50.0),
        stretches: vec![Stretch {
            points_mm: (0..deviation_um.len()).map(at).collect(),
            deviation_um,
        }],
        markers: vec![
            marker([1.0, 2.0], MarkerKind::Point),
            marker([f64::NAN, 2.0], MarkerKind::Point),
            marker([9.0, 3.0], MarkerKind::Best),
        ],
        ..TrackMap::default()
    }
}

pub fn process(deviation_um: Vec<f64>) -> ProcessMap {
    ProcessMap {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        quantity: NASTY.into(),
        axes: AxisLabels {
            horizontal: NASTY.into(),
            vertical: NASTY.into(),
        },
        horizontal: vec![0.05, 0.10, 0.20],
        vertical: vec![1.0, 3.0],
        deviation_um,
        tolerance_um: 50.0,
        drawn: Some([0.1, 2.0]),
    }
}

pub fn forces(newtons: Vec<f64>) -> ForcePlot {
    const SPAN_S: [f64; 2] = [0.0, 10.0];
    let samples = || newtons.iter().enumerate().map(|(k, n)| (k as f64, *n));
    let trace = |times: f64| ForceTrace {
        name: NASTY.into(),
        before: Envelope::of(SPAN_S, samples()),
        after: Envelope::of(SPAN_S, samples().map(|(time, n)| (time, times * n))),
    };
    ForcePlot {
        title: NASTY.into(),
        subtitle: NASTY.into(),
        traces: vec![trace(0.5), trace(-1.0)],
        air_s: vec![[0.0, 1.0], [f64::NAN, 2.0]],
        marks_s: vec![(0.5, NASTY.into()), (f64::NAN, "never".into())],
    }
}

/// One picture of each kind, and the same from input that has nothing to draw.
pub fn everything() -> Vec<String> {
    let lost = |_: f64, _: f64| PointState::Unreachable;
    let odd = |y: f64, z: f64| PointState::Reached(if y > 0.0 { f64::NAN } else { f64::INFINITY * z });
    let grids = [
        grid(5, 4, slope),
        grid(5, 4, lost),
        grid(4, 4, odd),
        grid(3, 3, |_, _| PointState::Reached(12.0)),
        grid(3, 3, |y, _| PointState::Reached(y * 1e300)),
        grid(1, 1, slope),
        grid(1, 7, slope),
        grid(7, 1, slope),
        Grid::default(),
        Grid {
            points: vec![PointState::Reached(1.0)],
            ..grid(3, 3, slope)
        },
        Grid {
            vertical_mm: vec![0.0, 0.0, f64::NAN],
            ..grid(3, 3, slope)
        },
    ];
    let mut all: Vec<String> = grids.iter().map(|g| map(g.clone()).to_svg()).collect();
    all.extend(grids.iter().map(|g| region(g.clone()).to_svg()));
    all.push(
        RegionMap {
            tolerance_um: f64::NAN,
            ..region(grid(3, 3, slope))
        }
        .to_svg(),
    );
    all.extend([
        sheet(grids.to_vec()).to_svg(),
        sheet(Vec::new()).to_svg(),
        sheet(vec![Grid::default()]).to_svg(),
    ]);
    let shares = [
        vec![3.0, -1.0, 0.5],
        vec![],
        vec![f64::NAN],
        vec![0.0],
        vec![-4.0],
    ];
    all.extend(shares.map(|s| bars(s).to_svg()));
    let sizes = [Some(30.0), Some(f64::NAN), None, Some(0.0), Some(1e300)];
    all.extend(sizes.map(|um| comparison(um).to_svg()));
    all.extend(sizes.map(|um| hole_map(um).to_svg()));
    let rows = [
        vec![1.0, f64::NAN, 3.0, 4.0],
        vec![],
        vec![f64::NAN],
        vec![7.0],
        vec![0.0; 3],
        vec![-1e300, 1e300],
    ];
    all.extend(rows.iter().map(|r| path_plot(r.clone()).to_svg()));
    all.extend(rows.iter().map(|r| polar(r.clone()).to_svg()));
    all.extend(rows.iter().map(|r| ballbar(r.clone()).to_svg()));
    all.extend(rows.iter().map(|r| track(r.clone()).to_svg()));
    all.extend(rows.iter().map(|r| forces(r.clone()).to_svg()));
    all.extend(
        [
            process(vec![10.0, 20.0, 90.0, 30.0, f64::INFINITY, 400.0]),
            process(vec![f64::NAN; 6]),
            process(vec![1.0]),
            process(vec![7.0; 6]),
            process(vec![0.0, f64::NAN, 1e300, -1e300, 3.0, 4.0]),
            ProcessMap {
                tolerance_um: f64::NAN,
                drawn: Some([f64::NAN, 2.0]),
                ..process(vec![10.0, 20.0, 90.0, 30.0, 40.0, 50.0])
            },
            ProcessMap {
                horizontal: vec![0.05; 3],
                ..process(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
            },
            ProcessMap {
                vertical: vec![1.0, f64::NAN],
                ..process(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
            },
        ]
        .map(|map| map.to_svg()),
    );
    let arrow = |v: f64| Arrow {
        at_mm: [v, 1.0],
        deviation_um: [v, 3.0],
    };
    all.extend(
        [
            vec![arrow(1.0), arrow(f64::NAN)],
            vec![],
            vec![arrow(f64::INFINITY)],
        ]
        .map(|a| field(a).to_svg()),
    );
    let compliances = [
        [[0.4, 0.1], [0.1, 0.2]],
        [[0.0; 2]; 2],
        [[f64::NAN; 2]; 2],
        [[1.0, 2.0], [2.0, 1.0]],
    ];
    all.extend(compliances.map(|c| ellipse(c).to_svg()));
    let nowhere = ArmPosture {
        tool_mm: [f64::NAN; 3],
        ..arm().posture
    };
    all.extend([
        arm().to_svg(),
        arm().to_svg_views(&[View::Iso, View::Front, View::Side, View::Top]),
        arm().to_svg_views(&[]),
        ArmDrawing {
            posture: nowhere,
            ..arm()
        }
        .to_svg(),
        ArmDrawing::default().to_svg(),
        ArmDrawing {
            standing_tool_mm: Some([[900.0, 0.0, 600.0], [900.0, 0.0, 300.0]]),
            ..arm()
        }
        .to_svg(),
        ArmDrawing {
            posture: ArmPosture {
                joints: vec![ArmJoint::default(); 6],
                ..ArmPosture::default()
            },
            ..arm()
        }
        .to_svg(),
    ]);
    all
}
