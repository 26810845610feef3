//! What holds for any bytes at all. The first byte picks the dialect, the rest is the program.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::thread::StandardThread;
use rigidtap::gcode::program::{Checker, Overrides};
use rigidtap::gcode::{
    CommandKind, Commands, Diagnostics, Dialect, Options, Subprograms, Text, Warnings, canonical, interpret, recognise,
};

/// Interprets and plans, and panics where a promise is broken.
pub(crate) fn exercise(bytes: &[u8]) {
    let Some((&pick, source)) = bytes.split_first() else { return };
    let dialect = &Dialect::ALL[usize::from(pick) % Dialect::ALL.len()];
    let options = Options { block_delete: pick >= 128, ..Options::default() };
    let program = interpret(source, dialect, options);
    let found = program.diagnostics.as_slice();
    assert!(found.len() <= 2 * (Diagnostics::LIMIT + 1));
    for found in found {
        assert!(found.span.start <= found.span.end && found.span.end <= source.len(), "{found:?}");
        assert!(found.line >= 1 && found.column >= 1);
        assert!(!found.message().is_empty() && !found.hint().is_empty());
    }
    with_a_file(source, dialect, options);
    assert!(!recognise(&mut Text::of(source)).reason().is_empty());
    let _ = std::str::from_utf8(source).map(StandardThread::by_name);
    the_same_in_pieces(source, dialect, options, &program.commands, found.len());
    if program.diagnostics.has_errors() {
        return;
    }
    let ends = program.commands.iter().filter(|command| command.kind == CommandKind::End).count();
    assert_eq!(ends, 1);
    for command in program.commands.iter().take(100) {
        assert!(!canonical(command).contains("NaN"), "{}", canonical(command));
    }
    let machine = Machine::reference();
    let mut checker = Checker::new(&machine, Law::TorqueCurve, Overrides::default(), options.start_mm);
    let mut concerns = Warnings::new(&machine, Law::TorqueCurve);
    // What repeats make is planned alike.
    for command in program.commands.iter().take(2000) {
        checker.command(command, &mut |refusal| assert!(!refusal.error.to_string().is_empty()));
        concerns.command(command, &mut |_| ());
    }
}

/// One file, whatever is called.
#[derive(Debug)]
struct OneFile(Vec<u8>);

impl Subprograms for OneFile {
    fn numbered(&mut self, _: u32) -> Option<(String, Vec<u8>)> {
        Some(("file".into(), self.0.clone()))
    }

    fn named(&mut self, name: &str) -> Option<(String, Vec<u8>)> {
        (name.len() < 20).then(|| (name.into(), self.0.clone()))
    }
}

/// Behind the first byte 1 stands the file of every subprogram.
fn with_a_file(source: &[u8], dialect: &Dialect, options: Options) {
    let Some(at) = source.iter().position(|byte| *byte == 1) else { return };
    let (program, file) = (&source[..at], source[at + 1..].to_vec());
    let mut text = Text::of(program).with_subprograms(Box::new(OneFile(file)));
    let mut commands = Commands::new(&mut text, dialect, options);
    let count = commands.by_ref().count();
    let found = commands.diagnostics().clone();
    for found in found.as_slice() {
        let (length, start) = match text.subprogram(found.span.start) {
            Some((_, bytes, start)) => (bytes.len(), start),
            None => (program.len(), 0),
        };
        assert!(found.span.start >= start && found.span.end <= start + length, "{found:?}");
        assert!(found.span.start <= found.span.end && found.line >= 1);
    }
    // What was taken in is found again, without asking.
    assert_eq!(Commands::new(&mut text, dialect, options).count(), count);
}

/// A reader that hands out a few bytes at a time.
struct Pieces<'a>(Cursor<&'a [u8]>);

impl Read for Pieces<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let length = into.len().min(7);
        self.0.read(&mut into[..length])
    }
}

impl Seek for Pieces<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

fn the_same_in_pieces(
    source: &[u8],
    dialect: &Dialect,
    options: Options,
    expected: &[rigidtap::gcode::Command],
    findings: usize,
) {
    let mut text = Text::new(Pieces(Cursor::new(source)));
    let mut commands = Commands::new(&mut text, dialect, options);
    assert!(commands.by_ref().eq(expected.iter().copied()));
    assert_eq!(commands.diagnostics().as_slice().len(), findings);
}
