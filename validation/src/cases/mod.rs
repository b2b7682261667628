//! The cases, one file each.

mod absorbing_column;
mod collapse_smoothing;
mod column_collapse;
mod contact;
mod first_mode;
mod footings;
mod gravity_column;
mod heap;
mod mass_matrix;
mod moving_mesh;
mod oedometer;
mod rotation;
mod sensitivity;
mod shear_wave;
mod thick_cylinder;

use crate::Case;

/// All cases, in the order of the book.
pub const ALL: [Case; 22] = [
    Case {
        name: "absorbing-column",
        title: "Suddenly loaded layer: rigid bottom, dashpot, dashpot and spring",
        run: absorbing_column::run,
    },
    Case {
        name: "sensitivity",
        title: "The absorbing bottom's parameters: reflection against creep",
        run: sensitivity::run,
    },
    Case {
        name: "gravity-column",
        title: "A column under suddenly applied gravity",
        run: gravity_column::run,
    },
    Case {
        name: "first-mode",
        title: "Energy of the first elastic mode",
        run: first_mode::run,
    },
    Case {
        name: "oedometer",
        title: "Compression to 40 % strain",
        run: oedometer::run,
    },
    Case {
        name: "mass-matrix",
        title: "Lumped against consistent mass on the first mode",
        run: mass_matrix::run,
    },
    Case {
        name: "rotation",
        title: "A body that spins freely",
        run: rotation::run,
    },
    Case {
        name: "shear-wave",
        title: "A shear wave against a dashpot",
        run: shear_wave::run,
    },
    Case {
        name: "strip-footing",
        title: "Bearing capacity of a strip footing on clay",
        run: footings::run_strip,
    },
    Case {
        name: "circular-footing",
        title: "Bearing capacity of a circular footing on clay",
        run: footings::run_circle,
    },
    Case {
        name: "column-collapse",
        title: "A cylinder of dry sand collapses",
        run: column_collapse::run,
    },
    Case {
        name: "thick-cylinder",
        title: "A thick-walled cylinder under internal pressure, as a sector",
        run: thick_cylinder::run,
    },
    Case {
        name: "heap",
        title: "A heap of sand that stays, and a steeper one that does not",
        run: heap::run,
    },
    Case {
        name: "collapse-smoothing",
        title: "A collapsing block of sand with each smoothing of strains",
        run: collapse_smoothing::run,
    },
    Case {
        name: "sliding-block",
        title: "A block that slides down an incline, and one that stays",
        run: contact::sliding_block::run,
    },
    Case {
        name: "sliding-block-gmsh",
        title: "A block slides down an incline in an unstructured mesh",
        run: contact::unstructured::run,
    },
    Case {
        name: "spheres",
        title: "Two spheres that meet head-on and obliquely",
        run: contact::spheres::run,
    },
    Case {
        name: "stack",
        title: "Three blocks that stand on each other",
        run: contact::stack::run,
    },
    Case {
        name: "drop",
        title: "A block that falls flat on a floor",
        run: contact::drop::run,
    },
    Case {
        name: "penetration",
        title: "A rigid wedge and a rigid cone pushed into soil",
        run: contact::penetration::run,
    },
    Case {
        name: "moving-ground",
        title: "A mesh moves through ground at rest",
        run: moving_mesh::ground::run,
    },
    Case {
        name: "moving-push",
        title: "A punch takes the mesh along, or goes through a fixed one",
        run: moving_mesh::push::run,
    },
];

/// The case of this name.
pub fn find(name: &str) -> Option<&'static Case> {
    ALL.iter().find(|c| c.name == name)
}
