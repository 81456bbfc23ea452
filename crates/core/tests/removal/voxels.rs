//! Random cuts against points that are tested one by one: inside of the tool, at many times of each move. Shares no code with the part.

use std::f64::consts::TAU;

use armill_core::load::EndMillBody;
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::removal::{DexelDirections, DexelPart, RotatingTool, ToolMove, ToolSolid};
use armill_core::watch::Watch;

use super::{MM, block};

/// Numbers from 0 to 1, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // The generator of Lehmer with the constants of Knuth; its upper bits.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn direction(&mut self, most: f64) -> Unit<Vector3<f64>> {
        let (tilt, turn) = (self.between(0.0, most), self.between(0.0, TAU));
        Unit::new_normalize(Vector3::new(
            tilt.sin() * turn.cos(),
            tilt.sin() * turn.sin(),
            tilt.cos(),
        ))
    }
}

/// Radius, corner, half angle of the taper, length; mm and rad.
#[derive(Clone, Copy)]
struct Shape([f64; 4]);

impl Shape {
    /// How far a point at the distance `rho` from the axis and the height `h` is out of the tool, at least: negative inside.
    fn distance(&self, rho: f64, h: f64) -> f64 {
        let [radius, corner, taper, length] = self.0;
        let (sin, cos) = taper.sin_cos();
        let disc = radius - corner;
        // The solid is the intersection of what is below its top, within its flank, above its bottom, and, below the end of the
        // corner, within the enlarged disc.
        let flank = (rho - disc - corner * cos - (h - corner * (1.0 - sin)) * sin / cos) * cos;
        let mut distance = flank.max(h - length).max(-h);
        if rho > disc && h < corner * (1.0 - sin) {
            distance = distance.max((rho - disc).hypot(h - corner) - corner);
        }
        distance
    }
}

/// The least distance of a point from the tool on a move, at this number of times.
fn least(shape: &Shape, motion: &ToolMove, point: &Point3<f64>, times: usize) -> f64 {
    let turn = motion.axes[0].dot(&motion.axes[1]).clamp(-1.0, 1.0).acos();
    let mut least = f64::INFINITY;
    for n in 0..=times {
        let t = n as f64 / times as f64;
        let tip = motion.ends[0] + (motion.ends[1] - motion.ends[0]) * t;
        let axis = if turn < 1e-6 {
            motion.axes[0].into_inner()
        } else {
            (motion.axes[0].into_inner() * ((1.0 - t) * turn).sin()
                + motion.axes[1].into_inner() * (t * turn).sin())
                / turn.sin()
        };
        let off = (point - tip) / MM;
        let h = off.dot(&axis);
        least = least.min(shape.distance((off - axis * h).norm(), h));
    }
    least
}

/// Cuts random moves and compares points on the dexels of all directions; `slack` mm is not decided.
fn compare(seed: u64, tilt: f64, turn: f64, tolerance: f64) {
    let mut numbers = Numbers(seed);
    let radius = numbers.between(1.5, 4.0);
    let corner = [0.0, radius, 0.4 * radius][seed as usize % 3];
    let taper = [0.0, 0.2][seed as usize / 3 % 2];
    let shape = Shape([radius, corner, taper, 15.0]);
    let body = EndMillBody::new(2.0 * radius * MM, corner * MM).unwrap();
    let tool = ToolSolid::tapered(&body, taper, 15.0 * MM).unwrap();
    let path: Vec<ToolMove> = (0..12)
        .map(|index| {
            let mut point = || {
                Point3::new(
                    numbers.between(0.0, 20.0),
                    numbers.between(0.0, 20.0),
                    numbers.between(2.0, 16.0),
                ) * MM
            };
            let ends = [point(), point()];
            let first = numbers.direction(tilt);
            let other = first.into_inner() + numbers.direction(3.0).into_inner() * turn;
            ToolMove {
                ends,
                axes: [
                    first,
                    if turn > 0.0 {
                        Unit::new_normalize(other)
                    } else {
                        first
                    },
                ],
                index,
                is_rapid: false,
            }
        })
        .collect();
    let part = block([20.0, 20.0, 14.0], 0.4, DexelDirections::All);
    let cutting = RotatingTool {
        cutting: &tool,
        clear: &[],
    };
    let (part, _) = part.cut(&path, &cutting, tolerance * MM, Watch::NONE).unwrap();
    let times = 600;
    // Between two times a point of the tool moves by less than the longest move and the longest tool over their number.
    let slack = tolerance + (30.0 + 16.0 * turn * 1.2) / times as f64 / 2.0 + 1e-4;
    let (mut decided, mut removed) = (0, 0);
    for _ in 0..1500 {
        let (k, point) = on_a_dexel(&part, &mut numbers);
        let outside = path
            .iter()
            .map(|motion| least(&shape, motion, &point, times))
            .fold(f64::INFINITY, f64::min);
        let found = is_material(&part, k, &point);
        if outside.abs() > slack {
            decided += 1;
            removed += usize::from(!found);
            assert_eq!(found, outside > 0.0, "{seed}: {point:?} along {k}, {outside} mm");
        }
    }
    assert!(decided > 1000 && removed > 50, "{decided} {removed}");
}

/// A random point on a dexel of a random direction.
fn on_a_dexel(part: &DexelPart, numbers: &mut Numbers) -> (usize, Point3<f64>) {
    let k = (numbers.next() * 3.0) as usize;
    let grid = &part.grids()[k];
    let cell = grid.cells().map(|count| (numbers.next() * count as f64) as usize);
    let at = grid.at(cell);
    let [low, high] = part.corners();
    let along = numbers.between(low[k], high[k]);
    let point = match k {
        0 => Point3::new(along, at[0], at[1]),
        1 => Point3::new(at[0], along, at[1]),
        _ => Point3::new(at[0], at[1], along),
    };
    (k, point)
}

fn is_material(part: &DexelPart, k: usize, point: &Point3<f64>) -> bool {
    let grid = &part.grids()[k];
    let across: Vec<usize> = (0..3).filter(|axis| *axis != k).collect();
    let [low, high] = part.corners();
    let cell = [0, 1].map(|n| {
        let axis = across[n];
        ((point[axis] - low[axis]) / (high[axis] - low[axis]) * grid.cells()[n] as f64) as usize
    });
    grid.material(cell)
        .any(|span| span.ends[0] < point[k] && point[k] < span.ends[1])
}

#[test]
fn upright_tools_cut_what_points_say() {
    for seed in 1..=6 {
        compare(seed, 0.0, 0.0, 1e-4);
    }
}

#[test]
fn tilted_tools_cut_what_points_say() {
    for seed in 1..=12 {
        compare(seed, 1.5, 0.0, 1e-4);
    }
}

#[test]
fn turning_tools_cut_what_points_say_within_the_tolerance() {
    for seed in 1..=6 {
        compare(seed, 0.6, 0.3, 0.05);
    }
}
