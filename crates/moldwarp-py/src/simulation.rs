//! A simulation as Python sees it. The package's class of this name is made on top of it.

use crate::copies::{Copies, Order};
use crate::errors::{self, BusyError, FrozenError, StoppedError};
use crate::law::PythonLaw;
use crate::lease::{Held, Lease};
use crate::scene::{LawArguments, Laws, Scene};
use crate::{arrays, mesh};
use moldwarp::Vec3;
use moldwarp::measure::Energies;
use moldwarp::particles::{Tensors, Vectors};
use moldwarp_io::run::Session;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, TryLockError};
use std::time::{Duration, Instant};

/// Name, unit, column and bodies of a state variable.
type StateField = (String, String, usize, Vec<usize>);

/// The state, and who looks at it.
pub struct Cell {
    pub session: Session,
    /// Number of leases that are not over.
    pub frozen: usize,
    /// Of views that may still be there.
    pub held: Option<Arc<Held>>,
    laws: Vec<Arc<PythonLaw>>,
    /// Threads of its own, if it was to have a number of them.
    pub threads: Option<rayon::ThreadPool>,
    /// Places by id, until something changes.
    places: Option<Arc<Vec<u32>>>,
    /// Whether ids are 0 to n − 1, until something changes.
    dense: Option<bool>,
    copies: Copies,
    /// Velocities at t = 0 by id, if they were assigned, until the first step.
    start: Option<Vec<f64>>,
    /// Whether stresses were assigned before the first step.
    stressed: bool,
}

impl Cell {
    /// Before anything of it is changed.
    pub fn change(&mut self) -> PyResult<()> {
        if self.frozen > 0 {
            return Err(FrozenError::new_err(
                "the simulation is frozen: it can be stepped and changed after the `with` block",
            ));
        }
        if let Some(reason) = self.session.stopped() {
            return Err(StoppedError::new_err(format!(
                "the simulation has stopped and cannot go on: {reason}"
            )));
        }
        self.forget_order();
        if let Some(held) = self.held.take()
            && Arc::strong_count(&held) > 1
        {
            // Only somebody with a view can make the count larger, and nobody gets another one here.
            held.keep(self.session.simulation_mut().take_particles());
        }
        Ok(())
    }

    fn forget_order(&mut self) {
        self.places = None;
        self.dense = None;
    }

    fn is_dense(&mut self) -> bool {
        let particles = self.session.simulation().particles();
        *self
            .dense
            .get_or_insert_with(|| arrays::is_dense(particles))
    }

    fn places(&mut self) -> Arc<Vec<u32>> {
        let particles = self.session.simulation().particles();
        let places = self
            .places
            .get_or_insert_with(|| Arc::new(arrays::places(particles)));
        places.clone()
    }

    /// Steps until one of the limits is reached. Returns the number of steps made.
    fn advance(&mut self, steps: u64, time: f64, budget: f64) -> Result<u64, moldwarp::Stop> {
        let begun = Instant::now();
        let budget = Duration::try_from_secs_f64(budget).unwrap_or(Duration::MAX);
        let mut done = 0;
        // A time that is a sum of steps may miss the wanted one by round-off.
        let reached = |session: &Session| session.simulation().time() >= time * (1.0 - 1e-12);
        while done < steps && !self.session.simulation().finished() && !reached(&self.session) {
            self.session.step()?;
            done += 1;
            let interrupted = |law: &Arc<PythonLaw>| law.was_interrupted();
            if begun.elapsed() >= budget
                || self.laws.iter().any(interrupted)
                || self.session.has_lost_a_frame()
            {
                break;
            }
        }
        Ok(done)
    }

    fn begin_again(&mut self, stress: Option<Tensors>, places: &[u32]) -> PyResult<()> {
        let sim = self.session.simulation();
        let velocity = match &self.start {
            Some(rows) => vectors(rows, places),
            None => sim.velocities_at_the_start(),
        };
        self.stressed |= stress.is_some();
        let stress = stress.unwrap_or_else(|| sim.particles().stress.clone());
        let stressed = self.stressed;
        let begun = self
            .session
            .simulation_mut()
            .begin_with(&velocity, &stress, stressed);
        self.forget_order();
        if let Err(stop) = begun {
            self.session.stop(&stop);
            return Err(errors::stop(&stop));
        }
        self.session.record_again();
        self.lost_frame()
    }

