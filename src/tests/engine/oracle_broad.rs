//! All broad phases at every width, held to each other, to a naive `f64` reading of the definition in
//! the broad phase, and to what really touches.
//!
//! Worlds: equal sizes, within 2×, over 300×, clusters, thin turned boxes to 1:1000, huge discs and
//! polygons, static pairs, categories, holes, far from the origin.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use glam::DVec2;
use lamina2d::body::{Bodies, Form};
use lamina2d::internals::{BRUTE_LIMIT, BroadPhase, SWEEP_LIMIT};
use lamina2d::lanes::Real;
use lamina2d::measure::{Outline, penetration};
use lamina2d::scene::{BodyKind, BodySpec, ShapeSpec};
use lamina2d::settings::Broad;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use crate::shared_oracle::{Everywhere, Solid, bodies_of, contact_bits};

/// A pair may be decided either way when its test value is this close to the threshold, relative to the sum of
/// the radii. Never needed so far: in these worlds all pairs, of both precisions, agree with the oracle.
const BAND: f64 = 1e-5;

const METHODS: [Broad; 4] = [Broad::Brute, Broad::Sweep, Broad::Grid, Broad::Auto];

#[derive(Clone, Copy, Debug)]
enum World {
    Equal,
    WithinTwice,
    Wide,
    Clustered,
    Thin,
    Huge,
    Mixed,
    Far,
}

const WORLDS: [World; 8] = [
    World::Equal,
    World::WithinTwice,
    World::Wide,
    World::Clustered,
    World::Thin,
    World::Huge,
    World::Mixed,
    World::Far,
];

fn regular(sides: u32, radius: f64, stretch: f64, random: &mut Pcg32) -> ShapeSpec {
    let start = random.random_range(0.0..1.0);
    let corner =
        |k| DVec2::from_angle((f64::from(k) + start) * std::f64::consts::TAU / f64::from(sides)) * radius;
    ShapeSpec::Polygon((0..sides).map(corner).map(|v| [v.x, v.y * stretch]).collect())
}

fn any_shape(size: f64, random: &mut Pcg32) -> ShapeSpec {
    match random.random_range(0..3) {
        0 => ShapeSpec::Circle(size),
        1 => ShapeSpec::Box([size, size * random.random_range(0.4..1.0)]),
        _ => regular(random.random_range(3..=8), size, random.random_range(0.5..1.0), random),
    }
}

fn shape_in(world: World, k: usize, random: &mut Pcg32) -> ShapeSpec {
    let log = |random: &mut Pcg32, decades: f64| 10f64.powf(random.random_range(-decades..0.0));
    match world {
        World::Equal => ShapeSpec::Circle(0.5),
        World::WithinTwice | World::Clustered | World::Far => {
            any_shape(random.random_range(0.3..0.6), random)
        }
        World::Wide => any_shape(2.0 * log(random, 2.5), random),
        World::Thin => ShapeSpec::Box([random.random_range(0.5..4.0), 0.5 * log(random, 2.5)]),
        World::Huge if k.is_multiple_of(20) => any_shape(random.random_range(3.0..12.0), random),
        World::Huge => any_shape(0.3, random),
        World::Mixed if k.is_multiple_of(11) => ShapeSpec::Box([5.0, 0.1]),
        World::Mixed => any_shape(1.5 * log(random, 1.0), random),
    }
}

fn specs(world: World, count: usize, seed: u64) -> Vec<BodySpec> {
    let mut random = Pcg32::seed_from_u64(seed);
    let side = 1.3 * (count as f64).sqrt() + 0.5;
    let spec = |k: usize| {
        let shape = shape_in(world, k, &mut random);
        let mut at = DVec2::new(random.random_range(0.0..side), random.random_range(0.0..side));
        match world {
            World::Clustered => at = at * 0.2 + DVec2::splat(if k.is_multiple_of(3) { 300.0 } else { -7.0 }),
            World::Far => at += DVec2::new(1e4, -1e4),
            _ => {}
        }
        let mut spec = BodySpec::new(shape, at.into()).turned(random.random_range(-4.0..4.0));
        if matches!(world, World::Mixed | World::Huge | World::Thin) {
            spec.kind = match random.random_range(0..5) {
                0 => BodyKind::Static,
                1 => BodyKind::Kinematic,
                _ => BodyKind::Dynamic,
            };
        }
        if matches!(world, World::Mixed) {
            spec.category = 1 << random.random_range(0..3);
            spec.collides_with = random.random_range(0..8);
        }
        spec
    };
    (0..count).map(spec).collect()
}

