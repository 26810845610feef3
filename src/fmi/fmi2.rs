//! The functions of FMI 2.0 for co-simulation, as far as they are used.

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;

use libloading::Library;

use super::binding::Bound;
use super::calls::{Calls, check, function, hear, load, whole_of};
use super::description::Type;

type Instance = *mut c_void;
type Logger = unsafe extern "C" fn(Instance, *const c_char, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`.
#[repr(C)]
struct Callbacks {
    logger: Logger,
    allocate_memory: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free_memory: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

type Instantiate = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const Callbacks,
    c_int,
    c_int,
) -> Instance;
type OfInstance = unsafe extern "C" fn(Instance) -> c_int;
type SetUp = unsafe extern "C" fn(Instance, c_int, f64, f64, c_int, f64) -> c_int;
type GetReal = unsafe extern "C" fn(Instance, *const u32, usize, *mut f64) -> c_int;
type GetInteger = unsafe extern "C" fn(Instance, *const u32, usize, *mut c_int) -> c_int;
type SetReal = unsafe extern "C" fn(Instance, *const u32, usize, *const f64) -> c_int;
type SetInteger = unsafe extern "C" fn(Instance, *const u32, usize, *const c_int) -> c_int;
type DoStep = unsafe extern "C" fn(Instance, f64, f64, c_int) -> c_int;

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

/// What the standard's logger is given beyond the message is left unread: its form is printf's.
unsafe extern "C" fn log(_: Instance, _: *const c_char, status: c_int, _: *const c_char, message: *const c_char) {
    if status > 0 {
        // SAFETY: the standard says that it is a text.
        unsafe { hear(message) };
    }
}

/// An FMU 2.0.
pub(super) struct Fmi2 {
    instance: Instance,
    callbacks: Box<Callbacks>,
    token: CString,
    resources: CString,
    instantiate: Instantiate,
    free_instance: unsafe extern "C" fn(Instance),
    set_up: SetUp,
    enter: OfInstance,
    exit: OfInstance,
    terminate: OfInstance,
    get_real: GetReal,
    get_integer: GetInteger,
    get_boolean: GetInteger,
    set_real: SetReal,
    set_integer: SetInteger,
    set_boolean: SetInteger,
    do_step: DoStep,
    /// The functions above are its: it goes last.
    _library: Library,
}

impl Fmi2 {
    pub(super) fn load(library: &Path, resources: &Path, token: &str) -> Result<Self, String> {
        let library = load(library)?;
        let text = |text: &str| CString::new(text).map_err(|_| "a text with a 0 in it".to_owned());
        // SAFETY: every type is that of the standard's fmi2FunctionTypes.h.
        unsafe {
            Ok(Self {
                instance: std::ptr::null_mut(),
                callbacks: Box::new(Callbacks {
                    logger: log,
                    allocate_memory: calloc,
                    free_memory: free,
                    step_finished: None,
                    environment: std::ptr::null_mut(),
                }),
                token: text(token)?,
                resources: text(&format!("file://{}", resources.display()))?,
                instantiate: function(&library, "fmi2Instantiate")?,
                free_instance: function(&library, "fmi2FreeInstance")?,
                set_up: function(&library, "fmi2SetupExperiment")?,
                enter: function(&library, "fmi2EnterInitializationMode")?,
                exit: function(&library, "fmi2ExitInitializationMode")?,
                terminate: function(&library, "fmi2Terminate")?,
                get_real: function(&library, "fmi2GetReal")?,
                get_integer: function(&library, "fmi2GetInteger")?,
                get_boolean: function(&library, "fmi2GetBoolean")?,
                set_real: function(&library, "fmi2SetReal")?,
                set_integer: function(&library, "fmi2SetInteger")?,
                set_boolean: function(&library, "fmi2SetBoolean")?,
                do_step: function(&library, "fmi2DoStep")?,
                _library: library,
            })
        }
    }

    fn end(&mut self) {
        if !self.instance.is_null() {
            // SAFETY: the instance is alive, and is no more after this.
            unsafe {
                (self.terminate)(self.instance);
                (self.free_instance)(self.instance);
            }
            self.instance = std::ptr::null_mut();
        }
    }
}

impl Drop for Fmi2 {
    fn drop(&mut self) {
        self.end();
    }
}

impl Calls for Fmi2 {
    fn start(&mut self, parameters: &[(Bound, f64)], start_s: f64) -> Result<(), String> {
        const CO_SIMULATION: c_int = 1;
        self.end();
        // SAFETY: texts and callbacks live as long as this, which outlives the instance.
        let instance = unsafe {
            (self.instantiate)(
                c"plant".as_ptr(),
                CO_SIMULATION,
                self.token.as_ptr(),
                self.resources.as_ptr(),
                &raw const *self.callbacks,
                0,
                0,
            )
        };
        if instance.is_null() {
            return check("fmi2Instantiate", 3);
        }
        self.instance = instance;
        for (bound, value) in parameters {
            self.set(*bound, *value)?;
        }
        // SAFETY: the instance is alive.
        unsafe {
            check("fmi2SetupExperiment", (self.set_up)(self.instance, 0, 0.0, start_s, 0, 0.0))?;
            check("fmi2EnterInitializationMode", (self.enter)(self.instance))?;
            check("fmi2ExitInitializationMode", (self.exit)(self.instance))
        }
    }

    fn set(&mut self, to: Bound, value: f64) -> Result<(), String> {
        let reference = to.reference;
        // SAFETY: one reference and one value.
        unsafe {
            match to.value_type {
                Type::Real => {
                    check("fmi2SetReal", (self.set_real)(self.instance, &raw const reference, 1, &raw const value))
                }
                Type::Boolean => {
                    let value = c_int::from(value != 0.0);
                    check(
                        "fmi2SetBoolean",
                        (self.set_boolean)(self.instance, &raw const reference, 1, &raw const value),
                    )
                }
                _ => {
                    let value = value as c_int;
                    check(
                        "fmi2SetInteger",
                        (self.set_integer)(self.instance, &raw const reference, 1, &raw const value),
                    )
                }
            }
        }
    }

    fn get(&mut self, from: Bound, whole: bool) -> Result<u64, String> {
        let reference = from.reference;
        if from.value_type == Type::Real {
            let mut value = 0.0;
            // SAFETY: one reference, room for one value.
            let status = unsafe { (self.get_real)(self.instance, &raw const reference, 1, &raw mut value) };
            check("fmi2GetReal", status)?;
            return if whole { whole_of(value).map(i64::cast_unsigned) } else { Ok(value.to_bits()) };
        }
        let get = if from.value_type == Type::Boolean { self.get_boolean } else { self.get_integer };
        let mut value = 0;
        // SAFETY: one reference, room for one value.
        check("fmi2GetInteger", unsafe { get(self.instance, &raw const reference, 1, &raw mut value) })?;
        Ok(if whole { i64::from(value).cast_unsigned() } else { f64::from(value).to_bits() })
    }

    fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), String> {
        // SAFETY: the instance is alive.
        check("fmi2DoStep", unsafe { (self.do_step)(self.instance, time_s, step_s, 1) })
    }
}
