//! Walking and changing a TOML document, whatever syntax its tables and lists are written in.

use toml_edit::{InlineTable, Item, Table, TableLike, Value};

/// A place in the document, whatever TOML syntax made it.
pub(super) enum Node<'a> {
    Item(&'a mut Item),
    Table(&'a mut Table),
    Value(&'a mut Value),
}

impl<'a> Node<'a> {
    pub fn is_table(&self) -> bool {
        match self {
            Node::Item(item) => item.is_table_like(),
            Node::Table(_) => true,
            Node::Value(value) => value.is_inline_table(),
        }
    }

    pub fn is_list(&self) -> bool {
        match self {
            Node::Item(item) => item.is_array() || item.is_array_of_tables(),
            Node::Table(_) => false,
            Node::Value(value) => value.is_array(),
        }
    }

    /// Keys of a table; names of a list's items, or their numbers.
    pub fn names(&self) -> Vec<String> {
        let keys = |t: &dyn TableLike| t.iter().map(|(k, _)| k.to_owned()).collect();
        let item_names = |names: Vec<Option<String>>| {
            let numbered = names.into_iter().enumerate();
            numbered.map(|(i, n)| n.unwrap_or(i.to_string())).collect()
        };
        match self {
            Node::Table(table) => keys(*table),
            Node::Item(Item::ArrayOfTables(tables)) => {
                item_names(tables.iter().map(|t| name_of(t)).collect())
            }
            Node::Item(item) => match (item.as_table_like(), item.as_array()) {
                (Some(table), _) => keys(table),
                (None, Some(array)) => item_names(array.iter().map(value_name).collect()),
                (None, None) => Vec::new(),
            },
            Node::Value(Value::InlineTable(table)) => keys(table),
            Node::Value(Value::Array(array)) => item_names(array.iter().map(value_name).collect()),
            Node::Value(_) => Vec::new(),
        }
    }

    pub fn has(&self, key: &str) -> bool {
        match self.position(key) {
            Some(_) => true,
            None => self.is_table() && self.names().iter().any(|n| n == key),
        }
    }

    /// Number of a list's item given by number or name.
    fn position(&self, key: &str) -> Option<usize> {
        if !self.is_list() {
            return None;
        }
        let names = self.names();
        match key.parse::<usize>() {
            Ok(i) => (i < names.len()).then_some(i),
            Err(_) => names.iter().position(|n| n == key),
        }
    }

    pub fn child(self, key: &str) -> Option<Node<'a>> {
        let position = self.position(key);
        match self {
            Node::Table(table) => table.get_mut(key).map(Node::Item),
            Node::Item(Item::Table(table)) => table.get_mut(key).map(Node::Item),
            Node::Item(Item::ArrayOfTables(tables)) => tables.get_mut(position?).map(Node::Table),
            Node::Item(Item::Value(value)) | Node::Value(value) => match value {
                Value::InlineTable(table) => table.get_mut(key).map(Node::Value),
                Value::Array(array) => array.get_mut(position?).map(Node::Value),
                _ => None,
            },
            Node::Item(Item::None) => None,
        }
    }

    /// A new empty table, with a header of its own or in its line.
    pub fn create(&mut self, key: &str, header: bool) {
        let new = match header {
            true => Item::Table(Table::new()),
            false => Item::Value(Value::InlineTable(InlineTable::new())),
        };
        let table: &mut dyn TableLike = match self {
            Node::Item(Item::Table(table)) => table,
            Node::Table(table) => *table,
            Node::Item(Item::Value(Value::InlineTable(table)))
            | Node::Value(Value::InlineTable(table)) => table,
            Node::Item(_) | Node::Value(_) => return,
        };
        table.insert(key, new);
    }

    /// Sets a key of a table or an item of a list of values; `false` if this is neither.
    pub fn put(self, key: &str, value: Value) -> bool {
        let position = self.position(key);
        match self {
            Node::Item(Item::Table(table)) => put_key(table, key, value),
            Node::Table(table) => put_key(table, key, value),
            Node::Item(Item::Value(Value::InlineTable(table)))
            | Node::Value(Value::InlineTable(table)) => put_key(table, key, value),
            Node::Item(Item::Value(Value::Array(array))) | Node::Value(Value::Array(array)) => {
                let old = position.and_then(|i| array.get_mut(i));
                old.map(|old| replace(old, value)).is_some()
            }
            Node::Item(_) | Node::Value(_) => false,
        }
    }
}

fn put_key(table: &mut dyn TableLike, key: &str, value: Value) -> bool {
    match table.get_mut(key) {
        Some(Item::Value(old)) => replace(old, value),
        Some(_) => return false,
        None => {
            table.insert(key, Item::Value(value));
        }
    }
    true
}

/// Keeps the comment behind the old value.
fn replace(old: &mut Value, new: Value) {
    let decor = old.decor().clone();
    *old = new;
    *old.decor_mut() = decor;
}

fn name_of(table: &dyn TableLike) -> Option<String> {
    table.get("name")?.as_str().map(str::to_owned)
}

fn value_name(value: &Value) -> Option<String> {
    name_of(value.as_inline_table()?)
}
