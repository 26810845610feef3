//! Faults that can be switched on: in what the host reads, while the drives keep their own encoders, or in the machine.

use core::fmt;
use core::str::FromStr;

/// One of the two axes that tapping needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The spindle.
    Spindle,
    /// Z.
    Z,
}

/// What can go wrong with one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisFault {
    /// The host's sample is flagged as invalid and keeps its last count; three periods by default.
    Invalid,
    /// The host's sample is the last one again, and nobody says so; three periods by default.
    Repeated,
    /// The host's count stands still, while the drive's encoder goes on.
    Frozen,
    /// The encoder itself stands still: the drive's loops, too.
    EncoderFrozen,
    /// The host's count jumps by a million: an index lost, a bit flipped.
    Jump,
    /// The host's counter of 24 bits wraps and nobody unwraps it.
    Wrap,
    /// The host counts backwards from here on.
    Reversed,
    /// The host's counts are 2 % too large from here on.
    Scaled,
    /// The drive trips and reports it; the axis coasts.
    Trip,
    /// The drive is off and reports nothing of it; the axis coasts.
    Coast,
    /// The motor loses half its torque; of Z the drive loses 95 % of its force.
    Weak,
    /// The reported effort is not a number; three periods by default.
    EffortNan,
    /// The reported effort is ten times what the drive has; three periods by default.
    EffortHuge,
}

impl AxisFault {
    const ALL: [Self; 13] = [
        Self::Invalid,
        Self::Repeated,
        Self::Frozen,
        Self::EncoderFrozen,
        Self::Jump,
        Self::Wrap,
        Self::Reversed,
        Self::Scaled,
        Self::Trip,
        Self::Coast,
        Self::Weak,
        Self::EffortNan,
        Self::EffortHuge,
    ];

    const fn name(self) -> &'static str {
        match self {
            Self::Invalid => "invalid",
            Self::Repeated => "repeated",
            Self::Frozen => "frozen",
            Self::EncoderFrozen => "encoder-frozen",
            Self::Jump => "jump",
            Self::Wrap => "wrap",
            Self::Reversed => "reversed",
            Self::Scaled => "scaled",
            Self::Trip => "trip",
            Self::Coast => "coast",
            Self::Weak => "weak",
            Self::EffortNan => "effort-nan",
            Self::EffortHuge => "effort-huge",
        }
    }
}

/// One fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Of one axis.
    Axis(Axis, AxisFault),
    /// A frame from the drives is lost, and the bus says so: both samples invalid; three periods by default.
    FrameInvalid,
    /// The same unsaid: both samples are the last ones again; three periods by default.
    FrameRepeated,
    /// A frame to the drives is lost: both carry the last setpoint on; three periods by default.
    SetpointLost,
    /// Something holds Z's table with 20 kN.
    ZCaught,
    /// Something pushes Z down with 5 kN; 20 ms by default.
    ZPushed,
    /// Chips wedge the tap: it turns no further.
    TapJam,
    /// The tap breaks: it cuts nothing any more.
    TapBroken,
    /// The host's clock gives no number.
    ClockNan,
    /// The host's clock runs backwards.
    ClockFalls,
}

impl Fault {
    /// Every fault, in the order of documentation.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_axes = [Axis::Spindle, Axis::Z]
            .into_iter()
            .flat_map(|axis| AxisFault::ALL.into_iter().map(move |fault| Self::Axis(axis, fault)));
        of_axes.chain([
            Self::FrameInvalid,
            Self::FrameRepeated,
            Self::SetpointLost,
            Self::ZCaught,
            Self::ZPushed,
            Self::TapJam,
            Self::TapBroken,
            Self::ClockNan,
            Self::ClockFalls,
        ])
    }

    /// Whether it lies in the host's clock, which the machine does not feel: a host's loop asks
    /// [`Port::clock_s`](crate::control::port::Port::clock_s) for the time that it passes on.
    #[must_use]
    pub const fn is_of_the_clock(self) -> bool {
        matches!(self, Self::ClockNan | Self::ClockFalls)
    }

    /// How long it lasts by default, in interpolation periods; for good where none.
    const fn periods(self) -> Option<f64> {
        match self {
            Self::Axis(_, AxisFault::Invalid | AxisFault::Repeated | AxisFault::EffortNan | AxisFault::EffortHuge)
            | Self::FrameInvalid
            | Self::FrameRepeated
            | Self::SetpointLost => Some(3.0),
            Self::ZPushed => Some(20.0),
            _ => None,
        }
    }
}

