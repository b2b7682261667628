//! `summary.json`: a run in figures. A folder that has it holds a run that is over.

use super::{FileError, write_whole};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::io::Write;
use std::path::Path;

/// What is kept of a run. SI units throughout; mass and energies of a part that is computed are those
/// of the whole body.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// A short name, after the scene's folder.
    pub case: String,
    /// The title of the scene.
    pub title: String,
    /// `OUT@STAGE` as given, if bodies are as an earlier run left them; else null.
    pub from: Option<String>,
    /// `"done"`, or why the run was stopped.
    pub exit: String,
    /// Number of particles at the end.
    pub particles: usize,
    /// Number of elements of the mesh.
    pub elements: usize,
    /// Of all bodies that are there at the end, kg.
    pub mass: f64,
    /// Number of steps done.
    pub steps: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Steps from which the run was [resumed](#checkpoints), in order; none if it was made in one go.
    pub resumed_at: Vec<u64>,
    /// From the start of the program's run to its end, s; of a run that was resumed that of all its
    /// parts, up to the checkpoints that they went on from.
    pub wall_time: f64,
    /// Particles times steps over the seconds spent in the steps alone, without set-up and without what is written
    /// before, between and after them.
    pub particle_steps_per_second: f64,
    /// Least step, s; null if there was none.
    pub min_dt: Option<f64>,
    /// Greatest step, s; null if there was none.
    pub max_dt: Option<f64>,
    /// The [energies](#energies) at the end, J, by kind.
    #[serde(serialize_with = "in_order")]
    pub energy: Vec<(String, f64)>,
    /// The greatest half sum of the absolute physical terms, J: what to relate the others to.
    pub energy_turned_over: f64,
    /// What was put back onto its side of a face of an aligned contact.
    pub projections: Projected,
    /// Particles in elements of another body of an aligned contact at the end; there should be none.
    pub foreign_particles: usize,
    /// Particles that are missing though nothing has taken them out; there must be none.
    pub lost_particles: u64,
    /// Particles that have left through outflow surfaces.
    pub outflow_particles: u64,
    /// Their mass, kg.
    pub outflow_mass: f64,
    /// What to doubt in the results: a ledger that does not close, or with large numerical terms, particles
    /// where they should not be.
    pub warnings: Vec<String>,
    /// The comparisons that the scene asked for and that could be made.
    pub compare: Vec<Compared>,
    /// Number of threads at work; the results do not depend on them.
    pub threads: usize,
    /// Version of the program.
    pub version: String,
    /// Fingerprint of the resolved plan and mesh, without title, output, comparisons and threads;
    /// it may change with the version. A run that was resumed keeps that of its beginning.
    pub scene_hash: String,
    /// Fingerprint of every array of the final state, all that a [checkpoint](#checkpoints) would hold
    /// of it, particles by id: two runs ended the same, bit for bit, when it is the same.
    pub state_hash: String,
    /// Each column of the history with its unit.
    #[serde(serialize_with = "in_order")]
    pub units: Vec<(String, String)>,
}

/// Particles that were put back onto their side of a face.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Projected {
    /// How often; a particle counts each time. Of the part that is computed.
    pub count: u64,
    /// Sum of the distances, m.
    pub sum: f64,
    /// The greatest distance, m.
    pub greatest: f64,
    /// Sum of the absolute works of gravity on the way, J.
    pub work: f64,
}

/// A history against its reference.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// The column of the history.
    pub column: String,
    /// The reference's name, without its folder.
    pub file: String,
    /// Greatest difference over the reference's peak; null if it is no number.
    pub relative_difference: f64,
    /// Greatest difference, in the column's unit.
    pub greatest_difference: f64,
    /// When it was reached, s.
    pub at_time: f64,
    /// The reference's greatest absolute value, in the column's unit.
    pub reference_peak: f64,
}

/// Pairs as a JSON object that keeps their order.
fn in_order<S: Serializer, T: Serialize>(
    pairs: &[(String, T)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(pairs.len()))?;
    for (key, value) in pairs {
        map.serialize_entry(key, value)?;
    }
    map.end()
}

impl Summary {
    /// Writes the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        write_whole(path, |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            writeln!(out)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_and_units_keep_their_order() {
        let summary = Summary {
            case: "column".into(),
            title: "A column".into(),
            from: Some("out/pit@dug".into()),
            exit: "done".into(),
            particles: 8,
            elements: 6,
            mass: 20.5,
            steps: 2,
            time: 0.5,
            resumed_at: vec![1, 2],
            wall_time: 1.0,
            particle_steps_per_second: 16.0,
            min_dt: Some(0.25),
            max_dt: None,
            energy: vec![("kinetic".into(), 1.0), ("elastic".into(), f64::NAN)],
            energy_turned_over: 2.0,
            projections: Projected {
                count: 3,
                sum: 0.5,
                greatest: 0.25,
                work: 0.5,
            },
            foreign_particles: 0,
            lost_particles: 0,
            outflow_particles: 3,
            outflow_mass: 0.5,
            warnings: vec!["coarse".into()],
            compare: Vec::new(),
            threads: 2,
            version: "0.1.0".into(),
            scene_hash: "0a".into(),
            state_hash: "0b".into(),
            units: vec![("time".into(), "s".into()), ("dt".into(), "s".into())],
        };
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("summary.json");
        summary.write(&path).unwrap();
        insta::assert_snapshot!(std::fs::read_to_string(&path).unwrap());
    }
}
