//! How followers move with their master.

mod slider_crank;

pub use slider_crank::SliderCrank;

use crate::control::math::{poly::State, sqrt};

/// Spindle to Z: z = pitch × angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// Z travel per spindle revolution, P of the paper's eq. 1, positive.
    pub pitch_mm: f64,
}

impl Thread {
    /// Z's travel, speed, acceleration and jerk for the spindle's.
    ///
    /// ```
    /// use rigidtap::control::{coupling::Thread, math::poly::State};
    /// let z = Thread { pitch_mm: 1.25 }.follow(&State { position: 4.0, velocity: 50.0, ..State::default() });
    /// assert_eq!((z.position, z.velocity), (5.0, 62.5));
    /// ```
    #[must_use]
    #[inline]
    pub fn follow(&self, spindle: &State) -> State {
        spindle.scaled(self.pitch_mm)
    }
}

/// Path length to N axes on a straight line: each axis in proportion, K_i = P_i/P (multi-axis paper, eq. 6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<const N: usize> {
    start_mm: [f64; N],
    end_mm: [f64; N],
    ratio: [f64; N],
    length_mm: f64,
}

impl<const N: usize> Line<N> {
    /// The line between two points.
    #[must_use]
    pub fn new(start_mm: [f64; N], end_mm: [f64; N]) -> Self {
        let mut ratio = [0.0; N];
        let mut sum = 0.0;
        for ((ratio, end), start) in ratio.iter_mut().zip(end_mm).zip(start_mm) {
            *ratio = end - start;
            sum += *ratio * *ratio;
        }
        let length_mm = sqrt(sum);
        if length_mm > 0.0 {
            for ratio in &mut ratio {
                *ratio /= length_mm;
            }
        }
        Self { start_mm, end_mm, ratio, length_mm }
    }

    /// Path length P.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.length_mm
    }

    /// The greatest path value under which no axis exceeds its own limit: min over i of limit_i/|K_i|.
    ///
    /// Serves speed, acceleration and jerk, which all keep the proportion (multi-axis paper, eq. 7). Infinite for a line without length.
    #[must_use]
    pub fn path_limit(&self, axis_limits: [f64; N]) -> f64 {
        self.ratio.iter().zip(axis_limits).fold(f64::INFINITY, |least, (ratio, limit)| {
            if *ratio == 0.0 { least } else { least.min(limit / ratio.abs()) }
        })
    }

    /// Each axis at a path state. From the path's end on, each axis stands on its own programmed end to the last bit:
    /// the end-point discrimination of the multi-axis paper, eq. 18 and 19.
    ///
    /// ```
    /// use rigidtap::control::{coupling::Line, math::poly::State};
    /// let line = Line::new([0.0, 0.0], [3.0, 4.0]);
    /// let [x, y] = line.follow(&State { position: 2.5, velocity: 10.0, ..State::default() });
    /// assert_eq!((x.position, y.position, x.velocity, y.velocity), (1.5, 2.0, 6.0, 8.0));
    /// ```
    #[must_use]
    pub fn follow(&self, path: &State) -> [State; N] {
        let mut axes = [State::default(); N];
        let at_end = path.position >= self.length_mm;
        for (((axis, ratio), start), end) in axes.iter_mut().zip(self.ratio).zip(self.start_mm).zip(self.end_mm) {
            *axis = path.scaled(ratio);
            axis.position = if at_end { end } else { start + axis.position };
        }
        axes
    }
}
