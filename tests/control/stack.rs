//! The stack that planning and stepping take, found by threads of less and less of it.
//!
//! A thread that runs out of stack ends its process, so each size is tried in a process of its own: this test binary again,
//! told by the environment what to do.

use std::env;
use std::process::{Command, Stdio};
use std::thread;

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::Settings;
use rigidtap::control::tapping::Tapping;

const TASK: &str = "RIGIDTAP_STACK_TASK";
const BYTES: &str = "RIGIDTAP_STACK_BYTES";
/// What a thread takes that does nothing.
const NOTHING: &str = "nothing";

fn hole() -> TapCycle {
    TapCycle { peck_mm: Some(8.0), ..TapCycle::right_hand(0.0, -20.0, 1.0, 4000.0) }
}

/// Runs a task on a thread of its own; everything large stays outside of it.
fn run(task: &str, bytes: usize) {
    let machine = Box::new(Machine::reference());
    let mut plan = Box::new(CyclePlan::new(hole(), &machine, Law::TorqueCurveSmooth).expect("feasible"));
    let mut tapping = Box::new(Tapping::new(&machine));
    let settings = Settings { learn: true, ..Settings::default() };
    if task == "step" {
        tapping.start((*plan).clone(), settings, 0.0, 0.0, 0.0).expect("at rest");
    }
    let task = task.to_owned();
    let job = move || match task.as_str() {
        "plan" => *plan = CyclePlan::new(hole(), &machine, Law::TorqueCurveSmooth).expect("feasible"),
        "start" => tapping.start(*plan, settings, 0.0, 0.0, 3000.0).expect("a speed"),
        "step" => {
            let mut feedback = Feedback::default();
            for period in 0..700 {
                let step = tapping.step(f64::from(period) * 0.001, &feedback).expect("under way");
                feedback.spindle_counts = (step.spindle.position * 16_384.0).round() as i64;
                feedback.z_counts = (step.z.position * 10_000.0).round() as i64;
            }
        }
        _ => {}
    };
    thread::Builder::new().stack_size(bytes).spawn(job).expect("a thread").join().expect("it does not panic");
}

#[test]
#[ignore = "what the tests below start again and again"]
fn child() {
    let (Ok(task), Ok(bytes)) = (env::var(TASK), env::var(BYTES)) else { return };
    run(&task, bytes.parse().expect("a number"));
}

fn survives(task: &str, bytes: usize) -> bool {
    let binary = env::current_exe().expect("this test");
    let mut child = Command::new(binary);
    child.args(["--ignored", "--exact", "stack::child"]).env(TASK, task).env(BYTES, bytes.to_string());
    child.stdout(Stdio::null()).stderr(Stdio::null()).status().expect("it starts").success()
}

/// Least stack of a task in kB, what a thread takes anyway left out.
fn stack_kb(task: &str) -> usize {
    let least = |task: &str| {
        let (mut low, mut high) = (0, 512);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if survives(task, middle * 1024) { high = middle } else { low = middle }
        }
        high
    };
    least(task).saturating_sub(least(NOTHING))
}

/// `src/guide/embedding.md` states these bounds.
#[test]
fn planning_and_stepping_stay_within_the_stack_that_the_guide_states() {
    for (task, most_kb) in [("plan", 48), ("start", 160), ("step", 48)] {
        let kb = stack_kb(task);
        assert!(kb <= most_kb, "{task} takes {kb} kB of stack");
    }
}
