//! Whole steps.

fn main() {}
