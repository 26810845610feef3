//! What was sent of late, and so where the axes' encoders are expected to read.

/// Periods kept; a drive that acts later than that is taken to act so late.
const KEPT: usize = 64;

/// A torque that is reported may have been commanded in so many periods more than the drive's latency: it is a period's mean,
/// interpolated, and late by the current loop and the bus.
const TORQUE_PERIODS: usize = 3;

/// A delay line of both axes' position setpoints and the spindle's torque, machine coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sent {
    /// Periods from a setpoint to the sample that shows it, and to the drive that acts on it.
    delay_periods: f64,
    latency_periods: usize,
    positions: [[f64; 2]; KEPT],
    torques_nm: [f64; KEPT],
    newest: usize,
    is_empty: bool,
}

impl Sent {
    pub(super) fn new(delay_periods: f64, latency_periods: f64) -> Self {
        let most = (KEPT - 2) as f64;
        Self {
            delay_periods: delay_periods.max(0.0).min(most),
            latency_periods: (latency_periods.max(0.0) as usize).min(KEPT - 2 - TORQUE_PERIODS),
            positions: [[0.0; 2]; KEPT],
            torques_nm: [0.0; KEPT],
            newest: 0,
            is_empty: true,
        }
    }

    /// The setpoints of one period, spindle and Z, and the spindle's torque. The first ones stand for all before them.
    pub(super) fn push(&mut self, positions: [f64; 2], torque_nm: f64) {
        if self.is_empty {
            (self.positions, self.is_empty) = ([positions; KEPT], false);
        }
        self.newest = (self.newest + 1) % KEPT;
        if let Some(slot) = self.positions.get_mut(self.newest) {
            *slot = positions;
        }
        if let Some(slot) = self.torques_nm.get_mut(self.newest) {
            *slot = torque_nm;
        }
    }

    /// Least and greatest of the torques that one which is reported in the period after the newest setpoint may obey.
    pub(super) fn torque_range_nm(&self) -> [f64; 2] {
        let first = self.latency_periods.saturating_sub(1);
        (first..=first + TORQUE_PERIODS)
            .filter_map(|periods| self.torques_nm.get(self.index(periods)))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least_nm, most_nm], torque_nm| {
                [least_nm.min(*torque_nm), most_nm.max(*torque_nm)]
            })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.is_empty
    }

    fn index(&self, periods_ago: usize) -> usize {
        (self.newest + KEPT - periods_ago % KEPT) % KEPT
    }

    fn ago(&self, periods: usize) -> [f64; 2] {
        self.positions.get(self.index(periods)).copied().unwrap_or_default()
    }

    /// Where both encoders are expected in the period after the newest setpoint.
    pub(super) fn expected(&self) -> [f64; 2] {
        // The newest setpoint is one period old by then.
        let periods = (self.delay_periods - 1.0).max(0.0);
        let whole = periods as usize;
        let part = periods - whole as f64;
        let ([new_rev, new_mm], [old_rev, old_mm]) = (self.ago(whole), self.ago(whole + 1));
        [new_rev + part * (old_rev - new_rev), new_mm + part * (old_mm - new_mm)]
    }
}

#[cfg(test)]
mod tests {
    use super::Sent;

    #[test]
    fn a_sample_shows_what_was_sent_its_delay_ago() {
        let mut sent = Sent::new(1.25, 1.0);
        (0..100).for_each(|k| sent.push([f64::from(k), -2.0 * f64::from(k)], 0.5 * f64::from(k)));
        // In period 100 that is 98.75.
        assert_eq!(sent.expected(), [98.75, -197.5]);
        // And the mean torque from 99 to 100 what was commanded in 98, at the earliest by the period before.
        assert_eq!(sent.torque_range_nm(), [48.0, 49.5]);
    }

    #[test]
    fn before_the_first_setpoint_it_stood_there() {
        let mut sent = Sent::new(7.0, 7.0);
        assert!(sent.is_empty());
        sent.push([3.0, 4.0], 0.0);
        assert_eq!(sent.expected(), [3.0, 4.0]);
    }
}
