//! Whether the pictures in the repository are those of the scenes in it. Nothing is drawn.

use super::{Entry, Record, entries, fingerprint, root};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Bytes: pages are to open at once, and the repository to stay small.
const LARGEST: u64 = 1_000_000;

fn recorded() -> Vec<(Entry, Record)> {
    let record = Record::read().expect("pictures.csv");
    let of = |entry: Entry| {
        let mut own = record.clone();
        own.rows.retain(|row| entry.files.contains(&row[0]));
        (entry, own)
    };
    entries()
        .expect("pictures.toml")
        .into_iter()
        .map(of)
        .collect()
}

#[test]
fn every_picture_is_of_its_scene_as_it_is_now() {
    let mut known: BTreeMap<String, (&str, String)> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (entry, record) in recorded() {
        for file in &entry.files {
            let about = std::fs::metadata(root().join(file));
            match about.map(|about| about.len()) {
                Ok(length) if length > LARGEST => wrong.push(format!("{file} has {length} bytes")),
                Ok(_) => {}
                Err(error) => wrong.push(format!("{file}: {error}")),
            }
            for scene in &entry.scenes {
                let now = known.entry(scene.clone()).or_insert_with(|| {
                    fingerprint(scene).unwrap_or_else(|e| panic!("{scene}: {e}"))
                });
                let mut rows = record
                    .rows
                    .iter()
                    .filter(|row| row[0] == *file && row[1] == *scene);
                match rows.next() {
                    None => wrong.push(format!("{file} has no row for {scene} in pictures.csv")),
                    Some(row) if (&row[2][..], &row[3]) != (now.0, &now.1) => {
                        wrong.push(format!("{scene} has changed since {file} was made from it"));
                    }
                    Some(row) if row[5] != entry.command() => {
                        wrong.push(format!("{file} was made in another way: {}", row[5]));
                    }
                    Some(_) => {}
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "`moldwarp-validation pictures NAME` makes them anew:\n  {}",
        wrong.join("\n  ")
    );
}

#[test]
fn the_record_has_no_other_pictures() {
    let entries = entries().expect("pictures.toml");
    for row in Record::read().expect("pictures.csv").rows {
        let entry = entries.iter().find(|e| e.files.contains(&row[0]));
        let entry = entry.unwrap_or_else(|| panic!("{} is not in pictures.toml", row[0]));
        assert!(
            entry.scenes.contains(&row[1]),
            "{} is not made from {}",
            row[0],
            row[1]
        );
    }
}

#[test]
fn all_pictures_that_are_shown_are_in_the_list_and_the_other_way_round() {
    let shown = shown();
    assert!(shown.len() > 20, "the pages show pictures");
    let listed: Vec<PathBuf> = entries()
        .expect("pictures.toml")
        .iter()
        .flat_map(|e| &e.files)
        .map(PathBuf::from)
        .collect();
    for (picture, page) in &shown {
        assert!(
            root().join(picture).is_file(),
            "{page} shows {}, which is not there",
            picture.display()
        );
        // Those are made by the cases, which need no scene.
        let of_a_case = picture.starts_with("validation/results");
        assert!(
            of_a_case || listed.contains(picture),
            "{page} shows {}, which is not in pictures.toml",
            picture.display()
        );
    }
    for picture in &listed {
        assert!(
            shown.contains_key(picture),
            "no page shows {}",
            picture.display()
        );
    }
}

/// The pictures that README, book and the examples' READMEs refer to, from the repository's folder, each
/// with a page that does.
fn shown() -> BTreeMap<PathBuf, String> {
    let mut pages = vec![PathBuf::from("README.md")];
    let mut folders = vec![PathBuf::from("book/src"), PathBuf::from("examples")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).expect("a folder of pages") {
            let entry = entry.expect("a page");
            let path = folder.join(entry.file_name());
            match entry.path().is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|e| e == "md") => pages.push(path),
                false => {}
            }
        }
    }
    let mut shown = BTreeMap::new();
    for page in pages {
        let text = std::fs::read_to_string(root().join(&page)).expect("a page");
        let folder = page.parent().unwrap_or(Path::new(""));
        for picture in pictures_of(&text) {
            shown.insert(plain(&folder.join(picture)), page.display().to_string());
        }
    }
    shown
}

/// What `![…](FILE)` and `<img src="FILE"` name, but for addresses.
fn pictures_of(page: &str) -> Vec<&str> {
    let images = page.split("![").skip(1).filter_map(|rest| {
        let (_, rest) = rest.split_once("](")?;
        rest.split([')', ' ']).next()
    });
    let tags = page.split("<img ").skip(1).filter_map(|rest| {
        let (_, rest) = rest.split_once("src=\"")?;
        rest.split('"').next()
    });
    images
        .chain(tags)
        .filter(|file| !file.contains("://"))
        .collect()
}

/// Without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

#[test]
fn references_are_found() {
    let page =
        "a ![x [y]](a/b.png) <img alt=\"c\" src=\"d.svg\" width=\"3\"> ![](https://e.org/f.png)";
    assert_eq!(pictures_of(page), ["a/b.png", "d.svg"]);
    assert_eq!(
        plain(Path::new("book/src/tutorials/../../../examples/a.png")),
        Path::new("examples/a.png")
    );
}
