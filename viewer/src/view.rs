//! What the canvas is to show and how: the choices a window remembers.

use serde::{Deserialize, Serialize};

/// What a body's colour says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
pub enum Colour {
    /// Circle, box or polygon.
    #[default]
    Shape,
    /// How fast its centroid moves.
    Speed,
    /// Which bodies hang together by contacts.
    Island,
    /// Awake or asleep.
    Sleep,
}

impl Colour {
    /// Every choice, in order.
    pub const ALL: [Self; 4] = [Self::Shape, Self::Speed, Self::Island, Self::Sleep];

    /// The name in the panel.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shape => "shape",
            Self::Speed => "speed",
            Self::Island => "island",
            Self::Sleep => "sleep",
        }
    }
}

/// Whose trails are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrailsOf {
    /// Nobody's.
    #[default]
    None,
    /// The selected body's.
    Selected,
    /// All dynamic bodies'.
    All,
}

impl TrailsOf {
    /// Every choice, in order.
    pub const ALL: [Self; 3] = [Self::None, Self::Selected, Self::All];

    /// The name in the panel.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "no trails",
            Self::Selected => "trail of selected",
            Self::All => "all trails",
        }
    }
}

/// Where the second recording is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Arrangement {
    /// Beside the first.
    #[default]
    SideBySide,
    /// Over the first, with lines from each body to its twin.
    Overlaid,
}

/// Longest trail, frames.
pub const MOST_TRAIL: usize = 120;

/// Everything that can be switched on the canvas.
#[expect(clippy::struct_excessive_bools, reason = "each is one checkbox")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct View {
    /// What a body's colour says.
    pub colour: Colour,
    /// Grid with metres at its lines.
    pub grid: bool,
    /// Contact points.
    pub contacts: bool,
    /// Unit normals from A to B, at each point.
    pub normals: bool,
    /// The points of A and of B that a contact's separation lies between.
    pub depths: bool,
    /// Normal impulses, as lines along the normal.
    pub impulses: bool,
    /// Length of an impulse: metres per N·s, times that of [`View::impulse_scale`] 1.
    pub impulse_scale: f32,
    /// Joints.
    pub joints: bool,
    /// Bounding circles.
    pub circles: bool,
    /// Velocities, a tenth of a second long.
    pub velocities: bool,
    /// Whose trails.
    pub trails: TrailsOf,
    /// Length of a trail, frames.
    pub trail_frames: usize,
    /// Does the camera follow the selected body?
    pub follow: bool,
    /// Where the second recording is drawn.
    pub arrangement: Arrangement,
    /// Dark, not light.
    pub dark: bool,
    /// Points per point: 1 as the system has it.
    pub ui_scale: f32,
}

impl Default for View {
    fn default() -> Self {
        Self {
            colour: Colour::Shape,
            grid: true,
            contacts: false,
            normals: false,
            depths: false,
            impulses: false,
            impulse_scale: 1.0,
            joints: true,
            circles: false,
            velocities: false,
            trails: TrailsOf::None,
            trail_frames: 60,
            follow: false,
            arrangement: Arrangement::SideBySide,
            dark: true,
            ui_scale: 1.0,
        }
    }
}
