//! Joint compliances assumed by the size of a robot, if none are known: wide uncertainty, marked in every result.
//!
//! The values are derived from the robots of the library whose stiffness is published. For each joint
//!
//! `c = (product of c_k)^(1/n)`, `f = max_k max(c_k / c, c / c_k)`, at least [`LEAST_FACTOR`], `u = (f - 1) c`
//!
//! | class | payload | from |
//! |---|---|---|
//! | light | up to 20 kg | only Yaskawa MH12; `f` is the widest of the heavy class, because one robot has no spread |
//! | medium | 20 to 100 kg | nothing published: `c` is midway between light and heavy in the logarithm, `f` covers both |
//! | heavy | 100 to 300 kg | FANUC R-2000iC, KUKA KR 210 R2700 extra, Staubli TX200 |
//!
//! Meaning and limits of use: `docs/theory/compliance-classes.md`.

use armill_core::robot::{JointCompliance, Robot};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::StudyError;
use crate::library;

/// A class of robots by payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ComplianceClass {
    /// Up to 20 kg.
    Light,
    /// 20 to 100 kg.
    Medium,
    /// 100 to 300 kg.
    Heavy,
}

/// Least uncertainty of a class value, as a factor: published robots of one class differ by as much in
/// a joint, and a robot that was not measured may be outside them.
pub const LEAST_FACTOR: f64 = 2.0;

/// Robots of the light class.
const LIGHT: &[&str] = &["yaskawa/mh12"];
/// Robots of the heavy class.
const HEAVY: &[&str] = &["fanuc/r2000ic", "kuka/kr210r2700extra", "staubli/tx200"];

/// Sources of the numbers of a class, for the report.
const MADE_OF: &str = "geometric mean of published robots (Yaskawa MH12; FANUC R-2000iC, KUKA KR 210 R2700 extra, Staubli TX200), see docs/theory/compliance-classes.md";

/// A class value of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassValue {
    /// Compliance, rad/(N m).
    pub value: f64,
    /// By which factor it may be wrong, either way.
    pub factor: f64,
}

impl ComplianceClass {
    /// Every class, lightest first.
    pub const ALL: [ComplianceClass; 3] = [
        ComplianceClass::Light,
        ComplianceClass::Medium,
        ComplianceClass::Heavy,
    ];

