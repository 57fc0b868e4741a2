//! What a reader sees of the rows: which cases pass, and up to where they hold.

use serde::Serialize;

use lamina2d::settings::Solver;

use super::run::Row;
use super::table::CASES;
use crate::present::Record;
use crate::present::table::{or_dash, significant, yes_no};

/// What is shown side by side: solvers and substeps.
const SHOWN: [(Solver, u32); 7] = [
    (Solver::Soft, 4),
    (Solver::Soft, 8),
    (Solver::Soft, 16),
    (Solver::Impulse, 8),
    (Solver::Pgs, 8),
    (Solver::Xpbd, 8),
    (Solver::Avbd, 8),
];
/// Their columns' heads.
const HEADS: [&str; 7] = ["soft ×4", "soft ×8", "soft ×16", "impulse ×8", "pgs ×8", "xpbd ×8", "avbd ×8"];
/// Of those, what misses are explained for.
const DEFAULT: usize = 1;

/// Heads of a table's columns: some, those of what is shown, some more.
const fn headers<const N: usize>(before: &[&'static str], after: &[&'static str]) -> [&'static str; N] {
    let mut all = [""; N];
    let (mut at, mut k) = (0, 0);
    let parts: [&[&'static str]; 3] = [before, &HEADS, after];
    while k < parts.len() {
        let mut j = 0;
        while j < parts[k].len() {
            all[at] = parts[k][j];
            (at, j) = (at + 1, j + 1);
        }
        k += 1;
    }
    all
}

/// One number or word for each of what is shown; null where it was not run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Columns<T> {
    /// The default solver, 4 substeps.
    pub soft_4: T,
    /// 8 substeps.
    pub soft_8: T,
    /// 16 substeps.
    pub soft_16: T,
    /// The others, 8 substeps.
    pub impulse_8: T,
    /// See `impulse_8`.
    pub pgs_8: T,
    /// See `impulse_8`.
    pub xpbd_8: T,
    /// See `impulse_8`.
    pub avbd_8: T,
}

impl<T> Columns<T> {
    fn of(rows: &[&Row], value: impl Fn(Option<&Row>) -> T) -> Self {
        let at = |k: usize| {
            let (solver, substeps) = SHOWN[k];
            value(rows.iter().copied().find(|row| row.solver == solver && row.substeps == substeps))
        };
        Self {
            soft_4: at(0),
            soft_8: at(1),
            soft_16: at(2),
            impulse_8: at(3),
            pgs_8: at(4),
            xpbd_8: at(5),
            avbd_8: at(6),
        }
    }

    fn cells(&self, cell: impl Fn(&T) -> String) -> [String; 7] {
        let Self { soft_4, soft_8, soft_16, impulse_8, pgs_8, xpbd_8, avbd_8 } = self;
        [soft_4, soft_8, soft_16, impulse_8, pgs_8, xpbd_8, avbd_8].map(cell)
    }
}

/// A case, and which solvers pass it.
#[derive(Clone, Debug, Serialize)]
pub struct PassLine {
    /// Its item in the list of cases.
    pub item: String,
    /// Its name.
    pub case: String,
    /// What must hold.
    pub threshold: String,
    /// What the default solver has at 8 substeps.
    pub found: Vec<Option<f64>>,
    /// Who passes.
    pub pass: Columns<Option<bool>>,
}

impl Record for PassLine {
    const NAME: &'static str = "stress";
    const TITLE: &'static str = "What holds";
    const COMMAND: &'static str = "lamina stress --limit --out reports/stress";
    const NOTE: &'static str = "The table of stability: the default solver with 4, 8 and 16 substeps, the others with 8, 60 steps a \
                                second, without sleep. `found` is what the default solver has with 8.";
    const HEADER: &'static [&'static str] = &headers::<10>(&["case"], &["must hold", "found"]);

    fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.case.clone()];
        cells.extend(self.pass.cells(|pass| or_dash(pass.map(yes_no))));
        cells.extend([self.threshold.clone(), found_cell(&self.found)]);
        cells
    }
}

/// A case, and the number up to which it holds.
#[derive(Clone, Debug, Serialize)]
pub struct LimitLine {
    /// Its name.
    pub case: String,
    /// What the number is, with its unit.
    pub parameter: String,
    /// Where the table looks.
    pub value: f64,
    /// In words: a number, `≥` where the harshest that was tried holds, `none` where not even the mildest does.
    pub limit: Columns<String>,
}

impl Record for LimitLine {
    const NAME: &'static str = "stress_limits";
    const TITLE: &'static str = "Up to where it holds";
    const COMMAND: &'static str = PassLine::COMMAND;
    const NOTE: &'static str = "The number each case is a function of, made harsher by twos from what is asked until something breaks that must hold \
                                (or milder, until all holds), then \
                                halved to one part in twenty; in runs of the length of quick ones. ≥: the harshest that was tried holds.";
    const HEADER: &'static [&'static str] = &headers::<10>(&["case", "number", "asked"], &[]);

    fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.case.clone(), self.parameter.clone(), significant(self.value)];
        cells.extend(self.limit.cells(String::clone));
        cells
    }
}

