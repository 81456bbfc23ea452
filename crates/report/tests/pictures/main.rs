//! What each picture claims: read back from its SVG.

mod inputs;

use armill_report::{ArmDrawing, Arrow, DeviationMap, Grid, MapSeries, PointState, RegionMap};

use inputs::{NASTY, arm, bars, ellipse, everything, field, grid, map, path_plot, region, sheet, slope};

#[cfg(feature = "png")]
#[test]
fn every_picture_is_well_formed_and_can_be_drawn() {
    for svg in everything() {
        let png = armill_report::raster::png(&svg, 0.5).unwrap_or_else(|e| panic!("{e}\n{svg}"));
        assert!(png.starts_with(b"\x89PNG"));
    }
}

#[test]
fn no_picture_contains_raw_text_or_an_invalid_number() {
    for svg in everything() {
        assert!(!svg.contains(NASTY) && !svg.contains("a <&"), "raw text");
        assert!(
            !svg.contains("NaN") && !svg.contains("inf\"") && !svg.contains('\u{1}'),
            "{svg}"
        );
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    assert_eq!(everything(), everything());
}

#[test]
fn pictures_on_one_page_do_not_share_identifiers() {
    let ids = |svg: &str| -> Vec<String> {
        svg.split("id=\"")
            .skip(1)
            .filter_map(|s| s.split('"').next())
            .map(String::from)
            .collect()
    };
    let (a, b) = (ids(&map(grid(5, 4, slope)).to_svg()), ids(&arm().to_svg()));
    assert!(!a.is_empty() && !b.is_empty() && a.iter().all(|id| !b.contains(id)));
}

#[test]
fn the_out_of_reach_hatch_is_exactly_where_points_are_out_of_reach() {
    let hole = grid(5, 4, |y, z| {
        if y > 40.0 && z > 90.0 {
            PointState::Unreachable
        } else {
            slope(y, z)
        }
    });
    for svg in [map(hole.clone()).to_svg(), region(hole).to_svg()] {
        assert!(svg.contains("class=\"unreachable\"") && svg.contains(">out of reach<"));
    }
    let svg = map(grid(5, 4, slope)).to_svg();
    assert!(!svg.contains("class=\"unreachable\"") && !svg.contains(">out of reach<"));
}

#[test]
fn points_outside_the_joint_limits_have_their_own_hatch() {
    let flagged = grid(5, 4, |y, z| match slope(y, z) {
        PointState::Reached(v) if z > 90.0 => PointState::OutsideJointLimits(v),
        other => other,
    });
    let svg = map(flagged).to_svg();
    assert!(svg.contains("class=\"outside-joint-limits\"") && svg.contains(">outside the joint limits<"));
    assert!(!map(grid(5, 4, slope)).to_svg().contains("outside-joint-limits"));
}

/// Points of the line drawn in the tolerance's colour, inside the map.
fn tolerance_line(svg: &str) -> Vec<[f64; 2]> {
    let line = svg
        .lines()
        .find(|l| l.contains("#c8102e") && l.contains("stroke-width=\"2.4\""))
        .unwrap_or("");
    let data = line
        .split("d=\"")
        .nth(1)
        .and_then(|s| s.split('"').next())
        .unwrap_or("");
    let pairs = data.split(['M', 'L', 'Z']).filter(|s| !s.is_empty());
    pairs
        .map(|p| {
            p.split(' ')
                .map(|n| n.parse().expect("our own SVG"))
                .collect::<Vec<f64>>()
        })
        .map(|v| [v[0], v[1]])
        .collect()
}

/// The frame of a map: the first rectangle without a fill.
fn frame(svg: &str) -> [f64; 4] {
    let line = svg
        .lines()
        .find(|l| l.starts_with("<rect") && l.contains("fill=\"none\""))
        .expect("our own SVG");
    ["x", "y", "width", "height"].map(|key| {
        let from = line.split(&format!(" {key}=\"")).nth(1).expect("our own SVG");
        from.split('"')
            .next()
            .expect("our own SVG")
            .parse()
            .expect("our own SVG")
    })
}

#[test]
fn the_tolerance_line_passes_between_the_right_grid_points() {
    // Values 20, 35, 50+, ... along the row: with the tolerance 42 the line is between the second and third of five
    // columns.
    let svg = DeviationMap {
        tolerance_um: Some(42.0),
        overlays: vec![],
        ..map(grid(5, 4, |y, _| slope(y, 0.0)))
    }
    .to_svg();
    let [x, _, width, _] = frame(&svg);
    let line = tolerance_line(&svg);
    assert!(line.len() >= 2);
    // 20 + 0.3 * 50 i = 42 at i = 1.4667 of 4 steps; a monotone cubic through a straight row is straight.
    let expected = x + width * (22.0 / 15.0) / 4.0;
    // Two decimals are written.
    assert!(
        line.iter().all(|p| (p[0] - expected).abs() < 0.05),
        "{line:?} {expected}"
    );
}

#[test]
fn a_tolerance_that_no_point_exceeds_is_named_but_not_drawn() {
    let svg = DeviationMap {
        tolerance_um: Some(500.0),
        ..map(grid(5, 4, slope))
    }
    .to_svg();
    assert!(svg.contains("tolerance 500 µm (met everywhere)"));
    let svg = DeviationMap {
        tolerance_um: Some(5.0),
        ..map(grid(5, 4, slope))
    }
    .to_svg();
    assert!(svg.contains("tolerance 5 µm (exceeded everywhere)"));
}

#[test]
fn the_scale_of_a_map_is_equal_both_ways() {
    // 200 mm across, 150 mm up.
    let [_, _, width, height] = frame(&map(grid(5, 4, slope)).to_svg());
    assert!((width / height - 200.0 / 150.0).abs() < 1e-3, "{width} {height}");
}

#[test]
fn sizes_of_the_inscribed_shapes_are_written() {
    let svg = region(grid(5, 4, slope)).to_svg();
    assert!(svg.contains(">100 × 80 mm<") && svg.contains(">Ø 50 mm<"));
    let svg = RegionMap {
        rectangle: None,
        circle: None,
        ..region(grid(5, 4, slope))
    }
    .to_svg();
    assert!(!svg.contains("inscribed-"));
}

#[test]
fn the_undecided_zone_is_painted_and_named_only_where_values_are_uncertain() {
    let certain = region(grid(5, 4, slope)).to_svg();
    let uncertain = RegionMap {
        spread_um: vec![5.0; 20],
        ..region(grid(5, 4, slope))
    }
    .to_svg();
    assert!(!certain.contains("uncertainty") && uncertain.contains("within the uncertainty (95 %)"));
    for spread_um in [vec![0.0; 20], vec![f64::NAN; 20], vec![5.0; 3]] {
        let of = |spread_um| {
            RegionMap {
                spread_um,
                ..region(grid(5, 4, slope))
            }
            .to_svg()
        };
        assert_eq!(of(spread_um), certain);
    }
}

#[test]
fn a_sheet_has_one_colour_bar_and_a_region_under_each_map() {
    let grids = vec![grid(5, 4, slope), grid(5, 4, slope), Grid::default()];
    let svg = MapSeries {
        quantity: "deviation (µm)".into(),
        ..sheet(grids.clone())
    }
    .to_svg();
    assert_eq!(svg.matches(">deviation (µm)<").count(), 1);
    assert_eq!(svg.matches("<clipPath").count(), 4, "two maps and two regions");
    assert!(svg.contains("no points"));
    let maps_only = MapSeries {
        show_regions: false,
        ..sheet(grids)
    }
    .to_svg();
    assert_eq!(maps_only.matches("<clipPath").count(), 2);
}

#[test]
fn a_missing_value_breaks_the_line() {
    let lines = |v: Vec<f64>| {
        path_plot(v)
            .to_svg()
            .matches("stroke=\"#0072B2\" stroke-width=\"1.8\"")
            .count()
    };
    assert_eq!(
        lines(vec![1.0, 2.0, f64::NAN, 3.0, 4.0]),
        lines(vec![1.0, 2.0, 3.0, 4.0, 5.0]) + 1
    );
}

#[test]
fn arrows_are_magnified_by_a_nice_factor() {
    let arrows = vec![
        Arrow {
            at_mm: [0.0, 0.0],
            deviation_um: [40.0, 0.0],
        },
        Arrow {
            at_mm: [100.0, 100.0],
            deviation_um: [0.0, -64.0],
        },
    ];
    // 16 % of 100 mm for 64 um is 250, the nice factor below is 200; the scale arrow is the nice length below 64 um.
    assert!(field(arrows).to_svg().contains("50 µm (deviations drawn × 200)"));
}

#[test]
fn principal_compliances_are_written() {
    // Diagonal: the principal values are the entries.
    let svg = ellipse([[0.4, 0.0], [0.0, 0.2]]).to_svg();
    assert!(svg.contains(">0.400 µm/N<") && svg.contains(">0.200 µm/N<") && svg.contains("0.300 µm/N"));
}

#[test]
fn the_total_of_the_shares_is_written_with_its_uncertainty() {
    assert!(bars(vec![30.0, -10.0]).to_svg().contains(">20 ± 2 µm<"));
}

#[test]
fn ghosts_and_plate_are_drawn_when_given() {
    let with = ArmDrawing {
        ghosts: vec![arm().posture, arm().posture],
        ..arm()
    }
    .to_svg();
    assert_eq!(with.matches("class=\"ghost\"").count(), 2);
    assert!(with.contains("class=\"plate\""));
    let without = ArmDrawing {
        plate_mm: None,
        ..arm()
    }
    .to_svg();
    assert!(!without.contains("class=\"ghost\"") && !without.contains("class=\"plate\""));
}

#[test]
fn a_tool_that_stands_in_the_cell_is_drawn_where_it_is_finite() {
    let with = |standing_tool_mm| {
        ArmDrawing {
            standing_tool_mm,
            ..arm()
        }
        .to_svg()
    };
    let without = arm().to_svg();
    assert_eq!(with(Some([[f64::NAN; 3], [0.0; 3]])), without);
    assert_eq!(with(None), without);
    let shapes = |svg: &str| svg.matches("<polygon").count() + svg.matches("<path").count();
    let near = with(Some([[900.0, 0.0, 600.0], [900.0, 0.0, 300.0]]));
    assert!(shapes(&near) > shapes(&without));
}