/// The world, with some bodies taken out and a few put into the holes.
fn build<R: Real>(world: World, count: usize, seed: u64) -> Bodies<R> {
    let specs = specs(world, count, seed);
    let mut bodies = bodies_of::<R>(&specs);
    for slot in (4..bodies.len()).step_by(6) {
        bodies.remove(bodies.id(slot).unwrap()).unwrap();
    }
    for spec in specs.iter().take(count / 20) {
        let moved = BodySpec { position: [spec.position[0] + 0.7, spec.position[1]], ..spec.clone() };
        bodies.insert(&moved).unwrap();
    }
    bodies.refresh_polygons();
    bodies
}

fn find<R: Everywhere>(width: usize, bodies: &Bodies<R>, method: Broad, margin: f64) -> Vec<[u32; 2]> {
    let mut broad = BroadPhase::default();
    R::find(&mut broad, width, bodies, method, margin);
    broad.pairs().to_vec()
}

/// A body as the definition sees it.
struct Bound {
    at: DVec2,
    radius: f64,
    /// For long bodies: attitude, centre and half-extents of the oriented box.
    long: Option<(DVec2, DVec2, DVec2)>,
}

fn bounds<R: Real>(bodies: &Bodies<R>, margin: f64) -> Vec<(usize, Bound)> {
    let mut movable: Vec<f64> = bodies
        .slots()
        .filter(|&k| bodies.kind(k) != BodyKind::Static)
        .map(|k| bodies.radius[k].to_f64())
        .collect();
    movable.sort_by(f64::total_cmp);
    let median = movable.get(movable.len() / 2).copied().unwrap_or(f64::INFINITY);
    let bound = |k: usize| {
        let turn = DVec2::new(bodies.c[k].to_f64(), bodies.s[k].to_f64());
        let (low, high) = if bodies.form(k) == Form::Circle {
            let r = DVec2::splat(bodies.extent_x[k].to_f64());
            (-r, r)
        } else {
            let unturned =
                bodies.outline(k).into_iter().map(|v| DVec2::from(v).rotate(turn * DVec2::new(1.0, -1.0)));
            unturned.fold((DVec2::MAX, DVec2::MIN), |(l, h), v| (l.min(v), h.max(v)))
        };
        let half = (high - low) / 2.0;
        let radius = bodies.radius[k].to_f64();
        let long = half.max_element() / half.min_element() >= 3.0 || radius > 4.0 * median;
        let grown = half * (1.0 + 1e-5) + margin / 2.0;
        let at = DVec2::new(bodies.x[k].to_f64(), bodies.y[k].to_f64());
        (
            k,
            Bound {
                at,
                radius: radius + margin / 2.0,
                long: long.then_some((turn, (low + high) / 2.0, grown)),
            },
        )
    };
    bodies.slots().map(bound).collect()
}

/// How far the pair's closest test is inside (negative) or outside its threshold, relative to the sizes.
fn excess(a: &Bound, b: &Bound) -> f64 {
    let reach = a.radius + b.radius;
    let circles = (a.at.distance(b.at) - reach) / reach;
    let boxed = [(a, b), (b, a)].into_iter().filter_map(|(own, other)| {
        let (turn, centre, half) = own.long?;
        let local = (other.at - own.at).rotate(turn * DVec2::new(1.0, -1.0)) - centre;
        let gap = (local.abs() - half).max(DVec2::ZERO).length();
        Some((gap - other.radius) / reach)
    });
    boxed.fold(circles, f64::max)
}

