//! Whether the axes follow their commands: tracking errors, drives that are not ready, a tap that jams, and an encoder whose
//! travel the drive's effort contradicts.

use crate::control::math::filter_share;
use crate::control::motor::Motor;
use crate::control::units::rpm_from_rev_per_s;

use super::alarm::{Alarm, Axis, NOT_READY_PERIODS};

/// Periods for which a limit has to be broken.
const OVER_PERIODS: u32 = 3;
/// Periods for which the drive's effort has to contradict the encoder.
const CONTRADICTED_PERIODS: u32 = 5;
/// Least push, as a share of the motor's torque, that the drive has to show for what its encoder says.
const PUSH_SHARE: f64 = 0.2;
/// A drive that was saturated has an integrator that says nothing of its error for so long.
const UNWINDING_S: f64 = 0.25;
/// Share of that push that has to be seen.
const SHOWN_SHARE: f64 = 0.25;
/// A jam's slowing against the motor's own greatest acceleration.
const JAM_ACCELERATION: f64 = 2.0;
/// Share of the speed that a sample's jitter may seem to change it by.
const JAM_JITTER_SHARE: f64 = 0.08;
/// A single sample that falls behind by so many times what samples scatter is a jam, too.
const SCATTERS: f64 = 8.0;
/// Memory of that scatter.
const SCATTER_S: f64 = 0.05;
/// Periods over which a sudden jam is looked at.
const JAM_WINDOW: usize = 2;
/// Seconds for which torque stands at its limit while the speed falls.
const SLOW_JAM_S: f64 = 0.006;

/// Limits of the spindle's and Z's following.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowingLimits {
    pub(super) motor: Motor,
    pub(super) spindle_rev: f64,
    pub(super) z_mm: f64,
    /// Gains of the spindle's drive, 1/s.
    pub(super) position_gain_per_s: f64,
    pub(super) velocity_gain_per_s: f64,
    pub(super) period_s: f64,
    pub(super) scale_ratio: f64,
}

/// One axis in a period, machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Followed {
    /// Measured less expected, and its rate per second.
    pub(super) error: f64,
    pub(super) error_rate: f64,
    /// Measured and expected speed.
    pub(super) speed: f64,
    pub(super) expected_speed: f64,
    /// The counts are to be gone by.
    pub(super) is_trusted: bool,
    /// The drive says that it is not ready, or that its effort stood at the limit.
    pub(super) is_not_ready: bool,
    pub(super) is_saturated: bool,
}

/// The spindle's effort in a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpindleEffort {
    /// As the drive reports it.
    pub(super) reported_nm: Option<f64>,
    /// What was commanded: acceleration and feedforward.
    pub(super) commanded_nm: f64,
}

/// Counts periods.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowingMonitor {
    limits: FollowingLimits,
    spindle_over: u32,
    z_over: u32,
    spindle_not_ready: u32,
    z_not_ready: u32,
    contradicted: u32,
    /// Periods for which a drive that was saturated may still be winding down.
    unwinding: u32,
    jamming: u32,
    /// How much slower than expected the spindle was in the last periods, rev/s.
    lags: [f64; JAM_WINDOW],
    /// Mean change of that lag from period to period, rev/s.
    scatter: f64,
    speed: f64,
}

impl FollowingMonitor {
    pub(super) fn new(limits: FollowingLimits) -> Self {
        Self {
            limits,
            spindle_over: 0,
            z_over: 0,
            spindle_not_ready: 0,
            z_not_ready: 0,
            contradicted: 0,
            unwinding: 0,
            jamming: 0,
            lags: [0.0; JAM_WINDOW],
            scatter: 0.0,
            speed: 0.0,
        }
    }

    /// Counts from nothing.
    pub(super) fn acknowledge(&mut self) {
        *self = Self::new(self.limits.clone());
    }

    /// One period of both axes: the alarm that is due.
    pub(super) fn check(&mut self, spindle: &Followed, z: &Followed, effort: &SpindleEffort) -> Option<Alarm> {
        let not_ready = self.not_ready(spindle, z);
        let jam = self.jam(spindle, effort);
        let contradiction = self.contradiction(spindle, effort);
        not_ready.or(jam).or(contradiction).or_else(|| self.over(spindle, z))
    }

    fn not_ready(&mut self, spindle: &Followed, z: &Followed) -> Option<Alarm> {
        let count = |periods: &mut u32, is_not_ready: bool, axis: Axis| {
            *periods = if is_not_ready { periods.saturating_add(1) } else { 0 };
            (*periods >= NOT_READY_PERIODS).then_some(Alarm::DriveNotReady { axis, periods: *periods })
        };
        let of_spindle = count(&mut self.spindle_not_ready, spindle.is_not_ready, Axis::Spindle);
        count(&mut self.z_not_ready, z.is_not_ready, Axis::Z).or(of_spindle)
    }

