//! Reads structs and enums of this workspace's source with what their comments say.

use std::path::{Path, PathBuf};
use syn::{Attribute, Expr, Fields, GenericArgument, Item, Lit, Meta, PathArguments, Type};

/// A struct's field, or an enum's variant.
pub struct Entry {
    /// As users write it: what serde calls a field; a variant in small letters with `-`.
    pub name: String,
    /// Its comment, a line each.
    pub docs: Vec<String>,
    /// Names of its type from the outermost to the innermost; none for variants.
    pub types: Vec<String>,
    /// Whether serde fills it in where it is missing.
    pub optional: bool,
    /// The number a variant stands for.
    pub number: Option<String>,
}

impl Entry {
    /// The comment as one line.
    pub fn text(&self) -> String {
        self.docs.join(" ")
    }
}

/// A file of the workspace, by its path from the workspace's folder.
pub fn file(path: &str) -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.join("../..").join(path)
}

pub fn read(path: &str) -> String {
    std::fs::read_to_string(file(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

pub fn write(path: &str, text: &str) {
    std::fs::write(file(path), text).unwrap_or_else(|e| panic!("{path}: {e}"));
}

fn items(path: &str) -> Vec<Item> {
    let file = syn::parse_file(&read(path));
    file.unwrap_or_else(|e| panic!("{path}: {e}")).items
}

/// The structs of a file with their fields, in order.
pub fn structs(path: &str) -> Vec<(String, Vec<Entry>)> {
    let items = items(path).into_iter();
    let structs = items.filter_map(|item| match item {
        Item::Struct(item) => Some((item.ident.to_string(), fields(item.fields))),
        _ => None,
    });
    structs.collect()
}

/// The fields of one struct.
pub fn struct_named(path: &str, name: &str) -> Vec<Entry> {
    let found = structs(path).into_iter().find(|s| s.0 == name);
    found.unwrap_or_else(|| panic!("{path} has no {name}")).1
}

/// The variants of an enum.
pub fn enum_named(path: &str, name: &str) -> Vec<Entry> {
    let items = items(path).into_iter();
    let mut found = items.filter_map(|item| match item {
        Item::Enum(item) if item.ident == name => Some(item),
        _ => None,
    });
    let item = found
        .next()
        .unwrap_or_else(|| panic!("{path} has no {name}"));
    let variants = item.variants.into_iter().map(|v| Entry {
        name: kebab(&v.ident.to_string()),
        docs: docs(&v.attrs),
        types: Vec::new(),
        optional: false,
        number: match v.discriminant {
            Some((_, Expr::Lit(lit))) => match lit.lit {
                Lit::Int(n) => Some(n.to_string()),
                _ => None,
            },
            _ => None,
        },
    });
    variants.collect()
}

fn fields(fields: Fields) -> Vec<Entry> {
    let fields = fields.into_iter().map(|f| {
        let mut types = Vec::new();
        type_names(&f.ty, &mut types);
        let (rename, default) = serde(&f.attrs);
        let ident = f.ident.map_or_else(String::new, |i| i.to_string());
        Entry {
            name: rename.unwrap_or(ident),
            docs: docs(&f.attrs),
            optional: default || types.first().is_some_and(|t| t == "Option"),
            types,
            number: None,
        }
    });
    fields.collect()
}

fn type_names(ty: &Type, names: &mut Vec<String>) {
    let Type::Path(path) = ty else { return };
    let Some(last) = path.path.segments.last() else {
        return;
    };
    names.push(last.ident.to_string());
    if let PathArguments::AngleBracketed(arguments) = &last.arguments {
        for argument in &arguments.args {
            if let GenericArgument::Type(ty) = argument {
                type_names(ty, names);
            }
        }
    }
}

fn docs(attributes: &[Attribute]) -> Vec<String> {
    let lines = attributes.iter().filter_map(|a| match &a.meta {
        Meta::NameValue(doc) if doc.path.is_ident("doc") => match &doc.value {
            Expr::Lit(lit) => match &lit.lit {
                Lit::Str(line) => Some(line.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    lines.filter(|l| !l.is_empty()).collect()
}

/// The name that serde uses instead of the field's, and whether it has a default.
fn serde(attributes: &[Attribute]) -> (Option<String>, bool) {
    let (mut rename, mut default) = (None, false);
    for attribute in attributes.iter().filter(|a| a.path().is_ident("serde")) {
        let read = attribute.parse_nested_meta(|meta| {
            default |= meta.path.is_ident("default");
            if meta.input.peek(syn::Token![=]) {
                let text: syn::LitStr = meta.value()?.parse()?;
                if meta.path.is_ident("rename") {
                    rename = Some(text.value());
                }
            }
            Ok(())
        });
        read.unwrap_or_else(|e| panic!("an attribute of serde: {e}"));
    }
    (rename, default)
}

fn kebab(name: &str) -> String {
    let mut word = String::new();
    for c in name.chars() {
        if c.is_uppercase() && !word.is_empty() {
            word.push('-');
        }
        word.extend(c.to_lowercase());
    }
    word
}