/// Holds a pair list to the definition, all pairs of all bodies.
fn meets_the_definition<R: Real>(bodies: &Bodies<R>, pairs: &[[u32; 2]], margin: f64) {
    let bounds = bounds(bodies, margin);
    for (k, (slot_a, a)) in bounds.iter().enumerate() {
        for (slot_b, b) in &bounds[k + 1..] {
            let excess = excess(a, b);
            let found = pairs.binary_search(&[*slot_a as u32, *slot_b as u32]).is_ok();
            let want = excess <= 0.0 && bodies.may_collide(*slot_a, *slot_b);
            assert!(
                found == want || (excess.abs() < BAND && bodies.may_collide(*slot_a, *slot_b)),
                "slots {slot_a} and {slot_b}: found {found}, excess {excess:e}"
            );
        }
    }
}

fn outline(solid: &Solid, fixed: bool) -> Outline {
    let vertices = solid.vertices.iter().map(|v| (*v + solid.centre).into()).collect();
    Outline { centre: solid.centre.into(), radius: solid.radius, vertices, fixed }
}

/// No pair that overlaps by more than rounding is missing; by `measure`'s own geometry.
fn misses_nothing_that_touches<R: Real>(bodies: &Bodies<R>, pairs: &[[u32; 2]]) -> usize {
    let solids: Vec<(usize, Outline)> = bodies
        .slots()
        .map(|k| (k, outline(&Solid::new(bodies, k), bodies.kind(k) != BodyKind::Dynamic)))
        .collect();
    let mut touching = 0;
    for (k, (slot_a, a)) in solids.iter().enumerate() {
        for (slot_b, b) in &solids[k + 1..] {
            let depth = penetration(&[a.clone(), b.clone()]).max;
            // Sizes are below 25 m: two units in the last place.
            if depth > 50.0 * R::EPSILON.to_f64() && bodies.may_collide(*slot_a, *slot_b) {
                touching += 1;
                let pair = [*slot_a as u32, *slot_b as u32];
                assert!(
                    pairs.binary_search(&pair).is_ok(),
                    "{pair:?} overlap by {depth:e} and are no candidates"
                );
            }
        }
    }
    touching
}

fn all_methods_agree<R: Everywhere>(bodies: &Bodies<R>, margin: f64, what: &str) -> Vec<[u32; 2]> {
    let want = find(1, bodies, Broad::Brute, margin);
    assert!(want.is_sorted() && want.iter().all(|p| p[0] < p[1]));
    for &width in R::WIDTHS {
        for method in METHODS {
            assert_eq!(find(width, bodies, method, margin), want, "{what}: {method} ×{width} {}", R::NAME);
        }
    }
    want
}

fn contacts_do_not_depend_on_the_method<R: Everywhere>(bodies: &Bodies<R>, pairs: &[[u32; 2]], margin: f64) {
    let all = find(1, bodies, Broad::Off, margin);
    let want = contact_bits(1, bodies, &all, margin);
    for &width in R::WIDTHS {
        assert_eq!(contact_bits(width, bodies, &all, margin), want, "off ×{width} {}", R::NAME);
        assert_eq!(contact_bits(width, bodies, pairs, margin), want, "candidates ×{width} {}", R::NAME);
    }
}

fn check_worlds<R: Everywhere>() {
    let (mut candidates, mut touching) = (0, 0);
    for (k, world) in WORLDS.into_iter().enumerate() {
        for count in [0, 1, 2, 3, 5, 17, 70, 160] {
            for seed in 0..3 {
                let bodies = build::<R>(world, count, seed * 1000 + (k * 100 + count) as u64);
                for margin in [0.0, 0.05] {
                    let pairs = all_methods_agree(&bodies, margin, &format!("{world:?}/{count} seed {seed}"));
                    meets_the_definition(&bodies, &pairs, margin);
                    contacts_do_not_depend_on_the_method(&bodies, &pairs, margin);
                    touching += misses_nothing_that_touches(&bodies, &pairs);
                    candidates += pairs.len();
                }
            }
        }
    }
    assert!(candidates > 2000 && touching > 1000, "the worlds are full: {candidates}, {touching}");
}

