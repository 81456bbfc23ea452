//! One XML text from a xacro file and all it includes, without what no chain needs, and with a call of its macro if
//! nothing else calls one.
//!
//! | in a file | in the text |
//! |---|---|
//! | `<xacro:include>` | the contents of that file, or nothing where it is not needed |
//! | any other `xacro:` element | itself, with the prefix `xacro` |
//! | `<link>` | its name alone; on request also its `<inertial>`, or the meshes of `<visual>` and `<collision>` with their origins |
//! | `<joint>` | itself, with origin, parent, child, axis, limit and mimic |
//! | `<material>`, `<gazebo>`, `<transmission>`, `<ros2_control>`, `<sensor>` | nothing |
//! | comments, attributes with a namespace | nothing |
//! | any other element, text | itself |

use std::path::{Path, PathBuf};

use roxmltree::Node;

use super::elements::{DIRECTIVES, is_plain, is_xacro};
use super::load_yaml::{self, Call};
use super::packages;
use crate::document::{Problem, Problems, Source};
use crate::input;
use crate::xml;

/// Files within files deeper than this are not accepted.
const DEEPEST: usize = 16;
/// More includes than this are not accepted.
const MOST_FILES: usize = 100;

/// A file of colours, materials or simulation is not missed.
const NOT_NEEDED: [&str; 7] = [
    "colour",
    "color",
    "material",
    "gazebo",
    "transmission",
    "control",
    "inertial",
];

/// What is kept inside a joint.
const OF_JOINTS: [&str; 6] = ["origin", "parent", "child", "axis", "limit", "mimic"];
/// What is dropped anywhere outside a link.
const DROPPED: [&str; 5] = ["material", "gazebo", "transmission", "ros2_control", "sensor"];

/// What is kept of the shapes of links: these elements, within one another.
const OF_SHAPES: [&str; 5] = ["visual", "collision", "origin", "geometry", "mesh"];

/// What is kept of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OfLinks {
    /// Its name: nothing of its shapes can then fail.
    Names,
    /// Its name and its mass.
    Inertials,
    /// Its name and its meshes.
    Meshes,
}

/// Everything of a xacro file in one text.
pub(super) struct Flat {
    /// One `<robot>` with the contents of all files.
    pub xml: String,
    /// The files included, to find the places of problems.
    pub sources: Vec<Source>,
    /// Files that were not found and are not needed.
    pub remarks: Vec<String>,
    /// Calls of `load_yaml`, in the order of the properties that contain their data.
    pub calls: Vec<Call>,
}

/// Writes one text while it walks through all files.
struct Writer<'a> {
    /// The file that was requested.
    main: &'a Source,
    of_links: OfLinks,
    /// What was written so far, without the root element.
    xml: String,
    /// The files included so far.
    sources: Vec<Source>,
    remarks: Vec<String>,
    calls: Vec<Call>,
    /// Of all files; the walk goes on behind each.
    problems: Vec<Problem>,
    /// More includes than are read.
    too_many: bool,
    /// The files that include the one at hand, outermost first.
    inside: Vec<PathBuf>,
    /// In the order of the text.
    macros: Vec<Macro>,
    /// How many definitions of macros enclose the element at hand.
    macros_around: usize,
    /// A joint outside all macros, or a call of a macro.
    makes_something: bool,
}

/// A macro with joints in it.
struct Macro {
    name: String,
    /// As the file has it: words between blanks, with `:=` or `=` where there is a default.
    params: String,
    /// Where its name is in its file.
    place: std::ops::Range<usize>,
    /// Whether `place` is in the main file.
    of_main: bool,
}

/// The text of `main`, read from `path`, and of all it includes.
///
/// Reads the included files from the disk. If nothing but macros is defined and one of them contains joints, a call of
/// it is at the end.
///
/// # Errors
/// What is not XML, files that are missing, no robot or several.
pub(super) fn flatten(main: &Source, path: &Path, of_links: OfLinks) -> Result<Flat, Problems> {
    let document = xml::parse(main)?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        let message = format!(
            "not a xacro robot: its root is <{}>, not <robot>",
            root.tag_name().name()
        );
        return Err(main.problem(xml::tag(root), message, None).into());
    }
    let mut writer = Writer {
        main,
        of_links,
        xml: String::new(),
        sources: Vec::new(),
        remarks: Vec::new(),
        calls: Vec::new(),
        problems: Vec::new(),
        too_many: false,
        inside: vec![path.to_owned()],
        macros: Vec::new(),
        macros_around: 0,
        makes_something: false,
    };
    for child in root.children() {
        writer.node(main, child);
    }
    Problems::from(std::mem::take(&mut writer.problems)).into_result()?;
    if !writer.makes_something {
        let call = writer.call(root)?;
        writer.xml.push_str(&call);
    }
    let name = root.attribute("name").unwrap_or_default();
    Ok(Flat {
        xml: format!(
            "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"{}\">{}</robot>",
            escaped(name),
            writer.xml
        ),
        sources: writer.sources,
        remarks: writer.remarks,
        calls: writer.calls,
    })
}

