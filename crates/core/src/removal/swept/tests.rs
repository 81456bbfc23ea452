use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Point3;
use proptest::prelude::*;

use super::*;
use crate::load::EndMillBody;

const MM: f64 = 1e-3;

/// A tool by its definition, without the code under test: kind, radius, corner radius, angle, length.
#[derive(Clone, Copy, Debug)]
struct Plain {
    kind: usize,
    radius: f64,
    corner: f64,
    angle: f64,
    length: f64,
}

impl Plain {
    fn solid(&self) -> ToolSolid {
        let (d, r) = (2.0 * self.radius, self.radius);
        let body = |corner: f64| EndMillBody::new(d, corner).unwrap();
        match self.kind {
            0 => ToolSolid::end_mill(&body(0.0), self.length),
            1 => ToolSolid::end_mill(&body(r), self.length),
            2 => ToolSolid::end_mill(&body(self.corner), self.length),
            3 => ToolSolid::tapered(&body(0.0), self.angle, self.length),
            4 => ToolSolid::tapered(&body(self.corner), self.angle, self.length),
            5 => ToolSolid::tapered(&body(r), self.angle, self.length),
            _ => ToolSolid::drill(d, 2.0 * self.angle + 1.0, self.length),
        }
        .unwrap()
    }

    /// How far a point is outside, by radius alone; negative inside.
    fn outside(&self, rho: f64, h: f64) -> f64 {
        let corner = match self.kind {
            0 | 3 | 6 => 0.0,
            1 | 5 => self.radius,
            _ => self.corner,
        };
        if h < 0.0 || h > self.length {
            return f64::INFINITY;
        }
        let taper = if (3..=5).contains(&self.kind) {
            self.angle
        } else {
            0.0
        };
        if self.kind == 6 {
            return rho - (h * (self.angle + 0.5).tan()).min(self.radius);
        }
        // Below the place where the flank touches the corner there is the corner.
        let touch = corner * (1.0 - taper.sin());
        let radius = if h < touch {
            let (flat, down) = (self.radius - corner, corner - h);
            flat + (corner * corner - down * down).sqrt()
        } else {
            self.radius - corner + corner * taper.cos() + (h - touch) * taper.tan()
        };
        rho - radius
    }
}

fn plain() -> impl Strategy<Value = Plain> {
    (
        0_usize..7,
        1.0..8.0_f64,
        0.05..0.95_f64,
        0.02..0.7_f64,
        12.0..40.0_f64,
    )
        .prop_map(|(kind, radius, part, angle, length)| Plain {
            kind,
            radius: radius * MM,
            corner: part * radius * MM,
            angle,
            length: length * MM,
        })
}

impl SweptTool<'_> {
    /// Both ends.
    fn interval(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        Some([self.end(at, End::Low)?, self.end(at, End::High)?])
    }
}

/// Directions, axes of coordinates among them.
fn direction() -> impl Strategy<Value = Unit<Vector3<f64>>> {
    let any = (-1.0..1.0_f64, 0.0..TAU).prop_map(|(z, turn)| {
        let across = (1.0 - z * z).sqrt();
        Unit::new_normalize(Vector3::new(across * turn.cos(), across * turn.sin(), z))
    });
    prop_oneof![
        3 => any,
        2 => Just(Vector3::z_axis()),
        1 => Just(Vector3::x_axis()),
        1 => Just(-Vector3::y_axis()),
    ]
}

/// How far the point is outside of the tool at a time.
fn outside(tool: &Plain, axis: &Vector3<f64>, off: Vector3<f64>) -> f64 {
    let h = off.dot(axis);
    tool.outside((off - axis * h).norm(), h)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn the_interval_is_that_of_the_tool_at_many_times(
        tool in plain(),
        axis in direction(),
        motion in (direction(), 0.0..20.0_f64),
        k in 0_usize..3,
        aim in (0.0..1.0_f64, 0.0..1.1_f64, 0.0..TAU, 0.0..1.1_f64),
    ) {
        let from = Point3::new(3.0, -2.0, 5.0) * MM;
        let travel = motion.0.into_inner() * (motion.1 * MM);
        let solid = tool.solid();
        let swept = SweptTool::new(&solid, [from, from + travel], &axis, k);
        // A dexel through a point near the tool at some time.
        let e = axis.cross(&Vector3::new(0.3, -0.5, 0.8)).normalize();
        let f = axis.cross(&e);
        let out = (e * aim.2.cos() + f * aim.2.sin()) * (aim.1 * solid.radius());
        let through = from + travel * aim.0 + axis.into_inner() * (aim.3 * tool.length) + out;
        let [i, j] = across(k);
        let at = [through[i], through[j]];
        let point = |s: f64| {
            let mut point = through;
            point[k] = s;
            point
        };
        let times = 600;
        let off = |s: f64, t: i32| point(s) - from - travel * (f64::from(t) / f64::from(times));
        let touches = |s: f64| (0..=times).any(|t| outside(&tool, &axis, off(s, t)) <= -1e-9);
        match swept.interval(at) {
            None => {
                // No point of the dexel is inside at any time.
                for step in -400..=400 {
                    prop_assert!(!touches(through[k] + 0.1 * MM * f64::from(step)));
                }
            }
            Some([low, high]) => {
                prop_assert!(low <= high + 1e-12);
                // Beyond an end no point is inside.
                for step in 0..40 {
                    let beyond = 1e-9 * 1.5_f64.powi(step);
                    prop_assert!(!touches(low - beyond), "{low} is too high by {beyond}");
                    prop_assert!(!touches(high + beyond), "{high} is too low by {beyond}");
                }
                // The ends are inside at some time: the least of a convex function, by golden section on the distance from
                // the tool made larger.
                for (s, inward) in [(low, 1.0), (high, -1.0)] {
                    let inner = s + inward * (high - low).min(1e-7);
                    prop_assert!(is_reached(&tool, &axis, &|t| point(inner) - from - travel * t), "{s}");
                }
            }
        }
    }
}

