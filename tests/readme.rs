//! What the README shows is what the program prints and draws. `BLESS=1 cargo test --test readme` rewrites both.

use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What a command line of the README prints.
fn printed(command: &str) -> String {
    let arguments = command.strip_prefix("rigidtap ").expect("a command of ours").split(' ');
    let output =
        assert_cmd::Command::cargo_bin("rigidtap").unwrap().current_dir(root()).args(arguments).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{command}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The README with the output of every `$ rigidtap` command as it is now.
fn readme_as_it_should_be(readme: &str) -> String {
    let mut fresh = String::new();
    let mut rest = readme;
    while let Some((before, block)) = rest.split_once("```console\n$ ") {
        let (body, after) = block.split_once("```\n").expect("the block ends");
        let command = body.lines().next().expect("a command");
        fresh += &format!("{before}```console\n$ {command}\n{}```\n", printed(command));
        rest = after;
    }
    fresh + rest
}

fn held(path: PathBuf, fresh: &str) {
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, fresh).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == fresh, "{} is not what the program says now", path.display());
}

#[test]
fn the_tables() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    held(root().join("README.md"), &readme_as_it_should_be(&readme));
}

#[test]
fn the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = folder.path().join("error.svg");
    let programs = "gcode/s3000.ngc gcode/s5000.ngc gcode/s7000.ngc";
    printed(&format!("rigidtap compare {programs} --laws s-curve,torque-curve --plot {}", drawn.display()));
    held(root().join("tests/readme/error.svg"), &std::fs::read_to_string(drawn).unwrap());
}

/// The README's first screen names the test command that CI calls.
#[test]
fn ci_calls_the_readmes_test_command() {
    let [readme, ci] = ["README.md", ".ci/run"].map(|name| std::fs::read_to_string(root().join(name)).unwrap());
    assert!(readme.contains("\ncargo test\n") && ci.contains("step cargo test\n"));
}
