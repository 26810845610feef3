//! A list that is written while it is made, so that it need not be in memory.

use std::borrow::Cow;
use std::cell::RefCell;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::ser::{Serialize, SerializeSeq, Serializer};

/// Makes the items one by one, and hands each to its argument.
type Make<'a, T> = Box<dyn FnOnce(&mut dyn FnMut(T)) + 'a>;

/// A list whose items are made when it is written, which is once.
///
/// ```
/// use rigidtap::report::json::Streamed;
/// let squares = Streamed::new(|item: &mut dyn FnMut(u32)| (1..4).for_each(|n| item(n * n)));
/// assert_eq!(serde_json::to_string(&squares)?, "[1,4,9]");
/// assert!(serde_json::to_string(&squares).is_err(), "written before");
/// # Ok::<(), serde_json::Error>(())
/// ```
pub struct Streamed<'a, T>(RefCell<Option<Make<'a, T>>>);

impl<'a, T> Streamed<'a, T> {
    /// A list of what `make` hands to its argument.
    pub fn new(make: impl FnOnce(&mut dyn FnMut(T)) + 'a) -> Self {
        Self(RefCell::new(Some(Box::new(make))))
    }
}

impl<T> fmt::Debug for Streamed<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Streamed")
    }
}

impl<T: Serialize> Serialize for Streamed<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let make = self.0.take().ok_or_else(|| serde::ser::Error::custom("the list was written before"))?;
        let mut list = serializer.serialize_seq(None)?;
        let mut written = Ok(());
        make(&mut |item| {
            if written.is_ok() {
                written = list.serialize_element(&item);
            }
        });
        written?;
        list.end()
    }
}

impl<T: JsonSchema> JsonSchema for Streamed<'_, T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        Vec::<T>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<T>::json_schema(generator)
    }
}
