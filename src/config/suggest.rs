//! "Did you mean": the nearest of some known names.

/// Names longer than this are no typing slip of ours.
const LONGEST: usize = 64;

/// The known name that `name` most likely means: a few letters off, or without its unit.
pub(super) fn nearest(name: &str, known: &[&'static str]) -> Option<&'static str> {
    if name.is_empty() || name.len() > LONGEST {
        return None;
    }
    // Letters to insert, drop, change or swap with their neighbour.
    let lower = name.to_lowercase();
    let distances = known.iter().map(|known| (strsim::osa_distance(&lower, known), *known));
    let close = distances.min_by_key(|(distance, _)| *distance);
    if let Some((distance, known)) = close
        && distance <= (name.len() / 3).clamp(1, 4)
    {
        return Some(known);
    }
    known.iter().copied().find(|known| known.strip_prefix(name).is_some_and(|unit| unit.starts_with('_')))
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
    }
}
