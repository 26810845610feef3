//! What makes the tail: each effect's value on the worst machines against all.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::io;

use super::ranked::at_ranks;
use super::records::Records;
use super::swept_machine::{SweptMachine, badness};
use crate::sim::{ACTUAL_VALUES, Actual, ActualValue};

/// One in so many machines is of the tail.
const TAIL_OF: u64 = 100;

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
pub(super) fn shifts(records: &mut Records) -> io::Result<Vec<TailShift>> {
    let machines = records.machines();
    if machines == 0 {
        return Ok(Vec::new());
    }
    let tail = Tail::of(records)?;
    let middle = |count: u64| [count.saturating_sub(1) / 2, count / 2];
    let wanted = |count: u64| -> Vec<_> {
        (0..ACTUAL_VALUES).flat_map(|column| middle(count).map(|rank| (column, rank))).collect()
    };
    let all = at_ranks(&wanted(machines), machines, &mut |see| records.each(&mut |machine| see(&numbers(machine))))?;
    let worst = at_ranks(&wanted(tail.machines), tail.machines, &mut |see| {
        let mut is_worst = tail.members();
        records.each_of(&mut is_worst, &mut |machine| see(&numbers(machine)))
    })?;
    // Of an even number the median is the mean of the two in the middle; of an odd one both are the same value.
    let medians = |found: &[f64]| -> Vec<f64> {
        let pairs = found.chunks_exact(2);
        pairs.map(|pair| if pair[0] == pair[1] { pair[0] } else { (pair[0] + pair[1]) / 2.0 }).collect()
    };
    let (all, worst) = (medians(&all), medians(&worst));

    let mut seen: Vec<_> = worst.iter().map(|median| Seen::new(*median)).collect();
    let mut is_worst = tail.members();
    records.each(&mut |machine| {
        let in_tail = is_worst(machine);
        for (one, (_, value)) in seen.iter_mut().zip(machine.actual.values()) {
            one.add(value, in_tail);
        }
    })?;
    let mut found = Vec::new();
    for (index, (key, kind)) in Actual::default().values().into_iter().enumerate() {
        let one = &seen[index];
        match kind {
            ActualValue::Number(_) if one.least == one.most => {}
            ActualValue::Number(_) => {
                let rank = (2 * one.below + one.equal) as f64 / (2 * machines) as f64;
                found.push(TailShift { key: key.to_owned(), all: all[index], tail: worst[index], rank });
            }
            ActualValue::Word(_) | ActualValue::Switch(_) => {
                found.extend(words(key, &one.words, machines, tail.machines));
            }
        }
    }
    found.sort_by(|left, right| (right.rank - 0.5).abs().total_cmp(&(left.rank - 0.5).abs()));
    Ok(found)
}

/// The worst hundredth, at least one machine: those worse than a bound, and the first so many that are just as bad.
struct Tail {
    machines: u64,
    bound_um: f64,
    just_as_bad: u64,
}

impl Tail {
    fn of(records: &mut Records) -> io::Result<Self> {
        let all = records.machines();
        let machines = all.div_ceil(TAIL_OF);
        let bound = at_ranks(&[(0, all - machines)], all, &mut |see| {
            records.each_outcome(&mut |machine| see(&[badness(machine)]))
        })?;
        let bound_um = bound.first().copied().unwrap_or(f64::NAN);
        let mut worse = 0;
        records.each_outcome(&mut |machine| worse += u64::from(badness(machine).total_cmp(&bound_um).is_gt()))?;
        Ok(Self { machines, bound_um, just_as_bad: machines - worse })
    }

    /// Says of each machine in the order of their numbers whether it is of the tail.
    fn members(&self) -> impl FnMut(&SweptMachine) -> bool + use<> {
        let (bound_um, mut left) = (self.bound_um, self.just_as_bad);
        move |machine| match badness(machine).total_cmp(&bound_um) {
            Ordering::Greater => true,
            Ordering::Equal if left > 0 => {
                left -= 1;
                true
            }
            _ => false,
        }
    }
}

/// What a machine has nothing of is 0 of it; so is what is no number.
fn number(value: ActualValue) -> f64 {
    if let ActualValue::Number(Some(number)) = value { number } else { 0.0 }
}

fn numbers(machine: &SweptMachine) -> [f64; ACTUAL_VALUES] {
    machine.actual.values().map(|(_, value)| number(value))
}

/// One effect over all machines.
struct Seen {
    tail_median: f64,
    below: u64,
    equal: u64,
    least: f64,
    most: f64,
    /// Of each word, or yes and no, how many machines have it: in all, and in the tail.
    words: BTreeMap<&'static str, [u64; 2]>,
}

impl Seen {
    fn new(tail_median: f64) -> Self {
        let words = BTreeMap::new();
        Self { tail_median, below: 0, equal: 0, least: f64::INFINITY, most: f64::NEG_INFINITY, words }
    }

    fn add(&mut self, value: ActualValue, in_tail: bool) {
        let word = match value {
            ActualValue::Word(word) => word,
            ActualValue::Switch(on) => ["false", "true"][usize::from(on)],
            ActualValue::Number(_) => {
                let number = number(value);
                self.below += u64::from(number < self.tail_median);
                self.equal += u64::from(number == self.tail_median);
                (self.least, self.most) = (self.least.min(number), self.most.max(number));
                return;
            }
        };
        let [all, tail] = self.words.entry(word).or_default();
        *all += 1;
        *tail += u64::from(in_tail);
    }
}

