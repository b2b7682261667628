//! The book's pages on the scene and on the output, made from the code.
//!
//! `scene.md` and `output.md` beside this file are their texts. A line `{{…}}` in them stands for a
//! table that is made from the code: from the comments of the scene's keys (`scene/raw.rs`), of the
//! words they take (the enums that these are turned into), of the energies, of the summary and of
//! the exit codes, and from the lists of fields and columns that the writers use. All of this is
//! test code: the program has none of it.
//!
//! The page's examples are read by the program as a user's scenes would be (`checks`), and a run's
//! files are compared with what the page on the output says (`runs`).

mod checks;
mod examples;
mod keys;
mod markdown;
mod results;
mod runs;
mod scene_page;
mod source;

/// Makes the pages anew.
const COMMAND: &str = "UPDATE_REFERENCE=1 cargo test -p moldwarp-io reference";

/// A page of the book: its text with the tables for its directives.
struct Page {
    name: &'static str,
    template: &'static str,
    /// The table for a directive, given its words.
    table: fn(&[&str]) -> String,
}

const PAGES: [Page; 2] = [
    Page {
        name: "scene",
        template: include_str!("scene.md"),
        table: scene_page::table,
    },
    Page {
        name: "output",
        template: include_str!("output.md"),
        table: results::table,
    },
];

impl Page {
    fn path(&self) -> String {
        format!("book/src/reference/{}.md", self.name)
    }

    /// The page as it should be.
    fn text(&self) -> String {
        let mut page = format!(
            "<!-- Made from crates/moldwarp-io/src/reference/{}.md and the code by\n     {COMMAND}\n     \
             Do not edit it here. -->\n\n",
            self.name
        );
        for line in self.template.lines() {
            match directive(line) {
                Some(words) => page += &(self.table)(&words),
                None => {
                    page += line;
                    page += "\n";
                }
            }
        }
        page
    }
}

/// The words of a line `{{…}}`.
fn directive(line: &str) -> Option<Vec<&str>> {
    let inside = line.strip_prefix("{{")?.strip_suffix("}}")?;
    Some(inside.split_whitespace().collect())
}

#[test]
fn the_pages_of_the_reference_are_those_of_the_code() {
    for page in PAGES {
        let text = page.text();
        if std::env::var_os("UPDATE_REFERENCE").is_some() {
            source::write(&page.path(), &text);
        }
        let written = source::read(&page.path()).replace("\r\n", "\n");
        let differs = |(old, new): &(&str, &str)| old != new;
        let first = written
            .lines()
            .zip(text.lines())
            .enumerate()
            .find(|(_, lines)| differs(lines));
        assert!(
            written == text,
            "{} is not what the code says; first difference: {first:#?}\nmake it anew: {COMMAND}",
            page.path()
        );
    }
}
