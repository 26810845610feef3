//! One axis' counts: bridged where a sample is missing, refused where it cannot be, watched for an encoder that stands still.
//!
//! The model that stands in is what was commanded, as late as drives and encoders are, and the tracking error that the axis
//! showed last, carried on at its rate (an α–β filter: Kalata, The tracking index, IEEE Trans. AES 20(2), 1984; its gains
//! are those of a fading memory, Brookner 1998).

use crate::control::math::round;

use super::alarm::{Alarm, Axis, FROZEN_COUNTS};

/// Pole of the fading memory: it follows a tracking error within a few periods.
const POLE: f64 = 0.5;
const ALPHA: f64 = 1.0 - POLE * POLE;
const BETA: f64 = (1.0 - POLE) * (1.0 - POLE);
/// What is left in a period of the rate at which a bridged tracking error goes on.
const BRIDGED_RATE_KEPT: f64 = 0.9;
/// What of a tracking error that was the encoder's is forgotten in a period, softly: Z may follow it.
const FALSE_SHARE: f64 = 0.05;
/// An encoder that stands still may flicker by so many.
const FLICKER_COUNTS: u64 = 2;
/// For so many periods the same sample may come again: a fresh one may have been lost.
const REPEATED_PERIODS: u32 = 3;
/// Share of a period's travel that a host's jitter may be worth.
const JITTER_SHARE: f64 = 0.1;
/// A sample that shows no more of a period's travel than this share has come to a halt at once.
const HALTED_SHARE: f64 = 0.15;
/// How much more than the drive's own acceleration the world may give an axis.
const WORLD_ACCELERATION: f64 = 4.0;
/// And how much more a tap that jams may take from it: the shaft rings.
const JAM_ACCELERATION: f64 = 20.0;

/// What is known of an axis and its encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisLimits {
    pub(super) axis: Axis,
    pub(super) counts_per_unit: f64,
    /// Greatest acceleration that the drive gives.
    pub(super) acceleration: f64,
    /// Travel that friction and backlash may withhold.
    pub(super) held: f64,
    pub(super) bridge_periods: u32,
    pub(super) period_s: f64,
}

/// Where an axis seems to be, machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Checked {
    /// Count to go by.
    pub(super) counts: i64,
    /// A model stands in for the sample.
    pub(super) bridged: bool,
    pub(super) alarm: Option<Alarm>,
}

/// The samples of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SampleMonitor {
    limits: AxisLimits,
    /// What its counts are less than the encoder's, after a jump that was not believed.
    shift: i64,
    /// Samples taken in so far, up to the two that a speed needs.
    seen: u32,
    /// Position one period ago, and what was last counted.
    position: f64,
    last_counts: i64,
    /// Travel of the last period.
    travel: f64,
    /// Tracking error and its rate per period: measured less expected.
    error: f64,
    error_rate: f64,
    missing_periods: u32,
    still_periods: u32,
    /// Count and expected position where an encoder came to a halt.
    still_counts: i64,
    still_expected: f64,
    /// The last sample came to a halt at once.
    halts: bool,
    /// From an alarm of this axis until it is acknowledged, the model alone counts.
    distrusted: bool,
    /// The tracking error was the encoder's.
    is_false: bool,
    /// The next sample says by how much a distrusted encoder is off.
    rejoins: bool,
}

impl SampleMonitor {
    pub(super) fn new(limits: AxisLimits) -> Self {
        Self {
            limits,
            shift: 0,
            seen: 0,
            position: 0.0,
            last_counts: 0,
            travel: 0.0,
            error: 0.0,
            error_rate: 0.0,
            missing_periods: 0,
            still_periods: 0,
            still_counts: 0,
            still_expected: 0.0,
            halts: false,
            distrusted: false,
            is_false: false,
            rejoins: false,
        }
    }

    /// Measured less expected, as it was last seen or carried on.
    pub(super) fn tracking_error(&self) -> f64 {
        self.error
    }

    /// Its rate per second.
    pub(super) fn tracking_error_rate(&self) -> f64 {
        self.error_rate / self.limits.period_s
    }

    /// Whether the counts are to be gone by.
    pub(super) fn is_trusted(&self) -> bool {
        !self.distrusted
    }

    /// The counts came to a halt at once: what moves may be behind a frozen encoder.
    pub(super) fn may_be_frozen(&self) -> bool {
        self.halts || self.still_periods > 0
    }

    /// Speed of the last period.
    pub(super) fn speed(&self) -> f64 {
        self.travel / self.limits.period_s
    }

