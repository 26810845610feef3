//! The one list of the machine file's keys: what each is called, means, why its default stands, and where it is stored.
//!
//! Reading, writing, suggestions and hints all walk this list, so that they cannot drift apart.

mod actual;
mod axes;
mod bands;
mod draft;
mod drive;
mod hard;
mod key;
mod law;
mod list;
mod program;
mod renamed;
mod spindle;
mod supervision;
mod sync;
mod tables;

pub(super) use bands::{BAND_KEYS, BANDS};
pub(super) use draft::Draft;
pub(super) use key::{Key, Slot, name, parent};
pub(super) use law::{DERIVED, rule};
pub(super) use list::{EITHER, all, find, names_in, of_table, unit};
pub(super) use renamed::renamed;
pub(super) use tables::{TABLES, Table, find_table};
