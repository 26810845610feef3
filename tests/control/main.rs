//! The control core against encoders and machines that a test makes up: strokes, stops, blocks, couplings, and how well
//! compensation `full` holds a thread.

mod controlled_stop;
mod echo;
mod hold;
mod interrupted_again;
mod multi_axis;
mod random_faults;
mod servo_press;
mod stack;
mod synchronizer;
mod tapping_block;
mod thread;
mod zero_heap;
