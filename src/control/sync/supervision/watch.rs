//! One hole's supervision with its state.

use crate::control::cycle::CyclePlan;
use crate::control::math::poly::State;
use crate::control::port::{AxisStatus, DriveState, Feedback};
use crate::control::sync::frame::AxisCommands;
use crate::control::sync::strategy::{Compensation, Settings};
use crate::control::units::{mm_from_um, um_from_mm};

use super::alarm::{Alarm, Axis};
use super::bounds::Bounded;
use super::clock::{Clock, Tick};
use super::effort::EffortMonitor;
use super::followed_stop::FollowedStop;
use super::following::{Followed, FollowingMonitor, SpindleEffort};
use super::limits::HoleLimits;
use super::reaction::{Severity, StopKind};
use super::rest::RestMonitor;
use super::sample::{Checked, SampleMonitor};
use super::sent::Sent;
use super::travel::{Hidden, TravelMonitor, Travelled};

/// How soon an error that an acknowledged fault left is held to the limit again, once it is gone: Z joins the helix in motion.
const LEFT_S: f64 = 0.1;

/// What the hole's command asks for and what was measured, positive into the hole.
#[derive(Clone, Copy, Debug)]
pub(in crate::control::sync) struct Observation<'a> {
    /// Travel of the spindle that is gone by.
    pub(in crate::control::sync) spindle_rev: f64,
    pub(in crate::control::sync) error_mm: f64,
    /// The feedback that is gone by.
    pub(in crate::control::sync) feedback: &'a Feedback,
}

/// Both axes' samples, efforts and setpoints of one hole, and its alarm.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct Supervision {
    limits: HoleLimits,
    /// Whether faults are looked for, and what leaves a step is bounded.
    watches: bool,
    /// Whether Z goes by the plan whatever the spindle does.
    goes_by_plan: bool,
    /// Thread's hand, ±1, and the spindle's rest angle before the hole.
    hand: f64,
    spindle_rest_rev: f64,
    r_plane_mm: f64,
    clock: Clock,
    sent: Sent,
    expected: [f64; 2],
    expected_speed: f64,
    spindle: SampleMonitor,
    z: SampleMonitor,
    torque: EffortMonitor,
    force: EffortMonitor,
    following: FollowingMonitor,
    spindle_travel: TravelMonitor,
    z_travel: TravelMonitor,
    /// How much deeper than the plan Z was commanded.
    deeper_mm: f64,
    followed_stop: FollowedStop,
    rest: RestMonitor,
    last: Option<[Bounded; 2]>,
    last_s: Option<f64>,
    elapsed_s: f64,
    /// |e(k)| that an acknowledged fault left: it is not raised again, unless it grows. None where it is taken anew.
    left_um: Option<f64>,
    alarm: Option<Alarm>,
    reaction: Option<Severity>,
    bridged_samples: u64,
}

impl Supervision {
    pub(in crate::control::sync) fn new(plan: &CyclePlan, settings: Settings, spindle_rest_rev: f64) -> Self {
        let by_model = settings.compensation == Compensation::ModelBased;
        let limits = HoleLimits::new(plan.machine(), plan, by_model);
        let period_s = limits.period_s;
        Self {
            watches: settings.supervise,
            goes_by_plan: !by_model,
            hand: plan.cycle().hand.sign(),
            spindle_rest_rev,
            r_plane_mm: plan.cycle().r_plane_mm,
            clock: Clock::new(period_s, limits.bridge_periods),
            sent: Sent::new(limits.delay_periods, limits.latency_periods),
            expected: [0.0; 2],
            expected_speed: 0.0,
            spindle: SampleMonitor::new(limits.spindle),
            z: SampleMonitor::new(limits.z),
            torque: EffortMonitor::new(Axis::Spindle, limits.torque_nm),
            force: EffortMonitor::new(Axis::Z, limits.force_n),
            following: FollowingMonitor::new(limits.following.clone()),
            spindle_travel: TravelMonitor::new(limits.spindle_travel),
            z_travel: TravelMonitor::new(limits.z_travel),
            deeper_mm: 0.0,
            followed_stop: FollowedStop::new(limits.stop.clone()),
            rest: RestMonitor::new(limits.stop.counts_per_rev, period_s),
            last: None,
            last_s: None,
            elapsed_s: period_s,
            left_um: Some(0.0),
            alarm: None,
            reaction: None,
            bridged_samples: 0,
            limits,
        }
    }

