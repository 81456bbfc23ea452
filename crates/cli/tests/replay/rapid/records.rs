//! Records and predefined data of RAPID.
//!
//! Source: Technical reference manual, RAPID instructions, functions and data types (3HAC16581-1): `robtarget`,
//! `jointtarget`, `tooldata`, `wobjdata`, `speeddata`, `zonedata` [recalled].

use crate::value::Value;

/// Speeds that exist without declaration, mm/s; vmax is that of the robot.
const SPEEDS: [u32; 25] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000,
    4000, 5000, 6000, 7000,
];
/// Zones that exist without declaration, mm; z0 is 0.3 mm.
const ZONES: [u32; 14] = [0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200];
const Z0_MM: f64 = 0.3;

/// Components by type: name and type of each.
const RECORDS: [(&str, &[(&str, &str)]); 9] = [
    (
        "robtarget",
        &[
            ("trans", "pos"),
            ("rot", "orient"),
            ("robconf", "confdata"),
            ("extax", "extjoint"),
        ],
    ),
    ("jointtarget", &[("robax", "robjoint"), ("extax", "extjoint")]),
    ("pose", &[("trans", "pos"), ("rot", "orient")]),
    ("pos", &[("x", "num"), ("y", "num"), ("z", "num")]),
    (
        "tooldata",
        &[("robhold", "bool"), ("tframe", "pose"), ("tload", "loaddata")],
    ),
    (
        "wobjdata",
        &[
            ("robhold", "bool"),
            ("ufprog", "bool"),
            ("ufmec", "string"),
            ("uframe", "pose"),
            ("oframe", "pose"),
        ],
    ),
    (
        "speeddata",
        &[
            ("v_tcp", "num"),
            ("v_ori", "num"),
            ("v_leax", "num"),
            ("v_reax", "num"),
        ],
    ),
    (
        "extjoint",
        &[
            ("eax_a", "num"),
            ("eax_b", "num"),
            ("eax_c", "num"),
            ("eax_d", "num"),
            ("eax_e", "num"),
            ("eax_f", "num"),
        ],
    ),
    (
        "zonedata",
        &[
            ("finep", "bool"),
            ("pzone_tcp", "num"),
            ("pzone_ori", "num"),
            ("pzone_eax", "num"),
            ("zone_ori", "num"),
            ("zone_leax", "num"),
            ("zone_reax", "num"),
        ],
    ),
];

/// Index from 0 and type of a component.
pub fn field(kind: &str, name: &str) -> Option<(usize, &'static str)> {
    let (_, fields) = RECORDS.iter().find(|(record, _)| *record == kind)?;
    let index = fields
        .iter()
        .position(|(field, _)| field.eq_ignore_ascii_case(name))?;
    Some((index, fields[index].1))
}

/// Type and value of data that exist without declaration; the name in capital letters.
pub fn predefined(name: &str) -> Option<(&'static str, Value)> {
    let number = |prefix: char| name.strip_prefix(prefix)?.parse::<u32>().ok();
    let zone = |fine: bool, distance: f64| {
        let mut parts = vec![Value::Truth(fine)];
        // The other zones follow the first, which alone matters for the path of the tool centre point.
        parts.extend([distance, distance, distance, 0.0, distance, 0.0].map(Value::Number));
        Value::List(parts)
    };
    let unit = || Value::List(vec![list(&[0.0; 3]), list(&[1.0, 0.0, 0.0, 0.0])]);
    if name == "FINE" {
        return Some(("zonedata", zone(true, 0.0)));
    }
    if let Some(distance) = number('Z').filter(|distance| ZONES.contains(distance)) {
        let distance = if distance == 0 { Z0_MM } else { f64::from(distance) };
        return Some(("zonedata", zone(false, distance)));
    }
    if let Some(speed) = number('V').filter(|speed| SPEEDS.contains(speed)) {
        return Some(("speeddata", list(&[f64::from(speed), 500.0, 5000.0, 1000.0])));
    }
    match name {
        "TOOL0" => Some((
            "tooldata",
            Value::List(vec![Value::Truth(true), unit(), Value::List(Vec::new())]),
        )),
        "WOBJ0" => Some((
            "wobjdata",
            Value::List(vec![
                Value::Truth(false),
                Value::Truth(true),
                Value::Text(String::new()),
                unit(),
                unit(),
            ]),
        )),
        _ => None,
    }
}

/// Numbers as a value.
pub fn list(numbers: &[f64]) -> Value {
    Value::List(numbers.iter().copied().map(Value::Number).collect())
}
