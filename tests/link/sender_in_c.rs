//! The sender for a microcontroller, and the test vectors of the documentation, against the receiver's own encoder.

use std::process::Command;

use rigidtap::link::frame::{Count, Frame, MAX_ENCODED, Status};

fn vectors() -> [Frame; 4] {
    let frame = |status, (spindle_bits, spindle), (z_bits, z), sequence, time_us| Frame {
        status: Status(status),
        sequence,
        time_us,
        spindle: Count::new(spindle_bits, spindle).unwrap(),
        z: Count::new(z_bits, z).unwrap(),
    };
    [
        frame(1, (32, 0), (32, 0), 0, 0),
        frame(0, (32, 16_384), (32, -10_000), 1, 1000),
        frame(8, (16, -1), (24, -2), u32::MAX, u32::MAX),
        frame(0, (63, (1 << 62) - 1), (12, 5), 258, 65_536),
    ]
}

fn hexadecimal(frame: &Frame) -> String {
    let mut line = [0; MAX_ENCODED];
    let length = frame.encode(&mut line);
    assert_eq!(Frame::decode(&line[..length - 1]), Ok(*frame));
    line[..length].iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn the_documented_vectors_are_what_is_sent() {
    let page = include_str!("../../src/link/README.md");
    for frame in vectors() {
        let bytes = hexadecimal(&frame);
        assert!(page.contains(&format!("`{bytes}`")), "src/link/README.md lacks {bytes}");
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the one way to say that a check was not run")]
fn the_sender_in_c_sends_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("vectors.c"), folder.path().join("vectors"));
    let sender = concat!(env!("CARGO_MANIFEST_DIR"), "/src/link/sender.c");
    let mut text = format!("#include <stdio.h>\n#include \"{sender}\"\n");
    text += "static void show(struct rigidtap_frame frame) {\n    uint8_t line[RIGIDTAP_FRAME_MAX];\n    \
             size_t length = rigidtap_encode(&frame, line);\n    \
             for (size_t i = 0; i < length; i++) printf(\"%02x\", line[i]);\n    puts(\"\");\n}\nint main(void) {\n";
    for frame in vectors() {
        // Signs extended, as a microcontroller's own integers are.
        text += &format!(
            "    show((struct rigidtap_frame){{ {}, {}, {}, {}u, {}u, {}ull, {}ull }});\n",
            frame.status.0,
            frame.spindle.bits(),
            frame.z.bits(),
            frame.sequence,
            frame.time_us,
            frame.spindle.signed().cast_unsigned(),
            frame.z.signed().cast_unsigned(),
        );
    }
    text += "    return 0;\n}\n";
    std::fs::write(&source, text).unwrap();
    let built =
        Command::new("cc").args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o"]).args([&program, &source]).output();
    let Ok(built) = built else {
        println!("not run: there is no C compiler `cc` here");
        return;
    };
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let sent = Command::new(&program).output().unwrap();
    let due: String = vectors().iter().map(|frame| hexadecimal(frame) + "\n").collect();
    assert_eq!(String::from_utf8_lossy(&sent.stdout), due);
}