    /// The spindle falls behind its command faster than its motor alone explains, or with all of its torque.
    fn jam(&mut self, spindle: &Followed, effort: &SpindleEffort) -> Option<Alarm> {
        let direction = if spindle.expected_speed < 0.0 { -1.0 } else { 1.0 };
        let lag = direction * (spindle.expected_speed - spindle.speed);
        let [older, newer] = self.lags;
        self.lags = [newer, lag];
        let slowed = self.speed.abs() - spindle.speed.abs();
        self.speed = spindle.speed;
        if !spindle.is_trusted {
            (self.lags, self.jamming) = ([lag; JAM_WINDOW], 0);
            return None;
        }
        let Self { limits: FollowingLimits { motor, period_s, .. }, .. } = self;
        let fastest = JAM_ACCELERATION * motor.acceleration_rev_per_s2(0.0, 1.0);
        let explained = JAM_WINDOW as f64 * fastest * *period_s + JAM_JITTER_SHARE * spindle.expected_speed.abs();
        let grown = lag - older;
        let over_window = grown > explained && newer > older && lag > newer && lag > explained;
        let at_once = lag - newer > 2.0 * fastest * *period_s + SCATTERS * self.scatter;
        self.scatter += filter_share(*period_s, SCATTER_S) * ((lag - newer).abs() - self.scatter);
        let sudden = over_window || at_once;
        let pushes = effort.commanded_nm * direction >= 0.0 && spindle.is_saturated;
        self.jamming = if pushes && slowed > 0.0 && lag > newer { self.jamming + 1 } else { 0 };
        let slow = f64::from(self.jamming) * *period_s >= SLOW_JAM_S;
        (sudden || slow)
            .then(|| Alarm::Jam { lag_rpm: rpm_from_rev_per_s(lag), limit_rpm: rpm_from_rev_per_s(explained) })
    }

    /// The drive does not push as it would, were its axis where the encoder says.
    fn contradiction(&mut self, spindle: &Followed, effort: &SpindleEffort) -> Option<Alarm> {
        if spindle.is_saturated {
            self.unwinding = (UNWINDING_S / self.limits.period_s) as u32;
        }
        let calm = self.unwinding == 0;
        self.unwinding = self.unwinding.saturating_sub(1);
        let Some(reported_nm) = effort.reported_nm.filter(|_| spindle.is_trusted && calm) else {
            self.contradicted = 0;
            return None;
        };
        let FollowingLimits { motor, position_gain_per_s, velocity_gain_per_s, period_s, .. } = &self.limits;
        let side = if spindle.error < 0.0 { -1.0 } else { 1.0 };
        // An error in proportion to the speed is a delay that is not as told, and no drive sees it.
        let delay_rev = spindle.speed.abs() * *period_s;
        let seen_rev = (spindle.error.abs() - delay_rev).max(0.0);
        let growing = (side * spindle.error_rate).max(0.0);
        let push_nm = motor.torque_for_nm(velocity_gain_per_s * (growing + position_gain_per_s * seen_rev));
        let shown_nm = side * (effort.commanded_nm - reported_nm);
        let least_nm = PUSH_SHARE * motor.curve.torque_nm(0.0);
        let contradicted = push_nm > least_nm && shown_nm < SHOWN_SHARE * push_nm;
        let gives_otherwise = (reported_nm - effort.commanded_nm).abs() > least_nm;
        self.contradicted = if contradicted { self.contradicted + 1 } else { 0 };
        let limit = delay_rev + least_nm / motor.torque_for_nm(velocity_gain_per_s * position_gain_per_s);
        (self.contradicted >= CONTRADICTED_PERIODS).then_some(if gives_otherwise {
            // It is the drive that does not obey: it gives another torque than it was told.
            Alarm::SpindleFollowing { error_rev: spindle.error, limit_rev: limit }
        } else {
            Alarm::TravelMismatch { axis: Axis::Spindle, deviation: spindle.error, limit }
        })
    }

    /// A drive that was thought to obey, and whose encoder was not believed, gives another torque than it is told.
    pub(super) fn disobeys(&mut self, effort: &SpindleEffort) -> bool {
        let least_nm = PUSH_SHARE * self.limits.motor.curve.torque_nm(0.0);
        let gives_otherwise =
            effort.reported_nm.is_some_and(|reported_nm| (reported_nm - effort.commanded_nm).abs() > least_nm);
        self.contradicted = if gives_otherwise { self.contradicted + 1 } else { 0 };
        self.contradicted >= CONTRADICTED_PERIODS
    }

