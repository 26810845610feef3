//! Our synchronizer with a program: the only loop in a thread of its own, which waits at each period for what the plant
//! tells, and is waited for until its setpoint is there.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::model::{Model, check_step};
use super::numbers::{TOLD, place};
use super::stored::Stored;
use crate::config::MachineFile;
use crate::control::cycle::TapCycle;
use crate::control::port::{AxisStatus, DriveState, Feedback, Port, Setpoint};
use crate::fmi::variables::{BOTTOM, HAND, HOLE, INPUT_COUNT, OUTPUT_COUNT, PITCH, POWER_ON, R_PLANE};
use crate::gcode::Command;
use crate::run::{Listener, ProgramSettings, Row, run_program};

/// Outputs of the control, in the order of the plant's inputs, and what it tells beside.
type Answer = ([f64; INPUT_COUNT], [f64; TOLD.len()]);
/// What the plant tells; none where nothing was ever set.
type Told = [Option<f64>; OUTPUT_COUNT];

/// Our synchronizer with its inputs and outputs.
pub(super) struct ControlModel {
    file: MachineFile,
    commands: Vec<Command>,
    settings: ProgramSettings,
    told: Told,
    answer: Answer,
    thread: Option<(Sender<Told>, Receiver<Answer>)>,
}

impl ControlModel {
    pub(super) fn new(stored: &Stored) -> Result<Self, String> {
        let file = stored.machine_file()?;
        let program = stored.program.as_ref().ok_or("it has no program")?;
        let commands = program.commands(&file)?;
        let settings = program.settings;
        Ok(Self { file, commands, settings, told: [None; OUTPUT_COUNT], answer: first_answer(&settings), thread: None })
    }
}

/// At rest where programs start.
fn first_answer(settings: &ProgramSettings) -> Answer {
    let mut outputs = [0.0; INPUT_COUNT];
    let [x_mm, y_mm, z_mm] = settings.run.start_mm;
    (outputs[4], outputs[8], outputs[9]) = (z_mm, x_mm, y_mm);
    (outputs[POWER_ON], outputs[HAND], outputs[PITCH]) = (1.0, 1.0, 1.0);
    (outputs, [0.0; TOLD.len()])
}

impl Model for ControlModel {
    fn set(&mut self, number: u32, value: f64) -> bool {
        let Some((1, index)) = place(number) else { return false };
        self.told[index] = Some(value);
        true
    }

    fn get(&self, number: u32) -> Option<f64> {
        match place(number)? {
            (0, index) => Some(self.answer.0[index]),
            (1, index) => Some(self.told[index].unwrap_or(0.0)),
            (3, index) => Some(self.answer.1[index]),
            _ => None,
        }
    }

    fn begin(&mut self) -> Result<(), String> {
        let (tell, told) = channel();
        let (answer, answered) = channel();
        let (file, commands, settings) = (self.file.clone(), self.commands.clone(), self.settings);
        self.answer = first_answer(&settings);
        // It ends by itself once either end of a channel is gone.
        let thread = std::thread::Builder::new().name("rigidtap control".into());
        thread
            .spawn(move || {
                let current = Rc::new(RefCell::new(first_answer(&settings)));
                let mut port = ThreadPort { told, answer, current: Rc::clone(&current), read: None, written: false };
                let mut watch = Watch(Rc::clone(&current));
                let outcome = run_program(&commands, &file.machine, &settings, &mut port, &mut watch);
                let alarm = outcome.ok().and_then(|outcome| outcome.fault).map_or(0, |fault| fault.alarm.code());
                let (outputs, _) = *current.borrow();
                let _ = port.answer.send((outputs, [0.0, 0.0, 1.0, f64::from(alarm)]));
            })
            .map_err(|error| error.to_string())?;
        self.thread = Some((tell, answered));
        Ok(())
    }

    fn step(&mut self, step_s: f64) -> Result<(), String> {
        check_step(step_s, self.file.machine.spec().control.period_s)?;
        let Some((tell, answered)) = &self.thread else { return Ok(()) };
        // After its end the control stands where it is.
        if tell.send(self.told).is_ok()
            && let Ok(answer) = answered.recv()
        {
            self.answer = answer;
        }
        Ok(())
    }
}

/// The thread's end of it.
struct ThreadPort {
    told: Receiver<Told>,
    answer: Sender<Answer>,
    current: Rc<RefCell<Answer>>,
    /// What the plant told for this period.
    read: Option<Told>,
    written: bool,
}

impl ThreadPort {
    /// Hands over the setpoint of the last period, with the hole that begins now, and waits for what the plant then tells.
    fn advance(&mut self) {
        if self.written {
            let _ = self.answer.send(*self.current.borrow());
            self.written = false;
            self.read = None;
        }
        if self.read.is_none() {
            self.read = self.told.recv().ok();
        }
    }
}

impl Port for ThreadPort {
    fn clock_s(&mut self, now_s: f64) -> f64 {
        self.advance();
        self.read.and_then(|told| told[16]).unwrap_or(now_s)
    }

    fn read(&mut self, _now_s: f64) -> Feedback {
        self.advance();
        // Whoever stepped it is gone: without samples the run ends soon.
        let told = self.read.unwrap_or([None; OUTPUT_COUNT]);
        let is_there = self.read.is_some();
        let switch = |place: usize| told[place].map(|value| value != 0.0);
        let status = |valid: usize, ready: usize, saturated: usize| AxisStatus {
            sample_valid: is_there && switch(valid).unwrap_or(true),
            drive: switch(ready).map(|on| if on { DriveState::Ready } else { DriveState::NotReady }),
            saturated: switch(saturated),
        };
        Feedback {
            spindle_counts: told[0].unwrap_or(0.0) as i64,
            z_counts: told[1].unwrap_or(0.0) as i64,
            z_motor_counts: told[2].map(|counts| counts as i64),
            spindle_torque_nm: told[3],
            z_force_n: told[4],
            spindle: status(5, 7, 9),
            z: status(6, 8, 10),
        }
    }

    fn write(&mut self, _now_s: f64, setpoint: &Setpoint) {
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
        self.current.borrow_mut().0.iter_mut().zip(set).for_each(|(output, value)| *output = value);
        self.written = true;
    }

    fn set_power(&mut self, is_on: bool) {
        self.current.borrow_mut().0[POWER_ON] = f64::from(u8::from(is_on));
    }

    fn begin_hole(&mut self, cycle: &TapCycle) {
        let (outputs, _) = &mut *self.current.borrow_mut();
        outputs[HOLE] += 1.0;
        outputs[PITCH] = cycle.pitch_mm;
        outputs[R_PLANE] = cycle.r_plane_mm;
        outputs[BOTTOM] = cycle.bottom_mm;
        outputs[HAND] = cycle.hand.sign();
    }
}

/// Keeps e(k) of the period under way.
struct Watch(Rc<RefCell<Answer>>);

impl Listener for Watch {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        let (_, told) = &mut *self.0.borrow_mut();
        told[0] = row.error_um.unwrap_or(0.0);
        told[1] = f64::from(u8::from(row.error_um.is_some()));
    }
}