#[test]
fn every_method_finds_the_defined_pairs_in_f32() {
    check_worlds::<f32>();
}

#[test]
fn every_method_finds_the_defined_pairs_in_f64() {
    check_worlds::<f64>();
}

#[test]
fn auto_changes_its_method_without_changing_its_pairs() {
    for world in WORLDS {
        // A sixth is taken out.
        for count in [BRUTE_LIMIT, BRUTE_LIMIT + 150, SWEEP_LIMIT * 4 / 3] {
            let bodies = build::<f32>(world, count, 5);
            let pairs = all_methods_agree(&bodies, 0.0, &format!("{world:?}/{count}"));
            meets_the_definition(&bodies, &pairs, 0.0);
        }
    }
    assert_eq!(BroadPhase::<f32>::resolve(Broad::Auto, BRUTE_LIMIT), Broad::Brute);
    assert_eq!(BroadPhase::<f32>::resolve(Broad::Auto, BRUTE_LIMIT + 1), Broad::Sweep);
    assert_eq!(BroadPhase::<f32>::resolve(Broad::Auto, SWEEP_LIMIT + 1), Broad::Grid);
}

/// Cells that outliers crowd are left to the sweep for some lists, and tried again.
#[test]
fn a_grid_that_gives_way_and_comes_back_loses_no_pair() {
    let worlds = [World::Clustered, World::Equal, World::Clustered];
    let worlds = worlds.map(|world| build::<f32>(world, SWEEP_LIMIT * 4 / 3, 11));
    let mut kept = BroadPhase::<f32>::default();
    assert_eq!(kept.in_use(Broad::Auto, SWEEP_LIMIT + 1), Broad::Grid);
    for (bodies, method) in worlds.iter().zip([Broad::Sweep, Broad::Grid, Broad::Sweep]) {
        let want = find(8, bodies, Broad::Brute, 0.05);
        for list in 0..100 {
            kept.forget();
            f32::find(&mut kept, 8, bodies, Broad::Auto, 0.05);
            // The first lists of a world come while the last one's cells are not tried again.
            assert!(
                list < 70 || kept.in_use(Broad::Auto, 0) == method,
                "list {list}: {:?}",
                kept.in_use(Broad::Auto, 0)
            );
            assert!(kept.pairs() == want, "list {list}: {} pairs, not {}", kept.pairs().len(), want.len());
        }
    }
}

#[test]
fn memory_kept_from_step_to_step_changes_no_pair() {
    for world in WORLDS {
        let mut bodies = build::<f32>(world, 120, 9);
        let mut kept = METHODS.map(|method| (method, BroadPhase::<f32>::default()));
        let mut random = Pcg32::seed_from_u64(4);
        for round in 0..12 {
            for slot in bodies.slots().collect::<Vec<_>>() {
                bodies.x[slot] += random.random_range(-0.3..0.3);
                bodies.y[slot] += random.random_range(-0.3..0.3);
            }
            if round % 4 == 3 {
                let gone = bodies.slots().nth(round * 5).unwrap();
                bodies.remove(bodies.id(gone).unwrap()).unwrap();
            }
            bodies.refresh_polygons();
            let want = all_methods_agree(&bodies, 0.0, "moved");
            for (method, broad) in &mut kept {
                f32::find(broad, 8, &bodies, *method, 0.0);
                assert_eq!(broad.pairs(), want, "{world:?} round {round}: {method}");
            }
        }
    }
}

