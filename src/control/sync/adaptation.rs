//! What outlives a hole: what the machine has shown of itself, what repeated holes have taught, and what fades after each.

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;
use crate::control::math::{exp, poly::State};
use crate::control::port::{Feedback, Setpoint};

use super::identify::{Identification, Identified};
use super::learning::Learning;

/// A hole's force feedforward fades in so many integral times of Z's drive, which takes it over: slowly while Z rests, so
/// that it is not moved, and soon once it moves, since each hole would add to what is left of the one before.
const RESTING_INTEGRALS: f64 = 200.0;
const MOVING_INTEGRALS: f64 = 2.0;

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
    resting_force_kept: f64,
    moving_force_kept: f64,
    /// Counts of Z in one period beyond which it moves.
    moving_counts: f64,
    z_counts: Option<i64>,
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
            resting_force_kept: exp(-period_s / (RESTING_INTEGRALS * spec.drive.z_integral_s)),
            moving_force_kept: exp(-period_s / (MOVING_INTEGRALS * spec.drive.z_integral_s)),
            moving_counts: spec.z_axis.stribeck_mm_per_s * period_s * spec.z_axis.encoder_counts_per_mm,
            z_counts: None,
        }
    }

    /// One period's feedback, outside a hole; from its first step on the synchronizer does it.
    pub fn observe(&mut self, feedback: &Feedback) {
        self.identification.observe(feedback);
        let before = self.z_counts.replace(feedback.z_counts).unwrap_or(feedback.z_counts);
        let moves = (feedback.z_counts.wrapping_sub(before) as f64).abs() > self.moving_counts;
        let force_kept = if moves { self.moving_force_kept } else { self.resting_force_kept };
        self.linger(self.position_kept * self.lingering.z.position, force_kept * self.lingering.z_force_n);
    }

    /// What the last hole left; to be added to Z's setpoints until the next one starts, shown each period meanwhile. A host
    /// that does not goes on from Z's last setpoint, and says so: [`Adaptation::let_go`].
    #[must_use]
    pub fn lingering(&self) -> Lingering {
        self.lingering
    }

    /// Nothing lingers: Z has been moved without it, or its drive was off.
    pub fn let_go(&mut self) {
        self.lingering = Lingering::default();
    }

    /// A hole has ended so far from R, with such a force.
    pub(super) fn linger(&mut self, z_mm: f64, z_force_n: f64) {
        let z = State { position: z_mm, velocity: -self.z_gain_per_s * z_mm, ..State::default() };
        self.lingering = Lingering { z, z_force_n };
    }

    /// Periods have passed unseen: the next one's feedback is not measured against the last, and nothing lingers.
    pub fn note_gap(&mut self) {
        self.identification.note_gap();
        self.z_counts = None;
        self.let_go();
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
        self.let_go();
        self.identification.begin_hole();
        self.learning.begin(plan.cycle(), plan.duration_s());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left_after(z_mm_per_period: f64, periods: i64) -> Lingering {
        let mut adaptation = Adaptation::new(&Machine::reference());
        adaptation.linger(0.005, 300.0);
        for k in 0..=periods {
            let z_counts = (k as f64 * z_mm_per_period * 10_000.0) as i64;
            adaptation.observe(&Feedback { z_counts, ..Feedback::default() });
        }
        adaptation.lingering()
    }

    /// 1/40 s, 2 s and 20 ms of the reference machine.
    #[test]
    fn what_lingers_fades_slowly_at_rest_and_soon_in_motion() {
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        let rested = left_after(0.0, 24);
        near(rested.z.position, 0.005 * (-1.0_f64).exp());
        near(rested.z.velocity, -40.0 * rested.z.position);
        near(rested.z_force_n, 300.0 * (-0.025_f64 / 2.0).exp());
        // The first period has none before it to have moved from.
        near(left_after(0.01, 20).z_force_n, 300.0 * (-0.001_f64 / 2.0 - 1.0).exp());
    }

    #[test]
    fn setpoints_go_on_from_it() {
        let z = State { position: -2.0, velocity: 3.0, ..State::default() };
        let setpoint = Setpoint { z, z_force_n: 10.0, ..Setpoint::default() };
        let mut adaptation = Adaptation::new(&Machine::reference());
        assert_eq!(adaptation.lingering().onto(setpoint), setpoint);
        adaptation.linger(0.005, 300.0);
        let beside = adaptation.lingering().onto(setpoint);
        assert_eq!((beside.z.position, beside.z.velocity, beside.z_force_n), (-1.995, 2.8, 310.0));
    }

    #[test]
    fn a_gap_leaves_nothing() {
        let mut adaptation = Adaptation::new(&Machine::reference());
        adaptation.linger(0.005, 300.0);
        adaptation.note_gap();
        assert_eq!(adaptation.lingering(), Lingering::default());
    }
}
