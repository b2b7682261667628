//! Meshes given as arrays.

use moldwarp::mesh::RawMesh;
use moldwarp::{Mesh, Vec3};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Points, tetrahedra, names and elements of volumes, names and triangles of surfaces.
pub type Arrays<'py> = (
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, i64>,
    Vec<(String, PyReadonlyArray1<'py, i64>)>,
    Vec<(String, PyReadonlyArray2<'py, i64>)>,
);

pub fn raw(arrays: &Arrays) -> PyResult<RawMesh> {
    let (points, tets, volumes, surfaces) = arrays;
    let points = rows::<f64, 3>(points, "points")?;
    let count = points.len();
    let tets = rows::<i64, 4>(tets, "tets")?;
    let elements = tets.len();
    let volume = |(name, group): &(String, PyReadonlyArray1<i64>)| {
        let what = format!("an element of volume `{name}`");
        let numbers = group.as_array();
        let numbers = numbers.iter().map(|&e| number(e, elements, &what));
        Ok::<_, PyErr>((name.clone(), numbers.collect::<PyResult<Vec<u32>>>()?))
    };
    let surface = |(name, group): &(String, PyReadonlyArray2<i64>)| {
        let what = format!("a node of surface `{name}`");
        let triangles = nodes(&rows::<i64, 3>(group, "triangles")?, count, &what)?;
        Ok::<_, PyErr>((name.clone(), triangles))
    };
    Ok(RawMesh {
        nodes: points.into_iter().map(Vec3::from_array).collect(),
        tets: nodes(&tets, count, "a node of an element")?,
        volume_groups: volumes.iter().map(volume).collect::<PyResult<_>>()?,
        surface_groups: surfaces.iter().map(surface).collect::<PyResult<_>>()?,
    })
}

fn rows<T: numpy::Element + Copy + Default, const N: usize>(
    array: &PyReadonlyArray2<T>,
    what: &str,
) -> PyResult<Vec<[T; N]>> {
    match array.shape() {
        [_, columns] if *columns == N => {}
        shape => {
            return Err(PyValueError::new_err(format!(
                "{what} are an array of shape (n, {N}), not {shape:?}"
            )));
        }
    }
    let rows = array.as_array();
    let row = |row: numpy::ndarray::ArrayView1<T>| std::array::from_fn(|k| row[k]);
    Ok(rows.rows().into_iter().map(row).collect())
}

fn number(n: i64, count: usize, what: &str) -> PyResult<u32> {
    let valid = u32::try_from(n).ok().filter(|&n| (n as usize) < count);
    valid.ok_or_else(|| {
        PyValueError::new_err(format!(
            "{what} is number {n}; they are counted from 0, and there are {count}"
        ))
    })
}

fn nodes<const N: usize>(rows: &[[i64; N]], count: usize, what: &str) -> PyResult<Vec<[u32; N]>> {
    let convert = |row: &[i64; N]| {
        let mut all = [0; N];
        for (to, &n) in all.iter_mut().zip(row) {
            *to = number(n, count, what)?;
        }
        Ok(all)
    };
    rows.iter().map(convert).collect()
}

/// The arrays of a mesh, by name.
pub fn arrays<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let points: Vec<[f64; 3]> = mesh.nodes.iter().map(|x| x.to_array()).collect();
    all.set_item("points", matrix(py, &points)?)?;
    all.set_item("tets", matrix(py, &mesh.tets)?)?;
    let groups = PyDict::new(py);
    for group in &mesh.volume_groups {
        groups.set_item(&group.name, PyArray1::from_slice(py, &group.elements))?;
    }
    all.set_item("volumes", groups)?;
    let surfaces = PyDict::new(py);
    for surface in &mesh.surfaces {
        let faces: Vec<[u32; 3]> = surface.faces.iter().map(|&f| mesh.face_nodes(f)).collect();
        surfaces.set_item(&surface.name, matrix(py, &faces)?)?;
    }
    all.set_item("surfaces", surfaces)?;
    Ok(all)
}

/// Rows as an array of shape (number of rows, N).
pub fn matrix<'py, T: numpy::Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    use numpy::PyArrayMethods;
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), N])
}
