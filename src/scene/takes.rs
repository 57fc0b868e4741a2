//! What a scene's parameter means.

use super::named::MAX_BODIES;

/// What a scene's parameter after the slash or `--bodies` means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Nothing: the scene is what it is.
    Nothing,
    /// A number of bodies.
    Bodies,
    /// A number of pairs of bodies.
    Pairs,
    /// A number of boxes on top of each other.
    Height,
    /// A number of boxes side by side in a pyramid's lowest row.
    Base,
    /// A number of pyramids of 55 boxes.
    Pyramids,
    /// A mass, in masses of the body that carries it.
    Ratio,
    /// A number of storeys of a house of cards.
    Levels,
    /// A number of links of a chain.
    Links,
    /// A number of bodies along a side of a square.
    Side,
}

impl Takes {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "none",
            Self::Bodies => "bodies",
            Self::Pairs => "pairs",
            Self::Height => "boxes",
            Self::Base => "base",
            Self::Pyramids => "pyramids",
            Self::Ratio => "ratio",
            Self::Levels => "levels",
            Self::Links => "links",
            Self::Side => "side",
        }
    }

    /// The largest it may be: where it is not itself a number of bodies, what makes [`MAX_BODIES`] of them.
    pub const fn most(self) -> usize {
        match self {
            Self::Nothing | Self::Bodies | Self::Pairs | Self::Height | Self::Ratio | Self::Links => {
                MAX_BODIES
            }
            Self::Side => 1000,
            Self::Base => 1413,
            Self::Pyramids => 18_000,
            Self::Levels => 816,
        }
    }

    /// What a scene takes after the slash, in words, and what it says to a number out of range.
    pub(super) const fn wanted(self) -> [&'static str; 2] {
        match self {
            Self::Nothing => ["nothing", "cannot be chosen"],
            Self::Bodies => ["a number of bodies (1 to 1000000)", "must be 1 to 1000000"],
            Self::Pairs => ["a number of pairs (1 to 1000000)", "must be 1 to 1000000"],
            Self::Height => ["a number of boxes (1 to 1000000)", "must be 1 to 1000000"],
            Self::Base => ["a number of boxes in the lowest row (1 to 1413)", "must be 1 to 1413"],
            Self::Pyramids => ["a number of pyramids (1 to 18000)", "must be 1 to 18000"],
            Self::Ratio => ["a ratio of masses (1 to 1000000)", "must be 1 to 1000000"],
            Self::Links => ["a number of links (1 to 1000000)", "must be 1 to 1000000"],
            Self::Side => ["a number of bodies along its side (1 to 1000)", "must be 1 to 1000"],
            Self::Levels => ["a number of levels (1 to 816)", "must be 1 to 816"],
        }
    }
}
