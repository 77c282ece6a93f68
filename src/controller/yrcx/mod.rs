//! OMRON / Yamaha YRCX: remote commands and bit I/O over a fieldbus.
//!
//! Controller and master exchange images of 24 words, each in its own direction: 16 words for one remote command at a
//! time with its answer, 7 words of bits, one reserved word. Every fieldbus carries that image with its own addressing.
//! Source: "YRCX Remote I/O User's Manual", cited by chapter and section (the sections 4.x are in chapter 2). Where the
//! manual contradicts itself, the detail pages and the worked examples (`tests/data/yrcx-examples.json`) decide.

pub mod alarm;
pub mod answer;
pub mod bus;
pub mod changes;
pub mod codec;
pub mod describe;
pub mod image;
pub mod names;
pub mod order;
pub mod passing;
pub mod procedure;
pub mod register;
pub mod sequence;
pub mod session;
pub mod signal;
pub mod simulator;
pub mod table;
pub mod value;
