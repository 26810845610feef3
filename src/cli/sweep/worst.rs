//! `rigidtap sweep --worst`.

use std::sync::atomic::Ordering;

use super::refusal::refused;
use super::setup::Setup;
use super::words;
use crate::cli::answer::{answer, layout};
use crate::cli::args::{Common, Format, SweepArgs};
use crate::cli::interrupt::stop_on_ctrl_c;
use crate::cli::outcome::{Outcome, Stop, print, print_json, report};
use crate::cli::output::Output;
use crate::cli::progress;
use crate::report::json::SweepWorstAnswer;
use crate::report::table;
use crate::study;

/// Searches, saves and reports the worst machine.
pub(super) fn worst(common: &Common, args: &SweepArgs, setup: &Setup) -> Result<Outcome, Stop> {
    let Setup { program, commands, file, base, settings } = setup;
    let stop = stop_on_ctrl_c();
    let mut output = args.save_worst.as_deref().map(Output::open).transpose()?;
    let bar = progress::bar(common, settings.runs.get() as usize, "searching");
    let go_on = || {
        bar.inc(1);
        setup.goes_on(&stop)
    };
    let found = study::worst_machine(commands, base, settings, &go_on);
    bar.finish_and_clear();
    setup.check_other(args)?;
    let found = found.map_err(|error| refused(program, error))?;
    if stop.load(Ordering::Relaxed) {
        report("interrupted: nothing was written");
        return Ok(Outcome::Interrupted);
    }
    let Some(found) = found else {
        report(&format!(
            "error: {program}: on no machine of the spread does the hole begin: see sweep without --worst"
        ));
        return Err(Stop::Reported);
    };
    if let Some(output) = &mut output {
        let machine = &found.machine;
        let what = format!(
            "The worst of {} machines that --worst ran with seed {}: {} µm in its first hole.",
            found.runs, settings.seed, machine.first.worst_um
        );
        output.write(&words::machine_file(&what, (machine.actual, machine.seed), base, file, common, args))?;
    }
    output.into_iter().try_for_each(Output::keep)?;
    let (law, sync) = (args.tap.law, base.settings.run.sync);
    if common.format == Format::Json {
        let found = SweepWorstAnswer::new(program, law, sync, settings, &found);
        print_json(&answer(common, Some(settings.seed), found))?;
    } else {
        print(&table::worst_machine(layout(common), program, law, sync, settings, &found))?;
    }
    Ok(Outcome::Good)
}
