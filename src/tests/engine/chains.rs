//! Chains, bridges and nets: how far they stretch, the shapes statics gives them, and what energy they gain.

use lamina2d::joint::JointKind;
use lamina2d::scene::{by_name, jointed};
use lamina2d::settings::{Settings, Solver};

use crate::EVERY;
use crate::shared_joints::{GRAVITY, advance, energy, gaps, in_f64};
use crate::shared_motion::start;

/// A weight of 100 links on 17 links: hanging at rest, and let go level.
#[test]
fn a_chain_with_a_heavy_end_stretches_little_and_substeps_make_it_less() {
    for substeps in [4, 16] {
        let settings = Settings { substeps, ..Settings::default() };
        let mut hanging = jointed::chain(17, Some(100.0));
        hanging.forces.gravity = Some([GRAVITY, 0.0]);
        for (what, scene) in [("hanging", hanging), ("swinging", jointed::chain(17, Some(100.0)))] {
            let mut world = start(&scene, settings);
            let begin = energy(&*world);
            let fall = 8.5 * GRAVITY / world.body(19).expect("the weight").inv_mass;
            let (mut most, mut most_gained) = ([0.0f64; 2], 0.0f64);
            for _ in 0..600 {
                advance(&mut *world, 1);
                let [worst, sum] = gaps(&*world);
                most = [worst.max(most[0]), sum.max(most[1])];
                // Of the joules its fall frees.
                let gained = (energy(&*world) - begin) / fall;
                most_gained = gained.max(most_gained);
            }
            let now = gaps(&*world)[1] / 8.5;
            println!(
                "chain 17, 100:1, {what}, {substeps} substeps: stretched by {:.3} % at most, {:.3} % in the end, \
                 {:.2e} m in one joint",
                100.0 * most[1] / 8.5,
                100.0 * now,
                most[0]
            );
            println!("chain 17, {what}, {substeps}: gained {most_gained:.2e} of its fall");
            let bounds = if substeps == 4 { [0.03, 1e-3] } else { [0.01, 1e-3] };
            assert!(most_gained < bounds[1], "{most_gained} of {fall} J from nothing");
            // Solved directly; by visits it was up to 12 and 2 % while it swings, and 2.5 and 0.2 % where it hangs.
            assert_eq!(world.counts().direct_joints, 18);
            assert!(most[1] / 8.5 < bounds[0] && (what == "swinging" || now < 1e-6), "{now} {most:?}");
        }
    }
}

/// The energy that `steps` of a chain that is let go level gain at most, over what its fall frees; what it has lost
/// after 100 steps; its greatest stretch.
fn swing(links: usize, weight: f64, substeps: u32, steps: usize) -> [f64; 3] {
    let settings = Settings { substeps, ..Settings::default() };
    let mut world = start(&jointed::chain(links, Some(weight)), settings);
    let begin = energy(&*world);
    let length = links as f64 / 2.0;
    let fall = length * GRAVITY / world.body(links + 2).expect("the weight").inv_mass;
    let (mut gained, mut stretch, mut lost) = (0.0f64, 0.0f64, 0.0);
    for step in 1..=steps {
        advance(&mut *world, 1);
        stretch = stretch.max(gaps(&*world)[1] / length);
        let now = (energy(&*world) - begin) / fall;
        gained = gained.max(now);
        if step == 100 {
            lost = -now;
        }
    }
    println!(
        "chain {links}, {weight}:1, {substeps} substeps: gained {gained:.1e}, lost {lost:.1e} at the bottom, stretched \
         by {stretch:.1e}"
    );
    [gained, lost, stretch]
}

/// A chain that goes slack and snaps taut under its weight gains no energy by that, however long and however heavy.
#[test]
fn a_heavy_chain_that_snaps_taut_gains_nothing() {
    for (links, weight) in [70.0, 100.0, 400.0].into_iter().flat_map(|w| [12, 14, 15, 17, 21].map(|n| (n, w)))
    {
        let [gained, lost, stretch] = swing(links, weight, 4, 600);
        // With the pull of the step before, gains were up to 0.9; a first swing that has not snapped loses little.
        assert!(gained < 1e-3 && lost < 3e-3, "{gained} {lost}");
        assert!(stretch < 0.02, "{stretch}");
    }
}

