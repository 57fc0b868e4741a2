//! Scenes with a reference beside them: what the laboratory measures errors and limits by.
//!
//! [`smooth`] holds those of table A, [`contact`] those of table B, [`stress`] those of table T; [`exact()`] knows where the
//! bodies of some of them must be, and [`case_error`] how far they are from there. [`SCENES`] are these and the
//! engine's own, [`by_name`] and [`load`] find them.

pub mod contact;
mod error;
mod exact;
pub mod smooth;
pub mod stress;

use lamina2d::scene::named::{SceneInfo, scene};
use lamina2d::scene::{self, BodyKind, BodySpec, Scene, SceneError, ShapeSpec};
use lamina2d::settings::Settings;

pub use error::{case_error, error_of};
pub use exact::{Exact, exact};
pub(crate) use exact::{Form, downhill, mass, moved, radius};

/// The engine's scenes and those of the tables.
pub const SCENES: &[SceneInfo] = &joined::<
    { scene::SCENES.len() + smooth::SCENES.len() + contact::SCENES.len() + stress::SCENES.len() },
>([scene::SCENES, smooth::SCENES, contact::SCENES, stress::SCENES]);

/// Four tables as one.
const fn joined<const N: usize>(tables: [&[SceneInfo]; 4]) -> [SceneInfo; N] {
    let mut all = [tables[0][0]; N];
    let (mut table, mut before, mut k) = (0, 0, 0);
    while k < N {
        if k - before == tables[table].len() {
            before = k;
            table += 1;
        }
        all[k] = tables[table][k - before];
        k += 1;
    }
    all
}

/// The scene `name` or `name/parameter`, of the engine or of a table; `bodies` overrides the parameter.
///
/// # Errors
/// Those of [`lamina2d::scene::by_name`].
pub fn by_name(name: &str, bodies: Option<usize>, seed: u64) -> Result<Scene, SceneError> {
    scene::by_name_in(SCENES, name, bodies, seed)
}

/// The scene that `given` names, with the settings it asks for: the path of a scene file, or a name.
///
/// # Errors
/// Those of [`lamina2d::scene::load`].
pub fn load(given: &str, bodies: Option<usize>, seed: u64) -> Result<(Scene, Settings), SceneError> {
    scene::load_in(SCENES, given, bodies, seed)
}