fn words(key: &str, known: &BTreeMap<&str, [u64; 2]>, all: u64, tail: u64) -> Vec<TailShift> {
    // Of one word there is nothing to tell, and of two words the second says the same as the first.
    let listed = if known.len() <= 2 { known.len() / 2 } else { known.len() };
    let shift = |(word, [in_all, in_tail]): (&&str, &[u64; 2])| {
        let (all, tail) = (*in_all as f64 / all as f64, *in_tail as f64 / tail as f64);
        TailShift { key: format!("{key} = {word}"), all, tail, rank: 0.5 + (tail - all) / 2.0 }
    };
    known.iter().take(listed).map(shift).collect()
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::*;
    use crate::sim::{FrictionModel, HardSpread, Spread};
    use crate::study::sweep::machine_run::draw;
    use crate::study::sweep::records::RecordWriter;
    use crate::study::sweep::settings::SweepSettings;
    use crate::study::sweep::swept_machine::HoleErrors;

    /// Machines as they are drawn, each as bad as `of` says.
    fn machines(runs: u32, drawn: bool, of: impl Fn(&Actual) -> f64) -> (Vec<SweptMachine>, Records) {
        let settings = SweepSettings {
            runs: NonZeroU32::new(runs).unwrap(),
            seed: 3,
            holes: NonZeroU32::MIN,
            spread: drawn.then(Spread::default),
            hard: drawn.then(HardSpread::default),
            jobs: None,
        };
        let mut writer = RecordWriter::new(&settings, &std::env::temp_dir());
        let nominal = Actual::default();
        let all: Vec<_> = (1..=runs)
            .map(|run| {
                let (actual, seed) = draw(&settings, nominal, run);
                let first = HoleErrors { worst_um: of(&actual), ..HoleErrors::NONE };
                let (last, worst_growth_ratio) = (first, None);
                let (saturated, unstable, alarm) = (false, false, None);
                SweptMachine { run, seed, actual, first, last, worst_growth_ratio, saturated, unstable, alarm }
            })
            .collect();
        all.iter().for_each(|machine| writer.add(machine).unwrap());
        (all, Records::new(vec![writer.finish(1).unwrap()], &settings, nominal))
    }

    fn median(mut values: Vec<f64>) -> f64 {
        values.sort_by(f64::total_cmp);
        (values[(values.len() - 1) / 2] + values[values.len() / 2]) / 2.0
    }

    /// Against the same by sorting everything, of more machines than are sorted at once.
    #[test]
    fn what_makes_the_error_makes_the_tail() {
        for runs in [999, 20_000] {
            let (mut all, mut records) = machines(runs, true, |actual| actual.z_weight_n + 1500.0);
            let shifts = shifts(&mut records).unwrap();
            all.sort_by(|left, right| right.first.worst_um.total_cmp(&left.first.worst_um));
            let tail = &all[..all.len().div_ceil(100)];
            let of = |key: &str| shifts.iter().find(|shift| shift.key == key).unwrap();
            let mut largest = 0.0_f64;
            for (index, (key, kind)) in Actual::default().values().into_iter().enumerate() {
                if !matches!(kind, ActualValue::Number(_)) || !shifts.iter().any(|shift| shift.key == key) {
                    continue;
                }
                let value = |machine: &SweptMachine| number(machine.actual.values()[index].1);
                let (in_all, in_tail) =
                    (median(all.iter().map(value).collect()), median(tail.iter().map(value).collect()));
                let below = all.iter().filter(|machine| value(machine) < in_tail).count();
                let equal = all.iter().filter(|machine| value(machine) == in_tail).count();
                let rank = (2 * below + equal) as f64 / (2 * all.len()) as f64;
                let due = TailShift { key: key.to_owned(), all: in_all, tail: in_tail, rank };
                assert_eq!(of(key), &due);
                largest = largest.max((rank - 0.5).abs());
            }
            assert_eq!((shifts[0].key.as_str(), (shifts[0].rank - 0.5).abs()), ("z_weight_n", largest));
            assert!((shifts[0].rank - 0.995).abs() < 1e-3);
            let share = |machines: &[SweptMachine]| {
                let count = machines.iter().filter(|machine| !machine.actual.reports_effort).count();
                count as f64 / machines.len() as f64
            };
            let silent = of("reports_effort = false");
            assert_eq!((silent.all, silent.tail), (share(&all), share(tail)));
            for model in FrictionModel::ALL {
                let drawn = all.iter().any(|machine| machine.actual.z_friction_model == model);
                let key = format!("z_friction_model = {}", model.name());
                assert_eq!(shifts.iter().any(|shift| shift.key == key), drawn);
            }
        }
    }

    #[test]
    fn machines_that_are_alike_have_no_tail() {
        assert!(shifts(&mut machines(2, false, |_| 3.0).1).unwrap().is_empty());
    }

    /// All as bad as each other: the first hundredth is the tail.
    #[test]
    fn of_equals_the_first_are_the_tail() {
        let (all, mut records) = machines(500, true, |_| f64::NAN);
        let mut is_worst = Tail::of(&mut records).unwrap().members();
        let runs: Vec<_> = all.iter().filter(|machine| is_worst(machine)).map(|machine| machine.run).collect();
        assert_eq!(runs, [1, 2, 3, 4, 5]);
    }
}
