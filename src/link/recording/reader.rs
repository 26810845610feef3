//! Rows become samples.

use super::fault::RecordingError;
use super::found::{Context, Corrupt, Corruption, Format, Recording};
use super::layout::Layout;
use super::row::Row;
use crate::link::plausibility::{Axis, Plausibility};
use crate::link::sample::{Gap, Sample};

/// A step of time beyond so many usual ones is a gap.
const GAP_PERIODS: f64 = 1.5;
/// A first or last row further away than so many usual steps has a corrupt time.
const ALONE_PERIODS: f64 = 1000.0;
/// No gap is longer: years. A corrupt time must not use up the numbers.
const MOST_STEPS: f64 = 1e12;
/// Corrupt readings that are told one by one.
const MOST_TOLD: usize = 5;
/// LinuxCNC's spindle comes out of a reset with less than so many steps of a period,
const RESET_STEPS: f64 = 2.0;
/// of which this share of its greatest speed is one, too, where it is at rest.
const RESET_SHARE: f64 = 0.01;

/// A row's time as it stands, for a message that only the next row brings about.
#[derive(Clone, Debug)]
struct Stamp {
    line: usize,
    value: String,
    /// The step of time to this row goes back, or leaps ahead.
    back: bool,
    odd: bool,
    /// It goes back, or so far ahead that a row at either end stands alone.
    alone: bool,
}

/// Reads rows into samples.
pub(super) struct Reader<'a> {
    layout: Layout,
    context: &'a Context,
    plausibility: Plausibility,
    /// Judges what follows a corrupt reading: readings that fit each other are a new beginning.
    anew: Plausibility,
    /// A row before this one was corrupt.
    doubtful: bool,
    found: Recording,
    last: Option<Sample>,
    stamp: Option<Stamp>,
    gap: Gap,
    rows: u64,
    /// What was taken from the spindle's position at resets.
    reset_counts: f64,
    last_step_counts: f64,
}

impl<'a> Reader<'a> {
    /// For rows `period_s` apart.
    pub(super) fn new(layout: Layout, period_s: f64, context: &'a Context) -> Self {
        let plausibility = Plausibility::new(&context.limits, &layout.scale, period_s);
        let found = Recording {
            format: layout.format,
            readings: 0,
            scale: layout.scale,
            period_s,
            jitter_s: 0.0,
            gaps: 0,
            missing: 0,
            repeated: 0,
            restarts: 0,
            resets: 0,
            corrupt: 0,
            first_corrupt: Vec::new(),
        };
        Self {
            layout,
            context,
            plausibility,
            anew: plausibility,
            doubtful: false,
            found,
            last: None,
            stamp: None,
            gap: Gap::None,
            rows: 0,
            reset_counts: 0.0,
            last_step_counts: 0.0,
        }
    }

    /// The next row's sample, if it is one.
    pub(super) fn read(&mut self, row: &Row) -> Result<Option<Sample>, RecordingError> {
        if row.is_overrun() {
            self.gap = self.gap.max(Gap::Readings);
            if self.layout.time.is_none() {
                // How long it lost samples nobody knows.
                self.plausibility.forget();
            }
            return Ok(None);
        }
        let number = self.rows;
        self.rows += 1;
        let time_s = match &self.layout.time {
            Some(time) => row.number(time.column)?.map(|value| value * time.factor),
            None => Some(number as f64 * self.context.period_s),
        };
        let counters = (self.layout.spindle.clone(), self.layout.z.clone());
        let (spindle, z) = (self.layout.spindle.read(row)?, self.layout.z.read(row)?);
        let (Some(time_s), Some(spindle_counts), Some(z_counts)) = (time_s, spindle, z) else {
            self.gap = self.gap.max(Gap::Readings);
            return Ok(None);
        };
        if !time_s.is_finite() {
            let line = row.number;
            let value = self.layout.time.as_ref().map_or_else(String::new, |time| row.shown(time.column));
            self.corrupt_time(line, value);
            return Ok(None);
        }
        if self.last.is_some_and(|last| time_s == last.time_s) {
            self.found.repeated += 1;
            return Ok(None);
        }
        self.step_of_time(time_s, row);
        let spindle_counts = self.carried(time_s, spindle_counts + self.reset_counts, z_counts);
        if !self.is_plausible(row, time_s, spindle_counts, z_counts) {
            // A wrapping counter is unwrapped from the last reading that is one.
            (self.layout.spindle, self.layout.z) = counters;
            return Ok(None);
        }
        Ok(Some(self.sample(time_s, spindle_counts, z_counts)))
    }

