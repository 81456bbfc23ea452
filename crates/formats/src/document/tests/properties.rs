//! Whatever the bytes, the reader ends with a value or with problems that have a place.

use proptest::prelude::*;

use super::super::{Document, Problems};
use super::{GOOD, Study, read};

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_of_a_file_makes_the_reader_panic(
        cuts in proptest::collection::vec((0..GOOD.len(), 0_usize..12, "[\\[\\]{}=.\"'#,\n\r\t a-c0-9_\u{e4}\u{1f600}\\\\+-]{0,6}"), 1..6),
    ) {
        let mut text = GOOD.to_owned();
        for (at, length, insert) in cuts {
            let from = text.floor_char_boundary(at);
            let to = text.ceil_char_boundary((from + length).min(text.len()));
            text.replace_range(from..to, &insert);
        }
        if let Err(problems) = read(&text) {
            prop_assert!(!problems.as_slice().is_empty());
            for problem in problems.as_slice() {
                let place = format!("study.toml:{}:{}", problem.line(), problem.column());
                let shown = Problems::from(problem.clone()).to_string();
                prop_assert!(shown.lines().next().is_some_and(|line| line.contains(&place)), "{}", shown);
                prop_assert!(problem.span().end <= text.len() + 1);
            }
            let _ = problems.in_colour();
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        if let Err(problems) = Document::from_bytes("study.toml", &bytes).and_then(|document| document.read::<Study>()) {
            prop_assert!(!problems.to_string().is_empty());
        }
    }

    #[test]
    fn no_path_makes_the_search_panic(path in ".{0,30}") {
        let document = Document::parse("study.toml", GOOD).unwrap();
        prop_assert!(document.problem(&path, "m", None).line() >= 1);
    }
}
