//! The order of holes with short joint travel: the nearest next one, improved by reversing parts (2-opt).
//!
//! ```text
//! c(a, b) = max over joints of |q_b - q_a| / v       time of a joint move at full speed
//! ```
//!
//! Source: 2-opt by Croes (1958). The order found is not proved to be the shortest.

/// Largest number of holes that are reordered: the effort grows with its square.
const MOST: usize = 5000;
/// Largest number of holes whose order is improved by reversing parts.
const MOST_IMPROVED: usize = 600;
/// Rounds of improvement.
const ROUNDS: usize = 50;
/// An order is improved by at least this part of a joint's full speed second, s.
const LEAST: f64 = 1e-9;

/// The order in which these joint positions (rad, m) are visited, from `start` if given; `speeds` are the maximum speeds
/// of the joints, rad/s (m/s). Lists of more than 5000 positions keep their order.
pub(super) fn shortest(positions: &[&[f64]], start: Option<&[f64]>, speeds: &[f64]) -> Vec<usize> {
    let count = positions.len();
    if count > MOST {
        return (0..count).collect();
    }
    let cost = |a: &[f64], b: &[f64]| {
        let times = a
            .iter()
            .zip(b)
            .zip(speeds)
            .map(|((a, b), speed)| (b - a).abs() / speed);
        times.fold(0.0, f64::max)
    };
    let mut left: Vec<usize> = (0..count).collect();
    let mut order = Vec::with_capacity(count);
    let mut at = start.or(positions.first().copied());
    while let Some(here) = at.filter(|_| !left.is_empty()) {
        let nearest = left
            .iter()
            .enumerate()
            .min_by(|(_, a), (_, b)| cost(here, positions[**a]).total_cmp(&cost(here, positions[**b])));
        let Some((index, _)) = nearest else { break };
        let next = left.remove(index);
        order.push(next);
        at = Some(positions[next]);
    }
    if count <= MOST_IMPROVED {
        let to = |order: &[usize], index: usize| positions[order[index]];
        let mut improved = true;
        let mut round = 0;
        while improved && round < ROUNDS {
            (improved, round) = (false, round + 1);
            for first in 0..count {
                let before = if first == 0 {
                    start
                } else {
                    Some(to(&order, first - 1))
                };
                for last in first + 1..count {
                    let after = (last + 1 < count).then(|| to(&order, last + 1));
                    let [a, b] = [to(&order, first), to(&order, last)];
                    let link = |from: Option<&[f64]>, to: Option<&[f64]>| {
                        from.zip(to).map_or(0.0, |(from, to)| cost(from, to))
                    };
                    let now = link(before, Some(a)) + link(Some(b), after);
                    let reversed = link(before, Some(b)) + link(Some(a), after);
                    if reversed < now - LEAST {
                        order[first..=last].reverse();
                        improved = true;
                    }
                }
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn travel(order: &[usize], positions: &[&[f64]], start: &[f64]) -> f64 {
        let stops = std::iter::once(start).chain(order.iter().map(|index| positions[*index]));
        let stops: Vec<&[f64]> = stops.collect();
        stops.windows(2).map(|pair| (pair[1][0] - pair[0][0]).abs()).sum()
    }

    #[test]
    fn positions_on_a_line_are_visited_along_it() {
        let values: Vec<[f64; 1]> = [3.0, -1.0, 2.0, 5.0, 0.5, 4.0].map(|value| [value]).to_vec();
        let positions: Vec<&[f64]> = values.iter().map(|value| &value[..]).collect();
        let order = shortest(&positions, Some(&[-2.0]), &[1.0]);
        assert_eq!(order, [1, 4, 2, 0, 5, 3]);
    }

    #[test]
    fn every_position_is_visited_once_and_no_farther_than_in_any_order_of_seven() {
        // Two joints of different speed; all orders are tried.
        let values: Vec<[f64; 2]> = (0..7)
            .map(|index| {
                let t = f64::from(index) * 2.4;
                [t.sin(), (1.7 * t).cos()]
            })
            .collect();
        let positions: Vec<&[f64]> = values.iter().map(|value| &value[..]).collect();
        let speeds = [2.0, 0.5];
        let cost =
            |a: &[f64], b: &[f64]| ((b[0] - a[0]).abs() / speeds[0]).max((b[1] - a[1]).abs() / speeds[1]);
        let start = [0.0, 0.0];
        let total = |order: &[usize]| {
            let stops = std::iter::once(&start[..]).chain(order.iter().map(|index| positions[*index]));
            let stops: Vec<&[f64]> = stops.collect();
            stops.windows(2).map(|pair| cost(pair[0], pair[1])).sum::<f64>()
        };
        let mut least = f64::INFINITY;
        let mut order: Vec<usize> = (0..7).collect();
        permutations(&mut order, 0, &mut |order| least = least.min(total(order)));
        let found = shortest(&positions, Some(&start), &speeds);
        let mut sorted = found.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3, 4, 5, 6]);
        assert!(total(&found) < 1.1 * least, "{} {least}", total(&found));
        assert!(travel(&found, &positions, &start) > 0.0);
    }

    fn permutations(order: &mut Vec<usize>, from: usize, each: &mut impl FnMut(&[usize])) {
        if from == order.len() {
            each(order);
        }
        for index in from..order.len() {
            order.swap(from, index);
            permutations(order, from + 1, each);
            order.swap(from, index);
        }
    }
}
