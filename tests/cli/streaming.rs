//! Programs of any length: memory does not grow with them.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};

/// All that a process may ask for, in bytes: the binary, its libraries, the standard buffers.
const MOST_BYTES: u64 = 64 << 20;

/// Moves with numbers and comments, and holes that differ.
fn program_of(count: u32) -> Vec<u8> {
    let mut text = String::from("G90 G54 G21\nM03 S3000\nG0 X0 Y0 Z10\n");
    let mut blocks = 3;
    while blocks < count {
        let x = blocks % 400;
        writeln!(text, "N{blocks} G1 X{x}.125 Y-{x}.5 F3000 (way)").unwrap();
        blocks += 1;
        if blocks % 100 == 0 {
            let depth = 5 + blocks % 7;
            writeln!(text, "G81 X{x} Y7 R3 Z-{depth} F3000\nG80\nG0 Z10").unwrap();
            blocks += 3;
        }
    }
    text.push_str("M30\n");
    text.into_bytes()
}

/// Runs the binary with little memory to have; a program that asks for more is ended by the system.
fn with_little_memory(arguments: &str, stdin: &[u8]) -> Output {
    let binary = assert_cmd::cargo::cargo_bin("rigidtap");
    let script = format!("ulimit -v {}; exec {} {arguments}", MOST_BYTES / 1024, binary.display());
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdin.take().unwrap();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // A child that ended early shows in its output.
            let _ = pipe.write_all(stdin);
        });
        child.wait_with_output().unwrap()
    })
}

#[cfg(target_os = "linux")]
#[test]
fn a_million_blocks_take_no_more_memory_than_ten() {
    let program = program_of(1_000_000);
    let folder = tempfile::tempdir().unwrap();
    let path = super::file(&folder, "million.ngc", &program);
    let path = super::text(&path);

    for arguments in [format!("check {path}"), "check -".into()] {
        let checked = with_little_memory(&arguments, &program);
        let found = super::stdout(&checked);
        assert_eq!(super::code(&checked), 0, "{}", super::stderr(&checked));
        assert!(found.contains(" 10000 tapped holes\n"), "{found}");
        assert!(found.contains(": 0 errors, 0 warnings, "), "{found}");
    }

    let wrong = [&program[..program.len() - 4], b"G84 Q1 Q2\nM30\n"].concat();
    let wrong = with_little_memory("check -", &wrong);
    assert_eq!(super::code(&wrong), 1);
    assert!(super::stderr(&wrong).contains("<stdin>:10"), "{}", super::stderr(&wrong));

    // A subprogram behind all of them is called and returns.
    let calling = [&program[..program.len() - 4], b"M98 P7\nM30\nO7 G0 X1.\nM99\n"].concat();
    let called = with_little_memory("check --dialect fanuc -q -", &calling);
    assert_eq!(super::code(&called), 0, "{}", super::stderr(&called));
}

#[cfg(target_os = "linux")]
#[test]
fn what_is_written_is_not_kept_either() {
    let folder = tempfile::tempdir().unwrap();
    let path = super::file(&folder, "long.ngc", &program_of(100_000));
    let path = super::text(&path);

    let canon = with_little_memory(&format!("check --canon {path}"), b"");
    assert!(super::stdout(&canon).ends_with(" end\n"), "{}", super::stderr(&canon));

    let json = with_little_memory(&format!("check --format json {path} | tail -c 100"), b"");
    assert!(super::stdout(&json).ends_with("\"diagnostics\": []\n    }\n  ]\n}\n"), "{}", super::stdout(&json));

    let plan = with_little_memory(&format!("plan {path} | tail -n 1"), b"");
    assert!(super::stdout(&plan).contains(" s as planned"), "{}{}", super::stdout(&plan), super::stderr(&plan));
}
