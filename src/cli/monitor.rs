//! `rigidtap monitor`.

use std::path::Path;

use crate::control::machine::Machine;
use crate::link::map::Map;
use crate::link::plausibility::Limits;
use crate::link::recording::{Context, RecordingError, RecordingFile};
use crate::link::sample::Scale;
use crate::report::monitor::Source;
use crate::run::analysis::{Analysis, AnalysisSettings, PitchFinder};

use super::args::{Common, MonitorArgs};
use super::outcome::{Outcome, Stop};
use super::recorder::Recorder;
use super::{board, input, live, output};

/// Judges a recording or a live machine, or plays the board.
pub(super) fn monitor(common: &Common, args: &MonitorArgs) -> Result<Outcome, Stop> {
    output::check_paths(
        common,
        args.file.as_slice(),
        &[args.plot.as_ref(), args.report.as_ref(), args.trace.as_ref()],
    )?;
    let file = input::machine_file(common, &[])?;
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
    let refused = |error: RecordingError| input::refused(&name, error.line, error.column, &error.kind);
    let context =
        Context { scale: Scale::of(machine), period_s: machine.spec().control.period_s, limits: Limits::of(machine) };
    let mut file = RecordingFile::new(input::recording(path)?, map.as_ref(), &context).map_err(refused)?;
    let pitch_mm = match args.pitch {
        Some(pitch_mm) => pitch_mm,
        None => {
            let mut finder = PitchFinder::new(file.scale());
            file.read(&mut |sample| finder.push(&sample)).map_err(refused)?;
            let none = "no movement in a coarse thread's pitch here: expected one, or --pitch";
            finder.pitch_mm().ok_or_else(|| input::refused(&name, 1, 1, &none))?
        }
    };
    let settings =
        AnalysisSettings { scale: file.scale(), pitch_mm, tolerance_um: machine.sync_tolerance_um(pitch_mm) };
    let mut analysis = Analysis::new(settings);
    let mut recorder = Recorder::new(args, &settings)?;
    let recording = file.read(&mut |sample| analysis.push(sample, &mut recorder)).map_err(refused)?;
    analysis.finish(&mut recorder);
    recorder.report(common, args, &name, pitch_mm, Source::Recording(&recording))
}
