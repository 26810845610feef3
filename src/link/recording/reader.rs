//! Rows become samples.

use super::found::{Context, Format, Recording};
use super::headings::OVERRUN;
use super::layout::Layout;
use super::row::{RecordingError, Row};
use crate::link::sample::{Gap, Sample};

/// A step of time beyond so many usual ones is a gap.
const GAP_PERIODS: f64 = 1.5;

/// Reads rows into samples.
pub(super) struct Reader<'a> {
    layout: Layout,
    context: &'a Context,
    pub(super) samples: Vec<Sample>,
    gap: Gap,
    rows: u64,
    repeated: u64,
    restarts: u64,
    resets: u64,
    /// What was taken from the spindle's position at resets.
    reset_counts: f64,
    last_step_counts: f64,
}

impl<'a> Reader<'a> {
    pub(super) fn new(layout: Layout, context: &'a Context) -> Self {
        Self {
            layout,
            context,
            samples: Vec::new(),
            gap: Gap::None,
            rows: 0,
            repeated: 0,
            restarts: 0,
            resets: 0,
            reset_counts: 0.0,
            last_step_counts: 0.0,
        }
    }

    pub(super) fn read(&mut self, row: &Row<'_>) -> Result<(), RecordingError> {
        if row.text.trim() == OVERRUN {
            self.gap = self.gap.max(Gap::Readings);
            return Ok(());
        }
        let number = self.rows;
        self.rows += 1;
        let layout = &mut self.layout;
        let time_s = match layout.time {
            Some((column, factor)) => row.number(column)?.map(|time| time * factor),
            None => Some(number as f64 * self.context.period_s),
        };
        let (spindle, z) = (layout.spindle.read(row)?, layout.z.read(row)?);
        let (Some(time_s), Some(mut spindle_counts), Some(z_counts)) = (time_s, spindle, z) else {
            self.gap = self.gap.max(Gap::Readings);
            return Ok(());
        };
        spindle_counts += self.reset_counts;
        if let Some(last) = self.samples.last() {
            if time_s == last.time_s {
                self.repeated += 1;
                return Ok(());
            }
            if time_s < last.time_s {
                self.restarts += 1;
                self.gap = Gap::Origin;
            } else if layout.format == Format::Halsampler {
                let step = spindle_counts - last.spindle_counts;
                let reach = self.context.fastest.spindle_counts_per_s * (time_s - last.time_s);
                // A jump, or a running spindle that falls back to its index.
                let back = step * self.last_step_counts < 0.0 && step.abs() > 4.0 * self.last_step_counts.abs();
                if step.abs() > reach
                    || (back && self.last_step_counts.abs() > self.layout.scale.counts_per_rev / 200.0)
                {
                    self.resets += 1;
                    let carried = last.spindle_counts + self.last_step_counts - spindle_counts;
                    self.reset_counts += carried;
                    spindle_counts += carried;
                } else {
                    self.last_step_counts = step;
                }
            }
        }
        let k = self.samples.len() as u64;
        self.samples.push(Sample { k, time_s, spindle_counts, z_counts, gap: core::mem::take(&mut self.gap) });
        Ok(())
    }

    /// Finds the usual step of time, and with it the gaps and the jitter.
    pub(super) fn finish(mut self) -> Recording {
        let mut steps: Vec<f64> =
            self.samples.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).filter(|step| *step > 0.0).collect();
        let middle = steps.len().saturating_sub(1) / 2;
        let period_s = if steps.is_empty() {
            self.context.period_s
        } else {
            *steps.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        let (mut gaps, mut missing, mut jitter_s, mut k, mut before) = (0, 0, 0f64, 0, None::<f64>);
        for sample in &mut self.samples {
            let step_s = before.map_or(period_s, |before| sample.time_s - before);
            before = Some(sample.time_s);
            let steps = (step_s / period_s).round().max(1.0);
            if step_s > GAP_PERIODS * period_s {
                sample.gap = sample.gap.max(Gap::Readings);
                missing += steps as u64 - 1;
            } else if step_s > 0.0 {
                jitter_s = jitter_s.max((step_s - period_s).abs());
            }
            gaps += u64::from(sample.gap == Gap::Readings);
            k += steps as u64;
            sample.k = k - 1;
        }
        Recording {
            format: self.layout.format,
            samples: self.samples,
            scale: self.layout.scale,
            period_s,
            jitter_s,
            gaps,
            missing,
            repeated: self.repeated,
            restarts: self.restarts,
            resets: self.resets,
        }
    }
}
