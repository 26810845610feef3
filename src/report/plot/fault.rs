//! Why there is no picture.

/// Greatest magnitude that a plot shows; anything beyond is no measurement.
const GREATEST: f64 = 1e15;

/// Why there is no picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlotError {
    /// No panel, profile, hole or point to draw.
    Nothing,
    /// A number that is not finite, or beyond 1e15.
    NotDrawable {
        /// The number.
        value: f64,
    },
    /// Points are not in rising order of period or time.
    Order {
        /// Period or time of the offending point.
        at: f64,
        /// That of the point before it.
        previous: f64,
    },
    /// The drawing library refused.
    Drawing,
}

impl core::fmt::Display for PlotError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Nothing => write!(f, "nothing to draw"),
            Self::NotDrawable { value } => write!(f, "cannot draw the value {value}"),
            Self::Order { at, previous } => write!(f, "cannot draw points out of order: {at} after {previous}"),
            Self::Drawing => write!(f, "the drawing library refused"),
        }
    }
}

impl core::error::Error for PlotError {}

/// Refuses what no axis can show.
pub(super) fn check_drawable(values: impl IntoIterator<Item = f64>) -> Result<(), PlotError> {
    match values.into_iter().find(|value| !(-GREATEST..=GREATEST).contains(value)) {
        Some(value) => Err(PlotError::NotDrawable { value }),
        None => Ok(()),
    }
}

/// Refuses points that go back.
pub(super) fn check_order(positions: impl Iterator<Item = f64>) -> Result<(), PlotError> {
    let mut previous = f64::NEG_INFINITY;
    for at in positions {
        if at < previous {
            return Err(PlotError::Order { at, previous });
        }
        previous = at;
    }
    Ok(())
}
