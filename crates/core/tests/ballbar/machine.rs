//! A simulated machine with two axes that moves on a circle: positions, independent of the evaluation.

use std::f64::consts::TAU;

use armill_core::measure::ballbar::{CircularTest, Direction, Run};

/// Errors of the machine and of the set-up; lengths in m, angles in rad.
#[derive(Clone, Copy, Debug, Default)]
pub struct Machine {
    /// Scale errors of both axes.
    pub scale: [f64; 2],
    /// Angle between the positive axes, beyond a right one.
    pub squareness: f64,
    /// Gap of both axes: the axis lags behind by half of it.
    pub gap: [f64; 2],
    /// How long both axes lag behind, s, at 0.1 m/s.
    pub late: [f64; 2],
    /// Centre of the path from that of the bar.
    pub offset: [f64; 2],
    /// Cyclic error of both axes: amplitude and period.
    pub cyclic: [[f64; 2]; 2],
    /// Three lobes.
    pub lobes: f64,
    /// Standard deviation of a sample.
    pub noise: f64,
    /// Standard deviation of scale and offset from run to run, m at the circle.
    pub drift: f64,
}

pub const RADIUS: f64 = 0.1;
const SPEED: f64 = 0.1;

/// Random numbers of a seed: SplitMix64.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal, of standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.even()).ln()).sqrt();
        radius * (TAU * self.even()).cos()
    }
}

impl Machine {
    /// Position of the tool when the drives are commanded to `angle` of the circle.
    fn place(&self, angle: f64, sign: f64) -> [f64; 2] {
        // Each drive is at the position commanded some time before.
        let given = [0, 1].map(|axis| {
            let late = angle - sign * SPEED / RADIUS * self.late[axis];
            RADIUS * if axis == 0 { late.cos() } else { late.sin() }
        });
        let speed = [-sign * angle.sin(), sign * angle.cos()];
        let axis = |k: usize| {
            let [height, period] = self.cyclic[k];
            let wave = if height == 0.0 {
                0.0
            } else {
                height * (TAU * given[k] / period).sin()
            };
            given[k] * (1.0 + self.scale[k]) - 0.5 * self.gap[k] * speed[k].signum() + wave
        };
        let [x, y] = [axis(0), axis(1)];
        [x - self.squareness * y, y]
    }

    /// A run of one turn from `start_deg` on, as the bar shows it.
    pub fn run(&self, direction: Direction, (start_deg, count): (f64, usize), random: &mut Random) -> Run {
        let sign = direction.sign();
        let [grown, east, north] = [0, 1, 2].map(|_| self.drift * random.normal());
        let sample = |k: usize| {
            // Half a step from the reversals: there a sample is on neither side.
            let angle = start_deg.to_radians() + sign * TAU * (k as f64 + 0.5) / count as f64;
            let [x, y] = self.place(angle, sign);
            let place = [x + self.offset[0] + east, y + self.offset[1] + north];
            let lobes = self.lobes * (3.0 * angle).cos();
            (angle, place[0].hypot(place[1]) - RADIUS + grown + lobes)
        };
        let (angle, exact): (Vec<f64>, Vec<f64>) = (0..count).map(sample).unzip();
        let deviation = exact.into_iter().map(|dr| dr + self.noise * random.normal());
        Run::new(direction, angle, deviation.collect()).unwrap()
    }

    /// So many runs of each direction, one after the other.
    pub fn test(&self, runs: [usize; 2], count: usize, seed: u64) -> CircularTest {
        let mut random = Random(seed);
        let runs = Direction::BOTH.iter().zip(runs);
        let runs = runs.flat_map(|(direction, runs)| std::iter::repeat_n(*direction, runs));
        let runs = runs.map(|direction| self.run(direction, (0.0, count), &mut random));
        CircularTest::new(RADIUS, runs.collect()).unwrap()
    }
}
