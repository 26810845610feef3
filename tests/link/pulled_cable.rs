//! Through a real pseudo-terminal, and with its cable pulled.
#![cfg(unix)]

use std::io::Write;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rigidtap::link::serial::{Event, Reader};
use serialport::{SerialPort, TTYPort};

use super::*;

/// Far more than it takes on the slowest machine.
const PATIENCE: Duration = Duration::from_secs(20);

fn next_event(reader: &mut Reader) -> Event {
    let start = Instant::now();
    loop {
        match reader.next_event() {
            Some(event) => return event,
            None if start.elapsed() > PATIENCE => panic!("nothing came in {PATIENCE:?}"),
            None => sleep(Duration::from_micros(200)),
        }
    }
}

fn collect(reader: &mut Reader, count: usize) -> Vec<Sample> {
    (0..count)
        .map(|_| match next_event(reader) {
            Event::Sample(sample) => sample,
            other => panic!("{other:?}"),
        })
        .collect()
}

#[test]
fn a_hole_at_10_khz_loses_nothing() {
    let machine = machine(1e-4);
    let simulated = simulated(&machine, ONE_HOLE);
    let (mut board, listener) = TTYPort::pair().unwrap();
    board.set_timeout(PATIENCE).unwrap();
    let mut reader = Reader::open(&listener.name().unwrap(), 921_600, Fastest::of(&machine)).unwrap();
    let frames = frames(&simulated.readings, 1e-4, 32);
    let sender = std::thread::spawn(move || {
        frames.iter().for_each(|frame| board.write_all(frame).unwrap());
        board
    });
    let samples = collect(&mut reader, simulated.readings.len());
    drop(sender.join().unwrap());
    let counters = reader.finish();
    assert!(counters.is_clean(), "{counters:?}");
    assert_same_error(&machine, &simulated, &monitored(settings(&machine), samples));
}

#[test]
fn the_cable_comes_back() {
    let machine = machine(1e-3);
    let readings: Vec<_> = (0..200).map(|k| Reading { spindle_counts: k * 100, z_counts: -k }).collect();
    let frames = frames(&readings, 1e-3, 32);
    let folder = tempfile::tempdir().unwrap();
    // The port's name stays, what is behind it changes: as a USB port's does.
    let port = folder.path().join("tty");
    let plug = |port: &Path| {
        let (mut board, listener) = TTYPort::pair().unwrap();
        board.set_timeout(PATIENCE).unwrap();
        let _ = std::fs::remove_file(port);
        std::os::unix::fs::symlink(listener.name().unwrap(), port).unwrap();
        (board, listener)
    };
    let (mut board, listener) = plug(&port);
    let mut reader = Reader::open(port.to_str().unwrap(), 921_600, Fastest::of(&machine)).unwrap();
    frames[..50].iter().for_each(|frame| board.write_all(frame).unwrap());
    let mut samples = collect(&mut reader, 50);
    drop((board, listener));
    std::fs::remove_file(&port).unwrap();
    assert_eq!(next_event(&mut reader), Event::Disconnected);
    let (mut board, _listener) = plug(&port);
    assert_eq!(next_event(&mut reader), Event::Reconnected);
    frames[150..].iter().for_each(|frame| board.write_all(frame).unwrap());
    samples.extend(collect(&mut reader, 50));
    let counters = reader.finish();
    assert_eq!((counters.lost, counters.reconnects, counters.accepted), (100, 1, 100), "{counters:?}");
    for sample in &samples {
        assert_eq!(sample.spindle_counts, readings[sample.k as usize].spindle_counts as f64);
    }
}
