//! Modal state: what stays in force from block to block.

use crate::control::cycle::Hand;
use crate::control::units::MM_PER_INCH;
use crate::gcode::dialect::Dialect;

/// Unit of lengths and feeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LengthUnit {
    Millimetre,
    Inch,
}

impl LengthUnit {
    pub(crate) const fn mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Inch => MM_PER_INCH,
        }
    }

    /// Least input increment, in mm: 1 µm or 0.0001 inch.
    pub(crate) const fn increment_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Inch => 1e-4 * MM_PER_INCH,
        }
    }
}

/// What F means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedMode {
    PerMinute,
    PerRevolution,
}

/// Where a cycle ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReturnTo {
    /// The initial level, or R if that is higher.
    Initial,
    R,
}

/// Tool length compensation, as far as the program says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ToolLength {
    /// Nothing was said: the work offset may hold it.
    Unsaid,
    On,
    /// It was on, and G49 ended it.
    Ended,
}

/// Which tool the spindle has, by its number: T selects it, M06 or the like puts it in. A control whose program never changes it
/// so takes it by T alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tool {
    selected: u32,
    in_spindle: u32,
    is_changed: bool,
}

impl Tool {
    pub(crate) fn select(&mut self, number: f64) {
        self.selected = number as u32;
    }

    pub(crate) fn change(&mut self) {
        (self.in_spindle, self.is_changed) = (self.selected, true);
    }

    /// 0 where nothing was said.
    pub(crate) const fn in_spindle(self) -> u32 {
        if self.is_changed { self.in_spindle } else { self.selected }
    }
}

/// In force until another block says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Modal {
    pub(crate) unit: LengthUnit,
    pub(crate) incremental: bool,
    pub(crate) feed_mode: FeedMode,
    pub(crate) return_to: ReturnTo,
    /// mm/min or mm/rev, by the feed mode.
    pub(crate) feed_mm: Option<f64>,
    pub(crate) speed_rpm: Option<f64>,
    /// M03, M04; none after M05.
    pub(crate) hand: Option<Hand>,
    /// SPOS: the angle at which the spindle rests, until a code turns it.
    pub(crate) spindle_angle_deg: Option<f64>,
    /// M29: the tapping cycle is rigid, until G80, G0 or G1.
    pub(crate) rigid: bool,
    /// G54 is 1.
    pub(crate) work_offset: u8,
    pub(crate) tool_length: ToolLength,
    pub(crate) tool: Tool,
    /// G16: the radius in mm and the angle in degrees that were last said.
    pub(crate) polar: Option<[Option<f64>; 2]>,
}

impl Modal {
    /// At power on: the dialect's unit, G90, G94, G98 or G99 as the dialect says, spindle at rest.
    pub(crate) const fn at_start(dialect: &Dialect) -> Self {
        Self {
            unit: if dialect.power_on_inch { LengthUnit::Inch } else { LengthUnit::Millimetre },
            incremental: false,
            feed_mode: FeedMode::PerMinute,
            return_to: if dialect.cycle.starts_at_r { ReturnTo::R } else { ReturnTo::Initial },
            feed_mm: None,
            speed_rpm: None,
            hand: None,
            spindle_angle_deg: None,
            rigid: false,
            work_offset: 1,
            tool_length: ToolLength::Unsaid,
            tool: Tool { selected: 0, in_spindle: 0, is_changed: false },
            polar: None,
        }
    }

    /// The speed, if it is above zero.
    pub(crate) fn turning_rpm(&self) -> Option<f64> {
        self.speed_rpm.filter(|&rpm| rpm > 0.0)
    }
}
