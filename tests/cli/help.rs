//! What the program says of itself.

use super::*;

#[test]
fn alone_it_shows_three_examples() {
    let output = rigidtap(&[]);
    assert_eq!((code(&output), stdout(&output).as_str()), (2, ""));
    let shown = stderr(&output);
    assert_eq!(shown.lines().filter(|line| line.starts_with("  rigidtap ")).count(), 3, "{shown}");
}

/// Own options stand before what every subcommand has.
#[test]
fn own_options_come_first() {
    for (subcommand, own) in
        [("simulate", "--trace"), ("compare", "--laws"), ("sweep", "--runs"), ("tune", "--bands"), ("monitor", "--map")]
    {
        let help = stdout(&rigidtap(&[subcommand, "--help"]));
        let own = format!("{own} <");
        let at = |words: &str| help.find(words).unwrap_or_else(|| panic!("{words} in {help}"));
        let own_end = ["\nSimulated machine", "\nCommon options:"].map(|heading| help.find(heading));
        assert!(at("\nOptions:") < at(&own) && at(&own) < own_end.into_iter().flatten().min().unwrap(), "{help}");
        assert!(at("Common options:") < at("--machine <") && at("--machine <") < at("--wide"), "{help}");
    }
}

#[test]
fn completions_know_the_subcommands_of_every_shell() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = rigidtap(&["completions", shell]);
        assert_eq!(code(&output), 0);
        assert!(stdout(&output).contains("simulate") && stdout(&output).contains("law"), "{shell}");
    }
    assert_eq!(code(&rigidtap(&["completions", "tcsh"])), 2);
}

#[test]
fn manual_pages_are_those_of_the_command_and_of_its_parts() {
    let whole = stdout(&rigidtap(&["man"]));
    assert!(whole.contains(".TH rigidtap 1") && whole.contains("simulate"), "{whole}");
    let part = stdout(&rigidtap(&["man", "simulate"]));
    assert!(part.contains(".TH rigidtap-simulate 1") && part.contains("trace") && part.contains("Examples:"), "{part}");
    assert_eq!(code(&rigidtap(&["man", "drill"])), 2);
}

#[test]
fn a_slip_is_answered_with_what_was_meant() {
    for (words, meant) in [(&["simulat"][..], "simulate"), (&["compare", "x", "--law", "s-curv"], "s-curve")] {
        let output = rigidtap(words);
        assert_eq!(code(&output), 2);
        assert!(stderr(&output).contains(meant), "{}", stderr(&output));
    }
}
