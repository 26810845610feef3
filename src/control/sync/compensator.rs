//! `compensation = full`: both axes' commands so that, with the machine as it is known, spindle and Z move as one.
//!
//! Times within a period: a setpoint commanded now acts `latency` later, its effort moves the spindle `effort lag` after
//! that. Everything is laid to the instant at which the spindle moves: Z's force is commanded as much earlier as Z's own
//! lag asks, and both drives' references say what their encoders will then read ([`Reference`]), so that no loop sees an
//! error where there is none.

use crate::control::cycle::CyclePlan;
use crate::control::machine::{DriveSpec, Machine, SyncSpec};
use crate::control::math::poly::State;
use crate::control::port::Feedback;
use crate::control::units::{mm_from_um, rpm_from_rev_per_s};

use super::adaptation::{Adaptation, Lingering};
use super::governor::{Governor, Load};
use super::identify::Identified;
use super::path::Path;
use super::reference::Reference;
use super::settings::{Compensation, Mode, Settings};
use super::spindle_feedforward::SpindleFeedforward;
use super::step::Pair;
use super::tracker::Tracker;
use super::z_feedforward::{When, ZFeedforward};

/// Steps of a leg between which its torque is looked at.
const TORQUE_STEPS: u32 = 200;

/// Delays of one axis's drive.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lags {
    /// From a commanded effort to the effort.
    effort_s: f64,
    /// From a velocity to its reading in the velocity loop.
    velocity_s: f64,
}

/// One hole's compensation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Compensator {
    adaptation: Adaptation,
    settings: Settings,
    sync: SyncSpec,
    drive: DriveSpec,
    period_s: f64,
    latency_s: f64,
    spindle_lags: Lags,
    z_lags: Lags,
    spindle: SpindleFeedforward,
    z: ZFeedforward,
    spindle_reference: Reference,
    z_reference: Reference,
    deviation: Tracker,
    governor: Governor,
    /// The machine as it is known at the hole's start.
    known: Identified,
    /// The plan's time of the last period; none before the hole's first.
    plan_s: Option<f64>,
}

impl Compensator {
    pub(super) fn new(plan: &CyclePlan, machine: &Machine, settings: Settings) -> Self {
        let spec = machine.spec();
        let (drive, period_s) = (&spec.drive, spec.control.period_s);
        let half_tick_s = drive.period_s / 2.0;
        let lags = |torque_lag_s: f64| Lags {
            effort_s: torque_lag_s + half_tick_s,
            velocity_s: drive.velocity_filter_s + half_tick_s,
        };
        Self {
            adaptation: Adaptation::new(machine),
            settings,
            sync: spec.sync,
            drive: *drive,
            period_s,
            latency_s: drive.latency_periods * period_s,
            spindle_lags: lags(spec.spindle.torque_lag_s),
            z_lags: lags(spec.z_axis.torque_lag_s),
            spindle: SpindleFeedforward::new(machine, plan.cycle()),
            z: ZFeedforward::new(machine),
            spindle_reference: Reference::new(drive.spindle_position_gain_per_s, period_s),
            z_reference: Reference::new(drive.z_position_gain_per_s, period_s),
            deviation: Tracker::of_angle(period_s, spec.sync.deviation_rad_per_s),
            governor: Governor::new(spec.sync.governor_per_s, spec.spindle.supply_sag_ratio, load_of(plan, machine)),
            known: Identified::nominal(machine),
            plan_s: None,
        }
    }

    /// Takes over what earlier holes left.
    pub(super) fn adapt(&mut self, adaptation: Adaptation) {
        self.adaptation = adaptation;
        if self.settings.compensation != Compensation::Full {
            self.adaptation.let_go();
        }
    }

    /// One period before the hole's first.
    pub(super) fn observe(&mut self, feedback: &Feedback) {
        self.adaptation.observe(feedback);
    }

    /// What lingers of the hole before, until this one begins.
    pub(super) fn lingering(&self) -> Lingering {
        self.adaptation.lingering()
    }

    /// What the next hole may use.
    pub(super) fn into_adaptation(self) -> Adaptation {
        self.adaptation
    }

    /// How long after the plan's end the axes still move, Z's motor perhaps through its play.
    pub(super) fn tail_s(&self) -> f64 {
        self.latency_s + self.spindle_lags.effort_s + self.z.lead_s()
    }

