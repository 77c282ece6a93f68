//! OMRON / Yamaha YRCX: remote commands and bit I/O over a fieldbus.
//!
//! Controller and master exchange images of 24 words in each direction: 16 words for one remote command or its answer,
//! 7 words of bits, one reserved word. Each fieldbus addresses the image in its own way. Source: "YRCX Remote I/O
//! User's Manual", by chapter and section (sections 4.x are in chapter 2). If the manual contradicts itself, detail
//! pages and worked examples (`tests/data/yrcx-examples.json`) have priority.

pub mod alarm;
pub mod answer;
pub mod bus;
pub mod codec;
pub mod describe;
pub mod image;
pub mod image_changes;
pub mod names;
pub mod order;
pub mod procedure;
pub mod read_only_filter;
pub mod recording;
pub mod register;
pub mod sequence;
pub mod session;
pub mod signal;
pub mod simulator;
pub mod table;
pub mod value;
