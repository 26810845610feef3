//! `rigidtap fmu`: our machine and our synchronizer as FMUs.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

use super::args::{Common, FmuCommand, FmuControlArgs, FmuPlantArgs, PlantArgs, TapArgs};
use super::input;
use super::outcome::{Outcome, Stop, print, report};
use super::output::{self, Output};
use super::plant::refuse_other;
use super::simulate::simulation;
use crate::config::MachineFile;
use crate::fmi::{PackError, Stored, StoredProgram, pack};
use crate::gcode::AUTO;
use crate::study::Simulation;

/// Makes an FMU.
pub(super) fn fmu(common: &Common, command: &FmuCommand) -> Result<Outcome, Stop> {
    match command {
        FmuCommand::Plant(FmuPlantArgs { out, library, tap, plant }) => {
            output::check_paths(common, &[], &[Some(out)])?;
            let (file, simulation) = machine(common, tap, plant)?;
            write(&file, &simulation, None, out, library.as_ref())
        }
        FmuCommand::Control(FmuControlArgs { file: path, out, library, tap, plant }) => {
            output::check_paths(common, std::slice::from_ref(path), &[Some(out)])?;
            let (file, simulation) = machine(common, tap, plant)?;
            let reading = input::dialect(common, &file)?;
            let overrides = simulation.settings.overrides;
            let paths = std::slice::from_ref(path);
            // Its faults are told as `simulate` does.
            input::programs(common, paths, &reading, &simulation.machine, &[tap.law], overrides)?;
            let dialect = common.dialect.clone().unwrap_or_else(|| file.gcode.dialect.clone());
            if dialect == AUTO {
                return Err(Stop::Usage("fmu control needs the dialect by its name: auto is for people".into()));
            }
            let text = std::fs::read(path).map_err(|error| Stop::Output { name: input::name(path), error })?;
            let settings = simulation.settings;
            let program = StoredProgram { text, dialect, block_delete: common.block_delete, settings };
            write(&file, &simulation, Some(program), out, library.as_ref())
        }
    }
}

fn machine(common: &Common, tap: &TapArgs, plant: &PlantArgs) -> Result<(MachineFile, Simulation), Stop> {
    refuse_other(plant, "fmu")?;
    let file = input::machine_file(common, &[tap.law])?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, tap.share)?;
    let simulation = simulation(machine, file.actual, plant, tap);
    Ok((file, simulation))
}

fn write(
    file: &MachineFile,
    simulation: &Simulation,
    program: Option<StoredProgram>,
    out: &std::path::Path,
    library: Option<&PathBuf>,
) -> Result<Outcome, Stop> {
    let path = library.cloned().or_else(beside).ok_or_else(|| {
        Stop::Usage(
            "the FMU's shared library is not beside rigidtap: build it by \
             `cargo rustc --release --lib --features fmi --crate-type cdylib`, or name it by --library"
                .into(),
        )
    })?;
    let opened = File::open(&path).map_err(|error| Stop::Output { name: input::name(&path), error })?;
    let machine = MachineFile { machine: simulation.machine.clone(), warnings: Vec::new(), ..file.clone() };
    let stored = Stored { machine: machine.to_toml(), effects: simulation.effects, program };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let name = input::name(out);
    match pack(&stored, &mut BufReader::new(opened), &mut bytes) {
        Ok(()) => {}
        Err(PackError::Io(error)) => return Err(Stop::Output { name, error }),
        Err(error) => {
            report(&format!("error: {name}: {error}"));
            return Err(Stop::Reported);
        }
    }
    let mut output = Output::open(out)?;
    output.write_bytes(bytes.get_ref())?;
    output.keep()?;
    print(&format!("{name}: FMI 2.0 for co-simulation, step {} s\n", simulation.machine.spec().control.period_s))?;
    Ok(Outcome::Good)
}

/// The shared library beside the program.
fn beside() -> Option<PathBuf> {
    let name = format!("{}rigidtap{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let path = std::env::current_exe().ok()?.with_file_name(name);
    path.is_file().then_some(path)
}
