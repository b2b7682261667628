//! The tables of the page on the output.

use super::markdown::{code, table as markdown};
use super::source::{Entry, enum_named, struct_named};
use crate::output::vtu::Data;
use crate::run::{FIRST, Field, NODE_FIELDS, OfParticles, PARTICLE_FIELDS};
use moldwarp::NodeFields;
use moldwarp::material::{
    External, Increments, Law, LinearElastic, Material, MohrCoulomb, MohrCoulombParameters,
    StateField,
};
use moldwarp::measure::Energies;
use moldwarp::particles::Particles;
use moldwarp::plan::Contact;
use std::sync::Arc;

const SUMMARY: &str = "crates/moldwarp-io/src/output/summary.rs";

pub fn table(directive: &[&str]) -> String {
    match directive {
        ["particle-fields"] => {
            let particles = Particles::default();
            fields(&PARTICLE_FIELDS, |values| match values {
                OfParticles::Numbers(all) => shape(all(&particles)),
                OfParticles::Scalar(_) => "scalar",
                OfParticles::Vector(_) => "vector",
                OfParticles::Tensor(_) => "XX YY ZZ XY YZ XZ",
            })
        }
        ["state-fields"] => state_fields(),
        ["node-fields"] => {
            let nodes = NodeFields {
                velocity: Vec::new(),
                mass: Vec::new(),
                reaction: Vec::new(),
            };
            fields(&NODE_FIELDS, |values| shape(values(&nodes)))
        }
        ["columns"] => {
            let rows: Vec<_> = FIRST
                .iter()
                .map(|c| [code([c.name], ""), c.unit.to_owned(), c.meaning.to_owned()])
                .collect();
            markdown(["column", "unit", "meaning"], &rows)
        }
        ["contact-columns"] => contact_columns(),
        ["energies"] => energies(),
        ["summary"] => summary(),
        ["exit-codes"] => exit_codes(),
        other => panic!("the page on the output has no table {other:?}"),
    }
}

fn fields<V: Copy>(fields: &[Field<V>], shape: impl Fn(V) -> &'static str) -> String {
    let rows: Vec<_> = fields
        .iter()
        .map(|f| {
            [
                code([f.name], ""),
                shape(f.values).to_owned(),
                f.label.to_owned(),
                f.meaning.to_owned(),
            ]
        })
        .collect();
    markdown(["field", "type", "unit", "meaning"], &rows)
}

fn shape(data: Data) -> &'static str {
    match data {
        Data::U64(_) | Data::U32(_) | Data::U16(_) | Data::U8(_) => "integer",
        Data::F64(_) | Data::EachF64(_) => "scalar",
        Data::Vectors(_) | Data::EachVector(_) => "vector",
        Data::EachTensor(_) => "XX YY ZZ XY YZ XZ",
        Data::Tets(_) | Data::Steps { .. } | Data::Same { .. } => "cells",
    }
}

/// A law that says nothing: what state variables an external one has is its own affair.
#[derive(Debug)]
struct Nothing;

impl Law for Nothing {
    fn update(&self, _: Increments) -> Result<(), String> {
        Err("says nothing".into())
    }

    fn state_fields(&self) -> &'static [StateField] {
        &[]
    }
}

/// A material of every model.
fn materials() -> [Material; 4] {
    let elastic = LinearElastic {
        young_modulus: 1.0,
        poisson_ratio: 0.0,
    };
    let parameters = MohrCoulombParameters {
        cohesion: 1.0,
        friction_angle: 0.5,
        dilation_angle: 0.0,
        tension_cutoff: None,
    };
    let soil = MohrCoulomb::new(elastic, parameters).expect("it has strength");
    [
        Material::LinearElastic(elastic),
        Material::MohrCoulomb(soil),
        Material::Rigid,
        Material::External(External {
            elastic,
            law: Arc::new(Nothing),
        }),
    ]
}

/// State variables with the models that have them.
fn state_variables() -> Vec<(StateField, Vec<&'static str>)> {
    let mut found: Vec<(StateField, Vec<&str>)> = Vec::new();
    for material in materials() {
        // A model that is missing here is missing in `materials` above.
        let model = match material {
            Material::LinearElastic(_) => "linear-elastic",
            Material::MohrCoulomb(_) => "mohr-coulomb",
            Material::Rigid => "rigid",
            Material::External(_) => "external",
        };
        for field in material.state_fields() {
            match found.iter_mut().find(|f| f.0.name == field.name) {
                Some(known) => known.1.push(model),
                None => found.push((*field, vec![model])),
            }
        }
    }
    found
}

fn state_fields() -> String {
    let rows: Vec<_> = state_variables()
        .into_iter()
        .map(|(field, models)| {
            [
                code([field.name], ""),
                models.join(", "),
                field.unit.to_owned(),
            ]
        })
        .collect();
    markdown(["field", "model", "meaning"], &rows)
}

fn contact_columns() -> String {
    let column = |(name, unit, meaning): (&str, &str, &str)| {
        let name = code([format!("contact.<name>.{name}")], "");
        [name, unit.to_owned(), meaning.to_owned()]
    };
    markdown(["column", "unit", "meaning"], &Contact::COLUMNS.map(column))
}

fn energies() -> String {
    let fields = struct_named("crates/moldwarp/src/measure/ledger.rs", "Energies");
    let names: Vec<&str> = fields.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, Energies::NAMES, "fields and names of Energies");
    let rows: Vec<_> = fields
        .iter()
        .map(|f| [format!("`energy.{}`", f.name), said(f)])
        .collect();
    markdown(["column", "meaning"], &rows)
}

/// The comment, which there must be.
fn said(entry: &Entry) -> String {
    assert!(!entry.docs.is_empty(), "`{}` has no comment", entry.name);
    entry.text()
}

fn summary() -> String {
    let mut rows = Vec::new();
    for field in struct_named(SUMMARY, "Summary") {
        rows.push([code([&field.name], ""), said(&field)]);
        for (kind, below) in [("Compared", "[]"), ("Projected", "")] {
            if field.types.iter().any(|t| t == kind) {
                for part in struct_named(SUMMARY, kind) {
                    let path = format!("{}{below}.{}", field.name, part.name);
                    rows.push([code([path], ""), said(&part)]);
                }
            }
        }
    }
    markdown(["key", "meaning"], &rows)
}

fn exit_codes() -> String {
    let codes = enum_named("crates/moldwarp-cli/src/exit.rs", "Exit");
    let rows: Vec<_> = codes
        .iter()
        .map(|code| {
            let number = code.number.clone();
            [number.expect("each exit code has its number"), said(code)]
        })
        .collect();
    markdown(["code", "meaning"], &rows)
}

#[test]
fn there_is_a_material_of_each_model() {
    let words = super::keys::words("materials::Model");
    assert_eq!(materials().len(), words.len());
    let enumeration = enum_named("crates/moldwarp/src/material/mod.rs", "Material");
    assert_eq!(materials().len(), enumeration.len());
}
