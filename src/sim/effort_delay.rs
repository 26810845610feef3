//! The time that a drive computes: its effort acts some of its periods after what it measured.

/// Ticks that are kept: enough for the greatest delay that a machine file allows.
const KEPT: usize = 10;

/// The last efforts of one drive, newest first.
#[derive(Clone, Debug)]
pub(crate) struct EffortDelay {
    efforts: [f64; KEPT],
    whole_ticks: usize,
    /// The effort of so many ticks ago, and the one before it.
    due: f64,
    before: f64,
    /// Steps of a tick in which the effort before is still in force.
    rest_steps: u32,
    /// Steps since the newest effort.
    step: u32,
}

impl EffortDelay {
    /// A delay in drive periods, rounded to plant steps.
    pub(crate) fn new(delay_periods: f64, steps_per_tick: u32) -> Self {
        let steps = (delay_periods * f64::from(steps_per_tick)).round() as u32;
        let whole_ticks = ((steps / steps_per_tick) as usize).min(KEPT - 2);
        Self { efforts: [0.0; KEPT], whole_ticks, due: 0.0, before: 0.0, rest_steps: steps % steps_per_tick, step: 0 }
    }

    /// A tick's new effort.
    pub(crate) fn push(&mut self, effort: f64) {
        if self.whole_ticks > 0 || self.rest_steps > 0 {
            self.efforts.rotate_right(1);
        }
        self.efforts[0] = effort;
        (self.due, self.before) = (self.efforts[self.whole_ticks], self.efforts[self.whole_ticks + 1]);
        self.step = 0;
    }

    /// The effort of all steps of this tick, where it is one.
    #[inline(always)]
    pub(crate) fn of_tick(&self) -> Option<f64> {
        (self.rest_steps == 0).then_some(self.due)
    }

    /// The effort in force over the next plant step.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> f64 {
        if self.step < self.rest_steps {
            self.step += 1;
            self.before
        } else {
            self.due
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effort_acts_so_many_steps_late() {
        for (delay_periods, late_steps) in [(0.0, 0), (0.4, 2), (1.0, 5), (1.6, 8), (2.0, 10)] {
            let mut delay = EffortDelay::new(delay_periods, 5);
            let in_force: Vec<f64> = (0..40)
                .map(|step| {
                    if step % 5 == 0 {
                        delay.push(f64::from(step) + 1.0);
                    }
                    delay.next()
                })
                .collect();
            for (step, effort) in (0_i32..).zip(in_force).skip(11) {
                assert_eq!(
                    effort,
                    f64::from((step - late_steps) / 5 * 5) + 1.0,
                    "{delay_periods} periods, step {step}"
                );
            }
        }
    }
}