    fn over(&mut self, spindle: &Followed, z: &Followed) -> Option<Alarm> {
        let FollowingLimits { spindle_rev, z_mm, period_s, .. } = self.limits;
        // A period more or less of delay is no tracking error.
        let limit_rev = spindle_rev + spindle.speed.abs() * period_s;
        let limit_mm = z_mm + z.speed.abs() * period_s;
        let count = |periods: &mut u32, followed: &Followed, limit: f64| {
            let over = followed.is_trusted && followed.error.abs() > limit;
            *periods = if over { *periods + 1 } else { 0 };
            *periods >= OVER_PERIODS
        };
        let spindle_is_over = count(&mut self.spindle_over, spindle, limit_rev);
        if count(&mut self.z_over, z, limit_mm) {
            return Some(Alarm::ZFollowing { error_mm: z.error, limit_mm });
        }
        spindle_is_over.then_some(Alarm::SpindleFollowing { error_rev: spindle.error, limit_rev })
    }
}

#[cfg(test)]
mod tests {
    use super::{Followed, FollowingLimits, FollowingMonitor, SpindleEffort};
    use crate::control::machine::Machine;
    use crate::control::sync::supervision::alarm::{Alarm, Axis};

    const PERIOD_S: f64 = 0.001;
    const SPINDLE_LIMIT_REV: f64 = 0.25;
    const Z_LIMIT_MM: f64 = 0.2;
    const FAST_REV_PER_S: f64 = 50.0;
    const UNTOLD: SpindleEffort = SpindleEffort { reported_nm: None, commanded_nm: 0.0 };

    fn monitor() -> FollowingMonitor {
        let machine = Machine::reference();
        let drive = &machine.spec().drive;
        FollowingMonitor::new(FollowingLimits {
            motor: machine.motor().clone(),
            spindle_rev: SPINDLE_LIMIT_REV,
            z_mm: Z_LIMIT_MM,
            position_gain_per_s: drive.spindle_position_gain_per_s,
            velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
            period_s: PERIOD_S,
            scale_ratio: 0.005,
        })
    }

    fn good() -> Followed {
        Followed { is_trusted: true, ..Followed::default() }
    }

    /// At constant commanded speed, some of it missing.
    fn slower(lag_rev_per_s: f64) -> Followed {
        Followed { speed: FAST_REV_PER_S - lag_rev_per_s, expected_speed: FAST_REV_PER_S, ..good() }
    }

    /// The first alarm over some periods of a spindle, and its period from 0.
    fn of_spindle(effort: SpindleEffort, spindle: impl Fn(u32) -> Followed, periods: u32) -> Option<(u32, Alarm)> {
        let mut monitor = monitor();
        (0..periods).find_map(|k| monitor.check(&spindle(k), &good(), &effort).map(|alarm| (k, alarm)))
    }

    #[test]
    fn a_drive_may_be_not_ready_for_two_periods() {
        let not_ready = Followed { is_not_ready: true, ..good() };
        let in_pairs = |k: u32| if k % 3 == 2 { good() } else { not_ready };
        assert_eq!(of_spindle(UNTOLD, in_pairs, 1000), None);
        let alarm = Alarm::DriveNotReady { axis: Axis::Spindle, periods: 3 };
        assert_eq!(of_spindle(UNTOLD, |_| not_ready, 10), Some((2, alarm)));
        // Where both fail, it is Z's that leaves the least.
        let mut monitor = monitor();
        let alarms = [(); 3].map(|()| monitor.check(&not_ready, &not_ready, &UNTOLD));
        assert_eq!(alarms, [None, None, Some(Alarm::DriveNotReady { axis: Axis::Z, periods: 3 })]);
    }

    #[test]
    fn a_tracking_error_over_its_limit_is_an_alarm_in_the_third_period() {
        let off = |error: f64| Followed { error, ..good() };
        assert_eq!(of_spindle(UNTOLD, |_| off(0.249), 1000), None);
        assert_eq!(of_spindle(UNTOLD, |k| off(if k % 3 == 2 { 0.249 } else { 0.251 }), 1000), None);
        assert_eq!(of_spindle(UNTOLD, |_| Followed { is_trusted: false, ..off(9.0) }, 1000), None);
        for error_rev in [0.251, -0.251] {
            let alarm = Alarm::SpindleFollowing { error_rev, limit_rev: SPINDLE_LIMIT_REV };
            assert_eq!(of_spindle(UNTOLD, |_| off(error_rev), 10), Some((2, alarm)));
            let mut monitor = monitor();
            let alarms = [(); 3].map(|()| monitor.check(&good(), &off(error_rev), &UNTOLD));
            let of_z = Alarm::ZFollowing { error_mm: error_rev, limit_mm: Z_LIMIT_MM };
            assert_eq!(alarms, [None, None, Some(of_z)]);
        }
        // A period of travel more or less is a delay: 0.05 rev at this speed.
        let fast = |error: f64| Followed { error, ..slower(0.0) };
        assert_eq!(of_spindle(UNTOLD, |_| fast(-0.299), 1000), None);
        assert!(of_spindle(UNTOLD, |_| fast(-0.301), 10).is_some());
    }

