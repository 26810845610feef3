//! `advise` for people: the answer first, then what it rests on.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use crate::report::advice::{Asked, ControlSheet, answer_sentences, kind_name, limit_sentence, trial_cells, trials};
use crate::study::{Advice, KindAdvice};

/// The answer in three sentences, speeds of each kind, settings that were looked at, what to type in, what to paste.
#[must_use]
pub fn advised(layout: Layout, advice: &Advice, asked: &Asked, control: Option<&ControlSheet>, toml: &str) -> String {
    let mut page = Page::new(layout);
    for sentence in answer_sentences(advice, asked) {
        page.say(sentence);
    }
    for kind in &advice.kinds {
        let hole = &kind.kind.hole;
        let feed = kind.trial.speed_rpm * hole.pitch_mm;
        page.blank().say(format!(
            "line {}, {}: S{:.0} F{:.1}; now S{:.0}",
            kind.kind.line,
            kind_name(&kind.kind),
            kind.trial.speed_rpm,
            feed,
            hole.speed_rpm
        ));
        page.table(&speeds(kind));
        page.say(format!("limit: {}", limit_sentence(kind)));
    }
    page.blank().table(&settings(advice));
    if let Some(sheet) = control {
        page.blank().say(format!("{}: what to type in", sheet.control.name()));
        let sources = sources(sheet);
        for found in &sheet.parameters {
            let source = sources.iter().position(|source| *source == found.source).map_or(0, |index| index + 1);
            let number = found.number.map_or_else(String::new, |number| format!("{number} = "));
            let set = format!("  {number}{} {}", found.value, found.unit);
            page.say(format!("{}: {}; {} [{source}]", set.trim_end(), found.name, found.rounding));
        }
        for (index, source) in sources.iter().enumerate() {
            page.say(format!("[{}] {source}", index + 1));
        }
        for note in &sheet.notes {
            page.say(note);
        }
    }
    page.blank().verbatim(toml);
    page.finish()
}

fn speeds(kind: &KindAdvice) -> Columns {
    let mut table = Columns::new(&[
        text("", 0),
        number("S rpm", 0),
        number("hole ms", 0),
        number("worst µm", 0),
        number("too deep µm", 2),
        number("used %", 0),
        number("good", 0),
        number("alarms", 3),
    ]);
    for (name, trial) in trials(kind) {
        let mut cells = trial_cells(name, &trial);
        cells.push(trial.alarms.to_string());
        table.row(cells);
    }
    table
}

fn settings(advice: &Advice) -> Columns {
    let mut table = Columns::new(&[text("law", 0), number("share", 0), number("all holes s", 0)]);
    for found in &advice.alternatives {
        let holds = found.holes_s.map_or_else(|| "does not hold".to_owned(), |seconds| format!("{seconds:.3}"));
        table.row(vec![
            found.law.name().into(),
            found.share.map_or_else(String::new, |share| format!("{share:.2}")),
            holds,
        ]);
    }
    table
}

fn sources(sheet: &ControlSheet) -> Vec<&'static str> {
    let mut sources = Vec::new();
    for found in &sheet.parameters {
        if !sources.contains(&found.source) {
            sources.push(found.source);
        }
    }
    sources
}
