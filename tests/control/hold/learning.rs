//! What holes taught, over restarts, tool changes and holes that differ.

use rigidtap::control::cycle::TapCycle;
use rigidtap::control::model::cutting::Material;
use rigidtap::run::{HoleOutcome, Learned};
use rigidtap::sim::Actual;

use super::bench::{Bench, percentile};

const SEEDS: u64 = 12;

/// A machine whose friction and screw are not as its file says.
fn bench(seed: u64) -> Bench {
    let bench = Bench::of(Material::AlSi, 7000.0).with_sync(|sync| sync.learn = true);
    let actual = Actual { friction: 1.3, screw_error_um: 3.0, ..bench.actual };
    Bench { actual, ..bench.seeded(seed) }
}

fn worst_um(holes: &[HoleOutcome], hole: usize) -> f64 {
    holes[hole - 1].worst_um()
}

#[test]
fn the_hole_after_a_restart_is_as_good_as_without_it() {
    let (mut first, mut going_on, mut restarted) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        let mut learned = Learned::default();
        let holes = bench(seed).program(20, &mut learned);
        first.push(worst_um(&holes, 1));
        restarted.push(worst_um(&bench(seed).program(1, &mut learned), 1));
        going_on.push(worst_um(&bench(seed).program(21, &mut Learned::default()), 21));
    }
    let [first_um, going_on_um, restarted_um] =
        [&mut first, &mut going_on, &mut restarted].map(|all| percentile(all, 0.5));
    // 2.0, 1.2 and 7.4 µm: the first hole after a restart is the one that the machine still settles into.
    assert!(restarted_um < going_on_um + 1.0, "{restarted:?} {going_on:?}");
    assert!(percentile(&mut restarted, 1.0) < percentile(&mut going_on, 1.0) + 1.3, "{restarted:?} {going_on:?}");
    assert!(restarted_um < 0.35 * first_um, "{restarted_um} {first_um}");
}

#[test]
fn another_tool_begins_anew_and_the_first_one_is_still_known() {
    let (mut others, mut backs, mut changes) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        let with_tool = |tool| {
            let bench = bench(seed);
            Bench { hole: TapCycle { tool, ..bench.hole }, ..bench }
        };
        let mut learned = Learned::default();
        let first_um = with_tool(1).program(10, &mut learned)[0].worst_um();
        let mut changed = learned.clone();
        // What the machine showed of its friction and screw goes on to another tool.
        others.push(with_tool(2).program(2, &mut changed)[0].worst_um() / first_um);
        let [back_um, never_away_um] =
            [&mut changed, &mut learned].map(|known| with_tool(1).program(1, known)[0].worst_um());
        backs.push(back_um / first_um);
        changes.push((back_um - never_away_um).abs());
    }
    let [other, back] = [&mut others, &mut backs].map(|all| percentile(all, 0.5));
    assert!(other > 0.6 && other < 1.1, "{others:?}");
    assert!(back < 0.35, "{backs:?}");
    assert!(percentile(&mut changes, 1.0) < 0.3, "{changes:?}");
}

/// The setpoints of one period do not come, somewhere in the hole.
#[test]
fn a_hole_with_a_missed_period_does_not_spoil_the_next() {
    let (mut after, mut without, mut bad) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        let mut learned = Learned::default();
        bench(seed).program(10, &mut learned);
        let mut spoiled = learned.clone();
        let missing = bench(seed);
        let actual = Actual { missed_periods_per_hole: 1.0, ..missing.actual };
        bad.push(worst_um(&Bench { actual, ..missing }.program(1, &mut spoiled), 1));
        after.push(worst_um(&bench(seed).program(1, &mut spoiled), 1));
        without.push(worst_um(&bench(seed).program(1, &mut learned), 1));
    }
    let worse_um = after.iter().zip(&without).map(|(after, without)| after - without).fold(0.0, f64::max);
    assert!(worse_um < 1.0, "{worse_um} µm; {bad:?} {after:?} {without:?}");
}
