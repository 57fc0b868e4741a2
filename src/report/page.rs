//! The page: HTML with the plots inside it, and a Markdown summary.

use askama::Template;

use super::plots::Plot;
use super::{Data, Headline, Machine, fitted_exponent};

/// A table as the templates want it.
struct Table {
    title: &'static str,
    command: &'static str,
    note: &'static str,
    header: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

#[derive(Template)]
#[template(path = "page.html", config = "src/report/askama.toml")]
struct Html<'a> {
    machine: &'a Machine,
    features: String,
    quick: bool,
    tables: Vec<Table>,
    plots: &'a [Plot],
}

#[derive(Template)]
#[template(path = "summary.md", config = "src/report/askama.toml", escape = "none")]
struct Markdown<'a> {
    machine: &'a Machine,
    features: String,
    quick: bool,
    tables: Vec<Table>,
}

/// The page, self-contained.
pub(super) fn html(data: &Data, plots: &[Plot]) -> anyhow::Result<String> {
    let features = data.machine.features.join(", ");
    Ok(Html { machine: &data.machine, features, quick: data.quick, tables: tables(data), plots }.render()?)
}

/// The summary.
pub(super) fn markdown(data: &Data) -> anyhow::Result<String> {
    let features = data.machine.features.join(", ");
    Ok(Markdown { machine: &data.machine, features, quick: data.quick, tables: tables(data) }.render()?)
}

/// Header and rows of the result table.
pub(super) fn result_table(data: &Data) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let table = results(data);
    (table.header, table.rows)
}

fn tables(data: &Data) -> Vec<Table> {
    vec![
        results(data),
        matrix(data),
        broad_phase(data),
        determinism(data),
        lanes(data),
        contacts(data),
        stability(data),
        sleep(data),
        skips(data),
        flight(data),
    ]
}

fn times(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "–".to_owned(), |r| format!("{r:.1}×"))
}

fn results(data: &Data) -> Table {
    let row = |h: &Headline| {
        vec![
            h.mix.clone(),
            h.bodies.to_string(),
            h.substeps.to_string(),
            format!("{:.4}", h.ms),
            times(h.times_thesis),
            times(h.times_tidy),
            h.contacts.to_string(),
            format!("{:.1}", h.mean_penetration * 1e3),
            h.thesis_mean_penetration.map_or_else(|| "–".to_owned(), |m| format!("{:.1}", m * 1e3)),
        ]
    };
    Table {
        title: "Against the thesis engine",
        command: "lamina bench",
        note: "Settled, one thread, 8 lanes, default settings with 4 and with 2 substeps, beside the baselines with \
               their Euler and 1 substep; medians of alternating windows in one run. Speed counts only beside the \
               overlap it costs: the last two columns.",
        header: vec![
            "mix",
            "bodies",
            "substeps",
            "ms per step",
            "vs thesis",
            "vs tidy",
            "contacts",
            "mean overlap mm",
            "thesis overlap mm",
        ],
        rows: data.headlines().iter().map(row).collect(),
    }
}

fn matrix(data: &Data) -> Table {
    let row = |r: &super::matrix::Row| {
        vec![
            r.mix.clone(),
            r.integrator.clone(),
            r.bodies.to_string(),
            r.engine.clone(),
            r.lanes.to_string(),
            r.substeps.to_string(),
            format!("{:.4}", r.ms_per_step.min),
            format!("{:.4}", r.ms_per_step.median),
            format!("{:.4}", r.ms_per_step.p99),
            r.contacts.to_string(),
            format!("{:.3}", r.max_penetration),
        ]
    };
    Table {
        title: "Performance: shape mix × integrator",
        command: "lamina bench",
        note: "The thesis's performance and complexity experiments: settled bodies, every step timed. \
               Lane widths of one integrator must end in the same bits, or the bench fails.",
        header: vec![
            "mix",
            "integrator",
            "bodies",
            "engine",
            "lanes",
            "substeps",
            "min ms",
            "median ms",
            "p99 ms",
            "contacts",
            "max overlap m",
        ],
        rows: data.matrix.iter().map(row).collect(),
    }
}

