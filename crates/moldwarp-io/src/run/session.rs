//! A simulation in memory: whoever holds it steps it and looks at it, and nothing is written unless
//! it is asked for. Its history has the columns, and the rows, that a run of the command writes.

mod account;
mod reel;

pub(crate) use account::GOING_ON;
pub(crate) use reel::Framed;

use super::checkpoint::CheckpointError;
use super::history::{Expected, columns, row};
use super::schedule::Schedule;
use super::steps::Pace;
use super::{recorder, simulation, state_hash, steps, whole};
use crate::output::container::{self, Damage};
use crate::output::{FileError, hash};
use crate::scene::{Compare, Every, Given, Kept, OutputSettings, Scene, SceneError, kept};
use moldwarp::measure::Energies;
use moldwarp::saved::{Broken, Section, load};
use moldwarp::{Plan, Simulation, Stop, Vec3};
use reel::Reel;
use std::path::Path;
use std::time::Instant;

/// What was known at the beginning and is needed to make the plan again.
#[derive(Clone, Debug)]
struct Origin {
    version: String,
    case: String,
    text: String,
    /// `OUT@STAGE`, if bodies are as an earlier run left them.
    from: Option<String>,
    scene_hash: String,
    /// Nodes of the mesh, m.
    nodes: Vec<Vec3>,
    /// What comparisons are made with: names of files, times and values.
    references: Vec<(String, Vec<(f64, f64)>)>,
}

moldwarp::saved!(Origin {
    version,
    case,
    text,
    from,
    scene_hash,
    nodes,
    references,
});

/// Rows of a history, one array a column.
#[derive(Clone, Debug, Default)]
struct Rows {
    schedule: Option<Schedule>,
    /// Steps made at the last one.
    last: Option<u64>,
    columns: Vec<Vec<f64>>,
}

moldwarp::saved!(Rows {
    schedule,
    last,
    columns,
});

/// A simulation with its history.
#[derive(Debug)]
pub struct Session {
    sim: Simulation,
    origin: Origin,
    /// Names and units of the history's columns.
    columns: Vec<(String, String)>,
    rows: Rows,
    row: Vec<f64>,
    pace: Pace,
    compare: Vec<Compare>,
    /// How often the scene wants frames.
    frames: Every,
    reel: Option<Reel>,
    notes: Vec<String>,
    /// Why it cannot go on.
    stopped: Option<String>,
}

/// Why there is no session, or no file of it.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum SessionError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{}: {}", .0.display(), .1)]
    Checkpoint(std::path::PathBuf, CheckpointError),
    #[error("{}: it is the checkpoint of a run; `moldwarp resume` goes on with it", .0.display())]
    OfARun(std::path::PathBuf),
    #[error("a simulation that has stopped is not kept: {0}")]
    Stopped(String),
}

impl Session {
    /// Sets a scene up and gets its first stage going.
    ///
    /// # Errors
    ///
    /// What keeps it from being computed, where it stands in the scene.
    pub fn new(scene: Scene) -> Result<Session, SceneError> {
        let mut origin = Origin {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene_hash: hash::scene_hash(&scene.plan),
            nodes: scene.plan.mesh.nodes.clone(),
            case: scene.case,
            text: String::new(),
            from: scene.earlier.map(|earlier| earlier.given),
            references: Vec::new(),
        };
        let sim = simulation(scene.plan, &scene.origin, &scene.text)?;
        origin.text = scene.text;
        let about = (scene.compare, scene.output.frames, scene.notes);
        let mut session = Session::of(sim, origin, about);
        match Expected::read_all(&session.compare, &session.columns) {
            Ok(expected) => session.origin.references = Expected::references(&expected),
            // Only a report needs them.
            Err(error) => session.notes.push(format!("nothing is compared: {error}")),
        }
        session.rows.schedule = recorder::schedule(scene.output.history, session.end());
        session.record();
        Ok(session)
    }

    fn of(
        sim: Simulation,
        origin: Origin,
        (compare, frames, notes): (Vec<Compare>, Every, Vec<String>),
    ) -> Session {
        let columns = columns(&sim);
        Session {
            pace: Pace::default(),
            compare,
            frames,
            reel: None,
            rows: Rows {
                columns: vec![Vec::new(); columns.len()],
                ..Rows::default()
            },
            sim,
            origin,
            columns,
            row: Vec::new(),
            notes,
            stopped: None,
        }
    }

    pub fn simulation(&self) -> &Simulation {
        &self.sim
    }

