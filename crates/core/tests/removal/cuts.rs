use std::f64::consts::PI;

use armill_core::nalgebra::Vector3;
use armill_core::removal::{DexelDirections, EndOrigin, RotatingTool, ToolMove, ToolSolid};
use armill_core::watch::Watch;

use super::{MM, at, block, cut, end_mill, moves, top};

#[test]
fn a_slot_has_the_volume_and_the_walls_of_the_cutter() {
    // 10 mm wide, 4 mm deep, through a block of 60 mm: 10 x 4 x 60 mm^3.
    let part = block([60.0, 40.0, 20.0], 0.25, DexelDirections::All);
    let path = moves(&[at(-10.0, 20.0, 16.0), at(70.0, 20.0, 16.0)], Vector3::z_axis());
    let before = part.volume();
    let (part, removals) = cut(part, &path, &end_mill(10.0, 0.0, 30.0));
    let expected = 10.0 * 4.0 * 60.0 * MM.powi(3);
    // The walls are on the edges of cells, so that the volume is exact but for single precision.
    assert!((removals[0].volume / expected - 1.0).abs() < 1e-6);
    assert!((before - part.volume() - removals[0].volume).abs() < 1e-15);
    for point in part.surface() {
        if point.origin != EndOrigin::Move(0) {
            continue;
        }
        let (place, normal) = (
            point.position / MM,
            path[0].surface_normal(&end_mill(10.0, 0.0, 30.0), 1e-5, &point.position),
        );
        let normal = normal.unwrap();
        match point.direction {
            1 => {
                let wall = if point.begins { 25.0 } else { 15.0 };
                assert!((place.y - wall).abs() < 2e-6, "{place}");
                assert!(
                    (normal.y - if point.begins { -1.0 } else { 1.0 }).abs() < 1e-6,
                    "{normal:?}"
                );
            }
            2 => {
                assert!((place.z - 16.0).abs() < 2e-6 && !point.begins);
                assert!(normal.z > 1.0 - 1e-6);
            }
            _ => unreachable!("a slot through the block has no end along x: {place}"),
        }
    }
}

#[test]
fn a_closed_slot_has_round_ends() {
    // Length 30 mm between the centres of both ends, 8 mm wide, 5 mm deep.
    let part = block([60.0, 20.0, 10.0], 0.1, DexelDirections::Z);
    let path = [at(15.0, 10.0, 12.0), at(15.0, 10.0, 5.0), at(45.0, 10.0, 5.0)];
    let (_, removals) = cut(part, &moves(&path, Vector3::z_axis()), &end_mill(8.0, 0.0, 30.0));
    let hole = PI * 16.0 * 5.0 * MM.powi(3);
    let slot = 8.0 * 30.0 * 5.0 * MM.powi(3);
    // Half a cell on the outline of the round ends, of both signs: far less than their length times half a cell.
    let bound = 0.02 * 8.0 * PI * 5.0 * MM.powi(3);
    assert!(
        (removals[0].volume - hole).abs() < bound,
        "{}",
        removals[0].volume / hole
    );
    assert!(
        (removals[1].volume - slot).abs() < bound,
        "{}",
        removals[1].volume / slot
    );
}

#[test]
fn a_ball_nose_leaves_scallops_between_its_passes() {
    let (radius, step) = (4.0, 2.0);
    let part = block([20.0, 20.0, 10.0], 0.1, DexelDirections::Z);
    let mut points = Vec::new();
    for pass in 0..12 {
        let (y, ends) = (f64::from(pass) * step - 1.0, [-5.0, 25.0]);
        let [from, to] = if pass % 2 == 0 { ends } else { [ends[1], ends[0]] };
        points.extend([at(from, y, 8.0), at(to, y, 8.0)]);
    }
    let (part, _) = cut(
        part,
        &moves(&points, Vector3::z_axis()),
        &end_mill(2.0 * radius, radius, 20.0),
    );
    // r - sqrt(r^2 - p^2/4) at the cusp between passes at 9 and 11 mm, and the circle itself at a cell's centre.
    let of_circle = |off: f64| 8.0 + radius - (radius * radius - off * off).sqrt();
    for (y, off) in [
        (9.05, 0.05),
        (9.55, 0.55),
        (9.95, 0.95),
        (10.05, 0.95),
        (10.95, 0.05),
    ] {
        let found = top(&part, 10.05, y).unwrap();
        assert!((found - of_circle(off)).abs() < 2e-6, "{y}: {found}");
    }
    let scallop = radius - (radius * radius - step * step / 4.0_f64).sqrt();
    let highest = (0..100)
        .map(|n| top(&part, 10.05, 5.05 + 0.1 * f64::from(n)).unwrap())
        .fold(0.0, f64::max);
    // The nearest centre of a cell is 0.05 mm from the cusp, where the slope is step / (2 radius).
    assert!(
        highest - 8.0 < scallop && highest - 8.0 > scallop - 0.05 * 0.26,
        "{highest}"
    );
}