    /// Raises what has kept a frame from being written.
    fn lost_frame(&mut self) -> PyResult<()> {
        let lost = self.session.lost_frame();
        lost.map_or(Ok(()), |error| Err(errors::frame(error)))
    }
}

impl Drop for Cell {
    fn drop(&mut self) {
        if let Some(held) = self.held.take()
            && Arc::strong_count(&held) > 1
        {
            held.keep(self.session.simulation_mut().give_up_particles());
        }
    }
}

/// A simulation.
#[pyclass(frozen, module = "moldwarp._moldwarp")]
pub struct Simulation {
    cell: Mutex<Cell>,
}

/// Refuses to compute in a process that was forked from one that has: the solver's threads stay
/// behind, and waiting for them would never end.
pub fn check_process() -> PyResult<()> {
    static FIRST: OnceLock<u32> = OnceLock::new();
    let process = std::process::id();
    if *FIRST.get_or_init(|| process) == process {
        return Ok(());
    }
    Err(PyRuntimeError::new_err(
        "this process was forked from one that has used moldwarp, whose threads are not here; for many \
         simulations at a time use threads, or the start method `spawn` of multiprocessing",
    ))
}

fn pool(threads: Option<usize>) -> PyResult<Option<rayon::ThreadPool>> {
    let pool = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        pool.map_err(|e| PyRuntimeError::new_err(format!("cannot start {count} threads: {e}")))
    };
    threads.map(pool).transpose()
}

/// With threads of its own, or with those of all.
pub fn within<T: Send>(threads: &Option<rayon::ThreadPool>, f: impl FnOnce() -> T + Send) -> T {
    match threads {
        Some(threads) => threads.install(f),
        None => f(),
    }
}

impl Simulation {
    fn new(session: Session, laws: &Laws, threads: Option<rayon::ThreadPool>) -> Simulation {
        let cell = Cell {
            session,
            frozen: 0,
            held: None,
            laws: laws.0.iter().map(|law| law.1.clone()).collect(),
            threads,
            places: None,
            dense: None,
            copies: Copies::default(),
            start: None,
            stressed: false,
        };
        Simulation {
            cell: Mutex::new(cell),
        }
    }