    /// Spindle and Z rest, and the next period is the hole's first.
    pub(super) fn begin(&mut self, plan: &CyclePlan, feedback: &Feedback) {
        let known = if self.settings.identify { self.adaptation.identified() } else { self.adaptation.nominal() };
        let poles = self.sync.deviation_rad_per_s;
        self.deviation = Tracker::of_deviation(&self.drive, self.period_s, poles, known.inertia_ratio);
        self.spindle.begin(known.inertia_ratio);
        self.begin_z(&known, feedback);
        self.governor.begin(&known);
        self.adaptation.begin_hole(plan);
    }

    fn begin_z(&mut self, known: &Identified, feedback: &Feedback) {
        self.known = *known;
        let held_n = known.z_weight_n - feedback.z_force_n.unwrap_or(0.0);
        let side = known.z_side(self.adaptation.z_twist_mm(feedback));
        let left = self.adaptation.lingering();
        self.z.begin(known, held_n, -left.z_force_n, side);
        self.z_reference.begin(-left.z.position);
    }

    /// The hole is done, Z commanded so far from R with such a force. One that was stopped on its way teaches nothing.
    pub(super) fn finish(&mut self, interrupted: bool, z_mm: f64, z_force_n: f64) {
        self.adaptation.linger(z_mm, z_force_n);
        if self.settings.learn && !interrupted {
            self.adaptation.learning.finish();
        }
    }

    /// The plan's time of the next period, unless the governor slows it.
    pub(super) fn next_plan_s(&self) -> f64 {
        self.plan_s.map_or(0.0, |last_s| last_s + self.governor.pace() * self.period_s)
    }

    /// The plan some time after the instant that is commanded now, as fast as the governor lets it run.
    fn at(&self, path: &mut Path, plan_s: f64, after_s: f64) -> State {
        let pace = self.governor.pace();
        let state = path.at(plan_s + pace * after_s).spindle;
        State {
            position: state.position,
            velocity: pace * state.velocity,
            acceleration: pace * pace * state.acceleration + self.governor.slope_per_s() * state.velocity,
            jerk: pace * pace * pace * state.jerk,
        }
    }

    /// One synchronous period: the spindle's measured motion and e(k) in, both commands out, with the plan's time.
    pub(super) fn step(&mut self, path: &mut Path, spindle: &State, error_mm: f64, feedback: &Feedback) -> (f64, Pair) {
        self.adaptation.observe(feedback);
        let first = self.plan_s.is_none();
        let plan_s = match self.plan_s {
            None => 0.0,
            Some(last_s) => {
                self.governor.step(&self.adaptation.identified(), self.period_s);
                last_s + self.governor.pace() * self.period_s
            }
        };
        self.plan_s = Some(plan_s);
        let thread = path.plan().thread();
        let (lag_s, encoder_s) = (self.spindle_lags.effort_s, self.drive.encoder_latency_s);
        let measured_s = self.latency_s + lag_s + encoder_s;
        let expected = self.at(path, plan_s, -measured_s);
        self.deviation.update(spindle.position - expected.position, feedback.torque_saturated());

        let pushed = self.at(path, plan_s, 0.0);
        let seen = self.at(path, plan_s, -lag_s - encoder_s);
        let felt = self.at(path, plan_s, -lag_s - self.spindle_lags.velocity_s);
        let (position, velocity) = self.spindle_reference.command(seen.position, seen.velocity, felt.velocity);

        let when = When { acting_s: self.z_lags.effort_s - lag_s, seen_s: -lag_s - self.z_lags.velocity_s };
        if first {
            for periods in 0..self.z.lead_periods() {
                let ahead_s = when.acting_s + f64::from(periods) * self.period_s;
                self.z.prime(&thread.follow(&self.at(path, plan_s, ahead_s)));
            }
        }
        let acting = thread.follow(&self.at(path, plan_s, when.acting_s));
        let ahead = thread.follow(&self.at(path, plan_s, when.acting_s + self.z.lead_s()));
        let late = thread.follow(&self.at(path, plan_s, when.seen_s));
        let measured_ago_s = when.acting_s + measured_s;
        if let Some(lead_mm) = self.known.z_lead_mm(self.adaptation.z_twist_mm(feedback)) {
            self.z.show(lead_mm, measured_ago_s);
        }
        let repeating_mm = self.z.repeats(measured_ago_s) * error_mm;
        self.adaptation.learning.observe(plan_s - self.governor.pace() * measured_s, repeating_mm);
        let extra = self.z.step(&acting, &ahead, when);
        // The feedback's force is the mean over the last period.
        if let Some(z_force_n) = feedback.z_force_n.filter(|_| self.settings.identify) {
            let then_s = -self.latency_s - lag_s - 0.5 * self.period_s;
            let table = thread.follow(&self.at(path, plan_s, then_s));
            self.z.observe(self.known.z_weight_n - z_force_n, &table);
        }
        let table = thread.follow(&seen);
        let motor_velocity = late.velocity + extra.motor_velocity_mm_per_s;
        let (z_position, z_velocity) = self.z_reference.command(table.position, table.velocity, motor_velocity);
        let followed = thread.follow(&self.followed(spindle, &seen, thread.pitch_mm));
        let learned = if self.settings.learn { self.adaptation.learning.correction(plan_s) } else { State::default() };
        let correction_mm = followed.position + learned.position;
        let pair = Pair {
            spindle: State { position, velocity, ..pushed },
            spindle_nm: self.spindle.torque_nm(&pushed),
            z: State {
                position: z_position + correction_mm,
                velocity: z_velocity + followed.velocity + learned.velocity * self.governor.pace(),
                acceleration: acting.acceleration + extra.acceleration_mm_per_s2,
                jerk: 0.0,
            },
            z_n: extra.friction_n,
            correction_mm,
            slowed: 1.0 - self.governor.pace(),
        };
        (plan_s, pair)
    }

