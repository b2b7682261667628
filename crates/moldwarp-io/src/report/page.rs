//! The page itself.

use super::answers::{Answer, Grade, answers, verdict};
use super::budget::{MOST_BYTES, Wishes};
use super::figures::{escape, in_script};
use super::packing::text;
use super::pictures::{Blobs, Pictures};
use super::source::Source;
use super::survey::Survey;
use super::{MARK, ReportError, tables};
use crate::scene::Part;
use crate::text::number;
use serde_json::{Value, json};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("viewer.js");
/// The history may take no more of the page.
const MOST_OF_HISTORY: usize = MOST_BYTES / 3;

/// The page of a run, and what was left out of it.
pub fn page(source: &Source, wishes: Wishes) -> Result<(String, Vec<String>), ReportError> {
    let survey = Survey::of(source)?;
    let (history, mut left_out) = history(source);
    left_out.extend_from_slice(&source.left_out);
    let mut about = json!({
        "case": source.summary.as_ref().map_or(&Value::Null, |s| &s["case"]),
        "up": up(source.outline.gravity),
        "part": part(source.outline.part),
        "stages": source.outline.stages,
        "units": tables::units(source),
    });
    let fixed = html_bytes(source) + history.len();
    let room = MOST_BYTES.saturating_sub(fixed);
    let has_pictures = survey.ids.first().is_some();
    let mut blobs = Blobs::default();
    if has_pictures {
        let pictures = Pictures::of(source, &survey, wishes, room)?;
        left_out.extend(omissions(&survey, &pictures));
        about["pictures"] = pictures.about;
        blobs = pictures.blobs;
    }
    let edges = &about["pictures"]["mesh"]["edge"];
    let edges: Option<Vec<f64>> = serde_json::from_value(edges.clone()).unwrap_or_default();
    let answers = answers(source, &survey, edges.and_then(|e| e.try_into().ok()));
    let nonce = blake3::hash(format!("{about}{}", source.scene).as_bytes()).to_hex();
    let page = Page {
        source,
        about: &about,
        answers: &answers,
        history: &history,
        blobs: &blobs,
        left_out: &left_out,
        nonce: &nonce,
    };
    Ok((page.html(), left_out))
}

/// About the bytes of all but the history and the pictures.
fn html_bytes(source: &Source) -> usize {
    let tables = 900 * source.history.names.len() + 60_000;
    // Ranges of frames, and the elements that the blobs stand in.
    let frames = 300_000;
    frames
        + STYLE.len()
        + SCRIPT.len()
        + 2 * source.scene.len()
        + 2 * source.summary_text.len()
        + tables
}

/// The history packed; if it is too long, with every second, fourth … row only.
fn history(source: &Source) -> (String, Vec<String>) {
    let whole = text(source.history_text.as_bytes());
    if whole.len() <= MOST_OF_HISTORY {
        return (whole, Vec::new());
    }
    let lines: Vec<&str> = source.history_text.split_inclusive('\n').collect();
    let last = lines.len() - 1;
    let mut stride = 1;
    loop {
        stride *= 2;
        let kept = |&(i, _): &(usize, &&str)| i == 0 || (i - 1) % stride == 0 || i == last;
        let some: Vec<&str> = lines
            .iter()
            .enumerate()
            .filter(kept)
            .map(|(_, line)| *line)
            .collect();
        let packed = text(some.concat().as_bytes());
        if packed.len() <= MOST_OF_HISTORY || some.len() < 100 {
            let sentence = format!(
                "Curves show every {stride}th row of the history, {} of {}. Tables and answers are of all rows.",
                some.len() - 1,
                last
            );
            return (packed, vec![sentence]);
        }
    }
}

