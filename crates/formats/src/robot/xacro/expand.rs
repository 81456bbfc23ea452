//! Properties, macros and expressions evaluated by the crate `xacro-rs`, its errors reported at their place.
//!
//! The text is bounded before (`growth`, and the constants below), the work is done in a thread of its own, and a panic
//! there is a problem of the file. Messages of the crate have no places, so the words that they quote are looked for in
//! the files.

use std::error::Error;
use std::path::{Path, PathBuf};

use xacro_rs::extensions::ExtensionHandler;
use xacro_rs::{XacroError, XacroProcessor};

use super::flatten::{Flat, escaped};
use super::{growth, load_yaml, packages, values};
use crate::document::{Problem, Problems, Source};
use crate::xml;

/// Brackets within one another in an expression: the evaluator calls itself for each.
const MOST_BRACKETS: usize = 40;
/// Room for an expression of that depth, in a build without optimisation.
const STACK_BYTES: usize = 64 << 20;
/// Name of the thread that works expressions out: a panic there becomes a problem of the file.
pub const EXPANDER: &str = "xacro";
/// A longer text is not a robot: the longest of ROS-Industrial has 20 kB without meshes.
const LONGEST_BYTES: usize = 4 << 20;

/// The expanded text.
///
/// # Errors
/// The expression or macro that cannot be evaluated, at its place in `main` or in a file that it includes.
pub(super) fn expand(main: &Source, path: &Path, flat: &Flat) -> Result<String, Problems> {
    let (xml, included) = (&flat.xml, &flat.sources[..]);
    if xml.len() > LONGEST_BYTES {
        let message = format!(
            "{} bytes with all included files: too large for a robot",
            xml.len()
        );
        return Err(main.problem(0..0, message, None).into());
    }
    for source in std::iter::once(main).chain(included) {
        if let Some(problem) = too_deep(source) {
            return Err(problem.into());
        }
    }
    let source = Source::new(main.name(), xml);
    let document = xml::parse(&source)?;
    let root = document.root_element();
    let at_call = |message: String| Problems::from(placed(main, included, &message));
    let data = load_yaml::data(&flat.calls, &values::values(root)).map_err(at_call)?;
    if let Some(message) = growth::refusal(root, &data) {
        return Err(placed(main, included, &message).into());
    }
    let properties: String = data
        .iter()
        .map(|data| {
            let value = escaped(&data.value);
            format!("<xacro:property name=\"{}\" value=\"{value}\"/>", data.property)
        })
        .collect();
    // They are defined before all else. A `>` in an attribute is escaped: the first one ends the tag of the root.
    let (head, rest) = xml.split_once('>').unwrap_or((xml, ""));
    let xml = format!("{head}>{properties}{rest}");
    let folder = path.parent().unwrap_or(Path::new(".")).to_owned();
    let expand = move || {
        let processor = XacroProcessor::builder()
            .clear_extensions()
            .with_extension(Box::new(Find(folder)))
            .with_compat_all()
            .build();
        processor.run_from_string(&xml).map_err(|error| reported(&error))
    };
    // A thread of its own has the stack that the evaluator needs, and keeps a fault of it from ending the program. On WASI
    // there is none: the page starts the program again.
    let expanded = if cfg!(target_os = "wasi") {
        Ok(Ok(expand()))
    } else {
        std::thread::Builder::new()
            .name(EXPANDER.to_owned())
            .stack_size(STACK_BYTES)
            .spawn(expand)
            .map(std::thread::JoinHandle::join)
    };
    match expanded {
        Ok(Ok(Ok(expanded))) => Ok(expanded),
        Ok(Ok(Err(message))) => Err(placed(main, included, &message).into()),
        _ => {
            let hint = "expand it with ROS (`xacro FILE > x.urdf`) and give the URDF".to_owned();
            Err(main
                .problem(0..0, "the xacro could not be expanded", Some(hint))
                .into())
        }
    }
}

/// `$(find package)`, by the folders around the file.
///
/// The folder is that of the main file.
struct Find(PathBuf);

impl ExtensionHandler for Find {
    /// The home of the package; nothing for any other command.
    fn resolve(&self, command: &str, arguments: &str) -> Result<Option<String>, Box<dyn Error>> {
        if command != "find" {
            return Ok(None);
        }
        let package = arguments.trim();
        match packages::homes(&self.0, package).find(|home| home.is_dir()) {
            Some(home) => Ok(Some(home.display().to_string())),
            None => Err(format!("package '{package}' is not among the folders around the file").into()),
        }
    }

    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}

/// An error in one line, with the macro it came up in.
///
/// Line ends become blanks, and what the crate repeats of its own message is cut off.
fn reported(error: &XacroError) -> String {
    let (error, place) = match error {
        XacroError::WithContext { source, context } => (
            source.as_ref(),
            context
                .macro_stack
                .last()
                .map(|name| format!(" (in macro `{name}`)")),
        ),
        other => (other, None),
    };
    let text = error.to_string();
    if let Some((_, rest)) = text.split_once("<xacro:")
        && let Some((name, _)) = rest.split_once('>')
        && matches!(error, XacroError::UnimplementedFeature(_))
    {
        return match name {
            "element" | "attribute" => format!("`xacro:{name}` is not understood"),
            _ => format!("no macro is called `{name}`"),
        };
    }
    let first = text.split("\n\n").next().unwrap_or_default();
    let line = first.split_whitespace().collect::<Vec<_>>().join(" ");
    // The evaluator says it twice.
    let once = line
        .find("Failed to evaluate")
        .and_then(|at| line.get(at..))
        .unwrap_or(&line);
    format!("cannot expand the xacro: {once}{}", place.unwrap_or_default())
}

/// The problem at the first text that the message quotes and a file contains.
///
/// Words in quotes are tried in their order, each in the main file first; where none is found, the problem is at
/// the start of the main file.
fn placed(main: &Source, included: &[Source], message: &str) -> Problem {
    let hint = "correct the expression, give the file that defines what is missing, or expand it with ROS (`xacro FILE > x.urdf`)";
    let quoted = message
        .split(['\'', '`', '"'])
        .skip(1)
        .step_by(2)
        .filter(|word| !word.is_empty());
    for word in quoted {
        for source in std::iter::once(main).chain(included) {
            if let Some(at) = source.text().find(word) {
                return source.problem(at..at + word.len(), message, Some(hint.to_owned()));
            }
        }
    }
    main.problem(0..0, message, Some(hint.to_owned()))
}

/// The first expression whose brackets go too deep.
///
/// Any bracket counts, whether it is in an expression or not.
fn too_deep(source: &Source) -> Option<Problem> {
    let text = source.text();
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            // An expression ends with its attribute.
            '<' | '>' => depth = 0,
            _ => {}
        }
        if depth > MOST_BRACKETS {
            let message = format!("brackets go deeper than {MOST_BRACKETS}");
            return Some(source.problem(at..at + 1, message, None));
        }
    }
    None
}
