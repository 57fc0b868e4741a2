//! SVG plots of a report's rows, and its strips of frames.

pub(crate) use std::borrow::Cow;

use crate::present::chart::{Series, Slope, bars, heat_map, log_log, stacked};

use lamina2d::measure::Stage;
use lamina2d::settings::Solver;

use super::experiments::{accuracy, broad_phase, contacts, matrix, stability};
use super::peers::{self, Peers};
use super::strip::Strip;
use super::{Data, Record, fitted_exponent};
use crate::accuracy::Line;
use crate::present::Earlier;

/// One drawing.
#[derive(Clone, Debug)]
pub(super) struct Plot {
    /// File name in the report's folder.
    pub(super) file: Cow<'static, str>,
    /// What it shows, for those who cannot see it.
    pub(super) about: String,
    /// The command that makes its rows.
    pub(super) command: &'static str,
    /// The commands that record what it shows, and open the recording.
    pub(super) replay: Option<[String; 2]>,
    /// The run it shows; `None` for the report's own.
    pub(super) earlier: Option<Earlier>,
    /// The drawing.
    pub(super) svg: String,
}

/// All plots of a report that have something to show.
pub(super) fn draw(data: &Data) -> anyhow::Result<Vec<Plot>> {
    type Draw = fn(&Data) -> anyhow::Result<Plot>;
    let peers = data.peers.is_some();
    let all: [(bool, Draw); 10] = [
        (peers, peers_times_faster),
        (peers, |data| peers_sweep(data, &OVERLAP)),
        (peers, |data| peers_sweep(data, &SAG)),
        (!data.matrix.is_empty(), times_faster),
        (!data.matrix.is_empty(), time_against_bodies),
        (!data.matrix.is_empty(), mix_by_integrator),
        (!data.stability.is_empty(), time_against_overlap),
        (!data.broad_phase.is_empty(), broad_on_off),
        (!data.contacts.is_empty(), stages),
        (!data.lanes.is_empty(), lanes_speed_up),
    ];
    let drawn = all.into_iter().filter(|(has_rows, _)| *has_rows).map(|(_, draw)| draw(data));
    let of_peers = data.peers.as_ref().map(|peers| peers.machine.clone());
    let drawn = drawn.map(|plot| {
        plot.map(|plot| {
            let earlier = of_peers.clone().filter(|_| plot.file.starts_with("peers_"));
            Plot { earlier, ..plot }
        })
    });
    let own = data.accuracy.drawings.iter().map(|drawing| Ok(case(drawing, None)));
    let earlier = data.earlier_accuracy.iter().flat_map(|sweep| {
        sweep.drawings.iter().map(|drawing| Ok(case(drawing, Some(sweep.machine.clone()))))
    });
    drawn.chain(own).chain(earlier).chain(data.strips.iter().map(|strip| Ok(frames(strip)))).collect()
}

fn frames(strip: &Strip) -> Plot {
    Plot {
        file: strip.file.into(),
        about: strip.about.clone(),
        command: "lamina report",
        replay: Some(strip.replay.clone()),
        earlier: None,
        svg: strip.svg.clone(),
    }
}

fn case(drawing: &accuracy::Drawing, earlier: Option<Earlier>) -> Plot {
    Plot {
        file: drawing.file.clone().into(),
        about: drawing.about.clone(),
        command: Line::COMMAND,
        replay: None,
        earlier,
        svg: drawing.svg.clone(),
    }
}