    /// The state, for this thread alone.
    pub fn look(&self) -> PyResult<MutexGuard<'_, Cell>> {
        check_process()?;
        match self.cell.try_lock() {
            Ok(cell) => Ok(cell),
            Err(TryLockError::WouldBlock) => Err(BusyError::new_err(
                "the simulation is computing, in another thread or in this step; ask it between steps",
            )),
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err(
                "the simulation is of no use after a bug in moldwarp; please report it",
            )),
        }
    }

    fn changing(&self) -> PyResult<MutexGuard<'_, Cell>> {
        let mut cell = self.look()?;
        cell.change()?;
        Ok(cell)
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn of_scene(py: Python, scene: &Bound<Scene>, threads: Option<usize>) -> PyResult<Simulation> {
        check_process()?;
        let threads = pool(threads)?;
        let scene = scene.get();
        let own = scene.scene.clone();
        let session = py.detach(|| within(&threads, || Session::new(own)));
        let session = session.map_err(|error| errors::scene(&error))?;
        Ok(Simulation::new(session, &scene.laws, threads))
    }

    /// What [`Simulation::save`] has written.
    #[staticmethod]
    fn load(
        py: Python,
        path: PathBuf,
        laws: Vec<LawArguments>,
        threads: Option<usize>,
    ) -> PyResult<Simulation> {
        let laws = Laws::new(laws)?;
        let given = laws.given();
        check_process()?;
        let threads = pool(threads)?;
        let session = py.detach(|| within(&threads, || Session::load(&path, &given)));
        let session = session.map_err(|error| errors::session(&error))?;
        Ok(Simulation::new(session, &laws, threads))
    }

    fn save(&self, py: Python, path: PathBuf) -> PyResult<()> {
        let cell = self.look()?;
        let session = &cell.session;
        py.detach(|| session.save(&path))
            .map_err(|error| errors::session(&error))
    }

    /// Keeps frames in an empty folder from now on.
    fn keep_frames(&self, py: Python, folder: PathBuf) -> PyResult<()> {
        let mut cell = self.look()?;
        let session = &mut cell.session;
        py.detach(|| session.keep_frames(&folder))
            .map_err(errors::frame)
    }

    /// At most `steps` steps, up to the first at or after `time` (s), for about `budget` seconds of wall
    /// time. Python's lock is released meanwhile.
    fn advance(&self, py: Python, steps: u64, time: f64, budget: f64) -> PyResult<u64> {
        let mut guard = self.changing()?;
        let cell = &mut *guard;
        cell.start = None;
        let threads = cell.threads.take();
        let done = py.detach(|| within(&threads, || cell.advance(steps, time, budget)));
        cell.threads = threads;
        let raised: Vec<PyErr> = cell.laws.iter().filter_map(|law| law.raised()).collect();
        let interrupted = cell.laws.iter().filter(|law| law.interrupted()).count() > 0;
        match done {
            Ok(_) if interrupted => Err(PyKeyboardInterrupt::new_err(())),
            Ok(done) => cell.lost_frame().map(|()| done),
            Err(stop) => {
                let error = errors::stop(&stop);
                if let Some(raised) = raised.into_iter().next() {
                    error.set_cause(py, Some(raised));
                }
                Err(error)
            }
        }
    }

    /// Keeps the simulation from being changed until the lease is over.
    fn freeze(slf: Bound<Simulation>) -> PyResult<Lease> {
        slf.get().look()?.frozen += 1;
        Ok(Lease::new(slf.unbind()))
    }

    /// A floating-point array of particles by id, of shape (n, components) or (n,).
    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut cell = self.look()?;
        let count = cell.session.simulation().particles().len();
        let at_start = name == "velocity" && cell.session.simulation().steps() == 0;
        if let Some(rows) = cell.start.as_ref().filter(|_| at_start) {
            return Ok(PyArray1::from_slice(py, rows)
                .reshape([count, 3])?
                .into_any());
        }
        let own = &mut *cell;
        let dense = py.detach(|| own.is_dense());
        let places = (!dense).then(|| py.detach(|| own.places()));
        let particles = own.session.simulation().particles();
        let order = match &places {
            Some(places) => Order::Places(places),
            None => Order::Ids(&particles.id),
        };
        let started = at_start.then(|| own.session.simulation().velocities_at_the_start());
        let components = match &started {
            Some(velocity) => velocity.components().to_vec(),
            None => arrays::components(particles, name)?,
        };
        own.copies.copy(py, &components, order, &own.threads)
    }

    /// `id`, `body` or `element` of particles, by id.
    fn numbers<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mut cell = self.look()?;
        let places = cell.places();
        let p = cell.session.simulation().particles();
        let places = places.iter().map(|&place| place as usize);
        Ok(match name {
            "id" => PyArray1::from_iter(py, places.map(|i| p.id[i])).into_any(),
            "body" => PyArray1::from_iter(py, places.map(|i| p.body[i])).into_any(),
            "element" => PyArray1::from_iter(py, places.map(|i| p.element[i])).into_any(),
            _ => return Err(arrays::unknown(name)),
        })
    }

    /// Assigns velocity or stress, by id.
    fn assign(&self, name: &str, values: PyReadonlyArray2<f64>) -> PyResult<()> {
        let mut cell = self.changing()?;
        let places = cell.places();
        let width = if name == "stress" { 6 } else { 3 };
        if values.shape() != [places.len(), width] {
            return Err(PyValueError::new_err(format!(
                "the particles' {name} is of shape ({}, {width}), not {:?}",
                places.len(),
                values.shape()
            )));
        }
        let rows = values.as_slice()?;
        if let Some(at) = rows.iter().position(|x| !x.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "the {name} in row {} is not a finite number",
                at / width
            )));
        }
        let first = cell.session.simulation().steps() == 0;
        match name {
            "velocity" if first => {
                cell.start = Some(rows.to_vec());
                cell.begin_again(None, &places)
            }
            "velocity" => {
                let velocity = vectors(rows, &places);
                cell.session.simulation_mut().assign_velocity(velocity);
                Ok(())
            }
            "stress" => {
                arrays::check_stress(cell.session.simulation(), rows, &places)?;
                let columns = arrays::columns::<6>(rows, &places);
                let tensor = |p: usize| std::array::from_fn(|k| columns[k][p]);
                let stress: Tensors = (0..places.len()).map(tensor).collect();
                if first {
                    return cell.begin_again(Some(stress), &places);
                }
                cell.session.simulation_mut().assign_stress(stress);
                Ok(())
            }
            _ => Err(arrays::unknown(name)),
        }
    }

    /// Name, unit and number among the columns of `state` of each state variable, and the bodies that
    /// have it.
    #[getter]
    fn state_fields(&self) -> PyResult<Vec<StateField>> {
        let cell = self.look()?;
        let plan = cell.session.simulation().plan();
        let mut all: Vec<StateField> = Vec::new();
        for (number, body) in plan.bodies.iter().enumerate() {
            let fields = plan.materials[body.material].model.state_fields();
            for (column, field) in fields.iter().enumerate() {
                let same = |f: &&mut StateField| f.0 == field.name && f.2 == column;
                match all.iter_mut().find(same) {
                    Some(known) => known.3.push(number),
                    None => all.push((field.name.into(), field.unit.into(), column, vec![number])),
                }
            }
        }
        Ok(all)
    }

    #[getter]
    fn count(&self) -> PyResult<usize> {
        Ok(self.look()?.session.simulation().particles().len())
    }

    #[getter]
    fn bodies(&self) -> PyResult<Vec<String>> {
        let cell = self.look()?;
        let bodies = cell.session.simulation().plan().bodies.iter();
        Ok(bodies.map(|body| body.name.clone()).collect())
    }

    #[getter]
    fn stages(&self) -> PyResult<Vec<String>> {
        let cell = self.look()?;
        let stages = cell.session.simulation().plan().stages.iter();
        Ok(stages.map(|stage| stage.name.clone()).collect())
    }

    #[getter]
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        mesh::arrays(py, self.look()?.session.simulation().mesh())
    }

    /// Fields over all nodes of the mesh.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let cell = self.look()?;
        let fields = cell.session.simulation().node_fields();
        let rows = |v: &[Vec3]| v.iter().map(|x| x.to_array()).collect::<Vec<_>>();
        let all = PyDict::new(py);
        all.set_item("velocity", mesh::matrix(py, &rows(&fields.velocity))?)?;
        all.set_item("mass", PyArray1::from_slice(py, &fields.mass))?;
        all.set_item("reaction", mesh::matrix(py, &rows(&fields.reaction))?)?;
        Ok(all)
    }

    /// Name, unit and values of each column of the history.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let cell = self.look()?;
        let columns = cell.session.history();
        let columns =
            columns.map(|(name, unit, values)| (name, unit, PyArray1::from_slice(py, values)));
        PyList::new(py, columns.collect::<Vec<_>>())
    }

    /// Energies of the whole body, J, by name.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let cell = self.look()?;
        let all = PyDict::new(py);
        for (name, value) in Energies::NAMES.iter().zip(cell.session.energies().values()) {
            all.set_item(name, value)?;
        }
        Ok(all)
    }

    /// Time, end, last and coming step (s), steps, stage, whether it is finished.
    #[getter]
    fn clock(&self) -> PyResult<(f64, f64, f64, f64, u64, usize, bool)> {
        let cell = self.look()?;
        let sim = cell.session.simulation();
        Ok((
            sim.time(),
            cell.session.end(),
            sim.time_step(),
            sim.next_time_step(),
            sim.steps(),
            sim.stage(),
            sim.finished(),
        ))
    }

    #[getter]
    fn energy_turned_over(&self) -> PyResult<f64> {
        Ok(self.look()?.session.energy_turned_over())
    }

    #[getter]
    fn warnings(&self) -> PyResult<Vec<String>> {
        Ok(self.look()?.session.warnings())
    }

    #[getter]
    fn notes(&self) -> PyResult<Vec<String>> {
        Ok(self.look()?.session.notes().to_vec())
    }

    #[getter]
    fn text(&self) -> PyResult<String> {
        Ok(self.look()?.session.text().to_owned())
    }

    #[getter]
    fn case(&self) -> PyResult<String> {
        Ok(self.look()?.session.case().to_owned())
    }

    #[getter]
    fn scene_hash(&self) -> PyResult<String> {
        Ok(self.look()?.session.scene_hash().to_owned())
    }

    #[getter]
    fn state_hash(&self, py: Python) -> PyResult<String> {
        let cell = self.look()?;
        let session = &cell.session;
        Ok(py.detach(|| session.state_hash()))
    }

    /// Particles times steps per second of stepping.
    #[getter]
    fn rate(&self) -> PyResult<f64> {
        Ok(self.look()?.session.rate())
    }
}

fn vectors(rows: &[f64], places: &[u32]) -> Vectors {
    let [x, y, z] = arrays::columns::<3>(rows, places);
    (0..places.len())
        .map(|p| Vec3::new(x[p], y[p], z[p]))
        .collect()
}
