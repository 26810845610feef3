//! `rigidtap monitor --simulate-board`: a board that streams a simulated program over a pseudo-terminal.

use std::path::Path;

use crate::config::MachineFile;

use super::args::Common;
use super::outcome::{Outcome, Stop};

/// Streams a program again and again, until Ctrl-C.
#[cfg(unix)]
pub(super) fn run(common: &Common, file: &MachineFile, program: &Path, rate_hz: Option<f64>) -> Result<Outcome, Stop> {
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use serialport::{SerialPort, TTYPort};

    use crate::control::machine::Law;
    use crate::gcode::Options;
    use crate::gcode::program::Overrides;
    use crate::link::board::{Encoder, Reading, stream};
    use crate::run::{Listener, Row};
    use crate::study::Simulation;

    /// Width of the simulated board's counters.
    const BITS: u8 = 32;

    /// What the board's counters show, period by period.
    struct Readings(Vec<Reading>);

    impl Listener for Readings {
        fn row(&mut self, _pitch_mm: f64, row: &Row) {
            let (spindle_counts, z_counts) = (row.feedback.spindle_counts, row.feedback.z_counts);
            self.0.push(Reading { spindle_counts, z_counts });
        }
    }

    let machine = match rate_hz {
        None => file.machine.clone(),
        // The simulation runs at the board's rate, so that each reading is one period of it.
        Some(rate_hz) => file
            .machine
            .with(|spec| {
                spec.control.period_s = 1.0 / rate_hz;
                let ticks = (spec.control.period_s / spec.drive.period_s).round().max(1.0);
                spec.drive.period_s = spec.control.period_s / ticks;
            })
            .map_err(super::input::unusable)?,
    };
    let reading = super::input::dialect(common, file)?;
    let path = [program.to_owned()];
    let mut read = super::input::programs(common, &path, &reading, &machine, &[Law::default()], Overrides::default())?;
    let mut readings = Readings(Vec::new());
    for program in &mut read {
        let mut simulation = Simulation { actual: file.actual, ..Simulation::of(machine.clone()) };
        simulation.settings.run.start_mm = Options::default().start_mm;
        simulation
            .run(program.commands(), &mut readings)
            .map_err(|error| Stop::Usage(format!("{}: {error}", program.name)))?;
        program.intact()?;
    }
    let output = |error: std::io::Error| Stop::Output { name: "the pseudo-terminal".into(), error };
    // The listener's end stays open here, too: the board outlives whoever listens.
    let (mut line, listener) = TTYPort::pair().map_err(|error| output(error.into()))?;
    super::outcome::print(&format!("{}\n", listener.name().unwrap_or_default()))?;
    let stop = super::interrupt::stop_on_ctrl_c();
    let period = Duration::from_secs_f64(machine.spec().control.period_s);
    while !stop.load(Ordering::Relaxed) {
        let going = readings.0.iter().copied().take_while(|_| !stop.load(Ordering::Relaxed));
        stream(going, period, &mut Encoder::new(period.as_secs_f64(), BITS), &mut line).map_err(output)?;
    }
    Ok(Outcome::Good)
}

/// Only unix has pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn run(_: &Common, _: &MachineFile, _: &Path, _: Option<f64>) -> Result<Outcome, Stop> {
    Err(Stop::Usage("--simulate-board needs a pseudo-terminal, which this system has not".into()))
}
