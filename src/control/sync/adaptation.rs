//! What outlives a hole: what the machine has shown of itself, what repeated holes have taught, and what fades after each.

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;
use crate::control::math::{exp, poly::State};
use crate::control::port::{Feedback, Setpoint};

use super::identify::{Identification, Identified};
use super::learning::Learning;

/// A hole's force feedforward fades in this many integral times of Z's drive, which takes it over without being moved.
const FORCE_INTEGRALS: f64 = 200.0;

/// What Z's drive is still commanded beyond a move after a hole: dropped at once it would be a blow. Machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lingering {
    /// Beside Z's setpoint, in mm. It falls as the drive's position loop lets a reference fall without being felt.
    pub z: State,
    /// Beside Z's force feedforward.
    pub z_force_n: f64,
}

impl Lingering {
    /// A setpoint of a move after a hole, with what lingers of the hole.
    #[must_use]
    pub fn onto(&self, setpoint: Setpoint) -> Setpoint {
        let Setpoint { z, z_force_n, .. } = setpoint;
        let z = State { velocity: z.velocity + self.z.velocity, ..z.shifted(self.z.position) };
        Setpoint { z, z_force_n: z_force_n + self.z_force_n, ..setpoint }
    }
}

/// Handed from hole to hole, and shown each period between them.
///
/// ```
/// use rigidtap::control::{machine::Machine, port::Feedback, sync::{Adaptation, Identified}};
/// let machine = Machine::reference();
/// let mut adaptation = Adaptation::new(&machine);
/// adaptation.observe(&Feedback::default());
/// // A machine that has not moved is taken for what its file says.
/// assert_eq!(adaptation.identified(), Identified::nominal(&machine));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Adaptation {
    identification: Identification,
    pub(super) learning: Learning,
    lingering: Lingering,
    /// Z's position gain, and what one period leaves of a position and of a force.
    z_gain_per_s: f64,
    position_kept: f64,
    force_kept: f64,
}

impl Adaptation {
    /// A machine that has not moved yet.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let (spec, period_s) = (machine.spec(), machine.spec().control.period_s);
        let z_gain_per_s = spec.drive.z_position_gain_per_s;
        Self {
            identification: Identification::new(machine),
            learning: Learning::new(spec.sync, period_s),
            lingering: Lingering::default(),
            z_gain_per_s,
            position_kept: exp(-z_gain_per_s * period_s),
            force_kept: exp(-period_s / (FORCE_INTEGRALS * spec.drive.z_integral_s)),
        }
    }

    /// One period's feedback, outside a hole; from a hole's first synchronous period on the synchronizer does it.
    pub fn observe(&mut self, feedback: &Feedback) {
        self.identification.observe(feedback);
        self.linger(self.position_kept * self.lingering.z.position, self.force_kept * self.lingering.z_force_n);
    }

    /// What the last hole left; to be added to Z's setpoints until the next one starts. A host that does not goes on from
    /// Z's last setpoint.
    #[must_use]
    pub fn lingering(&self) -> Lingering {
        self.lingering
    }

    /// A hole has ended so far from R, with such a force.
    pub(super) fn linger(&mut self, z_mm: f64, z_force_n: f64) {
        let z = State { position: z_mm, velocity: -self.z_gain_per_s * z_mm, ..State::default() };
        self.lingering = Lingering { z, z_force_n };
    }

    /// Periods have passed unseen: the next one's feedback is not measured against the last.
    pub fn note_gap(&mut self) {
        self.identification.note_gap();
    }

    /// What is known of the machine by now: what it has shown, as far as it has, else what its file says.
    #[must_use]
    pub fn identified(&self) -> Identified {
        self.identification.identified()
    }

    /// What its file says.
    pub(super) fn nominal(&self) -> Identified {
        self.identification.nominal()
    }

    /// Z's motor less its scale in one period.
    pub(super) fn z_twist_mm(&self, feedback: &Feedback) -> f64 {
        self.identification.twist_mm(feedback)
    }

    /// A hole begins.
    pub(super) fn begin_hole(&mut self, plan: &CyclePlan) {
        self.lingering = Lingering::default();
        self.identification.begin_hole();
        self.learning.begin(plan.cycle(), plan.duration_s());
    }
}