    /// Leaves what the model says behind once the encoder is back.
    pub(super) fn acknowledge(&mut self) {
        self.rejoins |= self.distrusted;
        (self.distrusted, self.is_false) = (false, false);
        (self.missing_periods, self.still_periods, self.still_expected) = (0, 0, 0.0);
    }

    fn units(&self, counts: i64) -> f64 {
        counts as f64 / self.limits.counts_per_unit
    }

    /// Whether a sample looks like the last one come again, though its axis moves.
    pub(super) fn looks_repeated(&self, counts: i64, expected: f64) -> bool {
        let fast = FROZEN_COUNTS / self.limits.counts_per_unit;
        let ahead = expected + self.error + self.error_rate - self.position;
        // While a sample is bridged this is what it should have moved.
        let was_moving = self.travel.abs() >= fast;
        self.seen >= 2 && self.is_still(counts.wrapping_sub(self.shift)) && was_moving && ahead.abs() >= fast
    }

    /// Whether a count is that of the halt, or of the last sample, but for its flicker.
    fn is_still(&self, counts: i64) -> bool {
        let halt = if self.still_periods > 0 { self.still_counts } else { self.last_counts };
        counts.wrapping_sub(halt).unsigned_abs() <= FLICKER_COUNTS
    }

    /// One period: a sample, where there is one, and where the axis is expected by what was commanded. `repeated_frame` says
    /// that every axis' sample came again; `may_halt`, that the axis no longer follows its command.
    pub(super) fn check(
        &mut self,
        sample: Option<i64>,
        expected: f64,
        repeated_frame: bool,
        may_halt: bool,
    ) -> Checked {
        let sample = sample.map(|counts| counts.wrapping_sub(self.shift));
        let predicted = expected + self.error + self.error_rate;
        let Some(counts) = sample.filter(|_| !self.distrusted && !repeated_frame) else {
            return self.bridge(expected, predicted);
        };
        if self.seen < 2 {
            return self.take_first(counts, expected);
        }
        if self.rejoins {
            self.rejoins = false;
            let off = self.units(counts) - predicted;
            if off.abs() > self.slack(0.0, 1.0, WORLD_ACCELERATION) {
                let believed = round(predicted * self.limits.counts_per_unit) as i64;
                self.shift = self.shift.wrapping_add(counts.wrapping_sub(believed));
                return self.take(believed, expected, predicted);
            }
        }
        if may_halt {
            (self.still_periods, self.still_expected) = (0, expected);
        } else if self.looks_repeated(counts.wrapping_add(self.shift), expected) {
            return self.repeated(expected, predicted);
        }
        // After a gap the model has been carried on without a check.
        let periods = f64::from(self.missing_periods.max(self.still_periods) + 1);
        let ahead = predicted - self.position;
        let travel = self.units(counts) - self.position;
        let slack = self.slack(ahead, periods, if may_halt { JAM_ACCELERATION } else { WORLD_ACCELERATION });
        // An axis that is held fast may come to rest at any rate, whatever was expected of it.
        let (least, most) = (ahead.min(self.travel).min(0.0), ahead.max(self.travel).max(0.0));
        if travel < least - slack || travel > most + slack {
            return self.refuse(travel, ahead, slack, expected, predicted);
        }
        let moved = ahead.abs().min(self.travel.abs());
        self.halts = travel.abs() < HALTED_SHARE * moved && moved * self.limits.counts_per_unit > FROZEN_COUNTS;
        // Nothing brings it to rest at once: either its encoder stands, or the next samples will tell.
        let braked = self.slack(ahead, periods, JAM_ACCELERATION);
        if !may_halt && moved - travel.abs() > braked && self.still_periods == 0 {
            (self.still_counts, self.still_expected) = (counts, self.position + travel);
            return self.halted(expected, predicted);
        }
        self.take(counts, expected, predicted)
    }

    /// By how much a travel over some periods may differ from what is expected.
    fn slack(&self, ahead: f64, periods: f64, world_acceleration: f64) -> f64 {
        let AxisLimits { counts_per_unit, acceleration, period_s, .. } = self.limits;
        let pushed_s = periods * period_s;
        FROZEN_COUNTS / counts_per_unit
            + JITTER_SHARE * ahead.abs()
            + world_acceleration * acceleration * pushed_s * pushed_s
    }

