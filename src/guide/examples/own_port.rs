//! A program against a machine of one's own, behind the `Port` trait: here one whose axes act three periods late.
//!
//! `cargo run --example own_port`
#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use std::collections::VecDeque;

use rigidtap::control::machine::Machine;
use rigidtap::control::port::{Feedback, Port, Setpoint};
use rigidtap::control::sync::{Compensation, Settings};
use rigidtap::gcode::{Dialect, Options, interpret};
use rigidtap::run::{HoleOutcome, Listener, ProgramSettings, Row, RunSettings, run_program};

/// Periods after which a setpoint is where the axes are.
const DELAY: usize = 3;

/// Axes that follow exactly, and late.
#[derive(Default)]
struct LateMachine {
    setpoints: VecDeque<Setpoint>,
}

impl Port for LateMachine {
    fn read(&mut self, _now_s: f64) -> Feedback {
        let Some(now) = self.setpoints.front() else {
            // Before the first setpoint Z stands where the program starts.
            let z_counts = (RunSettings::default().start_mm[2] * 10_000.0) as i64;
            return Feedback { z_counts, ..Feedback::default() };
        };
        Feedback {
            spindle_counts: (now.spindle.position * 16_384.0).round() as i64,
            z_counts: (now.z.position * 10_000.0).round() as i64,
            ..Feedback::default()
        }
    }

    fn write(&mut self, _now_s: f64, setpoint: &Setpoint) {
        self.setpoints.push_back(*setpoint);
        if self.setpoints.len() > DELAY {
            self.setpoints.pop_front();
        }
    }
}

/// Prints each hole once it is done.
struct Printer;

impl Listener for Printer {
    fn row(&mut self, _pitch_mm: f64, _row: &Row) {}

    fn hole(&mut self, hole: &HoleOutcome) {
        let (verdict, error_um) = (hole.verdict().name(), hole.error_um.peak_to_peak());
        println!("hole {}: {verdict}, {error_um:.1} µm peak to peak", hole.hole);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let program = b"G90 M03 S2000\nG0 X0 Y0 Z10\nG81 X0 Y0 R3 Z-8 F2000\nX10\nG80\nM30\n";
    let program = interpret(program, &Dialect::PAPER, Options::default());
    assert!(!program.diagnostics.has_errors());
    let run = RunSettings {
        sync: Settings { compensation: Compensation::Uncompensated, ..Settings::default() },
        ..RunSettings::default()
    };
    let settings = ProgramSettings { run, ..ProgramSettings::default() };
    let machine = Machine::reference();
    let outcome = run_program(&program.commands, &machine, &settings, &mut LateMachine::default(), &mut Printer)
        .map_err(|error| error.to_string())?;
    println!("{} holes in {:.3} s", outcome.holes.len(), outcome.total_s);
    Ok(())
}
