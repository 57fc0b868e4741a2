//! What must be so of every named scene, whatever table it stands in.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina2d::scene::{SceneInfo, by_name_in};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::simulate;

/// Every scene, at its default and at small parameters, in both precisions.
pub(crate) fn are_taken_in_and_overlap_nowhere(scenes: &[SceneInfo]) {
    for info in scenes {
        let small = [1, 2, 3, 5, 8, 13].into_iter().filter(|_| info.takes.name() != "none").map(Some);
        for parameter in std::iter::once(None).chain(small) {
            let scene = by_name_in(scenes, info.name, parameter, 7).unwrap();
            assert!(scene.name.starts_with(info.name), "{} is not {}", scene.name, info.name);
            for settings in [Settings::default(), Settings::default().with_precision(Precision::F64)] {
                let world = simulate(&scene, settings).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
                assert_eq!(world.bodies(), scene.bodies.len());
                // Bodies that begin in each other are what these are about.
                if info.name.starts_with("t14_") {
                    continue;
                }
                let overlap = world.penetration().max;
                assert!(overlap <= 1e-4, "{} begins with an overlap of {overlap} m", scene.name);
            }
        }
    }
}

/// A seed changes the bodies of scenes that draw numbers, and of no others.
pub(crate) fn differ_by_seed_where_random(scenes: &[SceneInfo]) {
    for info in scenes {
        let scene = |seed| by_name_in(scenes, info.name, None, seed).unwrap();
        assert_eq!(scene(3), scene(3), "{}", info.name);
        let random = scene(3).bodies != scene(4).bodies;
        assert_eq!(random, scene(3).seed == 3, "{}", info.name);
    }
}