    /// The simulation, to change it between steps.
    pub fn simulation_mut(&mut self) -> &mut Simulation {
        if let Some(reel) = &mut self.reel {
            reel.was_changed();
        }
        &mut self.sim
    }

    /// What a user should know.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Why it cannot go on, if it cannot.
    pub fn stopped(&self) -> Option<&str> {
        self.stopped.as_deref()
    }

    /// One step, and the row and the frame that are due after it.
    ///
    /// # Errors
    ///
    /// What a guard has found. Nothing can be computed after that.
    pub fn step(&mut self) -> Result<(), Stop> {
        let (begun, particles) = (Instant::now(), self.sim.particles().len());
        let (time, dt) = (self.sim.time(), self.sim.next_time_step());
        let stepped = self.sim.step();
        match &stepped {
            Ok(()) => {
                self.pace
                    .add(begun.elapsed(), particles, self.sim.time_step());
                self.record();
                if let Some(reel) = &mut self.reel {
                    reel.record(&self.sim);
                }
            }
            Err(stop) => {
                self.stop(stop);
                // Where the clock has not gone on, positions and stresses have.
                let now = self.sim.time();
                let not_at_rest = matches!(stop, Stop::NotAtRest { .. });
                let now = if now > time || not_at_rest {
                    now
                } else {
                    time + dt
                };
                if let Some(reel) = &mut self.reel {
                    reel.record_last(&self.sim, now);
                }
            }
        }
        stepped
    }

    /// Keeps it from going on, for this reason.
    pub fn stop(&mut self, reason: &Stop) {
        self.stopped = Some(reason.to_string());
        self.record_now();
    }

    fn record(&mut self) {
        let due = self.rows.schedule.as_mut();
        if due.is_some_and(|schedule| schedule.due(self.sim.time())) || self.sim.finished() {
            self.record_now();
        }
    }

    fn record_now(&mut self) {
        if self.rows.last == Some(self.sim.steps()) {
            return;
        }
        self.rows.last = Some(self.sim.steps());
        row(&self.sim, &mut self.row);
        for (column, &value) in self.rows.columns.iter_mut().zip(&self.row) {
            column.push(value);
        }
    }

    /// Makes the row of the beginning again, after something was changed there.
    pub fn record_again(&mut self) {
        self.rows.last = None;
        self.rows.columns.iter_mut().for_each(Vec::clear);
        self.record_now();
        if let Some(reel) = &mut self.reel {
            reel.record_again(&self.sim);
        }
    }

    /// The history so far: name, unit and values of each column.
    pub fn history(&self) -> impl Iterator<Item = (&str, &str, &[f64])> {
        let columns = self.columns.iter().zip(&self.rows.columns);
        columns.map(|((name, unit), values)| (&name[..], &unit[..], &values[..]))
    }

    /// When it will end, s; stages given in steps are taken to go on with the coming step.
    pub fn end(&self) -> f64 {
        steps::end_time(&self.sim)
    }

    /// Energies of the whole body, J.
    pub fn energies(&self) -> Energies {
        whole::energies(&self.sim)
    }

    /// The energy turned over, of the whole body, J.
    pub fn energy_turned_over(&self) -> f64 {
        whole::energy_turned_over(&self.sim)
    }

