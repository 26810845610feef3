//! An encoder of a wrong scale: its travel against what was commanded, in each whole revolution, and what a correction hides.
//!
//! An axis moves as its own drive sees it. One that is corrected until its encoder reads as wanted is moved off by as much as the
//! encoder is off its scale, and e(k) does not show it: the correction does.

use super::alarm::{Alarm, Axis};

/// What an axis may be off in a revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TravelLimits {
    pub(super) axis: Axis,
    /// Travel in one revolution of the spindle: 1 rev, or a pitch in mm.
    pub(super) whole: f64,
    /// A scale may be off by so much.
    pub(super) scale_ratio: f64,
    /// The axis' limit of its tracking error.
    pub(super) tracking: f64,
    pub(super) period_s: f64,
}

/// One axis in a period, machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Travelled {
    /// Where it is expected, and measured less that.
    pub(super) expected: f64,
    pub(super) error: f64,
    pub(super) speed: f64,
    pub(super) is_trusted: bool,
}

/// Z's error and what hides it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Hidden {
    /// e(k), mm, positive where Z seems too deep.
    pub(super) error_mm: f64,
    /// How much deeper than the plan Z was commanded.
    pub(super) correction_mm: f64,
    /// Most that e(k) may be.
    pub(super) limit_mm: f64,
}

/// The travel of one axis since the last whole revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TravelMonitor {
    limits: TravelLimits,
    since: Option<Travelled>,
}

impl TravelMonitor {
    pub(super) fn new(limits: TravelLimits) -> Self {
        Self { limits, since: None }
    }

    pub(super) fn acknowledge(&mut self) {
        self.since = None;
    }

    /// One period.
    pub(super) fn check(&mut self, now: &Travelled) -> Option<Alarm> {
        let TravelLimits { axis, whole, scale_ratio, tracking, period_s } = self.limits;
        if !now.is_trusted {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(*now);
        let travel = (now.expected - since.expected).abs();
        if travel < whole {
            return None;
        }
        self.since = Some(*now);
        // A period more or less of delay is no wrong scale.
        let delayed = (now.speed - since.speed).abs() * period_s;
        let (deviation, limit) = (now.error - since.error, scale_ratio * travel + tracking + delayed);
        (deviation.abs() > limit).then_some(Alarm::TravelMismatch { axis, deviation, limit })
    }

    /// Of Z: whether it is its own encoder that reads off, and a correction that hides it.
    pub(super) fn hidden(&self, z: &Travelled, hidden: &Hidden) -> Option<Alarm> {
        let Hidden { error_mm, correction_mm, limit_mm } = *hidden;
        let uncorrected_mm = error_mm - correction_mm;
        if correction_mm.abs() < error_mm.abs() || uncorrected_mm.abs() <= limit_mm {
            return None;
        }
        // Positive downwards, as e(k) is.
        let of_encoder_mm = -z.error;
        let explains = of_encoder_mm * uncorrected_mm > 0.0 && 2.0 * of_encoder_mm.abs() > uncorrected_mm.abs();
        (z.is_trusted && explains).then_some(Alarm::TravelMismatch {
            axis: self.limits.axis,
            deviation: z.error,
            limit: limit_mm,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Alarm, Axis, Hidden, TravelLimits, TravelMonitor, Travelled};

    const LIMITS: TravelLimits =
        TravelLimits { axis: Axis::Spindle, whole: 1.0, scale_ratio: 0.005, tracking: 0.1, period_s: 0.001 };

    /// The alarm of an encoder whose travel is so often what it should be, and the revolutions until then.
    fn scaled(ratio: f64, rev_per_s: f64) -> Option<(f64, Alarm)> {
        let mut monitor = TravelMonitor::new(LIMITS);
        (0..2000).find_map(|k| {
            let expected = 0.001 * f64::from(k) * rev_per_s;
            let now = Travelled { expected, error: (ratio - 1.0) * expected, speed: rev_per_s, is_trusted: true };
            monitor.check(&now).map(|alarm| (expected, alarm))
        })
    }

    #[test]
    fn a_wrong_scale_is_seen_in_a_revolution() {
        for rev_per_s in [10.0, -10.0, 100.0] {
            assert_eq!(scaled(1.09, rev_per_s), None);
            for ratio in [0.5, 0.88, 1.12, 2.0] {
                let Some((rev, Alarm::TravelMismatch { axis: Axis::Spindle, deviation, limit })) =
                    scaled(ratio, rev_per_s)
                else {
                    panic!("{ratio}")
                };
                assert!((1.0..1.2).contains(&rev.abs()) && deviation.abs() > limit, "{ratio}: {rev}");
            }
        }
    }

    #[test]
    fn a_delay_that_is_not_as_told_is_no_wrong_scale() {
        let mut monitor = TravelMonitor::new(TravelLimits { tracking: 0.0, ..LIMITS });
        for k in 0..1000 {
            // 200 rev/s², seen 0.9 ms late.
            let (t_s, late_s) = (0.001 * f64::from(k), 0.000_9);
            let (expected, speed) = (100.0 * t_s * t_s, 200.0 * t_s);
            let now = Travelled { expected, error: -speed * late_s, speed, is_trusted: true };
            assert_eq!(monitor.check(&now), None, "{k}");
        }
    }

    #[test]
    fn what_a_correction_hides_is_the_encoders_only_where_its_drive_contradicts() {
        let monitor = TravelMonitor::new(TravelLimits { axis: Axis::Z, ..LIMITS });
        let z = |error: f64| Travelled { error, is_trusted: true, ..Travelled::default() };
        let hidden = Hidden { error_mm: 0.01, correction_mm: -0.05, limit_mm: 0.05 };
        assert_eq!(
            monitor.hidden(&z(-0.058), &hidden),
            Some(Alarm::TravelMismatch { axis: Axis::Z, deviation: -0.058, limit: 0.05 })
        );
        // Z is where its drive holds it, and follows a spindle that falls behind; or is off the other way.
        for (error, hidden) in [
            (-0.02, hidden),
            (0.058, hidden),
            (-0.058, Hidden { correction_mm: -0.039, ..hidden }),
            (-0.058, Hidden { error_mm: 0.051, ..hidden }),
        ] {
            assert_eq!(monitor.hidden(&z(error), &hidden), None, "{error} {hidden:?}");
        }
        assert_eq!(monitor.hidden(&Travelled { is_trusted: false, ..z(-0.058) }, &hidden), None);
    }
}
