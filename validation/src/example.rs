//! The absorbing-column example: its exact histories and its plots.

use crate::exact::column::{Bottom, Column, ColumnSolution};
use crate::report::look;
use crate::setup::{self, Balance};
use moldwarp::Simulation;
use moldwarp_io::output::hash::scene_hash;
use moldwarp_io::plot::Plot;
use moldwarp_io::scene;
use std::fmt::Write;
use std::path::{Path, PathBuf};

type Failure = Box<dyn std::error::Error>;

const SPRING: Bottom = Bottom::DashpotAndSpring {
    alpha: 2.5,
    virtual_thickness: 0.5,
};
const DASHPOT: Bottom = Bottom::Dashpot { alpha: 2.5 };
/// End of the scenes, s.
const END: f64 = 2.0;

/// Scene, its bottom, and the file of its exact history.
const SCENES: [(&str, &str, Bottom, &str); 3] = [
    ("scene.toml", "dashpot and spring", SPRING, "exact.csv"),
    (
        "dashpot.toml",
        "dashpot alone",
        DASHPOT,
        "exact-dashpot.csv",
    ),
    ("rigid.toml", "rigid", Bottom::Rigid, "exact-rigid.csv"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/absorbing-column")
}

/// Writes the exact histories beside the scenes: the bottom's displacement, upward positive, for
/// the absorbing bottoms, the top's for the rigid one. Returns the files.
pub fn write_exact() -> std::io::Result<Vec<PathBuf>> {
    SCENES
        .iter()
        .map(|&(_, _, bottom, file)| {
            let path = folder().join(file);
            std::fs::write(&path, exact_history(bottom))?;
            Ok(path)
        })
        .collect()
}

/// Time and displacement every millisecond, as the text of a CSV file.
pub fn exact_history(bottom: Bottom) -> String {
    let exact = Column::of_the_paper(bottom).solve(END);
    let mut text = String::from("time,displacement\n");
    for i in 0..=2000 {
        let t = END * f64::from(i) / 2000.0;
        let down = match bottom {
            Bottom::Rigid => exact.top_displacement(t),
            _ => exact.bottom_displacement(t),
        };
        writeln!(text, "{t:.3},{:.9e}", -down).expect("a string takes what is written to it");
    }
    text
}

/// Histories of a scene: time, bottom's displacement, bottom's pressure.
struct Run {
    exact: ColumnSolution,
    points: Vec<[f64; 3]>,
    /// The scene's fingerprint.
    hash: String,
}

/// Runs a scene and draws the pressure at the bottom over time beside the exact one.
///
/// # Errors
///
/// If there is no such scene, or the file cannot be written.
pub fn draw_stress(file: &str, to: &Path) -> Result<(), Failure> {
    let scene = SCENES.iter().find(|s| s.0 == file);
    let scene = scene.ok_or_else(|| format!("there is no exact solution of {file}"))?;
    let (run, _) = run(scene)?;
    let title = format!("Pressure at the bottom: {}", scene.1);
    let mut stress = Plot {
        look: look(),
        caption: format!("scene {}", &run.hash[..12]),
        ..Plot::new(&title, "time (s)", "pressure (kPa)")
    };
    let points = run.points.iter().map(|p| (p[0], 1e-3 * p[2]));
    stress.line("moldwarp", points.collect());
    stress.dashed("exact", curve(|t| 1e-3 * run.exact.bottom_pressure(t)));
    stress.write(to)?;
    Ok(())
}

fn curve(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..=4000)
        .map(|i| END * f64::from(i) / 4000.0)
        .map(|t| (t, value(t)))
        .collect()
}

fn run(&(file, _, bottom, _): &(&str, &str, Bottom, &str)) -> Result<(Run, Balance), Failure> {
    let scene = scene::load(&folder().join(file), &[])?;
    let hash = scene_hash(&scene.plan);
    let mut points = Vec::new();
    let balance = setup::run(scene.plan, |s: &Simulation| {
        let value = |column: &str| -setup::value(s, column);
        points.push([
            s.time(),
            value("bottom.displacement.z"),
            value("bottom.stress.zz"),
        ]);
    });
    let run = Run {
        hash,
        exact: Column::of_the_paper(bottom).solve(END),
        points,
    };
    Ok((run, balance))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On the unstructured mesh: greatest error of the bottom's displacement over its peak at most
    /// 2.5 %, numerical terms at most 1 % of the energy turned over.
    #[test]
    fn the_scenes_are_near_the_exact_solution() {
        for scene in SCENES.iter().filter(|s| s.2 != Bottom::Rigid) {
            let (run, balance) = run(scene).expect("the example runs");
            let error = |p: &[f64; 3]| (p[1] - run.exact.bottom_displacement(p[0])).abs();
            let worst = run.points.iter().map(error).fold(0.0, f64::max);
            assert!(
                worst < 0.025 * run.exact.bottom_peak(END),
                "{}: {worst}",
                scene.0
            );
            assert!(balance.numerical < 0.01 && balance.residual < 1e-6);
        }
    }

    #[test]
    fn the_committed_exact_histories_are_those_of_this_program() {
        for (_, _, bottom, file) in SCENES {
            let committed = std::fs::read_to_string(folder().join(file)).expect(file);
            assert!(
                committed == exact_history(bottom),
                "run `moldwarp-validation exact`: {file} is stale"
            );
        }
    }
}
