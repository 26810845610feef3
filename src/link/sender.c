/* One reading of both encoders as bytes for the serial line; layout and test vectors: README.md beside this file.
 * No dependencies, no heap. Licence as the crate's. */
#include <stddef.h>
#include <stdint.h>

#define RIGIDTAP_VERSION 1
#define RIGIDTAP_FRAME_MAX 34

enum rigidtap_status {
    RIGIDTAP_START = 1,         /* first frame since power-up */
    RIGIDTAP_SPINDLE_FAULT = 2,
    RIGIDTAP_Z_FAULT = 4,
    RIGIDTAP_MISSED = 8         /* a reading before this one was not sent */
};

struct rigidtap_frame {
    uint8_t status;
    uint8_t spindle_bits;       /* width of the counter, 2 to 63 */
    uint8_t z_bits;
    uint32_t sequence;
    uint32_t time_us;
    uint64_t spindle;           /* the counter as it is; bits beyond its width are ignored */
    uint64_t z;
};

/* Bit by bit: 24 bytes take some 2000 cycles. A table of 256 words makes it ten times as fast. */
static uint32_t rigidtap_crc32(const uint8_t *bytes, size_t length)
{
    uint32_t crc = 0xFFFFFFFFu;
    while (length--) {
        crc ^= *bytes++;
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    return ~crc;
}

static uint8_t *rigidtap_put(uint8_t *to, uint64_t value, int bytes)
{
    while (bytes--) {
        *to++ = (uint8_t)value;
        value >>= 8;
    }
    return to;
}

static uint8_t *rigidtap_put_count(uint8_t *to, uint64_t value, int bits)
{
    return rigidtap_put(to, value & ((UINT64_C(1) << bits) - 1), (bits + 7) / 8);
}

/* Writes the frame with its end; returns its length, RIGIDTAP_FRAME_MAX at most. */
size_t rigidtap_encode(const struct rigidtap_frame *frame, uint8_t *line)
{
    uint8_t plain[RIGIDTAP_FRAME_MAX];
    uint8_t *end = plain;
    *end++ = RIGIDTAP_VERSION;
    *end++ = frame->status;
    *end++ = frame->spindle_bits;
    *end++ = frame->z_bits;
    end = rigidtap_put(end, frame->sequence, 4);
    end = rigidtap_put(end, frame->time_us, 4);
    end = rigidtap_put_count(end, frame->spindle, frame->spindle_bits);
    end = rigidtap_put_count(end, frame->z, frame->z_bits);
    end = rigidtap_put(end, rigidtap_crc32(plain, (size_t)(end - plain)), 4);

    /* COBS: each zero is replaced by the distance to the next one. */
    uint8_t *code = line, *to = line + 1;
    for (const uint8_t *from = plain; from < end; from++) {
        if (*from) {
            *to++ = *from;
        } else {
            *code = (uint8_t)(to - code);
            code = to++;
        }
    }
    *code = (uint8_t)(to - code);
    *to++ = 0;
    return (size_t)(to - line);
}
