//! Timing: all candidates in turn, round after round; the median of the rounds, and its quartiles.

use std::hint::black_box;
use std::time::Instant;

/// An implementation that can do a piece of work.
pub struct Candidate<'a> {
    /// Name in the table.
    pub who: &'static str,
    /// One of [`crate::work`], or work of this candidate only.
    pub work: &'static str,
    /// Number of threads.
    pub threads: usize,
    /// What a reader must know to compare it; may be empty.
    pub note: &'static str,
    /// Number of poses of one run.
    pub count: usize,
    /// Does it once for all poses; the result goes through [`black_box`].
    pub run: Box<dyn FnMut() + 'a>,
}

impl<'a> Candidate<'a> {
    /// A candidate on one thread, without note.
    pub fn new(
        who: &'static str,
        work: &'static str,
        count: usize,
        mut run: impl FnMut() + 'a,
    ) -> Candidate<'a> {
        Candidate {
            who,
            work,
            threads: 1,
            note: "",
            count,
            run: Box::new(move || {
                black_box(&mut run)();
            }),
        }
    }

    /// The same, with a note.
    #[must_use]
    pub fn note(mut self, note: &'static str) -> Candidate<'a> {
        self.note = note;
        self
    }

    /// The same, given so many threads.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Candidate<'a> {
        self.threads = threads;
        self
    }
}

/// Rate of one candidate, million poses per second.
pub struct Rate {
    /// Half of the rounds were slower.
    pub median: f64,
    /// A quarter of the rounds were slower.
    pub lower_quartile: f64,
    /// A quarter of the rounds were faster.
    pub upper_quartile: f64,
}

/// Times all candidates, after one round to warm up.
pub fn rates(candidates: &mut [Candidate<'_>], rounds: usize) -> Vec<Rate> {
    let mut measured = vec![Vec::with_capacity(rounds); candidates.len()];
    for round in 0..=rounds {
        for (candidate, measured) in candidates.iter_mut().zip(&mut measured) {
            let start = Instant::now();
            (candidate.run)();
            let seconds = start.elapsed().as_secs_f64();
            if round > 0 {
                measured.push(candidate.count as f64 * 1e-6 / seconds);
            }
        }
    }
    measured.into_iter().map(rate).collect()
}

/// Median and quartiles, by the nearest of the ordered values.
fn rate(mut measured: Vec<f64>) -> Rate {
    measured.sort_by(f64::total_cmp);
    let at = |quantile: f64| {
        let index = (measured.len().saturating_sub(1) as f64 * quantile).round() as usize;
        measured.get(index).copied().unwrap_or(0.0)
    };
    Rate {
        median: at(0.5),
        lower_quartile: at(0.25),
        upper_quartile: at(0.75),
    }
}

/// One row for `cargo xtask bench`: who, work, threads, median, quartiles, note; separated by tabs.
pub fn row(candidate: &Candidate<'_>, rate: &Rate) -> String {
    format!(
        "{}\t{}\t{}\t{:.6}\t{:.6}\t{:.6}\t{}",
        candidate.who,
        candidate.work,
        candidate.threads,
        rate.median,
        rate.lower_quartile,
        rate.upper_quartile,
        candidate.note
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_ordered_values() {
        let rate = rate(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        let all = [rate.lower_quartile, rate.median, rate.upper_quartile];
        assert_eq!(all, [2.0, 3.0, 4.0]);
    }

    #[test]
    fn a_row_has_seven_fields() {
        let candidate = Candidate::new("a", "dev", 10, || ()).threads(2);
        let row = row(&candidate, &rate(vec![1.0]));
        assert_eq!(row.split('\t').count(), 7);
    }
}