/// What is not drawn, and with how many digits the rest is.
fn omissions(survey: &Survey, pictures: &Pictures) -> Vec<String> {
    let mut all = Vec::new();
    let (shown, there) = (pictures.share.particles, survey.ids.len());
    if shown < there {
        all.push(format!(
            "The 3D view draws {shown} of {there} particles, evenly taken, and those with the extremes. Tables, \
             answers and ranges are of all of them."
        ));
    }
    let (shown, there) = (pictures.share.frames, survey.frames.len());
    if shown < there {
        all.push(format!(
            "The 3D view has {shown} of {there} frames. Answers and ranges are of all of them."
        ));
    }
    if let Some(triangles) = pictures.about["mesh"]["left_out"].as_u64() {
        all.push(format!(
            "The mesh is not drawn: its surface has {triangles} triangles."
        ));
    }
    all
}

/// Where the top of the picture is: against gravity, else along z.
fn up(gravity: [f64; 3]) -> [f64; 3] {
    let size = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    match size > 0.0 {
        true => gravity.map(|g| -g / size),
        false => [0.0, 0.0, 1.0],
    }
}

fn part(part: Option<Part>) -> Value {
    match part {
        None => Value::Null,
        Some(Part::Half { axis }) => json!({ "kind": "half", "axis": axis }),
        Some(Part::Sector { axis, angle }) => {
            json!({ "kind": "sector", "axis": axis, "angle": angle })
        }
    }
}

struct Page<'a> {
    source: &'a Source,
    about: &'a Value,
    answers: &'a [Answer],
    history: &'a str,
    blobs: &'a Blobs,
    left_out: &'a [String],
    nonce: &'a str,
}

