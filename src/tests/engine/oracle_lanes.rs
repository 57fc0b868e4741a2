//! Every operation of [`Lanes`] at every width, held to the plain scalar bit by bit; sine and cosine held
//! to std's in `f64`; columns held to a `Vec`.
//!
//! Inputs are drawn from ±0, denormals, infinities, NaN, huge, tiny, half-way and everyday values. NaN is
//! compared as NaN (its payload is the processor's business), all else by bits, the sign of zero included.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina2d::body::Bodies;
use lamina2d::column::{Column, PAD};
use lamina2d::lanes::{LaneMask, Lanes, ROW, Real, f32s, f64s, set_lanes};
use lamina2d::scene::{BodySpec, ShapeSpec};
use lamina2d::vec2::{Rot, Vec2, sin_cos};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Lanes drawn per case: the widest.
const DRAWN: usize = 16;

fn config() -> ProptestConfig {
    // Fewer where `.ci/run` asks for that: on an emulated processor, behind all of them on the real one.
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(2000);
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(0x1a31),
        failure_persistence: None,
        ..Default::default()
    }
}

/// The bits of a value; one pattern for all NaN.
fn bits<R: Real>(x: R) -> u64 {
    let x = x.to_f64();
    if x.is_nan() { u64::MAX } else { x.to_bits() }
}

/// Numbers of all kinds in `f64`; an `f32` test rounds them, which keeps every kind but the payload.
fn number() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        -5e-324,
        f64::from(f32::MAX),
        f64::from(f32::MIN),
        f64::from(f32::MIN_POSITIVE),
        1e-45,
        -1e-45,
        3e-39,
        1e18,
        1e100,
        4_194_303.5,
        -0.5,
        2.5,
        std::f64::consts::FRAC_PI_4,
    ]);
    prop_oneof![
        2 => special,
        1 => any::<u32>().prop_map(|b| f64::from(f32::from_bits(b))),
        1 => any::<u64>().prop_map(f64::from_bits),
        2 => -10.0..10.0f64,
        1 => (-4000..4000i32).prop_map(|k| f64::from(k) / 2.0),
        1 => -1e4..1e4f64,
    ]
}

/// Two operands per lane; a third of the lanes have equal ones, so that `equals` and `le` have work.
fn operands() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let pair = (number(), number(), 0..3u8).prop_map(|(a, b, same)| if same == 0 { (a, a) } else { (a, b) });
    prop::collection::vec(pair, DRAWN)
}

fn rounded<R: Real>(values: impl Iterator<Item = f64>) -> Vec<R> {
    values.map(R::from_f64).collect()
}

type Unary<L> = (&'static str, fn(L) -> L);
type Binary<L> = (&'static str, fn(L, L) -> L);
type Compare<L> = (&'static str, fn(L, L) -> <L as Lanes>::Mask);

fn unary<L: Lanes>() -> [Unary<L>; 4] {
    [("neg", |a| -a), ("sqrt", L::sqrt), ("abs", L::abs), ("round_small", L::round_small)]
}

fn binary<L: Lanes>() -> [Binary<L>; 8] {
    [
        ("+", |a, b| a + b),
        ("-", |a, b| a - b),
        ("*", |a, b| a * b),
        ("/", |a, b| a / b),
        ("min", L::min),
        ("max", L::max),
        ("select by <", |a, b| L::select(a.lt(b), a, b)),
        ("select by not ≤", |a, b| L::select(!a.le(b), b, a)),
    ]
}

fn comparisons<L: Lanes>() -> [Compare<L>; 7] {
    [
        ("lt", L::lt),
        ("le", L::le),
        ("equals", L::equals),
        ("lt & le", |a, b| a.lt(b) & b.le(L::one())),
        ("lt | equals", |a, b| a.lt(b) | a.equals(b)),
        ("!lt", |a, b| !a.lt(b)),
        ("!(le & !equals)", |a, b| !(a.le(b) & !a.equals(b))),
    ]
}

fn arithmetic_is_scalar<L: Lanes>(drawn: &[(f64, f64)]) {
    let a: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.0));
    let b: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.1));
    for at in (0..DRAWN).step_by(L::WIDTH) {
        let (va, vb) = (L::load(&a[at..]), L::load(&b[at..]));
        let check = |name: &str, lanes: L, scalar: &dyn Fn(usize) -> L::Elem| {
            let lanes = lanes.to_array();
            for k in 0..L::WIDTH {
                let (got, want) = (lanes[k], scalar(at + k));
                let (x, y) = (a[at + k], b[at + k]);
                assert_eq!(bits(got), bits(want), "{name}({x}, {y}) = {got}, scalar {want}, ×{}", L::WIDTH);
            }
        };
        for ((name, lane_op), (_, scalar_op)) in unary::<L>().into_iter().zip(unary::<L::Elem>()) {
            check(name, lane_op(va), &|k| scalar_op(a[k]));
        }
        for ((name, lane_op), (_, scalar_op)) in binary::<L>().into_iter().zip(binary::<L::Elem>()) {
            check(name, lane_op(va, vb), &|k| scalar_op(a[k], b[k]));
        }
    }
}