fn time_against_bodies(data: &Data) -> anyhow::Result<Plot> {
    let engines = [("lamina2d", 8), ("lamina2d", 1), ("tidy", 1), ("thesis", 1)];
    let series = engines.map(|(engine, lanes)| {
        let wanted = |row: &&matrix::Row| {
            row.engine == engine
                && row.lanes == lanes
                && row.mix == "polygons"
                && row.substeps != 2
                && row.integrator == "semi_implicit_euler"
        };
        let points: Vec<_> =
            data.matrix.iter().filter(wanted).map(|r| (r.bodies as f64, r.ms_per_step.median)).collect();
        let exponent = fitted_exponent(&points).map_or_else(String::new, |p| format!(", N^{p:.2}"));
        let lanes = if engine == "lamina2d" { format!(", {lanes} lanes") } else { String::new() };
        Series { name: format!("{engine}{lanes}{exponent}"), points }
    });
    Ok(Plot {
        file: "time_against_bodies.svg".into(),
        about: "Median time per step against the number of polygons, both logarithmic, with fitted exponents"
            .to_owned(),
        command: "lamina report --only matrix",
        replay: None,
        earlier: None,
        svg: log_log("Polygons, settled: time per step", ["bodies", "ms per step"], &series, Slope::Up)?,
    })
}