    /// Its name in files and options.
    pub fn name(self) -> &'static str {
        match self {
            ComplianceClass::Light => "light",
            ComplianceClass::Medium => "medium",
            ComplianceClass::Heavy => "heavy",
        }
    }

    /// The class of this name.
    ///
    /// # Errors
    /// The names there are.
    pub fn named(name: &str) -> Result<ComplianceClass, StudyError> {
        let found = ComplianceClass::ALL
            .into_iter()
            .find(|class| class.name() == name);
        found.ok_or_else(|| {
            let message = format!("`{name}` is not a class of compliances");
            StudyError::value(message, CLASSES)
        })
    }

    /// The class of robots with this payload, kg.
    pub fn of_payload(kg: f64) -> ComplianceClass {
        match kg {
            kg if kg <= 20.0 => ComplianceClass::Light,
            kg if kg <= 100.0 => ComplianceClass::Medium,
            _ => ComplianceClass::Heavy,
        }
    }

    /// Its six values, base to flange.
    ///
    /// # Errors
    /// A robot of the library that cannot be read: a defect of the library.
    pub fn values(self) -> Result<[ClassValue; 6], StudyError> {
        let heavy = mean_and_spread(HEAVY)?;
        let widest = heavy
            .iter()
            .map(|joint| joint.factor)
            .fold(LEAST_FACTOR, f64::max);
        let light = mean_and_spread(LIGHT)?.map(|joint| ClassValue {
            factor: widest,
            ..joint
        });
        Ok(match self {
            ComplianceClass::Light => light,
            ComplianceClass::Heavy => heavy,
            ComplianceClass::Medium => std::array::from_fn(|i| {
                let value = (light[i].value * heavy[i].value).sqrt();
                ClassValue {
                    value,
                    factor: factor_between(value, light[i].value).max(LEAST_FACTOR),
                }
            }),
        })
    }

    /// Its compliances for `robot`, with `u = (factor - 1) c` as standard uncertainty. Prismatic joints in front of the arm
    /// are rigid.
    ///
    /// # Errors
    /// A robot with another structure than six revolute joints, on prismatic ones or not.
    pub fn compliance_of(self, robot: &Robot) -> Result<Vec<JointCompliance>, StudyError> {
        let joints = robot.joints().len();
        let rails = rails(robot);
        if joints != rails + 6 || (rails..joints).any(|joint| robot.slides(joint)) {
            let message = format!(
                "class {} gives the compliances of six revolute joints, but `{}` has {joints} joints of another structure",
                self.name(),
                robot.name()
            );
            return Err(StudyError::value(message, "give the compliance of each joint"));
        }
        let rigid = JointCompliance {
            value: 0.0,
            standard_uncertainty: 0.0,
        };
        let joint = |joint: ClassValue| JointCompliance {
            value: joint.value,
            standard_uncertainty: (joint.factor - 1.0) * joint.value,
        };
        let arm = self.values()?.map(joint);
        Ok(std::iter::repeat_n(rigid, rails).chain(arm).collect())
    }

    /// The caution in every result of `robot` with compliances of this class.
    ///
    /// # Errors
    /// As [`ComplianceClass::values`].
    pub fn caution(self, robot: &Robot) -> Result<String, StudyError> {
        let factors = self.values()?.map(|joint| joint.factor);
        let (least, most) = factors.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), f| {
            (least.min(*f), most.max(*f))
        });
        let factor = if most - least < 0.05 {
            format!("{least:.1}")
        } else {
            format!("{least:.1} to {most:.1}")
        };
        let names = robot.joints().iter().take(rails(robot));
        let names: Vec<&str> = names.map(|joint| joint.name.as_str()).collect();
        let rigid = match names.is_empty() {
            true => String::new(),
            false => format!(
                " No class has prismatic joints: {} is taken as rigid.",
                names.join(", ")
            ),
        };
        Ok(format!(
            "The joint compliances are assumed, not measured: values of the class {}, each of which may be wrong by a factor of {factor}. Use them to compare postures and placements, not to predict absolute deviations.{rigid}",
            self.name()
        ))
    }

    /// Source of its numbers.
    pub fn source(self) -> String {
        format!("class {}: {MADE_OF}", self.name())
    }
}

/// The classes, as a hint.
pub const CLASSES: &str =
    "classes by payload: \"light\" (up to 20 kg), \"medium\" (20 to 100 kg), \"heavy\" (100 to 300 kg)";

/// Number of prismatic joints in front of the arm, such as that of a rail.
fn rails(robot: &Robot) -> usize {
    let joints = 0..robot.joints().len();
    joints.take_while(|joint| robot.slides(*joint)).count()
}

/// Geometric mean over the robots and the largest factor from it to one of them, joint by joint.
fn mean_and_spread(arms: &[&str]) -> Result<[ClassValue; 6], StudyError> {
    let known: Vec<Vec<f64>> = arms
        .iter()
        .map(|arm| compliances(arm))
        .collect::<Result<_, _>>()?;
    let of_joint = |joint: usize| known.iter().map(move |arm| arm[joint]);
    Ok(std::array::from_fn(|joint| {
        let logarithms: f64 = of_joint(joint).map(f64::ln).sum();
        let value = (logarithms / known.len() as f64).exp();
        let spread = of_joint(joint).map(|c| factor_between(c, value));
        ClassValue {
            value,
            factor: spread.fold(LEAST_FACTOR, f64::max),
        }
    }))
}

/// Ratio of the two, as a factor of at least 1.
fn factor_between(a: f64, b: f64) -> f64 {
    (a / b).max(b / a)
}

