//! All six collision kernels in both precisions, held to parry's `f64` and to separating axes over explicit
//! vertices.
//!
//! Errors are counted in ε·L: ε of the precision, L the larger of the two bodies' radii. The oracle works on
//! the values the engine holds, so rounding a scene to `f32` is no error here. A normal is right when moving
//! B by the depth along it parts the bodies and no axis needs less; where that axis is unique it is *the* normal.
//! Box and polygon kernels prefer A's face by a thousandth of a box's smaller half-extent or of an edge
//! (`PREFER_A`): that much more depth is allowed to them, and only to them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;

use glam::DVec2;
use lamina2d::body::{Bodies, Form};
use lamina2d::contact::Contact;
use lamina2d::internals::Narrow;
use lamina2d::lanes::Real;
use lamina2d::scene::BodySpec;
use parry2d_f64::math::{Pose, Rotation, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::{Ball, ConvexPolygon, Cuboid, Shape};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use crate::shared_oracle::{ContactBits, Everywhere, Solid, bodies_of, contact_bits, separation};
use crate::shared_pairs::{CASES, Case, Pair, pair, resting};

/// Pairs per case.
const PAIRS: usize = 720;

fn pairs_of(case: Case) -> Vec<Pair> {
    (0..PAIRS).map(|k| pair(case, k)).collect()
}

/// All pairs in one world: the narrow phase looks at the listed ones only.
fn world_of<R: Real>(pairs: &[Pair]) -> (Bodies<R>, Vec<[u32; 2]>) {
    let slots = (0..pairs.len() as u32).map(|k| [2 * k + 1, 2 * k + 2]).collect();
    (bodies_of(pairs.as_flattened()), slots)
}

fn contacts<R: Everywhere>(bodies: &Bodies<R>, slots: &[[u32; 2]], margin: f64) -> BTreeMap<u32, Contact> {
    let mut narrow = Narrow::default();
    R::collide(&mut narrow, 1, bodies, slots, margin);
    let found = (0..narrow.manifolds.len()).map(|k| narrow.manifolds.contact(k));
    found.map(|contact| (contact.a.min(contact.b), contact)).collect()
}

/// The largest errors of a kernel, in ε·L.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// Overlaps called misses, or gaps called hits: how far from touching.
    verdict: f64,
    /// Depth against the oracle's, beyond what `PREFER_A` explains.
    depth: f64,
    /// Overlap left after moving B by the depth along the normal.
    left: f64,
    /// Points off the surfaces.
    points: f64,
    /// | |n| − 1 |.
    unit: f64,
    /// Depth against parry's, likewise.
    parry: f64,
    /// Contacts found.
    hits: usize,
}

impl Worst {
    /// The errors as multiples of a length.
    fn per(&self, length: f64) -> Self {
        Self {
            verdict: self.verdict / length,
            depth: self.depth / length,
            left: self.left / length,
            points: self.points / length,
            unit: self.unit / length,
            parry: self.parry / length,
            ..*self
        }
    }

    fn raise(&mut self, other: &Self) {
        for (own, new) in [
            (&mut self.verdict, other.verdict),
            (&mut self.depth, other.depth),
            (&mut self.left, other.left),
            (&mut self.points, other.points),
            (&mut self.unit, other.unit),
            (&mut self.parry, other.parry),
        ] {
            assert!(!new.is_nan(), "NaN in a measured error");
            *own = own.max(new);
        }
        self.hits += other.hits;
    }
}

/// One pair, ordered as its kernel orders it.
struct Seen {
    a: Solid,
    b: Solid,
    kernel: (Form, Form),
    /// Metres that `PREFER_A` may cost.
    slack: f64,
    separation: f64,
}

fn see<R: Real>(bodies: &Bodies<R>, [first, second]: [u32; 2]) -> (Seen, [u32; 2]) {
    let forms = |p: [u32; 2]| (bodies.form(p[0] as usize), bodies.form(p[1] as usize));
    let slots =
        if forms([first, second]).0 <= forms([first, second]).1 { [first, second] } else { [second, first] };
    let [mut a, mut b] = slots.map(|slot| Solid::new(bodies, slot as usize));
    // About A, as the kernels see them: the oracle must not round 1e4 m either.
    (a.centre, b.centre) = (DVec2::ZERO, b.centre - a.centre);
    let kernel = forms(slots);
    let edge = |s: &Solid| s.edges().map(|(p, q)| p.distance(q)).fold(0.0, f64::max);
    let slack = match kernel {
        (Form::Circle, _) => 0.0,
        // Twice a half-extent is the smallest width of a box.
        (Form::Box, Form::Box) => 0.5e-3 * a.thinness().min(b.thinness()),
        _ => 1e-3 * edge(&a).min(edge(&b)),
    };
    let separation = separation(&a, &b);
    (Seen { a, b, kernel, slack, separation }, slots)
}

