//! Real encoders: from bytes or files to a verdict, held against the simulator.

mod corrupt;
mod estimates;
mod faults;
mod lost_thread;
mod pecks;
mod pulled_cable;
mod recordings;
mod same_error;
mod sender_in_c;

use rigidtap::control::cycle::StrokeKind;
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::sync::Compensation;
use rigidtap::gcode::{Dialect, Options, interpret};
use rigidtap::link::board::{Encoder, Reading};
use rigidtap::link::frame::MAX_ENCODED;
use rigidtap::link::receiver::{Counters, Fastest, Receiver};
use rigidtap::link::sample::{Sample, Scale};
use rigidtap::run::analysis::{Analysis, AnalysisListener, AnalysisSettings, Cutting, MeasuredHole, MeasuredRow};
use rigidtap::run::{HoleOutcome, Listener, Row, RowStage};
use rigidtap::study::Simulation;

const ONE_HOLE: &[u8] = b"G90 M03 S7000\nG0 X0 Y0 Z10\nG81 R5 Z-20 F7000\nG80 M30\n";
const TWO_LEFT: &[u8] = b"G90 M04 S2000\nG0 X0 Y0 Z10\nG81 R5 Z-5 F2000\nX7\nG80 M30\n";

/// The reference machine at this interpolation period, its drives at least as quick.
fn machine(period_s: f64) -> Machine {
    let machine = Machine::reference().with(|spec| {
        spec.control.period_s = period_s;
        spec.drive.period_s = spec.drive.period_s.min(period_s);
    });
    machine.expect("a sound machine")
}

/// Every period of a run as a board would read it, and e(k) as the simulator has it.
#[derive(Default)]
struct Simulated {
    readings: Vec<Reading>,
    errors: Vec<Option<f64>>,
    kinds: Vec<Option<StrokeKind>>,
    holes: Vec<HoleOutcome>,
}

impl Listener for Simulated {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        let (spindle_counts, z_counts) = (row.feedback.spindle_counts, row.feedback.z_counts);
        self.readings.push(Reading { spindle_counts, z_counts });
        self.errors.push(row.error_um);
        self.kinds.push(match row.stage {
            RowStage::Stroke(kind) => Some(kind),
            _ => None,
        });
    }

    fn hole(&mut self, outcome: &HoleOutcome) {
        self.holes.push(outcome.clone());
    }
}

fn simulated(machine: &Machine, program: &[u8]) -> Simulated {
    simulated_in(machine, program, &Dialect::PAPER, Law::default())
}

fn simulated_in(machine: &Machine, program: &[u8], dialect: &Dialect, law: Law) -> Simulated {
    let program = interpret(program, dialect, Options::default());
    assert!(!program.diagnostics.has_errors(), "{:?}", program.diagnostics);
    let mut found = Simulated::default();
    let mut simulation = Simulation::of(machine.clone());
    simulation.settings.law = law;
    // What is held against the simulator here is the monitor, and a lost thread has to be lost.
    simulation.settings.run.sync.compensation = Compensation::Uncompensated;
    simulation.settings.run.sync.supervise = false;
    simulation.run(&program.commands, &mut found).expect("runs");
    found
}

/// All that an analysis says.
#[derive(Default)]
struct Monitored {
    rows: Vec<MeasuredRow>,
    holes: Vec<MeasuredHole>,
    alarms: usize,
}

impl AnalysisListener for Monitored {
    fn row(&mut self, row: &MeasuredRow) {
        self.rows.push(*row);
    }

    fn alarm(&mut self, _cutting: &Cutting) {
        self.alarms += 1;
    }

    fn hole(&mut self, hole: &MeasuredHole) {
        self.holes.push(hole.clone());
    }
}

fn settings(machine: &Machine) -> AnalysisSettings {
    AnalysisSettings { scale: Scale::of(machine), pitch_mm: 1.0, tolerance_um: machine.sync_tolerance_um(1.0) }
}

fn monitored(settings: AnalysisSettings, samples: impl IntoIterator<Item = Sample>) -> Monitored {
    let (mut analysis, mut found) = (Analysis::new(settings), Monitored::default());
    samples.into_iter().for_each(|sample| analysis.push(sample, &mut found));
    analysis.finish(&mut found);
    found
}

/// The frames of readings as they go on the line.
fn frames(readings: &[Reading], period_s: f64, bits: u8) -> Vec<Vec<u8>> {
    let mut encoder = Encoder::new(period_s, bits);
    let encode = |reading: &Reading| {
        let mut line = [0; MAX_ENCODED];
        let length = encoder.encode(*reading, &mut line);
        line[..length].to_vec()
    };
    readings.iter().map(encode).collect()
}

fn received(machine: &Machine, chunks: &[Vec<u8>]) -> (Vec<Sample>, Counters) {
    let mut receiver = Receiver::new(Fastest::of(machine));
    let mut samples = Vec::new();
    for chunk in chunks {
        receiver.receive(chunk, 0.0, &mut |sample| samples.push(sample));
    }
    (samples, receiver.counters())
}

/// One count of either encoder, the greater.
fn count_um(machine: &Machine) -> f64 {
    let scale = Scale::of(machine);
    1000.0 * (1.0 / scale.counts_per_rev).max(1.0 / scale.counts_per_mm)
}

/// Periods in which both have e(k), and the greatest difference.
fn worst_difference_um(simulated: &Simulated, monitored: &Monitored) -> (usize, f64) {
    let both = monitored.rows.iter().filter_map(|row| simulated.errors[row.sample.k as usize].zip(row.error_um));
    both.fold((0, 0.0), |(count, worst), (due, found)| (count + 1, f64::max(worst, (due - found).abs())))
}

/// The monitor has e(k) wherever the simulator has it, to one count of either encoder.
fn assert_same_error(machine: &Machine, simulated: &Simulated, monitored: &Monitored) {
    let count_um = count_um(machine);
    let (compared, worst_um) = worst_difference_um(simulated, monitored);
    let due = simulated.errors.iter().flatten().count();
    assert!(worst_um <= count_um * 1.000_001, "{worst_um} µm of {count_um}");
    assert!(compared as f64 > 0.97 * due as f64, "{compared} of {due} periods");
    assert_eq!(simulated.holes.len(), monitored.holes.len());
    for (due, found) in simulated.holes.iter().zip(&monitored.holes) {
        for (due, found) in [(due.error_um.min(), found.error_um.min()), (due.error_um.max(), found.error_um.max())] {
            assert!((due - found).abs() <= 2.0 * count_um, "{due} µm, found {found}");
        }
        assert_eq!(
            found.judgement().name(),
            rigidtap::run::Verdict::of(due.error_um.peak_to_peak(), due.tolerance_um).name()
        );
    }
}
