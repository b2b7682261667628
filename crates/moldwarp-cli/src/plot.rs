//! `moldwarp plot`.

use crate::args::PlotArgs;
use crate::exit::Exit;
use crate::{Failure, say};
use moldwarp_io::plot::{
    Format, HistoriesError, Look, Plot, PlotError, Reference, Shown, ShownRun, histories,
};
use moldwarp_io::results::{Results, ResultsError};
use moldwarp_io::sweep;
use std::path::{Path, PathBuf};

pub fn plot(args: &PlotArgs) -> Result<Exit, Failure> {
    let files = match &args.output[..] {
        [] => vec![PathBuf::from("plot.png")],
        files => files.to_vec(),
    };
    for file in &files {
        Format::of(file).map_err(Failure::input)?;
    }
    let (mut runs, hashes) = runs(&args.outs)?;
    rename(&mut runs, &args.label)?;
    let pair = |range: &Option<Vec<String>>| {
        let both = range
            .as_ref()
            .map(|ends| <[String; 2]>::try_from(ends.clone()));
        both.and_then(Result::ok)
    };
    let shown = Shown {
        runs,
        what: args.what.clone(),
        against: args.against.clone(),
        references: args
            .reference
            .iter()
            .map(|entry| reference(entry))
            .collect(),
        x_unit: args.x_unit.clone(),
        y_unit: args.y_unit.clone(),
        x_range: pair(&args.x_range),
        y_range: pair(&args.y_range),
    };
    let plot = finished(histories(&shown).map_err(Failure::input)?, args, &hashes);
    for file in &files {
        plot.write(file).map_err(|error| match error {
            PlotError::File(_) => Failure::new(Exit::Files, error),
            _ => Failure::input(error),
        })?;
        say(&format!("plot: {}\n", file.display()));
    }
    Ok(Exit::Done)
}

/// With all that is not of the histories.
fn finished(plot: Plot, args: &PlotArgs, hashes: &[String]) -> Plot {
    // A label of the user gets the unit that the axis has.
    let renamed = |old: String, label: &Option<String>| match label {
        None => old,
        Some(label) => match old.rsplit_once(" (") {
            Some((_, unit)) => format!("{label} ({unit}"),
            None => label.clone(),
        },
    };
    let mut known: Vec<&str> = Vec::new();
    for hash in hashes.iter().map(|hash| &hash[..hash.len().min(12)]) {
        if !known.contains(&hash) {
            known.push(hash);
        }
    }
    let caption = match (args.scene_hash, known.len()) {
        (false, _) | (_, 0) => String::new(),
        (true, 1..=3) => format!("scene {}", known.join(", ")),
        (true, n) => format!("{n} scenes, the first {}", known[0]),
    };
    Plot {
        title: args.title.clone().unwrap_or_default(),
        x: renamed(plot.x, &args.x_label),
        y: renamed(plot.y, &args.y_label),
        log_y: args.log_y,
        caption,
        look: Look {
            size: args.size,
            font_size: args.font_size,
            dpi: args.dpi.into(),
        },
        ..plot
    }
}

/// The histories of the runs in these folders, those of sweeps one after the other, and the fingerprints
/// of their scenes.
fn runs(outs: &[PathBuf]) -> Result<(Vec<ShownRun>, Vec<String>), Failure> {
    let (mut runs, mut hashes) = (Vec::new(), Vec::new());
    for out in outs {
        let mut add = |label: String, path: &Path| -> Result<(), HistoriesError> {
            let results = Results::open(path)?;
            hashes.extend(results.scene_hash().map(str::to_owned));
            let history = results.history()?;
            runs.push(ShownRun { label, history });
            Ok(())
        };
        let Some(members) = sweep::members(out) else {
            add(name_of(out), out).map_err(Failure::input)?;
            continue;
        };
        let mut any = false;
        for member in members {
            let values: Vec<String> = member
                .values
                .iter()
                .map(|(path, value)| {
                    let last = path.rsplit('.').next().unwrap_or(path);
                    format!("{} = {}", last.replace('_', " "), value.trim_matches('"'))
                })
                .collect();
            // Runs that have not begun, or were refused, have nothing to show.
            match add(values.join(", "), &member.folder) {
                Ok(()) => any = true,
                Err(HistoriesError::Results(
                    ResultsError::Missing { .. } | ResultsError::NoRun { .. },
                )) => {
                    eprintln!("note: {} has no results", member.folder.display());
                }
                Err(error) => return Err(Failure::input(error)),
            }
        }
        if !any {
            return Err(Failure::input(miette::miette!(
                "no run of the sweep in {} has results",
                out.display()
            )));
        }
    }
    Ok((runs, hashes))
}

fn name_of(out: &Path) -> String {
    let whole = out.canonicalize().unwrap_or_else(|_| out.to_owned());
    whole.file_name().map_or_else(
        || out.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}

fn rename(runs: &mut [ShownRun], labels: &[String]) -> Result<(), Failure> {
    if !labels.is_empty() && labels.len() != runs.len() {
        return Err(Failure::input(miette::miette!(
            help = "give one `--label` for each run, in their order",
            "runs: {}, labels: {}",
            runs.len(),
            labels.len()
        )));
    }
    for (run, label) in runs.iter_mut().zip(labels) {
        run.label.clone_from(label);
    }
    Ok(())
}

/// `NAME=FILE`, or a file that is called after itself.
fn reference(entry: &str) -> Reference {
    match entry.split_once('=') {
        Some((name, file)) if !Path::new(entry).exists() => Reference {
            label: name.to_owned(),
            file: file.into(),
        },
        _ => Reference {
            label: Path::new(entry)
                .file_stem()
                .map_or_else(|| entry.to_owned(), |n| n.to_string_lossy().into_owned()),
            file: entry.into(),
        },
    }
}