    /// Notes where time goes back or leaps ahead; where both steps of a row do, it is the row's time that is corrupt.
    fn step_of_time(&mut self, time_s: f64, row: &Row) {
        let period_s = self.found.period_s;
        let Some(time) = &self.layout.time else { return };
        let value = row.shown(time.column);
        let (mut back, mut odd, mut alone) = (false, false, false);
        if let Some(last) = self.last {
            let step_s = time_s - last.time_s;
            back = step_s < 0.0;
            odd = back || step_s > GAP_PERIODS * period_s;
            alone = back || step_s > ALONE_PERIODS * period_s;
            let first = self.found.readings == 1;
            let before =
                self.stamp.take().filter(|before| (first && alone) || (before.odd && odd && (before.back || back)));
            if let Some(before) = before {
                self.corrupt_time(before.line, before.value);
            }
            if back {
                self.found.restarts += 1;
                self.gap = Gap::Origin;
                self.plausibility.forget();
            }
        }
        self.stamp = Some(Stamp { line: row.number, value, back, odd, alone });
    }

    /// halsampler's spindle position counts on where LinuxCNC resets it at the index: there it begins near 0.
    fn carried(&mut self, time_s: f64, spindle_counts: f64, z_counts: f64) -> f64 {
        let Some(last) = self.last.filter(|last| time_s > last.time_s) else { return spindle_counts };
        // A reset leaves a position that readings before it had shown.
        if self.layout.format != Format::Halsampler || self.found.readings < 2 {
            return spindle_counts;
        }
        let step = spindle_counts - last.spindle_counts;
        let max_per_s = self.context.limits.max_rev_per_s * self.layout.scale.counts_per_rev;
        let shown = spindle_counts - self.reset_counts;
        let near = RESET_STEPS * (self.last_step_counts.abs() + RESET_SHARE * max_per_s * self.found.period_s);
        let leaps = || {
            let mut plausibility = self.plausibility;
            let expected = last.spindle_counts + self.last_step_counts;
            // Z goes on: what leaps is the spindle alone.
            plausibility.judge(time_s, spindle_counts, z_counts).is_some() && { self.plausibility }
                .judge(time_s, expected, z_counts)
                .is_none()
        };
        if shown.abs() <= near && (step.abs() > max_per_s * (time_s - last.time_s) || leaps()) {
            self.found.resets += 1;
            let carried = last.spindle_counts + self.last_step_counts - spindle_counts;
            self.reset_counts += carried;
            return spindle_counts + carried;
        }
        self.last_step_counts = step;
        spindle_counts
    }

    fn is_plausible(&mut self, row: &Row, time_s: f64, spindle_counts: f64, z_counts: f64) -> bool {
        let Some(jump) = self.plausibility.judge(time_s, spindle_counts, z_counts) else {
            self.doubtful = false;
            return true;
        };
        if self.doubtful && self.anew.judge(time_s, spindle_counts, z_counts).is_none() {
            // Two readings that fit each other and not what was before: counts were lost for good.
            self.plausibility = self.anew;
            self.doubtful = false;
            self.gap = Gap::Origin;
            return true;
        }
        let position = match jump.axis {
            Axis::Spindle => &self.layout.spindle,
            Axis::Z => &self.layout.z,
        };
        let (column, name) = (position.column, position.name.clone());
        self.tell(row.number, column, name, row.shown(column), Corruption::Position(jump));
        self.anew.forget();
        self.doubtful = self.anew.judge(time_s, spindle_counts, z_counts).is_none();
        self.gap = self.gap.max(Gap::Readings);
        false
    }

    fn corrupt_time(&mut self, line: usize, value: String) {
        if let Some(time) = self.layout.time.clone() {
            self.tell(line, time.column, time.name, value, Corruption::Time);
        }
        self.gap = self.gap.max(Gap::Readings);
    }

    fn tell(&mut self, line: usize, column: usize, name: String, value: String, why: Corruption) {
        self.found.corrupt += 1;
        if self.found.first_corrupt.len() < MOST_TOLD {
            self.found.first_corrupt.push(Corrupt { line, column: column + 1, name, value, why });
        }
    }

    /// Numbers the sample by the usual step of time, and counts what is missing before it.
    fn sample(&mut self, time_s: f64, spindle_counts: f64, z_counts: f64) -> Sample {
        let found = &mut self.found;
        let step_s = self.last.map_or(found.period_s, |last| time_s - last.time_s);
        let steps = (step_s / found.period_s).round().clamp(1.0, MOST_STEPS) as u64;
        if step_s > GAP_PERIODS * found.period_s {
            self.gap = self.gap.max(Gap::Readings);
            found.missing = found.missing.saturating_add(steps - 1);
        } else if step_s > 0.0 {
            found.jitter_s = found.jitter_s.max((step_s - found.period_s).abs());
        }
        found.gaps += u64::from(self.gap == Gap::Readings);
        found.readings += 1;
        let k = self.last.map_or(0, |last| last.k.saturating_add(steps));
        let sample = Sample { k, time_s, spindle_counts, z_counts, gap: core::mem::take(&mut self.gap) };
        self.last = Some(sample);
        sample
    }

    /// What was found.
    pub(super) fn finish(mut self) -> Recording {
        // A last row that stands alone in time.
        if let Some(stamp) = self.stamp.take().filter(|stamp| stamp.alone) {
            self.corrupt_time(stamp.line, stamp.value);
        }
        self.found
    }
}
