//! `rigidtap monitor`.

use std::path::Path;

use crate::control::machine::Machine;
use crate::link::map::Map;
use crate::link::receiver::Fastest;
use crate::link::recording::{Context, Recording};
use crate::link::sample::Scale;
use crate::report::monitor::{Source, json, table};
use crate::report::plot::{ErrorPanel, error_figure};
use crate::run::Verdict;
use crate::run::analysis::{
    Analysis, AnalysisObserver, AnalysisSettings, Judgement, MeasuredHole, MeasuredRow, pitch_of,
};
use crate::run::measured_trace::MeasuredTrace;
use crate::study::{ErrorPoint, ErrorSeries};

use super::args::{Common, Format, MonitorArgs};
use super::outcome::{Outcome, Stop, print, print_json, tell};
use super::output::{self, Output};
use super::simulate::ERROR_TITLE;
use super::{board, input, live};

/// Judges a recording or a live machine, or plays the board.
pub(super) fn monitor(common: &Common, args: &MonitorArgs) -> Result<Outcome, Stop> {
    output::check_paths(common, args.file.as_slice(), &[args.plot.as_ref(), args.trace.as_ref()])?;
    let file = input::machine_file(common)?;
    if let Some(program) = &args.simulate_board {
        return board::run(common, &file, program, args.rate);
    }
    let machine = &file.machine;
    match (&args.file, &args.serial) {
        (Some(path), _) => recorded(common, args, machine, path),
        (None, Some(port)) => live::live(common, args, machine, port),
        // The command line's own rules leave no third way.
        (None, None) => Err(Stop::Usage("a recording or --serial is needed".into())),
    }
}

fn recorded(common: &Common, args: &MonitorArgs, machine: &Machine, path: &Path) -> Result<Outcome, Stop> {
    let map = args.map.as_deref().map(str::parse::<Map>).transpose();
    let map = map.map_err(|error| Stop::Usage(format!("--map: {error}")))?;
    let name = input::name(path);
    let context =
        Context { scale: Scale::of(machine), period_s: machine.spec().control.period_s, fastest: Fastest::of(machine) };
    let recording = Recording::read(&input::read(path)?, map.as_ref(), &context).map_err(|error| {
        tell(&format!("error: {name}:{}:{}: {}", error.line, error.column, error.kind));
        Stop::Told
    })?;
    let pitch_mm = match args.pitch.or_else(|| pitch_of(&recording.samples, &recording.scale)) {
        Some(pitch_mm) => pitch_mm,
        None => {
            tell(&format!("error: {name}:1:1: no movement in a coarse thread's pitch here: expected one, or --pitch"));
            return Err(Stop::Told);
        }
    };
    let settings =
        AnalysisSettings { scale: recording.scale, pitch_mm, tolerance_um: machine.sync_tolerance_um(pitch_mm) };
    let mut analysis = Analysis::new(settings);
    let mut keeper = Keeper::new(args, &settings)?;
    for sample in &recording.samples {
        analysis.push(*sample, &mut keeper);
    }
    analysis.finish(&mut keeper);
    keeper.report(common, args, &name, pitch_mm, Source::Recording(&recording))
}

/// Keeps what the report needs, and writes the trace.
pub(super) struct Keeper {
    pub(super) holes: Vec<MeasuredHole>,
    trace: Option<MeasuredTrace>,
    series: Option<ErrorSeries>,
    drawing: Option<Output>,
}

impl AnalysisObserver for Keeper {
    fn row(&mut self, row: &MeasuredRow) {
        if let Some(trace) = &mut self.trace {
            trace.push(row);
        }
        if let (Some(series), Some(kind), Some(error_um)) = (&mut self.series, row.kind, row.error_um) {
            series.points.push(ErrorPoint { k: row.sample.k, hole: row.hole, kind, error_um });
        }
    }

    fn hole(&mut self, hole: &MeasuredHole) {
        self.holes.push(hole.clone());
    }
}

impl Keeper {
    pub(super) fn new(args: &MonitorArgs, settings: &AnalysisSettings) -> Result<Self, Stop> {
        let open = |path: &std::path::PathBuf| {
            MeasuredTrace::create(path, settings.pitch_mm, settings.scale)
                .map_err(|error| Stop::Output { name: path.display().to_string(), error })
        };
        Ok(Self {
            holes: Vec::new(),
            trace: args.trace.as_ref().map(open).transpose()?,
            series: args.plot.is_some().then(ErrorSeries::default),
            drawing: args.plot.as_deref().map(Output::open).transpose()?,
        })
    }

    /// Writes all that was asked for.
    pub(super) fn report(
        self,
        common: &Common,
        args: &MonitorArgs,
        name: &str,
        pitch_mm: f64,
        source: Source<'_>,
    ) -> Result<Outcome, Stop> {
        let Self { holes, trace, series, mut drawing } = self;
        let trace = match (trace, &args.trace) {
            (Some(trace), Some(path)) => Some(Output::of(path, trace.finish())?),
            _ => None,
        };
        if let (Some(series), Some(drawing)) = (series, &mut drawing) {
            let verdict = |hole: &MeasuredHole| match hole.judgement() {
                Judgement::Judged(verdict) => verdict,
                Judgement::Gap | Judgement::NoTolerance => Verdict::Warning,
            };
            let unknown = holes.iter().filter(|hole| hole.judgement() == Judgement::Gap).count();
            let panel = ErrorPanel {
                // A picture's badge knows three verdicts only.
                title: match (holes.len(), unknown) {
                    (0, _) => format!("{name}: no hole found"),
                    (_, 0) => name.to_owned(),
                    (all, _) => format!("{name}: readings missing in {unknown} of {all} holes, which do not pass"),
                },
                tolerance_um: holes.first().and_then(|hole| hole.tolerance_um).unwrap_or(0.0),
                peak_to_peak_um: holes.iter().map(|hole| hole.error_um.peak_to_peak()).fold(0.0, f64::max),
                verdict: holes.iter().map(verdict).max().unwrap_or(Verdict::Warning),
                points: series.points,
            };
            drawing.draw(error_figure(ERROR_TITLE, &[panel]))?;
        }
        drawing.into_iter().chain(trace).try_for_each(Output::keep)?;
        if common.format == Format::Json {
            print_json(&json(name, pitch_mm, source, &holes))?;
        } else {
            print(&table(name, source, &holes))?;
        }
        Ok(Outcome::Good)
    }
}
