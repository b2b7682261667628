//! Every variant of the readers' errors is produced by some case.
//!
//! The names come from exhaustive matches: a new variant does not compile here until it is listed,
//! and once it is, [`each_variant_has_a_case`] fails until a file of the corpus produces it.

use crate::cases::{self, Case};
use moldwarp::SetupError;
use moldwarp::boundary::LoadError;
use moldwarp::contact::ContactError;
use moldwarp::material::ParameterError;
use moldwarp::mesh::{CylinderError, MeshError, MotionError};
use moldwarp::particles::{InheritedError, InitialStressError, SeedingError};
use moldwarp::step::TimeStepError;
use moldwarp::symmetry::SymmetryError;
use moldwarp_io::mesh::{GmshProblem, MeshFileError};
use moldwarp_io::output::compare::CompareError;
use moldwarp_io::output::csv::CsvError;
use moldwarp_io::run::RunError;
use moldwarp_io::scene::QuantityError;
use std::collections::BTreeSet;
use std::error::Error;

/// An enumeration of errors, for its variants' names.
trait Variants {
    fn name(&self) -> &'static str;
}

macro_rules! variants {
    ($($kind:ident { $($variant:ident)* })*) => {
        $(impl Variants for $kind {
            fn name(&self) -> &'static str {
                match self {
                    $($kind::$variant { .. } => {
                        concat!(stringify!($kind), "::", stringify!($variant))
                    })*
                }
            }
        })*

        /// All variants.
        const ALL: &[&str] =
            &[$($(concat!(stringify!($kind), "::", stringify!($variant))),*),*];
    };
}

variants! {
    // Meshes from files.
    MeshFileError { Missing Unreadable At Whole }
    GmshProblem {
        NotGmsh Version Expected TooMany NoSection ElementsFirst Partitioned ParametricNodes
        TwoNodes NoSuchNode HigherOrder NotTetrahedral UnknownElement NoTetrahedra NoTriangles
        NotPlane OutOfPlane NegativeRadius TwoAreas TwoVolumes SameTetrahedron TwoElements TwoNames
        TwoNamesOfOne EntitiesLast FlatTriangle TrianglesOverlap NoEdge
    }
    // Meshes as such, and generated ones.
    MeshError {
        Empty NotFinite NoSuchNode Inverted Flat FaceShared NoSuchFace TwoVolumes
    }
    CylinderError {
        OnePoint Height Radius InnerCount InnerHeight InnerRadius InnerMixed Angle Wide Cells
        Segments Grading Mesh
    }
    // Scenes.
    QuantityError { NotANumber NoUnit NotAUnit Comma SignWithoutUnit WrongDimension TooLarge }
    ParameterError {
        FrictionAngle DilationAngle Cohesion NoStrength CutoffMissing Cutoff CutoffAboveApex
    }
    SymmetryError { Angle NoMeridian NotRound NoPlane BothSides }
    // What is found when a scene is set up.
    RunError {
        Scene NoSuchColumn OneColumn Reference Csv Folder NoRun Over AtWork Checkpoint File Cut
    }
    CsvError { File Empty NoHeader Width Number }
    CompareError { Empty NotFinite NotOrdered Flat NoOverlap }
    SetupError {
        Seeding Inherited Contact Load TimeStep Motion NoReaction NoContact InitialStress
        NoInitialStress ProbeOfChange ProbeOfNothing NoStage
    }
    SeedingError { Empty TooMany Overlap }
    InheritedError { Outside Overlap Density InitialStress }
    ContactError { RigidWithOthers NotOnFaces }
    TimeStepError { AboveStable Collapsed NotFinite }
    MotionError { NotOnFaces NotCovered NoGroup Held }
    InitialStressError { NoGravity Sloping SideBySide NotOnFaces Yields }
}

