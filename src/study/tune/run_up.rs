//! A recorded run-up: time and speed of a spindle that accelerates with all its motor has.
//!
//! For users who have no torque table but can log a run-up. The text is CSV with `,`, `;`, tab or blanks between the
//! columns, decimal commas where `;` or a tab separates, comments from `#`, and rows at any distance in time. A header
//! names the two columns, `time_s` or `t` and `rpm` or `speed`, among any others; without one there are just these two.

use core::fmt;

/// Headings over the time in s.
const TIME_NAMES: [&str; 4] = ["time_s", "t_s", "time", "t"];
/// Headings over the speed in rpm.
const SPEED_NAMES: [&str; 5] = ["rpm", "speed_rpm", "spindle_rpm", "speed", "n"];
/// Fewer rows than these between standstill and full speed say too little of a curve.
pub(super) const LEAST_ROWS: usize = 20;

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) time_s: f64,
    pub(super) rpm: f64,
}

/// A run-up as recorded: rows in rising time, speeds without their direction.
#[derive(Clone, Debug, PartialEq)]
pub struct RunUp {
    pub(super) samples: Vec<Sample>,
    pub(super) last_line: usize,
}

/// What is wrong with a run-up, at its place. `Display` says what, without the place.
#[derive(Clone, Debug, PartialEq)]
pub struct RunUpError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong.
    pub fault: RunUpFault,
}

/// What can be wrong with a run-up.
#[derive(Clone, Debug, PartialEq)]
pub enum RunUpFault {
    /// No row at all.
    Empty,
    /// A header without one of the two columns.
    NoColumn {
        /// Headings that would be understood.
        expected: &'static [&'static str],
    },
    /// Fewer columns than the header has, or than two.
    Short {
        /// Columns found.
        found: usize,
        /// Columns expected.
        expected: usize,
    },
    /// A cell that is no finite number.
    NotANumber {
        /// The cell, shortened.
        cell: String,
    },
    /// Time does not rise.
    TimeOrder {
        /// Time found.
        time_s: f64,
        /// Time of the row before.
        previous_s: f64,
    },
    /// The log does not start near standstill.
    StartsFast {
        /// Least speed before the run-up.
        from_rpm: f64,
        /// Greatest speed that would do.
        limit_rpm: f64,
    },
    /// The run-up ends below the spindle's greatest speed.
    EndsSlow {
        /// Greatest speed found.
        reached_rpm: f64,
        /// Least speed that would do.
        needed_rpm: f64,
    },
    /// Too few rows between standstill and full speed.
    FewRows {
        /// Rows found.
        found: usize,
    },
    /// Speed does not rise steadily enough to say what the motor can do.
    NoCurve,
}

impl fmt::Display for RunUpFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("no rows: expected time in s and speed in rpm"),
            Self::NoColumn { expected } => {
                write!(f, "the header has no column {}", expected.join(" or "))
            }
            Self::Short { found, expected } => write!(f, "{found} columns found, expected {expected}"),
            Self::NotANumber { cell } => write!(f, "found `{}`, expected a number", cell.escape_debug()),
            Self::TimeOrder { time_s, previous_s } => {
                write!(f, "time {time_s} s does not come after {previous_s} s: expected rows in rising time")
            }
            Self::StartsFast { from_rpm, limit_rpm } => {
                write!(f, "the run-up starts at {from_rpm:.0} rpm, expected at most {limit_rpm:.0} rpm")
            }
            Self::EndsSlow { reached_rpm, needed_rpm } => {
                write!(f, "the run-up ends at {reached_rpm:.0} rpm, expected at least {needed_rpm:.0} rpm")
            }
            Self::FewRows { found } => {
                write!(f, "{found} rows between standstill and full speed, expected at least {LEAST_ROWS}")
            }
            Self::NoCurve => f.write_str("the speed does not rise steadily enough to tell what the motor can do"),
        }
    }
}

impl fmt::Display for RunUpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.fault.fmt(f)
    }
}