fn time_against_overlap(data: &Data) -> anyhow::Result<Plot> {
    const SCENE: &str = "stack/10";
    let stands = |row: &&stability::Row| row.scene == SCENE && row.failed.is_none() && row.moved < 0.5;
    let of = |solver: &Solver| {
        let rows: Vec<_> = data.stability.iter().filter(stands).filter(|row| row.solver == *solver).collect();
        let overlap_mm = |row: &stability::Row| row.max_penetration.max(1e-7) * 1e3;
        let mut points: Vec<_> = rows.iter().map(|row| (row.ms_per_step, overlap_mm(row))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let substeps: Vec<_> = rows.iter().map(|row| row.substeps.to_string()).collect();
        Series { name: format!("{solver}: {} substeps", substeps.join(", ")), points }
    };
    let series: Vec<_> = Solver::ALL.iter().map(of).filter(|s| !s.points.is_empty()).collect();
    Ok(Plot {
        file: "time_against_overlap.svg".into(),
        about:
            "Largest overlap of a stack of ten boxes against the median time per step, by solver and substeps"
                .to_owned(),
        command: "lamina report --only stability",
        replay: None,
        earlier: None,
        svg: log_log(
            "Ten boxes at rest: error against run time",
            ["ms per step", "largest overlap mm"],
            &series,
            Slope::Down,
        )?,
    })
}

fn broad_on_off(data: &Data) -> anyhow::Result<Plot> {
    let mut series = Vec::new();
    for engine in ["lamina2d", "thesis"] {
        let rows: Vec<_> = data.broad_phase.iter().filter(|r| r.engine == engine).collect();
        let mut add = |what: &str, time: fn(&broad_phase::Row) -> f64| {
            let points: Vec<_> = rows.iter().map(|r| (r.bodies as f64, time(r))).collect();
            let exponent = fitted_exponent(&points).map_or_else(String::new, |p| format!(", N^{p:.2}"));
            series.push(Series { name: format!("{engine}, {what}{exponent}"), points });
        };
        add("on", |r| r.on_ms);
        add("off", |r| r.off_ms);
    }
    Ok(Plot {
        file: "broad_on_off.svg".into(),
        about: "Median time per step with the broad phase on and off, 60 to 200 polygons".to_owned(),
        command: "lamina report --only broad_phase",
        replay: None,
        earlier: None,
        svg: log_log("Polygons: broad phase on and off", ["bodies", "ms per step"], &series, Slope::Up)?,
    })
}

fn lanes_speed_up(data: &Data) -> anyhow::Result<Plot> {
    let mut kernels: Vec<String> = Vec::new();
    for row in &data.lanes {
        if !kernels.iter().any(|k| k == row.kernel) {
            kernels.push(row.kernel.to_owned());
        }
    }
    let series = [4, 8, 16].map(|lanes| {
        let of = |(k, kernel): (usize, &String)| {
            let row = data.lanes.iter().find(|r| r.kernel == kernel && r.lanes == lanes);
            (k as f64, row.map_or(0.0, |r| r.speed_up))
        };
        Series { name: format!("{lanes} lanes"), points: kernels.iter().enumerate().map(of).collect() }
    });
    Ok(Plot {
        file: "lanes.svg".into(),
        about: "How many times faster than one lane each kernel runs at 4, 8 and 16 lanes".to_owned(),
        command: "lamina report --only lanes",
        replay: None,
        earlier: None,
        svg: bars("Kernels: speed-up over one lane", "times faster", &kernels, &series)?,
    })
}

fn times_faster(data: &Data) -> anyhow::Result<Plot> {
    let smallest = data.matrix.iter().map(|r| r.bodies).min().unwrap_or(0);
    let headlines: Vec<_> = data.headlines().into_iter().filter(|h| h.bodies == smallest).collect();
    let with = |substeps| headlines.iter().filter(move |h| h.substeps == substeps);
    let labels: Vec<String> = with(4).map(|h| h.mix.clone()).collect();
    let series = |name: &str, substeps, of: fn(&super::Headline) -> Option<f64>| {
        let points = with(substeps).enumerate().map(|(k, h)| (k as f64, of(h).unwrap_or(0.0)));
        Series { name: format!("against {name}, {substeps} substeps"), points: points.collect() }
    };
    let series = [
        series("thesis", 2, |h| h.times_thesis),
        series("thesis", 4, |h| h.times_thesis),
        series("tidy", 2, |h| h.times_tidy),
        series("tidy", 4, |h| h.times_tidy),
    ];
    Ok(Plot {
        file: "times_faster.svg".into(),
        about: format!("How many times faster than the thesis engine each mix of {smallest} bodies runs"),
        command: "lamina report --only matrix",
        replay: None,
        earlier: None,
        svg: bars(&format!("{smallest} bodies, settled: times faster"), "times faster", &labels, &series)?,
    })
}

/// Microseconds of one step of the thesis's number of bodies: integrator by integrator, mix by mix.
fn mix_by_integrator(data: &Data) -> anyhow::Result<Plot> {
    let smallest = data.matrix.iter().map(|r| r.bodies).min().unwrap_or(0);
    let wanted =
        |r: &&matrix::Row| r.engine == "lamina2d" && r.lanes == 8 && r.bodies == smallest && r.substeps != 2;
    let rows: Vec<_> = data.matrix.iter().filter(wanted).collect();
    let names = |of: fn(&matrix::Row) -> &String| {
        let mut names: Vec<String> = Vec::new();
        for row in &rows {
            if !names.contains(of(row)) {
                names.push(of(row).clone());
            }
        }
        names
    };
    let (mixes, integrators) = (names(|r| &r.mix), names(|r| &r.integrator));
    let cell = |mix: &String, integrator: &String| {
        let row = rows.iter().find(|r| r.mix == *mix && r.integrator == *integrator);
        row.map_or(f64::NAN, |r| r.ms_per_step.median * 1e3)
    };
    let values: Vec<Vec<f64>> =
        integrators.iter().map(|i| mixes.iter().map(|m| cell(m, i)).collect()).collect();
    Ok(Plot {
        file: "mix_by_integrator.svg".into(),
        about: format!("Median µs per step of {smallest} bodies, by shape mix and integrator, 8 lanes"),
        command: "lamina report --only matrix",
        replay: None,
        earlier: None,
        svg: heat_map(&format!("{smallest} bodies, settled: µs per step"), &mixes, &integrators, &values)?,
    })
}

/// Where a step of a thousand settled bodies goes.
fn stages(data: &Data) -> anyhow::Result<Plot> {
    let rows: Vec<_> = data.contacts.iter().filter(|r| r.lanes == 8 && r.bodies == 1000).collect();
    let labels: Vec<_> =
        rows.iter().map(|r| r.scene.split('/').next().unwrap_or_default().to_owned()).collect();
    let of = |stage: &Stage| {
        let height = |r: &&contacts::Row| r.ms_per_step * 1e3 * r.shares[*stage as usize];
        let points = rows.iter().enumerate().map(|(k, r)| (k as f64, height(r))).collect();
        Series { name: stage.name().to_owned(), points }
    };
    Ok(Plot {
        file: "stages.svg".into(),
        about: "Median µs per step of 1000 settled bodies, by stage, default settings, 8 lanes".to_owned(),
        command: "lamina report --only contacts",
        replay: None,
        earlier: None,
        svg: stacked(
            "1000 bodies, settled: where a step goes",
            "µs per step",
            &labels,
            &Stage::ALL.map(|s| of(&s)),
        )?,
    })
}

/// Scenes of the bars beside the peers: what there is of them.
const PEER_SCENES: [&str; 10] = [
    "circles/1000",
    "polygons/150",
    "polygons/1000",
    "polygons/10000",
    "all/10000",
    "pyramid/100",
    "tumbler/2000",
    "joint_grid/60",
    "rain/1000",
    "free_flight/100000",
];

fn peers_times_faster(data: &Data) -> anyhow::Result<Plot> {
    let scenes = data.peers.as_ref().map(Peers::scenes).unwrap_or_default();
    let find = |name: &&str| scenes.iter().find(|s| s.scene == **name && s.threads == 1 && !s.sleep);
    let shown: Vec<_> = PEER_SCENES.iter().filter_map(find).collect();
    let short = |name: &str| name.strip_suffix("000").map_or_else(|| name.to_owned(), |n| format!("{n}k"));
    let labels: Vec<_> = shown.iter().map(|s| short(&s.scene)).collect();
    let series = ["Box2D", "rapier"].into_iter().enumerate().map(|(peer, name)| {
        let height = |s: &&peers::Scene| s.times_faster()[peer].unwrap_or(0.0);
        let points = shown.iter().enumerate().map(|(k, s)| (k as f64, height(s))).collect();
        Series { name: format!("against {name}"), points }
    });
    let series: Vec<_> = series.collect();
    Ok(Plot {
        file: "peers_times_faster.svg".into(),
        about:
            "How many times faster than Box2D and rapier each scene runs, all with 4 substeps, one thread, \
                sleeping off"
                .to_owned(),
        command: "cargo run --release -p lamina-peers",
        replay: None,
        earlier: None,
        svg: bars("4 substeps, one thread: times faster", "times faster", &labels, &series)?,
    })
}

/// A sweep over substeps, all engines in one diagram.
struct Sweep {
    scene: &'static str,
    file: &'static str,
    title: &'static str,
    error: &'static str,
    /// Millimetres.
    of: fn(&peers::Row) -> Option<f64>,
}

const OVERLAP: Sweep = Sweep {
    scene: "polygons/1000",
    file: "peers_time_against_overlap.svg",
    title: "1000 polygons, 1 to 16 substeps: error against run time",
    error: "mean overlap mm",
    of: |row| row.mean_penetration,
};
const SAG: Sweep = Sweep {
    scene: "pyramid/30",
    file: "peers_time_against_sag.svg",
    title: "Pyramid of 465 boxes, 1 to 16 substeps: error against run time",
    error: "top has sunk mm",
    of: |row| row.sunk,
};

fn peers_sweep(data: &Data, sweep: &Sweep) -> anyhow::Result<Plot> {
    let of = |engine: &str| {
        let rows = data.peers.as_ref().map(|p| p.sweep(sweep.scene, engine)).unwrap_or_default();
        let point = |row: &&peers::Row| {
            let error = (sweep.of)(row)?.abs().max(1e-7) * 1e3;
            Some((row.ms_per_step.median, error))
        };
        Series { name: engine.to_owned(), points: rows.iter().filter_map(point).collect() }
    };
    let series = Peers::ENGINES.map(of);
    Ok(Plot {
        file: sweep.file.into(),
        about: format!(
            "{}: {} against the median time per step, each engine with 1, 2, 4, 8 and 16 substeps or iterations",
            sweep.scene, sweep.error
        ),
        command: "cargo run --release -p lamina-peers",
        replay: None,
        earlier: None,
        svg: log_log(sweep.title, ["ms per step", sweep.error], &series, Slope::Down)?,
    })
}
