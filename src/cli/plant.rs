//! `--plant MODEL.fmu`: someone else's machine in place of ours.

use super::args::PlantArgs;
use super::outcome::{Stop, report};
use crate::study::Simulation;

/// Takes the FMU that the command line names as the plant.
#[cfg(all(feature = "fmi", unix))]
pub(super) fn take_other(simulation: &mut Simulation, args: &PlantArgs) -> Result<(), Stop> {
    use super::input;
    use crate::fmi::FmuSource;

    let Some(path) = &args.plant else { return Ok(()) };
    let name = input::name(path);
    if args.ideal {
        return Err(Stop::Usage("--ideal is of our own plant: an FMU is as it is".into()));
    }
    let program = std::env::current_exe().map_err(|error| Stop::Output { name: name.clone(), error })?;
    let source = FmuSource::open(path, (program, vec!["fmu-host".to_owned()])).map_err(|error| {
        report(&format!("error: {name}: {error}"));
        Stop::Reported
    })?;
    let period_s = simulation.machine.spec().control.period_s;
    if let Some(step_s) = source.fixed_step_s() {
        let steps = period_s / step_s;
        if steps < 0.5 || (steps - steps.round()).abs() > 1e-6 * steps {
            report(&format!(
                "error: {name}: its step is fixed at {step_s} s, expected a whole part of the period of {period_s} s \
                 (control.period_s in the machine file)"
            ));
            return Err(Stop::Reported);
        }
    }
    simulation.other_plant = Some(std::sync::Arc::new(source));
    Ok(())
}

/// Without the feature there is no such word.
#[cfg(not(all(feature = "fmi", unix)))]
pub(super) fn take_other(_simulation: &mut Simulation, _args: &PlantArgs) -> Result<(), Stop> {
    Ok(())
}

/// Refuses one where our own machine is asked for.
pub(super) fn refuse_other(args: &PlantArgs, command: &str) -> Result<(), Stop> {
    let name = name(args);
    if name.is_empty() {
        return Ok(());
    }
    Err(Stop::Usage(format!("--plant {name}: {command} is of our own plant; simulate, compare and sweep take others")))
}

/// Whether a plant that is not ours ran to its end: what it did wrong is no result.
pub(super) fn check_other(simulation: &Simulation, args: &PlantArgs) -> Result<(), Stop> {
    let Some(error) = simulation.other_plant.as_ref().and_then(|source| source.error()) else { return Ok(()) };
    report(&format!("error: {}: {error}", name(args)));
    Err(Stop::Reported)
}

#[cfg(all(feature = "fmi", unix))]
fn name(args: &PlantArgs) -> String {
    args.plant.as_deref().map_or_else(String::new, super::input::name)
}

#[cfg(not(all(feature = "fmi", unix)))]
fn name(_args: &PlantArgs) -> String {
    String::new()
}
