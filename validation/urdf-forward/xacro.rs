//! The one macro of a ROS-Industrial xacro file as a URDF: only the part of xacro used by these files.
//!
//! ```text
//! <xacro:macro name="..." params="prefix"> ... ${prefix}link_1 ... ${radians(90)} ... ${-pi/2} ... </xacro:macro>
//! ```
//!
//! Comments and tags of xacro inside the macro are taken out; properties, conditions and includes are not
//! evaluated. armill reads xacro with a separate reader, which shares no code with this one.

use std::f64::consts::PI;

/// The body of the macro with empty prefix and every `${...}` worked out.
pub fn urdf_of_the_macro(xacro: &str) -> String {
    let text = without(xacro, "<!--", "-->");
    let (_, from_name) = text.split_once("<xacro:macro").expect("a macro");
    let (_, body) = from_name.split_once('>').expect("the end of its tag");
    let (body, _) = body.split_once("</xacro:macro>").expect("the end of the macro");
    let body = without(body, "<xacro:", ">");
    let mut urdf = "<robot name=\"sample\">".to_owned();
    let mut pieces = body.split("${");
    urdf.push_str(pieces.next().unwrap_or_default());
    for piece in pieces {
        let (expression, rest) = piece.split_once('}').expect("a closing brace");
        // Speeds by controller are in a separate file and not part of the geometry.
        match expression.trim() {
            "prefix" => {}
            speed if speed.contains("velocities") => urdf.push('0'),
            other => urdf.push_str(&value(other).to_string()),
        }
        urdf.push_str(rest);
    }
    urdf + "</robot>"
}

/// `text` without everything from an `open` to the next `close`.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, from)) = rest.split_once(open) {
        kept.push_str(before);
        rest = from.split_once(close).map_or("", |(_, after)| after);
    }
    kept + rest
}

/// Numbers, `pi`, a leading minus, one division, `radians(...)`.
fn value(expression: &str) -> f64 {
    let expression = expression.trim();
    let inside = |name: &str| expression.strip_prefix(name)?.strip_suffix(')');
    if let Some(negated) = expression.strip_prefix('-') {
        -value(negated)
    } else if let Some(degrees) = inside("radians(") {
        value(degrees).to_radians()
    } else if let Some((a, b)) = expression.split_once('/') {
        value(a) / value(b)
    } else if expression == "pi" {
        PI
    } else {
        expression
            .parse()
            .unwrap_or_else(|_| panic!("`{expression}` is beyond this reader"))
    }
}
