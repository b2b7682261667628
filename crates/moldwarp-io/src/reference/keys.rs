//! The scene's keys: what the comments of `scene/raw.rs` say of them.

use super::source::{Entry, enum_named, structs};

/// A key of the scene.
#[derive(Clone, Debug)]
pub struct Key {
    pub name: String,
    pub meaning: String,
    /// What is written there: a dimension and a range, words, a table. Empty if its own keys
    /// stand for it.
    pub kind: String,
    /// What holds where it is missing; `required`, or `–` where other keys can stand for it.
    pub default: String,
    /// The kinds or models that have this key; all, if there are none.
    pub only: Vec<String>,
    /// The words there are, where it takes one or a list of them.
    pub words: Vec<String>,
    /// The struct of the table, or tables, that it holds.
    pub table: Option<String>,
    /// Whether it holds tables (or values) by names of the user's.
    pub named: bool,
}

/// The keys of a table, by the name of its struct.
#[derive(Debug)]
pub struct Table {
    pub name: String,
    pub keys: Vec<Key>,
}

/// All tables of the scene.
pub fn tables() -> Vec<Table> {
    let structs = structs("crates/moldwarp-io/src/scene/raw.rs");
    let names: Vec<String> = structs.iter().map(|s| s.0.clone()).collect();
    let tables = structs.into_iter().map(|(name, fields)| Table {
        keys: fields.iter().map(|f| key(&name, f, &names)).collect(),
        name,
    });
    tables.collect()
}

/// The enum whose variants are the words of `file::Enum`.
pub fn words(path: &str) -> Vec<Entry> {
    let (file, name) = path
        .split_once("::")
        .unwrap_or_else(|| panic!("`{path}` should be file::Enum"));
    let file = match file {
        plan if plan.split('/').next() == Some("plan") => format!("crates/moldwarp/src/{plan}.rs"),
        _ => format!("crates/moldwarp-io/src/scene/{file}.rs"),
    };
    enum_named(&file, name)
}

fn key(owner: &str, field: &Entry, tables: &[String]) -> Key {
    let at = format!("`{}` of {owner}", field.name);
    let table = field.types.iter().find(|t| tables.contains(t)).cloned();
    let [meaning, only, kind, default] = parts(&field.docs);
    assert!(
        !kind.is_empty() || (table.is_some() && field.docs.is_empty()),
        "{at} has no line `type:` in its comment"
    );
    let default = match (field.optional, kind.is_empty()) {
        (false, _) => {
            assert!(
                default.is_empty(),
                "{at}: serde needs it, yet it has a default"
            );
            "required".to_owned()
        }
        (true, false) => {
            assert!(
                !default.is_empty(),
                "{at} has no line `default:` in its comment"
            );
            default
        }
        (true, true) => default,
    };
    let list = |text: &str| match text {
        "" => Vec::new(),
        _ => text.split(", ").map(str::to_owned).collect(),
    };
    let (kind, words) = spelled_out(&kind);
    Key {
        name: field.name.clone(),
        meaning,
        kind,
        default,
        only: list(&only),
        words,
        table,
        named: field.types.iter().any(|t| t == "Named"),
    }
}

/// The comment's meaning, and what follows `for:`, `type:` and `default:`.
fn parts(lines: &[String]) -> [String; 4] {
    let mut parts: [String; 4] = Default::default();
    let mut part = 0;
    for line in lines {
        let mut rest = line.as_str();
        for (i, label) in ["for:", "type:", "default:"].into_iter().enumerate() {
            if let Some(after) = line.strip_prefix(label) {
                (part, rest) = (i + 1, after.trim());
            }
        }
        if !parts[part].is_empty() {
            parts[part].push(' ');
        }
        parts[part].push_str(rest);
    }
    parts
}

/// The type as it is shown, and its words: those of the enum in `words of file::Enum`, or the
/// quoted ones of a list.
fn spelled_out(kind: &str) -> (String, Vec<String>) {
    const WORDS: &str = "words of ";
    if let Some(at) = kind.find(WORDS) {
        let path = &kind[at + WORDS.len()..];
        let words: Vec<String> = self::words(path).into_iter().map(|w| w.name).collect();
        let shown: Vec<String> = words.iter().map(|w| format!("`\"{w}\"`")).collect();
        return (format!("{}{}", &kind[..at], shown.join(", ")), words);
    }
    let quoted: Vec<&str> = kind.split('"').skip(1).step_by(2).collect();
    if !kind.contains("list of") || quoted.is_empty() {
        return (kind.to_owned(), Vec::new());
    }
    let shown = quoted.iter().fold(kind.to_owned(), |text, word| {
        text.replace(&format!("\"{word}\""), &format!("`\"{word}\"`"))
    });
    (shown, quoted.into_iter().map(str::to_owned).collect())
}