    /// What Z takes over of the spindle's deviation from where it is planned to be when Z acts.
    fn followed(&self, spindle: &State, planned: &State, pitch_mm: f64) -> State {
        let horizon_s = self.latency_s + self.drive.encoder_latency_s + self.sync.deviation_lead_s;
        let ahead = self.deviation.predict(horizon_s);
        match self.settings.mode {
            Mode::Commanded => {
                // d³/(d² + z²): nothing of the noise, all of what counts, and smooth between.
                let zone_rev = mm_from_um(self.sync.dead_zone_um) / pitch_mm;
                let square = ahead.position * ahead.position;
                let share = if zone_rev > 0.0 { square / (square + zone_rev * zone_rev) } else { 1.0 };
                let slope = share * (3.0 - 2.0 * share);
                State { position: share * ahead.position, velocity: slope * ahead.velocity, ..State::default() }
            }
            Mode::FollowingPredicted => ahead,
            // As it was measured: what the plan knows of the time since is taken back.
            Mode::Following => State {
                position: spindle.position - planned.position,
                velocity: spindle.velocity - planned.velocity,
                ..State::default()
            },
        }
    }
}

/// What a plan asks of the motor that the file describes.
fn load_of(plan: &CyclePlan, machine: &Machine) -> Load {
    let (motor, spindle) = (machine.motor(), &machine.spec().spindle);
    let (mut inertia_share, mut top_rpm) = (0.0_f64, 0.0_f64);
    for leg in plan.legs() {
        for instant in 0..=TORQUE_STEPS {
            let state = leg.profile.at(leg.duration_s * f64::from(instant) / f64::from(TORQUE_STEPS));
            let rpm = rpm_from_rev_per_s(state.velocity.abs());
            let share = motor.torque_for_nm(state.acceleration.abs()) / motor.curve.torque_nm(rpm);
            (inertia_share, top_rpm) = (inertia_share.max(share), top_rpm.max(rpm));
        }
    }
    let friction_nm = spindle.coulomb_nm + spindle.viscous_nm_per_rpm * top_rpm;
    Load { inertia_share, top_nm: motor.curve.torque_nm(top_rpm), friction_nm }
}

#[cfg(test)]
mod tests {
    use super::load_of;
    use crate::control::cycle::{CyclePlan, TapCycle};
    use crate::control::machine::{Law, Machine};

    /// The linear law asks for 38 197 rpm/s everywhere: 16 N·m of 0.004 kg·m², below 3000 rpm of 20 N·m.
    #[test]
    fn load_is_the_share_of_the_motor_that_the_plan_takes() {
        let machine = Machine::reference();
        let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
        let load = load_of(&CyclePlan::new(hole, &machine, Law::Linear).unwrap(), &machine);
        assert!((load.inertia_share - 0.8).abs() < 1e-4, "{load:?}");
        assert!((load.top_nm - 20.0).abs() < 1e-9, "{load:?}");
        assert!((load.friction_nm - (0.3 + 0.3 * 3.0 / 8.0)).abs() < 1e-9, "{load:?}");
    }
}