fn masks_are_scalar<L: Lanes>(drawn: &[(f64, f64)]) {
    let a: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.0));
    let b: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.1));
    for at in (0..DRAWN).step_by(L::WIDTH) {
        let (va, vb) = (L::load(&a[at..]), L::load(&b[at..]));
        for ((name, lane_op), (_, scalar_op)) in comparisons::<L>().into_iter().zip(comparisons::<L::Elem>())
        {
            let mask = lane_op(va, vb);
            let want = (0..L::WIDTH)
                .fold(0, |bits, k| bits | u32::from(scalar_op(a[at + k], b[at + k]).bits() != 0) << k);
            assert_eq!(mask.bits(), want, "{name}: bits past the width must be clear, ×{}", L::WIDTH);
            assert_eq!(mask.any(), want != 0, "{name}");
            assert_eq!(set_lanes(want).fold(0, |bits, lane| bits | 1 << lane), want);
        }
    }
}

fn moves_are_copies<L: Lanes>(drawn: &[(f64, f64)], index: &[u32]) {
    let values: Vec<L::Elem> = rounded(drawn.iter().flat_map(|p| [p.0, p.1]));
    let splat = L::splat(values[3]).to_array();
    assert!((0..DRAWN).all(|k| bits(splat[k]) == if k < L::WIDTH { bits(values[3]) } else { 0 }));

    // An odd start: loads and stores take any alignment and touch no more than `WIDTH`.
    let mut stored = [L::Elem::ONE; 20];
    L::load(&values[5..]).store(&mut stored[1..]);
    for (k, value) in stored.iter().enumerate() {
        let inside = (1..=L::WIDTH).contains(&k);
        assert_eq!(bits(*value), if inside { bits(values[4 + k]) } else { bits(L::Elem::ONE) });
    }

    let rows: Vec<[L::Elem; ROW]> = values.chunks_exact(ROW).map(|row| row.try_into().unwrap()).collect();
    let gathered = L::gather_rows(&rows, index);
    for (k, entry) in gathered.map(L::to_array).iter().enumerate() {
        for lane in 0..L::WIDTH {
            assert_eq!(bits(entry[lane]), bits(rows[index[lane] as usize][k]), "gather ×{}", L::WIDTH);
        }
    }
    let mut back = vec![[L::Elem::ONE; ROW]; DRAWN + 1];
    L::store_rows(gathered, &mut back);
    for (lane, row) in back.iter().enumerate() {
        let want = if lane < L::WIDTH { rows[index[lane] as usize] } else { [L::Elem::ONE; ROW] };
        assert_eq!(row.map(bits), want.map(bits), "store_rows ×{}", L::WIDTH);
    }
}

/// Vec2 and Rot written over lanes, each entry held to width 1.
fn geometry_is_scalar<L: Lanes>(drawn: &[(f64, f64)], rotations: &[f64]) {
    let x: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.0));
    let y: Vec<L::Elem> = rounded(drawn.iter().map(|p| p.1));
    let (c, s): (Vec<L::Elem>, Vec<L::Elem>) =
        rotations.iter().map(|t| (L::Elem::from_f64(t.cos()), L::Elem::from_f64(t.sin()))).unzip();
    for at in (0..DRAWN).step_by(L::WIDTH) {
        let (unit, length) = Vec2::new(L::load(&x[at..]), L::load(&y[at..])).normalized();
        let (sin, cos) = sin_cos(L::load(&x[at..]));
        let rot = Rot { c: L::load(&c[at..]), s: L::load(&s[at..]) };
        let turned = rot.turned(L::load(&x[at..]));
        let got = [unit.x, unit.y, length, sin, cos, turned.c, turned.s].map(L::to_array);
        for k in 0..L::WIDTH {
            let j = at + k;
            let (unit, length) = Vec2::new(x[j], y[j]).normalized();
            let (sin, cos) = sin_cos(x[j]);
            let turned = Rot { c: c[j], s: s[j] }.turned(x[j]);
            let want = [unit.x, unit.y, length, sin, cos, turned.c, turned.s];
            assert_eq!(got.map(|entry| bits(entry[k])), want.map(bits), "({}, {}) ×{}", x[j], y[j], L::WIDTH);
        }
    }
}