/// What was found, as a cell has it.
pub(super) fn found_cell(found: &[Option<f64>]) -> String {
    let found: Vec<_> = found.iter().map(|found| or_dash(found.map(significant))).collect();
    found.join(", ")
}

/// The limit of a row, as a cell has it.
pub(super) fn limit_cell(row: &Row) -> String {
    match (row.limit, row.limit_note.as_deref()) {
        (Some(limit), Some("harshest")) => format!("≥ {}", significant(limit)),
        (Some(limit), _) => significant(limit),
        (None, Some(_)) => "none".to_owned(),
        (None, None) => "–".to_owned(),
    }
}

/// Rows of each case, in the table's order.
fn by_case(rows: &[Row]) -> impl Iterator<Item = Vec<&Row>> {
    let of = |name: &str| -> Vec<&Row> { rows.iter().filter(|row| row.case == name).collect() };
    CASES.iter().map(move |case| of(case.name)).filter(|rows| !rows.is_empty())
}

/// Who passes what.
pub fn pass_lines(rows: &[Row]) -> Vec<PassLine> {
    let line = |rows: Vec<&Row>| {
        let (solver, substeps) = SHOWN[DEFAULT];
        let ours = rows.iter().find(|row| row.solver == solver && row.substeps == substeps);
        PassLine {
            item: rows[0].item.clone(),
            case: rows[0].case.clone(),
            threshold: rows[0].threshold.clone(),
            found: ours.map_or_else(Vec::new, |row| row.found.clone()),
            pass: Columns::of(&rows, |row| row.map(|row| row.pass)),
        }
    };
    by_case(rows).map(line).collect()
}

/// Up to where each holds; nothing where that was not sought.
pub fn limit_lines(rows: &[Row]) -> Vec<LimitLine> {
    let sought = |rows: &Vec<&Row>| rows.iter().any(|row| row.limit_note.is_some() || row.limit.is_some());
    let line = |rows: Vec<&Row>| LimitLine {
        case: rows[0].case.clone(),
        parameter: format!("{} {}", rows[0].parameter, rows[0].unit).trim_end().to_owned(),
        value: rows[0].value,
        limit: Columns::of(&rows, |row| row.map_or_else(|| "–".to_owned(), limit_cell)),
    };
    by_case(rows).filter(sought).map(line).collect()
}

/// Items of the list of cases, and how many of them pass in all their cases: of what is shown, in its order.
pub fn passed_items(rows: &[Row]) -> Vec<(String, usize, usize)> {
    let count = |&(solver, substeps): &(Solver, u32)| {
        let rows: Vec<&Row> =
            rows.iter().filter(|row| row.solver == solver && row.substeps == substeps).collect();
        let mut items: Vec<&str> = rows.iter().map(|row| row.item.as_str()).collect();
        items.dedup();
        let holds = |item: &&&str| rows.iter().all(|row| row.item != **item || row.pass);
        let passed = items.iter().filter(holds).count();
        (format!("{solver} ×{substeps}"), passed, items.len())
    };
    SHOWN.iter().map(count).filter(|(_, _, items)| *items > 0).collect()
}

/// What the rows answer, in sentences.
pub fn answers(rows: &[Row]) -> Vec<String> {
    let passed: Vec<String> =
        passed_items(rows).iter().map(|(who, passed, items)| format!("{who} {passed} of {items}")).collect();
    if passed.is_empty() {
        return Vec::new();
    }
    let mut all = vec![format!("Items of the table of stability that hold: {}.", passed.join(", "))];
    let (solver, substeps) = SHOWN[DEFAULT];
    let ours = || rows.iter().filter(|row| row.solver == solver && row.substeps == substeps);
    let list = |does: fn(&&Row) -> bool, what: fn(&Row) -> String| -> Vec<String> {
        ours().filter(does).map(what).collect()
    };
    let directly =
        list(|row| row.direct_joints > 0, |row| format!("{} joints of {}", row.direct_joints, row.case));
    if !directly.is_empty() {
        all.push(format!(
            "A direct solve takes over in {solver} where joints make up trees whose masses are 64 apart, or their ratio \
             times the number of joints squared is 4096 (of nets, 256): {}.",
            directly.join(", ")
        ));
    }
    let paced =
        list(|row| row.most_substeps > row.substeps, |row| format!("{} in {}", row.most_substeps, row.case));
    if !paced.is_empty() {
        all.push(format!(
            "Islands in which a slender stack would buckle with {substeps} substeps get more of themselves: {}.",
            paced.join(", ")
        ));
    }
    all.extend(ours().filter(|row| !row.pass).map(|row| {
        let case = CASES.iter().find(|case| case.name == row.case);
        let [about, why] = [case.map_or("", |case| case.about), case.map_or("", |case| case.missed)];
        let broke = row.failed.as_ref().map_or_else(String::new, |failed| format!("; broke off: {failed}"));
        let why = if why.is_empty() { String::new() } else { format!(": {why}") };
        format!(
            "{} ({about}) does not hold with {solver} ×{substeps}: {} asked, {} found{broke}{why}.",
            row.case,
            row.threshold,
            found_cell(&row.found)
        )
    }));
    all
}