impl RunUp {
    /// Reads a log. Rows with an empty time or speed are left out.
    ///
    /// # Errors
    /// The first fault, at its place.
    ///
    /// ```
    /// use rigidtap::study::{RunUp, RunUpFault};
    /// assert!(RunUp::read(b"# spindle at 100 %\ntime_s,rpm\n0.000,0\n0.001,48\n").is_ok());
    /// let error = RunUp::read(b"t;speed\n0,1;zero\n").unwrap_err();
    /// assert_eq!((error.line, error.column), (2, 5));
    /// ```
    pub fn read(bytes: &[u8]) -> Result<Self, RunUpError> {
        let text = String::from_utf8_lossy(bytes);
        let mut columns = None;
        let mut run_up = Self { samples: Vec::new(), last_line: 1 };
        for (line, row) in (1..).zip(text.trim_start_matches('\u{FEFF}').lines()) {
            let row = row.split('#').next().unwrap_or_default();
            if row.trim().is_empty() {
                continue;
            }
            run_up.last_line = line;
            let cells = cells(row);
            let Some(columns) = &columns else {
                let (found, is_header) = Columns::of(&cells, line)?;
                columns = Some(found);
                if !is_header {
                    run_up.row(line, &cells, &Columns::PLAIN)?;
                }
                continue;
            };
            run_up.row(line, &cells, columns)?;
        }
        if run_up.samples.is_empty() {
            return Err(RunUpError { line: run_up.last_line, column: 1, fault: RunUpFault::Empty });
        }
        Ok(run_up)
    }

    fn row(&mut self, line: usize, cells: &[Cell], columns: &Columns) -> Result<(), RunUpError> {
        let expected = columns.time.max(columns.speed) + 1;
        let (Some(time), Some(speed)) = (cells.get(columns.time), cells.get(columns.speed)) else {
            let fault = RunUpFault::Short { found: cells.len(), expected };
            return Err(RunUpError { line, column: 1, fault });
        };
        if time.text.is_empty() || speed.text.is_empty() {
            return Ok(());
        }
        let (time_s, rpm) = (time.number(line)?, speed.number(line)?.abs());
        if let Some(previous) = self.samples.last()
            && !(time_s > previous.time_s)
        {
            let fault = RunUpFault::TimeOrder { time_s, previous_s: previous.time_s };
            return Err(RunUpError { line, column: time.column, fault });
        }
        self.samples.push(Sample { time_s, rpm });
        Ok(())
    }
}

/// Where the two values stand in a row.
struct Columns {
    time: usize,
    speed: usize,
}

impl Columns {
    const PLAIN: Self = Self { time: 0, speed: 1 };

    /// The columns as the first row has them, and whether that row is a header.
    fn of(first: &[Cell], line: usize) -> Result<(Self, bool), RunUpError> {
        if first.iter().all(|cell| cell.text.is_empty() || cell.value().is_some()) {
            return Ok((Self::PLAIN, false));
        }
        let column = |expected: &'static [&'static str]| {
            let named = |cell: &Cell| expected.contains(&cell.text.trim_matches('"').to_ascii_lowercase().as_str());
            let fault = RunUpFault::NoColumn { expected };
            first.iter().position(named).ok_or(RunUpError { line, column: 1, fault })
        };
        Ok((Self { time: column(&TIME_NAMES)?, speed: column(&SPEED_NAMES)? }, true))
    }
}

struct Cell<'a> {
    text: &'a str,
    column: usize,
    decimal_comma: bool,
}

impl Cell<'_> {
    fn value(&self) -> Option<f64> {
        let parsed = if self.decimal_comma { self.text.replace(',', ".").parse() } else { self.text.parse::<f64>() };
        parsed.ok().filter(|value| value.is_finite())
    }

    fn number(&self, line: usize) -> Result<f64, RunUpError> {
        self.value().ok_or_else(|| {
            let fault = RunUpFault::NotANumber { cell: self.text.chars().take(20).collect() };
            RunUpError { line, column: self.column, fault }
        })
    }
}

/// The cells of a row, at the strongest separator that it has.
fn cells(row: &str) -> Vec<Cell<'_>> {
    let separator = [';', '\t', ','].into_iter().find(|separator| row.contains(*separator));
    let splits = |c: char| separator.map_or(c.is_whitespace(), |separator| c == separator);
    let mut column = 1;
    let mut cells = Vec::new();
    for piece in row.split(splits) {
        let text = piece.trim();
        let lead = piece.chars().take_while(|c| c.is_whitespace()).count();
        if separator.is_some() || !text.is_empty() {
            cells.push(Cell { text, column: column + lead, decimal_comma: separator != Some(',') });
        }
        column += piece.chars().count() + 1;
    }
    cells
}
