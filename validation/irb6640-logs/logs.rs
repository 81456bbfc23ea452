//! The logs of an ABB IRB 6640, each predicted from one of its kind.

use std::path::Path;

use armill_formats::robot::{RobotDescription, armill};
use armill_measure::motion::answer::StretchAnswer;
use armill_measure::motion::{MotionAnswer, NamedLog, Question, answer, learn, read};

/// Lengths of an IRB 6600-225/2.55, whose forward kinematics make the logged moves straight.
const IRB: &str = r#"format = 1
name = "ABB IRB 6600-225/2.55"

[chain]
source = "ros"
motions = [
  { along = "z", length_mm = 780 },
  { about = "z", joint = "J1" },
  { along = "x", length_mm = 320 },
  { about = "y", joint = "J2" },
  { along = "z", length_mm = 1075 },
  { about = "y", joint = "J3" },
  { along = "z", length_mm = 200 },
  { about = "x", joint = "J4" },
  { along = "x", length_mm = 1142 },
  { about = "y", joint = "J5" },
  { along = "x", length_mm = 200 },
  { about = "x", joint = "J6" },
]
JOINTS
[sources.ros]
what = "lengths and joint speeds"
where = "abb_irb6600_support, irb6600_225_255_macro.xacro"
licence = "BSD"
"#;

/// Zones of the logs at each speed, mm.
const ZONES: [(&str, f64); 4] = [("fine", 0.0), ("z1", 1.0), ("z10", 10.0), ("z20", 20.0)];

fn irb() -> RobotDescription {
    let joints: String = [100, 90, 90, 150, 120, 190]
        .iter()
        .enumerate()
        .map(|(k, speed)| {
            format!(
                "[[joint]]\nname = \"J{}\"\nsign = 1\nmax_speed_deg_per_s = {speed}\nsource = \"ros\"\n",
                k + 1
            )
        })
        .collect();
    armill::read("irb.toml", "irb", &IRB.replace("JOINTS", &joints))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

/// The predictions of the other logs of a kind, learnt from its log at 500 mm/s with stops: name and stretch.
pub(crate) fn predictions(
    folder: &Path,
    [learnt_from, kind]: [&str; 2],
) -> (MotionAnswer, Vec<(String, StretchAnswer)>) {
    let found = irb();
    let names: Vec<(String, f64)> = ["500", "50"]
        .iter()
        .flat_map(|speed| ZONES.map(|(zone, radius)| (format!("v{speed}_{zone}"), radius)))
        .collect();
    let question = Question {
        zones: names.iter().skip(1).map(|(_, radius)| radius * 1e-3).collect(),
        ..Question::default()
    };
    let log = |kind: &str, name: &str| {
        let path = folder.join(format!("{kind}_movel_30_car_{name}.csv"));
        read(&path, &found.robot, &question).unwrap_or_else(|error| panic!("{error}"))
    };
    let learned =
        learn(&found, log(learnt_from, &names[0].0), &question).unwrap_or_else(|error| panic!("{error}"));
    let others: Vec<NamedLog> = names.iter().skip(1).map(|(name, _)| log(kind, name)).collect();
    let given = answer(&found.robot, &learned, &others, &question).unwrap_or_else(|error| panic!("{error}"));
    let stretches = names.iter().zip(&given.compared).map(|((name, _), compared)| {
        assert_eq!(compared.stretches.len(), 1, "{kind} {name}");
        (name.clone(), compared.stretches[0].clone())
    });
    let stretches = stretches.collect();
    (given, stretches)
}
