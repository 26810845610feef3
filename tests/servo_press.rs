//! The servo press of the fourth paper.

use rigidtap::control::coupling::SliderCrank;
use rigidtap::control::profile::press::{PressStroke, PressTask};

fn task() -> PressTask {
    PressTask {
        slide: SliderCrank::new(450.0, 1200.0).unwrap(),
        closing_rev: 66.0 / 360.0,
        forming_start_rev: 131.5 / 360.0,
        forming_end_rev: 190.0 / 360.0,
        opening_rev: 294.0 / 360.0,
        forming_rev_per_s: 6.7 / 60.0,
        transfer_s: 2.0,
        slide_mm_per_s2: 3500.0,
    }
}

#[test]
fn rate() {
    let t = std::time::Instant::now();
    let stroke = task().plan().unwrap();
    eprintln!(
        "{:?} {}/min {:?} {:?} {:?} w1 {}",
        t.elapsed(),
        60.0 / stroke.profile.duration_s(),
        stroke.key_points_s,
        stroke.jerks_rev_per_s3.map(|j| j * 60.0),
        stroke.profile.segments().iter().map(|s| (s.duration_s, s.start.velocity * 60.0)).collect::<Vec<_>>(),
        stroke.profile.end().velocity * 60.0
    );
    let _: PressStroke = stroke;
}