fn broad_phase(data: &Data) -> Table {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for engine in ["lamina2d", "tidy", "thesis"] {
        let own: Vec<_> = data.broad_phase.iter().filter(|r| r.engine == engine).collect();
        for row in &own {
            rows.push(vec![
                engine.to_owned(),
                row.bodies.to_string(),
                format!("{:.4}", row.on_ms),
                format!("{:.4}", row.off_ms),
                format!("{:.2}", row.off_ms / row.on_ms),
            ]);
        }
        let exponent = |time: fn(&super::broad_phase::Row) -> f64| {
            let points: Vec<_> = own.iter().map(|r| (r.bodies as f64, time(r))).collect();
            fitted_exponent(&points).map_or_else(String::new, |p| format!("N^{p:.2}"))
        };
        let (on, off) = (exponent(|r| r.on_ms), exponent(|r| r.off_ms));
        rows.push(vec![engine.to_owned(), "fitted".to_owned(), on, off, String::new()]);
    }
    Table {
        title: "Broad phase on and off",
        command: "lamina bench",
        note: "Polygons. On and off must end in the same state, or the bench fails.",
        header: vec!["engine", "bodies", "on ms", "off ms", "off/on"],
        rows,
    }
}

fn determinism(data: &Data) -> Table {
    let row = |r: &super::determinism::Row| {
        vec![
            r.engine.clone(),
            r.integrator.clone(),
            r.stepping.to_string(),
            r.seconds.to_string(),
            if r.identical { "yes" } else { "no" }.to_owned(),
            format!("{:.2e}", r.max_apart_m),
            r.from_semi_implicit_m.map_or_else(|| "–".to_owned(), |d| format!("{d:.2e}")),
        ]
    };
    Table {
        title: "Determinism: two runs",
        command: "lamina determinism",
        note: "Six bodies. A frame lasts 1/60 s plus what this machine took for it, so variable steps never repeat.",
        header: vec![
            "engine",
            "integrator",
            "step",
            "seconds",
            "same bits",
            "max apart m",
            "from semi-implicit m",
        ],
        rows: data.determinism.iter().map(row).collect(),
    }
}

fn lanes(data: &Data) -> Table {
    let row = |r: &super::lanes::Row| {
        vec![
            r.kernel.to_owned(),
            r.scene.to_owned(),
            r.lanes.to_string(),
            r.elements.to_string(),
            format!("{:.3}", r.ns_per_element),
            format!("{:.2}×", r.speed_up),
        ]
    };
    Table {
        title: "Lanes",
        command: "lamina report",
        note: "Each kernel alone on the same settled bodies; an element is a pair tested, a pair collided, a body advanced.",
        header: vec!["kernel", "scene", "lanes", "elements", "ns per element", "over 1 lane"],
        rows: data.lanes.iter().map(row).collect(),
    }
}

fn contacts(data: &Data) -> Table {
    let row = |r: &super::contacts::Row| {
        let mut cells = vec![
            r.scene.to_owned(),
            r.lanes.to_string(),
            r.bodies.to_string(),
            r.contacts.to_string(),
            format!("{:.4}", r.ms_per_step),
            format!("{:.2}", r.ns_per_contact_and_pass),
            format!("{:.2}×", r.solve_speed_up),
            r.bytes_per_contact.map(|bytes| bytes.to_string()).join(" / "),
        ];
        cells.extend(r.shares.map(|share| format!("{:.0} %", share * 100.0)));
        cells
    };
    Table {
        title: "Contacts: where a step goes",
        command: "lamina report",
        note: "Settled piles with `soft`, 4 substeps of two passes. Bytes: what a pass streams of a two-point and a \
               one-point contact, its bodies' rows not counted.",
        header: vec![
            "scene",
            "lanes",
            "bodies",
            "contacts",
            "ms per step",
            "ns per contact and pass",
            "solve over 1 lane",
            "bytes",
            "broad",
            "narrow",
            "prepare",
            "integrate",
            "solve",
            "measure",
        ],
        rows: data.contacts.iter().map(row).collect(),
    }
}

