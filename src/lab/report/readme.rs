//! What the README repeats of a published report: between two comments each, so that it is never older than the rows.

use std::fmt::Write;

use super::Data;

/// A part of the README between `<!-- NAME -->` and `<!-- end -->`.
struct Part {
    name: &'static str,
    text: fn(&Data) -> Option<String>,
}

const PARTS: &[Part] = &[
    Part { name: "thesis", text: results },
    Part { name: "fastest", text: fastest },
    Part { name: "wild", text: wild },
];

/// The README with the parts that this report has rows for.
///
/// # Errors
/// A part that is not there, or has no end.
pub fn refreshed(readme: &str, data: &Data) -> anyhow::Result<String> {
    let mut readme = readme.to_owned();
    for part in PARTS {
        let Some(text) = (part.text)(data) else { continue };
        let begin = format!("<!-- {} -->\n", part.name);
        let missing = || anyhow::anyhow!("README.md: no {}…<!-- end -->", begin.trim_end());
        let from = readme.find(&begin).ok_or_else(missing)? + begin.len();
        let to = from + readme[from..].find("<!-- end -->").ok_or_else(missing)?;
        readme.replace_range(from..to, &text);
    }
    Ok(readme)
}

/// The result table: a line per mix and size, with 4 and with 2 substeps.
fn results(data: &Data) -> Option<String> {
    let headlines = data.headlines();
    let mut text = String::from(
        "| mix | bodies | ms per step | vs thesis | vs tidy | mean overlap mm | thesis overlap mm |\n\
         |---|---|---|---|---|---|---|\n",
    );
    let before = text.len();
    for four in headlines.iter().filter(|row| row.substeps == 4) {
        let same =
            |row: &&super::Headline| row.substeps == 2 && row.mix == four.mix && row.bodies == four.bodies;
        let two = headlines.iter().find(same)?;
        let times =
            |of: fn(&super::Headline) -> Option<f64>| Some(format!("{:.1}× / {:.1}×", of(four)?, of(two)?));
        writeln!(
            text,
            "| {} | {} | {:.4} / {:.4} | {} | {} | {:.1} / {:.1} | {:.1} |",
            four.mix,
            four.bodies,
            four.ms,
            two.ms,
            times(|row| row.times_thesis)?,
            times(|row| row.times_tidy)?,
            four.mean_penetration * 1e3,
            two.mean_penetration * 1e3,
            four.thesis_mean_penetration? * 1e3,
        )
        .ok()?;
    }
    (text.len() > before).then_some(text)
}

/// Which scheme is fastest at an error, and which settings in a pile.
fn fastest(data: &Data) -> Option<String> {
    let said = |beginnings: &[&str]| {
        let begins = |line: &&String| beginnings.iter().any(|beginning| line.starts_with(beginning));
        let lines: Vec<&str> = data.accuracy.answers.iter().filter(begins).map(String::as_str).collect();
        (!lines.is_empty()).then(|| format!("- {}\n", lines.join(" ")))
    };
    let parts = [said(&["Smooth"]), said(&["A costlier", "Cheapest"])];
    let text: String = parts.into_iter().flatten().collect();
    (!text.is_empty()).then_some(text)
}

/// How many scenes from problem reports each engine gets right.
fn wild(data: &Data) -> Option<String> {
    let all = data.wild.0.iter().find(|line| line.kind == "all")?;
    let of = |[right, cases]: [usize; 2]| format!("{right} of {cases}");
    let (ours, box2d, rapier) = (of(all.lamina2d), of(all.box2d), of(all.rapier2d));
    Some(format!("lamina2d gets {ours} right, Box2D {box2d} of those it can express, rapier {rapier}.\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_replaced_and_all_else_stays() {
        let mut data = Data::empty(false);
        let readme = "a\n<!-- thesis -->\nold\n<!-- end -->\nb\n<!-- fastest -->\nold\n<!-- end -->\nc\n";
        assert_eq!(refreshed(readme, &data).unwrap(), readme, "no rows, no change");
        let answers = [
            "Shapes.",
            "Smooth motion, at 1e-2: rk4 3.",
            "Cheapest: soft.",
            "Smooth motion, at 1e-4: rk4 4.",
        ];
        data.accuracy.answers = answers.map(str::to_owned).to_vec();
        let new = refreshed(readme, &data).unwrap();
        let expected = "fastest -->\n- Smooth motion, at 1e-2: rk4 3. Smooth motion, at 1e-4: rk4 4.\n- Cheapest: soft.\n";
        assert_eq!(new, readme.replace("fastest -->\nold\n", expected));
        assert!(refreshed("nothing", &data).unwrap_err().to_string().contains("<!-- fastest -->"));
    }
}
