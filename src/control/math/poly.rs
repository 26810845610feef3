//! Motion under constant snap: the quartic every time law of the papers is made of.

/// Factors instead of divisions, which would take most of an evaluation's time.
const SIXTH: f64 = 1.0 / 6.0;
const TWENTY_FOURTH: f64 = 1.0 / 24.0;

/// State of one coordinate at one instant, in the coordinate's own unit (rev or mm) and seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Position.
    pub position: f64,
    /// First derivative of position.
    pub velocity: f64,
    /// Second derivative of position.
    pub acceleration: f64,
    /// Third derivative of position.
    pub jerk: f64,
}

impl State {
    /// The state of a coordinate that moves `ratio` times as far.
    #[must_use]
    #[inline]
    pub fn scaled(&self, ratio: f64) -> Self {
        Self {
            position: ratio * self.position,
            velocity: ratio * self.velocity,
            acceleration: ratio * self.acceleration,
            jerk: ratio * self.jerk,
        }
    }

    /// The same motion from another origin.
    #[must_use]
    #[inline]
    pub fn shifted(&self, offset: f64) -> Self {
        Self { position: offset + self.position, ..*self }
    }

    /// The state after `t` seconds of constant snap; in Estrin's form, whose terms do not wait for each other.
    ///
    /// ```
    /// use rigidtap::control::math::poly::State;
    /// let end = State { velocity: 2.0, acceleration: 4.0, ..State::default() }.after(0.5, 0.0);
    /// assert_eq!((end.position, end.velocity), (1.5, 4.0));
    /// ```
    #[must_use]
    #[inline]
    pub fn after(&self, t: f64, snap: f64) -> Self {
        let Self { position, velocity, acceleration, jerk } = *self;
        let t2 = t * t;
        Self {
            position: (position + t * velocity)
                + t2 * ((acceleration * 0.5 + t * (jerk * SIXTH)) + t2 * (snap * TWENTY_FOURTH)),
            velocity: (velocity + t * acceleration) + t2 * (jerk * 0.5 + t * (snap * SIXTH)),
            acceleration: (acceleration + t * jerk) + t2 * (snap * 0.5),
            jerk: jerk + t * snap,
        }
    }
}
