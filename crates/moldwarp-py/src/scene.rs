//! Scenes: from a file, or from a text to which something is given.

use crate::errors;
use crate::law::PythonLaw;
use crate::mesh;
use crate::simulation::check_process;
use moldwarp::material::Law;
use moldwarp_io::scene::{self, Dimension, Given};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene that has been read and checked.
#[pyclass(frozen, module = "moldwarp._moldwarp")]
pub struct Scene {
    pub scene: scene::Scene,
    pub laws: Laws,
}

/// The laws that Python has given, by the names of their materials.
#[derive(Clone, Default)]
pub struct Laws(pub Vec<(String, Arc<PythonLaw>)>);

/// Name of the material, the object, names and units of its state variables.
pub type LawArguments = (String, Py<PyAny>, Vec<(String, String)>);

impl Laws {
    pub fn new(laws: Vec<LawArguments>) -> PyResult<Laws> {
        let law = |(name, object, fields): LawArguments| {
            let law = PythonLaw::new(name.clone(), object, fields)?;
            Ok((name, Arc::new(law)))
        };
        Ok(Laws(laws.into_iter().map(law).collect::<PyResult<_>>()?))
    }

    pub fn given(&self) -> Given {
        let laws = self.0.iter();
        let laws = laws.map(|(name, law)| (name.clone(), law.clone() as Arc<dyn Law>));
        Given {
            laws: laws.collect(),
            ..Given::default()
        }
    }
}

#[pymethods]
impl Scene {
    /// Reads a file, or scene.toml in a folder.
    #[staticmethod]
    fn load(py: Python, path: PathBuf, sets: Vec<String>) -> PyResult<Scene> {
        check_process()?;
        let read = py.detach(|| scene::load(&path, &sets));
        Ok(Scene {
            scene: read.map_err(|error| errors::scene(&error))?,
            laws: Laws::default(),
        })
    }

    /// Reads a text as if it stood in `file`. `meshes` are names of files and what stands for them.
    #[staticmethod]
    fn parse(
        py: Python,
        file: PathBuf,
        text: String,
        sets: Vec<String>,
        meshes: Vec<(String, mesh::Arrays)>,
        laws: Vec<LawArguments>,
    ) -> PyResult<Scene> {
        check_process()?;
        let laws = Laws::new(laws)?;
        let mut given = laws.given();
        for (name, arrays) in meshes {
            given.meshes.insert(name, mesh::raw(&arrays)?);
        }
        let read = py.detach(|| scene::parse_with(&file, &text, &sets, &given));
        let scene = read.map_err(|error| errors::scene(&error))?;
        Ok(Scene { scene, laws })
    }

    /// The same scene whose bodies are as an earlier run left them, `OUT@STAGE`.
    fn inherit(&self, py: Python, from: String) -> PyResult<Scene> {
        let mut scene = self.scene.clone();
        let inherited = py.detach(|| scene::inherit(&mut scene, &from));
        inherited.map_err(|error| errors::scene(&error))?;
        Ok(Scene {
            scene,
            laws: self.laws.clone(),
        })
    }

    #[getter]
    fn text(&self) -> &str {
        &self.scene.text
    }

    #[getter]
    fn case(&self) -> &str {
        &self.scene.case
    }

    #[getter]
    fn title(&self) -> &str {
        &self.scene.plan.title
    }

    #[getter]
    fn folder(&self) -> PathBuf {
        self.scene.folder.clone()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.scene.notes.clone()
    }

    #[getter]
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        mesh::arrays(py, &self.scene.plan.mesh)
    }
}

/// A quantity with its unit, in SI: `quantity("50 ms", "time")` is 0.05.
#[pyfunction]
pub fn quantity(text: &str, dimension: &str) -> PyResult<f64> {
    let dimension = match dimension {
        "time" => Dimension::Time,
        "length" => Dimension::Length,
        "stress" => Dimension::Stress,
        other => {
            return Err(PyValueError::new_err(format!(
                "no dimension is called `{other}`"
            )));
        }
    };
    scene::parse_quantity(text, dimension).map_err(|error| PyValueError::new_err(error.to_string()))
}
