//! The page itself: text, tables, figures.

use core::fmt::Write;

use serde::Serialize;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// What stands first: the verdict, and where all of it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// What the page is about.
    pub title: String,
    /// `ok`, `warning` or `fail`; none where nothing is judged.
    pub verdict: Option<&'static str>,
    /// The verdict in words.
    pub summary: Vec<String>,
    /// The machine file's name.
    pub machine: String,
    /// Seed of what is random; none where nothing is.
    pub seed: Option<u64>,
    /// The command that makes it again.
    pub command: String,
}

/// A line of a figure.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Line {
    /// Name in the legend.
    pub name: String,
    /// Abscissae, rising.
    pub x: Vec<f64>,
    /// Ordinates; none leaves a gap.
    pub y: Vec<Option<f64>>,
}

/// A level that is drawn across a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Where.
    pub y: f64,
    /// What it is.
    pub name: String,
}

/// A figure.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// Figures of a group zoom together.
    pub group: String,
    /// What is to the right, with its unit.
    pub x_label: String,
    /// What is upward, with its unit.
    pub y_label: String,
    /// The lines, or one of bars.
    pub series: Vec<Line>,
    /// What is allowed: lowest and highest.
    pub band: Option<[f64; 2]>,
    /// Levels of y.
    pub limits: Vec<Level>,
    /// Levels of x.
    pub x_limits: Vec<Level>,
    /// Bars from zero in place of a line.
    pub bars: bool,
    /// Zero is always shown.
    pub from_zero: bool,
}

/// Figures of which one set is shown at a time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChartSet {
    /// What is chosen.
    pub name: String,
    /// Its figures.
    pub charts: Vec<Chart>,
}

/// A table: the first column to the left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Headings.
    pub head: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

/// A page as it grows.
#[derive(Clone, Debug)]
pub struct Page {
    body: String,
    charts: Vec<Vec<ChartSet>>,
    title: String,
}

impl Page {
    /// A page with its heading.
    #[must_use]
    pub fn new(heading: &Heading) -> Self {
        let mut body = String::new();
        let Heading { title, verdict, summary, machine, seed, command } = heading;
        let _ = write!(body, "<h1>");
        if let Some(verdict) = verdict {
            let _ = write!(body, "<span class=\"verdict {verdict}\" id=\"verdict\">{verdict}</span>");
        }
        let _ = writeln!(body, "{}</h1>", escaped(title));
        for sentence in summary {
            let _ = writeln!(body, "<p>{}</p>", escaped(sentence));
        }
        let seed = seed.map_or_else(String::new, |seed| format!(", seed {seed}"));
        let version = env!("CARGO_PKG_VERSION");
        let _ = writeln!(
            body,
            "<p class=\"soft\">Machine {}{seed}; rigidtap {version}; again: <code>{}</code></p>",
            escaped(machine),
            escaped(command)
        );
        Self { body, charts: Vec::new(), title: title.clone() }
    }

    /// A part's heading.
    pub fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escaped(text));
    }

    /// A sentence.
    pub fn say(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// Text as it stands.
    pub fn verbatim(&mut self, text: &str) {
        let _ = writeln!(self.body, "<pre>{}</pre>", escaped(text));
    }

    /// A table.
    pub fn table(&mut self, table: &Table) {
        let cells = |tag: &str, row: &[String]| -> String {
            row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
        };
        let _ = write!(
            self.body,
            "<div class=\"scroll\"><table><thead><tr>{}</tr></thead><tbody>",
            cells("th", &table.head)
        );
        for row in &table.rows {
            let _ = write!(self.body, "<tr>{}</tr>", cells("td", row));
        }
        self.body += "</tbody></table></div>\n";
    }

    /// Figures; of several sets one at a time.
    pub fn figures(&mut self, sets: Vec<ChartSet>) {
        if sets.iter().all(|set| set.charts.is_empty()) {
            return;
        }
        let _ = writeln!(self.body, "<div data-charts=\"{}\"></div>", self.charts.len());
        self.charts.push(sets);
    }

    /// The whole page, with the answer in JSON as `--format json` gives it.
    ///
    /// # Errors
    /// None that a value of ours can cause.
    pub fn finish(self, answer: &impl Serialize) -> Result<String, serde_json::Error> {
        let script = |value: String| value.replace('<', "\\u003c");
        let charts = script(serde_json::to_string(&self.charts)?);
        let answer = script(serde_json::to_string(answer)?);
        let hint = if self.charts.is_empty() {
            ""
        } else {
            "<p class=\"soft hint\">Drag across a figure to zoom, double-click to see all again.</p>\n"
        };
        Ok(format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
             <title>{title}</title><style>{STYLE}</style></head>\n<body><main>\n{body}{hint}</main>\n\
             <script type=\"application/json\" id=\"answer\">{answer}</script>\n\
             <script type=\"application/json\" id=\"charts\">{charts}</script>\n<script>{SCRIPT}</script></body></html>\n",
            title = escaped(&self.title),
            body = self.body,
        ))
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_end_the_script_or_begin_a_tag() {
        let evil = "</script><img src=x>";
        let heading = Heading {
            title: evil.into(),
            verdict: Some("ok"),
            summary: vec![evil.into()],
            machine: evil.into(),
            seed: None,
            command: evil.into(),
        };
        let mut page = Page::new(&heading);
        let line = Line { name: evil.into(), x: vec![0.0], y: vec![None] };
        page.figures(vec![ChartSet {
            name: evil.into(),
            charts: vec![Chart { series: vec![line], ..Chart::default() }],
        }]);
        let html = page.finish(&evil).unwrap();
        assert!(!html.contains("<img") && html.matches("</script>").count() == 3, "{html}");
    }
}
