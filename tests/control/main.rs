//! The control core against encoders and machines that a test makes up: strokes, stops, blocks, couplings, and how well
//! compensation `full` holds a thread.

mod controlled_stop;
mod hold;
mod multi_axis;
mod servo_press;
mod stack;
mod synchronizer;
mod tapping_block;
mod thread;
mod zero_heap;
