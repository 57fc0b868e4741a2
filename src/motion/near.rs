//! How near bodies are to be for a contact.

use crate::lanes::Real;

/// Gaps up to this share of a pair's length have touched: when a bounce is due, when a fast body is stopped.
pub(crate) const TOUCH: f64 = 1e-3;

/// A gap within which bodies count as near: some metres, and a share of the pair's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near<R> {
    /// Metres.
    pub metres: R,
    /// Of the pair's length, see [`Bodies::length`](crate::body::Bodies::length).
    pub share: R,
}

impl<R: Real> From<R> for Near<R> {
    fn from(metres: R) -> Self {
        Self { metres, share: R::ZERO }
    }
}
