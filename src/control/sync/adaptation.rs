//! What outlives a hole: what the machine has shown of itself, and what repeated holes have taught.

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;
use crate::control::port::Feedback;

use super::identify::{Identification, Identified};
use super::learning::Learning;

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
}

impl Adaptation {
    /// A machine that has not moved yet.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let spec = machine.spec();
        Self { identification: Identification::new(machine), learning: Learning::new(spec.sync, spec.control.period_s) }
    }

    /// One period's feedback, outside a hole; from a hole's first synchronous period on the synchronizer does it.
    pub fn observe(&mut self, feedback: &Feedback) {
        self.identification.observe(feedback);
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

    /// A hole begins; `from_above` where Z's motor stands on the side that pushes into it.
    pub(super) fn begin_hole(&mut self, plan: &CyclePlan, from_above: bool) {
        self.identification.begin_hole();
        self.learning.begin(plan.cycle(), plan.duration_s(), from_above);
    }
}
