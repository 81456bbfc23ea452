//! Changes of the axes of a vector: signs and order of its columns.
//!
//! There are 48 with the identity: six orders, eight signs each. The simplest are first: all signs, one sign, two
//! columns exchanged, two signs, then the others.

use armill_core::nalgebra::Vector3;

/// Another sign or order of the components of a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisChange {
    /// Component that is taken for each one.
    from: [usize; 3],
    /// Its sign.
    signs: [f64; 3],
}

/// Names of the components.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Orders of the components: as given, two exchanged, all moved on.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [2, 1, 0], [0, 2, 1], [1, 2, 0], [2, 0, 1]];

impl AxisChange {
    /// Every change but the identity, the simplest first.
    pub fn all() -> Vec<AxisChange> {
        let signs = (0..8).map(|bits| [0, 1, 2].map(|k| if bits >> k & 1 == 1 { -1.0 } else { 1.0 }));
        let mut all: Vec<AxisChange> = signs
            .flat_map(|signs| ORDERS.map(|from| AxisChange { from, signs }))
            .filter(|change| change.complexity() > 0)
            .collect();
        all.sort_by_key(AxisChange::complexity);
        all
    }

    /// How many things went wrong: a common sign is one of them.
    fn complexity(&self) -> usize {
        let negated = self.negated().len();
        let signs = if negated == 3 { 1 } else { 2 * negated };
        let order = match self.moved() {
            0 => 0,
            2 => 3,
            _ => 5,
        };
        signs + order
    }

    /// Whether only the sign of the whole vector changes.
    pub fn is_common_sign(&self) -> bool {
        self.moved() == 0 && self.negated().len() == 3
    }

    fn moved(&self) -> usize {
        (0..3).filter(|k| self.from[*k] != *k).count()
    }

    fn negated(&self) -> Vec<usize> {
        (0..3).filter(|k| self.signs[*k] < 0.0).collect()
    }

    /// The changed vector.
    pub fn of(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|k, _| self.signs[k] * vector[self.from[k]])
    }

    /// Where component `axis` of a vector goes, and its sign there.
    pub fn moves(&self, axis: usize) -> (usize, f64) {
        let to = (0..3).find(|k| self.from[*k] == axis).unwrap_or(axis);
        (to, self.signs[to])
    }

    /// What is changed: `z negated`, `x and y exchanged`, `(x, y, z) taken as (y, z, -x)`.
    pub fn words(&self) -> String {
        let negated: Vec<&str> = self.negated().into_iter().map(|k| AXES[k]).collect();
        let signs = match &negated[..] {
            [] => String::new(),
            [_, _, _] => "all signs reversed".to_owned(),
            some => format!("{} negated", some.join(" and ")),
        };
        match self.moved() {
            0 => signs,
            2 => {
                let pair: Vec<&str> = (0..3).filter(|k| self.from[*k] != *k).map(|k| AXES[k]).collect();
                let exchanged = format!("{} exchanged", pair.join(" and "));
                match negated.is_empty() {
                    true => exchanged,
                    false => format!("{exchanged} and then {signs}"),
                }
            }
            _ => {
                let taken = |k: usize| {
                    format!(
                        "{}{}",
                        if self.signs[k] < 0.0 { "-" } else { "" },
                        AXES[self.from[k]]
                    )
                };
                format!("(x, y, z) taken as ({}, {}, {})", taken(0), taken(1), taken(2))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_47_changes_the_simplest_first_and_each_in_other_words() {
        let all = AxisChange::all();
        assert_eq!(all.len(), 47);
        let words: Vec<String> = all.iter().map(AxisChange::words).collect();
        assert_eq!(
            words[..4],
            ["all signs reversed", "x negated", "y negated", "z negated"]
        );
        assert_eq!(
            words[4..7],
            ["x and y exchanged", "x and z exchanged", "y and z exchanged"]
        );
        assert!(words.contains(&"(x, y, z) taken as (y, z, -x)".to_owned()));
        let mut different = words.clone();
        different.sort();
        different.dedup();
        assert_eq!(different.len(), 47);
    }

    #[test]
    fn a_component_moves_where_the_vector_has_it() {
        let v = Vector3::new(1.0, 2.0, 3.0);
        for change in AxisChange::all() {
            let changed = change.of(&v);
            assert_eq!(changed.norm(), v.norm());
            for axis in 0..3 {
                let (to, sign) = change.moves(axis);
                assert_eq!(changed[to], sign * v[axis], "{}", change.words());
            }
        }
    }
}
