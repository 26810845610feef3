//! Straight lines between holes: each axis keeps its own limits (multi-axis paper, section 3).

use crate::control::coupling::Line;
use crate::control::machine::{AxisSpec, Machine};
use crate::control::math::poly::State;
use crate::control::profile::{Profile, ProfileError, SCurveLaw, StrokeRequest};

/// A straight line of X, Y and Z with its time law.
#[derive(Clone, Debug, PartialEq)]
pub struct Positioning {
    /// Path length to axes.
    pub path: Line<3>,
    /// Path length over time, mm.
    pub profile: Profile,
}

impl Positioning {
    /// From rest to rest under the S-curve, at the speed that `command` makes of the greatest that the axes allow; none
    /// where there is no way to go.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a way or a speed that is no positive finite number.
    ///
    /// ```
    /// use rigidtap::control::{cycle::Positioning, machine::Machine};
    /// let machine = Machine::reference();
    /// let line = Positioning::plan(&machine, [0.0; 3], [30.0, 40.0, 0.0], |top| top).unwrap().unwrap();
    /// // Y takes four fifths of the path's speed.
    /// assert!(line.profile.peak_velocity() <= 500.0 / 0.8);
    /// assert_eq!(line.at(line.profile.duration_s()).map(|axis| axis.position), [30.0, 40.0, 0.0]);
    /// ```
    pub fn plan(
        machine: &Machine,
        from_mm: [f64; 3],
        to_mm: [f64; 3],
        command: impl FnOnce(f64) -> f64,
    ) -> Result<Option<Self>, ProfileError> {
        let path = Line::new(from_mm, to_mm);
        if path.length_mm() == 0.0 {
            return Ok(None);
        }
        let spec = machine.spec();
        let limit = |of: fn(&AxisSpec) -> f64| path.path_limit([of(&spec.x), of(&spec.y), of(&spec.z)]);
        let command = command(limit(|axis| axis.max_mm_per_s));
        let law = SCurveLaw { acceleration: limit(|axis| axis.max_mm_per_s2), jerk: limit(|axis| axis.max_mm_per_s3) };
        let profile = law.plan(StrokeRequest { distance: path.length_mm(), command })?;
        Ok(Some(Self { path, profile }))
    }

    /// The axes at a time from the start.
    #[must_use]
    pub fn at(&self, t_s: f64) -> [State; 3] {
        self.path.follow(&self.profile.at(t_s))
    }
}
