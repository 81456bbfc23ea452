//! `motion`: how a controller moves an arm, in a robot file or a study.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::document::{Document, Problem};

/// How a controller moves an arm. Values of the study replace those of the robot file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionTable {
    /// Greatest acceleration of each joint, base to flange; mm/s^2 for prismatic joints.
    #[schemars(inner(range(min = 0.001, max = 1e6)))]
    // unit: deg/s^2, mm/s^2
    pub joint_acceleration_deg_per_s2: Option<Vec<f64>>,
    /// Acceleration that each joint reached in a log, base to flange: its greatest acceleration is at least this; used where that is not given.
    #[schemars(inner(range(min = 0.0, max = 1e6)))]
    // unit: deg/s^2, mm/s^2
    pub joint_acceleration_reached_deg_per_s2: Option<Vec<f64>>,
    /// Greatest acceleration along the path.
    #[schemars(range(min = 1.0, max = 1e6))]
    // unit: mm/s^2
    pub path_acceleration_mm_per_s2: Option<f64>,
    /// Window over which the controller averages the command, by which it limits the jerk.
    #[schemars(range(min = 0.0, max = 1000.0))]
    // unit: ms
    pub smoothing_ms: Option<f64>,
    /// Time that the controller waits at a stop, from where its command has arrived.
    #[schemars(range(min = 0.0, max = 10000.0))]
    // unit: ms
    pub settling_ms: Option<f64>,
    /// Lead of each motor over its acceleration, base to flange: how far it is ahead of the arm by the elastic deflection of the drive that the controller compensates. Used where a
    /// log of motor positions is predicted.
    #[schemars(inner(range(min = -0.1, max = 0.1)))]
    // unit: s^2
    pub motor_lead_s2: Option<Vec<f64>>,
    /// Shortest time in which a zone is passed: smaller zones are enlarged to it at the programmed feed.
    #[schemars(range(min = 0.0, max = 1000.0))]
    // unit: ms
    pub shortest_blending_ms: Option<f64>,
    /// How late each joint follows its command, base to flange; one value stands for all.
    #[schemars(inner(range(min = 0.0, max = 1000.0)))]
    // unit: ms
    pub lag_ms: Option<Vec<f64>>,
    /// Standard uncertainty of it, one value for each joint or one for all.
    #[schemars(inner(range(min = 0.0, max = 1000.0)))]
    // unit: ms
    pub lag_u_ms: Option<Vec<f64>>,
    /// Part of the speed that is fed forward: 0 none, 1 complete, where joints are not late at constant speed.
    #[schemars(range(min = 0.0, max = 1.0))]
    // unit: -
    pub speed_feed_forward: Option<f64>,
    /// Radius of the zone at the end of a move where the program states none; 0: the tool stops there. If left out, zones round corners by
    /// `rounding_um`.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub zone_mm: Option<f64>,
    /// Largest distance of a rounded corner from the programmed one, where neither the program nor `zone_mm` gives the zone: as in programs that
    /// armill writes; 5 if left out.
    #[schemars(range(min = 0.1, max = 1e6))]
    pub rounding_um: Option<f64>,
    /// Feed where the program states none.
    #[schemars(range(min = 0.001, max = 1e6))]
    pub feed_mm_per_min: Option<f64>,
    /// Source of the values.
    pub source: Option<String>,
}

