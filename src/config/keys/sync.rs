//! `[sync]`

use super::key::Key;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("sync.backlash_crossing_s", "s", "time over which Z's motor crosses its backlash where the screw's force turns round",
        "0.4 periods of z.resonance_hz; 4 periods of control.period_s at least and in such steps, 64 at most", |d| &mut d.spec.sync.backlash_crossing_s),
    Key::number("sync.observer_rad_per_s", "rad/s", "poles of the observer of the spindle's tracking error",
        "half of 1/control.period_s", |d| &mut d.spec.sync.observer_rad_per_s),
    Key::number("sync.dead_zone_um", "µm", "Z does not follow smaller tracking errors of the spindle: they are mostly noise",
        "4 times what drive.encoder_jitter_s is at spindle.max_rpm and a pitch of 1 mm",
        |d| &mut d.spec.sync.dead_zone_um),
    Key::number("sync.governor_per_s", "1/s", "greatest fall of the path rate per second, where the motor is weak",
        "slowing takes a few percent of the motor itself", |d| &mut d.spec.sync.governor_per_s),
    Key::number("sync.learning_gain", "", "share of a hole's error that the next one's correction takes up",
        "holes differ by noise; what is common adds up", |d| &mut d.spec.sync.learning_gain),
    Key::number("sync.learning_forgetting", "", "share of a correction that stays from hole to hole",
        "halves in some 140 holes", |d| &mut d.spec.sync.learning_forgetting),
    Key::number("sync.learning_smoothing_s", "s", "half-width of the smoothing along the path",
        "2 periods: what is narrower the drive cannot follow", |d| &mut d.spec.sync.learning_smoothing_s),
    Key::number("sync.learning_lead_s", "s", "by how much a correction comes before the error that it is for",
        "drive.latency_periods, and the time constant of Z's velocity loop", |d| &mut d.spec.sync.learning_lead_s),
    Key::number("sync.learning_taper_s", "s", "time from rest over which corrections grow at the start of a hole",
        "2.5 times sync.backlash_crossing_s", |d| &mut d.spec.sync.learning_taper_s),
];
