//! Penetration of any engine's bodies, from outlines and poses alone, in `f64`.
//!
//! Independent of the kernels under test: separating axes over explicit vertices, one pair at a time,
//! candidates by a plain sweep over axis-aligned bounds.

/// A body as a picture: a disc, or a convex outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Centre of the disc, or any point the outline is given about; metres.
    pub centre: [f64; 2],
    /// Radius of a disc; 0 for outlines.
    pub radius: f64,
    /// Vertices, counter-clockwise, world coordinates; empty for discs.
    pub vertices: Vec<[f64; 2]>,
    /// Cannot move: pairs of such bodies do not count.
    pub fixed: bool,
}

/// How far bodies overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Penetration {
    /// The largest depth of any pair, metres; 0 where nothing overlaps.
    pub max: f64,
    /// The mean depth of all pairs that overlap, metres; 0 where none does.
    pub mean: f64,
    /// Pairs that overlap.
    pub pairs: usize,
}

/// The overlaps of all pairs of which at least one can move.
pub fn penetration(outlines: &[Outline]) -> Penetration {
    let depths = depths(outlines);
    let (max, sum) = depths.iter().fold((0.0f64, 0.0), |(max, sum), depth| (max.max(*depth), sum + depth));
    let pairs = depths.len();
    Penetration { max, mean: if pairs == 0 { 0.0 } else { sum / pairs as f64 }, pairs }
}

/// How deep each pair overlaps that does and of which at least one can move, metres, in no particular order.
pub fn depths(outlines: &[Outline]) -> Vec<f64> {
    let bounds: Vec<[f64; 4]> = outlines.iter().map(bounds).collect();
    let mut order: Vec<usize> = (0..outlines.len()).collect();
    order.sort_by(|&a, &b| bounds[a][0].total_cmp(&bounds[b][0]));
    let mut depths = Vec::new();
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| bounds[b][0] <= bounds[a][2]) {
            let apart = bounds[a][1] > bounds[b][3] || bounds[b][1] > bounds[a][3];
            if apart || (outlines[a].fixed && outlines[b].fixed) {
                continue;
            }
            let depth = -separation(&outlines[a], &outlines[b]);
            if depth > 0.0 {
                depths.push(depth);
            }
        }
    }
    depths
}

/// Left, bottom, right, top.
fn bounds(outline: &Outline) -> [f64; 4] {
    if outline.vertices.is_empty() {
        let ([x, y], r) = (outline.centre, outline.radius);
        return [x - r, y - r, x + r, y + r];
    }
    outline.vertices.iter().fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |b, v| {
        [b[0].min(v[0]), b[1].min(v[1]), b[2].max(v[0]), b[3].max(v[1])]
    })
}

/// Signed distance where the bodies overlap (negative depth); where they do not, any positive number.
fn separation(a: &Outline, b: &Outline) -> f64 {
    match (a.vertices.is_empty(), b.vertices.is_empty()) {
        (true, true) => {
            let [dx, dy] = [b.centre[0] - a.centre[0], b.centre[1] - a.centre[1]];
            dx.hypot(dy) - a.radius - b.radius
        }
        (true, false) => disc_separation(a, b),
        (false, true) => disc_separation(b, a),
        (false, false) => axes_separation(a, b).max(axes_separation(b, a)),
    }
}

fn edges(outline: &Outline) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    let next = outline.vertices.iter().cycle().skip(1);
    outline.vertices.iter().zip(next).map(|(&p, &q)| (p, q))
}

/// Outward normal of a counter-clockwise edge.
fn normal(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let length = dx.hypot(dy);
    [dy / length, -dx / length]
}

fn axes_separation(a: &Outline, b: &Outline) -> f64 {
    edges(a)
        .map(|(p, q)| {
            let n = normal(p, q);
            b.vertices.iter().map(|v| n[0] * (v[0] - p[0]) + n[1] * (v[1] - p[1])).fold(f64::MAX, f64::min)
        })
        .fold(f64::MIN, f64::max)
}

/// Distance of the disc's centre from the outline (negative inside), less the radius.
fn disc_separation(disc: &Outline, outline: &Outline) -> f64 {
    let c = disc.centre;
    let inside = edges(outline)
        .map(|(p, q)| {
            let n = normal(p, q);
            n[0] * (c[0] - p[0]) + n[1] * (c[1] - p[1])
        })
        .fold(f64::MIN, f64::max);
    if inside <= 0.0 {
        return inside - disc.radius;
    }
    let nearest = edges(outline)
        .map(|(p, q)| {
            let (ex, ey) = (q[0] - p[0], q[1] - p[1]);
            let t = (((c[0] - p[0]) * ex + (c[1] - p[1]) * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
            (p[0] + t * ex - c[0]).hypot(p[1] + t * ey - c[1])
        })
        .fold(f64::MAX, f64::min);
    nearest - disc.radius
}
