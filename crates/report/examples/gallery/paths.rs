//! Made-up deviations along paths, shares of joints and compliances.

use armill_report::{
    Arrow, ArrowCase, AxisLabels, BallbarPlot, BallbarTrace, Cell, CellMap, ColourScale, ComparedCell,
    Comparison, Envelope, ForcePlot, ForceTrace, Growth, HoleMap, HoleMark, Marker, MarkerKind, PathPlot,
    PolarPlot, ProcessMap, RadialReference, RadialSeries, Sense, Series, ShareBar, ShareBars, StabilityPlot,
    StiffnessEllipse, Stretch, TrackMap, VectorField,
};

/// Load cases by the direction of the feed.
const CASES: [&str; 4] = ["feed +y", "feed −y", "feed +z'", "feed −z'"];

/// Deviation in um at an angle of the circle under one case.
fn deviation_um(case: usize, angle_rad: f64) -> [f64; 2] {
    let phase = case as f64 * std::f64::consts::FRAC_PI_2;
    let (s, c) = phase.sin_cos();
    let soft = 1.0 + 0.25 * (angle_rad - 0.4).sin();
    [soft * (38.0 * c + 9.0 * s), soft * (9.0 * c + 55.0 * s)]
}

/// Name and SVG of each picture.
pub fn pictures() -> Vec<(&'static str, String)> {
    vec![
        ("vector_field", vector_field().to_svg()),
        ("path_plot", path_plot().to_svg()),
        ("track_map", track_map().to_svg()),
        ("hole_map", hole_map().to_svg()),
        ("process_map", process_map().to_svg()),
        ("stability_plot", stability_plot().to_svg()),
        ("cell_map", cell_map().to_svg()),
        ("force_plot", force_plot().to_svg()),
        ("polar_plot", polar_plot().to_svg()),
        ("polar_plot_roundness", roundness_plot().to_svg()),
        ("ballbar_plot", ballbar_plot().to_svg()),
        ("comparison", comparison().to_svg()),
        ("shares", shares().to_svg()),
        ("ellipse", ellipse().to_svg()),
    ]
}

/// One mode at 922 Hz, four teeth: closed lobes.
fn stability_plot() -> StabilityPlot {
    let speeds_rpm: Vec<f64> = (0..500).map(|k| 3000.0 + 24.0 * f64::from(k)).collect();
    let depth = |rpm: f64| {
        (1..20_000)
            .map(|step| 1.0 + f64::from(step) * 1e-4)
            .fold(f64::INFINITY, |least, part| {
                let turns = 922.0 * part / (rpm / 60.0 * 4.0);
                let x = (1.0 - part * part, 0.022 * part);
                let whole = turns - (std::f64::consts::FRAC_PI_2 - x.0.atan2(x.1)) / std::f64::consts::PI;
                let on_lobe = (whole - whole.round()).abs() < 5e-4;
                let depth = 4.0 * (x.0 * x.0 + x.1 * x.1) / -x.0;
                if on_lobe { depth.min(least) } else { least }
            })
    };
    StabilityPlot {
        title: "Stability of the cut".into(),
        subtitle: "Cutter of 16 mm with 4 flutes, down-milling, one mode at 922 Hz".into(),
        depths_mm: speeds_rpm.iter().map(|rpm| depth(*rpm)).collect(),
        speeds_rpm,
        deepest_mm: Some(2.0),
        mode_coupling_mm: Some(1.4),
        programmed: Some([9500.0, 0.8]),
    }
}

fn vector_field() -> VectorField {
    let on_circle = |a: f64| [150.0 * a.cos(), 350.0 + 150.0 * a.sin()];
    let turn = std::f64::consts::TAU;
    let cases = CASES.iter().enumerate().map(|(k, name)| ArrowCase {
        name: (*name).into(),
        arrows: (0..16)
            .map(|m| turn * f64::from(m) / 16.0)
            .map(|a| Arrow {
                at_mm: on_circle(a),
                deviation_um: deviation_um(k, a),
            })
            .collect(),
    });
    VectorField {
        title: "Deviation of the tool around a circle of 300 mm".into(),
        subtitle: "Vertical plate at x = 900 mm, 120 N; seen from the tool side".into(),
        axes: AxisLabels {
            horizontal: "base y (mm)".into(),
            vertical: "along plate z' (mm)".into(),
        },
        growth: Growth::Left,
        path_mm: (0..=128)
            .map(|k| on_circle(turn * f64::from(k) / 128.0))
            .collect(),
        cases: cases.collect(),
    }
}

