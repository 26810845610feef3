//! An FMU as the plant: a port like our own machine.

use std::io::{self, BufReader};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::binding::Binding;
use super::error::{FmuError, Instant};
use super::host::actual_keys;
use super::unpack::{Unpacked, library_path, unpack};
use super::variables::{BOTTOM, HAND, HOLE, INPUT_COUNT, OUTPUT_COUNT, PITCH, POWER_ON, R_PLANE};
use super::wire::{Outputs, Request, Start, Step, read_answer};
use crate::control::cycle::TapCycle;
use crate::control::port::{AxisStatus, DriveState, Feedback, Port, Setpoint, Truth};
use crate::sim::{Actual, ActualValue};
use crate::study::PlantSource;

/// Longest time for one answer.
const LONGEST_ANSWER: Duration = Duration::from_secs(10);

/// An FMU that was read and checked; every run has an instance of it.
#[derive(Debug)]
pub struct FmuSource {
    unpacked: Unpacked,
    /// Program and first words that run it: the folder comes behind them.
    host: (PathBuf, Vec<String>),
    /// The first thing that went wrong in any run.
    failed: Arc<Mutex<Option<FmuError>>>,
    /// Processes that wait for the next run.
    idle: Arc<Mutex<Vec<Process>>>,
}

impl FmuSource {
    /// Reads an FMU and checks its variables. `host` is the command that [`serve`](super::serve)s the folder behind it.
    ///
    /// # Errors
    /// [`FmuError`] where it is none, or no plant.
    pub fn open(path: &Path, host: (PathBuf, Vec<String>)) -> Result<Self, FmuError> {
        let unpacked = unpack(path)?;
        Binding::new(&unpacked.description, &actual_keys())?;
        let library = library_path(&unpacked.description);
        if !unpacked.folder.path().join(&library).is_file() {
            return Err(FmuError::NoLibrary { path: library });
        }
        Ok(Self { unpacked, host, failed: Arc::default(), idle: Arc::default() })
    }

    /// The step that the FMU is bound to, where it is to one, s.
    #[must_use]
    pub fn fixed_step_s(&self) -> Option<f64> {
        self.unpacked.description.fixed_step_s
    }

    fn process(&self) -> Result<Process, FmuError> {
        let waiting = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        waiting.map_or_else(|| Process::start(&self.host, self.unpacked.folder.path()), Ok)
    }
}

impl PlantSource for FmuSource {
    fn start(&self, actual: &Actual, seed: u64, z_start_mm: f64, period_s: f64) -> Box<dyn Port> {
        let mut plant = FmuPlant {
            process: None,
            outputs: [None; OUTPUT_COUNT],
            pending: None,
            inputs: [0.0; INPUT_COUNT],
            failed: Arc::clone(&self.failed),
            idle: Arc::clone(&self.idle),
            period_s,
        };
        plant.inputs[POWER_ON] = 1.0;
        plant.inputs[HAND] = 1.0;
        let mut parameters = vec![("seed".to_owned(), seed as f64), ("z_start_mm".to_owned(), z_start_mm)];
        parameters.extend(actual.values().into_iter().filter_map(|(key, value)| match value {
            ActualValue::Number(number) => Some((key.to_owned(), number?)),
            ActualValue::Switch(on) => Some((key.to_owned(), f64::from(u8::from(on)))),
            ActualValue::Word(_) => None,
        }));
        match self.process() {
            Ok(process) => {
                plant.process = Some(process);
                plant.ask(&Request::Start(Start { parameters }), None);
            }
            Err(error) => plant.fail(error),
        }
        Box::new(plant)
    }

    fn error(&self) -> Option<String> {
        let failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
        failed.as_ref().map(ToString::to_string)
    }
}

/// A process with the other end of its standard input.
#[derive(Debug)]
struct Process {
    child: Child,
    from: BufReader<UnixStream>,
    to: UnixStream,
}

impl Process {
    fn start((program, words): &(PathBuf, Vec<String>), folder: &Path) -> Result<Self, FmuError> {
        let begin = || -> io::Result<Self> {
            let (ours, theirs) = UnixStream::pair()?;
            ours.set_read_timeout(Some(LONGEST_ANSWER))?;
            let child = Command::new(program)
                .args(words)
                .arg(folder)
                .stdin(Stdio::from(OwnedFd::from(theirs)))
                // What an FMU prints is no answer of ours.
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()?;
            Ok(Self { child, from: BufReader::new(ours.try_clone()?), to: ours })
        };
        begin().map_err(|error| FmuError::Process(error.to_string()))
    }

