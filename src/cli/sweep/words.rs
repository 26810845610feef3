//! A sweep's words: those that repeat it, and its worst machine's file.

use crc::{CRC_64_XZ, Crc};

use crate::cli::args::{Common, Identify, PlantArgs, Supervision, SweepArgs};
#[cfg(all(feature = "fmi", unix))]
use crate::cli::input;
use crate::config::MachineFile;
use crate::sim::Actual;
use crate::study::Simulation;

/// The nominal machine as it was run, with what makes it the worst one, and how to see it again.
pub(super) fn machine_file(
    found: &str,
    (actual, seed): (Actual, u64),
    base: &Simulation,
    file: &MachineFile,
    common: &Common,
    args: &SweepArgs,
) -> String {
    let file = MachineFile { machine: base.machine.clone(), actual, warnings: Vec::new(), ..file.clone() };
    format!(
        "# {found} Again:\n\
         # rigidtap simulate PROGRAM --machine THIS_FILE --seed {seed}{flags}\n#\n{toml}",
        flags = flags(common, args),
        toml = file.to_toml(),
    )
}

/// All of a sweep's own words that its results depend on, but for those that parts are compared by one by one.
pub(super) fn options(common: &Common, args: &SweepArgs) -> String {
    let mut words = flags(common, args);
    #[cfg(all(feature = "fmi", unix))]
    if let Some(path) = &args.plant.plant {
        let bytes = std::fs::read(path).unwrap_or_default();
        words += &format!(" --plant {} ({})", input::name(path), checksum(&bytes));
    }
    if let Some(tap) = &args.plant.tap {
        words += &format!(" --tap {tap}");
    }
    if let Some(material) = args.plant.material {
        words += &format!(" --material {}", material.name());
    }
    if let Some(share) = args.tap.share {
        words += &format!(" --share {share}");
    }
    for (word, on) in [("--nominal", args.nominal), ("--hard", args.hard)] {
        if on {
            words += &format!(" {word}");
        }
    }
    words
}

/// The sweep's own words that no machine file holds.
fn flags(common: &Common, args: &SweepArgs) -> String {
    let SweepArgs { plant: PlantArgs { ideal, adapting, overrides, .. }, tap, .. } = args;
    let mut words =
        format!(" --law {} --sync {} --compensation {}", tap.law.name(), tap.sync.name(), tap.compensation.name());
    if let Some(dialect) = &common.dialect {
        words += &format!(" --dialect {dialect}");
    }
    if common.block_delete {
        words += " --block-delete";
    }
    match adapting.identify {
        Identify::None => words += " --identify=none",
        Identify::Approach => {}
        Identify::DryCycle => words += " --identify",
    }
    if adapting.learn {
        words += " --learn";
    }
    if adapting.supervision == Supervision::Off {
        words += " --supervision off";
    }
    if *ideal {
        words += " --ideal";
    }
    if !tap.without.is_empty() {
        let names: Vec<_> = tap.without.iter().map(|effect| effect.name()).collect();
        words += &format!(" --without {}", names.join(","));
    }
    for (name, percent) in [("rapid", overrides.rapid_override), ("feed", overrides.feed_override)] {
        if percent != 100.0 {
            words += &format!(" --{name}-override {percent}");
        }
    }
    words
}

/// Tells files apart.
pub(super) fn checksum(bytes: &[u8]) -> String {
    format!("{:016x}", Crc::<u64>::new(&CRC_64_XZ).checksum(bytes))
}