impl Seen {
    fn size(&self) -> f64 {
        self.a.reach().max(self.b.reach())
    }

    /// The errors of an answer, in metres.
    fn errors(&self, contact: Option<&Contact>) -> Worst {
        let mut worst = Worst::default();
        let Some(contact) = contact else {
            worst.verdict = (-self.separation).max(0.0);
            return worst;
        };
        worst.verdict = self.separation.max(0.0);
        let normal = DVec2::from(contact.normal);
        worst.unit = (normal.length() - 1.0).abs() * self.size();
        let deepest = contact.points.iter().map(|p| p.separation).fold(f64::MAX, f64::min);
        let too_deep = (self.separation - deepest - self.slack).max(0.0);
        worst.depth = too_deep.max(deepest - self.separation);
        let mut moved = self.b.clone();
        moved.centre -= normal * deepest;
        worst.left = (-separation(&self.a, &moved)).max(0.0);
        let d = self.b.centre;
        // Where B's axis was better by less than the slack, a corner beside A's face may stand for it.
        let preferred = self.separation - deepest > 1e-6 * self.slack;
        let beside = if preferred { 3.0 * self.slack } else { 0.0 };
        for point in &contact.points {
            let (middle, half) = (DVec2::from(point.arm_a), normal * (point.separation * 0.5));
            let off_a = self.a.distance_to(middle - half).abs();
            let off_b = self.b.distance_to(middle + half - d).abs();
            worst.points = worst.points.max(off_a.max(off_b) - beside);
        }
        worst.hits = 1;
        match self.against_parry(deepest) {
            Some(error) => worst.parry = error,
            // Parry sees no contact: then there is all but none.
            None => worst.verdict = self.separation.abs(),
        }
        worst
    }

    /// By how much a depth differs from parry's, if parry sees a contact, too.
    fn against_parry(&self, deepest: f64) -> Option<f64> {
        let [(at_a, a), (at_b, b)] = [parry(self.kernel.0, &self.a), parry(self.kernel.1, &self.b)];
        match query::contact(&at_a, a.as_ref(), &at_b, b.as_ref(), 0.0) {
            Ok(Some(contact)) => Some((contact.dist - deepest - self.slack).max(deepest - contact.dist)),
            _ => None,
        }
    }
}

/// A body as parry has it.
fn parry(form: Form, solid: &Solid) -> (Pose, Box<dyn Shape>) {
    let at = Vector::new(solid.centre.x, solid.centre.y);
    match form {
        Form::Circle => (Pose::from_translation(at), Box::new(Ball::new(solid.radius))),
        Form::Box => {
            let (x, y) = (solid.vertices[1] - solid.vertices[0], solid.vertices[2] - solid.vertices[1]);
            let turn = Rotation::from_cos_sin_unchecked(x.normalize().x, x.normalize().y);
            let half = Vector::new(x.length() / 2.0, y.length() / 2.0);
            (Pose::from_parts(at, turn), Box::new(Cuboid::new(half)))
        }
        Form::Polygon => {
            let vertices = solid.vertices.iter().map(|v| Vector::new(v.x, v.y)).collect();
            let polygon = ConvexPolygon::from_convex_polyline_unmodified(vertices).unwrap();
            (Pose::from_translation(at), Box::new(polygon))
        }
    }
}

