//! What makes the tail: each effect's value on the worst machines against all.

use std::collections::BTreeSet;

use super::swept_machine::SweptMachine;
use crate::sim::ActualValue;

/// One in so many machines is of the tail.
const TAIL_OF: usize = 100;

/// One effect in the tail and in all machines.
#[derive(Clone, Debug, PartialEq)]
pub struct TailShift {
    /// Key of `[actual]`; with `= word` the share of the machines that have this word, or true.
    pub key: String,
    /// Median over all machines; of a word its share.
    pub all: f64,
    /// The same over the worst hundredth by the first hole's error, at least one machine.
    pub tail: f64,
    /// Share of all machines whose value is below the tail's median, those equal to it by half: 0.5 where the effect makes
    /// nothing of the tail. Of a word 0.5 and half of the difference of the shares.
    pub rank: f64,
}

/// Every effect that differs from machine to machine, the one that lies farthest off its middle first.
pub(super) fn shifts(machines: &[SweptMachine]) -> Vec<TailShift> {
    let size = |machine: &&SweptMachine| machine.first.worst_um.abs();
    let mut sorted: Vec<_> = machines.iter().collect();
    sorted.sort_by(|left, right| size(right).total_cmp(&size(left)));
    let tail = &sorted[..machines.len().div_ceil(TAIL_OF)];
    let Some(first) = sorted.first() else { return Vec::new() };
    let mut found = Vec::new();
    for (index, (key, kind)) in first.actual.values().into_iter().enumerate() {
        let of = |machine: &&SweptMachine| machine.actual.values()[index].1;
        match kind {
            ActualValue::Number(_) => found.extend(numbers(key, sorted.iter().map(of), tail.iter().map(of))),
            ActualValue::Word(_) | ActualValue::Switch(_) => found.extend(words(key, &sorted, tail, of)),
        }
    }
    found.sort_by(|left, right| (right.rank - 0.5).abs().total_cmp(&(left.rank - 0.5).abs()));
    found
}

fn numbers(
    key: &str,
    all: impl Iterator<Item = ActualValue>,
    tail: impl Iterator<Item = ActualValue>,
) -> Option<TailShift> {
    // What a machine has nothing of is 0 of it.
    let number = |value: ActualValue| if let ActualValue::Number(Some(number)) = value { number } else { 0.0 };
    let sorted = |values: &mut dyn Iterator<Item = ActualValue>| {
        let mut numbers: Vec<f64> = values.map(number).collect();
        numbers.sort_by(f64::total_cmp);
        numbers
    };
    let (all, tail) = (sorted(&mut { all }), sorted(&mut { tail }));
    let (least, most) = (all.first()?, all.last()?);
    if least == most {
        return None;
    }
    let (all_median, tail_median) = (median(&all), median(&tail));
    let below = all.partition_point(|value| *value < tail_median);
    let up_to = all.partition_point(|value| *value <= tail_median);
    let rank = (below + up_to) as f64 / (2 * all.len()) as f64;
    Some(TailShift { key: key.to_owned(), all: all_median, tail: tail_median, rank })
}

fn median(sorted: &[f64]) -> f64 {
    let half = sorted.len() / 2;
    match (sorted.get(half.saturating_sub(1)), sorted.get(half)) {
        (Some(below), Some(above)) if sorted.len().is_multiple_of(2) => (below + above) / 2.0,
        (_, above) => above.copied().unwrap_or(f64::NAN),
    }
}

fn words(
    key: &str,
    all: &[&SweptMachine],
    tail: &[&SweptMachine],
    of: impl Fn(&&SweptMachine) -> ActualValue,
) -> Vec<TailShift> {
    let word = |machine: &&SweptMachine| match of(machine) {
        ActualValue::Word(word) => word.to_owned(),
        ActualValue::Switch(on) => on.to_string(),
        ActualValue::Number(_) => String::new(),
    };
    let known: BTreeSet<String> = all.iter().map(word).collect();
    // Of two words the second says the same as the first.
    let listed = if known.len() == 2 { 1 } else { known.len() };
    let share = |machines: &[&SweptMachine], wanted: &str| {
        machines.iter().filter(|machine| word(machine) == wanted).count() as f64 / machines.len() as f64
    };
    let varies = known.len() > 1;
    known
        .iter()
        .filter(|_| varies)
        .take(listed)
        .map(|wanted| {
            let (all, tail) = (share(all, wanted), share(tail, wanted));
            TailShift { key: format!("{key} = {wanted}"), all, tail, rank: 0.5 + (tail - all) / 2.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{Actual, FrictionModel};
    use crate::study::HoleErrors;

    fn machine(run: u32, worst_um: f64, actual: Actual) -> SweptMachine {
        let hole = HoleErrors { worst_um, ..HoleErrors::NONE };
        let (first, last) = (hole, hole);
        SweptMachine {
            run,
            seed: 0,
            actual,
            first,
            last,
            worst_growth_ratio: None,
            saturated: false,
            unstable: false,
            alarm: None,
        }
    }

    #[test]
    fn what_makes_the_error_makes_the_tail() {
        let machines: Vec<_> = (0..1000)
            .map(|run| {
                let share = f64::from(run) / 1000.0;
                let other = f64::from(run * 7 % 1000) / 1000.0;
                let reports_effort = run % 100 != 99;
                let z_friction_model = FrictionModel::ALL[run as usize % 2];
                let actual = Actual {
                    z_weight_n: share,
                    friction: other,
                    reports_effort,
                    z_friction_model,
                    ..Actual::default()
                };
                machine(run, share, actual)
            })
            .collect();
        let shifts = shifts(&machines);
        assert_eq!(shifts.len(), 4);
        assert_eq!(shifts[0].key, "z_weight_n");
        assert!((shifts[0].all - 0.4995).abs() < 1e-9 && (shifts[0].tail - 0.9945).abs() < 1e-9);
        assert!((shifts[0].rank - 0.995).abs() < 1e-9);
        let of = |key: &str| shifts.iter().find(|shift| shift.key == key).unwrap();
        assert!((of("reports_effort = false").all - 0.01).abs() < 1e-9);
        assert!((of("reports_effort = false").tail - 0.1).abs() < 1e-9);
        assert!((of("z_friction_model = lugre").rank - 0.5).abs() < 1e-9);
    }

    #[test]
    fn machines_that_are_alike_have_no_tail() {
        assert!(shifts(&[]).is_empty());
        assert!(shifts(&[machine(1, 3.0, Actual::default()), machine(2, 4.0, Actual::default())]).is_empty());
    }
}
