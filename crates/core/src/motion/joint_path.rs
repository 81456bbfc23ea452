//! Joint positions along a path, with their derivatives by its length.
//!
//! ```text
//! q'(s_i)  = ((q_i - q_{i-1}) b / a + (q_{i+1} - q_i) a / b) / (a + b)          a = s_i - s_{i-1},  b = s_{i+1} - s_i
//! q''(s_i) = 2 ((q_{i+1} - q_i) / b - (q_i - q_{i-1}) / a) / (a + b)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s` | length along the path | m |
//! | `q` | joint positions | rad (m) |
//!
//! Exact for parabolas. At a stop the derivatives are those of the step after it: there the direction may change at once, with no speed.

/// Joint positions along a path.
#[derive(Clone, Debug)]
pub struct JointPath {
    joints: usize,
    along: Vec<f64>,
    stops: Vec<bool>,
    /// `q'` at the beginning of the step after each point, point after point; at the last that of the step before.
    slopes: Vec<f64>,
    /// `q''` there.
    curvatures: Vec<f64>,
}

impl JointPath {
    /// A path through these positions, rad (m), `joints` values a point, at these lengths, m, which rise; it stops at some points, and at
    /// the first and the last.
    ///
    /// # Panics
    /// If the numbers of values do not belong together, there are fewer than two points, or a length does not rise.
    pub fn new(
        joints: usize,
        positions: &[f64],
        along: Vec<f64>,
        is_stop: impl Fn(usize) -> bool,
    ) -> JointPath {
        let count = along.len();
        assert!(count >= 2, "two points");
        assert_eq!(positions.len(), joints * count, "positions of every point");
        assert!(along.is_sorted_by(|a, b| a < b), "lengths that rise");
        let stops: Vec<bool> = (0..count)
            .map(|index| index == 0 || index + 1 == count || is_stop(index))
            .collect();
        let mut path = JointPath {
            joints,
            along,
            stops,
            slopes: vec![0.0; joints * count],
            curvatures: vec![0.0; joints * count],
        };
        let at = |index: usize, joint: usize| positions[index * joints + joint];
        for index in 0..count {
            for joint in 0..joints {
                let slope = |from: usize| (at(from + 1, joint) - at(from, joint)) / path.step(from);
                let place = index * joints + joint;
                let sides = [index.checked_sub(1), (index + 1 < count).then_some(index)];
                let [before, after] = sides.map(|from| from.map(slope));
                let both = before.zip(after).filter(|_| !path.stops[index]);
                if let Some((before, after)) = both {
                    let (a, b) = (path.step(index - 1), path.step(index));
                    path.slopes[place] = (before * b + after * a) / (a + b);
                    path.curvatures[place] = 2.0 * (after - before) / (a + b);
                } else {
                    path.slopes[place] = after.or(before).unwrap_or(0.0);
                }
            }
        }
        path
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.along.len()
    }

    /// Whether there is no point: never.
    pub fn is_empty(&self) -> bool {
        self.along.is_empty()
    }

    /// Length of the path up to each point, m.
    pub fn along(&self) -> &[f64] {
        &self.along
    }

    /// Distance from a point to the next one, m.
    pub fn step(&self, index: usize) -> f64 {
        self.along[index + 1] - self.along[index]
    }

    /// Whether the arm stops at a point.
    pub fn stops(&self, index: usize) -> bool {
        self.stops[index]
    }

    /// First and second derivative of every joint at the beginning of the step after a point, rad/m (1) and rad/m^2 (1/m).
    pub(super) fn after(&self, index: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let range = index * self.joints..(index + 1) * self.joints;
        let slopes = self.slopes[range.clone()].iter().copied();
        slopes.zip(self.curvatures[range].iter().copied())
    }
}