/// Contours of a part and a finer one inside; the arm does not reach one corner.
fn track_map() -> TrackMap {
    let turn = std::f64::consts::TAU;
    let ring = |radius: f64, corners: u32| -> Stretch {
        let points_mm: Vec<[f64; 2]> = (0..=corners)
            .map(|k| turn * f64::from(k) / f64::from(corners))
            .map(|a| {
                let r = radius * (1.0 + 0.18 * (4.0 * a).cos());
                [r * a.cos(), 0.7 * r * a.sin()]
            })
            .collect();
        let deviation = |p: &[f64; 2]| {
            let value = 34.0 + 0.12 * p[0] + 0.002 * p[1].powi(2);
            if p[0] + p[1] > 225.0 { f64::NAN } else { value }
        };
        Stretch {
            deviation_um: points_mm.iter().map(deviation).collect(),
            points_mm,
        }
    };
    let marker = |name: &str, at_mm| Marker {
        at_mm,
        label: "worst points".to_owned(),
        kind: MarkerKind::Point,
        name: name.to_owned(),
    };
    TrackMap {
        title: "A part with an island".to_owned(),
        subtitle: "front elbow-up no-flip, 120 N".to_owned(),
        axes: AxisLabels {
            horizontal: "program x (mm)".to_owned(),
            vertical: "program y (mm)".to_owned(),
        },
        quantity: "deviation across the tool (µm)".to_owned(),
        tolerance_um: Some(60.0),
        scale: ColourScale::Viridis,
        stretches: vec![ring(210.0, 2000), ring(150.0, 400), ring(60.0, 24)],
        markers: vec![marker("1", [0.0, 120.5]), marker("2", [0.0, -173.5])],
    }
}

/// A cut whose deviation goes with depth and, from a base that the edges make, with feed; deep cuts draw the tool in.
fn process_map() -> ProcessMap {
    let steps = |most: f64| (1..=24).map(|k| most * f64::from(k) / 24.0).collect::<Vec<f64>>();
    let (feeds, depths) = (steps(0.2), steps(4.0));
    let deviation = |depth: f64, feed: f64| {
        let drawn = depth * (22.0 + 260.0 * feed);
        if drawn < 220.0 {
            drawn / (1.0 - drawn / 400.0)
        } else {
            f64::INFINITY
        }
    };
    ProcessMap {
        title: "ring: depth and feed".to_owned(),
        subtitle: "front elbow-up no-flip, EN AW-6082 T6, flat end mill of 10 mm".to_owned(),
        axes: AxisLabels {
            horizontal: "feed per tooth (mm)".to_owned(),
            vertical: "axial depth (mm)".to_owned(),
        },
        quantity: "largest deviation across the tool (µm)".to_owned(),
        deviation_um: depths
            .iter()
            .flat_map(|depth| feeds.iter().map(|feed| deviation(*depth, *feed)))
            .collect(),
        horizontal: feeds,
        vertical: depths,
        tolerance_um: 100.0,
        drawn: Some([0.08, 2.5]),
    }
}

/// Turns of the tool that limits bound from above and a singularity cuts in two; the turn chosen goes round its end.
fn cell_map() -> CellMap {
    let along_mm: Vec<f64> = (0..160).map(|k| f64::from(k) * 5.0).collect();
    let turns_deg: Vec<f64> = (-36..36).map(|k| f64::from(k) * 5.0).collect();
    let cell = |along: f64, turn: f64| {
        let wave = (along / 130.0).sin();
        if turn > 110.0 + 30.0 * wave && turn < 160.0 {
            Cell::OutsideJointLimits
        } else if (turn - 20.0 - 0.1 * along).abs() < 4.0 {
            Cell::Singular
        } else if along > 620.0 && turn < -90.0 {
            Cell::OutOfReach
        } else {
            Cell::Deviation(60.0 + 25.0 * wave + 20.0 * (turn.to_radians() - 0.004 * along).cos())
        }
    };
    CellMap {
        title: "rim: how the tool may be turned along the path".to_owned(),
        subtitle: "front elbow-up no-flip, the force of the cut".to_owned(),
        quantity: "deviation across the tool (µm)".to_owned(),
        cells: along_mm
            .iter()
            .flat_map(|along| turns_deg.iter().map(move |turn| cell(*along, *turn)))
            .collect(),
        chosen: along_mm.iter().map(|along| -100.0 - 0.2 * along).collect(),
        chosen_word: "chosen turn".to_owned(),
        period: Some(360.0),
        labels: AxisLabels {
            horizontal: "along the path (mm)".to_owned(),
            vertical: "turn of the tool (deg)".to_owned(),
        },
        across: along_mm,
        up: turns_deg,
        tolerance_um: Some(80.0),
        marks: Vec::new(),
    }
}

