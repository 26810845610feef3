//! A machine identified from what it reports while it moves: in a [`dry_cycle`], live, or from a recording.

mod dry_cycle;
mod friction_fit;
mod lost_motion;
mod motion;
#[cfg(test)]
mod tests;

pub use dry_cycle::{dry_cycle, dry_cycle_for_linuxcnc};

use crate::control::machine::Machine;
use crate::control::model::two_mass::TwoMass;
use crate::control::port::{Feedback, Port};
use crate::control::sync::{Adaptation, Identified};
use crate::control::units::{mm_from_m, um_from_mm};
use crate::gcode::program::PlanError;
use crate::gcode::{Dialect, Options, interpret};
use crate::run::{Fault, Listener, ProgramSettings, Row, run_program};

use motion::{Motion, slides_both_ways, two_encoders};

/// What was identified of a machine, in the machine file's units; none is what its motion does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Findings {
    /// Z's sliding friction, mean of both directions and over the travel.
    pub friction_n: Option<f64>,
    /// Breakaway over sliding friction.
    pub static_ratio: Option<f64>,
    /// Speed over which the Stribeck effect decays.
    pub stribeck_mm_per_s: Option<f64>,
    /// Travel over which friction builds up after a reversal.
    pub presliding_um: Option<f64>,
    /// Z's motor less its scale at constant speed, one direction less the other.
    pub lost_motion_um: Option<f64>,
    /// The part of it that friction's wind-up of the screw does not explain, the screw as stiff as `resonance_hz` says, else
    /// as the file does.
    pub backlash_um: Option<f64>,
    /// The table's resonance on the screw, by the mass that the file says it has.
    pub resonance_hz: Option<f64>,
    /// The spindle's inertia per torque constant, over the file's.
    pub inertia_ratio: Option<f64>,
    /// The spindle motor's torque limit over the file's, where the drive stood at it.
    pub torque_limit_ratio: Option<f64>,
    /// Torque against the spindle's turning beyond the file's friction.
    pub spindle_drag_nm: Option<f64>,
}

/// Identifies a machine from what it reported, one [`Feedback`] each interpolation period without gaps; `machine` is what
/// its file says, where what the motion does not say is taken from.
///
/// Inertia, torque limit, drag, compliance and the middle of the lost motion are those of the estimator that runs in the
/// period, [`Adaptation`]. Friction over speed and lost motion at steady speed take the whole recording at once.
#[must_use]
pub fn identify(feedback: &[Feedback], machine: &Machine) -> Findings {
    let spec = machine.spec();
    let z = &spec.z_axis;
    let nominal = Identified::nominal(machine);
    let mut adaptation = Adaptation::new(machine);
    feedback.iter().for_each(|period| {
        adaptation.observe(period);
    });
    let identified = adaptation.identified();
    // What stays at its prior to the bit was not measured.
    let measured = |value: f64, prior: f64| (value != prior).then_some(value);

    let motions: Vec<_> = feedback.iter().map(|period| Motion::of(period, machine)).collect();
    let fit = slides_both_ways(&motions, machine).then(|| friction_fit::fit(&motions, machine)).flatten();
    let friction_n = fit.map(|fit| fit.coulomb_n);
    let two_encoders = two_encoders(&motions, machine);
    let lost_motion_mm = identified.z.deflection_middle_mm.filter(|_| two_encoders).map(|_| {
        let steady_mm = friction_n.and_then(|friction_n| lost_motion::steady_mm(&motions, machine, friction_n));
        steady_mm.unwrap_or(identified.z.lost_motion_mm).max(0.0)
    });
    let compliance_ratio = measured(identified.z.compliance_ratio, nominal.z.compliance_ratio).filter(|_| two_encoders);
    let stiffness = TwoMass::of_z(z).stiffness / compliance_ratio.unwrap_or(1.0);
    let deflection_mm = friction_n.map(|friction_n| mm_from_m(2.0 * friction_n * z.friction_table_share / stiffness));
    Findings {
        friction_n,
        static_ratio: fit.and_then(|fit| fit.static_ratio),
        stribeck_mm_per_s: fit.and_then(|fit| fit.stribeck_mm_per_s),
        // Where one side is not seen, the lost motion looks like its pre-sliding travel.
        presliding_um: fit.and_then(|fit| fit.presliding_um).filter(|_| two_encoders),
        lost_motion_um: lost_motion_mm.map(um_from_mm),
        backlash_um: lost_motion_mm
            .zip(deflection_mm)
            .map(|(lost_mm, deflection_mm)| um_from_mm((lost_mm - deflection_mm).max(0.0))),
        resonance_hz: compliance_ratio.map(|ratio| z.resonance_hz / ratio.sqrt()),
        inertia_ratio: measured(identified.spindle.inertia_ratio, nominal.spindle.inertia_ratio),
        torque_limit_ratio: measured(identified.spindle.torque_limit_ratio, nominal.spindle.torque_limit_ratio),
        spindle_drag_nm: measured(identified.spindle.drag_nm, nominal.spindle.drag_nm),
    }
}

/// Why the dry cycle told nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DryCycleError {
    /// The machine's file does not let it move like that.
    Refused(PlanError),
    /// The machine did not follow.
    Fault(Fault),
}

/// Runs the dry cycle on a machine that stands where [`ProgramSettings`] start, and returns what its port reported.
///
/// # Errors
/// [`DryCycleError`]
///
/// ```
/// use rigidtap::control::machine::Machine;
/// use rigidtap::run::RunSettings;
/// use rigidtap::sim::{Actual, Plant, PlantOptions};
/// use rigidtap::study::{identify, run_dry_cycle};
/// let machine = Machine::reference();
/// let actual = Actual { friction: 1.5, ..Actual::default() };
/// let z_start_mm = RunSettings::default().start_mm[2];
/// let mut plant = Plant::new(&machine, &PlantOptions { actual, z_start_mm, ..PlantOptions::default() });
/// let found = identify(&run_dry_cycle(&machine, &mut plant).unwrap(), &machine);
/// assert!((found.friction_n.unwrap() / 450.0 - 1.0).abs() < 0.05, "{found:?}");
/// ```
pub fn run_dry_cycle(machine: &Machine, port: &mut impl Port) -> Result<Vec<Feedback>, DryCycleError> {
    let program = interpret(dry_cycle(machine).as_bytes(), &Dialect::PAPER, Options::default());
    let mut recorder = FeedbackRecorder::default();
    let outcome = run_program(&program.commands, machine, &ProgramSettings::default(), port, &mut recorder)
        .map_err(DryCycleError::Refused)?;
    outcome.fault.map_or(Ok(recorder.feedback), |fault| Err(DryCycleError::Fault(fault)))
}

/// Records what the port reports, and nothing else.
#[derive(Default)]
struct FeedbackRecorder {
    feedback: Vec<Feedback>,
}

impl Listener for FeedbackRecorder {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        self.feedback.push(row.feedback);
    }
}
