//! From a frame's last byte to the alarm line: a board on a pseudo-terminal in real time, `rigidtap monitor --serial`
//! as a process of its own, its standard output read here. `cargo bench --bench link_latency`.

#[cfg(unix)]
fn main() -> std::io::Result<()> {
    measured::main()
}

#[cfg(not(unix))]
fn main() {}

#[cfg(unix)]
#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
mod measured {
    use std::io::{self, BufRead, BufReader, Write};
    use std::process::{Command, Stdio};
    use std::sync::mpsc;
    use std::time::{Duration, Instant};

    use rigidtap::link::board::{Encoder, Reading};
    use rigidtap::link::frame::MAX_ENCODED;
    use serialport::{SerialPort, TTYPort};

    const HOLES: usize = 300;
    const PERIOD: Duration = Duration::from_millis(1);
    /// Periods of a hole: rest, stroke in, stroke out.
    const REST: u32 = 60;
    const STROKE: u32 = 100;
    /// Z slips here, far out of the tolerance.
    const SLIP: u32 = REST + 70;

    /// A stroke of 4 rev with constant acceleration to its middle, and back; where the slip is, Z is 0.2 mm ahead.
    fn reading(period: u32) -> Reading {
        let way = |share: f64| if share < 0.5 { 2.0 * share * share } else { 1.0 - 2.0 * (1.0 - share).powi(2) };
        let since = period.saturating_sub(REST);
        let share = |periods: u32| f64::from(periods.min(STROKE)) / f64::from(STROKE);
        let rev = 4.0 * (way(share(since)) - way(share(since.saturating_sub(STROKE))));
        let slip_mm = if (SLIP..REST + STROKE).contains(&period) { 0.2 } else { 0.0 };
        Reading {
            spindle_counts: (rev * 16_384.0).round() as i64,
            z_counts: (-(rev + slip_mm) * 10_000.0).round() as i64,
        }
    }

    pub(super) fn main() -> io::Result<()> {
        let (mut board, listener) = TTYPort::pair()?;
        let port = listener.name().unwrap_or_default();
        let holes = HOLES.to_string();
        let mut monitor = Command::new(env!("CARGO_BIN_EXE_rigidtap"))
            .args(["monitor", "--serial", &port, "--pitch", "1", "--holes", &holes, "-q"])
            .stdout(Stdio::piped())
            .spawn()?;
        let lines = BufReader::new(monitor.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?);
        let (alarms, alarmed) = mpsc::channel();
        let listener_thread = std::thread::spawn(move || {
            for line in lines.lines().map_while(Result::ok) {
                if line.starts_with("ALARM") && alarms.send(Instant::now()).is_err() {
                    return;
                }
            }
        });
        std::thread::sleep(Duration::from_millis(300));
        let mut encoder = Encoder::new(PERIOD.as_secs_f64(), 32);
        let mut latencies = Vec::new();
        let start = Instant::now();
        let mut number = 0;
        'holes: for _ in 0..HOLES {
            for period in 0..REST + 2 * STROKE + REST {
                if let Some(wait) = (PERIOD * number).checked_sub(start.elapsed()) {
                    std::thread::sleep(wait);
                }
                number += 1;
                let mut line = [0; MAX_ENCODED];
                let length = encoder.encode(reading(period), &mut line);
                // The monitor ends with its last hole.
                if board.write_all(&line[..length]).is_err() {
                    break 'holes;
                }
                if period == SLIP {
                    let sent = Instant::now();
                    match alarmed.recv_timeout(Duration::from_secs(2)) {
                        Ok(heard) => latencies.push(heard.saturating_duration_since(sent)),
                        Err(_) => println!("no alarm within 2 s"),
                    }
                }
            }
        }
        drop(board);
        monitor.kill()?;
        monitor.wait()?;
        drop(listener);
        let _ = listener_thread.join();
        latencies.sort();
        let at = |share: f64| latencies.get((share * (latencies.len() - 1) as f64).round() as usize);
        println!("{} alarms, last byte to alarm line: ", latencies.len());
        for (name, share) in [("median", 0.5), ("99th percentile", 0.99), ("greatest", 1.0)] {
            println!("  {name}: {:?}", at(share).copied().unwrap_or_default());
        }
        Ok(())
    }
}
