//! What a run would be, without running it.

use crate::mesh::describe_quality;
use crate::run::{
    Expected, RunError, checkpoint_bytes, columns, end_time, frame_bytes, simulation, whole_factor,
};
use crate::scene::{Every, Scene};
use moldwarp::mesh::Visit;
use moldwarp::plan::Until;
use moldwarp::{Simulation, Stop};
use std::time::{Duration, Instant};

/// The plan of a run. SI units.
#[derive(Debug)]
pub struct Forecast {
    pub title: String,
    pub particles: usize,
    /// What [`describe_quality`] says of the mesh.
    pub mesh: [String; 2],
    pub bodies: Vec<BodyForecast>,
    /// Where a moving mesh will hold fewest particles.
    pub visit: Option<Visit>,
    /// The stable step at the start, s.
    pub stable_time_step: f64,
    /// The first step, s: the stable one unless another is forced.
    pub time_step: f64,
    /// Simulated time, s; an estimate where a stage is given in steps.
    pub end: f64,
    /// Steps, if all are as long as the first.
    pub steps: u64,
    /// Wall time until the first step can be made, s: of reading the scene and its mesh, and of filling bodies with
    /// particles.
    pub set_up: [f64; 2],
    /// Wall time in the step loop by the pace of a few trial steps, s.
    pub wall_time: f64,
    /// Particles times steps per second of the trial steps.
    pub rate: f64,
    /// Most memory that this process has held so far, trial steps included, bytes. Known on
    /// Linux only.
    pub memory: Option<u64>,
    pub frames: u64,
    /// Bytes of all frames, of the ends of stages and of the history.
    pub disk: f64,
    /// Bytes of the checkpoints while the run goes on: two, and one that is being written.
    pub checkpoints: f64,
    /// Columns of the history with their units.
    pub columns: Vec<(String, String)>,
    pub notes: Vec<String>,
    /// A guard that stopped the trial steps.
    pub stopped: Option<Stop>,
}

/// One body of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyForecast {
    pub name: String,
    pub material: String,
    pub particles: usize,
    /// m³; of the whole body if a part of it is computed.
    pub volume: f64,
    /// kg; the same.
    pub mass: f64,
}

/// Trial steps end after this time, or this number of steps.
const TRIAL_TIME: Duration = Duration::from_secs(2);
const TRIAL_STEPS: u64 = 20;

/// Sets the scene up, makes a few trial steps and writes nothing.
pub fn check(scene: Scene) -> Result<Forecast, RunError> {
    let names: Vec<(String, String)> = {
        let plan = &scene.plan;
        let material = |b: &moldwarp::plan::Body| plan.materials[b.material].name.clone();
        plan.bodies
            .iter()
            .map(|b| (b.name.clone(), material(b)))
            .collect()
    };
    let title = scene.plan.title.clone();
    let travel = scene.travel;
    let (reading, start) = (scene.reading, Instant::now());
    let mut sim = simulation(scene.plan, &scene.origin, &scene.text)?;
    let set_up = [reading, start.elapsed()].map(|time| time.as_secs_f64());
    let columns = columns(&sim);
    Expected::read_all(&scene.compare, &columns)?;
    let mesh = describe_quality(sim.mesh(), &scene.element_tags);
    let bodies = bodies(&sim, names);
    let visit = sim.fewest_visited(travel);
    let stable_time_step = sim.stable_time_step();
    let time_step = sim.next_time_step();
    let end = end_time(&sim);
    let steps = steps(&sim);
    let particles = sim.particles().len();
    let (nodes, elements) = (sim.mesh().nodes.len(), sim.mesh().tets.len());
    let frames = outputs(scene.output.frames, end);
    let rows = outputs(scene.output.history, end);
    let frame = frame_bytes(particles, nodes, elements) as f64;
    // The end of a stage is a frame of the particles with three more fields.
    let stage = frame_bytes(particles, 0, 0) + 24 * particles;
    let stages = (sim.plan().stages.len() * stage) as f64;
    let disk = frames as f64 * frame + stages + rows as f64 * (columns.len() * 20) as f64;
    let checkpoints = 3.0 * checkpoint_bytes(&sim) as f64;
    let (pace, stopped) = trial(&mut sim);
    Ok(Forecast {
        title,
        particles,
        mesh,
        bodies,
        visit,
        stable_time_step,
        time_step,
        end,
        steps,
        set_up,
        wall_time: steps as f64 * pace,
        rate: particles as f64 / pace,
        memory: peak_memory(),
        frames,
        disk,
        checkpoints,
        columns,
        notes: scene.notes,
        stopped,
    })
}

/// Steps of all stages, if they are as long as the first.
fn steps(sim: &Simulation) -> u64 {
    let stages = sim.plan().stages.iter();
    stages
        .map(|stage| match stage.until {
            Until::Duration(duration)
            | Until::Equilibrium {
                limit: duration, ..
            } => (duration / sim.next_time_step()).ceil() as u64,
            Until::Steps(steps) => steps,
        })
        .fold(0, u64::saturating_add)
}

/// How often something is written in a run that ends at `end`, s: at 0, too.
fn outputs(every: Every, end: f64) -> u64 {
    match every {
        Every::Count(0) => 0,
        Every::Count(count) => u64::from(count) + 1,
        Every::Interval(interval) => ((end / interval).ceil() as u64).saturating_add(1),
    }
}

/// Seconds a step, and the guard that stopped the trial.
fn trial(sim: &mut Simulation) -> (f64, Option<Stop>) {
    let start = Instant::now();
    let mut made = 0;
    while made < TRIAL_STEPS && start.elapsed() < TRIAL_TIME && !sim.finished() {
        if let Err(stop) = sim.step() {
            return (
                start.elapsed().as_secs_f64() / (made + 1) as f64,
                Some(stop),
            );
        }
        made += 1;
    }
    (start.elapsed().as_secs_f64() / made.max(1) as f64, None)
}

fn bodies(sim: &Simulation, names: Vec<(String, String)>) -> Vec<BodyForecast> {
    let mut bodies: Vec<BodyForecast> = names
        .into_iter()
        .map(|(name, material)| BodyForecast {
            name,
            material,
            particles: 0,
            volume: 0.0,
            mass: 0.0,
        })
        .collect();
    let (p, whole) = (sim.particles(), whole_factor(sim));
    for (i, &body) in p.body.iter().enumerate() {
        let body = &mut bodies[body as usize];
        body.particles += 1;
        body.volume += p.volume[i] * whole;
        body.mass += p.mass[i] * whole;
    }
    bodies
}

/// The process's peak resident memory, bytes, where the system tells it as Linux does.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
