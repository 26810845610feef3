//! All machines of a sweep, run here or merged from parts.

use std::fs::File;
use std::sync::atomic::Ordering;

use super::refusal::refused;
use super::setup::Setup;
use super::words;
use crate::cli::answer::{answer, layout};
use crate::cli::args::{Common, Format, SweepArgs};
use crate::cli::interrupt::stop_on_ctrl_c;
use crate::cli::outcome::{Outcome, Stop, print, print_json, report};
use crate::cli::output::Output;
use crate::cli::{input, page, progress};
use crate::report::json::SweepAnswer;
use crate::report::page::{Page, sweep_charts};
use crate::report::table::Layout;
use crate::report::{plot, sweep_csv, table};
use crate::study::{self, PartFile, Sweep, SweepError};

/// Title of the picture.
const TITLE: &str = "The first hole's error over all machines";

/// Runs or merges, and reports.
pub(super) fn whole(common: &Common, args: &SweepArgs, setup: &Setup) -> Result<Outcome, Stop> {
    let Setup { program, file, base, settings, .. } = setup;
    // From here on Ctrl-C leaves no file behind, a temporary one neither.
    let stop = stop_on_ctrl_c();
    let open = |path: &Option<std::path::PathBuf>| path.as_deref().map(Output::open).transpose();
    let (mut csv, mut drawing, mut worst_file) = (open(&args.csv)?, open(&args.plot)?, open(&args.save_worst)?);
    let mut paper = open(&args.report)?;
    let found = if args.merge.is_empty() {
        let bar = progress::bar(common, settings.runs.get() as usize, "sweeping");
        let go_on = || {
            bar.inc(1);
            setup.goes_on(&stop)
        };
        let found = study::sweep(&setup.commands, base, settings, &go_on);
        bar.finish_and_clear();
        found
    } else {
        merged(common, args, setup)?.map(Some)
    };
    setup.check_other(args)?;
    let found = found.map_err(|error| refused(program, error))?;
    let Some(mut found) = found.filter(|_| !stop.load(Ordering::Relaxed)) else {
        report("interrupted: nothing was written");
        return Ok(Outcome::Interrupted);
    };

    let unreadable = |error| refused(program, SweepError::Io(error));
    if let Some(csv) = &mut csv {
        sweep_csv::sweep_csv(&mut found, &base.machine, csv.writer()).map_err(unreadable)?;
    }
    if let Some(drawing) = &mut drawing {
        let values = found.worst_um().map_err(unreadable)?;
        drawing.draw(plot::histogram_figure(
            TITLE,
            "peak-to-peak e(k), the worse of measured and true, µm",
            &values,
        ))?;
    }
    let counts = found.summary.counts;
    if let (Some(output), Some(worst)) = (&mut worst_file, found.worst()) {
        let what = format!(
            "The worst of {} machines, run {} of a sweep with seed {}: {} µm in its first hole.",
            counts.machines, worst.run, settings.seed, worst.first.worst_um
        );
        output.write(&words::machine_file(&what, (worst.actual, worst.seed), base, file, common, args))?;
    }
    let (law, sync) = (args.tap.law, base.settings.run.sync);
    let answered =
        |found: &Sweep| answer(common, Some(settings.seed), SweepAnswer::new(program, law, sync, settings, found));
    let told = |layout, found: &Sweep| table::swept_program(layout, program, law, sync, settings, found);
    if let Some(paper) = &mut paper {
        let verdict = if counts.failing > 0 {
            "fail"
        } else if counts.warning > 0 {
            "warning"
        } else {
            "ok"
        };
        let summary =
            format!("{program}: {} of {} machines fail, {} warn.", counts.failing, counts.machines, counts.warning);
        let heading = page::heading(common, "Many machines", Some(verdict), vec![summary], Some(settings.seed));
        let mut sheet = Page::new(&heading);
        let tolerance_um = base.machine.sync_tolerance_um(found.hole.pitch_mm);
        let (charts, tail) = sweep_charts(&mut found, tolerance_um).map_err(unreadable)?;
        sheet.figures(charts);
        sheet.heading("Which effect costs what: the worst hundredth against all");
        sheet.table(&tail);
        sheet.verbatim(&told(Layout::new(120, true), &found));
        page::write(paper, sheet, &answered(&found))?;
    }
    csv.into_iter().chain(drawing).chain(worst_file).chain(paper).try_for_each(Output::keep)?;
    if common.format == Format::Json {
        print_json(&answered(&found))?;
    } else {
        print(&told(layout(common), &found))?;
    }
    Ok(Outcome::Good)
}

/// The whole from its parts.
fn merged(common: &Common, args: &SweepArgs, setup: &Setup) -> Result<Result<Sweep, SweepError>, Stop> {
    let mut parts = Vec::new();
    let mut unread = false;
    for path in &args.merge {
        let name = input::name(path);
        match File::open(path) {
            Ok(file) => parts.push(PartFile::new(name, file)),
            Err(error) => {
                report(&format!("error: {name} cannot be read: {error}"));
                unread = true;
            }
        }
    }
    if unread {
        return Err(Stop::Reported);
    }
    let labels = setup.labels(common, args);
    Ok(study::merge(&setup.commands, &setup.base, &setup.settings, &labels, parts))
}