fn path_plot() -> PathPlot {
    let position: Vec<f64> = (0..=180).map(|k| f64::from(k) * 2.0).collect();
    let size = |k: usize, a: f64| {
        let [y, z] = deviation_um(k, a.to_radians());
        y.hypot(z) * (1.0 + 0.06 * (3.0 * a.to_radians()).sin())
    };
    let series: Vec<Series> = (0..3)
        .map(|k| Series {
            name: CASES[k].into(),
            position: position.clone(),
            deviation_um: position
                .iter()
                .map(|a| {
                    if k == 2 && (200.0..230.0).contains(a) {
                        f64::NAN
                    } else {
                        size(k, *a) - 9.0 * k as f64
                    }
                })
                .collect(),
        })
        .collect();
    let largest = |m: usize| series.iter().map(|s| s.deviation_um[m]).fold(f64::NAN, f64::max);
    let envelope = Series {
        name: "largest over the cases".into(),
        position: position.clone(),
        deviation_um: (0..position.len()).map(largest).collect(),
    };
    PathPlot {
        title: "In-plane deviation around the circle".into(),
        subtitle: "Vertical plate at x = 900 mm, 120 N".into(),
        position_label: "angle on the circle (°)".into(),
        quantity: "in-plane deviation (µm)".into(),
        series,
        envelope: Some(envelope),
        tolerance_um: Some(50.0),
    }
}

/// Half a million samples of a cut from 1.5 s to 8 s, with drift and the teeth of a cutter.
fn force_plot() -> ForcePlot {
    /// Time that is shown, s, and samples a second.
    const SPAN_S: [f64; 2] = [0.0, 10.0];
    const RATE_HZ: f64 = 50_000.0;
    let cut = |time: f64| f64::from((1.5..8.0).contains(&time) && !(4.0..4.4).contains(&time));
    let teeth = |time: f64| (time * 1885.0).sin() + 0.4 * (time * 3770.0 + 0.3).sin();
    let axis = move |axis: usize, time: f64| {
        let turned = if time < 4.2 { axis } else { (axis + 1) % 2 };
        let mean = [42.0, -65.0, 18.0][if axis == 2 { 2 } else { turned }];
        [mean * cut(time), mean * cut(time) * (1.0 + 0.6 * teeth(time))]
    };
    let drift = |axis: usize, time: f64| [8.0, -5.0, 3.0][axis] * (0.4 + 0.12 * time);
    let samples = || (0..500_000).map(|k| f64::from(k) / RATE_HZ);
    let component = |name: &str, of: usize| ForceTrace {
        name: name.into(),
        before: Envelope::of(SPAN_S, samples().map(|t| (t, axis(of, t)[1] + drift(of, t)))),
        after: Envelope::of(SPAN_S, samples().map(|t| (t, axis(of, t)[0]))),
    };
    let size = |treated: bool| {
        samples().map(move |t| {
            let sum: f64 = (0..3)
                .map(|of| match treated {
                    true => axis(of, t)[0],
                    false => axis(of, t)[1] + drift(of, t),
                })
                .map(|force| force * force)
                .sum();
            (t, sum.sqrt())
        })
    };
    ForcePlot {
        title: "Force on the tool while a groove is milled".into(),
        subtitle: "groove.txt, 50000 Hz; drift removed; low-pass 50 Hz".into(),
        traces: vec![
            component("Fx (N)", 0),
            component("Fy (N)", 1),
            component("Fz (N)", 2),
            ForceTrace {
                name: "size (N)".into(),
                before: Envelope::of(SPAN_S, size(false)),
                after: Envelope::of(SPAN_S, size(true)),
            },
        ],
        air_s: vec![[0.0, 1.3], [8.2, 10.0]],
        marks_s: vec![(1.5, "first cut begins".into()), (8.0, "last cut ends".into())],
    }
}