#[test]
fn a_drilled_hole_has_a_cylinder_and_a_cone() {
    // 118 deg, 10 mm: the cone is 5 / tan 59 deg high. The tip ends 20 mm deep.
    let drill = ToolSolid::drill(10.0 * MM, 118_f64.to_radians(), 60.0 * MM).unwrap();
    let part = block([20.0, 20.0, 30.0], 0.05, DexelDirections::Z);
    let path = moves(&[at(10.0, 10.0, 35.0), at(10.0, 10.0, 10.0)], Vector3::z_axis());
    let (part, removals) = cut(part, &path, &drill);
    let cone = 5.0 / 59_f64.to_radians().tan();
    let expected = PI * 25.0 * (20.0 - cone) + PI * 25.0 * cone / 3.0;
    assert!((removals[0].volume / MM.powi(3) / expected - 1.0).abs() < 5e-4);
    let rho = (2.025_f64 * 2.025 + 1.025 * 1.025).sqrt();
    let found = top(&part, 12.03, 11.03).unwrap();
    assert!(
        (found - 10.0 - rho / 59_f64.to_radians().tan()).abs() < 2e-6,
        "{found}"
    );
}

#[test]
fn a_tool_that_leaves_through_the_bottom_leaves_no_material_there() {
    let part = block([20.0, 20.0, 10.0], 0.5, DexelDirections::All);
    let path = moves(&[at(10.0, 10.0, 15.0), at(10.0, 10.0, -1.0)], Vector3::z_axis());
    let (part, _) = cut(part, &path, &end_mill(6.0, 0.0, 30.0));
    assert_eq!(top(&part, 10.2, 10.2), None);
    assert!((top(&part, 15.2, 15.2).unwrap() - 10.0).abs() < 1e-6);
}

#[test]
fn an_undercut_keeps_the_material_above_it() {
    // A tool along x cuts a tunnel in the side: z dexels have material below and above.
    let part = block([20.0, 20.0, 20.0], 0.25, DexelDirections::All);
    let path = moves(&[at(5.0, -5.0, 10.0), at(5.0, 25.0, 10.0)], -Vector3::x_axis());
    // The tool reaches from its tip at x = 5 mm towards -x.
    let (part, removals) = cut(part, &path, &end_mill(6.0, 0.0, 30.0));
    let grid = part.grids().last().unwrap();
    let spans: Vec<[f64; 2]> = grid
        .material([8, 40])
        .map(|span| span.ends.map(|end| end / MM))
        .collect();
    assert_eq!(spans.len(), 2);
    assert!(
        (spans[0][1] - 7.0).abs() < 2e-6 && (spans[1][0] - 13.0).abs() < 2e-6,
        "{spans:?}"
    );
    assert!((removals[0].volume / (5.0 * 6.0 * 20.0 * MM.powi(3)) - 1.0).abs() < 1e-6);
    assert!(part.bytes() > 0);
}

#[test]
fn the_contact_of_shank_and_holder_is_reported_and_removes_nothing() {
    // Flutes of 5 mm in a slot of 8 mm: 3 mm of the shank, which is as wide as the cutter, are in the material; the holder is above it.
    let cutter = end_mill(10.0, 0.0, 5.0);
    let shank = ToolSolid::cone([5.0 * MM, 20.0 * MM], [5.0 * MM; 2]).unwrap();
    let holder = ToolSolid::cone([20.0 * MM, 50.0 * MM], [15.0 * MM; 2]).unwrap();
    let bodies = [shank, holder];
    let tool = RotatingTool {
        cutting: &cutter,
        clear: &bodies,
    };
    let part = block([40.0, 30.0, 20.0], 0.5, DexelDirections::All);
    let path = moves(
        &[at(-10.0, 15.0, 15.5), at(10.0, 15.0, 15.5), at(10.0, 15.0, 12.0)],
        Vector3::z_axis(),
    );
    let (part, removals) = part.cut(&path, &tool, 1e-5, Watch::NONE).unwrap();
    // The first move is 4.5 mm deep: less than the flutes.
    assert_eq!(removals[0].contact, 0.0);
    // The second is 8 mm deep, where the first has already made room for the shank.
    assert!(
        removals[1].contact < 1e-8 && removals[1].volume > 0.0,
        "{removals:?}"
    );
    let deep = moves(&[at(10.0, 15.0, 12.0), at(20.0, 15.0, 12.0)], Vector3::z_axis());
    let before = part.volume();
    let (part, removals) = part.cut(&deep, &tool, 1e-5, Watch::NONE).unwrap();
    // The shank meets what is above the flutes, 3 mm along z, and up to its own diameter across.
    assert!(removals[0].contact >= 3.0 * MM - 1e-8, "{}", removals[0].contact);
    assert!((before - part.volume() - removals[0].volume).abs() < 1e-15);
    // Where no edge was the material is still there.
    assert!((top(&part, 26.2, 15.2).unwrap() - 20.0).abs() < 2e-6);
}

#[test]
fn rapids_in_material_are_known_by_what_they_remove() {
    let part = block([40.0, 30.0, 20.0], 0.5, DexelDirections::All);
    let mut path = moves(
        &[at(-10.0, 15.0, 25.0), at(50.0, 15.0, 25.0), at(-10.0, 15.0, 19.0)],
        Vector3::z_axis(),
    );
    path.iter_mut()
        .for_each(|motion: &mut ToolMove| motion.is_rapid = true);
    let (_, removals) = cut(part, &path, &end_mill(10.0, 0.0, 30.0));
    let touching: Vec<usize> = path
        .iter()
        .zip(&removals)
        .enumerate()
        .filter(|(_, (motion, removal))| removal.is_rapid_in_material(motion))
        .map(|(place, _)| place)
        .collect();
    assert_eq!(touching, [1]);
    assert_eq!(removals[0], Default::default());
}
