//! A movement that may become a hole.

use crate::control::sync::ErrorBand;
use crate::control::units::um_from_mm;
use crate::link::sample::{Gap, Sample};

use super::hole::{Found, MeasuredHole, measure};
use super::listener::{AnalysisListener, Cutting};
use super::rest::{CHORD_S, Rest};
use super::row::MeasuredRow;
use super::settings::AnalysisSettings;
use super::travel::Travel;

/// From half a revolution to a whole one it shows whether Z follows the spindle.
const LOOK_REV: f64 = 0.5;
const SHOWS_REV: f64 = 1.0;
/// The ratio of Z's travel to pitch × spindle there: lags of several periods are within.
const SHOWS_RATIO: std::ops::RangeInclusive<f64> = 0.3..=2.0;
/// Beyond this ratio on the way in it is no thread, however lost.
const THREAD_RATIO: std::ops::RangeInclusive<f64> = 0.15..=7.0;
/// The ratio at rest at the bottom.
const BOTTOM_RATIO: std::ops::RangeInclusive<f64> = 0.4..=2.5;
/// A turn back by this much is a reversal.
const REVERSED_REV: f64 = 0.25;
/// This close to the beginning both are home.
const HOME_REV: f64 = 0.03;
/// At rest for this long with Z back: the hole is done. A smooth law rests for some 20 ms between pecks.
const DONE_S: f64 = 0.06;
/// A spindle that turned already: Z is in step where its speed is within this share of pitch × spindle speed.
const IN_STEP: f64 = 0.02;
/// And stays so for this long.
const IN_STEP_S: f64 = 0.012;
/// Spindle and Z of one hole do not stop further apart than this.
const APART_S: f64 = 0.03;
/// Unless Z followed it for so many revolutions, to this share of the pitch: then it is a thread, and may be lost after.
const PROVEN_REV: f64 = 3.0;
const PROVEN_SHARE: f64 = 0.25;
/// A spindle that lost its thread brakes and turns within this time, or never.
const LOST_S: f64 = 0.5;
/// Longer than any hole: some minutes at 10 kHz.
const MOST_SAMPLES: usize = 4_000_000;

/// How it goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// More samples.
    Go,
    /// The hole ended at this sample.
    Done(usize),
    /// It was no hole.
    Dismissed,
    /// The data end in it.
    Broken,
}

#[derive(Clone, Debug)]
pub(super) struct Candidate {
    settings: AnalysisSettings,
    /// The spindle turned before Z moved.
    running: bool,
    samples: Vec<Sample>,
    /// Direction of the thread, once Z follows.
    hand: Option<f64>,
    in_step_since_s: Option<f64>,
    /// First sample whose error counts.
    judged_from: Option<usize>,
    /// Z followed from rest: a thread, whatever comes.
    proven: bool,
    deepest_mm: f64,
    furthest_rev: f64,
    band_um: ErrorBand,
    alarmed: bool,
    /// Where it came to rest with Z back, if it stays there.
    rested: Option<usize>,
    /// The newest sample has both axes where they began, after a reversal.
    home: bool,
}

impl Candidate {
    pub(super) fn new(settings: AnalysisSettings, running: bool) -> Self {
        Self {
            settings,
            running,
            samples: Vec::new(),
            hand: None,
            in_step_since_s: None,
            judged_from: (!running).then_some(0),
            proven: false,
            deepest_mm: 0.0,
            furthest_rev: 0.0,
            band_um: ErrorBand::default(),
            alarmed: false,
            rested: None,
            home: false,
        }
    }

    pub(super) fn is_hole(&self) -> bool {
        self.hand.is_some()
    }