    fn take_first(&mut self, counts: i64, expected: f64) -> Checked {
        let position = self.units(counts);
        let error = position - expected;
        self.error_rate = if self.seen == 0 { 0.0 } else { error - self.error };
        self.travel = if self.seen == 0 { 0.0 } else { position - self.position };
        (self.error, self.position, self.last_counts) = (error, position, counts);
        self.seen += 1;
        self.checked(counts, false)
    }

    fn take(&mut self, counts: i64, expected: f64, predicted: f64) -> Checked {
        let position = self.units(counts);
        let innovation = position - predicted;
        self.error += self.error_rate + ALPHA * innovation;
        self.error_rate += BETA * innovation;
        self.missing_periods = 0;
        let alarm = self.watch_still(counts, expected);
        self.travel = position - self.position;
        (self.position, self.last_counts) = (position, counts);
        Checked { alarm, ..self.checked(counts, false) }
    }

    /// An encoder that stands still at a speed too low for its sample to look repeated.
    fn watch_still(&mut self, counts: i64, expected: f64) -> Option<Alarm> {
        if !self.is_still(counts) {
            self.still_periods = 0;
            return None;
        }
        if self.still_periods == 0 {
            (self.still_counts, self.still_expected) = (counts, expected);
        }
        self.still_periods = self.still_periods.saturating_add(1);
        self.frozen(expected)
    }

    fn repeated(&mut self, expected: f64, predicted: f64) -> Checked {
        if self.still_periods == 0 {
            (self.still_counts, self.still_expected) = (self.last_counts, expected - self.travel);
        }
        self.halted(expected, predicted)
    }

    fn halted(&mut self, expected: f64, predicted: f64) -> Checked {
        self.still_periods = self.still_periods.saturating_add(1);
        let alarm = self.frozen(expected);
        self.carry_on(predicted);
        Checked { alarm, ..self.checked(self.believed(), true) }
    }

    /// The alarm of an encoder that has stood still for long enough; [`Self::still_expected`] is where it should have been
    /// when it came to a halt.
    fn frozen(&mut self, expected: f64) -> Option<Alarm> {
        let missed = (expected - self.still_expected).abs();
        let expected_counts = missed * self.limits.counts_per_unit;
        let least = FROZEN_COUNTS / self.limits.counts_per_unit + self.limits.held;
        if self.still_periods <= REPEATED_PERIODS || missed < least {
            return None;
        }
        self.distrusted = true;
        Some(Alarm::EncoderFrozen { axis: self.limits.axis, periods: self.still_periods, expected_counts })
    }

    fn refuse(&mut self, travel: f64, ahead: f64, slack: f64, expected: f64, predicted: f64) -> Checked {
        self.distrusted = true;
        let axis = self.limits.axis;
        let backwards = (travel + ahead).abs() < slack && ahead.abs() > slack;
        let alarm = if backwards {
            Alarm::TravelMismatch { axis, deviation: self.position + travel - expected, limit: slack }
        } else {
            Alarm::CountJump { axis, travel, limit: ahead.abs() + slack }
        };
        self.carry_on(predicted);
        Checked { alarm: Some(alarm), ..self.checked(self.believed(), true) }
    }

    fn bridge(&mut self, expected: f64, predicted: f64) -> Checked {
        if self.seen == 0 {
            // Nothing was ever read: where it was commanded to stand is all there is.
            (self.position, self.seen) = (expected, 2);
        }
        self.missing_periods = self.missing_periods.saturating_add(1);
        self.carry_on(predicted);
        let (periods, limit) = (self.missing_periods, self.limits.bridge_periods);
        let lost = !self.distrusted && periods > limit;
        self.distrusted |= lost;
        let alarm = lost.then_some(Alarm::SampleLost { axis: self.limits.axis, periods, limit });
        Checked { alarm, ..self.checked(self.believed(), true) }
    }

    fn carry_on(&mut self, predicted: f64) {
        self.travel = predicted - self.position;
        self.position = predicted;
        self.error += self.error_rate;
        self.error_rate = if self.is_false { -FALSE_SHARE * self.error } else { BRIDGED_RATE_KEPT * self.error_rate };
    }

    fn believed(&self) -> i64 {
        round(self.position * self.limits.counts_per_unit) as i64
    }

    fn checked(&self, counts: i64, bridged: bool) -> Checked {
        Checked { counts, bridged, alarm: None }
    }

    /// The encoder's travel does not fit its axis: from now on the model alone counts, and the axis is where it was commanded. The
    /// tracking error that was seen is the encoder's, and forgotten.
    pub(super) fn distrust(&mut self) {
        (self.distrusted, self.is_false) = (true, true);
        self.error_rate = -FALSE_SHARE * self.error;
    }
}
