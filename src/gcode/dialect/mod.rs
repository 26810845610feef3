//! What the codes of a control mean, as data: another control is another table, not another interpreter.

mod all;
mod brother;
mod codes;
mod definition;
mod idle;
mod mitsubishi;
mod names;
mod recognise;
mod rules;
mod siemens;
mod sources;
mod tables;

pub use codes::{CodeName, GCode, GGroup, IdleWords, MCode, MGroup};
pub use definition::{
    CycleWords, DecimalPoint, Dialect, DwellUnit, G81, Macros, PECK_BACK_MM, ReturnSpeed, Syntax, WordMeaning,
};
pub(crate) use mitsubishi::{COMMA_I, COMMA_J, COMMA_R, COMMA_S};
pub(crate) use names::Name;
pub use recognise::{AUTO, Recognised, looks_like, recognise};
pub use rules::{CodeAlone, CycleRules, ZeroRepeats};
pub use sources::{RULES, Rule, Source};