fn polar_plot() -> PolarPlot {
    let series = |k: usize| RadialSeries {
        name: CASES[k].into(),
        angle_deg: (0..=180).map(|m| f64::from(m) * 2.0).collect(),
        radial_um: (0..=180)
            .map(|m| (f64::from(m) * 2.0).to_radians())
            .map(|a| {
                let [y, z] = deviation_um(k, a);
                y * a.cos() + z * a.sin()
            })
            .collect(),
    };
    PolarPlot {
        title: "Radial deviation of the circle of 300 mm".into(),
        subtitle: "Roundness 76 µm (feed +y), 112 µm (feed +z')".into(),
        horizontal: "y".into(),
        vertical: "z'".into(),
        growth: Growth::Left,
        zero: "nominal circle".into(),
        series: vec![series(0), series(2)],
        references: Vec::new(),
    }
}

/// A measured bore of three lobes with its four reference circles.
fn roundness_plot() -> PolarPlot {
    let circle = |name: &str, [x, y]: [f64; 2], radii_um: &[f64]| {
        let seen = radii_um.iter().flat_map(|r| {
            let at = move |m: i32| {
                let a = (f64::from(m) * 2.0).to_radians();
                (f64::from(m) * 2.0, r + x * a.cos() + y * a.sin())
            };
            (0..=180).map(at).chain([(0.0, f64::NAN)])
        });
        let (angle_deg, radial_um) = seen.unzip();
        RadialReference {
            seen: RadialSeries {
                name: name.into(),
                angle_deg,
                radial_um,
            },
            centre_um: [x, y],
        }
    };
    let profile = |m: i32| {
        let a = (f64::from(m) * 2.0).to_radians();
        4.0 * (3.0 * a).cos() + 1.5 * (5.0 * a + 0.6).sin() + 0.4 * (31.0 * a).sin()
    };
    PolarPlot {
        title: "Bore 25 mm".into(),
        subtitle: "RONt 10.6 µm LSCI, 9.9 µm MZCI".into(),
        horizontal: "x".into(),
        vertical: "y".into(),
        growth: Growth::Right,
        zero: "LSCI".into(),
        series: vec![RadialSeries {
            name: "profile".into(),
            angle_deg: (0..=180).map(|m| f64::from(m) * 2.0).collect(),
            radial_um: (0..=180).map(profile).collect(),
        }],
        references: vec![
            circle("MZCI", [0.3, 0.4], &[-4.9, 5.1]),
            circle("MCCI", [-0.5, 0.2], &[5.4]),
            circle("MICI", [0.6, -0.3], &[-4.6]),
        ],
    }
}

/// Two runs each way: an ellipse, 20 um of backlash that step where an axis reverses, and noise.
fn ballbar_plot() -> BallbarPlot {
    let trace = |(name, sense, repeat): (&str, Sense, usize)| {
        let sign = if sense == Sense::Clockwise { -1.0 } else { 1.0 };
        let radial = |deg: usize| {
            let a = (deg as f64 + 0.5).to_radians();
            let gap = 25.0 * sign * (a.sin().signum() * a.cos() - 0.6 * a.cos().signum() * a.sin());
            let noise =
                5.0 * (f64::sin(7.3 * a + repeat as f64) + f64::sin(23.0 * a * (1.0 + repeat as f64)));
            35.0 * (2.0 * a - 0.6).cos() + 12.0 * (3.0 * a).sin() + gap + noise
        };
        BallbarTrace {
            name: name.into(),
            sense,
            angle_deg: (0..=360).map(|deg| deg as f64 + 0.5).collect(),
            radial_um: (0..=360).map(radial).collect(),
            start_deg: Some(180.0),
        }
    };
    let runs = [
        ("CW1", Sense::Clockwise, 0),
        ("CW2", Sense::Clockwise, 1),
        ("CCW1", Sense::Anticlockwise, 0),
        ("CCW2", Sense::Anticlockwise, 1),
    ];
    BallbarPlot {
        title: "Circular test".into(),
        subtitle: "radius 100 mm, 1000 mm/min; G(b) 118 µm".into(),
        horizontal: "X".into(),
        vertical: "Y".into(),
        growth: Growth::Right,
        traces: runs.map(trace).to_vec(),
        marks: Vec::new(),
    }
}