impl Writer<'_> {
    /// Any node of a file: text, an element of URDF that chains need, or one of xacro.
    ///
    /// Whether an element makes joints is seen on the way: a joint or a call of a macro outside all macros.
    fn node(&mut self, file: &Source, node: Node<'_, '_>) {
        if node.is_text() {
            self.xml.push_str(&escaped(node.text().unwrap_or_default()));
        }
        if !node.is_element() {
            return;
        }
        let name = node.tag_name().name();
        if !is_xacro(node) {
            let inside_joint = node.parent().is_some_and(|parent| is_plain(parent, "joint"));
            if DROPPED.contains(&name) || (inside_joint && !OF_JOINTS.contains(&name)) {
                return;
            }
            self.makes_something |= name == "joint" && self.macros_around == 0;
            self.element(file, node);
            return;
        }
        match name {
            "include" => self.include(file, node),
            "macro" => {
                if node.descendants().any(|inner| is_plain(inner, "joint")) {
                    self.macros.push(Macro {
                        name: node.attribute("name").unwrap_or_default().to_owned(),
                        params: node.attribute("params").unwrap_or_default().to_owned(),
                        place: xml::value_place(node, "name"),
                        of_main: self.inside.len() == 1,
                    });
                }
                self.macros_around += 1;
                self.element(file, node);
                self.macros_around -= 1;
            }
            _ => {
                self.makes_something |= self.macros_around == 0 && !DIRECTIVES.contains(&name);
                self.element(file, node);
            }
        }
    }

    /// An element with its attributes; of a link its name alone.
    fn element(&mut self, file: &Source, node: Node<'_, '_>) {
        let name = node.tag_name().name();
        let prefix = if is_xacro(node) { "xacro:" } else { "" };
        self.xml.push_str(&format!("<{prefix}{name}"));
        let folder = self.folder();
        for attribute in node
            .attributes()
            .filter(|attribute| attribute.namespace().is_none())
        {
            let value = load_yaml::replaced(attribute.value(), &folder, &mut self.calls);
            self.xml
                .push_str(&format!(" {}=\"{}\"", attribute.name(), escaped(&value)));
        }
        self.xml.push('>');
        let is_link = is_plain(node, "link");
        for child in node.children() {
            if !is_link {
                self.node(file, child);
            } else {
                match self.of_links {
                    OfLinks::Names => {}
                    OfLinks::Inertials => self.inertial(file, child),
                    OfLinks::Meshes => self.shape(child),
                }
            }
        }
        self.xml.push_str(&format!("</{prefix}{name}>"));
    }

    /// An element of a link, if it is or makes its `<inertial>`: a macro says so by its name.
    fn inertial(&mut self, file: &Source, node: Node<'_, '_>) {
        let name = node.tag_name().name();
        let of_mass = |name: &str| name.contains("inerti") || name.contains("mass");
        if !node.is_element() {
            return;
        }
        if (is_plain(node, "inertial")) || (is_xacro(node) && of_mass(&name.to_lowercase())) {
            self.element(file, node);
        } else if is_xacro(node) && ["if", "unless"].contains(&name) {
            let value = node.attribute("value").unwrap_or_default();
            self.xml
                .push_str(&format!("<xacro:{name} value=\"{}\">", escaped(value)));
            for child in node.children() {
                self.inertial(file, child);
            }
            self.xml.push_str(&format!("</xacro:{name}>"));
        }
    }

    /// An element of the shape of a link, if a mesh needs it.
    fn shape(&mut self, node: Node<'_, '_>) {
        let name = node.tag_name().name();
        if !node.is_element() || is_xacro(node) || !OF_SHAPES.contains(&name) {
            return;
        }
        self.xml.push_str(&format!("<{name}"));
        for attribute in node
            .attributes()
            .filter(|attribute| attribute.namespace().is_none())
        {
            self.xml.push_str(&format!(
                " {}=\"{}\"",
                attribute.name(),
                escaped(attribute.value())
            ));
        }
        self.xml.push('>');
        for child in node.children() {
            self.shape(child);
        }
        self.xml.push_str(&format!("</{name}>"));
    }

    /// The folder of the file at hand.
    fn folder(&self) -> PathBuf {
        let folder = self.inside.last().and_then(|path| path.parent());
        match folder {
            Some(folder) if folder != Path::new("") => folder.to_owned(),
            _ => PathBuf::from("."),
        }
    }

    /// The contents of an included file in place of the element.
    ///
    /// A file that is missing is a problem, unless it is marked as optional or its name says that it contains colours
    /// or the like: then it is a remark. Files that include one another in a circle are refused, as are more than 100.
    fn include(&mut self, file: &Source, node: Node<'_, '_>) {
        let place = xml::value_place(node, "filename");
        let Some(filename) = node.attribute("filename") else {
            self.problems
                .push(file.problem(place, "<xacro:include> names no file", None));
            return;
        };
        let Some(candidates) = packages::candidates(&self.folder(), filename) else {
            let message = format!("the path of file `{filename}` cannot be determined");
            let hint =
                "includes are found by `$(find package)/...` or a plain path, not by other expressions"
                    .to_owned();
            self.problems.push(file.problem(place, message, Some(hint)));
            return;
        };
        let Some(path) = candidates.iter().find(|path| path.is_file()) else {
            let lower = filename.to_lowercase();
            let optional = node
                .attribute("optional")
                .is_some_and(|word| word.eq_ignore_ascii_case("true"));
            if optional || NOT_NEEDED.iter().any(|word| lower.contains(word)) {
                self.remarks
                    .push(format!("{filename} was not found: not needed for the chain"));
            } else {
                let message = format!("cannot find the included file `{filename}`");
                let candidates_text = candidates
                    .last()
                    .map_or_else(String::new, |path| path.display().to_string());
                let hint = format!("put it there: {candidates_text}");
                self.problems.push(file.problem(place, message, Some(hint)));
            }
            return;
        };
        if self.sources.len() >= MOST_FILES {
            // Reported once, however many follow.
            if !std::mem::replace(&mut self.too_many, true) {
                let message = format!("more than {MOST_FILES} includes");
                self.problems.push(file.problem(place, message, None));
            }
            return;
        }
        let same = |outer: &PathBuf| outer == path || outer.canonicalize().ok() == path.canonicalize().ok();
        if self.inside.iter().any(same) {
            let message = format!("the file `{filename}` includes itself");
            self.problems.push(file.problem(place, message, None));
            return;
        }
        if self.inside.len() >= DEEPEST {
            let message = format!("includes are nested deeper than {DEEPEST} files");
            self.problems.push(file.problem(place, message, None));
            return;
        }
        let bytes = match input::read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!("cannot read `{}`: {error}", path.display());
                self.problems.push(file.problem(place, message, None));
                return;
            }
        };
        let source = Source::new(&path.display().to_string(), &String::from_utf8_lossy(&bytes));
        match xml::parse(&source) {
            Ok(document) => {
                self.inside.push(path.clone());
                for child in document.root_element().children() {
                    self.node(&source, child);
                }
                self.inside.pop();
            }
            Err(problems) => self.problems.extend(problems),
        }
        self.sources.push(source);
    }

    /// The call of the one robot macro with an empty prefix.
    ///
    /// # Errors
    /// No macro with joints, several of them, or one with a parameter other than `prefix` that has no default.
    fn call(&self, root: Node<'_, '_>) -> Result<String, Problems> {
        let refused =
            |message: &str, hint: String| Err(self.main.problem(xml::tag(root), message, Some(hint)).into());
        let found = match &self.macros[..] {
            [] => {
                let message = "the file defines no robot: it has no joint, only colours, materials, constants or macros without joints";
                let hint = "give the file that includes it".to_owned();
                return refused(message, hint);
            }
            [one] => one,
            several => {
                let names: Vec<&str> = several.iter().map(|found| found.name.as_str()).collect();
                let hint = format!(
                    "write a file that includes this one and calls one of them: {}",
                    names.join(", ")
                );
                return refused("the file defines several robot macros and calls none", hint);
            }
        };
        let without_default = |word: &&str| !word.contains('=') && *word != "prefix";
        let needed: Vec<&str> = found.params.split_whitespace().filter(without_default).collect();
        if !needed.is_empty() {
            let message = format!("macro `{}` requires values for {}", found.name, needed.join(", "));
            let hint = format!(
                "write a file that includes this one and calls it: <xacro:{} prefix=\"\" {}=\"...\"/>",
                found.name,
                needed.join("=\"...\" ")
            );
            let place = if found.of_main {
                found.place.clone()
            } else {
                xml::tag(root)
            };
            return Err(self.main.problem(place, message, Some(hint)).into());
        }
        let takes_prefix = found
            .params
            .split_whitespace()
            .any(|word| word.split([':', '=']).next() == Some("prefix"));
        let prefix = if takes_prefix { " prefix=\"\"" } else { "" };
        Ok(format!("<xacro:{}{prefix}/>", found.name))
    }
}

/// Text for an attribute or between tags.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
