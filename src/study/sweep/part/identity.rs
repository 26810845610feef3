//! What parts must have in common to be parts of one sweep.

use crc::{CRC_64_XZ, Crc};
use serde::{Deserialize, Serialize};

use crate::gcode::Command;
use crate::study::simulation::Simulation;
use crate::study::sweep::settings::SweepSettings;

/// The checksum of parts and of what they are compared by.
pub(super) static CRC: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

/// How a part's sweep is named to people, and which build of the program ran it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PartLabels {
    /// Tells builds of the program apart, since two of them may round differently.
    pub build: String,
    /// Name of the program swept.
    pub program: String,
    /// Name of the machine file.
    pub machine: String,
    /// The sweep's own words on the command line.
    pub options: String,
}

/// What parts of one sweep have in common. Checksums are of the data themselves, so that a name, a comment or the order
/// of words is of no matter.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub(super) struct Identity {
    pub(super) rigidtap: String,
    pub(super) build: String,
    pub(super) program: String,
    pub(super) program_crc64: String,
    pub(super) machine: String,
    pub(super) machine_crc64: String,
    pub(super) options: String,
    pub(super) options_crc64: String,
    pub(super) seed: u64,
    pub(super) runs: u32,
    pub(super) holes: u32,
}

impl Identity {
    pub(super) fn new(labels: &PartLabels, commands: &[Command], base: &Simulation, settings: &SweepSettings) -> Self {
        // Debug writes every field, and each number with the digits that tell it from its neighbours.
        let crc = |text: String| format!("{:016x}", CRC.checksum(text.as_bytes()));
        let kinds: Vec<_> = commands.iter().map(|command| command.kind).collect();
        let Simulation { machine, actual, effects, faults, settings: run, .. } = base;
        let PartLabels { build, program, machine: machine_name, options } = labels.clone();
        Self {
            rigidtap: env!("CARGO_PKG_VERSION").to_owned(),
            build,
            program,
            program_crc64: crc(format!("{kinds:?}")),
            machine: machine_name,
            machine_crc64: crc(format!("{:?} {actual:?} {:?} {:?}", machine.spec(), settings.spread, settings.hard)),
            options,
            options_crc64: crc(format!("{effects:?} {faults:?} {run:?}")),
            seed: settings.seed,
            runs: settings.runs.get(),
            holes: settings.holes.get(),
        }
    }

    /// The first thing in which another one differs: what it is, as found and as expected.
    pub(super) fn difference(&self, found: &Self) -> Option<(&'static str, String, String)> {
        let named = |name: &str, crc: &str| format!("{name} ({crc})");
        let pair = |found: &dyn ToString, expected: &dyn ToString| (found.to_string(), expected.to_string());
        let different =
            |what, same: bool, (found, expected): (String, String)| (!same).then_some((what, found, expected));
        let words = |identity: &Self| format!("`{}`", identity.options.trim());
        different("version of rigidtap", self.rigidtap == found.rigidtap, pair(&found.rigidtap, &self.rigidtap))
            .or_else(|| different("build of rigidtap", self.build == found.build, pair(&found.build, &self.build)))
            .or_else(|| {
                different("number of machines (--runs)", self.runs == found.runs, pair(&found.runs, &self.runs))
            })
            .or_else(|| different("seed (--seed)", self.seed == found.seed, pair(&found.seed, &self.seed)))
            .or_else(|| {
                different("number of holes (--holes)", self.holes == found.holes, pair(&found.holes, &self.holes))
            })
            .or_else(|| {
                let same = self.program_crc64 == found.program_crc64;
                let [found, expected] = [found, self].map(|identity| named(&identity.program, &identity.program_crc64));
                different("program", same, (found, expected))
            })
            .or_else(|| different("options", self.options == found.options, (words(found), words(self))))
            .or_else(|| {
                let same = self.machine_crc64 == found.machine_crc64;
                let [found, expected] = [found, self].map(|identity| named(&identity.machine, &identity.machine_crc64));
                different("machine", same, (found, expected))
            })
            .or_else(|| {
                let same = self.options_crc64 == found.options_crc64;
                different("settings", same, pair(&found.options_crc64, &self.options_crc64))
            })
    }
}
