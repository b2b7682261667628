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
