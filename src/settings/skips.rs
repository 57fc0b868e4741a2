//! Which work is left out where a scene does not need it.

use serde::{Deserialize, Serialize};

use super::{Skip, UnknownName};

/// A set of [`Skip`]s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Skips(u32);

impl Skips {
    /// All of them: the default.
    pub const ALL: Self = Self((1 << Skip::ALL.len()) - 1);
    /// Those that change no bit of a result.
    pub const EXACT: Self = Self::ALL.without(Skip::ManifoldReuse);
    /// None: every stage does all its work.
    pub const NONE: Self = Self(0);

    /// Is `skip` on?
    pub const fn has(self, skip: Skip) -> bool {
        self.0 & (1 << skip as u32) != 0
    }
    /// The set with `skip` on.
    #[must_use]
    pub const fn with(self, skip: Skip) -> Self {
        Self(self.0 | 1 << skip as u32)
    }
    /// The set with `skip` off.
    #[must_use]
    pub const fn without(self, skip: Skip) -> Self {
        Self(self.0 & !(1 << skip as u32))
    }
}

impl std::str::FromStr for Skips {
    type Err = UnknownName;
    /// `all`, `none`, `exact` (all that change no bit), or names separated by commas.
    fn from_str(given: &str) -> Result<Self, UnknownName> {
        match given {
            "all" => Ok(Self::ALL),
            "none" => Ok(Self::NONE),
            "exact" => Ok(Self::EXACT),
            list => list.split(',').try_fold(Self::NONE, |set, name| Ok(set.with(name.trim().parse()?))),
        }
    }
}

impl TryFrom<String> for Skips {
    type Error = UnknownName;
    fn try_from(given: String) -> Result<Self, UnknownName> {
        given.parse()
    }
}

impl From<Skips> for String {
    fn from(skips: Skips) -> Self {
        skips.to_string()
    }
}

impl std::fmt::Display for Skips {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::ALL => f.write_str("all"),
            Self::NONE => f.write_str("none"),
            Self::EXACT => f.write_str("exact"),
            some => {
                let names: Vec<_> = Skip::ALL.iter().filter(|s| some.has(**s)).map(|s| s.name()).collect();
                f.write_str(&names.join(","))
            }
        }
    }
}
