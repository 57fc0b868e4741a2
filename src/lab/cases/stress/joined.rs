//! What joints must hold.

use lamina2d::scene::{Scene, jointed};

/// T9, T10: a chain of `links` level at first, and a weight of `ratio` links at its end.
pub fn heavy_chain(links: usize, ratio: f64) -> Scene {
    jointed::chain(links, Some(ratio))
}

/// T24: `side` × `side` discs, each hinged to its neighbours; the upper corners are static.
pub fn net(side: f64) -> Scene {
    jointed::joint_grid(side as usize)
}
