//! Views of particles' arrays without a copy.
//!
//! Why they are sound. A view is a NumPy array over the memory of one of the solver's arrays. It is
//! read-only: NumPy lets nobody make an array writable that does not own its memory and whose owner
//! exports no writable buffer, as [`Hold`] does not. The memory must neither be freed nor written while
//! a view of it is there:
//!
//! - Within the block the simulation refuses whatever would change it ([`Cell::change`]).
//! - A view's base is a [`Hold`], which keeps [`Held`] alive. When the simulation is changed for the first
//!   time after a block, or dropped, and a hold is still there, the particles' arrays are moved into
//!   `Held`, and the simulation goes on with copies. What is moved is the arrays' owner; their numbers stay
//!   where they are in memory. `Held` frees them with the last view.
//!
//! So a view never shows freed or changing memory, whatever is done with it. Beyond that, the objects that
//! Python's users have in their hands (`moldwarp.View`) refuse to be used after their block; only
//! who takes the array out of one, with `numpy.asarray`, keeps it, and it stays as it was.
//!
//! [`Cell::change`]: crate::simulation::Cell::change

use crate::arrays;
use crate::errors::FrozenError;
use crate::simulation::Simulation;
use moldwarp::particles::Particles;
use numpy::ndarray::ArrayView1;
use numpy::{Element, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// What keeps arrays of particles that the simulation has left behind.
#[derive(Default)]
pub struct Held(Mutex<Option<Particles>>);

impl Held {
    pub fn keep(&self, particles: Particles) {
        match self.0.lock() {
            Ok(mut held) => *held = Some(particles),
            // Better never freed than too early.
            Err(_) => std::mem::forget(particles),
        }
    }
}

/// The owner of a view's memory, as far as NumPy knows.
#[pyclass(frozen)]
pub struct Hold {
    #[expect(dead_code, reason = "it is there to be dropped")]
    held: Arc<Held>,
}

/// A simulation that is not changed until it is given back.
#[pyclass(frozen, module = "moldwarp._moldwarp")]
pub struct Lease {
    simulation: Py<Simulation>,
    over: AtomicBool,
}

impl Lease {
    pub fn new(simulation: Py<Simulation>) -> Lease {
        Lease {
            simulation,
            over: AtomicBool::new(false),
        }
    }
}

impl Drop for Lease {
    /// A block that was entered by hand and never left ends here.
    fn drop(&mut self) {
        // Who cannot be asked now stays frozen, which is safe.
        let _ = self.end();
    }
}

#[pymethods]
impl Lease {
    /// The components of an array, in the order of the solver, read-only and without a copy.
    fn columns<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyTuple>> {
        if self.over.load(Ordering::Acquire) {
            return Err(FrozenError::new_err("the frozen block is over"));
        }
        let simulation = self.simulation.get();
        let mut cell = simulation.look()?;
        let held = cell.held.get_or_insert_default().clone();
        let hold = Bound::new(py, Hold { held })?.into_any();
        let particles = cell.session.simulation().particles();
        // SAFETY: see above; the arrays are those of the particles, which `hold` outlives.
        let views = unsafe {
            match name {
                "id" => vec![view(&particles.id, &hold)?],
                "body" => vec![view(&particles.body, &hold)?],
                "element" => vec![view(&particles.element, &hold)?],
                _ => {
                    let components = arrays::components(particles, name)?.into_iter();
                    components
                        .map(|c| view(c, &hold))
                        .collect::<PyResult<_>>()?
                }
            }
        };
        PyTuple::new(py, views)
    }

    /// Ends it; again and again if one likes.
    fn end(&self) -> PyResult<()> {
        let mut cell = self.simulation.get().look()?;
        if !self.over.swap(true, Ordering::AcqRel) {
            cell.frozen -= 1;
        }
        Ok(())
    }

    #[getter]
    fn over(&self) -> bool {
        self.over.load(Ordering::Acquire)
    }
}

/// # Safety
///
/// The memory of `values` must stay as it is as long as `hold` is there.
unsafe fn view<'py, T: Element>(
    values: &[T],
    hold: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let values = ArrayView1::from(values);
    // SAFETY: the caller's.
    let view = unsafe { PyArray1::borrow_from_array(&values, hold.clone()) }.into_any();
    view.call_method1("setflags", (false,))?;
    Ok(view)
}
