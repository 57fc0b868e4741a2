//! `lamina scenes`: the table of scenes.

use lamina::cases::SCENES;
use serde_json::json;

use super::output;

/// Arguments of `lamina scenes`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    if args.json {
        let rows: Vec<_> = SCENES
            .iter()
            .map(|s| json!({"name": s.name, "parameter": s.takes.name(), "default": s.default, "about": s.about}))
            .collect();
        return output::print_json(&rows);
    }
    let rows = SCENES.iter().map(|s| {
        vec![s.name.to_owned(), s.takes.name().to_owned(), s.default.to_string(), s.about.to_owned()]
    });
    output::print_text(&output::table(&["scene", "parameter", "default", "about"], rows))?;
    output::print_text("\nA parameter follows a slash: `lamina run polygons/1000`, `lamina run stack/20`.")
}
