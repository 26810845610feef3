//! What an FMU of ours carries beside its library.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::config::MachineFile;
use crate::control::machine::Law;
use crate::control::sync::{Compensation, Mode, Settings};
use crate::gcode::program::Overrides;
use crate::gcode::{Command, Dialect, Options, interpret};
use crate::run::{ProgramSettings, RunSettings};
use crate::sim::{Effect, Effects};

pub(super) const MACHINE: &str = "machine.toml";
pub(super) const SETTINGS: &str = "settings.json";
pub(super) const PROGRAM: &str = "program.ngc";

/// What an FMU of ours carries: the machine file as text, and what else it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Machine file.
    pub machine: String,
    /// Effects that the plant has.
    pub effects: Effects,
    /// What the control runs; none in the plant.
    pub program: Option<StoredProgram>,
}

/// A program, and how it is run.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredProgram {
    /// G-code, all in one file.
    pub text: Vec<u8>,
    /// Name of its dialect.
    pub dialect: String,
    /// Blocks that begin with / are left out.
    pub block_delete: bool,
    /// Law, synchronisation, overrides.
    pub settings: ProgramSettings,
}

/// The settings' file.
#[derive(Deserialize, Serialize)]
struct Text {
    lacking: Vec<String>,
    program: Option<ProgramText>,
}

#[derive(Deserialize, Serialize)]
struct ProgramText {
    dialect: String,
    block_delete: bool,
    law: String,
    sync: String,
    compensation: String,
    identify: bool,
    learn: bool,
    supervise: bool,
    dry_cycle: bool,
    rapid: f64,
    feed: f64,
}

impl Stored {
    /// The settings as text.
    pub(super) fn settings(&self) -> String {
        let program = self.program.as_ref().map(|program| {
            let ProgramSettings { law, overrides, run } = program.settings;
            ProgramText {
                dialect: program.dialect.clone(),
                block_delete: program.block_delete,
                law: law.name().to_owned(),
                sync: run.sync.mode.name().to_owned(),
                compensation: run.sync.compensation.name().to_owned(),
                identify: run.sync.identify,
                learn: run.sync.learn,
                supervise: run.sync.supervise,
                dry_cycle: run.dry_cycle,
                rapid: overrides.rapid,
                feed: overrides.feed,
            }
        });
        let lacking = self.effects.off().map(|effect| effect.name().to_owned()).collect();
        serde_json::to_string_pretty(&Text { lacking, program }).unwrap_or_default()
    }

    /// From the folder that an FMU's resources were unpacked into.
    pub(super) fn read(folder: &Path) -> Result<Self, String> {
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
        };
        let text: Text = serde_json::from_slice(&read(SETTINGS)?).map_err(|error| format!("{SETTINGS}: {error}"))?;
        let lacks = |effect: &Effect| text.lacking.iter().any(|name| name == effect.name());
        let effects = Effect::ALL.into_iter().filter(lacks).fold(Effects::FULL, Effects::without);
        let program = text.program.map(|found| {
            let unknown = |what: &str| format!("{SETTINGS}: unknown {what}");
            let sync = Settings {
                mode: Mode::ALL.into_iter().find(|mode| mode.name() == found.sync).ok_or_else(|| unknown("sync"))?,
                compensation: Compensation::ALL
                    .into_iter()
                    .find(|compensation| compensation.name() == found.compensation)
                    .ok_or_else(|| unknown("compensation"))?,
                identify: found.identify,
                learn: found.learn,
                supervise: found.supervise,
            };
            let law = Law::ALL.into_iter().find(|law| law.name() == found.law).ok_or_else(|| unknown("law"))?;
            let run = RunSettings { sync, dry_cycle: found.dry_cycle, ..RunSettings::default() };
            let overrides = Overrides { rapid: found.rapid, feed: found.feed };
            Ok::<_, String>(StoredProgram {
                text: read(PROGRAM)?,
                dialect: found.dialect,
                block_delete: found.block_delete,
                settings: ProgramSettings { law, overrides, run },
            })
        });
        let machine = String::from_utf8(read(MACHINE)?).map_err(|error| format!("{MACHINE}: {error}"))?;
        Ok(Self { machine, effects, program: program.transpose()? })
    }

    /// The machine file, checked.
    pub(super) fn machine_file(&self) -> Result<MachineFile, String> {
        let read = MachineFile::read(self.machine.as_bytes());
        read.map_err(|faults| format!("{MACHINE} has {} faults", faults.len()))
    }
}

impl StoredProgram {
    /// Its commands.
    pub(super) fn commands(&self, file: &MachineFile) -> Result<Vec<Command>, String> {
        let dialect = Dialect::by_name(&self.dialect).ok_or_else(|| format!("dialect {} is unknown", self.dialect))?;
        let options = Options { block_delete: self.block_delete, ..Options::default() };
        let found = interpret(&self.text, &file.gcode.apply(dialect), options);
        if found.diagnostics.has_errors() {
            return Err("the program has errors: a program of an FMU is one file, without subprograms in others".into());
        }
        Ok(found.commands)
    }
}
