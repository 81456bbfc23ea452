//! Names that must differ from each other, as links and joints of a file must.

use std::collections::BTreeSet;

/// Names given so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Names(BTreeSet<String>);

impl Names {
    /// With these names in use.
    pub fn new<'a>(used: impl IntoIterator<Item = &'a str>) -> Names {
        Names(used.into_iter().map(str::to_owned).collect())
    }

    /// This name, with a number behind it if it is in use.
    pub fn unique(&mut self, name: &str) -> String {
        let mut found = name.to_owned();
        let mut number = 1;
        while !self.0.insert(found.clone()) {
            number += 1;
            found = format!("{name}_{number}");
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_in_use_gets_a_number() {
        let mut names = Names::new(["a", "a_2"]);
        assert_eq!(
            ["a", "b", "a"].map(|name| names.unique(name)),
            ["a_3", "b", "a_4"]
        );
    }
}
