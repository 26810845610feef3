//! The worst machine for people.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::sweep::significant;
use super::words::settings as settings_words;
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::sim::ActualValue;
use crate::study::{SweepSettings, WorstMachine};

/// The largest error, and what each effect has in it.
#[must_use]
pub fn worst_machine(
    layout: Layout,
    file: &str,
    law: Law,
    sync: Settings,
    settings: &SweepSettings,
    found: &WorstMachine,
) -> String {
    let machine = &found.machine;
    let mut page = Page::new(layout);
    page.say(format!(
        "{file}: the worst of {} machines, seed {}; {}, {}",
        found.runs,
        settings.seed,
        law.name(),
        settings_words(sync),
    ));
    let alarm = machine.alarm.map_or_else(String::new, |code| format!(", stopped by alarm A{code}"));
    page.say(format!(
        "{:.2} µm in its first hole, {}{alarm}; the largest of {} anywhere in the box: {:.2} µm",
        machine.first.worst_um,
        machine.first.verdict.name(),
        found.anywhere_runs,
        found.anywhere_um,
    ));
    if found.without_error > 0 {
        page.say(format!("{} machines never began their hole and have no error", found.without_error));
    }
    let mut table = Columns::new(&[
        text("effect", 0),
        number("worst machine", 0),
        number("nominal", 0),
        number("µm with it nominal", 0),
        number("less by", 0),
    ]);
    for effect in &found.effects {
        let less = effect.worst_um.map(|um| 100.0 * (1.0 - um / machine.first.worst_um));
        table.row(vec![
            effect.key.to_owned(),
            value(effect.value),
            value(effect.nominal),
            effect.worst_um.map_or_else(|| "no hole".to_owned(), |um| format!("{um:.2}")),
            less.map_or_else(String::new, |percent| format!("{percent:.0} %")),
        ]);
    }
    page.blank().say("What makes it: each effect by itself as on the nominal machine, all others as they are");
    page.table(&table);
    page.finish()
}

fn value(value: ActualValue) -> String {
    match value {
        ActualValue::Number(number) => number.map_or_else(|| "–".to_owned(), significant),
        ActualValue::Word(word) => word.to_owned(),
        ActualValue::Switch(on) => on.to_string(),
    }
}
