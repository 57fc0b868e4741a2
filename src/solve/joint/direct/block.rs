//! Numbers of the direct solve: three rows of a joint against three of another.

/// A number per row of a joint.
pub(super) type Triple = [f64; 3];
/// 3×3, by rows.
pub(super) type Block = [Triple; 3];

/// A pivot that has all but vanished, as a share of its entry: well under what nets add to theirs.
const LEAST_PIVOT: f64 = 1e-5;

pub(super) fn transposed(a: Block) -> Block {
    crate::each::indexed(|i| crate::each::indexed(|j| a[j][i]))
}

pub(super) fn times(a: Block, b: Block) -> Block {
    let at = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    crate::each::indexed(|i| crate::each::indexed(|j| at(i, j)))
}

pub(super) fn minus(a: Block, b: Block) -> Block {
    crate::each::indexed(|i| crate::each::indexed(|j| a[i][j] - b[i][j]))
}

pub(super) fn apply(a: Block, v: Triple) -> Triple {
    crate::each::indexed(|i| a[i][0] * v[0] + a[i][1] * v[1] + a[i][2] * v[2])
}

/// Of a symmetric matrix with pivots that may all but vanish: L·D·Lᵀ, in which they do one by one.
pub(super) fn inverse_by_pivots(a: Block) -> Block {
    let pivot = |rest: f64, whole: f64| rest.max(LEAST_PIVOT * whole).max(f64::MIN_POSITIVE);
    let d0 = pivot(a[0][0], a[0][0]);
    let [l1, l2] = [a[1][0] / d0, a[2][0] / d0];
    let d1 = pivot(a[1][1] - l1 * a[1][0], a[1][1]);
    let below = a[2][1] - l2 * a[1][0];
    let l3 = below / d1;
    let d2 = pivot(a[2][2] - l2 * a[2][0] - l3 * below, a[2][2]);
    let column = |k: usize| {
        let y0 = f64::from(u8::from(k == 0));
        let y1 = f64::from(u8::from(k == 1)) - l1 * y0;
        let y2 = f64::from(u8::from(k == 2)) - l2 * y0 - l3 * y1;
        let x2 = y2 / d2;
        let x1 = y1 / d1 - l3 * x2;
        [y0 / d0 - l1 * x1 - l2 * x2, x1, x2]
    };
    [0, 1, 2].map(column)
}

/// Of a symmetric matrix, by its adjoint; zeros where nothing yields.
pub(super) fn inverse(a: Block) -> Block {
    let minor = |i: usize, j: usize| {
        let ([i, k], [j, l]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        a[i][j] * a[k][l] - a[i][l] * a[k][j]
    };
    let determinant = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
    if determinant <= 0.0 {
        return [[0.0; 3]; 3];
    }
    crate::each::indexed(|i| crate::each::indexed(|j| minor(j, i) / determinant))
}
