//! The links and joints of a URDF as a tree, and the chain from its root to a tip.
//!
//! Every link but one is the child of exactly one joint, and every link is reached from that one, the root. A joint is
//! known by its child, so that the way from a tip back to the root is one look-up a step.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::joints::{JointElement, Kind};
use crate::document::{Problems, Source};
use crate::xml::{children, tag};

/// More links than this are not listed in a hint.
const MOST_LISTED: usize = 30;

/// Links joined without a loop, from one root.
pub(super) struct Tree<'a> {
    /// The link without a parent.
    pub root: &'a str,
    /// All, in the order of the file.
    links: Vec<&'a str>,
    /// The joint that leads to a link.
    by_child: BTreeMap<&'a str, &'a JointElement>,
    /// Of the element `<robot>`, for problems of the whole.
    place: std::ops::Range<usize>,
}

/// The way from the root to a tip.
pub(super) struct Chain<'a> {
    /// Root to tip, fixed ones included.
    pub joints: Vec<&'a JointElement>,
    /// The last link.
    pub tip: &'a str,
    /// Names of moving joints that are not on it.
    pub left_out: Vec<&'a str>,
}

impl<'a> Tree<'a> {
    /// The tree of the links below `root` and of these joints.
    ///
    /// # Errors
    /// A joint to a link that is not there, a link with two parents, a loop, no root or several.
    pub fn new(file: &Source, root: Node<'a, '_>, joints: &'a [JointElement]) -> Result<Tree<'a>, Problems> {
        let links: Vec<&str> = children(root, "link")
            .filter_map(|link| link.attribute("name"))
            .collect();
        let known: BTreeSet<&str> = links.iter().copied().collect();
        let mut problems = Vec::new();
        let mut by_child = BTreeMap::new();
        for joint in joints {
            for (link, place) in [(&joint.parent, &joint.place), (&joint.child, &joint.child_place)] {
                if !known.contains(link.as_str()) {
                    let message = format!(
                        "joint `{}` names link `{link}`, which is not in the file",
                        joint.name
                    );
                    problems.push(file.problem(place.clone(), message, Some(list_of(&links))));
                }
            }
            if let Some(other) = by_child.insert(joint.child.as_str(), joint) {
                let message = format!(
                    "link `{}` is the child of 2 joints, `{}` and `{}`",
                    joint.child, other.name, joint.name
                );
                problems.push(file.problem(joint.child_place.clone(), message, Some(LOOP.to_owned())));
            }
        }
        Problems::from(problems).into_result()?;
        let place = tag(root);
        let roots: Vec<&str> = known
            .iter()
            .copied()
            .filter(|link| !by_child.contains_key(link))
            .collect();
        let refused =
            |message: String| Err(file.problem(place.clone(), message, Some(LOOP.to_owned())).into());
        match roots[..] {
            _ if links.is_empty() => {
                let hint = "a URDF has <link> and <joint> elements inside <robot>".to_owned();
                Err(file.problem(place, "the file has no link", Some(hint)).into())
            }
            [] => refused("the joints form a loop: every link is the child of another".to_owned()),
            [root] => match unreachable(root, joints, &known)[..] {
                [] => Ok(Tree {
                    root,
                    links,
                    by_child,
                    place,
                }),
                ref loops => refused(format!(
                    "the joints between these links form a loop: {}",
                    listed(loops)
                )),
            },
            _ => refused(format!(
                "{} links have no parent: exactly one root is required: {}",
                roots.len(),
                listed(&roots)
            )),
        }
    }

    /// The joints from the root to a link; `None` if there is no such way.
    ///
    /// In the order root to link; empty for the root itself.
    pub fn path_from_root(&self, link: &str) -> Option<Vec<&'a JointElement>> {
        let mut chain = Vec::new();
        let mut link = link;
        while let Some(joint) = self.by_child.get(link) {
            chain.push(*joint);
            link = &joint.parent;
            if chain.len() > self.by_child.len() {
                return None;
            }
        }
        chain.reverse();
        (link == self.root).then_some(chain)
    }

    /// The chain to the link `tip`, or to the one with the most moving joints.
    ///
    /// Without `tip` the ends of all branches are looked at: most moving joints first, then the link `tool0`, then most
    /// joints of any kind, then the last in the file.
    ///
    /// # Errors
    /// No such link, or none that the root leads to.
    pub fn chain(&self, file: &Source, tip: Option<&str>) -> Result<Chain<'a>, Problems> {
        let parents: BTreeSet<&str> = self
            .by_child
            .values()
            .map(|joint| joint.parent.as_str())
            .collect();
        let ends = self.links.iter().copied().filter(|link| match tip {
            Some(tip) => *link == tip,
            None => !parents.contains(link),
        });
        let chains = ends.filter_map(|tip| Some((tip, self.path_from_root(tip)?)));
        let moving = |chain: &[&JointElement]| chain.iter().filter(|joint| moves(joint)).count();
        let longest = chains.max_by_key(|(tip, chain)| (moving(chain), *tip == "tool0", chain.len()));
        let Some((tip, joints)) = longest else {
            let message = match tip {
                Some(tip) => format!("link `{tip}` is not in the file, or no joints lead to it"),
                None => "no joints lead from the root link to a tip".to_owned(),
            };
            return Err(file
                .problem(self.place.clone(), message, Some(list_of(&self.links)))
                .into());
        };
        let on_chain: BTreeSet<&str> = joints.iter().map(|joint| joint.child.as_str()).collect();
        let left_out = self
            .by_child
            .values()
            .filter(|joint| joint.kind != Kind::Fixed && !on_chain.contains(joint.child.as_str()))
            .map(|joint| joint.name.as_str())
            .collect();
        Ok(Chain {
            joints,
            tip,
            left_out,
        })
    }
}

/// The links that no way from the root leads to.
///
/// Such links are in a loop or hang on one: each has a parent, or it would be a root.
fn unreachable<'a>(root: &'a str, joints: &'a [JointElement], links: &BTreeSet<&'a str>) -> Vec<&'a str> {
    let mut below: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for joint in joints {
        below.entry(&joint.parent).or_default().push(&joint.child);
    }
    let mut reached = BTreeSet::from([root]);
    let mut front = vec![root];
    while let Some(link) = front.pop() {
        let next = below.remove(link).unwrap_or_default();
        reached.extend(&next);
        front.extend(next);
    }
    links.difference(&reached).copied().collect()
}

/// What to look for where links and joints do not form a tree.
const LOOP: &str = "a serial arm has one root link and joints that lead away from it without a loop";

/// Whether a joint has a position of its own.
fn moves(joint: &JointElement) -> bool {
    joint.kind != Kind::Fixed && joint.mimics.is_none()
}

/// A hint that names the links of the file.
fn list_of(links: &[&str]) -> String {
    format!("the links of the file: {}", listed(links))
}

/// The first of these names, and how many more there are.
fn listed(links: &[&str]) -> String {
    let shown = links
        .iter()
        .take(MOST_LISTED)
        .copied()
        .collect::<Vec<_>>()
        .join(", ");
    match links.len().checked_sub(MOST_LISTED) {
        Some(more) if more > 0 => format!("{shown} and {more} more"),
        _ => shown,
    }
}
