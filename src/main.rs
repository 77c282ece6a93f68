//! The `armctl` binary.

fn main() {}
