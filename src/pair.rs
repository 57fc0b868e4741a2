//! Reading a pair of numbers from a file: exactly two. Serde's own arrays take the first two of any number
//! where the format lets them (TOML does), so that a third coordinate would be lost without a word.

use serde::{Deserialize, Deserializer};

/// Two numbers, x and y.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(crate) struct Pair(pub(crate) [f64; 2]);

impl TryFrom<Vec<f64>> for Pair {
    type Error = String;
    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        match numbers[..] {
            [x, y] => Ok(Self([x, y])),
            _ => Err(format!("expected two numbers [x, y], got {}", numbers.len())),
        }
    }
}

/// For fields that must be there, or have a default.
pub(crate) fn required<'de, D: Deserializer<'de>>(source: D) -> Result<[f64; 2], D::Error> {
    Pair::deserialize(source).map(|pair| pair.0)
}

/// For fields that may be left out; they also need `#[serde(default)]`.
pub(crate) fn optional<'de, D: Deserializer<'de>>(source: D) -> Result<Option<[f64; 2]>, D::Error> {
    required(source).map(Some)
}
