//! Bytes of a record that outlives the power: numbers with their low bytes first, and the sum behind them.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// It takes no table: a record is read once after a restart, and written outside the period.
static CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// CRC-32 (ISO-HDLC).
pub(crate) fn sum(bytes: &[u8]) -> u32 {
    CRC.checksum(bytes)
}

/// Bytes in their order; zeros once they have ended.
pub(crate) struct Reader<'a>(core::slice::Iter<'a, u8>);

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(bytes.iter())
    }

    pub(crate) fn take<const BYTES: usize>(&mut self) -> [u8; BYTES] {
        let mut taken = [0; BYTES];
        for (place, byte) in taken.iter_mut().zip(self.0.by_ref()) {
            *place = *byte;
        }
        taken
    }

    pub(crate) fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }

    /// Bytes that are left.
    pub(crate) fn left(&self) -> usize {
        self.0.len()
    }
}

/// Puts bytes into a buffer of the caller's, one behind the other; what has no room is counted and left out.
pub(crate) struct Writer<'a> {
    bytes: &'a mut [u8],
    written: usize,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(bytes: &'a mut [u8]) -> Self {
        Self { bytes, written: 0 }
    }

    pub(crate) fn put(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if let Some(place) = self.bytes.get_mut(self.written) {
                *place = *byte;
            }
            self.written = self.written.saturating_add(1);
        }
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.put(&value.to_le_bytes());
    }

    /// Puts the sum of all bytes so far, and returns how many there are then.
    pub(crate) fn end(mut self) -> usize {
        let sum = sum(self.bytes.get(..self.written).unwrap_or_default());
        self.put(&sum.to_le_bytes());
        self.written
    }
}

#[cfg(test)]
mod tests {
    use super::{Reader, Writer, sum};

    #[test]
    fn what_was_put_is_taken() {
        let mut bytes = [0; 16];
        let mut writer = Writer::new(&mut bytes);
        writer.put(b"RT");
        writer.f64(-1.5);
        assert_eq!(writer.end(), 14);
        let mut reader = Reader::new(&bytes);
        assert_eq!((reader.take(), reader.f64(), reader.left()), (*b"RT", -1.5, 6));
        assert_eq!(u32::from_le_bytes(reader.take()), sum(&bytes[..10]));
        // The check value of this CRC, as its catalogue has it.
        assert_eq!(sum(b"123456789"), 0xcbf4_3926);
        assert_eq!((reader.take::<2>(), reader.take::<2>()), ([0, 0], [0, 0]));
    }

    #[test]
    fn a_buffer_that_is_too_small_is_counted_out() {
        let mut bytes = [0; 3];
        let mut writer = Writer::new(&mut bytes);
        writer.f64(1.0);
        assert_eq!(writer.end(), 12);
    }
}
