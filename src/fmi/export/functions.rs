//! The functions of FMI 2.0 for co-simulation over our models: what a shared library of this crate exports.
//!
//! An instance is a boxed [`Instance`]; a simulator hands over what [`fmi2Instantiate`] gave it, and nothing else.
#![allow(non_snake_case, reason = "the standard's names")]
#![allow(clippy::missing_safety_doc, reason = "the standard says what a simulator may hand over")]
#![allow(missing_docs, reason = "the standard's functions")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;

use super::control_model::ControlModel;
use super::description::{Which, guid};
use super::model::Model;
use super::plant_model::PlantModel;
use super::stored::Stored;

const OK: c_int = 0;
const ERROR: c_int = 3;

type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`, as far as it is used: memory is our own.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate_memory: *mut c_void,
    free_memory: *mut c_void,
    step_finished: *mut c_void,
    environment: *mut c_void,
}

/// One model under a simulator.
pub struct Instance {
    model: Box<dyn Model + Send>,
    log: Log,
    begun: bool,
    time_s: f64,
}

#[derive(Clone)]
struct Log {
    logger: Option<Logger>,
    environment: *mut c_void,
    name: CString,
}

impl Log {
    fn say(&self, why: &str) -> c_int {
        let message = CString::new(why.replace('%', "%%")).unwrap_or_default();
        if let Some(logger) = self.logger {
            // SAFETY: the simulator's own function; the texts live through the call.
            unsafe {
                logger(self.environment, self.name.as_ptr(), ERROR, c"logStatusError".as_ptr(), message.as_ptr())
            };
        }
        ERROR
    }
}

/// Does something with an instance; what it says goes to the simulator's logger.
///
/// # Safety
/// `instance` is null or one of ours, and no one else uses it meanwhile.
unsafe fn with(instance: *mut Instance, act: impl FnOnce(&mut Instance) -> Result<(), String>) -> c_int {
    // SAFETY: the caller's promise.
    let Some(instance) = (unsafe { instance.as_mut() }) else { return ERROR };
    match act(instance) {
        Ok(()) => OK,
        Err(why) => instance.log.say(&why),
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    _type: c_int,
    token: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut Instance {
    // SAFETY: texts are null or end in 0; the callbacks are null or live through the call.
    let (name, token, resources, callbacks) = unsafe {
        let text = |text: *const c_char| if text.is_null() { c"" } else { CStr::from_ptr(text) };
        (text(name), text(token), text(resources), callbacks.as_ref())
    };
    let log = Log {
        logger: callbacks.and_then(|callbacks| callbacks.logger),
        environment: callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.environment),
        name: name.to_owned(),
    };
    let made = model(&token.to_string_lossy(), &resources.to_string_lossy());
    match made {
        Ok(model) => Box::into_raw(Box::new(Instance { model, log, begun: false, time_s: 0.0 })),
        Err(why) => {
            log.say(&why);
            std::ptr::null_mut()
        }
    }
}

fn model(token: &str, resources: &str) -> Result<Box<dyn Model + Send>, String> {
    let stored = Stored::read(&folder_of(resources))?;
    if token == guid(Which::Plant) {
        Ok(Box::new(PlantModel::new(&stored)?))
    } else if token == guid(Which::Control) {
        Ok(Box::new(ControlModel::new(&stored)?))
    } else {
        Err(format!("its guid is {token}: expected {} or {}", guid(Which::Plant), guid(Which::Control)))
    }
}

/// The folder of an address such as file:///tmp/a%20b, which the standard hands over; simulators that hand over a path
/// are understood, too.
fn folder_of(address: &str) -> PathBuf {
    let Some(path) = address.strip_prefix("file:") else { return address.into() };
    let path = path.strip_prefix("//localhost").or_else(|| path.strip_prefix("//")).unwrap_or(path);
    let (mut bytes, mut rest) = (Vec::new(), path.as_bytes());
    while let Some((first, others)) = rest.split_first() {
        let coded = others.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        match coded.filter(|_| *first == b'%').and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = others.get(2..).unwrap_or_default();
            }
            None => {
                bytes.push(*first);
                rest = others;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned().into()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(instance: *mut Instance) {
    if !instance.is_null() {
        // SAFETY: made by fmi2Instantiate, and freed once.
        drop(unsafe { Box::from_raw(instance) });
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetDebugLogging(_: *mut Instance, _: c_int, _: usize, _: *const *const c_char) -> c_int {
    OK
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    instance: *mut Instance,
    _: c_int,
    _: f64,
    start_s: f64,
    _: c_int,
    _: f64,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe {
        with(instance, |instance| {
            instance.time_s = start_s;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(instance: *mut Instance) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { with(instance, |_| Ok(())) }
}

/// Parameters are set by now.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(instance: *mut Instance) -> c_int {
    // SAFETY: the standard's promise.
    unsafe {
        with(instance, |instance| {
            instance.begun = true;
            instance.model.begin()
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(instance: *mut Instance) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { with(instance, |_| Ok(())) }
}

/// Parameters stay as they were set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(instance: *mut Instance) -> c_int {
    // SAFETY: the standard's promise.
    unsafe {
        with(instance, |instance| {
            instance.begun = false;
            Ok(())
        })
    }
}

/// # Safety
/// As the standard says of getters and setters: so many numbers, so many values.
unsafe fn get<T>(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *mut T,
    of: impl Fn(f64) -> T,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        with(instance, |instance| {
            for at in 0..count {
                let number = numbers.add(at).read();
                let value = instance.model.get(number).ok_or_else(|| format!("there is no variable {number}"))?;
                values.add(at).write(of(value));
            }
            Ok(())
        })
    }
}

/// # Safety
/// As [`get`].
unsafe fn set<T: Copy>(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *const T,
    of: impl Fn(T) -> f64,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        with(instance, |instance| {
            for at in 0..count {
                let (number, value) = (numbers.add(at).read(), values.add(at).read());
                if !instance.model.set(number, of(value)) {
                    return Err(format!("there is no variable {number} that can be set"));
                }
            }
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *mut f64,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { get(instance, numbers, count, values, |value| value) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *const f64,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { set(instance, numbers, count, values, |value| value) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *mut c_int,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { get(instance, numbers, count, values, |value| value as c_int) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *const c_int,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { set(instance, numbers, count, values, f64::from) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *mut c_int,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { get(instance, numbers, count, values, |value| c_int::from(value != 0.0)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    instance: *mut Instance,
    numbers: *const u32,
    count: usize,
    values: *const c_int,
) -> c_int {
    // SAFETY: the standard's promise.
    unsafe { set(instance, numbers, count, values, |value| f64::from(u8::from(value != 0))) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(instance: *mut Instance, time_s: f64, step_s: f64, _: c_int) -> c_int {
    // SAFETY: the standard's promise.
    unsafe {
        with(instance, |instance| {
            if !instance.begun {
                return Err("a step before the end of the initialisation".into());
            }
            instance.time_s = time_s + step_s;
            instance.model.step(step_s)
        })
    }
}

/// `fmi2GetRealStatus`: the time of the last step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(instance: *mut Instance, _: c_int, value: *mut f64) -> c_int {
    // SAFETY: the standard's promise.
    unsafe {
        with(instance, |instance| {
            value.write(instance.time_s);
            Ok(())
        })
    }
}

/// Functions that have to be there and that no simulator calls on a model without that ability.
macro_rules! absent {
    ($($name:ident)*) => {
        $(
            #[unsafe(no_mangle)]
            pub extern "C" fn $name() -> c_int {
                ERROR
            }
        )*
    };
}

absent! {
    fmi2GetString fmi2SetString fmi2GetFMUstate fmi2SetFMUstate fmi2FreeFMUstate fmi2SerializedFMUstateSize
    fmi2SerializeFMUstate fmi2DeSerializeFMUstate fmi2GetDirectionalDerivative fmi2SetRealInputDerivatives
    fmi2GetRealOutputDerivatives fmi2CancelStep fmi2GetStatus fmi2GetIntegerStatus fmi2GetBooleanStatus
    fmi2GetStringStatus
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_a_folder() {
        for address in ["/tmp/a b/c", "file:///tmp/a%20b/c", "file:/tmp/a b/c", "file://localhost/tmp/a%20b/c"] {
            assert_eq!(folder_of(address), PathBuf::from("/tmp/a b/c"));
        }
    }
}