    pub(super) fn push(
        &mut self,
        sample: Sample,
        spindle: &Rest,
        z: &Rest,
        number: u32,
        listener: &mut dyn AnalysisListener,
    ) -> Next {
        let Some(zero) = self.samples.first().copied() else {
            // A gap before the zero is none of the hole's.
            self.samples.push(Sample { gap: Gap::None, ..sample });
            return Next::Go;
        };
        self.samples.push(sample);
        if self.samples.len() > MOST_SAMPLES {
            return Next::Dismissed;
        }
        let pitch_mm = self.settings.pitch_mm;
        let Some(hand) = self.hand else { return self.look(&zero, &sample, spindle, z) };
        let travel = Travel::between(&zero, &sample, hand, &self.settings.scale);
        self.deepest_mm = self.deepest_mm.max(travel.z_mm);
        self.furthest_rev = self.furthest_rev.max(travel.spindle_rev);
        let reversed = self.furthest_rev - travel.spindle_rev > REVERSED_REV;
        let z_reversed = self.deepest_mm - travel.z_mm > REVERSED_REV * pitch_mm;
        self.watch(&travel, &sample, reversed, number, listener);
        if !reversed {
            let ratio = travel.z_mm / (pitch_mm * travel.spindle_rev.max(SHOWS_REV));
            let lost = !z_reversed && travel.spindle_rev > 2.0 && !THREAD_RATIO.contains(&ratio);
            let gone = z_reversed && travel.z_mm <= 0.0 && !self.running && spindle_runs_on(&travel, self.furthest_rev);
            // Z that stops or turns while the spindle runs on was a drill's, or an approach.
            let left = self.running && z_reversed;
            // One moves on while the other has stopped: an approach with a spindle that runs up or down.
            let followed = um_from_mm(PROVEN_SHARE * pitch_mm) >= self.band_um.magnitude();
            self.proven |= !self.running && travel.spindle_rev >= PROVEN_REV && followed;
            let most_s = if self.proven { LOST_S } else { APART_S };
            let apart = |stopped: &Rest, moving: &Rest| stopped.lasted_s() > most_s && moving.moving_s() > most_s;
            let parted = !z_reversed && (apart(z, spindle) || apart(spindle, z));
            // At the bottom a thread has about its pitch, and a spindle that turned already does not pause.
            let stopped = spindle.lasted_s() > APART_S && (self.running || !BOTTOM_RATIO.contains(&ratio));
            return match lost || gone || left || parted || stopped {
                false => Next::Go,
                true if self.proven => Next::Broken,
                true => Next::Dismissed,
            };
        }
        let last = self.samples.len() - 1;
        if self.running {
            return if travel.z_mm <= 0.0 { Next::Done(last) } else { Next::Go };
        }
        let is_home = |mm: f64| mm.abs() <= HOME_REV * pitch_mm;
        self.home = is_home(travel.z_mm) && is_home(travel.spindle_rev * pitch_mm);
        let back = travel.z_mm < (0.25 * self.deepest_mm).max(0.5 * pitch_mm);
        self.rested = (back && spindle.is_at_rest()).then(|| {
            let since_s = spindle.since_s();
            self.samples.iter().rposition(|sample| sample.time_s <= since_s).unwrap_or(last)
        });
        let withdrawn = travel.z_mm < -0.5 * pitch_mm;
        if let Some(rested) = self.rested.filter(|_| spindle.lasted_s() >= DONE_S || withdrawn) {
            return Next::Done(rested);
        }
        let last_where = |is: &dyn Fn(Travel) -> bool| {
            let travel = |sample: &Sample| Travel::between(&zero, sample, hand, &self.settings.scale);
            self.samples.iter().rposition(|sample| is(travel(sample))).unwrap_or(last)
        };
        if withdrawn {
            return Next::Done(last_where(&|travel| travel.z_mm >= -HOME_REV * pitch_mm));
        }
        // A spindle that lost its command swings through its start, and is waited for. One that goes further than it
        // came from runs on by its own: the hole ended where either was back.
        if travel.spindle_rev < -self.furthest_rev {
            return Next::Done(last_where(&|travel| travel.spindle_rev > 0.0 && travel.z_mm > 0.0));
        }
        Next::Go
    }

