//! What every answer begins with.

use schemars::JsonSchema;
use serde::Serialize;

/// Version of the answers' form: it rises where a field changes its meaning or goes.
pub const SCHEMA: u32 = 2;

/// What every answer begins with, and the answer.
///
/// ```
/// use rigidtap::report::json::{Answer, DryCycleAnswer};
/// let answer = Answer::new("built-in", None, DryCycleAnswer { program: "M30\n".into() });
/// let text = serde_json::to_string(&answer)?;
/// assert!(text.ends_with(r#""schema":2,"machine":"built-in","program":"M30\n"}"#), "{text}");
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, JsonSchema, Serialize)]
#[schemars(rename = "{T}OnMachine", description = "An answer, with what every answer begins with.")]
pub struct Answer<T> {
    /// Version of the program.
    rigidtap: &'static str,
    /// Version of the answers' form.
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    /// Machine file, or `built-in`.
    machine: String,
    /// Seed of everything random, where one counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(flatten)]
    body: T,
}

impl<T> Answer<T> {
    /// An answer on a machine, by its file's name.
    pub fn new(machine: &str, seed: Option<u64>, body: T) -> Self {
        Self { rigidtap: env!("CARGO_PKG_VERSION"), schema: SCHEMA, machine: machine.to_owned(), seed, body }
    }
}
