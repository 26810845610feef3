//! The command line: words in, files read, studies run, reports out, an exit code.

mod advise;
mod answer;
mod args;
mod board;
mod check;
mod compare;
mod describe;
#[cfg(all(feature = "fmi", unix))]
mod fmu;
mod input;
mod interrupt;
mod learned;
mod live;
mod machine;
mod monitor;
mod outcome;
mod output;
mod page;
mod plan;
mod plant;
mod progress;
mod recorder;
mod simulate;
mod subprograms;
mod sweep;
mod tune;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command, FIRST_STEPS};
use outcome::{Outcome, Stop};

use crate::report::printable;

/// Runs the command that the process was called with.
#[must_use]
pub fn run() -> ExitCode {
    if std::env::args_os().len() <= 1 {
        outcome::report(FIRST_STEPS);
        return Outcome::WrongUsage.into();
    }
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version come this way too, and a closed pipe is no matter.
            let error = printable_error(error);
            let _ = error.print();
            return if error.use_stderr() { Outcome::WrongUsage.into() } else { Outcome::Good.into() };
        }
    };
    log_to_stderr(&cli);
    let result = match &cli.command {
        Command::Check(args) => check::check(&cli.common, args),
        Command::Plan(args) => plan::plan(&cli.common, args),
        Command::Simulate(args) => simulate::simulate(&cli.common, args),
        Command::Compare(args) => compare::compare(&cli.common, args),
        Command::Sweep(args) => sweep::sweep(&cli.common, args),
        Command::Advise(args) => advise::advise(&cli.common, args),
        Command::Tune(args) => tune::tune(&cli.common, args),
        Command::Monitor(args) => monitor::monitor(&cli.common, args),
        Command::Machine(args) => machine::machine(&cli.common, args),
        Command::Schema(args) => describe::schema(args),
        Command::Completions(args) => describe::completions(args),
        Command::Man(args) => describe::man(args),
        #[cfg(all(feature = "fmi", unix))]
        Command::Fmu(args) => fmu::fmu(&cli.common, &args.command),
        #[cfg(all(feature = "fmi", unix))]
        Command::FmuHost(args) => {
            // At its end there is nobody to tell.
            let _ = crate::fmi::serve(&args.folder);
            Ok(Outcome::Good)
        }
    };
    match result {
        Ok(outcome) => outcome.into(),
        Err(Stop::Reported) => Outcome::Rejected.into(),
        Err(Stop::Usage(message)) => {
            outcome::report(&format!("error: {}", printable(&message)));
            Outcome::WrongUsage.into()
        }
        Err(Stop::Output { name, error })
            if error.kind() == std::io::ErrorKind::BrokenPipe && name == outcome::STDOUT =>
        {
            Outcome::Good.into()
        }
        Err(Stop::Output { name, error }) => {
            outcome::report(&format!("error: {name} cannot be written: {error}"));
            Outcome::Rejected.into()
        }
    }
}

/// An error in the words of the command line shows them: here as the error of words that command no terminal.
fn printable_error(error: clap::Error) -> clap::Error {
    let words = std::env::args_os().map(|word| printable(&word.to_string_lossy()).into_owned());
    if error.use_stderr() { Cli::try_parse_from(words).err().unwrap_or(error) } else { error }
}

fn log_to_stderr(cli: &Cli) {
    let level = match (cli.common.quiet, cli.common.verbose) {
        (true, _) => tracing::Level::ERROR,
        (false, 0) => tracing::Level::WARN,
        (false, 1) => tracing::Level::INFO,
        (false, _) => tracing::Level::DEBUG,
    };
    // A second subscriber in one process can only come from a test; the first one stays.
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(input::color(&cli.common))
        .without_time()
        .with_target(false)
        .try_init();
}
