//! The functions of FMI 3.0 for co-simulation, as far as they are used.

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;

use libloading::Library;

use super::binding::Bound;
use super::calls::{Calls, check, function, hear, load, whole_of};
use super::description::Type;

type Instance = *mut c_void;
type Logger = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
type Instantiate = unsafe extern "C" fn(
    *const c_char,
    *const c_char,
    *const c_char,
    bool,
    bool,
    bool,
    bool,
    *const u32,
    usize,
    *mut c_void,
    Option<Logger>,
    Option<unsafe extern "C" fn()>,
) -> Instance;
type OfInstance = unsafe extern "C" fn(Instance) -> c_int;
type Enter = unsafe extern "C" fn(Instance, bool, f64, f64, bool, f64) -> c_int;
type Get<T> = unsafe extern "C" fn(Instance, *const u32, usize, *mut T, usize) -> c_int;
type Set<T> = unsafe extern "C" fn(Instance, *const u32, usize, *const T, usize) -> c_int;
type DoStep = unsafe extern "C" fn(Instance, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> c_int;

unsafe extern "C" fn log(_: *mut c_void, status: c_int, _: *const c_char, message: *const c_char) {
    if status > 0 {
        // SAFETY: the standard says that it is a text.
        unsafe { hear(message) };
    }
}

/// An FMU 3.0.
pub(super) struct Fmi3 {
    instance: Instance,
    token: CString,
    resources: CString,
    instantiate: Instantiate,
    free_instance: unsafe extern "C" fn(Instance),
    enter: Enter,
    exit: OfInstance,
    terminate: OfInstance,
    do_step: DoStep,
    /// The functions above are its: it goes last.
    library: Library,
}

impl Fmi3 {
    pub(super) fn load(library: &Path, resources: &Path, token: &str) -> Result<Self, String> {
        let library = load(library)?;
        let text = |text: &str| CString::new(text).map_err(|_| "a text with a 0 in it".to_owned());
        // SAFETY: every type is that of the standard's fmi3FunctionTypes.h.
        unsafe {
            Ok(Self {
                instance: std::ptr::null_mut(),
                token: text(token)?,
                // A path here, no address as in FMI 2.
                resources: text(&format!("{}/", resources.display()))?,
                instantiate: function(&library, "fmi3InstantiateCoSimulation")?,
                free_instance: function(&library, "fmi3FreeInstance")?,
                enter: function(&library, "fmi3EnterInitializationMode")?,
                exit: function(&library, "fmi3ExitInitializationMode")?,
                terminate: function(&library, "fmi3Terminate")?,
                do_step: function(&library, "fmi3DoStep")?,
                library,
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

    fn get_as<T: Copy + Default>(&self, name: &str, reference: u32) -> Result<T, String> {
        let mut value = T::default();
        // SAFETY: the name's type is T; one reference, room for one value.
        let status = unsafe {
            let get: Get<T> = function(&self.library, name)?;
            get(self.instance, &raw const reference, 1, &raw mut value, 1)
        };
        check(name, status).map(|()| value)
    }

    fn set_as<T: Copy>(&self, name: &str, reference: u32, value: T) -> Result<(), String> {
        // SAFETY: the name's type is T; one reference, one value.
        let status = unsafe {
            let set: Set<T> = function(&self.library, name)?;
            set(self.instance, &raw const reference, 1, &raw const value, 1)
        };
        check(name, status)
    }
}

impl Drop for Fmi3 {
    fn drop(&mut self) {
        self.end();
    }
}

impl Calls for Fmi3 {
    fn start(&mut self, parameters: &[(Bound, f64)], start_s: f64) -> Result<(), String> {
        self.end();
        let none = std::ptr::null_mut();
        // SAFETY: the texts live as long as this, which outlives the instance.
        let instance = unsafe {
            (self.instantiate)(
                c"plant".as_ptr(),
                self.token.as_ptr(),
                self.resources.as_ptr(),
                false,
                false,
                false,
                false,
                std::ptr::null(),
                0,
                none,
                Some(log),
                None,
            )
        };
        if instance.is_null() {
            return check("fmi3InstantiateCoSimulation", 3);
        }
        self.instance = instance;
        for (bound, value) in parameters {
            self.set(*bound, *value)?;
        }
        // SAFETY: the instance is alive.
        unsafe {
            let entered = (self.enter)(self.instance, false, 0.0, start_s, false, 0.0);
            check("fmi3EnterInitializationMode", entered)?;
            check("fmi3ExitInitializationMode", (self.exit)(self.instance))
        }
    }

    fn set(&mut self, to: Bound, value: f64) -> Result<(), String> {
        let reference = to.reference;
        match to.value_type {
            Type::Real => self.set_as("fmi3SetFloat64", reference, value),
            Type::Float32 => self.set_as("fmi3SetFloat32", reference, value as f32),
            Type::Int8 => self.set_as("fmi3SetInt8", reference, value as i8),
            Type::UInt8 => self.set_as("fmi3SetUInt8", reference, value as u8),
            Type::Int16 => self.set_as("fmi3SetInt16", reference, value as i16),
            Type::UInt16 => self.set_as("fmi3SetUInt16", reference, value as u16),
            Type::Int32 => self.set_as("fmi3SetInt32", reference, value as i32),
            Type::UInt32 => self.set_as("fmi3SetUInt32", reference, value as u32),
            Type::Int64 => self.set_as("fmi3SetInt64", reference, value as i64),
            Type::UInt64 => self.set_as("fmi3SetUInt64", reference, value as u64),
            Type::Boolean => self.set_as("fmi3SetBoolean", reference, value != 0.0),
            Type::Other => Ok(()),
        }
    }

    fn get(&mut self, from: Bound, whole: bool) -> Result<u64, String> {
        let reference = from.reference;
        let integer = match from.value_type {
            Type::Real | Type::Float32 => {
                let value = if from.value_type == Type::Real {
                    self.get_as::<f64>("fmi3GetFloat64", reference)?
                } else {
                    self.get_as::<f32>("fmi3GetFloat32", reference)?.into()
                };
                return if whole { whole_of(value).map(i64::cast_unsigned) } else { Ok(value.to_bits()) };
            }
            Type::Int8 => self.get_as::<i8>("fmi3GetInt8", reference)?.into(),
            Type::UInt8 => self.get_as::<u8>("fmi3GetUInt8", reference)?.into(),
            Type::Int16 => self.get_as::<i16>("fmi3GetInt16", reference)?.into(),
            Type::UInt16 => self.get_as::<u16>("fmi3GetUInt16", reference)?.into(),
            Type::Int32 => self.get_as::<i32>("fmi3GetInt32", reference)?.into(),
            Type::UInt32 => self.get_as::<u32>("fmi3GetUInt32", reference)?.into(),
            Type::Int64 => self.get_as::<i64>("fmi3GetInt64", reference)?,
            Type::UInt64 => self.get_as::<u64>("fmi3GetUInt64", reference)?.cast_signed(),
            // A byte that is neither 0 nor 1 would be no bool.
            Type::Boolean => i64::from(self.get_as::<u8>("fmi3GetBoolean", reference)? != 0),
            Type::Other => 0,
        };
        Ok(if whole { integer.cast_unsigned() } else { (integer as f64).to_bits() })
    }

    fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), String> {
        let (mut event, mut terminate, mut early, mut last_s) = (false, false, false, 0.0);
        // SAFETY: the instance is alive, the results' places too.
        let status = unsafe {
            (self.do_step)(
                self.instance,
                time_s,
                step_s,
                true,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut last_s,
            )
        };
        check("fmi3DoStep", status)?;
        if terminate { Err("fmi3DoStep asks to end the simulation".into()) } else { Ok(()) }
    }
}
