//! Each stage's kernel alone.

fn main() {}
