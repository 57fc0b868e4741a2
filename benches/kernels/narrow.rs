//! Manifolds of the pairs of one bucket.

use lamina2d::body::Form;
use lamina2d::internals::{Narrow, run_at};
use lamina2d::lanes::Lanes;

use super::pile::Pile;
use super::{Kernel, SIZES, Stage, answer_of, list_widths, margin};
use crate::common::Answer;

/// Pairs of one bucket.
struct Bucket {
    pile: Pile,
    pairs: Vec<[u32; 2]>,
}

impl Stage for Bucket {
    type Memory<L: Lanes<Elem = f32>> = Narrow<f32>;

    fn elements(&self) -> usize {
        self.pairs.len()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> Narrow<f32> {
        Narrow::default()
    }

    fn run<L: Lanes<Elem = f32>>(&self, narrow: &mut Narrow<f32>) {
        run_at(L::WIDTH, narrow, &self.pile.bodies, &self.pairs, margin());
    }

    fn answer<L: Lanes<Elem = f32>>(&self, narrow: &Narrow<f32>) -> Answer {
        let found = &narrow.manifolds;
        let contacts = found.touching().iter().map(|&place| place as usize).flat_map(|at| {
            let ([a, b], code) = (found.slots(at), found.code(at));
            let names = [a, b, code.points() as u32, code.feature(0).into(), code.feature(1).into()];
            let rows = found.geometry()[at].into_iter().chain(found.gaps()[at]);
            names.map(u64::from).into_iter().chain(rows.map(|value| u64::from(value.to_bits())))
        });
        answer_of(found.len(), contacts)
    }
}

/// A bucket and a mix whose piles fill it.
const BUCKETS: [(&str, [Form; 2], &str); 6] = [
    ("circle-circle", [Form::Circle, Form::Circle], "circles"),
    ("circle-box", [Form::Circle, Form::Box], "all"),
    ("circle-polygon", [Form::Circle, Form::Polygon], "circles_polygons"),
    ("box-box", [Form::Box, Form::Box], "all"),
    ("box-polygon", [Form::Box, Form::Polygon], "all"),
    ("polygon-polygon", [Form::Polygon, Form::Polygon], "polygons"),
];

/// Every bucket.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    for (kernel, forms, mix) in BUCKETS {
        for size in SIZES {
            let kernel = format!("narrow/{kernel}/{size}");
            list_widths(kernels, &kernel, &kernel, move |settled| {
                let pile = Pile::of(settled, mix, size);
                Bucket { pairs: pile.pairs_of(forms), pile }
            });
        }
    }
}