impl Page<'_> {
    fn html(&self) -> String {
        let source = self.source;
        let title = escape(match &source.outline.title[..] {
            "" => source
                .summary
                .as_ref()
                .and_then(|s| s["case"].as_str())
                .unwrap_or("A run"),
            title => title,
        });
        let nonce = self.nonce;
        let text_of = |key: &str| {
            source
                .summary
                .as_ref()
                .and_then(|s| s[key].as_str())
                .unwrap_or_default()
        };
        let version = match text_of("version") {
            "" => env!("CARGO_PKG_VERSION"),
            version => version,
        };
        let from = match text_of("from") {
            "" => String::new(),
            from => format!(" · begun from <code>{}</code>", escape(from)),
        };
        let scene = escape(&source.scene);
        let mut page = format!(
            r##"{MARK} {version} -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; img-src data: blob:">
<title>{title}</title>
<style nonce="{nonce}">
{STYLE}</style>
</head>
<body>
<header>
<p class="by">moldwarp {version} · <code>{case}</code>{from}</p>
<h1>{title}</h1>
{verdict}</header>
<nav aria-label="Parts of the report"><a href="#answers">Answers</a> <a href="#view">3D view</a> <a href="#curves">Curves</a> <a href="#energy">Energy</a> <a href="#stages">Stages</a> <a href="#figures">Figures</a> <a href="#scene">Scene</a></nav>
<main>
<section aria-label="Answers" id="answers">
{answers}</section>
<section aria-labelledby="view"><h2 id="view">The ground in 3D</h2>
{view}</section>
<section aria-labelledby="curves"><h2 id="curves">Curves</h2>
<div id="plots"><noscript><p>The curves need JavaScript.</p></noscript></div></section>
<section aria-labelledby="warnings"><h2 id="warnings">Warnings</h2>
{warnings}</section>
<section aria-labelledby="energy"><h2 id="energy">Energy</h2>
{energies}</section>
<section aria-labelledby="stages"><h2 id="stages">Stages</h2>
{stages}</section>
{comparisons}
<section aria-labelledby="figures"><h2 id="figures">Figures</h2>
<details><summary>All figures of <code>summary.json</code></summary>
{summary}</details>
<details><summary>All columns of <code>history.csv</code></summary>
{history}</details></section>
<section aria-labelledby="scene"><h2 id="scene">Scene</h2>
<details><summary>The scene as run, <code>scene.toml</code></summary>
<pre><code>{scene}</code></pre></details></section>
<section aria-labelledby="about-page"><h2 id="about-page">About this page</h2>
{about_page}</section>
</main>
"##,
            case = escape(text_of("case")),
            verdict = self.verdict(),
            answers = self.answers.iter().map(card).collect::<String>(),
            view = self.view(),
            warnings = tables::warnings(source),
            energies = tables::energies(source),
            stages = tables::stages(source),
            comparisons = tables::comparisons(source),
            summary = tables::summary(source),
            history = tables::history(source),
            about_page = self.about_page(),
        );
        let data = |id: &str, kind: &str, text: &str| {
            format!("<script type=\"{kind}\" id=\"{id}\">{text}</script>\n")
        };
        page += &data(
            "about",
            "application/json",
            &in_script(&self.about.to_string()),
        );
        page += &data(
            "summary",
            "application/json",
            &in_script(&source.summary_text),
        );
        page += &data("history", "text/plain", self.history);
        for (number, blob) in self.blobs.texts.iter().enumerate() {
            page += &data(&format!("blob-{number}"), "text/plain", blob);
        }
        page += &format!("<script nonce=\"{nonce}\">\n{SCRIPT}</script>\n</body>\n</html>\n");
        page
    }

    fn verdict(&self) -> String {
        let verdict = verdict(self.source);
        let class = match verdict.grade {
            Grade::Good => "good",
            Grade::Unfinished => "unfinished",
            Grade::Doubt => "doubt",
            Grade::Bad => "bad",
        };
        format!(
            "<p id=\"verdict\" class=\"verdict {class}\" role=\"status\"><b>{}</b> {}</p>\n",
            verdict.ended, verdict.trust
        )
    }

    fn view(&self) -> String {
        let left_out: String = self
            .left_out
            .iter()
            .map(|l| format!("<li>{}</li>", escape(l)))
            .collect();
        let left_out = match left_out.is_empty() {
            true => left_out,
            false => format!("<ul class=\"left-out\">{left_out}</ul>\n"),
        };
        if self.about["pictures"].is_null() {
            let why = match self.source.particles.is_empty() {
                true => {
                    "The run has written no frames, so there is nothing to show here. Frames are written with \
                     <code>frames</code> or <code>frame_interval</code> in the scene's <code>[output]</code>, or \
                     with <code>--set output.frames=50</code>."
                }
                false => "The frames hold no particles.",
            };
            return format!("<p id=\"no-frames\">{why}</p>\n{left_out}");
        }
        format!(
            "{left_out}<div id=\"viewer\"><noscript><p>The 3D view needs JavaScript.</p></noscript></div>\n"
        )
    }

    fn about_page(&self) -> String {
        let pictures = &self.about["pictures"];
        let mut all = vec![
            "This page holds all that it shows and asks nothing of any network. Figures are those of \
             <code>summary.json</code> and <code>history.csv</code>; where they are rounded, the exact value is in \
             the page's source."
                .to_owned(),
        ];
        if let Some(bits) = pictures["bits"][1].as_i64() {
            let error = |bits: i64| number(100.0 * (-(bits as f64) - 1.0).exp2());
            let displacement = pictures["bits"][0].as_i64().unwrap_or(bits);
            all.push(format!(
                "Values of single particles are kept with a relative precision of {} % (displacements: {} %), above \
                 6·10<sup>−5</sup> of the field's greatest value.",
                error(bits),
                error(displacement)
            ));
        }
        all.push(
            "The script contains uPlot 1.6 © Leon Sorokin, under the MIT licence, whose text stands at the script's beginning."
                .to_owned(),
        );
        all.iter().map(|l| format!("<p>{l}</p>\n")).collect()
    }
}

/// A question with its answer.
fn card(answer: &Answer) -> String {
    let more = answer.more.iter().map(|line| format!("<li>{line}</li>\n"));
    let show = answer
        .show
        .as_ref()
        .map_or_else(String::new, |(caption, what)| {
            let what = escape(&what.to_string());
            format!(
                "<button type=\"button\" class=\"show\" data-show=\"{what}\">{caption}</button>\n"
            )
        });
    format!(
        "<article id=\"answer-{}\"><h2>{}</h2>\n<p class=\"short\">{}</p>\n<ul>\n{}</ul>\n{show}</article>\n",
        answer.id,
        answer.question,
        answer.short,
        more.collect::<String>()
    )
}