/// Worst errors per kernel, over all pairs of some cases.
fn measure<R: Everywhere>(cases: &[Case]) -> BTreeMap<(Form, Form), Worst> {
    let mut all = BTreeMap::<_, Worst>::new();
    for &case in cases {
        let (bodies, slots) = world_of::<R>(&pairs_of(case));
        let found = contacts(&bodies, &slots, 0.0);
        for &pair in &slots {
            let (seen, order) = see(&bodies, pair);
            let contact = found.get(&pair[0]);
            if let Some(contact) = contact {
                assert_eq!([contact.a, contact.b], order, "A has the lesser form, or the lower slot");
                assert!((1..=2).contains(&contact.points.len()));
                assert!(contact.points.iter().all(|p| p.separation <= 0.0), "margin 0 means overlap");
            }
            let unit = R::EPSILON.to_f64() * seen.size();
            all.entry(seen.kernel).or_default().raise(&seen.errors(contact).per(unit));
        }
    }
    all
}

/// Bounds in ε·L, at twice to three times the worst measured (per kernel and precision, all cases):
/// verdict 1.1, depth 2.4, overlap left 2.8, points 2.7, length of the normal 1.5, parry 2.4.
/// `f64` has the same bounds as `f32`: its ε is 5·10⁸ times smaller.
const BOUND: Worst =
    Worst { verdict: 3.0, depth: 5.0, left: 6.0, points: 6.0, unit: 3.0, parry: 5.0, hits: 0 };

fn hold<R: Everywhere>(cases: &[Case]) {
    let measured = measure::<R>(cases);
    assert_eq!(measured.len(), 6, "every kernel has its pairs");
    for (kernel, worst) in &measured {
        println!("{} {kernel:?}: {worst:.1?}", R::NAME);
        for (what, error, limit) in [
            ("verdict", worst.verdict, BOUND.verdict),
            ("depth", worst.depth, BOUND.depth),
            ("overlap left", worst.left, BOUND.left),
            ("points", worst.points, BOUND.points),
            ("normal", worst.unit, BOUND.unit),
            ("parry", worst.parry, BOUND.parry),
        ] {
            assert!(error <= limit, "{} {kernel:?} {cases:?}: {what} off by {error} ε·L", R::NAME);
        }
        assert!(worst.hits > 30, "{kernel:?}: {worst:?}");
    }
}

#[test]
fn every_kernel_agrees_with_parry_and_the_oracle() {
    let plain: Vec<Case> = CASES.into_iter().filter(|case| *case != Case::Slivers).collect();
    hold::<f32>(&plain);
    hold::<f64>(&plain);
}

#[test]
fn slivers_of_a_thousand_to_one_agree_too() {
    hold::<f32>(&[Case::Slivers]);
    hold::<f64>(&[Case::Slivers]);
}

/// Contacts by their pair, so that lists of other orders can be compared.
fn by_pair(contacts: Vec<ContactBits>) -> BTreeMap<(u32, u32), ContactBits> {
    contacts.into_iter().map(|c| ((c.0[0], c.0[1]), c)).collect()
}

fn company_changes_nothing<R: Everywhere>(margin: f64) {
    let mut random = Pcg32::seed_from_u64(11);
    let pairs: Vec<Pair> = CASES.into_iter().flat_map(|case| pairs_of(case).into_iter().take(400)).collect();
    let (bodies, slots) = world_of::<R>(&pairs);
    // Alone: a batch of one, padded.
    let alone: Vec<ContactBits> =
        slots.iter().flat_map(|&pair| contact_bits(1, &bodies, &[pair], margin)).collect();
    let alone = by_pair(alone);
    for &width in R::WIDTHS {
        let mut list = slots.clone();
        for round in 0..6 {
            let together = by_pair(contact_bits(width, &bodies, &list, margin));
            for (pair, contact) in &together {
                let single = alone.get(pair);
                assert_eq!(
                    Some(contact),
                    single,
                    "{} ×{width} round {round}, {pair:?} of {:?}",
                    R::NAME,
                    CASES[(pair.0.min(pair.1) as usize - 1) / 800]
                );
            }
            assert_eq!(together.len(), alone.len());
            list.shuffle(&mut random);
        }
        for &pair in slots.iter().step_by(7) {
            let single = by_pair(contact_bits(width, &bodies, &[pair], margin));
            assert!(single.iter().all(|(pair, contact)| alone.get(pair) == Some(contact)), "alone ×{width}");
        }
    }
}

#[test]
fn a_pair_gets_the_same_bits_in_any_company_at_any_width() {
    for margin in [0.0, 1e-3, 0.05] {
        company_changes_nothing::<f32>(margin);
        company_changes_nothing::<f64>(margin);
    }
}