/// The six drive compliances of a library robot, rad/(N m).
///
/// # Errors
/// It is not there, does not read, or has not six of them above 0: a defect of the library.
fn compliances(arm: &str) -> Result<Vec<f64>, StudyError> {
    let missing = || {
        StudyError::value(
            format!("library robot {arm} lacks its compliance"),
            "a fault of armill: please report it",
        )
    };
    let found = library::robot(arm).ok_or_else(missing)??;
    let values: Vec<f64> = found
        .robot
        .compliance()
        .unwrap_or_default()
        .iter()
        .map(|c| c.value)
        .collect();
    if values.len() == 6 && values.iter().all(|c| *c > 0.0) {
        Ok(values)
    } else {
        Err(missing())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heavy_robots_are_within_the_stated_factor() {
        // 1 / k of the publications, N m/rad: Liu et al. 2026; GBT-ADL set 28N6; Huynh et al. 2020 (kz).
        let published = [
            [
                9.339_417_6e5,
                4.129_256_1e6,
                1.907_534_1e6,
                2.332_046_0e5,
                4.043_588_3e5,
                7.961_815_9e4,
            ],
            [2.2072e6, 3.3767e6, 2.7757e6, 2.3502e6, 2.1575e6, 4.6706e5],
            [2.3e6, 8.6e6, 2.8e6, 3.0e6, 0.2e6, 0.9e6],
        ];
        let class = ComplianceClass::Heavy.values().unwrap();
        for stiffness in published {
            for (joint, k) in class.iter().zip(stiffness) {
                let off = factor_between(joint.value, 1.0 / k);
                assert!(off <= joint.factor * (1.0 + 1e-4), "{off} of {}", joint.factor);
            }
        }
    }

    #[test]
    fn mean_of_the_heavy_class_is_that_of_its_stiffness() {
        let mean = (9.339_417_6e5 * 2.2072e6 * 2.3e6_f64).cbrt();
        let found = ComplianceClass::Heavy.values().unwrap()[0].value;
        assert!((found * mean - 1.0).abs() < 1e-4);
    }

    #[test]
    fn light_is_the_mh12_and_medium_is_between() {
        let [light, medium, heavy] = ComplianceClass::ALL.map(|class| class.values().unwrap());
        let mh12 = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
        for joint in 0..6 {
            assert!((light[joint].value / mh12[joint] - 1.0).abs() < 1e-12);
            assert!(light[joint].value > medium[joint].value && medium[joint].value > heavy[joint].value);
            for class in [light, heavy] {
                let off = factor_between(class[joint].value, medium[joint].value);
                assert!(off <= medium[joint].factor * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn no_class_value_is_known_better_than_to_a_factor_of_two() {
        for class in ComplianceClass::ALL {
            let arm = library::robot("kuka/kr120r2500pro").unwrap().unwrap().robot;
            for joint in class.compliance_of(&arm).unwrap() {
                assert!(joint.standard_uncertainty >= joint.value);
            }
        }
    }

    #[test]
    fn the_theory_page_shows_these_values() {
        let page = include_str!("../../../docs/theory/compliance-classes.md");
        for class in ComplianceClass::ALL {
            let cells = class
                .values()
                .unwrap()
                .map(|joint| format!("{:.2e} ({:.1})", joint.value, joint.factor));
            let row = format!("| {} | {} |", class.name(), cells.join(" | "));
            assert!(page.contains(&row), "not there: {row}");
        }
    }

    #[test]
    fn payloads_at_the_bounds_belong_to_the_lighter_class() {
        let classes = [12.0, 20.0, 20.1, 100.0, 120.0].map(ComplianceClass::of_payload);
        let names = classes.map(ComplianceClass::name);
        assert_eq!(names, ["light", "light", "medium", "medium", "heavy"]);
    }

    #[test]
    fn an_arm_of_seven_joints_is_refused() {
        let arm = library::robot("kuka/lbr-iiwa-14-r820").unwrap().unwrap().robot;
        let error = ComplianceClass::Light
            .compliance_of(&arm)
            .unwrap_err()
            .to_string();
        assert!(error.contains("7 joints"), "{error}");
    }

    #[test]
    fn an_unknown_class_is_refused_with_the_list_of_classes() {
        let error = ComplianceClass::named("middling").unwrap_err().to_string();
        assert!(
            error.contains("`middling`") && error.contains("\"medium\""),
            "{error}"
        );
    }
}
