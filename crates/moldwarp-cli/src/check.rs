//! `moldwarp check`.

use crate::args::CheckArgs;
use crate::exit::{Exit, of_stop};
use crate::run::load;
use crate::{Failure, say, text};
use moldwarp::mesh::Visit;
use moldwarp_io::check::{Forecast, check as forecast};
use std::time::Duration;
use text::number;

pub fn check(args: &CheckArgs) -> Result<Exit, Failure> {
    let (scene, threads) = load(&args.scene)?;
    let forecast = forecast(scene)?;
    say(&plan(&forecast, threads));
    match forecast.stopped {
        None => Ok(Exit::Done),
        Some(stop) => Err(Failure::new(
            of_stop(&stop),
            miette::miette!("stopped in the first trial steps: {stop}"),
        )),
    }
}

fn plan(f: &Forecast, threads: usize) -> String {
    let mut lines = vec![f.title.clone()];
    lines.extend(f.notes.iter().map(|n| format!("note: {n}")));
    let [size, quality] = &f.mesh;
    lines.push(format!("mesh        {size}"));
    lines.push(format!("            {quality}"));
    lines.extend(f.bodies.iter().map(|b| {
        format!(
            "body        `{}` of `{}`: {} particles, {} m3, {} kg",
            b.name,
            b.material,
            b.particles,
            number(b.volume),
            number(b.mass)
        )
    }));
    lines.extend(f.visit.iter().flat_map(visit));
    lines.push(steps(f));
    lines.push(set_up(f));
    lines.push(effort(f, threads));
    lines.push(format!(
        "disk        {} in {} frames, the ends of stages and the history; {} for checkpoints on the way",
        text::bytes(f.disk),
        f.frames,
        text::bytes(f.checkpoints)
    ));
    let columns: Vec<&str> = f.columns.iter().map(|c| c.0.as_str()).collect();
    lines.push(format!("history     {}", columns.join(" ")));
    lines.iter().map(|l| format!("{l}\n")).collect()
}

/// Fewer particles than this in an element give a poor mean of its stress.
const FEW: f64 = 2.0;

fn visit(visit: &Visit) -> Vec<String> {
    let mut lines = vec![format!(
        "motion      over {} m of motion elements of the moving volumes will hold {:.1} particles or more",
        number(visit.travel),
        visit.particles
    )];
    if visit.particles < FEW {
        let x = visit.position;
        lines.push(format!(
            "            warning: that is fewer than {FEW}, at [{}, {}, {}] m after \
             {} m of motion; take a smaller `particle_spacing` there",
            number(x.x),
            number(x.y),
            number(x.z),
            number(visit.after)
        ));
    }
    lines
}

fn steps(f: &Forecast) -> String {
    format!(
        "time step   {} s (stable: {} s); about {} steps to t = {} s",
        number(f.time_step),
        number(f.stable_time_step),
        f.steps,
        number(f.end)
    )
}

fn set_up(f: &Forecast) -> String {
    let time = |seconds| text::duration(Duration::try_from_secs_f64(seconds).unwrap_or_default());
    let [reading, particles] = f.set_up;
    format!(
        "set-up      {}: scene and mesh {}, particles {}",
        time(reading + particles),
        time(reading),
        time(particles)
    )
}

fn effort(f: &Forecast, threads: usize) -> String {
    let time = Duration::try_from_secs_f64(f.wall_time).unwrap_or(Duration::MAX);
    let memory = f
        .memory
        .map(|m| format!(", {} of memory", text::bytes(m as f64)));
    format!(
        "effort      about {} with {} ({} particle steps/s in a few trial steps){}",
        text::duration(time),
        text::threads(threads),
        text::rate(f.rate),
        memory.unwrap_or_default()
    )
}