    /// What to doubt in the results, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        super::warnings::warnings(&self.sim)
    }

    /// The scene's fingerprint, as a run's summary has it.
    pub fn scene_hash(&self) -> &str {
        &self.origin.scene_hash
    }

    /// The state's, as a run's summary has it.
    pub fn state_hash(&self) -> String {
        state_hash(&self.sim)
    }

    /// The short name of the scene.
    pub fn case(&self) -> &str {
        &self.origin.case
    }

    /// The scene's text.
    pub fn text(&self) -> &str {
        &self.origin.text
    }

    /// Writes all of it into a file from which [`Session::load`] goes on bit for bit.
    ///
    /// # Errors
    ///
    /// If the file cannot be written, or a guard has stopped the simulation.
    pub fn save(&self, path: &Path) -> Result<(), SessionError> {
        if let Some(reason) = &self.stopped {
            return Err(SessionError::Stopped(reason.clone()));
        }
        container::write(path, |sections| {
            sections.add_pieces("session", &Section::new(&self.origin))?;
            sections.add_pieces("mesh", &Section::new(self.sim.mesh()))?;
            sections.add_pieces("history", &Section::new(&self.rows))?;
            sections.add_pieces("pace", &Section::new(&self.pace))?;
            self.sim.save(|name, part| sections.add_pieces(name, &part))
        })?;
        Ok(())
    }

    /// What was saved. `given` is what the program gave to the scene; its meshes are not needed.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is damaged or of another version, or a law is missing.
    pub fn load(path: &Path, given: &Given) -> Result<Session, SessionError> {
        let bytes = std::fs::read(path).map_err(FileError::at("read", path))?;
        let wrong = |error: CheckpointError| SessionError::Checkpoint(path.to_owned(), error);
        let broken = |error: Broken| wrong(error.into());
        let damaged = |error: Damage| wrong(error.into());
        let sections = container::read(&bytes).map_err(damaged)?;
        let find = |name: &str| sections.iter().find(|s| s.0 == name).map(|s| s.1);
        let Some(origin) = find("session") else {
            return Err(match find("beginning") {
                Some(_) => SessionError::OfARun(path.to_owned()),
                None => broken(Broken::new("session")),
            });
        };
        let origin: Origin = load(origin).map_err(broken)?;
        if origin.version != env!("CARGO_PKG_VERSION") {
            return Err(wrong(CheckpointError::Version {
                theirs: origin.version,
            }));
        }
        let mut mesh: moldwarp::Mesh = load(find("mesh").unwrap_or_default()).map_err(broken)?;
        if origin.nodes.len() != mesh.nodes.len() {
            return Err(broken(Broken::new("mesh")));
        }
        mesh.nodes.clone_from(&origin.nodes);
        mesh.update_geometry();
        let of_session = Kept {
            text: &origin.text,
            case: &origin.case,
            mesh,
            given: given.clone(),
        };
        let (scene, _): (Scene, OutputSettings) = kept(of_session, path, &[], 0)?;
        let sim = restored(scene.plan, find).map_err(broken)?;
        let about = (scene.compare, scene.output.frames, scene.notes);
        let mut session = Session::of(sim, origin, about);
        session.pace = load(find("pace").unwrap_or_default()).map_err(broken)?;
        let rows: Rows = load(find("history").unwrap_or_default()).map_err(broken)?;
        if rows.columns.len() != session.columns.len() {
            return Err(broken(Broken::new("history")));
        }
        session.rows = rows;
        Ok(session)
    }
}

fn restored<'a>(plan: Plan, find: impl Fn(&str) -> Option<&'a [u8]>) -> Result<Simulation, Broken> {
    Simulation::restore(plan, find)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::state::tests::SCENE;
    use crate::run::{RunOptions, run};
    use crate::scene::parse;

    fn scene() -> Scene {
        // Later the column falls apart.
        let text = SCENE.replace("steps = 100", "steps = 50");
        parse(Path::new("scene.toml"), &text).unwrap()
    }

    fn stepped(steps: usize) -> Session {
        let mut session = Session::new(scene()).unwrap();
        (0..steps).for_each(|_| session.step().unwrap());
        session
    }

    /// A session is the run of the command: the same state, and the same history as numbers.
    #[test]
    fn a_session_is_a_run() {
        let dir = tempfile::tempdir().unwrap();
        let options = RunOptions {
            out: Some(dir.path().join("out")),
            ..RunOptions::default()
        };
        let outcome = run(scene(), &options, &mut ()).unwrap();
        let mut session = Session::new(scene()).unwrap();
        while !session.simulation().finished() {
            session.step().unwrap();
        }
        assert_eq!(session.state_hash(), outcome.summary.state_hash);
        assert_eq!(session.scene_hash(), outcome.summary.scene_hash);
        let written = crate::output::csv::read(&outcome.folder.history()).unwrap();
        let kept: Vec<&[f64]> = session.history().map(|c| c.2).collect();
        assert_eq!(kept, written.columns);
        assert_eq!(kept[0].len(), 51);
    }

    /// What is loaded goes on bit for bit, with its history.
    #[test]
    fn what_is_loaded_goes_on() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.checkpoint");
        stepped(30).save(&path).unwrap();
        let mut loaded = Session::load(&path, &Given::default()).unwrap();
        assert_eq!(loaded.state_hash(), stepped(30).state_hash());
        let mut whole = stepped(30);
        for session in [&mut loaded, &mut whole] {
            while !session.simulation().finished() {
                session.step().unwrap();
            }
        }
        assert_eq!(loaded.state_hash(), whole.state_hash());
        assert!(loaded.history().eq(whole.history()));
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[100] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        let damaged = Session::load(&path, &Given::default()).unwrap_err();
        assert!(damaged.to_string().ends_with("it is damaged"), "{damaged}");
    }
}
