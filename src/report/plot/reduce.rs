//! Fewer points, same picture: of each pixel column the least and the greatest value.

/// Points whose picture on an axis of `columns` columns, from `low` to `high`, is that of `points`.
///
/// Points are in rising order of x. Of each column the least and the greatest stay, in their order, with their own x; so
/// the band of the result is the band of the input, column by column.
pub(super) fn by_column(points: &[(f64, f64)], low: f64, high: f64, columns: usize) -> Vec<(f64, f64)> {
    if points.len() <= 2 * columns {
        return points.to_vec();
    }
    let column = |x: f64| ((x - low) / (high - low) * columns as f64) as usize;
    let mut kept = Vec::with_capacity(2 * columns + 2);
    for group in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let indexed = || group.iter().enumerate();
        let least = indexed().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let greatest = indexed().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let (Some(least), Some(greatest)) = (least, greatest) else { continue };
        let (first, second) = if least.0 <= greatest.0 { (least, greatest) } else { (greatest, least) };
        kept.push(*first.1);
        if first.0 != second.0 {
            kept.push(*second.1);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn band(points: &[(f64, f64)]) -> (f64, f64) {
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, y)| (low.min(*y), high.max(*y)))
    }

    proptest! {
        #[test]
        fn every_column_keeps_its_band(values in prop::collection::vec(-1e6..1e6f64, 1..3000), columns in 1..400usize) {
            let points: Vec<(f64, f64)> = values.iter().enumerate().map(|(k, y)| (k as f64, *y)).collect();
            let high = points.len() as f64;
            let kept = by_column(&points, 0.0, high, columns);
            prop_assert!(kept.len() <= (2 * columns + 2).max(1));
            prop_assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
            for column in 0..columns {
                let inside = |p: &&(f64, f64)| (p.0 / high * columns as f64) as usize == column;
                let of = |all: &[(f64, f64)]| band(&all.iter().filter(inside).copied().collect::<Vec<_>>());
                prop_assert_eq!(of(&points), of(&kept));
            }
        }
    }
}