    #[test]
    fn a_spindle_that_falls_behind_faster_than_its_motor_explains_is_jammed() {
        // Twice what the motor gives, 1.6 rev/s a period, and 8 % of the speed are explained.
        assert_eq!(of_spindle(UNTOLD, |k| slower(f64::from(k.min(60)) * 0.7), 100), None);
        assert_eq!(of_spindle(UNTOLD, |k| slower(if k % 2 == 0 { 1.5 } else { -1.5 }), 1000), None);
        for sense in [1.0, -1.0] {
            let jam = |k: u32| {
                let lag = f64::from(k.saturating_sub(49)) * 4.0;
                Followed { speed: sense * (FAST_REV_PER_S - lag), expected_speed: sense * FAST_REV_PER_S, ..good() }
            };
            let Some((k, Alarm::Jam { lag_rpm, limit_rpm })) = of_spindle(UNTOLD, jam, 100) else { panic!("none") };
            assert!((50..=51).contains(&k) && lag_rpm > 200.0 && limit_rpm > 400.0, "{k}: {lag_rpm} {limit_rpm}");
        }
        let blind = |k| Followed { is_trusted: false, ..slower(f64::from(k) * 4.0) };
        assert_eq!(of_spindle(UNTOLD, blind, 100), None);
    }

    #[test]
    fn a_jam_against_all_of_the_torque_is_seen_within_10_ms() {
        let pushing = SpindleEffort { reported_nm: None, commanded_nm: 1.0 };
        let slowing = |k: u32| Followed { is_saturated: true, ..slower(0.5 * f64::from(k)) };
        let Some((k, Alarm::Jam { .. })) = of_spindle(pushing, slowing, 20) else { panic!("none") };
        assert!(k < 10, "{k}");
        // At its limit to brake, or as fast as before, it is no jam.
        let braking = SpindleEffort { reported_nm: None, commanded_nm: -1.0 };
        assert_eq!(of_spindle(braking, slowing, 20), None);
        assert_eq!(of_spindle(pushing, |_| Followed { is_saturated: true, ..slower(0.5) }, 100), None);
    }

    #[test]
    fn effort_tells_a_wrong_encoder_from_a_drive_that_does_not_obey() {
        // 0.05 rev behind: 40 and 200 1/s make 400 rev/s², for which the motor takes 10 N·m.
        let behind = |_| Followed { error: -0.05, ..good() };
        let effort = |commanded_nm, reported_nm| SpindleEffort { commanded_nm, reported_nm: Some(reported_nm) };
        assert_eq!(of_spindle(effort(1.0, 9.0), behind, 1000), None, "it pushes as it should");
        assert_eq!(of_spindle(effort(1.0, 3.6), behind, 1000), None, "it pushes a quarter of that");
        let Some((4, Alarm::TravelMismatch { axis, deviation, .. })) = of_spindle(effort(1.0, 1.1), behind, 10) else {
            panic!("the drive sees its axis where it is to be")
        };
        assert_eq!((axis, deviation), (Axis::Spindle, -0.05));
        let Some((4, Alarm::SpindleFollowing { error_rev, .. })) = of_spindle(effort(12.0, 0.0), behind, 10) else {
            panic!("the drive gives nothing")
        };
        assert_eq!(error_rev, -0.05);
        // Nothing is known of a drive that tells nothing, or that gives all it has.
        assert_eq!(of_spindle(SpindleEffort { reported_nm: None, ..effort(1.0, 0.0) }, behind, 100), None);
        let saturated = |_| Followed { is_saturated: true, ..behind(0) };
        assert_eq!(of_spindle(effort(-1.0, -1.0), saturated, 100), None);
    }

    #[test]
    fn a_drive_that_gives_another_torque_disobeys_after_five_periods() {
        let mut monitor = monitor();
        let effort = |commanded_nm| SpindleEffort { commanded_nm, reported_nm: Some(0.0) };
        assert!((0..100).all(|_| !monitor.disobeys(&effort(3.9))));
        assert_eq!([(); 5].map(|()| monitor.disobeys(&effort(4.1))), [false, false, false, false, true]);
        monitor.acknowledge();
        assert!(!monitor.disobeys(&effort(4.1)));
    }
}
