//! `lamina tune`: the cheapest settings for an error.

use anyhow::{anyhow, ensure};
use lamina::accuracy::tune::{Answer, Metric, Question, Tried, tune};
use lamina::cases;

use super::{output, refuse};

/// Arguments of `lamina tune`.
#[derive(Debug, clap::Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct Args {
    /// A scene's name, `name/parameter`, or the path of a .toml file.
    scene: String,
    /// The error must not be larger, in the metric's unit.
    #[arg(long, value_name = "E")]
    max_error: f64,
    /// What counts as error [default: the scene's closed form; overlap where bodies touch; else trajectory].
    #[arg(long, value_enum, value_name = "M")]
    metric: Option<Metric>,
    /// Number of bodies, pairs or boxes, as the scene takes it.
    #[arg(long)]
    bodies: Option<usize>,
    /// Where the scene's random numbers come from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Simulated seconds [default: the scene's own steps].
    #[arg(long, value_name = "T")]
    seconds: Option<f64>,
    /// Real seconds after which no further settings are tried.
    #[arg(long, value_name = "T", default_value_t = 120.0)]
    budget: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let positive = |name: &str, value: f64| {
        let good = value > 0.0 && value.is_finite();
        if good { Ok(()) } else { Err(refuse(anyhow!("{name} must be positive and finite, got {value}"))) }
    };
    positive("--max-error", args.max_error)?;
    positive("--budget", args.budget)?;
    let (scene, _) = cases::load(&args.scene, args.bodies, args.seed).map_err(refuse)?;
    let horizon_secs = args.seconds.unwrap_or(scene.steps as f64 * scene.dt_secs);
    positive("--seconds", horizon_secs)?;
    let metric = match args.metric {
        Some(metric) => metric,
        None => Metric::of(&scene, horizon_secs)?,
    };
    let bodies = args.bodies.map_or_else(String::new, |bodies| format!(" --bodies {bodies}"));
    let seed = if args.seed == 1 { String::new() } else { format!(" --seed {}", args.seed) };
    let given = format!("{}{bodies}{seed}", args.scene);
    let question = Question {
        given,
        metric,
        max_error: args.max_error,
        horizon_secs,
        budget_secs: args.budget.min(1e6),
    };
    let bar = output::progress(1, "tune");
    let answer = tune(&scene, &question, |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let answer = answer.map_err(refuse)?;
    if args.json {
        output::print_json(&answer)?;
    } else {
        print(&answer)?;
    }
    ensure!(
        answer.met,
        "no settings tried keep {} of {} under {} {}{}",
        answer.metric,
        answer.scene,
        answer.max_error,
        answer.unit,
        if answer.disagreed > 0 { " and come out as a converged run does" } else { "" }
    );
    Ok(())
}

/// What the first row is.
fn head_of(answer: &Answer) -> &'static str {
    if answer.met { "best" } else { "nearest" }
}

fn print(answer: &Answer) -> anyhow::Result<()> {
    let Answer { scene, metric, unit, max_error, seconds, .. } = answer;
    let head = if answer.met { "Cheapest" } else { "None meets it; nearest" };
    output::print_text(&format!("{head} for {scene}: {metric} <= {max_error} {unit} over {seconds} s\n"))?;
    let row = |name: &'static str, run: &Tried| {
        vec![
            name.to_owned(),
            run.integrator.to_string(),
            run.solver.map_or_else(|| "–".to_owned(), |solver| solver.to_string()),
            format!("1/{:.0}", 1.0 / run.h),
            run.substeps.to_string(),
            run.stiffness.map_or_else(|| "–".to_owned(), |stiffness| stiffness.to_string()),
            run.precision.to_string(),
            run.error.map_or_else(|| "not finite".to_owned(), |error| format!("{error:.2e}")),
            format!("{:.4}", run.ns_per_simulated_second * 1e-6),
            run.differs.clone().unwrap_or_else(|| "yes".to_owned()),
        ]
    };
    let error = format!("error, {unit}");
    let header = [
        "",
        "integrator",
        "solver",
        "h, s",
        "substeps",
        "stiffness",
        "precision",
        &error,
        "ms per simulated second",
        "comes out right",
    ];
    let best =
        answer.best.iter().enumerate().map(|(k, run)| row(if k == 0 { head_of(answer) } else { "" }, run));
    let rows = best.chain([row("default", &answer.default)]);
    output::print_text(&output::table(&header, rows))?;
    let Answer { tried, disagreed, too_slow, not_tried, .. } = answer;
    output::print_text(&format!(
        "\n{tried} settings run; {disagreed} kept the error but came out otherwise than a converged run; {too_slow} left out as slower, {not_tried} for want of time (--budget)"
    ))?;
    match answer.best.first() {
        Some(run) => output::print_text(&run.command),
        None => Ok(()),
    }
}
