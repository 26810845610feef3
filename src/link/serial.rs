//! A serial port, read by a thread of its own into a ring buffer. A pulled cable is waited for.

use std::io::{self, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam::sync::{Parker, Unparker};
use ringbuf::HeapRb;
use ringbuf::traits::{Consumer, Producer, Split};

use super::receiver::{Counters, Fastest, Receiver};
use super::sample::Sample;

/// Samples that the buffer holds: some seconds at 10 kHz.
const CAPACITY: usize = 1 << 16;
/// How long a read waits before it looks whether anyone still listens.
const READ_TIMEOUT: Duration = Duration::from_millis(20);
/// How long after a pulled cable the port is tried again.
const RETRY: Duration = Duration::from_millis(100);

/// What the reader hands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A reading.
    Sample(Sample),
    /// The port is gone.
    Disconnected,
    /// The port is back.
    Reconnected,
}

/// Reads a port until dropped.
pub struct Reader {
    events: ringbuf::HeapCons<Event>,
    news: Parker,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Counters>>,
}

impl Reader {
    /// Opens a port and starts to read.
    ///
    /// # Errors
    /// Where the port cannot be opened at first; later it is waited for.
    pub fn open(path: &str, baud: u32, fastest: Fastest) -> io::Result<Self> {
        let port = connect(path, baud)?;
        let (producer, events) = HeapRb::new(CAPACITY).split();
        let (stop, news) = (Arc::new(AtomicBool::new(false)), Parker::new());
        let line = Line {
            path: path.to_owned(),
            baud,
            stop: Arc::clone(&stop),
            receiver: Receiver::new(fastest),
            events: producer,
            listener: news.unparker().clone(),
        };
        let thread = std::thread::Builder::new().name("serial".into()).spawn(move || line.read(port))?;
        Ok(Self { events, news, stop, thread: Some(thread) })
    }

    /// The next event, if there is one yet.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.try_pop()
    }

    /// Waits until something has come since the last wait, at most so long.
    pub fn wait(&self, timeout: Duration) {
        self.news.park_timeout(timeout);
    }

    /// Stops reading; what went over the line.
    #[must_use]
    pub fn finish(mut self) -> Counters {
        self.stop.store(true, Ordering::Relaxed);
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(counters)) => counters,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
            None => Counters::default(),
        }
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn connect(path: &str, baud: u32) -> io::Result<Box<dyn serialport::SerialPort>> {
    let port = serialport::new(path, baud).timeout(READ_TIMEOUT).open()?;
    // What lies there from before is of unknown age.
    port.clear(serialport::ClearBuffer::Input)?;
    Ok(port)
}

/// The reading thread's own.
struct Line {
    path: String,
    baud: u32,
    stop: Arc<AtomicBool>,
    receiver: Receiver,
    events: ringbuf::HeapProd<Event>,
    /// Wakes whoever waits for events.
    listener: Unparker,
}

impl Line {
    fn read(mut self, port: Box<dyn serialport::SerialPort>) -> Counters {
        let clock = Instant::now();
        let mut bytes = [0; 4096];
        let mut port = Some(port);
        while !self.stop.load(Ordering::Relaxed) {
            let Some(open) = port.as_mut() else {
                std::thread::sleep(RETRY);
                port = connect(&self.path, self.baud).ok();
                if port.is_some() {
                    self.receiver.reconnected();
                    self.tell(Event::Reconnected);
                }
                continue;
            };
            match open.read(&mut bytes) {
                // A port that is ready and has nothing is gone.
                Ok(0) => port = None,
                Ok(length) => self.hand_on(&bytes[..length], clock.elapsed().as_secs_f64()),
                Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::Interrupted) => {}
                Err(_) => port = None,
            }
            if port.is_none() {
                self.tell(Event::Disconnected);
            }
        }
        self.receiver.counters()
    }

    /// A full buffer loses the word, not the gap: the receiver marks that by itself.
    fn tell(&mut self, event: Event) {
        let _ = self.events.try_push(event);
        self.listener.unpark();
    }

    fn hand_on(&mut self, bytes: &[u8], arrived_s: f64) {
        let Self { receiver, events, listener, .. } = self;
        let mut overrun = false;
        // Byte ranges are received whole, so that an overrun is marked on the sample after it at the latest.
        receiver.receive(bytes, arrived_s, &mut |sample| {
            overrun |= events.try_push(Event::Sample(sample)).is_err();
        });
        listener.unpark();
        if overrun {
            receiver.overrun();
        }
    }
}
