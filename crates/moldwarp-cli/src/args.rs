//! The command line.

use clap::builder::PossibleValuesParser;
use clap::{Args as ClapArgs, Parser, Subcommand};
use moldwarp::Simd;
use std::path::PathBuf;

/// Dynamic material point method for geomechanics
#[derive(Debug, Parser)]
#[command(name = "moldwarp", version)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute a scene and write its results
    Run(RunArgs),
    /// Go on with a run that was interrupted, from its last checkpoint, as if it had never stopped
    ///
    /// Changed input files do not matter. A run that is over is left as it is.
    Resume(ResumeArgs),
    /// Say what a run would be: counts, steps, memory, disk, time; writes nothing
    Check(CheckArgs),
    /// Compute a scene once for each value, or each combination of values, of --vary
    ///
    /// The last --vary changes fastest. A run that stops does not end the sweep. The exit code is 0
    /// if all runs were done, else the greatest of their codes.
    Sweep(SweepArgs),
    /// One run of a sweep, which starts it
    #[command(hide = true)]
    SweepPart(PartArgs),
    /// Make one page of a run that opens in any browser: answers, curves, the ground in 3D
    Report(ReportArgs),
    /// Begin with an example
    New(NewArgs),
    /// Say how a run went or goes: stages, frames, extremes, energies, how it ended
    Inspect(InspectArgs),
    /// Draw histories of runs and sweeps, as PNG or SVG
    Plot(PlotArgs),
    /// Write completions of commands and options for a shell, to standard output
    Completions(CompletionsArgs),
    /// Write the manual page to standard output, or the pages of all commands into a folder
    Man(ManArgs),
}

/// What is to be computed.
#[derive(Debug, ClapArgs)]
pub struct SceneArgs {
    /// A scene file, or a folder with scene.toml
    pub scene: PathBuf,
    /// Replace a value of the scene, such as numerics.courant=0.3 or stages.loading.duration="1 s"
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub sets: Vec<String>,
    /// Begin with the ground as an earlier run left it: its folder and the name of a stage that it
    /// completed. Its bodies are found by name
    #[arg(long, value_name = "OUT@STAGE")]
    pub from: Option<String>,
    /// Number of threads; all cores if not given. The results do not depend on it
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

#[derive(Debug, ClapArgs)]
pub struct RunArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Where results go [default: out/<case>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace an unfinished run; write beside files that are not moldwarp's
    #[arg(long)]
    pub force: bool,
    /// Write a report of it at the end: report.html in its folder
    #[arg(long)]
    pub report: bool,
    #[command(flatten)]
    pub how: HowArgs,
}

#[derive(Debug, ClapArgs)]
pub struct ResumeArgs {
    /// The folder of the run
    pub dir: PathBuf,
    /// Change the end of a stage that is not over, or the output, such as
    /// stages.loading.duration="2 s" or output.frames=100
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub sets: Vec<String>,
    /// Number of threads; all cores if not given. The results do not depend on it
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Write a report of it at the end: report.html in its folder
    #[arg(long)]
    pub report: bool,
    #[command(flatten)]
    pub how: HowArgs,
}

/// How steps are made.
#[derive(Debug, ClapArgs)]
pub struct HowArgs {
    /// Vector instructions to use; the best of this processor if not given. The results do not depend on
    /// them
    #[arg(long, value_parser = PossibleValuesParser::new(Simd::NAMES))]
    pub simd: Option<String>,
    /// Say where the time went, part by part of the step
    #[arg(long)]
    pub profile: bool,
}

#[derive(Debug, ClapArgs)]
pub struct SweepArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Values that a path of the scene is to have, such as numerics.courant=0.3,0.4; several --vary
    /// make every combination
    #[arg(long, value_name = "PATH=V1,V2,…", required = true)]
    pub vary: Vec<String>,
    /// Number of runs at a time, which share the threads. The results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: u16,
    /// Where results go [default: out/<case>-sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace an unfinished sweep; write beside files that are not moldwarp's
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, ClapArgs)]
pub struct PartArgs {
    #[command(flatten)]
    pub run: RunArgs,
    /// The fingerprint of the scene as the sweep has checked it
    #[arg(long)]
    pub scene_hash: String,
}

#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
}