/// Links far too light for their weight tremble faster than any number of substeps sees; that neither grows nor is
/// felt. (Without friction between them: no number at 16 substeps of 50,000:1, 2.7 % stretch at 4.)
#[test]
fn a_chain_of_links_that_tremble_swings_on() {
    let cases = [(17, 1e3), (50, 5e4)].into_iter().flat_map(|chain| [2, 4, 8, 16].map(|k| (chain, k)));
    for ((links, weight), substeps) in cases.step_by(EVERY) {
        let [gained, lost, stretch] = swing(links, weight, substeps, 1200);
        assert!(gained < 1e-3 && lost < 2e-3 && stretch < 2e-3, "{gained} {lost} {stretch}");
    }
}

#[test]
fn chains_bridges_and_nets_come_to_no_harm() {
    for name in ["chain/1", "chain/30", "chain/200", "bridge/40", "joint_grid/20"] {
        for &solver in Solver::ALL {
            let scene = by_name(name, None, 1).unwrap();
            let mut world = start(&scene, Settings { solver, ..Settings::default() });
            let begin = energy(&*world);
            let (mut worst, mut gained) = (0.0f64, f64::MIN);
            for _ in 0..300 {
                advance(&mut *world, 1);
                worst = worst.max(gaps(&*world)[0]);
                gained = gained.max(energy(&*world) - begin);
            }
            println!("{name} {solver}: gap {worst:.2e} m at most, energy {gained:+.2e} J");
            // A chain of 200 pulls its first links with 200 times the load of a pendulum.
            let allowed =
                if solver == Solver::Impulse { 1.0 } else { f64::max(0.1, 1e-3 * scene.bodies.len() as f64) };
            assert!(worst < allowed, "{name} {solver}: {worst} m apart");
            let scale = scene.bodies.len() as f64 * GRAVITY * 0.046;
            assert!(gained < 0.02 * scale, "{name} {solver}: {gained} J from nothing");
        }
    }
}

/// tan θᵢ = w(N + 1 − 2i)/2H with Σ ℓ cos θᵢ = span: each plank's ends pull with the same horizontal H.
#[test]
fn a_bridge_hangs_in_the_shape_of_statics() {
    let planks = 10;
    let mut scene = by_name("bridge/10", None, 1).unwrap();
    scene.forces.linear_drag = Some(0.2);
    let mut world = start(&scene, Settings { substeps: 64, ..in_f64() });
    advance(&mut *world, 1200);
    let anchors = world.joint_anchors();
    let span = anchors[planks][1][0] - anchors[0][0][0];
    let slope =
        |i: usize, weight_over_pull: f64| 0.5 * weight_over_pull * (planks as f64 + 1.0 - 2.0 * i as f64);
    let width = |ratio: f64| (1..=planks).map(|i| 0.5 / slope(i, ratio).hypot(1.0)).sum::<f64>();
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if width(middle) > span { low = middle } else { high = middle }
    }
    let (mut x, mut y, mut worst) = (anchors[0][0][0], anchors[0][0][1], 0.0f64);
    for i in 1..=planks {
        let slope = slope(i, low);
        x += 0.5 / slope.hypot(1.0);
        y -= 0.5 * slope / slope.hypot(1.0);
        let [at_x, at_y] = anchors[i][0];
        worst = worst.max((at_x - x).hypot(at_y - y));
    }
    println!("bridge/10: {worst:.2e} m from statics");
    assert!(worst < 1e-4 * 5.0, "{worst} m from the shape of statics");
}

/// In f32, where places 10 km out are known to a millimetre.
#[test]
fn a_chain_far_from_the_origin_holds_together() {
    let mut scene = jointed::chain(10, None);
    for body in &mut scene.bodies {
        body.position[0] += 1e4;
    }
    for joint in &mut scene.joints {
        if let JointKind::Revolute(hinge) = &mut joint.kind {
            hinge.anchor[0] += 1e4;
        }
    }
    let mut world = start(&scene, Settings::default());
    advance(&mut *world, 300);
    let [worst, _] = gaps(&*world);
    assert!(worst < 0.02, "{worst} m apart");
}
