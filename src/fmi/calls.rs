//! What both versions' functions have in common.

use std::cell::RefCell;
use std::ffi::{CStr, c_char};
use std::path::Path;

use libloading::{Library, Symbol};

use super::binding::Bound;

thread_local! {
    /// What the FMU said last through its logger, for the message of a call that failed.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Status of a call: OK and warning go on.
pub(super) fn check(call: &str, status: i32) -> Result<(), String> {
    let word = match status {
        0 | 1 => return Ok(()),
        2 => "discard",
        3 => "error",
        4 => "fatal",
        5 => "pending",
        _ => "an unknown status",
    };
    let said = SAID.with(|said| std::mem::take(&mut *said.borrow_mut()));
    let said = if said.is_empty() { String::new() } else { format!(": {said}") };
    Err(format!("{call} answers {word}{said}"))
}

/// Keeps what an FMU says.
///
/// # Safety
/// `message` is null or a text that ends in 0.
pub(super) unsafe fn hear(message: *const c_char) {
    if !message.is_null() {
        // SAFETY: the caller's promise.
        let text = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
        SAID.with(|said| *said.borrow_mut() = text);
    }
}

/// Loads a shared library.
pub(super) fn load(path: &Path) -> Result<Library, String> {
    // SAFETY: what its initialisers do is the FMU's matter; it runs in a process of its own.
    unsafe { Library::new(path) }.map_err(|error| error.to_string())
}

/// A function of it.
///
/// # Safety
/// `F` is the function's type by the standard.
pub(super) unsafe fn function<F: Copy>(library: &Library, name: &str) -> Result<F, String> {
    // SAFETY: the caller's promise.
    let found: Result<Symbol<'_, F>, _> = unsafe { library.get(name.as_bytes()) };
    found.map(|symbol| *symbol).map_err(|_| format!("its library has no function {name}"))
}

/// One FMU, loaded; instances of it one after the other.
pub(super) trait Calls {
    /// A fresh instance, in initialisation mode once its parameters are set.
    fn start(&mut self, parameters: &[(Bound, f64)], start_s: f64) -> Result<(), String>;
    /// Sets one variable.
    fn set(&mut self, to: Bound, value: f64) -> Result<(), String>;
    /// Gets one variable: the bits of an i64 where `whole`, else those of an f64.
    fn get(&mut self, from: Bound, whole: bool) -> Result<u64, String>;
    /// Steps.
    fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), String>;
}

/// A count as Real: exact up to 2⁵³, and whole.
pub(super) fn whole_of(value: f64) -> Result<i64, String> {
    const MOST: f64 = 9_007_199_254_740_992.0;
    if value.fract() == 0.0 && value.abs() <= MOST {
        Ok(value as i64)
    } else {
        Err(format!("is {value}, expected a whole number"))
    }
}