/// Two discs at exactly the distance at which their rounded reach says they meet.
#[test]
fn sweep_keeps_a_pair_whose_reach_was_rounded_up() {
    let mut random = Pcg32::seed_from_u64(77);
    let disc = BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 0.0]);
    for _ in 0..2000 {
        let mut bodies = bodies_of::<f32>(&[disc.clone(), disc.clone()]);
        let radii: [f32; 2] = [random.random_range(0.5..1.0), random.random_range(0.5..1.0)];
        let left: f32 = if random.random() { 0.0 } else { random.random_range(-1e4..1e4) };
        (bodies.x[1], bodies.x[2]) = (left, left + (radii[0] + radii[1]));
        (bodies.radius[1], bodies.radius[2]) = (radii[0], radii[1]);
        all_methods_agree(&bodies, 0.0, &format!("{radii:?} at {left}"));
    }
}

#[test]
fn a_body_that_flew_away_breaks_no_method() {
    fn check<R: Everywhere>(distances: &[f64]) {
        for &away in distances {
            let mut specs = specs(World::Wide, 30, 3);
            specs.push(BodySpec::new(ShapeSpec::Circle(1e-4), [away, -away]));
            specs.push(BodySpec::new(ShapeSpec::Circle(0.4), [-away, 0.3]));
            let bodies = bodies_of::<R>(&specs);
            let pairs = all_methods_agree(&bodies, 0.0, &format!("{away:e} m away"));
            meets_the_definition(&bodies, &pairs, 0.0);
        }
    }
    check::<f32>(&[1e6, 1e10, 9e14]);
    check::<f64>(&[1e6, 1e15, 1e25, 9e96]);
}

/// Bodies that graze a thin, turned floor far from its centre, within a few units in the last place of it.
#[test]
fn a_grazing_contact_far_along_a_thin_floor_stays_a_candidate() {
    fn check<R: Everywhere>() {
        let mut random = Pcg32::seed_from_u64(21);
        let mut grazing = 0;
        for round in 0..300 {
            let (angle, half) = (random.random_range(-3.0..3.0), [50.0, 0.02]);
            let (along, up) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
            let mut specs = vec![BodySpec::new(ShapeSpec::Box(half), [0.0, 0.0]).turned(angle).fixed()];
            for k in 0..24 {
                let size = random.random_range(0.005..0.1);
                let shape = match k % 3 {
                    0 => ShapeSpec::Circle(size),
                    1 => ShapeSpec::Box([size, size]),
                    _ => ShapeSpec::Polygon(
                        [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|v| v.map(|x| x * size)).into(),
                    ),
                };
                let depth = random.random_range(-100.0..100.0) * R::EPSILON.to_f64();
                let at = along * random.random_range(-49.0..49.0) + up * (half[1] + size - depth);
                specs.push(BodySpec::new(shape, at.into()).turned(angle));
            }
            let bodies = bodies_of::<R>(&specs);
            let pairs = all_methods_agree(&bodies, 0.0, "grazing");
            contacts_do_not_depend_on_the_method(&bodies, &pairs, 0.0);
            grazing += contact_bits(1, &bodies, &pairs, 0.0).len();
            assert!(round < 299 || grazing > 1000, "{grazing} of 7200 touch");
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Many statics, which are kept apart from what moves, and planks, which are found by their circles: every method finds the same
/// pairs, and all that meet.
#[test]
fn many_statics_are_never_looked_at_in_pairs() {
    let mut random = Pcg32::seed_from_u64(4711);
    for statics in [10, 63, 64, 200] {
        let mut one = |half: [f64; 2], wide: f64| {
            let at = [random.random_range(-wide..wide), random.random_range(-wide..wide)];
            BodySpec::new(ShapeSpec::Box(half), at).turned(random.random_range(0.0..6.3))
        };
        let mut specs: Vec<_> = (0..statics).map(|_| one([0.5, 0.4], 6.0).fixed()).collect();
        specs.extend((0..60).map(|_| one([0.8, 0.2], 8.0)));
        specs.extend((0..60).map(|_| one([0.3, 0.3], 8.0)));
        specs.push(one([40.0, 0.1], 1.0).fixed());
        let mut bodies = bodies_of::<f32>(&specs);
        bodies.refresh_polygons();
        let pairs = all_methods_agree(&bodies, 0.0, &format!("{statics} statics"));
        meets_the_definition(&bodies, &pairs, 0.0);
    }
}
