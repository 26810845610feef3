//! Keys of earlier versions, with what took their place.

use super::key::Key;
use super::list::find;

/// A key that an earlier version had.
#[derive(Debug)]
pub(in crate::config) struct Renamed {
    pub(in crate::config) old: &'static str,
    /// What to write instead; none where the control needs no such value any more.
    pub(in crate::config) new: Option<&'static str>,
}

const RENAMED: [Renamed; 3] = [
    Renamed { old: "sync.play_crossing_s", new: Some("sync.backlash_crossing_s") },
    Renamed { old: "sync.deviation_rad_per_s", new: Some("sync.observer_rad_per_s") },
    Renamed { old: "sync.deviation_lead_s", new: None },
];

/// The key of an earlier version at a path.
pub(in crate::config) fn renamed(path: &str) -> Option<&'static Renamed> {
    RENAMED.iter().find(|renamed| renamed.old == path)
}

impl Renamed {
    /// The key that took its place.
    pub(in crate::config) fn key(&self) -> Option<&'static Key> {
        self.new.and_then(find)
    }
}
