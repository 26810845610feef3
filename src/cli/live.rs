//! `rigidtap monitor --serial`: holes as they are cut.

use std::sync::atomic::Ordering;
use std::time::Duration;

use indicatif::ProgressBar;

use crate::control::machine::Machine;
use crate::link::receiver::Fastest;
use crate::link::sample::Scale;
use crate::link::serial::{Event, Reader};
use crate::report::monitor::{Source, alarm_line, hole_line};
use crate::report::printable;
use crate::run::analysis::{Analysis, AnalysisListener, AnalysisSettings, Cutting, MeasuredHole, MeasuredRow};

use super::args::{Common, Format, MonitorArgs};
use super::interrupt::stop_on_ctrl_c;
use super::outcome::{Outcome, Stop, print, report};
use super::progress;
use super::recorder::Recorder;

/// How long it waits for readings before it looks whether Ctrl-C was pressed.
const IDLE: Duration = Duration::from_millis(50);
/// The bar is drawn for one sample in so many: some ten times a second at 1 kHz.
const BAR_EVERY: u64 = 100;
/// The bar's full length, in tolerances.
const BAR_STEPS: u64 = 100;

/// Records holes, and reports each while the next is cut.
struct LiveRecorder<'a> {
    recorder: Recorder,
    bar: &'a ProgressBar,
    /// JSON keeps standard output to itself: lines then go to standard error.
    lines_to_stderr: bool,
    tolerance_um: Option<f64>,
    failed: Option<Stop>,
}

impl LiveRecorder<'_> {
    fn line(&mut self, text: &str) {
        let Self { bar, lines_to_stderr, .. } = self;
        let reported = bar.suspend(|| {
            if *lines_to_stderr {
                report(text);
                Ok(())
            } else {
                print(&format!("{text}\n"))
            }
        });
        self.failed = self.failed.take().or(reported.err());
    }
}

impl AnalysisListener for LiveRecorder<'_> {
    fn row(&mut self, row: &MeasuredRow) {
        self.recorder.row(row);
    }

    fn cutting(&mut self, cutting: &Cutting) {
        if cutting.sample.k.is_multiple_of(BAR_EVERY) {
            let share = self.tolerance_um.map_or(0.0, |most| cutting.band_um.peak_to_peak() / most);
            self.bar.set_position((share.min(1.0) * BAR_STEPS as f64) as u64);
            self.bar.set_message(format!(
                "hole {} {:.1} mm, e(k) {:.1} µm, peak to peak",
                cutting.hole, cutting.z_travel_mm, cutting.error_um
            ));
        }
    }

    fn alarm(&mut self, cutting: &Cutting) {
        self.line(&alarm_line(cutting));
    }

    fn hole(&mut self, hole: &MeasuredHole) {
        self.line(&hole_line(hole));
        self.recorder.hole(hole);
    }
}

/// Judges holes until there are enough of them, or Ctrl-C.
pub(super) fn live(common: &Common, args: &MonitorArgs, machine: &Machine, port: &str) -> Result<Outcome, Stop> {
    let name = &*printable(port);
    let pitch_mm = args.pitch.ok_or_else(|| Stop::Usage("--serial needs --pitch".into()))?;
    let settings =
        AnalysisSettings { scale: Scale::of(machine), pitch_mm, tolerance_um: machine.sync_tolerance_um(pitch_mm) };
    let recorder = Recorder::new(args, &settings)?;
    let stop = stop_on_ctrl_c();
    let mut reader = Reader::open(port, args.baud, Fastest::of(machine)).map_err(|error| {
        report(&format!("error: {name}: {error}"));
        Stop::Reported
    })?;
    let bar = progress::bar(common, BAR_STEPS as usize, "waiting for a hole");
    let lines_to_stderr = common.format == Format::Json;
    let tolerance_um = settings.tolerance_um;
    let mut live = LiveRecorder { recorder, bar: &bar, lines_to_stderr, tolerance_um, failed: None };
    let mut analysis = Analysis::new(settings);
    let enough = |live: &LiveRecorder<'_>| args.holes.is_some_and(|most| live.recorder.holes.len() >= most as usize);
    while !stop.load(Ordering::Relaxed) && !enough(&live) && live.failed.is_none() {
        match reader.next_event() {
            Some(Event::Sample(sample)) => analysis.push(sample, &mut live),
            Some(Event::Disconnected) => bar.suspend(|| report(&format!("{name} is gone: waiting for it"))),
            Some(Event::Reconnected) => bar.suspend(|| report(&format!("{name} is back"))),
            None => reader.wait(IDLE),
        }
    }
    analysis.finish(&mut live);
    bar.finish_and_clear();
    let counters = reader.finish();
    let LiveRecorder { recorder, failed, .. } = live;
    match failed {
        Some(stop) => Err(stop),
        None => recorder.report(common, args, name, pitch_mm, Source::Line(counters)),
    }
}