    /// Does Z follow?
    fn look(&mut self, zero: &Sample, sample: &Sample, spindle: &Rest, z: &Rest) -> Next {
        let travel = Travel::between(zero, sample, 1.0, &self.settings.scale);
        let pitch_mm = self.settings.pitch_mm;
        let (z_mm, spindle_rev) = (travel.z_mm, travel.spindle_rev.abs());
        if self.running {
            let hand = travel.spindle_rev.signum();
            if spindle.is_at_rest() || z.lasted_s() > APART_S {
                return Next::Dismissed;
            }
            // A stroke of an axis that catches up: in step within a few revolutions, or it is none.
            // Speeds that only cross are those of an approach.
            if !self.is_in_step(hand) {
                self.in_step_since_s = None;
            } else if sample.time_s - *self.in_step_since_s.get_or_insert(sample.time_s) >= IN_STEP_S {
                self.hand = Some(hand);
                self.judged_from = Some(self.samples.len() - 1);
                return Next::Go;
            }
            let catching_up = z_mm > 0.0 && sample.time_s - zero.time_s < 0.5;
            return if catching_up { Next::Go } else { Next::Dismissed };
        }
        let shows = SHOWS_RATIO.contains(&(z_mm / (pitch_mm * spindle_rev)));
        if spindle_rev < LOOK_REV {
            let other = z_mm.abs() > 3.0 * pitch_mm || spindle.lasted_s() > APART_S;
            return if other { Next::Dismissed } else { Next::Go };
        }
        if !shows {
            return Next::Dismissed;
        }
        if spindle_rev < SHOWS_REV {
            return Next::Go;
        }
        let hand = travel.spindle_rev.signum();
        self.hand = Some(hand);
        for sample in &self.samples {
            self.band_um.add(Travel::between(zero, sample, hand, &self.settings.scale).error_um(pitch_mm));
        }
        Next::Go
    }

    /// Z's speed is that of the thread.
    fn is_in_step(&self, hand: f64) -> bool {
        let Some(last) = self.samples.last() else { return false };
        let Some(first) = self.samples.iter().rev().find(|sample| last.time_s - sample.time_s >= CHORD_S) else {
            return false;
        };
        let step = Travel::between(first, last, hand, &self.settings.scale);
        let due_mm = self.settings.pitch_mm * step.spindle_rev;
        due_mm > 0.0 && (step.z_mm - due_mm).abs() <= IN_STEP * due_mm
    }

    fn watch(
        &mut self,
        travel: &Travel,
        sample: &Sample,
        reversed: bool,
        number: u32,
        listener: &mut dyn AnalysisListener,
    ) {
        // The last bit of the way out is left to the judgement: Z may already be free there.
        let over = reversed && travel.spindle_rev < REVERSED_REV;
        if self.judged_from.is_none() || over {
            return;
        }
        let error_um = travel.error_um(self.settings.pitch_mm);
        self.band_um.add(error_um);
        let cutting =
            Cutting { hole: number, sample: *sample, z_travel_mm: travel.z_mm, error_um, band_um: self.band_um };
        if !self.alarmed && self.settings.tolerance_um.is_some_and(|most| self.band_um.peak_to_peak() > most) {
            self.alarmed = true;
            listener.alarm(&cutting);
        }
        listener.cutting(&cutting);
    }

    /// The hole with its rows and the samples after it; the samples alone where it was none.
    pub(super) fn finish(
        self,
        next: Next,
        number: u32,
    ) -> Result<(MeasuredHole, Vec<MeasuredRow>, Vec<Sample>), Vec<Sample>> {
        let Self { settings, running, mut samples, hand, judged_from, rested, home, .. } = self;
        let (Some(hand), Some(judged_from)) = (hand, judged_from) else { return Err(samples) };
        let (end, broken) = match (next, rested) {
            (Next::Done(last), _) | (Next::Broken, Some(last)) => (last + 1, false),
            (Next::Dismissed, _) => return Err(samples),
            // A recording may end with its last period.
            (Next::Go | Next::Broken, _) => (samples.len(), !home),
        };
        let after = samples.split_off(end.min(samples.len()));
        let found = Found { number, running, hand, judged_from, broken };
        let (hole, rows) = measure(&settings, &found, &samples);
        Ok((hole, rows, after))
    }
}

/// Z is back where it was, and the spindle has not even turned round.
fn spindle_runs_on(travel: &Travel, furthest_rev: f64) -> bool {
    furthest_rev - travel.spindle_rev < 1e-3
}