impl MotionTable {
    /// These values, with those of `other` where this table has none.
    pub fn or(&self, other: &MotionTable) -> MotionTable {
        let list = |own: &Option<Vec<f64>>, other: &Option<Vec<f64>>| own.clone().or_else(|| other.clone());
        MotionTable {
            joint_acceleration_deg_per_s2: list(
                &self.joint_acceleration_deg_per_s2,
                &other.joint_acceleration_deg_per_s2,
            ),
            joint_acceleration_reached_deg_per_s2: list(
                &self.joint_acceleration_reached_deg_per_s2,
                &other.joint_acceleration_reached_deg_per_s2,
            ),
            path_acceleration_mm_per_s2: self
                .path_acceleration_mm_per_s2
                .or(other.path_acceleration_mm_per_s2),
            smoothing_ms: self.smoothing_ms.or(other.smoothing_ms),
            settling_ms: self.settling_ms.or(other.settling_ms),
            motor_lead_s2: list(&self.motor_lead_s2, &other.motor_lead_s2),
            shortest_blending_ms: self.shortest_blending_ms.or(other.shortest_blending_ms),
            lag_ms: list(&self.lag_ms, &other.lag_ms),
            // An uncertainty belongs to its value.
            lag_u_ms: match self.lag_ms {
                Some(_) => self.lag_u_ms.clone(),
                None => list(&self.lag_u_ms, &other.lag_u_ms),
            },
            speed_feed_forward: self.speed_feed_forward.or(other.speed_feed_forward),
            zone_mm: self.zone_mm.or(other.zone_mm),
            rounding_um: self.rounding_um.or(other.rounding_um),
            feed_mm_per_min: self.feed_mm_per_min.or(other.feed_mm_per_min),
            source: self.source.clone().or_else(|| other.source.clone()),
        }
    }

    /// Problems of the table `motion` of this document, for an arm with this number of joints: lists of another length.
    pub fn problems(&self, document: &Document, joint_count: usize) -> Vec<Problem> {
        let lists = [
            (
                "joint_acceleration_deg_per_s2",
                &self.joint_acceleration_deg_per_s2,
                false,
            ),
            (
                "joint_acceleration_reached_deg_per_s2",
                &self.joint_acceleration_reached_deg_per_s2,
                false,
            ),
            ("motor_lead_s2", &self.motor_lead_s2, false),
            ("lag_ms", &self.lag_ms, true),
            ("lag_u_ms", &self.lag_u_ms, true),
        ];
        let wrong = lists.into_iter().filter_map(|(key, list, may_be_one)| {
            let count = list.as_ref()?.len();
            let fits = count == joint_count || (may_be_one && count == 1);
            let hint = if may_be_one {
                "one value for each joint, base to flange, or one for all"
            } else {
                "one value for each joint, base to flange"
            };
            (!fits).then(|| {
                let message = format!("`{key}` has {count} values, but the robot has {joint_count} joints");
                document.problem(&format!("motion.{key}"), message, Some(hint))
            })
        });
        wrong.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Document, MotionTable) {
        #[derive(Deserialize, JsonSchema)]
        struct File {
            motion: MotionTable,
        }
        let document = Document::from_bytes("cell.toml", text.as_bytes()).unwrap();
        let file: File = document.read().unwrap_or_else(|problems| panic!("{problems}"));
        (document, file.motion)
    }

    #[test]
    fn values_of_the_study_replace_those_of_the_robot_file_with_their_uncertainty() {
        let (_, study) = read("[motion]\nsmoothing_ms = 20\nlag_ms = [8]\n");
        let (_, robot) = read(
            "[motion]\nsmoothing_ms = 40\nlag_ms = [15]\nlag_u_ms = [2]\npath_acceleration_mm_per_s2 = 4600\n",
        );
        let both = study.or(&robot);
        assert_eq!(both.smoothing_ms, Some(20.0));
        assert_eq!((both.lag_ms.as_deref(), both.lag_u_ms), (Some(&[8.0][..]), None));
        assert_eq!(both.path_acceleration_mm_per_s2, Some(4600.0));
    }

    #[test]
    fn lists_of_another_length_are_refused_together() {
        let (document, table) =
            read("[motion]\njoint_acceleration_deg_per_s2 = [100]\nlag_ms = [1, 2]\nlag_u_ms = [1]\n");
        let found = table.problems(&document, 6);
        let shown: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(shown.len(), 2, "{shown:?}");
        assert!(
            shown[0].contains("cell.toml:2") && shown[0].contains("has 1 values, but the robot has 6 joints"),
            "{shown:?}"
        );
        assert!(
            shown[1].contains("cell.toml:3") && shown[1].contains("`lag_ms` has 2 values"),
            "{shown:?}"
        );
        let hints: Vec<&str> = found.iter().filter_map(|problem| problem.hint()).collect();
        assert!(
            !hints[0].contains("one for all") && hints[1].contains("one for all"),
            "{hints:?}"
        );
    }
}
