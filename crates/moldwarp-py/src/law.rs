//! A material written in Python.

use moldwarp::material::{Increments, Law, STATE_SIZE, StateField};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// An object of Python whose method `_increment` says the new stresses.
pub struct PythonLaw {
    name: String,
    object: Py<PyAny>,
    fields: &'static [StateField],
    /// What it has raised: Python has it back once the step has stopped.
    raised: Mutex<Option<PyErr>>,
    /// Whether it was interrupted (Ctrl-C). It is called again then, so that the step is whole.
    interrupted: AtomicBool,
}

impl fmt::Debug for PythonLaw {
    /// Its name alone: where the object lies is different each time.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "PythonLaw({})", self.name)
    }
}

impl PythonLaw {
    /// `fields` are names and units of its state variables.
    pub fn new(
        name: String,
        object: Py<PyAny>,
        fields: Vec<(String, String)>,
    ) -> PyResult<PythonLaw> {
        if fields.len() > STATE_SIZE {
            return Err(PyValueError::new_err(format!(
                "material `{name}` has {} state variables; {STATE_SIZE} are the most",
                fields.len()
            )));
        }
        // They live as long as the program: a few bytes a material.
        let leak = |text: String| -> &'static str { text.leak() };
        let fields: Vec<StateField> = (fields.into_iter())
            .map(|(name, unit)| StateField {
                name: leak(name),
                unit: leak(unit),
            })
            .collect();
        Ok(PythonLaw {
            name,
            object,
            fields: fields.leak(),
            raised: Mutex::new(None),
            interrupted: AtomicBool::new(false),
        })
    }

    /// What it has raised since it was last asked.
    pub fn raised(&self) -> Option<PyErr> {
        self.raised.lock().ok()?.take()
    }

    /// Whether it was interrupted.
    pub fn was_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// The same; it is forgotten then.
    pub fn interrupted(&self) -> bool {
        self.interrupted.swap(false, Ordering::Relaxed)
    }

    fn call(&self, py: Python, step: &mut Increments) -> PyResult<()> {
        let count = step.id.len();
        let id = PyArray1::from_slice(py, step.id);
        let stress = columns(py, &step.before, count)?;
        let strain = columns(py, &step.strain, count)?;
        let own: Vec<&[f64]> = (step.state.iter().take(self.fields.len()))
            .map(|s| &**s)
            .collect();
        let state = columns(py, &own, count)?;
        let said = self.object.bind(py);
        let said = said.call_method1("_increment", (&self.name, id, stress, strain, state))?;
        type Said<'py> = (
            PyReadonlyArray2<'py, f64>,
            Option<PyReadonlyArray2<'py, f64>>,
            Option<PyReadonlyArray2<'py, f64>>,
        );
        let (stress, state, plastic): Said = said.extract()?;
        put(&stress, &mut step.stress);
        if let Some(state) = state {
            put(&state, &mut step.state[..self.fields.len()]);
        }
        if let Some(plastic) = plastic {
            *step.plastic = true;
            put(&plastic, &mut step.plastic_strain);
        }
        Ok(())
    }
}

impl Law for PythonLaw {
    fn update(&self, mut step: Increments) -> Result<(), String> {
        Python::attach(|py| {
            // What a law is given are copies, so that asking it again gives the same. Whoever holds
            // Ctrl-C down will be heard after a few times at the latest.
            for _ in 0..8 {
                match self.call(py, &mut step) {
                    Ok(()) => return Ok(()),
                    Err(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => {
                        self.interrupted.store(true, Ordering::Relaxed);
                    }
                    Err(error) => {
                        let said = format!("has a law that raised {error}");
                        if let Ok(mut raised) = self.raised.lock() {
                            *raised = Some(error);
                        }
                        return Err(said);
                    }
                }
            }
            Err("has a law that was interrupted again and again".to_owned())
        })
    }

    fn state_fields(&self) -> &'static [StateField] {
        self.fields
    }
}

/// Columns as a read-only array of shape (count, number of columns), each contiguous.
fn columns<'py>(py: Python<'py>, columns: &[&[f64]], count: usize) -> PyResult<Bound<'py, PyAny>> {
    // SAFETY: all of it is written below, before anybody else has it.
    let array = unsafe { PyArray2::<f64>::new(py, [columns.len(), count], false) };
    {
        // SAFETY: it is new, contiguous and nobody else's.
        let all = unsafe { array.as_slice_mut()? };
        let parts = all.par_chunks_exact_mut(count.max(1));
        parts
            .zip(columns)
            .for_each(|(to, from)| to.copy_from_slice(from));
    }
    let array = array.getattr("T")?;
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// The shapes have been checked in Python.
fn put(from: &PyReadonlyArray2<f64>, to: &mut [&mut [f64]]) {
    debug_assert_eq!(from.shape()[1], to.len());
    let from = from.as_array();
    for (from, to) in from.columns().into_iter().zip(to) {
        match from.as_slice() {
            Some(from) => to.copy_from_slice(from),
            None => to.iter_mut().zip(from).for_each(|(x, &value)| *x = value),
        }
    }
}