/// Whether the point is within 0.2 um of the tool at some time: by the distance to the tool, which is convex in time.
fn is_reached(tool: &Plain, axis: &Vector3<f64>, off: &dyn Fn(f64) -> Vector3<f64>) -> bool {
    let outline: Vec<[f64; 2]> = (0..=40_000)
        .map(|n| {
            // Denser near the tip, where the outline of a ball is level.
            let part = f64::from(n) / 40_000.0;
            let h = tool.length * part * part;
            [h, -tool.outside(0.0, h)]
        })
        .collect();
    let distance = |t: f64| {
        let off = off(t);
        let h = off.dot(axis);
        let rho = (off - axis * h).norm();
        if tool.outside(rho, h) <= 0.0 {
            return 0.0;
        }
        let near_2 = |[height, radius]: &[f64; 2]| (rho - radius).max(0.0).powi(2) + (h - height).powi(2);
        outline.iter().map(near_2).fold(f64::INFINITY, f64::min).sqrt()
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let (one, other) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        let (first, second) = (distance(one), distance(other));
        // The samples of the outline are up to 2 um apart in height.
        if first.min(second) < 2e-6 {
            return true;
        }
        if first < second {
            high = other;
        } else {
            low = one;
        }
    }
    distance(0.5 * (low + high)).min(distance(0.0)).min(distance(1.0)) < 2e-6
}

fn end_mill(diameter: f64, corner: f64) -> ToolSolid {
    ToolSolid::end_mill(&EndMillBody::new(diameter * MM, corner * MM).unwrap(), 30.0 * MM).unwrap()
}

#[test]
fn a_ball_on_an_oblique_move_sweeps_a_cylinder_with_its_axis_along_the_move() {
    let ball = end_mill(10.0, 5.0);
    let (from, to) = (Point3::origin(), Point3::new(30.0, 40.0, 20.0) * MM);
    let swept = SweptTool::new(&ball, [from, to], &Vector3::z_axis(), 2);
    // The dexel over the middle of the move: the lowest point of a cylinder of 5 mm about a line that rises by 20 in 50 is
    // 5 / cos(slope) below the line of centres, which is 5 mm above that of the tips.
    let slope = (20.0_f64 / 50.0).atan();
    let expected = (10.0 + 5.0 - 5.0 / slope.cos()) * MM;
    let low = swept.end([15.0 * MM, 20.0 * MM], End::Low).unwrap();
    assert!((low - expected).abs() < 1e-15, "{low}");
}

#[test]
fn a_plunge_is_the_tool_at_rest_longer_by_the_move() {
    let bull = end_mill(12.0, 2.0);
    let swept = SweptTool::new(
        &bull,
        [Point3::new(0.0, 0.0, 0.04), Point3::origin()],
        &Vector3::z_axis(),
        2,
    );
    // 1 mm out on the corner: r - sqrt(r^2 - 1^2) above the tip.
    let [low, high] = swept.interval([5.0 * MM, 0.0]).unwrap();
    assert!((low - (2.0 - 3.0_f64.sqrt()) * MM).abs() < 1e-15 && (high - 0.07).abs() < 1e-15);
    assert_eq!(swept.interval([6.001 * MM, 0.0]), None);
}

#[test]
fn a_tool_on_its_side_cuts_with_the_length_of_its_flutes() {
    let flat = end_mill(10.0, 0.0);
    let swept = SweptTool::new(
        &flat,
        [Point3::origin(), Point3::new(0.0, 0.05, 0.0)],
        &Vector3::x_axis(),
        0,
    );
    // The tool fills x from 0 to 30 mm where a point of the dexel is within 5 mm of the line of the axis.
    assert_eq!(swept.interval([0.02, 3.0 * MM]), Some([0.0, 0.03]));
    assert_eq!(swept.interval([0.02, 5.1 * MM]), None);
    let angle = FRAC_PI_2 - 0.3;
    let axis = Unit::new_normalize(Vector3::new(angle.cos(), 0.0, angle.sin()));
    let turned = SweptTool::new(&flat, [Point3::origin(), Point3::new(0.0, 0.05, 0.0)], &axis, 2);
    // Below its axis a cylinder is a cylinder: R / sin across, and its lower end is the rim.
    let low = turned.end([0.0, 0.02], End::Low).unwrap();
    assert!((low - 0.0).abs() < 1e-12, "{low}");
}
