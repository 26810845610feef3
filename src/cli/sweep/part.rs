//! `rigidtap sweep --shard K/N --out PART`.

use std::path::Path;
use std::sync::atomic::Ordering;

use super::refusal::refused;
use super::setup::Setup;
use crate::cli::answer::answer;
use crate::cli::args::{Common, Format, SweepArgs};
use crate::cli::interrupt::stop_on_ctrl_c;
use crate::cli::outcome::{Outcome, Stop, print, print_json, report};
use crate::cli::output::Output;
use crate::cli::{input, progress};
use crate::report::json::SweepPartAnswer;
use crate::report::table;
use crate::study::{self, Shard};

/// Runs one part and writes its file.
pub(super) fn part(
    common: &Common,
    args: &SweepArgs,
    setup: &Setup,
    shard: Shard,
    path: &Path,
) -> Result<Outcome, Stop> {
    let Setup { program, commands, base, settings, .. } = setup;
    if shard.of() > settings.runs.get() {
        let message = format!("--shard {shard}: there are more parts than machines, which are {}", settings.runs);
        return Err(Stop::Usage(message));
    }
    let stop = stop_on_ctrl_c();
    let mut output = Output::open(path)?;
    let bar = progress::bar(common, shard.runs(settings.runs).count(), "sweeping");
    let go_on = || {
        bar.inc(1);
        setup.goes_on(&stop)
    };
    let folder = path.parent().filter(|folder| folder.is_dir()).unwrap_or(Path::new("."));
    let labels = setup.labels(common, args);
    let found = study::sweep_part(commands, base, settings, &labels, shard, folder, &go_on, output.writer());
    bar.finish_and_clear();
    setup.check_other(args)?;
    let counts = found.map_err(|error| refused(program, error))?;
    let Some(counts) = counts.filter(|_| !stop.load(Ordering::Relaxed)) else {
        report("interrupted: nothing was written");
        return Ok(Outcome::Interrupted);
    };
    output.keep()?;
    let name = input::name(path);
    if common.format == Format::Json {
        print_json(&answer(
            common,
            Some(settings.seed),
            SweepPartAnswer::new(program, settings, shard, &counts, &name),
        ))?;
    } else {
        print(&table::swept_part(program, settings, shard, &counts, &name))?;
    }
    Ok(Outcome::Good)
}
