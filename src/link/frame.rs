//! One reading of both encoders on the wire; the [parent](super) documents the layout.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc};

/// The layout's version.
pub const VERSION: u8 = 1;
/// What ends a frame, and is nowhere inside.
pub const END: u8 = 0;
/// Longest frame on the line: 12 fixed bytes, two counts of 8, the CRC, the code byte of COBS and the end.
pub const MAX_ENCODED: usize = MAX_DECODED + 2;

const HEAD: usize = 12;
const CRC_BYTES: usize = 4;
const MAX_DECODED: usize = HEAD + 16 + CRC_BYTES;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// What the board says of itself in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status(pub u8);

impl Status {
    /// The first frame since power-up: counts and sequence start anew.
    pub const START: Self = Self(1);
    /// The spindle's encoder is faulty.
    pub const SPINDLE_FAULT: Self = Self(2);
    /// Z's encoder is faulty.
    pub const Z_FAULT: Self = Self(4);
    /// The board missed a reading before this one.
    pub const MISSED: Self = Self(8);

    /// True where this status has any bit of the other.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// A counter's reading and its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    bits: u8,
    raw: u64,
}

impl Count {
    /// The lower `bits` bits of a count, 2 to 63; none for other widths.
    ///
    /// ```
    /// use rigidtap::link::frame::Count;
    /// assert_eq!(Count::new(16, -1).unwrap().raw(), 65_535);
    /// assert_eq!(Count::new(16, -1).unwrap().signed(), -1);
    /// assert!(Count::new(64, 0).is_none());
    /// ```
    #[must_use]
    pub const fn new(bits: u8, value: i64) -> Option<Self> {
        if bits < 2 || bits > 63 {
            return None;
        }
        Some(Self { bits, raw: value.cast_unsigned() & ((1 << bits) - 1) })
    }

    /// The counter's width.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.bits
    }

    /// The counter as it is.
    #[must_use]
    pub const fn raw(self) -> u64 {
        self.raw
    }

    /// The same as a number in two's complement.
    #[must_use]
    pub const fn signed(self) -> i64 {
        let shift = 64 - self.bits as u32;
        (self.raw << shift).cast_signed() >> shift
    }

    const fn bytes(bits: u8) -> usize {
        bits.div_ceil(8) as usize
    }

    fn read(bits: u8, bytes: &[u8]) -> Option<Self> {
        let mut raw = [0; 8];
        raw.get_mut(..bytes.len())?.copy_from_slice(bytes);
        let raw = u64::from_le_bytes(raw);
        // Bits beyond the width say that the sender and its own width disagree.
        Self::new(bits, raw.cast_signed()).filter(|count| count.raw == raw)
    }
}

/// One reading of both encoders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// What the board says of itself.
    pub status: Status,
    /// Number of the reading, wraps.
    pub sequence: u32,
    /// Instant of the reading in µs, wraps.
    pub time_us: u32,
    /// The spindle's counter.
    pub spindle: Count,
    /// Z's counter; it falls into the hole.
    pub z: Count,
}

/// Why a piece between two ends is no frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// Its COBS encoding is broken.
    Encoding,
    /// So many bytes are no frame of its kind.
    Length {
        /// Bytes found.
        bytes: usize,
    },
    /// The CRC does not fit.
    Crc {
        /// As sent.
        sent: u32,
        /// Of what arrived.
        computed: u32,
    },
    /// A version that this receiver does not know.
    Version {
        /// As sent.
        version: u8,
    },
    /// A counter's width is not 2 to 63, or its count is wider.
    Width {
        /// The spindle's, as sent.
        spindle_bits: u8,
        /// Z's, as sent.
        z_bits: u8,
    },
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Encoding => write!(f, "broken COBS encoding"),
            Self::Length { bytes } => write!(f, "{bytes} bytes are no frame of its kind"),
            Self::Crc { sent, computed } => write!(f, "CRC {sent:08x} was sent, what arrived has {computed:08x}"),
            Self::Version { version } => write!(f, "version {version}: expected {VERSION}"),
            Self::Width { spindle_bits, z_bits } => {
                write!(f, "counters of {spindle_bits} and {z_bits} bits: expected 2 to 63, and counts within")
            }
        }
    }
}

impl core::error::Error for FrameError {}

impl Frame {
    /// Writes the frame as it goes on the line, its end included; returns its length.
    ///
    /// ```
    /// use rigidtap::link::frame::{Count, Frame, MAX_ENCODED, Status};
    /// let count = |value| Count::new(24, value).unwrap();
    /// let frame = Frame { status: Status(0), sequence: 7, time_us: 7000, spindle: count(-3), z: count(12) };
    /// let mut line = [0; MAX_ENCODED];
    /// let length = frame.encode(&mut line);
    /// assert_eq!(Frame::decode(&line[..length - 1]), Ok(frame));
    /// ```
    pub fn encode(&self, line: &mut [u8; MAX_ENCODED]) -> usize {
        let mut plain = [0; MAX_DECODED];
        let mut length = 0;
        let mut put = |bytes: &[u8]| {
            for (place, byte) in plain.iter_mut().skip(length).zip(bytes) {
                *place = *byte;
            }
            length += bytes.len();
        };
        put(&[VERSION, self.status.0, self.spindle.bits, self.z.bits]);
        put(&self.sequence.to_le_bytes());
        put(&self.time_us.to_le_bytes());
        for count in [self.spindle, self.z] {
            put(&count.raw.to_le_bytes()[..Count::bytes(count.bits)]);
        }
        let crc = CRC.checksum(&plain[..length]);
        plain[length..length + CRC_BYTES].copy_from_slice(&crc.to_le_bytes());
        let encoded = cobs::encode(&plain[..length + CRC_BYTES], line);
        line[encoded] = END;
        encoded + 1
    }

    /// Reads what stood between two ends.
    ///
    /// # Errors
    /// [`FrameError`]: nothing of it is used.
    pub fn decode(piece: &[u8]) -> Result<Self, FrameError> {
        let mut plain = [0; MAX_DECODED];
        if piece.len() >= MAX_ENCODED {
            return Err(FrameError::Length { bytes: piece.len() });
        }
        let bytes = cobs::decode(piece, &mut plain).map_err(|_| FrameError::Encoding)?.frame_size();
        let (body, crc) = plain.get(..bytes).and_then(<[u8]>::split_last_chunk).ok_or(FrameError::Length { bytes })?;
        let (sent, computed) = (u32::from_le_bytes(*crc), CRC.checksum(body));
        if sent != computed {
            return Err(FrameError::Crc { sent, computed });
        }
        let (head, counts) = body.split_first_chunk::<HEAD>().ok_or(FrameError::Length { bytes })?;
        let [version, status, spindle_bits, z_bits, s0, s1, s2, s3, t0, t1, t2, t3] = *head;
        if version != VERSION {
            return Err(FrameError::Version { version });
        }
        let width = FrameError::Width { spindle_bits, z_bits };
        let spindle_bytes = Count::bytes(spindle_bits);
        if counts.len() != spindle_bytes + Count::bytes(z_bits) {
            return Err(FrameError::Length { bytes });
        }
        let (spindle, z) = counts.split_at(spindle_bytes);
        Ok(Self {
            status: Status(status),
            sequence: u32::from_le_bytes([s0, s1, s2, s3]),
            time_us: u32::from_le_bytes([t0, t1, t2, t3]),
            spindle: Count::read(spindle_bits, spindle).ok_or(width)?,
            z: Count::read(z_bits, z).ok_or(width)?,
        })
    }
}
