//! A simulated hole. Items are simulated periods of 1 ms: 0.1 Mitem/s is 100 times real time.

use divan::Bencher;
use divan::counter::ItemsCount;
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::gcode::program::Action;
use rigidtap::run::{Executor, RunSettings};
use rigidtap::sim::{Effects, Plant, PlantOptions};

fn main() {
    divan::main();
}

/// Taps one hole of 25 mm at S7000; the periods it took.
fn tap(machine: &Machine, action: &Action, effects: Effects) -> u64 {
    let mut plant = Plant::new(machine, &PlantOptions { effects, ..PlantOptions::default() });
    let mut executor = Executor::new(machine, &mut plant, RunSettings::default());
    executor.run(action, &mut ()).expect("settles");
    (executor.now_s() / machine.spec().control.period_s).round() as u64
}

#[divan::bench]
fn hole_full(bencher: Bencher<'_, '_>) {
    hole(bencher, Effects::FULL);
}

#[divan::bench]
fn hole_ideal(bencher: Bencher<'_, '_>) {
    hole(bencher, Effects::IDEAL);
}

fn hole(bencher: Bencher<'_, '_>, effects: Effects) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    let action = Action::Tap(Box::new(CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible")));
    let periods = tap(&machine, &action, effects);
    bencher.counter(ItemsCount::new(periods)).bench_local(|| tap(&machine, &action, effects));
}