/// Do two faces look at each other, nearly parallel, side by side for a tenth of the size, and overlap by more
/// than their tilt takes away again?
fn face_to_face(seen: &Seen, contact: &Contact) -> bool {
    let (normal, size) = (DVec2::from(contact.normal), seen.size());
    let span = |(p, q): (DVec2, DVec2)| {
        let along = [p, q].map(|v| v.dot(normal.perp()));
        (along[0].min(along[1]), along[0].max(along[1]))
    };
    let facing = |s: &Solid, sign: f64| {
        s.edges().zip(s.faces()).find(|(_, (n, _))| n.dot(normal) * sign > 0.999_9).map(|(e, (n, _))| (e, n))
    };
    let (Some((edge_a, n_a)), Some((edge_b, n_b))) = (facing(&seen.a, 1.0), facing(&seen.b, -1.0)) else {
        return false;
    };
    let (a, b) = (span(edge_a), span((edge_b.0 + seen.b.centre, edge_b.1 + seen.b.centre)));
    let beside = a.1.min(b.1) - a.0.max(b.0);
    let tilt = n_a.perp_dot(-n_b).abs();
    beside > 0.1 * size && -seen.separation > 2.0 * tilt * size + 1e-5 * size
}

fn faces_have_two_points<R: Everywhere>() {
    let mut met = 0;
    for case in [Case::ParallelEdges, Case::Stacked] {
        let (bodies, slots) = world_of::<R>(&pairs_of(case));
        let found = contacts(&bodies, &slots, 0.0);
        for &pair in &slots {
            let ((seen, _), Some(contact)) = (see(&bodies, pair), found.get(&pair[0])) else { continue };
            if seen.kernel.0 != Form::Circle && face_to_face(&seen, contact) {
                met += 1;
                assert_eq!(contact.points.len(), 2, "{case:?} {pair:?} {:?}: {contact:?}", seen.kernel);
            }
        }
    }
    assert!(met > 300, "{met} faces met");
}

#[test]
fn faces_that_meet_have_two_points() {
    faces_have_two_points::<f32>();
    faces_have_two_points::<f64>();
}

fn resting_keeps_features<R: Everywhere>() {
    let mut random = Pcg32::seed_from_u64(8);
    let still = resting();
    let (bodies, slots) = world_of::<R>(&still);
    let want = contacts(&bodies, &slots, 0.0);
    let features = |contact: &Contact| contact.points.iter().map(|p| p.feature).collect::<Vec<_>>();
    assert!(want.len() == still.len() && want.values().all(|c| c.points.len() == 2));
    for _ in 0..300 {
        // Both move a little, and turn by less than makes a corner leave.
        let moved: Vec<Pair> = still
            .iter()
            .map(|pair| {
                pair.clone().map(|spec| {
                    let by: [f64; 2] = std::array::from_fn(|_| random.random_range(-2e-4..2e-4));
                    let at = (DVec2::from(spec.position) + DVec2::from(by)).into();
                    BodySpec { position: at, ..spec }.turned(random.random_range(-5e-5..5e-5))
                })
            })
            .collect();
        let (bodies, slots) = world_of::<R>(&moved);
        for (pair, contact) in contacts(&bodies, &slots, 0.0) {
            assert_eq!(features(&contact), features(&want[&pair]), "{:?}", moved[pair as usize / 2]);
        }
    }
}

#[test]
fn a_resting_contact_keeps_its_features() {
    resting_keeps_features::<f32>();
    resting_keeps_features::<f64>();
}

/// Twins in one place: every axis ties, nothing may be NaN, and the depth is the thickness.
#[test]
fn a_body_upon_its_twin_has_a_finite_contact() {
    fn check<R: Everywhere>() {
        let pairs: Vec<Pair> = (0..90).map(|k| pair(Case::Random, k)).map(|[a, _]| [a.clone(), a]).collect();
        let (bodies, slots) = world_of::<R>(&pairs);
        let found = contacts(&bodies, &slots, 0.0);
        for &pair in &slots {
            let (seen, _) = see(&bodies, pair);
            let errors = seen.errors(Some(&found[&pair[0]])).per(R::EPSILON.to_f64() * seen.size());
            assert!(errors.depth.max(errors.left) <= BOUND.left, "{pair:?}: {errors:?}");
        }
    }
    check::<f32>();
    check::<f64>();
}
