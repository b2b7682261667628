//! Particles' arrays by name, in the order of ids.
//!
//! In the solver a vector is three arrays, in an order that changes as particles move. Python sees
//! arrays of shape (n, 3), by id.

use moldwarp::Simulation;
use moldwarp::particles::Particles;
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Whether ids are 0 to n − 1: no two particles have the same one.
pub fn is_dense(particles: &Particles) -> bool {
    let count = particles.len();
    particles.id.par_iter().all(|&id| (id as usize) < count)
}

/// Places of particles by ascending id.
pub fn places(particles: &Particles) -> Vec<u32> {
    const NOBODY: u32 = u32::MAX;
    let count = particles
        .id
        .par_iter()
        .max()
        .map_or(0, |&id| id as usize + 1);
    let places: Vec<AtomicU32> = (0..count)
        .into_par_iter()
        .map(|_| AtomicU32::new(NOBODY))
        .collect();
    // No two particles have the same id, so it does not matter who writes first.
    particles
        .id
        .par_iter()
        .enumerate()
        .for_each(|(place, &id)| {
            places[id as usize].store(place as u32, Ordering::Relaxed);
        });
    let places: Vec<u32> = places.into_par_iter().map(AtomicU32::into_inner).collect();
    if particles.len() == count {
        return places;
    }
    places
        .into_iter()
        .filter(|&place| place != NOBODY)
        .collect()
}

/// The components of an array, if there is one of this name.
pub fn components<'a>(particles: &'a Particles, name: &str) -> PyResult<Vec<&'a [f64]>> {
    let p = particles;
    Ok(match name {
        "position" => p.position.components().to_vec(),
        "velocity" => p.velocity.components().to_vec(),
        "origin" => p.origin.components().to_vec(),
        "stress" => p.stress.components().to_vec(),
        "state" => p.state.components().to_vec(),
        "volume" => vec![&p.volume],
        "initial_volume" => vec![&p.initial_volume],
        "mass" => vec![&p.mass],
        _ => return Err(unknown(name)),
    })
}

pub fn unknown(name: &str) -> PyErr {
    PyAttributeError::new_err(format!("particles have no array `{name}`"))
}

/// Writes the row of each particle to the place that its id says; ids are 0 to n − 1. What is read and what
/// is written is near what came before, since particles of neighbours have neighbouring ids.
pub fn scatter(components: &[&[f64]], ids: &[u32], to: &mut [f64]) {
    let width = components.len();
    // SAFETY: both have the same size and alignment, and `to` is borrowed by this function alone.
    let to = unsafe { std::slice::from_raw_parts(to.as_mut_ptr().cast::<AtomicU64>(), to.len()) };
    let write = |to: &AtomicU64, x: f64| to.store(x.to_bits(), Ordering::Relaxed);
    let blocks = ids.par_chunks(BLOCK).enumerate();
    blocks.for_each(|(number, ids)| match components {
        [x, y, z] => {
            let [x, y, z] = [x, y, z].map(|c| &c[number * BLOCK..][..ids.len()]);
            for (p, &id) in ids.iter().enumerate() {
                let row = &to[3 * id as usize..][..3];
                write(&row[0], x[p]);
                write(&row[1], y[p]);
                write(&row[2], z[p]);
            }
        }
        _ => {
            for (p, &id) in (number * BLOCK..).zip(ids) {
                let row = &to[width * id as usize..][..width];
                for (to, component) in row.iter().zip(components) {
                    write(to, component[p]);
                }
            }
        }
    });
}

/// Rows of so many particles that one thread copies at a time.
const BLOCK: usize = 1 << 14;

/// Writes the rows of particles, in the order of `places`.
pub fn gather(components: &[&[f64]], places: &[u32], to: &mut [f64]) {
    let width = components.len();
    let blocks = to
        .par_chunks_mut(BLOCK * width)
        .zip(places.par_chunks(BLOCK));
    blocks.for_each(|(to, places)| match components {
        [x, y, z] => {
            for (row, &p) in to.chunks_exact_mut(3).zip(places) {
                let p = p as usize;
                row.copy_from_slice(&[x[p], y[p], z[p]]);
            }
        }
        _ => {
            for (row, &p) in to.chunks_exact_mut(width).zip(places) {
                for (to, component) in row.iter_mut().zip(components) {
                    *to = component[p as usize];
                }
            }
        }
    });
}

/// Rows by id as columns in the order of the arrays.
pub fn columns<const N: usize>(rows: &[f64], places: &[u32]) -> [Vec<f64>; N] {
    let mut columns: [Vec<f64>; N] = std::array::from_fn(|_| vec![0.0; places.len()]);
    for (row, &place) in rows.chunks_exact(N).zip(places) {
        for (column, &x) in columns.iter_mut().zip(row) {
            column[place as usize] = x;
        }
    }
    columns
}

/// Refuses stresses that no material can have: beyond its strength, or none at all.
pub fn check_stress(sim: &Simulation, stress: &[f64], places: &[u32]) -> PyResult<()> {
    let (p, plan) = (sim.particles(), sim.plan());
    for (row, &place) in stress.chunks_exact(6).zip(places) {
        let place = place as usize;
        let body = &plan.bodies[usize::from(p.body[place])];
        let material = &plan.materials[body.material];
        let row: [f64; 6] = row.try_into().expect("chunks of six");
        if material.model.yields(&row) {
            return Err(PyValueError::new_err(format!(
                "the stress of particle {} is beyond the strength of material `{}`",
                p.id[place], material.name
            )));
        }
        if material.model.is_rigid() && row != [0.0; 6] {
            return Err(PyValueError::new_err(format!(
                "particle {} is of body `{}`, which is rigid and has no stress",
                p.id[place], body.name
            )));
        }
    }
    Ok(())
}
