//! What `rigidtap monitor` records of holes, live or not, and the report that it makes of it.

use crate::report::json::MonitorAnswer;
use crate::report::monitor::{Source, source_words, table};
use crate::report::page::{MeasuredRecorder, Page, table_of_measured};
use crate::report::plot::{ErrorPanel, error_figure};
use crate::run::Verdict;
use crate::run::analysis::{AnalysisListener, AnalysisSettings, Judgement, MeasuredHole, MeasuredRow};
use crate::run::measured_trace::MeasuredTrace;
use crate::study::{ErrorPoint, ErrorSeries};

use super::answer::{answer, layout};
use super::args::{Common, Format, MonitorArgs};
use super::outcome::{Outcome, Stop, print, print_json};
use super::output::Output;
use super::page;
use super::simulate::ERROR_TITLE;

/// Records what the report needs, and writes the trace.
pub(super) struct Recorder {
    pub(super) holes: Vec<MeasuredHole>,
    trace: Option<MeasuredTrace>,
    series: Option<ErrorSeries>,
    drawing: Option<Output>,
    curves: Option<MeasuredRecorder>,
    paper: Option<Output>,
}

impl AnalysisListener for Recorder {
    fn row(&mut self, row: &MeasuredRow) {
        if let Some(trace) = &mut self.trace {
            trace.push(row);
        }
        if let (Some(series), Some(kind), Some(error_um)) = (&mut self.series, row.kind, row.error_um) {
            series.points.push(ErrorPoint { k: row.sample.k, hole: row.hole, kind, error_um });
        }
        if let Some(curves) = &mut self.curves {
            curves.row(row);
        }
    }

    fn hole(&mut self, hole: &MeasuredHole) {
        self.holes.push(hole.clone());
        if let Some(curves) = &mut self.curves {
            curves.hole(hole);
        }
    }
}

/// A picture's badge knows three verdicts only: what cannot pass for want of readings is a warning.
fn verdict(hole: &MeasuredHole) -> Verdict {
    match hole.judgement() {
        Judgement::Judged(verdict) => verdict,
        Judgement::Corrupt => Verdict::Fail,
        Judgement::Gap | Judgement::NoTolerance => Verdict::Warning,
    }
}

impl Recorder {
    pub(super) fn new(args: &MonitorArgs, settings: &AnalysisSettings) -> Result<Self, Stop> {
        let open = |path: &std::path::PathBuf| {
            MeasuredTrace::create(path, settings.pitch_mm, settings.scale)
                .map_err(|error| Stop::Output { name: super::input::name(path), error })
        };
        Ok(Self {
            holes: Vec::new(),
            trace: args.trace.as_ref().map(open).transpose()?,
            series: args.plot.is_some().then(ErrorSeries::default),
            drawing: args.plot.as_deref().map(Output::open).transpose()?,
            curves: args.report.is_some().then(|| MeasuredRecorder::new(settings.scale)),
            paper: args.report.as_deref().map(Output::open).transpose()?,
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
        let Self { mut holes, trace, series, mut drawing, curves, mut paper } = self;
        let corrupt = match source {
            Source::Recording(recording) => recording.corrupt,
            Source::Line(_) => 0,
        };
        // What is around a corrupt reading is not to be trusted further than that it may fail.
        holes.iter_mut().for_each(|hole| hole.corrupt = corrupt > 0);
        let trace = match (trace, &args.trace) {
            (Some(trace), Some(path)) => Some(Output::of(path, trace.finish())?),
            _ => None,
        };
        let verdict = holes.iter().map(verdict).max();
        if let (Some(series), Some(drawing)) = (series, &mut drawing) {
            let count = |what| holes.iter().filter(|hole| hole.judgement() == what).count();
            let (unknown, corrupt) = (count(Judgement::Gap), count(Judgement::Corrupt));
            let panel = ErrorPanel {
                title: match (holes.len(), unknown, corrupt) {
                    (0, _, _) => format!("{name}: no hole found"),
                    (_, 0, 0) => name.to_owned(),
                    (_, _, 1..) => format!("{name}: readings that cannot be; no hole passes"),
                    (all, _, _) => format!("{name}: readings missing in {unknown} of {all} holes, which do not pass"),
                },
                tolerance_um: holes.first().and_then(|hole| hole.tolerance_um).unwrap_or(0.0),
                peak_to_peak_um: holes.iter().map(|hole| hole.error_um.peak_to_peak()).fold(0.0, f64::max),
                verdict: verdict.unwrap_or(Verdict::Warning),
                period_s: match source {
                    Source::Recording(recording) => recording.period_s,
                    Source::Line(_) => 0.0,
                },
                points: series.points,
            };
            drawing.draw(error_figure(ERROR_TITLE, &[panel]))?;
        }
        if let (Some(curves), Some(paper)) = (curves, &mut paper) {
            let found = match holes.len() {
                0 => "No hole was found.".to_owned(),
                1 => format!("1 hole of pitch {pitch_mm} mm."),
                count => format!("{count} holes of pitch {pitch_mm} mm."),
            };
            let summary = vec![format!("{name}: {}.", source_words(source)), found];
            let title = "Measured tapping";
            let mut shown = Page::new(&page::heading(common, title, verdict.map(Verdict::name), summary, None));
            shown.figures(curves.charts(name));
            shown.table(&table_of_measured(&holes));
            shown.heading("Each hole in words");
            shown.verbatim(&table(layout(common), name, source, &holes));
            page::write(paper, shown, &answer(common, None, MonitorAnswer::new(name, pitch_mm, source, &holes)))?;
        }
        drawing.into_iter().chain(trace).chain(paper).try_for_each(Output::keep)?;
        if common.format == Format::Json {
            print_json(&answer(common, None, MonitorAnswer::new(name, pitch_mm, source, &holes)))?;
        } else {
            print(&table(layout(common), name, source, &holes))?;
        }
        let failed = corrupt > 0 || holes.iter().any(|hole| hole.judgement() == Judgement::Judged(Verdict::Fail));
        Ok(if failed { Outcome::VerdictFail } else { Outcome::Good })
    }
}
