//! The page: HTML with the plots inside it, and a Markdown summary.

use askama::Template;

use super::plots::Plot;
use super::{Data, Machine, Record, Table};
use crate::accuracy::answers::MixLine;
use crate::present::Earlier;
use crate::stress::{self, PassLine};

/// A part of the page: what it is about, then its plots and tables.
struct Group {
    title: &'static str,
    intro: &'static str,
    /// File names.
    plots: &'static [&'static str],
    /// Names.
    tables: &'static [&'static str],
}

/// The order of the page. What has nothing to show is left out.
const GROUPS: &[Group] = &[
    Group {
        title: "Results",
        intro: "The same scenes, measured in alternating windows of this run, beside the engine this one started from.",
        plots: &["times_faster.svg", "time_against_bodies.svg"],
        tables: &["results"],
    },
    Group {
        title: "Run time against error",
        intro: "What an error costs: substeps buy stiffness. Down and to the left is better.",
        plots: &["peers_time_against_overlap.svg", "peers_time_against_sag.svg", "time_against_overlap.svg"],
        tables: &["stability"],
    },
    Group {
        title: "Accuracy",
        intro: "What error a microsecond buys: every case with a closed form or a converged reference, every integrator \
                and step, every solver, number of substeps and stiffness. Down and to the left is better; the line of steps \
                is what no other run beats.",
        plots: &[
            "accuracy_oscillator.svg",
            "accuracy_quadratic_drop.svg",
            "accuracy_kepler.svg",
            "accuracy_magnetic.svg",
            "accuracy_pendulum.svg",
            "accuracy_arenstorf.svg",
            "accuracy_sliding_block.svg",
            "accuracy_bouncing_ball.svg",
            "accuracy_billiard.svg",
            "accuracy_stack_forces.svg",
            "accuracy_chain.svg",
        ],
        tables: &["fastest", "contact_targets", "accuracy"],
    },
    Group {
        title: "Shape mixes",
        intro: "No course of a pile can be told for long: what can be is how deep bodies overlap, what momentum is lost, \
                and how well contacts obey their laws.",
        plots: &[
            "accuracy_circles.svg",
            "accuracy_circles_polygons.svg",
            "accuracy_polygons.svg",
            "accuracy_all.svg",
            "accuracy_circles_momentum.svg",
            "accuracy_circles_polygons_momentum.svg",
            "accuracy_polygons_momentum.svg",
            "accuracy_all_momentum.svg",
        ],
        tables: &["mixes"],
    },
    Group {
        title: "Where it breaks",
        intro: "What must stand, hold or stop, with each solver, and the number at which it no longer does.",
        plots: &[],
        tables: &["stress", "stress_limits"],
    },
    Group {
        title: "In the wild",
        intro: "What people report of engines like this one, and which engine gets it right.",
        plots: &[],
        tables: &["wild"],
    },
    Group {
        title: "Peers",
        intro: "Box2D v3 and rapier on the library's own scenes, body for body, in alternating windows of one process; \
                the same f64 code measures every engine's overlaps and errors.",
        plots: &["peers_times_faster.svg"],
        tables: &["peers", "peer_rows"],
    },
    Group {
        title: "Scenes",
        intro: "What is timed above, at a few moments of a run with default settings: every body, drawn from the \
                engine's own state. Any of it can be recorded and looked at frame by frame.",
        plots: &[
            "strip_circles.svg",
            "strip_circles_polygons.svg",
            "strip_polygons.svg",
            "strip_all.svg",
            "strip_pyramid.svg",
            "strip_tumbler.svg",
            "strip_spinner.svg",
            "strip_rain.svg",
            "strip_joint_grid.svg",
        ],
        tables: &[],
    },
    Group {
        title: "The thesis's experiments",
        intro: "Performance by mix and integrator, complexity, broad phase on and off, determinism.",
        plots: &["mix_by_integrator.svg", "broad_on_off.svg"],
        tables: &["matrix", "broad_phase", "determinism"],
    },
    Group {
        title: "Where a step goes",
        intro: "Stages of the default step, and what lanes do for each kernel.",
        plots: &["stages.svg", "lanes.svg"],
        tables: &["contacts", "lanes"],
    },
    Group {
        title: "What is left out",
        intro: "Work a scene does not need: each skip on and off, and piles that sleep.",
        plots: &[],
        tables: &["skips", "sleep"],
    },
    Group {
        title: "Recordings",
        intro: "What writing every step down costs, and what reading any of it takes.",
        plots: &[],
        tables: &["recording"],
    },
    Group {
        title: "Instructions",
        intro: "Counted by callgrind, repeatable to the instruction, held by a gate in every check-in.",
        plots: &[],
        tables: &["instructions"],
    },
    Group {
        title: "Limits",
        intro: "What the machine could do at most, measured in the same run, and the stages' share of it.",
        plots: &[],
        tables: &["limit_shares", "limits", "flight"],
    },
];

/// A group with what it shows.
struct Section<'a> {
    title: &'static str,
    /// Of its heading, for links.
    anchor: String,
    intro: &'static str,
    /// The run that all of it is from; `None` where some is of the report's own.
    earlier: Option<Earlier>,
    /// What its rows answer, in sentences.
    answers: Vec<String>,
    plots: Vec<Drawing<'a>>,
    tables: Vec<&'a Table>,
}

/// A plot as the page embeds it.
struct Drawing<'a> {
    plot: &'a Plot,
    /// In the page's colours: paper and ink follow the reader's scheme.
    svg: String,
}

