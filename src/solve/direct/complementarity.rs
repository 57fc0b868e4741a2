//! λ ≥ 0, w = K·λ + q ≥ 0, λ·w = 0: a linear complementarity problem with a symmetric positive definite matrix.
//!
//! Principal pivoting: rows are taken for active (w = 0) or not (λ = 0), the active ones solved by a Cholesky factorisation,
//! and rows that are wrong change sides, all at once while that leaves fewer wrong, else the last of them alone, which
//! ends (Murty 1974; Júdice and Pires 1994, block pivoting). Rows that depend on each other, as the corners of a table with
//! more legs than it needs, share by a part of 10⁻⁹ that is added to the diagonal.

/// Added to the diagonal, as a share of it.
const SHARED: f64 = 1e-9;
/// Rows are right to this share of the largest.
const TOLERANCE: f64 = 1e-10;
/// Rounds of all at once without progress before rows change one by one.
const PATIENCE: u32 = 4;

/// One problem; memory is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Complementarity {
    rows: usize,
    /// K, row by row.
    matrix: Vec<f64>,
    /// What is added to its diagonal.
    compliance: Vec<f64>,
    /// q.
    constant: Vec<f64>,
    answer: Vec<f64>,
    active: Vec<bool>,
    /// Numbers of the active rows.
    chosen: Vec<usize>,
    factor: Vec<f64>,
    wrong: Vec<usize>,
}

impl Complementarity {
    /// A problem of so many rows.
    pub(super) fn begin(&mut self, rows: usize) {
        self.rows = rows;
        self.matrix.clear();
        self.matrix.resize(rows * rows, 0.0);
        self.compliance.clear();
        self.compliance.resize(rows, 0.0);
        self.constant.clear();
        self.constant.resize(rows, 0.0);
        self.answer.clear();
        self.answer.resize(rows, 0.0);
        self.active.clear();
        self.active.resize(rows, false);
    }

    /// An entry of K and the one it mirrors; 0 on the diagonal where nothing yields.
    pub(super) fn set(&mut self, i: usize, j: usize, value: f64) {
        let value = if i != j {
            value
        } else if value > 0.0 {
            value * (1.0 + SHARED)
        } else {
            1.0
        };
        self.matrix[i * self.rows + j] = value;
        self.matrix[j * self.rows + i] = value;
    }

    /// Velocity over what it is to be at least, with the impulse there is; the row gives way by `compliance`, 1/kg.
    pub(super) fn want(&mut self, i: usize, over: f64, impulse: f64, compliance: f64) {
        self.constant[i] = over;
        self.answer[i] = impulse;
        self.compliance[i] = compliance;
    }

    /// λ of a row.
    pub(super) fn answer(&self, i: usize) -> f64 {
        self.answer[i]
    }

    /// Solves it, beginning with the rows active that carry something; says whether it could.
    pub(super) fn solve(&mut self) -> bool {
        let rows = self.rows;
        for i in 0..rows {
            let given: f64 = (0..rows).map(|j| self.matrix[i * rows + j] * self.answer[j]).sum();
            self.active[i] = self.answer[i] > 0.0;
            self.constant[i] -= given;
        }
        for i in 0..rows {
            self.matrix[i * rows + i] += self.compliance[i];
        }
        let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
        for _ in 0..(8 * rows + 16) {
            self.solve_active();
            self.find_wrong();
            let wrong = self.wrong.len();
            if wrong == 0 {
                return true;
            }
            if wrong < fewest {
                (fewest, patience) = (wrong, PATIENCE);
            } else {
                patience = patience.saturating_sub(1);
            }
            let from = if patience > 0 { 0 } else { wrong - 1 };
            for k in from..wrong {
                let row = self.wrong[k];
                self.active[row] = !self.active[row];
            }
        }
        false
    }

    /// λ of the active rows by Cholesky's factorisation, zeros elsewhere.
    fn solve_active(&mut self) {
        let Self { rows, matrix, constant, answer, active, chosen, factor, .. } = self;
        chosen.clear();
        chosen.extend((0..*rows).filter(|&i| active[i]));
        answer.fill(0.0);
        let n = chosen.len();
        factor.clear();
        factor.resize(n * n, 0.0);
        for i in 0..n {
            for j in 0..=i {
                let given: f64 = (0..j).map(|k| factor[i * n + k] * factor[j * n + k]).sum();
                let rest = matrix[chosen[i] * *rows + chosen[j]] - given;
                factor[i * n + j] = if i == j {
                    // What round-off leaves of a row that others hold yields nothing.
                    rest.max(SHARED * SHARED * matrix[chosen[i] * *rows + chosen[i]]).sqrt()
                } else {
                    rest / factor[j * n + j]
                };
            }
        }
        for i in 0..n {
            let given: f64 = (0..i).map(|k| factor[i * n + k] * answer[chosen[k]]).sum();
            answer[chosen[i]] = (-constant[chosen[i]] - given) / factor[i * n + i];
        }
        for i in (0..n).rev() {
            let given: f64 = (i + 1..n).map(|k| factor[k * n + i] * answer[chosen[k]]).sum();
            answer[chosen[i]] = (answer[chosen[i]] - given) / factor[i * n + i];
        }
    }

    /// Active rows that pull, and others that close.
    fn find_wrong(&mut self) {
        let Self { rows, matrix, constant, answer, active, wrong, .. } = self;
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let (least_answer, least_over) = (-TOLERANCE * largest(answer), -TOLERANCE * largest(constant));
        wrong.clear();
        for i in 0..*rows {
            let is_wrong = if active[i] {
                answer[i] < least_answer
            } else {
                let given: f64 = (0..*rows).map(|j| matrix[i * *rows + j] * answer[j]).sum();
                constant[i] + given < least_over
            };
            if is_wrong {
                wrong.push(i);
            }
        }
    }
}
