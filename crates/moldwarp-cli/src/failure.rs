//! How messages are broken into lines: names and commands stay whole, so that they can be copied.

use miette::MietteHandlerOpts;
use textwrap::core::Word;
use textwrap::{WordSeparator, WordSplitter};

/// Shows reports so from here on.
pub fn install() {
    // It fails only if it was done before, which changes nothing.
    let _ = miette::set_hook(Box::new(|_| {
        let options = MietteHandlerOpts::new()
            .break_words(false)
            .word_separator(WordSeparator::Custom(words))
            .word_splitter(WordSplitter::NoHyphenation);
        Box::new(options.build())
    }));
}

/// Words end at spaces, but not within backticks.
fn words(line: &str) -> Box<dyn Iterator<Item = Word<'_>> + '_> {
    let mut rest = line;
    Box::new(std::iter::from_fn(move || {
        let (word, after) = rest.split_at(word_length(rest));
        rest = after;
        (!word.is_empty()).then(|| Word::from(word))
    }))
}

/// Bytes of the first word with the spaces after it.
fn word_length(text: &str) -> usize {
    let (mut quoted, mut ended) = (false, false);
    for (at, c) in text.char_indices() {
        match c {
            ' ' if !quoted => ended = true,
            _ if ended => return at,
            // One without its counterpart quotes nothing.
            '`' => quoted = !quoted && text[at + 1..].contains('`'),
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_one_word() {
        let all = |line| words(line).map(|w| w.word.to_owned()).collect::<Vec<_>>();
        assert_eq!(
            all("make it  with `gmsh -3 a.geo`, then `z-max` "),
            ["make", "it", "with", "`gmsh -3 a.geo`,", "then", "`z-max`"]
        );
        assert_eq!(all("a ` b"), ["a", "`", "b"]);
        assert!(all("").is_empty());
    }
}
