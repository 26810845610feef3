//! What outlives a hole: what was measured of the machine, what its holes taught, and the residual feedforward of the last.

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;
use crate::control::port::{Feedback, Setpoint};

use super::cutting_torque::CuttingTorque;
use super::frame::{Measured, Scale};
use super::hand_over::{HandOver, ResidualFeedforward};
use super::identification::Identification;
use super::learning::{LearnedError, Learning};
use super::plant_model::Identified;

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
    scale: Scale,
    /// [`Machine::motion_fingerprint`].
    machine: u64,
    pub(super) identification: Identification,
    pub(super) learning: Learning,
    pub(super) hand_over: HandOver,
    pub(super) cutting_torque: CuttingTorque,
}

impl Adaptation {
    /// A machine that has not moved yet.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        Self {
            scale: Scale::of(machine),
            machine: machine.motion_fingerprint(),
            identification: Identification::new(machine),
            learning: Learning::new(machine.spec().sync, machine.spec().control.period_s),
            hand_over: HandOver::new(machine),
            cutting_torque: CuttingTorque::new(machine),
        }
    }

    /// One period outside a hole. Returns what is to be added to Z's setpoint of this period.
    pub fn observe(&mut self, feedback: &Feedback) -> ResidualFeedforward {
        let measured = self.scale.measure(feedback);
        self.identification.observe_approach(&measured);
        self.observe_measured(&measured)
    }

    pub(super) fn observe_measured(&mut self, measured: &Measured) -> ResidualFeedforward {
        let residual = self.hand_over.residual();
        self.identification.observe(measured);
        self.hand_over.decay(measured);
        residual
    }

    /// What was commanded for the period that was observed last, outside a hole. A host that does not tell it goes without
    /// what commands and encoders together say of the machine: how late setpoints act.
    pub fn note_commanded(&mut self, setpoint: &Setpoint) {
        let commanded = self.scale.commanded(setpoint);
        self.identification.note_commanded(&commanded);
    }

    /// What the last hole left beside Z's setpoints. A host that does not add it goes on from Z's last setpoint, and says so
    /// by [`Adaptation::discard_residual`].
    #[must_use]
    pub fn residual(&self) -> ResidualFeedforward {
        self.hand_over.residual()
    }

    /// Nothing is left beside Z's setpoints: Z was moved without it, or its drive was off.
    pub fn discard_residual(&mut self) {
        self.hand_over.discard();
    }

    /// Periods have passed unseen: the next one is not measured against the last, and no residual is left.
    pub fn note_gap(&mut self) {
        self.identification.note_gap();
        self.hand_over.note_gap();
    }

    /// What is known of the machine by now: what was measured, as far as it was, else what its file says.
    #[must_use]
    pub fn identified(&self) -> Identified {
        self.identification.identified()
    }

    /// What a hole goes by: what was measured, or the file alone.
    pub(super) fn known(&self, identify: bool) -> Identified {
        if identify { self.identification.identified() } else { self.identification.nominal() }
    }

    /// Writes what holes taught, and what they measured of friction, inertia and screw, to be kept over a restart, and returns how many bytes that is: at most
    /// [`LEARNED_BYTES`](super::LEARNED_BYTES). The record is of this machine, has a version and a sum.
    ///
    /// # Errors
    /// [`LearnedError::TooShort`]: the buffer has no room, and what it holds is of no use.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, sync::{Adaptation, LearnedError}};
    /// let machine = Machine::reference();
    /// let (mut adaptation, mut bytes) = (Adaptation::new(&machine), [0; 2000]);
    /// let size = adaptation.save_learned(&mut bytes).unwrap();
    /// assert_eq!(adaptation.load_learned(&bytes[..size]), Ok(()));
    /// bytes[50] ^= 1;
    /// assert!(matches!(adaptation.load_learned(&bytes[..size]), Err(LearnedError::Damaged { .. })));
    /// let other = machine.with(|spec| spec.z_axis.mass_kg += 1.0).unwrap();
    /// let size = adaptation.save_learned(&mut bytes).unwrap();
    /// let refused = Adaptation::new(&other).load_learned(&bytes[..size]);
    /// assert!(matches!(refused, Err(LearnedError::OtherMachine { .. })));
    /// ```
    pub fn save_learned(&self, bytes: &mut [u8]) -> Result<usize, LearnedError> {
        self.learning.save(self.machine, &self.identification.numbers(), bytes)
    }

    /// Takes over what holes taught before a restart, in place of what this one knows. Not in a hole.
    ///
    /// # Errors
    /// [`LearnedError`], and nothing has changed.
    pub fn load_learned(&mut self, bytes: &[u8]) -> Result<(), LearnedError> {
        let numbers = self.learning.load(self.machine, bytes)?;
        self.identification.restore(&numbers);
        Ok(())
    }

    /// A hole goes on from rest after a fault: nothing that was commanded before it stands.
    pub(super) fn resume_hole(&mut self) {
        self.note_gap();
    }

    /// A hole begins and takes over what the last one left.
    pub(super) fn begin_hole(&mut self, plan: &CyclePlan) {
        self.hand_over.discard();
        self.identification.begin_hole();
        self.cutting_torque.begin(plan.cycle());
        self.learning.begin(plan);
    }
}
