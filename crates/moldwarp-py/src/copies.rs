//! Copies of particles' arrays that belong to Python, by id.
//!
//! Fresh memory costs more than copying into it: the system clears it page by page, and a virtual machine may
//! have to get it from its host first, which takes ten times as long. So the last few copies are
//! remembered, and those that nobody else has any more are written anew.

use crate::arrays;
use crate::simulation::within;
use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::ffi;
use pyo3::prelude::*;
use std::collections::VecDeque;

/// So many copies are remembered: what a function uses that looks at positions, velocities and stresses.
const REMEMBERED: usize = 3;

/// The last copies, the oldest first.
#[derive(Default)]
pub struct Copies(VecDeque<Py<PyArray2<f64>>>);

/// How rows are brought into the order of ids.
pub enum Order<'a> {
    /// Ids are 0 to n − 1, each once.
    Ids(&'a [u32]),
    /// Places by ascending id.
    Places(&'a [u32]),
}

impl Copies {
    /// Rows by id, of shape (n, components), or (n,) of a single one. Made by `threads`.
    pub fn copy<'py>(
        &mut self,
        py: Python<'py>,
        components: &[&[f64]],
        order: Order,
        threads: &Option<rayon::ThreadPool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (Order::Ids(rows) | Order::Places(rows)) = order;
        let (count, width) = (rows.len(), components.len());
        let array = match self.take(py, [count, width])? {
            Some(array) => array,
            // SAFETY: all of it is written below, before anybody else has it.
            None => unsafe { PyArray2::<f64>::new(py, [count, width], false) },
        };
        {
            // SAFETY: it is contiguous, and nobody else's: new, or without any other reference to it.
            let all = unsafe { array.as_slice_mut()? };
            let write = || match order {
                Order::Ids(ids) => arrays::scatter(components, ids, all),
                Order::Places(places) => arrays::gather(components, places, all),
            };
            py.detach(|| within(threads, write));
        }
        self.remember(&array);
        let array = match width {
            1 => array.reshape([count])?.into_any(),
            _ => array.into_any(),
        };
        // What is written to a copy would be lost without a word.
        array.call_method1("setflags", (false,))?;
        Ok(array)
    }

    /// A copy of this shape that nobody has any more, if there is one.
    fn take<'py>(
        &mut self,
        py: Python<'py>,
        shape: [usize; 2],
    ) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        for number in 0..self.0.len() {
            let array = self.0[number].bind(py);
            // Views of it, and whatever else looks at its memory, have a reference to it.
            // SAFETY: it is an object, and this thread has Python's lock.
            if unsafe { ffi::Py_REFCNT(array.as_ptr()) } != 1 {
                continue;
            }
            // Who had it may have changed its shape or type in place, or given it other memory.
            let is_array = array.as_any().cast::<PyArray2<f64>>().is_ok();
            if is_array
                && array.shape() == shape
                && array.is_c_contiguous()
                && array.as_any().getattr("base")?.is_none()
            {
                return Ok(self.0.remove(number).map(|array| array.into_bound(py)));
            }
        }
        Ok(None)
    }

    fn remember(&mut self, array: &Bound<PyArray2<f64>>) {
        self.0.push_back(array.clone().unbind());
        if self.0.len() > REMEMBERED {
            self.0.pop_front();
        }
    }
}
