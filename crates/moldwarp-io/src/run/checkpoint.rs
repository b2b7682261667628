//! Checkpoints: files from which a run goes on.
//!
//! Each holds everything: the scene's text, the mesh as the run began, references of comparisons,
//! what was recorded, and the state. The plan is made again from text and mesh by the ordinary
//! reader; the state is that of [`Simulation::save`]. There are two files that are written in turn,
//! so that while one is written, and should it be damaged later, there is the one before.

use super::recorder::{Recorded, Recorder};
use super::steps::Pace;
use crate::output::container::{self, Damage};
use crate::output::{FileError, Folder};
use moldwarp::mesh::MeshAt;
use moldwarp::saved::{Broken, Saved, Section, load, to_bytes};
use moldwarp::{Mesh, Simulation, Vec3};
use std::time::{Duration, Instant};

/// What a run began with and keeps.
#[derive(Clone, Debug)]
pub(super) struct Beginning {
    /// Of the program: another one may read the scene differently, or compute other bits.
    pub version: String,
    pub case: String,
    /// The scene as run.
    pub text: String,
    /// `OUT@STAGE`, if bodies are as an earlier run left them.
    pub from: Option<String>,
    pub scene_hash: String,
    /// What comparisons are made with: names of files, times and values.
    pub references: Vec<(String, Vec<(f64, f64)>)>,
}

moldwarp::saved!(Beginning {
    version,
    case,
    text,
    from,
    scene_hash,
    references,
});

/// How a run has gone so far, beside its simulation.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
    /// Steps from which it was resumed.
    pub resumed_at: Vec<u64>,
    pub pace: Pace,
    /// Wall time of the processes before this one, s.
    pub earlier: f64,
}

moldwarp::saved!(Course {
    resumed_at,
    pace,
    earlier
});

/// Between two checkpoints passes at least this many times what one takes: they cost 2 % of the time.
const APART: u32 = 50;

/// Writes checkpoints of a run.
#[derive(Debug)]
pub(super) struct Checkpoints {
    folder: Folder,
    /// What is the same in all of them.
    beginning: Vec<u8>,
    /// Where the mesh's nodes were at the beginning, m.
    nodes: Vec<Vec3>,
    generation: u64,
    interval: Duration,
    start: Instant,
    /// When the last one was written, and after how many steps.
    last: Option<(Instant, u64)>,
    /// How long that took.
    cost: Duration,
}

impl Checkpoints {
    /// Of a process that has begun at `start`; `nodes` are those of the mesh at the
    /// beginning, m, and the first checkpoint has number `generation`. `interval` is in s.
    pub fn new(
        folder: &Folder,
        (beginning, nodes): (&Beginning, Vec<Vec3>),
        generation: u64,
        interval: f64,
        start: Instant,
    ) -> Checkpoints {
        Checkpoints {
            folder: folder.clone(),
            beginning: to_bytes(beginning),
            nodes,
            generation,
            interval: Duration::try_from_secs_f64(interval).unwrap_or(Duration::MAX),
            start,
            last: None,
            cost: Duration::ZERO,
        }
    }

