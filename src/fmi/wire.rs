//! What program and FMU process say to each other: an FMU that fails takes no more than its own process with it.
//!
//! Each side says one thing in turn. Numbers are eight bytes, the low one first.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize};

use super::variables::{INPUT_COUNT, OUTPUT_COUNT};

/// The longest text.
const LONGEST: u64 = 1 << 20;

/// What the FMU's process is asked.
pub(super) enum Request {
    /// A fresh instance.
    Start(Start),
    /// A step.
    Step(Step),
}

/// A fresh instance.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(super) struct Start {
    /// Parameters by name; those that the FMU lacks are left out.
    pub(super) parameters: Vec<(String, f64)>,
}

/// A step with the inputs that are in force in it, in the order of the set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub(super) time_s: f64,
    pub(super) step_s: f64,
    pub(super) inputs: [f64; INPUT_COUNT],
}

/// Outputs in the order of the set: the bits of an i64 for whole numbers, else of an f64; none that the FMU lacks.
pub(super) type Outputs = [Option<u64>; OUTPUT_COUNT];

const START: u8 = 1;
const STEP: u8 = 2;
const DONE: u8 = 0;
const FAILED: u8 = 1;

impl Request {
    pub(super) fn write(&self, to: &mut impl Write) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(256);
        match self {
            Self::Start(start) => {
                bytes.push(START);
                let text = serde_json::to_vec(start)?;
                bytes.extend((text.len() as u64).to_le_bytes());
                bytes.extend(text);
            }
            Self::Step(Step { time_s, step_s, inputs }) => {
                bytes.push(STEP);
                bytes.extend([time_s, step_s].into_iter().chain(inputs).flat_map(|number| number.to_le_bytes()));
            }
        }
        to.write_all(&bytes)
    }

    /// None at the end of what is asked.
    pub(super) fn read(from: &mut impl Read) -> io::Result<Option<Self>> {
        let mut kind = [0];
        if from.read(&mut kind)? == 0 {
            return Ok(None);
        }
        if kind == [START] {
            return Ok(Some(Self::Start(serde_json::from_slice(&text(from)?)?)));
        }
        let mut number = || word(from).map(f64::from_bits);
        let (time_s, step_s) = (number()?, number()?);
        let mut inputs = [0.0; INPUT_COUNT];
        for input in &mut inputs {
            *input = number()?;
        }
        Ok(Some(Self::Step(Step { time_s, step_s, inputs })))
    }
}

/// The FMU process's answer.
pub(super) fn write_answer(to: &mut impl Write, answer: &Result<Outputs, String>) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(256);
    match answer {
        Ok(outputs) => {
            bytes.push(DONE);
            for output in outputs {
                bytes.push(u8::from(output.is_some()));
                bytes.extend(output.unwrap_or(0).to_le_bytes());
            }
        }
        Err(message) => {
            bytes.push(FAILED);
            bytes.extend((message.len() as u64).to_le_bytes());
            bytes.extend(message.as_bytes());
        }
    }
    to.write_all(&bytes)
}

/// The answer, read.
pub(super) fn read_answer(from: &mut impl Read) -> io::Result<Result<Outputs, String>> {
    let mut kind = [0];
    from.read_exact(&mut kind)?;
    if kind == [FAILED] {
        return Ok(Err(String::from_utf8_lossy(&text(from)?).into_owned()));
    }
    let mut outputs = [None; OUTPUT_COUNT];
    for output in &mut outputs {
        from.read_exact(&mut kind)?;
        let value = word(from)?;
        *output = (kind == [1]).then_some(value);
    }
    Ok(Ok(outputs))
}

fn word(from: &mut impl Read) -> io::Result<u64> {
    let mut bytes = [0; 8];
    from.read_exact(&mut bytes)?;
    Ok(u64::from_le_bytes(bytes))
}

fn text(from: &mut impl Read) -> io::Result<Vec<u8>> {
    let length = word(from)?.min(LONGEST);
    let mut bytes = vec![0; length as usize];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_is_heard() {
        let mut bytes = Vec::new();
        let start = Start { parameters: vec![("seed".into(), 3.0)] };
        let step = Step { time_s: 0.25, step_s: 0.001, inputs: std::array::from_fn(|index| index as f64) };
        Request::Start(start.clone()).write(&mut bytes).unwrap();
        Request::Step(step).write(&mut bytes).unwrap();
        let mut from = &bytes[..];
        assert!(matches!(Request::read(&mut from).unwrap(), Some(Request::Start(found)) if found == start));
        assert!(matches!(Request::read(&mut from).unwrap(), Some(Request::Step(found)) if found == step));
        assert!(Request::read(&mut from).unwrap().is_none());

        let outputs = std::array::from_fn(|index| (index % 3 > 0).then_some(index as u64));
        for answer in [Ok(outputs), Err("µ".to_owned())] {
            let mut bytes = Vec::new();
            write_answer(&mut bytes, &answer).unwrap();
            assert_eq!(read_answer(&mut &bytes[..]).unwrap(), answer);
        }
    }
}