/// What no file of the corpus can produce, and why; tests elsewhere are named.
const ELSEWHERE: &[(&str, &str)] = &[
    (
        "MeshError::Empty",
        "a file without tetrahedra is refused by its reader",
    ),
    (
        "MeshError::NotFinite",
        "a coordinate that is not finite is refused by the reader",
    ),
    (
        "MeshError::NoSuchNode",
        "a node that is not there is refused by the reader",
    ),
    (
        "MeshError::TwoVolumes",
        "an element in two groups is refused by the reader",
    ),
    ("CylinderError::Cells", "the scene's `cells` are at least 1"),
    (
        "RunError::NoSuchColumn",
        "columns are checked as the scene is read",
    ),
    (
        "RunError::Folder",
        "of the output: tests/refusals.rs of moldwarp-cli",
    ),
    (
        "RunError::File",
        "of the output: tests/refusals.rs of moldwarp-cli",
    ),
    (
        "RunError::NoRun",
        "of a run that is resumed: tests/resume of moldwarp-cli",
    ),
    (
        "RunError::Over",
        "of a run that is resumed: tests/resume of moldwarp-cli",
    ),
    (
        "RunError::AtWork",
        "of a run that is resumed: tests/resume of moldwarp-cli",
    ),
    (
        "RunError::Checkpoint",
        "of a run that is resumed: tests/resume of moldwarp-cli",
    ),
    (
        "RunError::Cut",
        "of the output: tests/resume of moldwarp-cli",
    ),
    (
        "TimeStepError::Collapsed",
        "in a run: step/mod.rs of the solver",
    ),
    (
        "CompareError::NoOverlap",
        "of a finished run: src/output/compare.rs",
    ),
    (
        "SetupError::Inherited",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "SetupError::NoReaction",
        "checked as the scene is read: probe-reaction-of-free-surface",
    ),
    (
        "SetupError::NoStage",
        "checked as the scene is read: no-stages",
    ),
    (
        "InheritedError::Outside",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "InheritedError::Overlap",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "InheritedError::Density",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "InheritedError::InitialStress",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "ContactError::RigidWithOthers",
        "checked as the scene is read: contact-rigid-with-others",
    ),
];

/// The names of an error and of those in it.
fn names(error: &(dyn Error + 'static), found: &mut BTreeSet<&'static str>) {
    macro_rules! among {
        ($($kind:ident),*) => {
            $(if let Some(error) = error.downcast_ref::<$kind>() {
                found.insert(error.name());
            })*
        };
    }
    among!(
        MeshFileError,
        MeshError,
        CylinderError,
        QuantityError,
        ParameterError,
        SymmetryError,
        CsvError,
        CompareError,
        SetupError,
        SeedingError,
        InheritedError,
        ContactError,
        TimeStepError,
        MotionError,
        InitialStressError
    );
    if let Some(MeshFileError::At { problem, .. } | MeshFileError::Whole { problem, .. }) =
        error.downcast_ref()
    {
        found.insert(problem.name());
    }
    if let Some(CylinderError::Mesh(error)) = error.downcast_ref() {
        names(error, found);
    }
    match error.downcast_ref() {
        Some(SetupError::Seeding(error)) => names(error, found),
        Some(SetupError::Inherited(error)) => names(error, found),
        Some(SetupError::Contact(error)) => names(error, found),
        Some(SetupError::TimeStep(error)) => names(error, found),
        Some(SetupError::Motion(error)) => names(error, found),
        Some(SetupError::InitialStress(error)) => names(error, found),
        Some(SetupError::Load(LoadError { .. })) | Some(_) | None => {}
    }
}

fn produced(case: &Case, found: &mut BTreeSet<&'static str>) {
    let Some(error) = &case.error else { return };
    found.insert(error.name());
    match error {
        RunError::Scene(error) => {
            if let Some(cause) = error.cause() {
                names(cause, found);
            }
        }
        RunError::Csv(error) => names(error, found),
        RunError::Reference { problem, .. } => names(problem, found),
        _ => {}
    }
}

#[test]
fn each_variant_has_a_case() {
    let mut found = BTreeSet::new();
    for case in cases::all() {
        produced(case, &mut found);
    }
    let elsewhere = |name: &str| ELSEWHERE.iter().any(|e| e.0 == name);
    let missing: Vec<_> = (ALL.iter())
        .filter(|name| !found.contains(**name) && !elsewhere(name))
        .collect();
    assert!(
        missing.is_empty(),
        "no file of tests/bad produces {missing:#?}: add one, or say in ELSEWHERE why there is none"
    );
    let stale: Vec<_> = (ELSEWHERE.iter())
        .filter(|e| found.contains(e.0) || !ALL.contains(&e.0))
        .collect();
    assert!(stale.is_empty(), "there are files for these: {stale:#?}");
}
