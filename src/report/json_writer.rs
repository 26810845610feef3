//! JSON written piece by piece, so that a long list need not be in memory. The text is that of `serde_json`, indented.

use std::io::{self, Write};

use serde_json::Value;

/// Writes one JSON value made of objects and arrays that are begun and ended.
///
/// ```
/// use rigidtap::report::json_writer::JsonWriter;
/// use serde_json::json;
/// let mut out = Vec::new();
/// let mut writer = JsonWriter::new(&mut out);
/// writer.begin_object(None).unwrap();
/// writer.begin_array(Some("numbers")).unwrap();
/// writer.value(None, &json!(1)).unwrap();
/// writer.end().unwrap();
/// writer.end().unwrap();
/// assert_eq!(out, format!("{:#}\n", json!({ "numbers": [1] })).into_bytes());
/// ```
#[derive(Debug)]
pub struct JsonWriter<W> {
    out: W,
    /// How each object and array that is open ends, and whether it holds anything.
    open: Vec<(char, bool)>,
}

impl<W: Write> JsonWriter<W> {
    /// Nothing is written yet.
    pub const fn new(out: W) -> Self {
        Self { out, open: Vec::new() }
    }

    /// Begins an object; with its key inside another.
    ///
    /// # Errors
    /// What the writer says.
    pub fn begin_object(&mut self, key: Option<&str>) -> io::Result<()> {
        self.begin(key, '{', '}')
    }

    /// Begins an array; with its key inside an object.
    ///
    /// # Errors
    /// What the writer says.
    pub fn begin_array(&mut self, key: Option<&str>) -> io::Result<()> {
        self.begin(key, '[', ']')
    }

    /// A whole value; with its key inside an object.
    ///
    /// # Errors
    /// What the writer says.
    pub fn value(&mut self, key: Option<&str>, value: &Value) -> io::Result<()> {
        self.place(key)?;
        let indent = format!("\n{}", "  ".repeat(self.open.len()));
        // Line ends inside strings are escaped: each that is here begins a line.
        write!(self.out, "{}", format!("{value:#}").replace('\n', &indent))
    }

    /// Ends what was begun last; the outermost ends its line.
    ///
    /// # Errors
    /// What the writer says.
    pub fn end(&mut self) -> io::Result<()> {
        let Some((close, any)) = self.open.pop() else { return Ok(()) };
        if any {
            write!(self.out, "\n{}", "  ".repeat(self.open.len()))?;
        }
        write!(self.out, "{close}")?;
        if self.open.is_empty() { self.out.write_all(b"\n") } else { Ok(()) }
    }

    fn begin(&mut self, key: Option<&str>, open: char, close: char) -> io::Result<()> {
        self.place(key)?;
        write!(self.out, "{open}")?;
        self.open.push((close, false));
        Ok(())
    }

    /// Where the next value goes.
    fn place(&mut self, key: Option<&str>) -> io::Result<()> {
        let depth = self.open.len();
        if let Some((_, any)) = self.open.last_mut() {
            let comma = if std::mem::replace(any, true) { "," } else { "" };
            write!(self.out, "{comma}\n{}", "  ".repeat(depth))?;
        }
        key.map_or(Ok(()), |key| write!(self.out, "{}: ", Value::from(key)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_same_text_as_whole() {
        let entry = json!({ "a": [1, { "b\n": "c\n\"" }], "empty": [], "none": {} });
        let whole = json!({ "files": [{ "file": "x", "list": [entry, entry], "no": [] }, 3], "last": null });
        let mut out = Vec::new();
        let mut writer = JsonWriter::new(&mut out);
        let write = |writer: &mut JsonWriter<&mut Vec<u8>>| -> io::Result<()> {
            writer.begin_object(None)?;
            writer.begin_array(Some("files"))?;
            writer.begin_object(None)?;
            writer.value(Some("file"), &json!("x"))?;
            writer.begin_array(Some("list"))?;
            writer.value(None, &entry)?;
            writer.value(None, &entry)?;
            writer.end()?;
            writer.begin_array(Some("no"))?;
            writer.end()?;
            writer.end()?;
            writer.value(None, &json!(3))?;
            writer.end()?;
            writer.value(Some("last"), &Value::Null)?;
            writer.end()
        };
        write(&mut writer).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), format!("{whole:#}\n"));
    }
}
