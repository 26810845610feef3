//! `[sync]`

use super::Key;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("sync.play_crossing_s", "s", "time over which Z's motor crosses its play where the screw's force turns round",
        "0.4 periods of z.resonance_hz; 4 periods of control.period_s at least and in such steps, 64 at most", |d| &mut d.spec.sync.play_crossing_s),
    Key::number("sync.deviation_rad_per_s", "rad/s", "poles of the filter on the spindle's deviation from its plan",
        "half of 1/control.period_s", |d| &mut d.spec.sync.deviation_rad_per_s),
    Key::number("sync.deviation_lead_s", "s", "lead of its prediction over the drives' own delays",
        "those are all there is", |d| &mut d.spec.sync.deviation_lead_s),
    Key::number("sync.dead_zone_um", "µm", "Z leaves smaller deviations alone: they are mostly noise",
        "4 times what drive.encoder_jitter_s is at spindle.max_rpm and a pitch of 1 mm",
        |d| &mut d.spec.sync.dead_zone_um),
    Key::number("sync.governor_per_s", "1/s", "fastest that a weak motor slows the path, shares of its pace per second",
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
        "2.5 times sync.play_crossing_s", |d| &mut d.spec.sync.learning_taper_s),
];
