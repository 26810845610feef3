//! One hole on the simulated machine in which something fails at some moment, and what is seen of it.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::Port;
use rigidtap::control::sync::{Compensation, Settings, Stage, synchronisation_error_mm};
use rigidtap::control::tapping::Tapping;
use rigidtap::control::units::um_from_mm;
use rigidtap::sim::{Fault, Injection, Plant, PlantOptions};

const PERIOD_S: f64 = 0.001;
const PITCH_MM: f64 = 1.0;
const BOTTOM_MM: f64 = -25.0;
/// Half a pitch below the bottom the thread is given up: Z brakes at 10 m/s² before it.
const LOWEST_MM: f64 = BOTTOM_MM - 0.5 * PITCH_MM;
const Z_MM_PER_S2: f64 = 10_000.0;
/// No stop takes longer: a spindle that coasts from 7000 rpm takes a few seconds.
const LONGEST_PERIODS: u32 = 15_000;
/// Held for so long, it is held.
const HELD_PERIODS: u32 = 100;

/// What is tapped, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hole {
    pub(crate) speed_rpm: f64,
    pub(crate) compensation: Compensation,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum End {
    Done,
    Held,
    Moving,
}

impl End {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Held => "held",
            Self::Moving => "moving",
        }
    }
}

/// What was seen of one run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// First and last synchronous period.
    pub(crate) synchronous: [u32; 2],
    /// The alarm's code, and in which period of the fault it came, from 1.
    pub(crate) alarm: Option<(u32, u32)>,
    /// Greatest true |e| in the thread from the fault on.
    pub(crate) error_um: f64,
    /// Greatest change of a setpoint's speed from one period to the next, mm/s and rev/s.
    pub(crate) z_step: f64,
    pub(crate) spindle_step: f64,
    /// Deepest that the tip came.
    pub(crate) least_mm: f64,
    pub(crate) end: End,
}

/// Taps with a fault that begins in a period, or without any.
pub(crate) fn tap(hole: Hole, fault: Option<(Fault, u32)>) -> Seen {
    let machine = Machine::reference();
    let cycle = TapCycle::right_hand(0.0, BOTTOM_MM, PITCH_MM, hole.speed_rpm);
    let plan = CyclePlan::new(cycle, &machine, Law::TorqueCurve).expect("feasible");
    let injection = fault.map(|(fault, at)| Injection::new(fault, f64::from(at) * PERIOD_S));
    let faults = std::array::from_fn(|index| if index == 0 { injection } else { None });
    let mut plant = Plant::new(&machine, &PlantOptions { faults, ..PlantOptions::default() });
    plant.begin_hole(&cycle);
    let mut tapping = Tapping::new(&machine);
    let settings = Settings { compensation: hole.compensation, ..Settings::default() };
    tapping.start(plan, settings, 0.0, 0.0, 0.0).expect("a number");
    let mut fault_at = fault.map_or(0, |(_, at)| at);
    let surface_mm = -machine.spec().tap.surface_below_r_mm;
    let mut seen = Seen {
        synchronous: [0; 2],
        alarm: None,
        error_um: 0.0,
        z_step: 0.0,
        spindle_step: 0.0,
        least_mm: 0.0,
        end: End::Moving,
    };
    let (mut zero, mut held, mut given_up) = (None, 0, false);
    let (mut last, mut speeds) = (None::<[f64; 2]>, [0.0; 2]);
    for k in 0..LONGEST_PERIODS {
        let now_s = f64::from(k) * PERIOD_S;
        let feedback = plant.read(now_s);
        let truth = plant.truth().expect("a simulation knows");
        let host_s = plant.clock_s(now_s);
        // Above the surface nothing holds a tap.
        if fault.is_some_and(|(fault, _)| fault == Fault::TapJam) && seen.alarm.is_none() && truth.z_mm >= surface_mm {
            fault_at = fault_at.max(k);
        }
        let step = tapping.step(host_s, &feedback).expect("under way");
        if let (None, Some(alarm)) = (seen.alarm, step.alarm) {
            seen.alarm = Some((alarm.code(), (k + 1).saturating_sub(fault_at)));
        }
        if matches!(step.stage, Stage::Synchronous(..)) {
            seen.synchronous = [if seen.synchronous[0] == 0 { k } else { seen.synchronous[0] }, k];
            zero.get_or_insert(truth);
        }
        let positions = [step.spindle.position, step.z.position];
        if let Some(before) = last {
            let now = [0, 1].map(|axis| (positions[axis] - before[axis]) / PERIOD_S);
            if k >= fault_at {
                seen.spindle_step = seen.spindle_step.max((now[0] - speeds[0]).abs());
                seen.z_step = seen.z_step.max((now[1] - speeds[1]).abs());
            }
            speeds = now;
        }
        last = Some(positions);
        // What the last stage can just brake is not the strategy's any more.
        given_up |= speeds[1].powi(2) > 1.8 * Z_MM_PER_S2 * (step.z.position - LOWEST_MM);
        if let Some(zero) = zero {
            seen.least_mm = seen.least_mm.min(truth.z_mm);
            let in_thread = truth.z_mm < surface_mm && !given_up;
            if k >= fault_at && in_thread {
                let turned = truth.spindle_rev - zero.spindle_rev;
                let error_mm = synchronisation_error_mm(zero.z_mm - truth.z_mm, PITCH_MM, turned);
                seen.error_um = seen.error_um.max(um_from_mm(error_mm).abs());
            }
        }
        held = if step.stage == Stage::Held { held + 1 } else { 0 };
        if step.stage == Stage::Done || held >= HELD_PERIODS {
            seen.end = if held > 0 { End::Held } else { End::Done };
            break;
        }
        plant.write(now_s, &step.setpoint(State::default(), State::default()));
    }
    seen
}