#[derive(Debug, ClapArgs)]
pub struct InspectArgs {
    /// The folder of a run, at work or not, or of a sweep; or a checkpoint or frame of one
    pub out: PathBuf,
    /// Look for the extremes of the fields in all frames, not only in the last one
    #[arg(long)]
    pub frames: bool,
    /// For programs: everything as JSON, in SI units
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct PlotArgs {
    /// Folders of runs or sweeps, drawn together
    #[arg(required = true, value_name = "OUT")]
    pub outs: Vec<PathBuf>,
    /// Columns of the history with commas between them: names, beginnings of names such as energy, or
    /// patterns such as '*.displacement.z'
    #[arg(long, value_name = "COLUMNS", required = true)]
    pub what: Vec<String>,
    /// Column of the horizontal axis
    #[arg(long, value_name = "COLUMN", default_value = "time")]
    pub against: String,
    /// Where the plot goes; several write several [default: plot.png]
    #[arg(long, value_name = "FILE.png|FILE.svg")]
    pub output: Vec<PathBuf>,
    /// A table to compare with, drawn dashed: in its first two columns, under a header, the horizontal and
    /// the vertical value in SI units. NAME is for the legend
    #[arg(long, value_name = "[NAME=]FILE")]
    pub reference: Vec<String>,
    /// What a run is called in the legend, one for each run in their order [default: its folder, or its
    /// values in the sweep]
    #[arg(long, value_name = "NAME")]
    pub label: Vec<String>,
    /// Above the plot
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Name of the horizontal axis; its unit is added
    #[arg(long, value_name = "TEXT")]
    pub x_label: Option<String>,
    /// Name of the vertical axis; its unit is added
    #[arg(long, value_name = "TEXT")]
    pub y_label: Option<String>,
    /// Unit of the horizontal axis, such as ms [default: one that suits the values]
    #[arg(long, value_name = "UNIT")]
    pub x_unit: Option<String>,
    /// Unit of the vertical axis, such as kPa [default: one that suits the values]
    #[arg(long, value_name = "UNIT")]
    pub y_unit: Option<String>,
    /// Ends of the horizontal axis, with unit or in SI, such as 0 '50 ms'
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_hyphen_values = true)]
    pub x_range: Option<Vec<String>>,
    /// Ends of the vertical axis, with unit or in SI
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_hyphen_values = true)]
    pub y_range: Option<Vec<String>>,
    /// A logarithmic vertical axis
    #[arg(long)]
    pub log_y: bool,
    /// Width and height, cm
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "12x8", value_parser = size)]
    pub size: [f64; 2],
    /// Size of the letters, points
    #[arg(long, value_name = "POINTS", default_value_t = 9.0, value_parser = font_size)]
    pub font_size: f64,
    /// Dots per inch of a PNG
    #[arg(long, value_name = "DPI", default_value_t = 300, value_parser = clap::value_parser!(u32).range(30..=2400))]
    pub dpi: u32,
    /// Write the fingerprints of the scenes small under the plot
    #[arg(long)]
    pub scene_hash: bool,
}

/// `12x8` in cm.
fn size(text: &str) -> Result<[f64; 2], String> {
    let lengths = text
        .split_once(['x', '×', 'X'])
        .and_then(|(width, height)| {
            let length = |text: &str| text.trim().trim_end_matches("cm").trim().parse().ok();
            Some([length(width)?, length(height)?])
        });
    match lengths {
        Some(size) if size.iter().all(|length| (1.0..=200.0).contains(length)) => Ok(size),
        _ => Err("width and height in cm are needed, 1 to 200, such as 12x8".to_owned()),
    }
}

fn font_size(text: &str) -> Result<f64, String> {
    match text.trim_end_matches("pt").trim().parse() {
        Ok(size) if (3.0..=72.0).contains(&size) => Ok(size),
        _ => Err("a size in points is needed, 3 to 72".to_owned()),
    }
}

#[derive(Debug, ClapArgs)]
pub struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

#[derive(Debug, ClapArgs)]
pub struct ManArgs {
    /// Folder for the pages of all commands; it is made if it is not there
    pub dir: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
pub struct ReportArgs {
    /// The folder of the run
    pub dir: PathBuf,
    /// Where the report goes [default: report.html in the folder]
    #[arg(long, value_name = "FILE")]
    pub to: Option<PathBuf>,
    /// Draw no more particles than this; 200,000, or fewer where the page would become too large, if not
    /// given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub particles: Option<u32>,
    /// Show no more frames than this; all, or fewer where the page would become too large, if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
}

#[derive(Debug, ClapArgs)]
pub struct NewArgs {
    /// Name of the example
    #[arg(value_parser = PossibleValuesParser::new(crate::new::names()))]
    pub case: String,
    /// Folder to be made
    pub dir: PathBuf,
}