    /// The hole begins with both axes at rest in it, rev and mm of travel.
    pub(in crate::control::sync) fn rest_at(&mut self, spindle_rev: f64, depth_mm: f64) {
        self.followed_stop.rest_at(spindle_rev);
        self.expected = [self.spindle_rest_rev + self.hand * spindle_rev, self.r_plane_mm - depth_mm];
    }

    /// Whether faults are looked for.
    pub(in crate::control::sync) fn watches(&self) -> bool {
        self.watches
    }

    /// Takes in an alarm; one that is latched already stays.
    pub(in crate::control::sync) fn raise(&mut self, alarm: Alarm) {
        self.alarm.get_or_insert(alarm);
    }

    pub(in crate::control::sync) fn alarm(&self) -> Option<Alarm> {
        self.alarm
    }

    /// What is done about the alarm; none where nothing is, or no longer.
    pub(in crate::control::sync) fn stop(&self) -> Option<StopKind> {
        self.reaction.map(Severity::stop)
    }

    /// Whether both axes rest: a fault that moves nothing, or a stop that is over.
    pub(in crate::control::sync) fn is_at_rest(&self) -> bool {
        self.reaction.is_none() || self.rest.is_at_rest()
    }

    /// Samples for which the model stood in.
    pub(in crate::control::sync) fn bridged_samples(&self) -> u64 {
        self.bridged_samples
    }

    /// The host's clock shows a time.
    pub(in crate::control::sync) fn tick(&mut self, host_s: f64) -> Tick {
        if !self.watches {
            return Tick { now_s: host_s, periods: 1, alarm: None };
        }
        self.clock.read(host_s)
    }

    /// The time that an order of the host is of.
    pub(in crate::control::sync) fn of_order(&self, host_s: f64) -> f64 {
        if self.watches { self.clock.of_order(host_s) } else { host_s }
    }

    /// One period begins: the feedback to go by, and the alarm where the told one cannot be. None is a period that the host
    /// left out.
    pub(in crate::control::sync) fn check(&mut self, now_s: f64, told: Option<&Feedback>) -> (Feedback, Option<Alarm>) {
        let period_s = self.limits.period_s;
        let elapsed_s = self.last_s.replace(now_s).map_or(period_s, |last_s| now_s - last_s);
        self.elapsed_s = if elapsed_s > 0.25 * period_s { elapsed_s } else { period_s };
        if !self.watches {
            return (told.copied().unwrap_or_default(), None);
        }
        let Some(told) = told else { return (self.samples(None).0, None) };
        let (counted, of_samples) = self.samples(Some(told));
        let (spindle_torque_nm, of_torque) = self.torque.check(told.spindle_torque_nm);
        let (z_force_n, of_force) = self.force.check(told.z_force_n);
        let feedback = Feedback { spindle_torque_nm, z_force_n, ..counted };
        (feedback, of_samples.or(of_torque).or(of_force))
    }