/// Runs a generic check at every width of both precisions.
macro_rules! at_every_width {
    ($check:ident $(, $argument:expr)*) => {
        $check::<f32s::X1>($($argument),*);
        $check::<f32s::X4>($($argument),*);
        $check::<f32s::X8>($($argument),*);
        $check::<f32s::X16>($($argument),*);
        $check::<f64s::X1>($($argument),*);
        $check::<f64s::X4>($($argument),*);
    };
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_lane_computes_what_the_scalar_computes(drawn in operands()) {
        at_every_width!(arithmetic_is_scalar, &drawn);
    }

    #[test]
    fn a_mask_bit_is_the_scalar_comparison(drawn in operands()) {
        at_every_width!(masks_are_scalar, &drawn);
    }

    #[test]
    fn loads_stores_and_transposes_move_every_bit_to_its_place(
        drawn in operands(),
        index in prop::collection::vec(0..4u32, DRAWN),
    ) {
        at_every_width!(moves_are_copies, &drawn, &index);
    }

    #[test]
    fn unit_vectors_and_rotations_do_not_depend_on_neighbouring_lanes(
        drawn in operands(),
        rotations in prop::collection::vec(-4.0..4.0f64, DRAWN),
    ) {
        at_every_width!(geometry_is_scalar, &drawn, &rotations);
    }

    #[test]
    fn slow_and_fast_spin_share_a_batch(
        slow in prop::collection::vec(-0.785..0.785f64, DRAWN),
        fast in -1e4..1e4f64,
        lane in 0..DRAWN,
    ) {
        // The early exit of `sin_cos` is taken by the whole batch or not at all: its lanes must not notice.
        let mut drawn: Vec<_> = slow.iter().map(|&t| (t, 1.0)).collect();
        drawn[lane].0 = fast;
        at_every_width!(geometry_is_scalar, &drawn, &slow);
    }

    #[test]
    fn a_column_is_a_padded_vec(changes in prop::collection::vec((0..4u8, 0..300usize, number()), 1..30)) {
        column_is_a_vec::<f32>(&changes);
        column_is_a_vec::<f64>(&changes);
    }
}

fn column_is_a_vec<R: Real>(changes: &[(u8, usize, f64)]) {
    let padding = R::FAR;
    let (mut column, mut model) = (Column::new(padding), Vec::new());
    for &(change, at, value) in changes {
        let value = R::from_f64(value);
        match change {
            0 => (column.resize(at), model.resize(at, padding)).1,
            1 => (column.push(value), model.push(value)).1,
            2 => {
                column.as_mut_slice().iter_mut().zip(&mut model).for_each(|(c, m)| (*c, *m) = (value, value));
            }
            _ if model.is_empty() => {}
            _ => (column[at % model.len()], model[at % column.len()]) = (value, value),
        }
        assert_eq!((column.len(), column.is_empty()), (model.len(), model.is_empty()));
        let padded = column.padded();
        assert_eq!(padded.as_ptr() as usize % 64, 0, "columns start on a cache line");
        assert!(padded.len().is_multiple_of(PAD) && padded.len() >= model.len());
        let want = model.iter().copied().chain(std::iter::repeat(padding));
        assert!(padded.iter().zip(want).all(|(&got, want)| bits(got) == bits(want)), "padding is inert");
        assert!(column.as_slice().iter().zip(&model).all(|(&a, &b)| bits(a) == bits(b)));
        let rows = column.rows().as_flattened();
        assert!(rows.len() == padded.len() && rows.iter().zip(padded).all(|(&a, &b)| bits(a) == bits(b)));
    }
    lane_view_is_the_scalar_view::<R, R>(&column);
}

fn lane_view_is_the_scalar_view<R: Real, L: Lanes<Elem = R>>(column: &Column<R>) {
    let lanes = column.lanes::<L>();
    assert_eq!(lanes.len() * L::WIDTH, column.padded().len());
    for (value, scalars) in lanes.iter().zip(column.padded().chunks_exact(L::WIDTH)) {
        assert!(value.to_array().iter().zip(scalars).all(|(&a, &b)| bits(a) == bits(b)));
    }
}

