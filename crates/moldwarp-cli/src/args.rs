//! The command line.

use clap::builder::PossibleValuesParser;
use clap::{Args as ClapArgs, Parser, Subcommand};
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
    /// Say what a run would be: counts, steps, memory, disk, time; writes nothing
    Check(CheckArgs),
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
}

#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
}

#[derive(Debug, ClapArgs)]
pub struct NewArgs {
    /// Name of the example
    #[arg(value_parser = PossibleValuesParser::new(crate::new::names()))]
    pub case: String,
    /// Folder to be made
    pub dir: PathBuf,
}
