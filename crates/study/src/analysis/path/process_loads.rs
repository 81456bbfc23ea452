//! What the cut asks of tool and spindle at each point of a path: force, torque, chip thickness, removal rate.
//!
//! The force is that at force-deflection equilibrium; torque, chip and removal rate are those of the nominal cut.

use armill_core::load::{Cut, Milling, PathLoad};
use armill_core::path::{Cutting, Pace, Track};

/// Steps of a period at which the greatest torque is sought.
const TORQUE_STEPS: u32 = 360;
/// From this part of the radius of the cutter on a chip is thick. Teeth move on trochoids; as circles they have a chip that is wrong by a
/// tenth of the feed per tooth there: `c / 2R`, at the side of the tool.
const THICK: f64 = 0.2;

/// Process values along a path; not a number where nothing is cut or the force is not known.
#[derive(Clone, Debug, Default)]
pub struct ProcessLoads {
    /// Of each point.
    pub points: Vec<ProcessPoint>,
    /// Greatest torque within a revolution where its mean is largest, N m.
    pub greatest_torque: f64,
    /// Number of points with a thick chip.
    pub thick: usize,
    /// The first of them.
    pub first_thick: Option<usize>,
}

/// Process values at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProcessPoint {
    /// Size of the mean force of a revolution, N.
    pub force: f64,
    /// Mean torque of a revolution, N m.
    pub torque: f64,
    /// Largest chip thickness, m.
    pub chip: f64,
    /// Material removal rate, m³/s; not a number where the speed is not known.
    pub removal_rate: f64,
}

/// Nothing is cut.
const NOTHING: ProcessPoint = ProcessPoint {
    force: f64::NAN,
    torque: f64::NAN,
    chip: f64::NAN,
    removal_rate: f64::NAN,
};

impl ProcessLoads {
    /// Those of a cut along `track` under `load`; `None` if the load is not from a cut.
    pub fn of(cutting: &Cutting, track: &Track, load: &PathLoad) -> Option<ProcessLoads> {
        let PathLoad::Cuts(cuts) = load else { return None };
        let mut points = Vec::with_capacity(track.len());
        // Consecutive points mostly have the same cut.
        let mut last: Option<(usize, Cut, [f64; 2])> = None;
        let mut hardest: Option<(f64, Milling)> = None;
        let (mut thick, mut first_thick) = (0, None);
        for (index, (here, point)) in cuts.points.iter().zip(&track.path.points).enumerate() {
            let Some(cut) = here.cut else {
                points.push(NOTHING);
                continue;
            };
            let known = last.filter(|(cutter, before, _)| (*cutter, *before) == (here.cutter, cut));
            let [torque, chip] = match known {
                Some((.., values)) => values,
                None => match Milling::new(cuts.cutters[here.cutter], cutting.law, cut) {
                    Ok(milling) => {
                        let values = [milling.mean_torque(), milling.largest_chip()];
                        if hardest.is_none_or(|(torque, _)| values[0] > torque) {
                            hardest = Some((values[0], milling));
                        }
                        last = Some((here.cutter, cut, values));
                        values
                    }
                    Err(_) => [f64::NAN; 2],
                },
            };
            if chip > THICK * 0.5 * cuts.cutters[here.cutter].diameter() {
                thick += 1;
                first_thick.get_or_insert(index);
            }
            let speed = match point.pace {
                Pace::Feed(speed) => Some(speed),
                Pace::Rapid | Pace::Unknown => cutting.feed,
            };
            points.push(ProcessPoint {
                force: here.mean.norm(),
                torque,
                chip,
                removal_rate: speed.map_or(f64::NAN, |speed| cut.removal_rate(speed)),
            });
        }
        Some(ProcessLoads {
            points,
            greatest_torque: hardest.map_or(0.0, |(_, milling)| milling.greatest_torque(TORQUE_STEPS)),
            thick,
            first_thick,
        })
    }

    /// The largest value of the points; zero without any.
    pub fn largest(&self, of: impl Fn(&ProcessPoint) -> f64) -> f64 {
        self.points.iter().map(of).fold(0.0, f64::max)
    }
}