    fn samples(&mut self, told: Option<&Feedback>) -> (Feedback, Option<Alarm>) {
        if self.sent.is_empty() {
            // Nothing was sent yet that it could be compared with.
            return (told.copied().unwrap_or_default(), None);
        }
        let [before_rev, _] = self.expected;
        self.expected = self.sent.expected();
        let [spindle_rev, z_mm] = self.expected;
        self.expected_speed = (spindle_rev - before_rev) / self.limits.period_s;
        let follows = self.followed_stop.is_under_way();
        let valid = |counts: i64, status: AxisStatus| status.sample_valid.then_some(counts);
        let spindle = told.and_then(|told| valid(told.spindle_counts, told.spindle));
        let z = told.and_then(|told| valid(told.z_counts, told.z));
        let repeats = !follows
            && spindle.is_some_and(|counts| self.spindle.looks_repeated(counts, spindle_rev))
            && z.is_some_and(|counts| self.z.looks_repeated(counts, z_mm));
        let of_spindle = self.spindle.check(spindle, spindle_rev, repeats, follows);
        let of_z = self.z.check(z, z_mm, repeats, follows);
        self.bridged_samples += u64::from(of_spindle.bridged || of_z.bridged);
        let told = told.copied().unwrap_or_default();
        let feedback = Feedback {
            spindle_counts: of_spindle.counts,
            z_counts: of_z.counts,
            spindle: status(told.spindle, &of_spindle),
            z: status(told.z, &of_z),
            // The motor's encoder comes with Z's sample.
            z_motor_counts: told.z_motor_counts.filter(|_| !of_z.bridged),
            ..told
        };
        (feedback, of_spindle.alarm.or(of_z.alarm))
    }

    /// The axes in a synchronous period: what is to be raised.
    pub(in crate::control::sync) fn judge(&mut self, seen: &Observation<'_>) -> Option<Alarm> {
        self.followed_stop.observe(seen.spindle_rev);
        self.rest.observe(seen.spindle_rev);
        if !self.watches {
            return None;
        }
        let followed = |monitor: &SampleMonitor, status: &AxisStatus, expected_speed: f64| Followed {
            error: monitor.tracking_error(),
            error_rate: monitor.tracking_error_rate(),
            speed: monitor.speed(),
            expected_speed,
            is_trusted: monitor.is_trusted() && status.sample_valid,
            may_be_frozen: monitor.may_be_frozen(),
            is_not_ready: status.drive == Some(DriveState::NotReady),
            is_saturated: status.saturated == Some(true),
        };
        let spindle = followed(&self.spindle, &seen.feedback.spindle, self.expected_speed);
        let z = followed(&self.z, &seen.feedback.z, 0.0);
        let effort =
            SpindleEffort { reported_nm: seen.feedback.spindle_torque_nm, commanded_nm: self.sent.torque_range_nm() };
        let off_scale = self.travels([&spindle, &z], seen);
        let alarm = off_scale.or(self.following.check(&spindle, &z, &effort));
        let error_um = um_from_mm(seen.error_mm);
        let before_um = self.left_um.unwrap_or(error_um.abs());
        let kept_um = (1.0 - self.limits.period_s / LEFT_S) * before_um;
        let left_um = error_um.abs().max(kept_um).min(before_um);
        self.left_um = Some(left_um);
        let limit_um = self.limits.error_um + left_um;
        let too_far = spindle.is_trusted && z.is_trusted && error_um.abs() > limit_um;
        alarm.or(too_far.then_some(Alarm::SynchronisationError { error_um, limit_um }))
    }

    /// Encoders whose travel is off.
    fn travels(&mut self, [spindle, z]: [&Followed; 2], seen: &Observation<'_>) -> Option<Alarm> {
        let travelled = |expected: f64, followed: &Followed| Travelled {
            expected,
            error: followed.error,
            speed: followed.speed,
            is_trusted: followed.is_trusted,
        };
        let [spindle_rev, z_mm] = self.expected;
        let z = travelled(z_mm, z);
        let hidden = Hidden {
            error_mm: seen.error_mm,
            correction_mm: self.deeper_mm,
            limit_mm: mm_from_um(self.limits.error_um),
        };
        let of_spindle = self.spindle_travel.check(&travelled(spindle_rev, spindle));
        of_spindle.or(self.z_travel.check(&z)).or(self.z_travel.hidden(&z, &hidden).filter(|_| self.goes_by_plan))
    }