fn stability(data: &Data) -> Table {
    let row = |r: &super::stability::Row| {
        vec![
            r.scene.to_owned(),
            r.solver.to_string(),
            r.substeps.to_string(),
            r.seconds.to_string(),
            format!("{:.4}", r.ms_per_step),
            format!("{:.2}", r.max_penetration * 1e3),
            format!("{:.2}", r.mean_penetration * 1e3),
            format!("{:.1e}", r.rms_speed),
            format!("{:.3}", r.moved),
            format!("{:.4}", r.drift),
            r.failed.clone().unwrap_or_else(|| "–".to_owned()),
        ]
    };
    Table {
        title: "Stability: run time against error",
        command: "lamina report",
        note: "Piles left to stand. Moved: the farthest any body is from where it began, which is what it has sunk; \
               a body's size or more says that it fell. Drift: since half the time. `avbd` visits contacts ten times per \
               substep, `pgs` eight times, `soft` and `xpbd` twice. `sag`: substeps per island (`--max-sag`).",
        header: vec![
            "scene",
            "solver",
            "substeps",
            "seconds",
            "ms per step",
            "max overlap mm",
            "mean overlap mm",
            "rms speed m/s",
            "moved m",
            "drift m",
            "broke off",
        ],
        rows: data.stability.iter().map(row).collect(),
    }
}

fn sleep(data: &Data) -> Table {
    let row = |r: &super::sleep::Row| {
        vec![
            r.scene.to_owned(),
            r.substeps.to_string(),
            r.bodies.to_string(),
            r.slept_after.map_or_else(|| "–".to_owned(), |steps| steps.to_string()),
            format!("{:.4}", r.awake_ms),
            format!("{:.5}", r.asleep_ms),
            format!("{:.3} %", r.share * 100.0),
            format!("{:.2}", r.beside_us),
            format!("{:.2}", r.alone_us),
            format!("{:.2}", r.ns_per_sleeper),
        ]
    };
    Table {
        title: "Sleep",
        command: "lamina report",
        note: "Piles with sleep on: a step awake, a step when all sleep, and a step in which one other body flies by \
               at 50 m/s, which finds its pairs anew in every step: beside the pile and without it.",
        header: vec![
            "scene",
            "substeps",
            "bodies",
            "asleep after steps",
            "awake ms",
            "asleep ms",
            "asleep / awake",
            "beside a flier µs",
            "flier alone µs",
            "ns per sleeper",
        ],
        rows: data.sleep.iter().map(row).collect(),
    }
}

fn skips(data: &Data) -> Table {
    let row = |r: &super::skips::Row| {
        vec![
            r.scene.to_owned(),
            r.integrator.to_string(),
            r.skip.to_owned(),
            format!("{:.4}", r.on_ms),
            format!("{:.4}", r.off_ms),
            format!("{:.1} %", r.saved * 100.0),
            if r.same_hash { "yes" } else { "no" }.to_owned(),
            r.spared.to_string(),
            r.max_penetration_m.map(|m| format!("{:.3}", m * 1e3)).join(" / "),
            r.kinetic_energy_j.map(|j| format!("{j:.1e}")).join(" / "),
        ]
    };
    Table {
        title: "Skips",
        command: "lamina report",
        note: "All exact skips on, against all but one, and against none (exact); reused manifolds on top of all, \
               against without. Overlap and energy: on / off.",
        header: vec![
            "scene",
            "integrator",
            "skip off",
            "on ms",
            "off ms",
            "saved",
            "same bits",
            "spared",
            "max overlap mm",
            "kinetic energy J",
        ],
        rows: data.skips.iter().map(row).collect(),
    }
}

fn flight(data: &Data) -> Table {
    let row = |r: &super::flight::Row| {
        vec![
            r.bodies.to_string(),
            r.integrator.to_string(),
            format!("{:.3}", r.ns_per_body),
            r.bytes_per_body.to_string(),
            format!("{:.1}", r.gb_per_s),
            format!("{:.1}", r.copy_gb_per_s),
            format!("{:.0} %", r.share * 100.0),
        ]
    };
    Table {
        title: "Free flight against copy bandwidth",
        command: "lamina report",
        note: "The integration pass alone, 8 lanes, beside a copy that reads and writes as many bytes in the same run.",
        header: vec!["bodies", "integrator", "ns per body", "bytes per body", "GB/s", "copy GB/s", "share"],
        rows: data.flight.iter().map(row).collect(),
    }
}
