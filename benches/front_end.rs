//! Full interpretation of a 50 MB program, beside the gcode crate that only lexes it: its parser with a visitor that does
//! nothing, which allocates nothing and keeps nothing. One core, the two in turn, the best pass of each.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

use rigidtap::gcode::{Commands, Dialect, Options, Text};

const BYTES: usize = 50_000_000;
const PASSES: usize = 7;

/// What post processors write: tapped rows, moves at feed and rapid, line numbers on some, comments here and there.
fn program() -> String {
    let mut text = String::with_capacity(BYTES + 1000);
    text.push_str("%\nO1000 (PLATE)\nG21 G17 G40 G49 G80 G90\nT1 M06\nG54 M03 S3000\n");
    let mut plate = 0_u32;
    while text.len() < BYTES {
        plate += 1;
        let line = |text: &mut String, words: std::fmt::Arguments<'_>| writeln!(text, "{words}").expect("text");
        line(&mut text, format_args!("(ROW {plate})\nG95 G98 G0 X0. Y{}.5 Z10.", plate % 400));
        line(&mut text, format_args!("M29 S3000\nG84 X0. Z-12.5 R3. F1."));
        for hole in 1..40_u32 {
            line(&mut text, format_args!("X{}.{:03}", hole * 7, hole * 131 % 1000));
        }
        line(&mut text, format_args!("G80\nG94 G1 F1200."));
        for corner in 1..60_u32 {
            let (x, y) = (corner * 37 % 400, corner * 91 % 300);
            line(&mut text, format_args!("N{} G1 X{x}.{:03} Y-{y}.{:04}", corner * 10, x * 7 % 1000, y * 13 % 10_000));
        }
        line(&mut text, format_args!("G0 Z10."));
    }
    text.push_str("M30\n%\n");
    text
}

/// Interprets; how many commands there are.
fn interpret(source: &str) -> usize {
    let mut text = Text::of(source.as_bytes());
    let mut commands = 0;
    let diagnostics = Commands::new(&mut text, &Dialect::FANUC, Options::default()).finish(&mut |command| {
        black_box(command);
        commands += 1;
    });
    assert!(!diagnostics.has_errors(), "{:?}", diagnostics.as_slice());
    commands
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

#[allow(clippy::print_stdout, reason = "the bench's result")]
fn main() {
    let source = program();
    let megabytes = source.len() as f64 / 1e6;
    let (mut own_s, mut lexing_s) = (f64::INFINITY, f64::INFINITY);
    let mut commands = 0;
    for _ in 0..PASSES {
        own_s = own_s.min(seconds(|| commands = interpret(black_box(&source))));
        lexing_s = lexing_s.min(seconds(|| gcode::core::parse(black_box(&source), &mut gcode::core::Noop)));
    }
    println!("{megabytes:.1} MB, {commands} commands; best of {PASSES} passes each, one core");
    println!("full interpretation:  {:6.1} MB/s", megabytes / own_s);
    println!("gcode 0.7 lexing:     {:6.1} MB/s", megabytes / lexing_s);
    println!("ratio:                {:6.2}", lexing_s / own_s);
}