    /// Latches an alarm and reacts. True where both axes are to brake on the plan from now on.
    pub(in crate::control::sync) fn react(&mut self, alarm: Alarm) -> bool {
        self.raise(alarm);
        let severity = Severity::of(&alarm);
        let present = self.reaction.unwrap_or(Severity::Noted);
        if severity <= present {
            return false;
        }
        if let Alarm::TravelMismatch { axis, .. } = alarm {
            let monitor = if axis == Axis::Spindle { &mut self.spindle } else { &mut self.z };
            monitor.distrust();
        }
        let stays_with_plan = severity == Severity::Model || severity == Severity::Synchronous && !self.goes_by_plan;
        let may_follow = !stays_with_plan && self.spindle.is_trusted() && !self.followed_stop.is_under_way();
        if let (true, Some([spindle, z])) = (may_follow, self.last) {
            let at_once = matches!(alarm, Alarm::Jam { .. });
            self.followed_stop.begin(&self.in_hole(&spindle), self.z_in_hole(&z), at_once);
        }
        self.reaction = Some(severity);
        !self.followed_stop.is_under_way() && present == Severity::Noted
    }

    /// What was sent of the spindle, positive into the hole.
    fn in_hole(&self, sent: &Bounded) -> State {
        sent.state.shifted(-self.spindle_rest_rev).scaled(self.hand)
    }

    fn z_in_hole(&self, sent: &Bounded) -> State {
        sent.state.shifted(-self.r_plane_mm).scaled(-1.0)
    }

    /// One period of a stop that does not brake on the plan: its commands.
    pub(in crate::control::sync) fn followed(&mut self) -> Option<AxisCommands> {
        let [spindle, _] = self.last?;
        let sent = self.in_hole(&spindle);
        self.followed_stop.step(&sent)
    }

    /// What the plan commands, kept for a stop that follows.
    pub(in crate::control::sync) fn note_commands(&mut self, commands: &AxisCommands, deeper_mm: f64) {
        self.deeper_mm = deeper_mm;
        self.followed_stop.note(commands, deeper_mm);
    }

    /// The host has seen the alarm, and both axes rest: from now on the hole may be retracted. Returns where the spindle was
    /// brought to rest, if not on the plan.
    pub(in crate::control::sync) fn acknowledge(&mut self) -> Option<f64> {
        (self.alarm, self.reaction, self.left_um) = (None, None, None);
        self.spindle.acknowledge();
        self.z.acknowledge();
        self.torque.acknowledge();
        self.force.acknowledge();
        self.following.acknowledge();
        self.spindle_travel.acknowledge();
        self.z_travel.acknowledge();
        self.followed_stop.end()
    }

    /// The last stage: setpoints of both axes, machine coordinates, within the limits, the spindle's with a torque beyond its
    /// acceleration's. Without supervision they pass as they are.
    pub(in crate::control::sync) fn bound(&mut self, spindle: &State, z: &State, spindle_torque_nm: f64) -> [State; 2] {
        if !self.watches {
            return [*spindle, *z];
        }
        let first = || [Bounded::at_rest(spindle.position), Bounded::at_rest(z.position)];
        let [spindle_before, z_before] = self.last.unwrap_or_else(first);
        let next = [
            self.limits.spindle_bounds.next(&spindle_before, spindle, self.elapsed_s),
            self.limits.z_bounds.next(&z_before, z, self.elapsed_s),
        ];
        self.last = Some(next);
        let [spindle, z] = next.map(|sent| sent.state);
        let torque_nm = self.limits.stop.motor.torque_for_nm(spindle.acceleration) + spindle_torque_nm;
        let [spindle_response, z_response] = &mut self.limits.responses;
        self.sent.push([spindle_response.step(&spindle), z_response.step(&z)], torque_nm);
        [spindle, z]
    }
}

fn status(told: AxisStatus, checked: &Checked) -> AxisStatus {
    AxisStatus { sample_valid: !checked.bridged, ..told }
}