    /// Wall time of this process, s.
    pub fn elapsed(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Whether it is time for the next one: after the interval, and not so soon that checkpoints would hold
    /// the run up.
    pub fn due(&self, now: Instant) -> bool {
        let wait = self.interval.max(self.cost * APART);
        self.last.is_none_or(|last| now - last.0 >= wait)
    }

    /// The number of steps at the last one, if there is any.
    pub fn last_step(&self) -> Option<u64> {
        self.last.map(|last| last.1)
    }

    /// Writes one, unless the last is of this step.
    pub fn write(
        &mut self,
        sim: &Simulation,
        course: &Course,
        recorder: &mut Recorder,
    ) -> Result<(), FileError> {
        if self.last_step() == Some(sim.steps()) {
            return Ok(());
        }
        let begun = Instant::now();
        let mut course = course.clone();
        course.earlier += self.elapsed();
        let run = (
            self.generation,
            (sim.stage(), (course, recorder.recorded()?)),
        );
        let path = self.folder.checkpoint(self.generation);
        container::write(&path, |sections| {
            sections.add("run", &to_bytes(&run))?;
            sections.add("beginning", &self.beginning)?;
            let mesh = MeshAt::new(sim.mesh(), &self.nodes);
            sections.add_pieces("mesh", &Section::new(&mesh))?;
            sim.save(|name, section| sections.add_pieces(name, &section))
        })?;
        self.generation += 1;
        let now = Instant::now();
        self.last = Some((now, sim.steps()));
        self.cost = now - begun;
        Ok(())
    }
}

/// Size of a checkpoint, but for texts and recorded times.
pub(crate) fn checkpoint_bytes(sim: &Simulation) -> usize {
    let mut all = sim.mesh().size();
    let Ok(()) = sim.save(|_, section| {
        all += section.size();
        Ok::<(), std::convert::Infallible>(())
    });
    all
}

/// A checkpoint that has been read.
#[derive(Debug)]
pub(super) struct Checkpoint {
    bytes: Vec<u8>,
    generation: u64,
    /// Number of stages that are over.
    pub stage: usize,
    course: Course,
    recorded: Recorded,
    pub beginning: Beginning,
}

/// Why there is none to go on from.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    #[error("{} holds no checkpoint", .0.display())]
    None(std::path::PathBuf),
    #[error("there is no checkpoint in {} that can be used: {problems}", .folder.display())]
    Unusable {
        folder: std::path::PathBuf,
        problems: String,
    },
    #[error("the run was made by moldwarp {theirs}, and this is {}", env!("CARGO_PKG_VERSION"))]
    Version { theirs: String },
    #[error(transparent)]
    Damage(#[from] Damage),
    /// The file is whole, but this program makes nothing of it.
    #[error("the checkpoint is not of this version of moldwarp: {0}")]
    Broken(#[from] Broken),
}

impl CheckpointError {
    /// What the user can do about it.
    pub(super) fn remedy(&self) -> &'static str {
        match self {
            CheckpointError::None(_) => {
                "a run has one once its first step is about to be made: run the scene again"
            }
            CheckpointError::Unusable { .. } | CheckpointError::Damage(_) => {
                "run the scene again, with `--force`"
            }
            CheckpointError::Version { .. } | CheckpointError::Broken(_) => {
                "results could not be the same bit for bit: resume it with the version that made it, or \
                 run the scene again with `--force`"
            }
        }
    }
}

impl Checkpoint {
    /// The newest one in a folder, and what is wrong with those that cannot be used.
    pub fn newest(folder: &Folder) -> Result<(Checkpoint, Vec<String>), CheckpointError> {
        let (mut newest, mut problems): (Option<Checkpoint>, _) = (None, Vec::new());
        for path in [0, 1].map(|generation| folder.checkpoint(generation)) {
            let read = match std::fs::read(&path) {
                Err(e) if e.kind() == std::io::ErrorKind::NotFound => continue,
                Err(e) => Err(e.to_string()),
                Ok(bytes) => match Checkpoint::new(bytes) {
                    Ok(read) => Ok(read),
                    Err(Unread::Damage(damage)) => Err(damage.to_string()),
                    Err(Unread::Broken(broken)) => return Err(broken.into()),
                },
            };
            match read {
                Ok(read)
                    if newest
                        .as_ref()
                        .is_none_or(|n| n.generation < read.generation) =>
                {
                    newest = Some(read);
                }
                Ok(_) => {}
                Err(problem) => {
                    problems.push(format!("{} cannot be used: {problem}", path.display()));
                }
            }
        }
        match newest {
            Some(newest) if newest.beginning.version != env!("CARGO_PKG_VERSION") => {
                Err(CheckpointError::Version {
                    theirs: newest.beginning.version,
                })
            }
            Some(newest) => Ok((newest, problems)),
            None if problems.is_empty() => Err(CheckpointError::None(folder.path().to_owned())),
            None => Err(CheckpointError::Unusable {
                folder: folder.path().to_owned(),
                problems: problems.join("; "),
            }),
        }
    }

    /// A checkpoint as a file holds it.
    pub fn of(bytes: Vec<u8>) -> Result<Checkpoint, CheckpointError> {
        Checkpoint::new(bytes).map_err(|unread| match unread {
            Unread::Damage(damage) => damage.into(),
            Unread::Broken(broken) => broken.into(),
        })
    }

    fn new(bytes: Vec<u8>) -> Result<Checkpoint, Unread> {
        let sections = container::read(&bytes)?;
        let run = find(&sections, "run")?;
        let (generation, (stage, (course, recorded))) =
            load::<(u64, (usize, (Course, Recorded)))>(run)?;
        let beginning = load(find(&sections, "beginning")?)?;
        Ok(Checkpoint {
            generation,
            stage,
            course,
            recorded,
            beginning,
            bytes,
        })
    }