#[test]
fn all_widths_see_the_same_column() {
    for len in [0, 1, 15, 63, 64, 65, 200] {
        let (mut single, mut double) = (Column::<f32>::filled(len, 7.0), Column::<f64>::filled(len, 7.0));
        for k in 0..len {
            (single[k], double[k]) = (k as f32, k as f64);
        }
        lane_view_is_the_scalar_view::<f32, f32s::X4>(&single);
        lane_view_is_the_scalar_view::<f32, f32s::X8>(&single);
        lane_view_is_the_scalar_view::<f32, f32s::X16>(&single);
        lane_view_is_the_scalar_view::<f64, f64s::X4>(&double);
        single.lanes_mut::<f32s::X8>().iter_mut().for_each(|v| *v = -*v);
        assert!(single.as_slice().iter().enumerate().all(|(k, v)| bits(*v) == bits(-(k as f32))));
    }
}

#[test]
fn a_hole_left_by_a_removed_body_is_padding() {
    fn check<R: Real>() {
        let mut bodies = Bodies::<R>::new();
        let body =
            |x: f64| BodySpec::new(ShapeSpec::Box([1.0, 2.0]), [x, 3.0]).turned(0.5).moving([1.0, 2.0], 3.0);
        let ids: Vec<_> = (0..70).map(|k| bodies.insert(&body(f64::from(k))).unwrap()).collect();
        bodies.remove(ids[40]).unwrap();
        let columns = [
            &bodies.x,
            &bodies.y,
            &bodies.c,
            &bodies.s,
            &bodies.vx,
            &bodies.vy,
            &bodies.w,
            &bodies.inv_mass,
            &bodies.inv_inertia,
            &bodies.extent_x,
            &bodies.extent_y,
            &bodies.radius,
            &bodies.friction,
            &bodies.restitution,
        ];
        for (k, column) in columns.into_iter().enumerate() {
            let padding = bits(column.padded()[bodies.len()]);
            assert_eq!(bits(column[41]), padding, "column {k}: hole");
            assert_eq!(bits(column[0]), padding, "column {k}: world");
        }
    }
    check::<f32>();
    check::<f64>();
}

/// The largest error of sine and cosine against std's `f64` over |θ| ≤ 10⁴ rad: two million angles spread
/// evenly, and the neighbourhood of every multiple of π/4, where the quadrant changes.
fn worst_sin_cos_error<R: Real>() -> f64 {
    let spread = (0..2_000_000).map(|k| f64::from(k) * 0.01 + 0.003_7 - 1e4);
    let corners = (-12_732..=12_732).flat_map(|k| {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
        [-1e-3, -1e-7, 0.0, 1e-7, 1e-3].map(|by| angle + by)
    });
    spread.chain(corners).fold(0.0, |worst: f64, angle| {
        let theta = R::from_f64(angle);
        let (sin, cos) = sin_cos(theta);
        let reference = theta.to_f64().sin_cos();
        worst.max((sin.to_f64() - reference.0).abs()).max((cos.to_f64() - reference.1).abs())
    })
}

#[test]
fn sine_and_cosine_keep_their_stated_errors() {
    let (single, double) = (worst_sin_cos_error::<f32>(), worst_sin_cos_error::<f64>());
    println!("sin_cos worst: f32 {single:e}, f64 {double:e}");
    assert!(single <= 1e-7, "f32: {single:e}");
    // std's own error, at most one unit in the last place (1.1e-16), is in this number.
    assert!(double <= 4e-16, "f64: {double:e}");
}

/// The largest | |rot| − 1 | and the error of the angle at the end, both in units of ε, over 10⁶ turns.
fn drift_over_a_million_turns<R: Real>(angle: f64) -> [f64; 2] {
    let angle = R::from_f64(angle);
    let mut rot = Rot { c: R::ONE, s: R::ZERO };
    let mut worst = 0.0f64;
    for _ in 0..1_000_000 {
        rot = rot.turned(angle);
        worst = worst.max((rot.c.to_f64().hypot(rot.s.to_f64()) - 1.0).abs());
    }
    let (end, tau) = (rot.s.to_f64().atan2(rot.c.to_f64()), std::f64::consts::TAU);
    let off = (end - angle.to_f64() * 1e6).rem_euclid(tau);
    [worst, off.min(tau - off)].map(|error| error / R::EPSILON.to_f64())
}

#[test]
fn a_million_turns_keep_length_and_angle() {
    for angle in [1e-6, 3e-3, 0.1, -0.7, 2.0] {
        let (single, double) =
            (drift_over_a_million_turns::<f32>(angle), drift_over_a_million_turns::<f64>(angle));
        println!("turned by {angle}: length and angle f32 {single:?} ε, f64 {double:?} ε");
        for [length, turned] in [single, double] {
            assert!(length <= 1.5, "{angle}: length off by {length} ε");
            assert!(turned <= 1e6, "{angle}: angle off by {turned} ε");
        }
    }
}
