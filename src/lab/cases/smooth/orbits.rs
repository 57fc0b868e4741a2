//! A12, A14 and A15: orbits.

use lamina2d::force::{Central, Forces, Spring};
use lamina2d::scene::{BodySpec, Scene};

use super::{at, only, particle, scene};
use crate::cases::Exact;
use crate::reference::kepler::eccentric_anomaly;

/// A12: μ = a = 1 from the periapsis: a year of 2π s.
fn kepler(about: &str, e: f64) -> Scene {
    let central = Some(Central { center: [0.0; 2], strength: 1.0 });
    let planet = particle([1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()], 2.0);
    scene(about, vec![planet], Forces { central, ..Forces::default() })
}

/// Eccentricity one half.
pub(super) fn kepler_half() -> Scene {
    kepler("an orbit of eccentricity 0.5", 0.5)
}

/// Eccentricity nine tenths.
pub(super) fn kepler_nine_tenths() -> Scene {
    kepler("an orbit of eccentricity 0.9", 0.9)
}

/// x = cos E − e, y = √(1 − e²) sin E, E − e sin E = t.
pub(super) fn kepler_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let e = 1.0 - only(scene).position[0];
    let (s, c) = eccentric_anomaly(t, e).sin_cos();
    at([c - e, (1.0 - e * e).sqrt() * s])
}

/// Mass of the Moon over that of Earth and Moon.
pub const ARENSTORF_MU: f64 = 0.012_277_471;
/// After so many seconds the orbit is closed.
pub const ARENSTORF_PERIOD_SECS: f64 = 17.065_216_560_157_964;

/// A14: a satellite between Earth and Moon in the frame that turns with them at 1 rad/s: the spring of −1 N/m is the
/// centrifugal force of 1 kg, the magnetic force of 2 kg/s its Coriolis force. The orbit closes.
///
/// Source: Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.0.
pub(super) fn arenstorf() -> Scene {
    let mu = ARENSTORF_MU;
    let forces = Forces {
        spring: Some(Spring { anchor: [0.0; 2], stiffness: -1.0 }),
        magnetic: Some(2.0),
        central: Some(Central { center: [-mu, 0.0], strength: 1.0 - mu }),
        companion: Some(Central { center: [1.0 - mu, 0.0], strength: mu }),
        ..Forces::default()
    };
    let satellite = particle([0.994, 0.0], [0.0, -2.001_585_106_379_082_4], 1.0);
    scene("a closed orbit between Earth and Moon", vec![satellite], forces)
}

/// A15: seven bodies of 1 to 7 kg, G = 1, that pass close to each other. Source: as [`arenstorf`], II.10.
pub(super) fn pleiades() -> Scene {
    const AT: [[f64; 2]; 7] =
        [[3.0, 3.0], [3.0, -3.0], [-1.0, 2.0], [-3.0, 0.0], [2.0, 0.0], [-2.0, -4.0], [2.0, 4.0]];
    const MOVING: [[f64; 2]; 7] =
        [[0.0; 2], [0.0; 2], [0.0; 2], [0.0, -1.25], [0.0, 1.0], [1.75, 0.0], [-1.5, 0.0]];
    // Points: they pass through each other.
    let star = |k: usize| BodySpec { collides_with: 0, ..particle(AT[k], MOVING[k], k as f64 + 1.0) };
    let forces = Forces { attraction: Some(1.0), ..Forces::default() };
    scene("seven bodies that attract each other", (0..7).map(star).collect(), forces)
}

/// A15: a star in the potential ½(x² + y²) + x²y − ⅓y³, of energy 0.13 below the escape at ⅙.
///
/// Source: Hénon and Heiles, Astron. J. 69 (1964) 73.
pub(super) fn henon_heiles() -> Scene {
    let forces = Forces {
        spring: Some(Spring { anchor: [0.0; 2], stiffness: 1.0 }),
        henon_heiles: Some(1.0),
        ..Forces::default()
    };
    scene("a star in the potential of Hénon and Heiles", vec![particle([0.0, 0.1], [0.5, 0.0], 1.0)], forces)
}
