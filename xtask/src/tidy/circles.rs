//! Circles among things that use each other: modules, files.

use std::collections::{BTreeMap, VecDeque};

use super::violation::Violation;

/// Of each thing those that it uses, with the file and line of the first use.
pub type Uses = BTreeMap<String, BTreeMap<String, (String, usize)>>;

/// A violation for each use that closes a circle: the used thing leads back to the one that uses it.
pub fn circles(uses: &Uses, hint: &str) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (user, used) in uses {
        for (name, (path, line)) in used {
            // At least one use of a circle goes against the alphabet; the others would report the same circle again.
            if user < name {
                continue;
            }
            if let Some(way) = way(uses, name, user) {
                let what = format!(
                    "`{user}` uses `{name}`, which leads back to it: {}",
                    way.join(" -> ")
                );
                violations.push(Violation::new(path, *line, what, hint));
            }
        }
    }
    violations
}

/// The shortest way from one thing to another along uses, both included; none if there is no way.
fn way<'a>(uses: &'a Uses, from: &'a str, to: &str) -> Option<Vec<&'a str>> {
    let mut before: BTreeMap<&str, Option<&str>> = BTreeMap::from([(from, None)]);
    let mut next = VecDeque::from([from]);
    while let Some(here) = next.pop_front() {
        if here == to {
            let mut way = vec![here];
            while let Some(Some(step)) = before.get(way[way.len() - 1]) {
                way.push(step);
            }
            way.reverse();
            return Some(way);
        }
        for used in uses.get(here).into_iter().flat_map(BTreeMap::keys) {
            if !before.contains_key(used.as_str()) {
                before.insert(used, Some(here));
                next.push_back(used);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(pairs: &[(&str, &str)]) -> Vec<String> {
        let mut uses = Uses::new();
        for (line, (user, used)) in pairs.iter().enumerate() {
            let of_user = uses.entry((*user).to_owned()).or_default();
            of_user.insert((*used).to_owned(), ("file.rs".to_owned(), line + 1));
        }
        let found = circles(&uses, "hint");
        found
            .into_iter()
            .map(|violation| format!("{}: {}", violation.line, violation.what))
            .collect()
    }

    #[test]
    fn a_circle_is_reported_once_with_its_shortest_way() {
        let pairs = [("a", "b"), ("a", "c"), ("b", "c"), ("c", "a"), ("a", "d")];
        assert_eq!(given(&pairs), ["4: `c` uses `a`, which leads back to it: a -> c"]);
    }

    #[test]
    fn several_ways_to_one_end_are_no_circle() {
        assert_eq!(given(&[("c", "a"), ("c", "b"), ("b", "a")]), Vec::<String>::new());
    }
}