    fn ask(&mut self, request: &Request, time_s: Option<Instant>) -> Result<Outputs, FmuError> {
        let answer = request.write(&mut self.to).and_then(|()| read_answer(&mut self.from));
        match answer {
            Ok(answer) => answer.map_err(|message| FmuError::Call { time_s, message }),
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                Err(FmuError::Slow { time_s, limit_s: LONGEST_ANSWER.as_secs() })
            }
            Err(_) => {
                let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
                Err(FmuError::Crashed { time_s, status })
            }
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may hang in the FMU's code: it is not asked.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One run of an FMU.
struct FmuPlant {
    /// None once it failed.
    process: Option<Process>,
    outputs: Outputs,
    inputs: [f64; INPUT_COUNT],
    /// Time of the step that is due: it is made once the next period begins, so that a hole that begins meanwhile is told with it.
    pending: Option<f64>,
    failed: Arc<Mutex<Option<FmuError>>>,
    idle: Arc<Mutex<Vec<Process>>>,
    period_s: f64,
}

impl FmuPlant {
    fn fail(&mut self, error: FmuError) {
        self.process = None;
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    fn flush(&mut self) {
        if let Some(time_s) = self.pending.take() {
            let step = Step { time_s, step_s: self.period_s, inputs: self.inputs };
            self.ask(&Request::Step(step), Some(Instant::of_s(time_s)));
        }
    }

    fn ask(&mut self, request: &Request, time_s: Option<Instant>) {
        let Some(process) = &mut self.process else { return };
        match process.ask(request, time_s) {
            Ok(outputs) => self.outputs = outputs,
            Err(error) => self.fail(error),
        }
    }

    fn count(&self, place: usize) -> Option<i64> {
        self.outputs.get(place).copied().flatten().map(u64::cast_signed)
    }

    fn real(&self, place: usize) -> Option<f64> {
        self.outputs.get(place).copied().flatten().map(f64::from_bits)
    }

    fn switch(&self, place: usize) -> Option<bool> {
        self.real(place).map(|value| value != 0.0)
    }

    fn status(&self, valid: usize, ready: usize, saturated: usize) -> AxisStatus {
        AxisStatus {
            // After a failure nothing is a sample, and the control ends the run.
            sample_valid: self.process.is_some() && self.switch(valid).unwrap_or(true),
            drive: self.switch(ready).map(|on| if on { DriveState::Ready } else { DriveState::NotReady }),
            saturated: self.switch(saturated),
        }
    }
}

impl Port for FmuPlant {
    fn clock_s(&mut self, now_s: f64) -> f64 {
        self.flush();
        self.real(16).unwrap_or(now_s)
    }

    fn read(&mut self, _now_s: f64) -> Feedback {
        self.flush();
        Feedback {
            spindle_counts: self.count(0).unwrap_or(0),
            z_counts: self.count(1).unwrap_or(0),
            z_motor_counts: self.count(2),
            spindle_torque_nm: self.real(3),
            z_force_n: self.real(4),
            spindle: self.status(5, 7, 9),
            z: self.status(6, 8, 10),
        }
    }

    fn write(&mut self, now_s: f64, setpoint: &Setpoint) {
        let Setpoint { spindle, x, y, z, spindle_torque_nm, z_force_n } = setpoint;
        let set = [
            spindle.position,
            spindle.velocity,
            spindle.acceleration,
            spindle.jerk,
            z.position,
            z.velocity,
            z.acceleration,
            z.jerk,
            x.position,
            y.position,
            *spindle_torque_nm,
            *z_force_n,
        ];
        self.inputs.iter_mut().zip(set).for_each(|(input, value)| *input = value);
        self.pending = Some(now_s);
    }

    fn set_power(&mut self, is_on: bool) {
        self.flush();
        self.inputs[POWER_ON] = f64::from(u8::from(is_on));
    }

    fn begin_hole(&mut self, cycle: &TapCycle) {
        self.inputs[HOLE] += 1.0;
        self.inputs[PITCH] = cycle.pitch_mm;
        self.inputs[R_PLANE] = cycle.r_plane_mm;
        self.inputs[BOTTOM] = cycle.bottom_mm;
        self.inputs[HAND] = cycle.hand.sign();
    }

    fn truth(&self) -> Option<Truth> {
        Some(Truth {
            spindle_rev: self.real(11)?,
            z_mm: self.real(12)?,
            spindle_rpm: self.real(13).unwrap_or(f64::NAN),
            spindle_torque_nm: self.real(14).unwrap_or(f64::NAN),
            z_force_n: self.real(15).unwrap_or(f64::NAN),
        })
    }
}

impl Drop for FmuPlant {
    fn drop(&mut self) {
        if let Some(process) = self.process.take() {
            self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(process);
        }
    }
}
