//! The process that an FMU runs in.

use std::io::BufReader;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::path::Path;

use super::binding::{Binding, Bound};
use super::calls::Calls;
use super::description::{Description, Version};
use super::fmi2::Fmi2;
use super::fmi3::Fmi3;
use super::unpack::library_path;
use super::variables::{INPUTS, Kind, OUTPUTS};
use super::wire::{Outputs, Request, Step, write_answer};
use crate::sim::Actual;

/// Runs the FMU that was unpacked into a folder, for the program at the other end of standard input, which is a socket,
/// until that program goes.
///
/// # Errors
/// Where standard input is no socket, or the other end is gone in the middle of a word.
pub fn serve(folder: &Path) -> std::io::Result<()> {
    let socket = UnixStream::from(std::io::stdin().as_fd().try_clone_to_owned()?);
    let (mut from, mut to) = (BufReader::new(socket.try_clone()?), socket);
    let mut hosted = Hosted::load(folder);
    while let Some(request) = Request::read(&mut from)? {
        let answer = match &mut hosted {
            Err(message) => Err(message.clone()),
            Ok(hosted) => hosted.answer(&request),
        };
        write_answer(&mut to, &answer)?;
    }
    Ok(())
}

/// An FMU, loaded.
struct Hosted {
    calls: Box<dyn Calls>,
    binding: Binding,
}

impl Hosted {
    fn load(folder: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(folder.join("modelDescription.xml")).map_err(|error| error.to_string())?;
        let description = Description::read(&text).map_err(|error| error.to_string())?;
        let binding = Binding::new(&description, &actual_keys()).map_err(|error| error.to_string())?;
        let (library, resources) = (folder.join(library_path(&description)), folder.join("resources"));
        let calls: Box<dyn Calls> = match description.version {
            Version::Two => Box::new(Fmi2::load(&library, &resources, &description.token)?),
            Version::Three => Box::new(Fmi3::load(&library, &resources, &description.token)?),
        };
        Ok(Self { calls, binding })
    }

    fn answer(&mut self, request: &Request) -> Result<Outputs, String> {
        match request {
            Request::Start(start) => {
                let given = self.binding.parameters.iter().filter_map(|(name, bound)| {
                    let (_, value) = start.parameters.iter().find(|(given, _)| given == name)?;
                    Some((*bound, *value))
                });
                let given: Vec<_> = given.collect();
                self.calls.start(&given, 0.0)?;
            }
            Request::Step(Step { time_s, step_s, inputs }) => {
                for ((bound, value), variable) in self.binding.inputs.iter().zip(inputs).zip(&INPUTS) {
                    if let Some(bound) = bound {
                        self.calls.set(*bound, *value).map_err(|why| format!("{}: {why}", variable.name))?;
                    }
                }
                self.calls.step(*time_s, *step_s)?;
            }
        }
        let mut outputs = [None; OUTPUTS.len()];
        for ((output, bound), variable) in outputs.iter_mut().zip(&self.binding.outputs).zip(&OUTPUTS) {
            if let Some(bound) = bound {
                *output = Some(
                    get(&mut *self.calls, *bound, variable.kind).map_err(|why| format!("{} {why}", variable.name))?,
                );
            }
        }
        Ok(outputs)
    }
}

fn get(calls: &mut dyn Calls, bound: Bound, kind: Kind) -> Result<u64, String> {
    let bits = calls.get(bound, kind == Kind::Whole)?;
    let value = f64::from_bits(bits);
    if kind == Kind::Real && !value.is_finite() {
        return Err(format!("is {value}, expected a finite number"));
    }
    Ok(bits)
}

/// What a sweep draws, by its keys.
pub(super) fn actual_keys() -> Vec<&'static str> {
    Actual::default().values().into_iter().map(|(key, _)| key).collect()
}