/// Everything the templates want.
pub(super) struct Page<'a> {
    data: &'a Data,
    /// Is all that is shown of this run?
    of_one_run: bool,
    features: String,
    headlines: Vec<String>,
    sections: Vec<Section<'a>>,
}

#[derive(Template)]
#[template(path = "page.html")]
struct Html<'a> {
    page: &'a Page<'a>,
    machine: &'a Machine,
}

#[derive(Template)]
#[template(path = "summary.md", escape = "none")]
struct Markdown<'a> {
    page: &'a Page<'a>,
    machine: &'a Machine,
}

impl<'a> Page<'a> {
    /// Sorts tables and plots into groups.
    pub(super) fn new(data: &'a Data, tables: &'a [Table], plots: &'a [Plot]) -> Self {
        let section = |group: &Group| {
            let drawing = |plot| Drawing { plot, svg: in_page_colors(&plot.svg) };
            let of_group: Vec<&Table> =
                group.tables.iter().filter_map(|name| tables.iter().find(|t| t.name == *name)).collect();
            let plots = group.plots.iter().filter_map(|file| plots.iter().find(|p| p.file == **file));
            Section {
                title: group.title,
                anchor: group.title.to_lowercase().replace([' ', '\''], "-"),
                intro: group.intro,
                answers: answers_of(data, group),
                plots: plots.map(drawing).collect(),
                earlier: of_group
                    .first()
                    .and_then(|table| table.earlier.clone())
                    .filter(|earlier| of_group.iter().all(|table| table.earlier.as_ref() == Some(earlier))),
                tables: of_group,
            }
        };
        let sections = GROUPS.iter().map(section).filter(|s| !(s.plots.is_empty() && s.tables.is_empty()));
        let of_one_run = tables.iter().all(|table| table.earlier.is_none());
        Self {
            data,
            of_one_run,
            features: data.machine.features.join(", "),
            headlines: sentences(data),
            sections: sections.collect(),
        }
    }

    /// The page, self-contained.
    pub(super) fn html(&self) -> anyhow::Result<String> {
        Ok(Html { page: self, machine: &self.data.machine }.render()?)
    }

    /// The summary.
    pub(super) fn markdown(&self) -> anyhow::Result<String> {
        Ok(Markdown { page: self, machine: &self.data.machine }.render()?)
    }
}

/// What the rows of a group's tables answer.
fn answers_of(data: &Data, group: &Group) -> Vec<String> {
    if group.tables.contains(&MixLine::NAME) {
        let earlier = data.earlier_accuracy.as_ref().map(|sweep| sweep.answers.clone());
        earlier.unwrap_or_else(|| data.accuracy.answers.clone())
    } else if group.tables.contains(&PassLine::NAME) {
        stress::answers(&data.stress.0)
    } else {
        Vec::new()
    }
}

/// White becomes the page's paper and black its ink, so that a plot can be read on a dark page too.
fn in_page_colors(svg: &str) -> String {
    svg.replace("\"#FFFFFF\"", "\"var(--paper)\"").replace("\"#000000\"", "\"currentColor\"")
}

/// The headline ratios, each a sentence with the error it is had at, and with where it was measured if not in this run.
fn sentences(data: &Data) -> Vec<String> {
    let sizes = [150, 1000, 10_000];
    let ours = sizes.iter().flat_map(|&bodies| [2, 4].map(|substeps| beside_thesis(data, bodies, substeps)));
    let mut all: Vec<String> = ours.flatten().collect();
    let Some(peers) = &data.peers else { return all };
    let scenes = peers.scenes();
    for wanted in ["polygons/150", "polygons/1000", "polygons/10000", "pyramid/100"] {
        let scene = scenes.iter().find(|s| s.scene == wanted && s.threads == 1 && !s.sleep);
        let said = scene.and_then(beside_peers);
        all.extend(said.map(|said| format!("{said} Not of this run: {}.", peers.machine)));
    }
    all
}

/// Polygons beside the baselines, in a sentence.
pub(super) fn beside_thesis(data: &Data, bodies: usize, substeps: u32) -> Option<String> {
    const MIX: &str = "polygons";
    let headlines = data.headlines();
    let row = headlines.iter().find(|h| h.mix == MIX && h.bodies == bodies && h.substeps == substeps)?;
    let (thesis, tidy) = (row.times_thesis?, row.times_tidy?);
    let (ours, theirs) = (row.mean_penetration * 1e3, row.thesis_mean_penetration? * 1e3);
    Some(format!(
        "{bodies} {MIX} at {substeps} substeps: {thesis:.1}× as fast as the thesis engine, {tidy:.1}× as its tidy \
         version; bodies overlap by {ours:.1} mm on average, the thesis's by {theirs:.1} mm."
    ))
}

/// One scene beside the peers, in a sentence.
fn beside_peers(scene: &super::peers::Scene) -> Option<String> {
    let [box2d, rapier] = scene.times_faster();
    let [ours, theirs, last] = scene.mean_penetration.map(|m| m.map(|m| m * 1e3));
    Some(format!(
        "`{}`, all with 4 substeps: {:.1}× as fast as Box2D, {:.1}× as rapier; bodies overlap by {:.2} mm on average, \
         theirs by {:.2} and {:.2} mm.",
        scene.scene, box2d?, rapier?, ours?, theirs?, last?
    ))
}

/// HTML of a text in which backticks mark code.
fn marked(text: &str) -> String {
    let safe = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let code = |(k, part)| if k % 2 == 1 { format!("<code>{part}</code>") } else { String::from(part) };
    safe.split('`').enumerate().map(code).collect()
}
