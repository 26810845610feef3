//! "Did you mean": the nearest of some known names.

/// Names longer than this are no typing slip of ours.
const LONGEST: usize = 64;

/// The known name that `name` most likely means: a few letters off, or without its unit.
pub(super) fn nearest(name: &str, known: &[&'static str]) -> Option<&'static str> {
    if name.is_empty() || name.len() > LONGEST {
        return None;
    }
    let close = known.iter().map(|known| (distance(name, known), *known)).min_by_key(|(distance, _)| *distance);
    if let Some((distance, known)) = close
        && distance <= (name.len() / 3).clamp(1, 4)
    {
        return Some(known);
    }
    known.iter().copied().find(|known| known.strip_prefix(name).is_some_and(|unit| unit.starts_with('_')))
}

/// Letters to insert, drop, change or swap with their neighbour (optimal string alignment).
fn distance(left: &str, right: &str) -> usize {
    let (left, right): (Vec<char>, Vec<char>) = (left.to_lowercase().chars().collect(), right.chars().collect());
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=right.len()).collect();
    for (row, a) in left.iter().enumerate() {
        let mut this = vec![row + 1];
        for (column, b) in right.iter().enumerate() {
            let at = |line: &[usize], index: usize| line.get(index).copied().unwrap_or(usize::MAX / 2);
            let mut least = at(&last, column) + usize::from(a != b);
            least = least.min(at(&last, column + 1) + 1).min(at(&this, column) + 1);
            let swapped = row > 0 && column > 0 && left.get(row - 1) == Some(b) && right.get(column - 1) == Some(a);
            if swapped {
                least = least.min(at(&before_last, column - 1) + 1);
            }
            this.push(least);
        }
        before_last = core::mem::replace(&mut last, this);
    }
    last.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_find_their_name() {
        let known = ["max_rpm", "inertia_kg_m2", "torque_lag_s", "torque_curve"];
        assert_eq!(nearest("max_rmp", &known), Some("max_rpm"));
        assert_eq!(nearest("MAX_RPM", &known), Some("max_rpm"));
        assert_eq!(nearest("inertia", &known), Some("inertia_kg_m2"));
        assert_eq!(nearest("torque_curv", &known), Some("torque_curve"));
        assert_eq!(nearest("colour", &known), None);
        assert_eq!(nearest("", &known), None);
        assert_eq!((distance("ab", "ba"), distance("", "abc"), distance("abc", "")), (1, 3, 3));
    }
}
