//! Completions, manual pages and the book's page on the command have every command and option.

mod common;

use common::Bench;

/// The commands, as the help lists them, each with its options.
fn commands(bench: &Bench) -> Vec<(String, Vec<String>)> {
    let help = bench.done(&["--help"]);
    let list = help
        .split("Commands:")
        .nth(1)
        .unwrap()
        .split("Options:")
        .next()
        .unwrap();
    let names = list.lines().filter_map(|line| {
        let name = line.strip_prefix("  ")?.split_whitespace().next()?;
        (line.as_bytes()[2] != b' ' && name != "help").then(|| name.to_owned())
    });
    let options = |name: &str| {
        let help = bench.done(&[name, "--help"]);
        let words = help
            .lines()
            .map(str::trim_start)
            .filter(|l| l.starts_with("--") || l.starts_with("-h"));
        let option = |line: &str| {
            let word = line.split("--").nth(1)?;
            let end = word.find(|c: char| !c.is_ascii_alphanumeric() && c != '-');
            Some(format!("--{}", &word[..end.unwrap_or(word.len())]))
        };
        words.filter_map(option).collect::<Vec<_>>()
    };
    names.map(|name| (name.clone(), options(&name))).collect()
}

#[test]
fn completions_have_every_command_and_option() {
    let bench = Bench::new();
    let commands = commands(&bench);
    assert!(commands.len() >= 9, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.done(&["completions", shell]);
        for (name, options) in &commands {
            assert!(script.contains(name.as_str()), "{shell}: {name}");
            for option in options {
                let long = option.trim_start_matches('-');
                let fish = format!("-l {long}");
                assert!(
                    script.contains(option.as_str()) || script.contains(&fish),
                    "{shell}: {name} {option}"
                );
            }
        }
        assert!(!script.contains("sweep-part"), "{shell}");
    }
    let said = bench.fails(2, &["completions", "cmd"]);
    assert!(said.contains("bash"), "{said}");
}

#[test]
fn manual_pages_have_every_command_and_option() {
    let bench = Bench::new();
    let whole = bench.done(&["man"]).replace("\\-", "-");
    bench.done(&["man", "pages"]);
    for (name, options) in commands(&bench) {
        assert!(whole.contains(&format!("moldwarp-{name}")), "{name}");
        let page = bench
            .read(&format!("pages/moldwarp-{name}.1"))
            .replace("\\-", "-");
        assert!(page.contains(&format!("moldwarp {name}")), "{name}: {page}");
        for option in options {
            assert!(page.contains(&option), "{name} {option}");
        }
    }
    assert_eq!(bench.read("pages/moldwarp.1").replace("\\-", "-"), whole);
    assert!(!bench.path("pages/moldwarp-sweep-part.1").exists());
    let said = bench.fails(4, &["man", "column/scene.toml"]);
    assert!(said.contains("cannot create"), "{said}");
}

/// What the page says of the options, people check; that it has them, this test.
#[test]
fn the_book_has_every_command_and_option() {
    let bench = Bench::new();
    let page = include_str!("../../../book/src/reference/command.md");
    for (name, options) in commands(&bench) {
        assert!(page.contains(&format!("\n## {name}\n")), "{name}");
        for option in options.iter().filter(|o| *o != "--help") {
            assert!(page.contains(option.as_str()), "{name} {option}");
        }
    }
}