impl fmt::Display for Fault {
    /// The name on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Axis(axis, fault) => {
                let axis = if *axis == Axis::Spindle { "spindle" } else { "z" };
                return write!(f, "{axis}-{}", fault.name());
            }
            Self::FrameInvalid => "frame-invalid",
            Self::FrameRepeated => "frame-repeated",
            Self::SetpointLost => "setpoint-lost",
            Self::ZCaught => "z-caught",
            Self::ZPushed => "z-pushed",
            Self::TapJam => "tap-jam",
            Self::TapBroken => "tap-broken",
            Self::ClockNan => "clock-nan",
            Self::ClockFalls => "clock-falls",
        };
        f.write_str(name)
    }
}

/// A fault with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Injection {
    /// What happens.
    pub fault: Fault,
    /// When, from the machine's start.
    pub at_s: f64,
    /// How long; by the fault's kind where none.
    pub duration_s: Option<f64>,
}

impl Injection {
    /// A fault at a time, as long as its kind lasts.
    #[must_use]
    pub const fn new(fault: Fault, at_s: f64) -> Self {
        Self { fault, at_s, duration_s: None }
    }

    /// Whether it is on at a time.
    pub(super) fn is_on(&self, time_s: f64, period_s: f64) -> bool {
        let duration_s = self.duration_s.or(self.fault.periods().map(|periods| periods * period_s));
        // A hair early, so that a time that is a whole number of periods meets its period.
        let since_s = time_s - self.at_s + 1e-6 * period_s;
        since_s >= 0.0 && duration_s.is_none_or(|duration_s| since_s < duration_s)
    }
}

impl FromStr for Injection {
    type Err = String;

    /// `NAME@SECONDS`, or `NAME@SECONDS+DURATION`.
    ///
    /// ```
    /// use rigidtap::sim::{Axis, AxisFault, Fault, Injection};
    /// let jump: Injection = "z-jump@2.5".parse().unwrap();
    /// assert_eq!(jump, Injection::new(Fault::Axis(Axis::Z, AxisFault::Jump), 2.5));
    /// let long: Injection = "frame-invalid@1+0.02".parse().unwrap();
    /// assert_eq!(long.duration_s, Some(0.02));
    /// assert!("z-jmp@1".parse::<Injection>().unwrap_err().contains("z-jump"));
    /// ```
    fn from_str(text: &str) -> Result<Self, String> {
        let shape = || "expected NAME@SECONDS or NAME@SECONDS+DURATION, such as z-jump@2.5".to_owned();
        let (name, times) = text.split_once('@').ok_or_else(shape)?;
        let fault = Fault::all().find(|fault| fault.to_string() == name).ok_or_else(|| {
            let names: Vec<_> = Fault::all().map(|fault| fault.to_string()).collect();
            format!("no fault is called {name}: expected one of {}", names.join(", "))
        })?;
        let seconds =
            |text: &str| text.parse::<f64>().ok().filter(|seconds| (0.0..=1e6).contains(seconds)).ok_or_else(shape);
        let (at_s, duration_s) = match times.split_once('+') {
            Some((at, duration)) => (seconds(at)?, Some(seconds(duration)?)),
            None => (seconds(times)?, None),
        };
        Ok(Self { fault, at_s, duration_s })
    }
}