fn shares() -> ShareBars {
    let bar = |label: &str, shares_um: [f64; 6]| ShareBar {
        label: label.into(),
        shares_um: shares_um.into(),
        total_um: Some(shares_um.iter().sum()),
        total_uncertainty_um: Some(4.2),
    };
    let bars = vec![
        bar("centre of the plate", [11.0, 16.5, 9.2, 2.1, -3.4, 0.6]),
        bar("upper left corner", [24.0, 21.5, 14.0, 4.8, -9.0, 1.2]),
        bar("lower right corner, elbow down", [8.0, -6.5, 5.2, 1.1, 2.4, 0.2]),
    ];
    ShareBars {
        title: "Contributions of the joints".into(),
        subtitle: "Share of each joint in the in-plane deviation, feed +y, 120 N".into(),
        quantity: "share of in-plane deviation (µm)".into(),
        parts: ["S", "L", "U", "R", "B", "T"].map(String::from).into(),
        bars,
    }
}

fn ellipse() -> StiffnessEllipse {
    StiffnessEllipse {
        title: "Compliance in the plate".into(),
        subtitle: "Centre of the plate, elbow up".into(),
        axes: AxisLabels {
            horizontal: "base y (µm/N)".into(),
            vertical: "along plate z' (µm/N)".into(),
        },
        growth: Growth::Left,
        compliance_um_per_n: [[0.42, 0.11], [0.11, 0.23]],
    }
}

/// Three cells, one of which is known badly and one that does not reach everything.
fn comparison() -> Comparison {
    let cell = |label: &str, [mean, p95, largest, u]: [f64; 4], note: &str, result: &str| ComparedCell {
        label: label.into(),
        note: note.into(),
        mean_um: Some(mean),
        p95_um: Some(p95),
        largest_um: Some(largest),
        largest_uncertainty_um: Some(u),
        tolerance_um: Some(40.0),
        result: result.into(),
    };
    Comparison {
        title: "Rim of a housing: which cell meets the tolerance".into(),
        subtitle: "mean, 95 % and largest deviation; best first".into(),
        quantity: "in-plane deviation (µm)".into(),
        result: "within".into(),
        cells: vec![
            cell("large arm", [12.0, 19.0, 24.0, 3.0], "", "100.0 %"),
            cell(
                "large arm, long tool",
                [22.0, 37.0, 52.0, 14.0],
                "compliance assumed",
                "91.5 %",
            ),
            cell(
                "small arm",
                [41.0, 66.0, 83.0, 8.0],
                "12 of 240 points out of reach",
                "38.0 %",
            ),
        ],
    }
}

/// A panel of holes, worse to the right; one corner is out of reach.
fn hole_map() -> HoleMap {
    let hole = |k: u32| {
        let [x, y] = [60.0 * f64::from(k % 7), 50.0 * f64::from(k / 7)];
        let error_um = [12.0 + 0.06 * x, -6.0 + 0.05 * y - 0.02 * x];
        let lost = x > 300.0 && y > 140.0;
        HoleMark {
            is_rejected: false,
            at_mm: [x, y],
            error_um,
            deviation_um: (!lost).then(|| error_um[0].hypot(error_um[1])),
            name: if k == 6 { "1".into() } else { String::new() },
        }
    };
    HoleMap {
        title: "Rivet holes of a panel".into(),
        subtitle: "drill of 6 mm, each hole in its best posture".into(),
        axes: AxisLabels {
            horizontal: "x (mm)".into(),
            vertical: "y (mm)".into(),
        },
        quantity: "deviation across the hole (µm)".into(),
        tolerance_um: Some(30.0),
        scale: ColourScale::Viridis,
        holes: (0..28).map(hole).collect(),
    }
}