    /// The mesh as the run began.
    pub fn mesh(&self) -> Result<Mesh, CheckpointError> {
        Ok(load(self.section("mesh").unwrap_or_default())?)
    }

    /// What a run goes on with; the state, which is large, is forgotten.
    pub fn go_on(self) -> (Beginning, Course, Recorded, u64) {
        (
            self.beginning,
            self.course,
            self.recorded,
            self.generation + 1,
        )
    }

    /// A section of the state.
    pub fn section(&self, name: &str) -> Option<&[u8]> {
        find(&container::sections(&self.bytes).ok()?, name).ok()
    }
}

/// What a checkpoint is of.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub generation: u64,
    /// s.
    pub time: f64,
    pub step: u64,
    pub stages_over: usize,
    pub case: String,
    pub version: String,
    pub scene_hash: String,
    /// s.
    pub wall_time: f64,
}

/// What a checkpoint's bytes are of; nothing is set up.
pub(crate) fn facts(bytes: Vec<u8>) -> Result<Facts, CheckpointError> {
    let checkpoint = Checkpoint::of(bytes)?;
    let (time, step) = moldwarp::saved::instant(|name| checkpoint.section(name))?;
    Ok(Facts {
        time,
        step,
        generation: checkpoint.generation,
        stages_over: checkpoint.stage,
        wall_time: checkpoint.course.earlier,
        case: checkpoint.beginning.case,
        version: checkpoint.beginning.version,
        scene_hash: checkpoint.beginning.scene_hash,
    })
}

enum Unread {
    Damage(Damage),
    Broken(Broken),
}

impl From<Damage> for Unread {
    fn from(damage: Damage) -> Unread {
        Unread::Damage(damage)
    }
}

impl From<Broken> for Unread {
    fn from(broken: Broken) -> Unread {
        Unread::Broken(broken)
    }
}

fn find<'a>(sections: &[(&str, &'a [u8])], name: &str) -> Result<&'a [u8], Broken> {
    let section = sections.iter().find(|s| s.0 == name);
    section.map(|s| s.1).ok_or_else(|| Broken::new(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{RunOptions, run};
    use std::sync::atomic::Ordering;

    /// The checkpoint before the first step of a small run.
    fn checkpoint() -> Vec<u8> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("scene.toml");
        std::fs::write(&path, crate::run::state::tests::SCENE).unwrap();
        let options = RunOptions {
            out: Some(dir.path().join("out")),
            ..RunOptions::default()
        };
        options.interrupt.signal().store(2, Ordering::Relaxed);
        let scene = crate::scene::load(&path, &[]).unwrap();
        let outcome = run(scene, &options, &mut ()).unwrap();
        assert_eq!((outcome.interrupted, outcome.summary.steps), (Some(2), 0));
        std::fs::read(outcome.folder.checkpoint(0)).unwrap()
    }

    /// One that takes 1 s on a slow disk comes every 50 s, however often it is asked for.
    #[test]
    fn checkpoints_do_not_hold_the_run_up() {
        let now = Instant::now();
        let checkpoints = |interval, cost| Checkpoints {
            folder: Folder::resume(std::path::Path::new("out")),
            beginning: Vec::new(),
            nodes: Vec::new(),
            generation: 1,
            interval: Duration::from_secs(interval),
            start: now,
            last: Some((now, 7)),
            cost: Duration::from_secs(cost),
        };
        let due = |interval, cost, after| {
            checkpoints(interval, cost).due(now + Duration::from_secs(after))
        };
        assert!(!due(300, 1, 299) && due(300, 1, 300));
        assert!(!due(5, 1, 49) && due(5, 1, 50));
    }

    /// At both ends and in the middle of each section, and at regular places all over the file.
    #[test]
    fn a_flipped_bit_anywhere_is_noticed() {
        let mut bytes = checkpoint();
        let start = bytes.as_ptr() as usize;
        let sections = container::sections(&bytes).unwrap();
        assert!(sections.len() > 20);
        let places = sections.iter().flat_map(|(_, section)| {
            let first = section.as_ptr() as usize - start;
            [first, first + section.len() / 2, first + section.len() - 1]
        });
        let places: Vec<usize> = places.chain((0..bytes.len()).step_by(997)).collect();
        assert!(Checkpoint::new(bytes.clone()).is_ok());
        for place in places {
            bytes[place] ^= 1 << (place % 8);
            assert!(Checkpoint::new(bytes.clone()).is_err(), "byte {place}");
            bytes[place] ^= 1 << (place % 8);
        }
    }
}
