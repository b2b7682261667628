//! What is wrong with a scene, where, and what to do about it.

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::error::Error;
use std::fmt;
use std::ops::Range;
use std::panic::Location;

/// A scene that cannot be computed. As a [`miette::Diagnostic`] it shows the place in the file
/// and the remedy.
pub struct SceneError(Box<Content>);

struct Content {
    message: String,
    source: Option<NamedSource<String>>,
    labels: Vec<LabeledSpan>,
    help: Option<String>,
    cause: Option<Cause>,
    raised: &'static Location<'static>,
}

type Cause = Box<dyn Error + Send + Sync>;

/// The same before it is known which file it belongs to: what the checks return.
#[derive(Debug)]
pub(crate) struct Fault {
    pub message: String,
    /// Byte ranges in the scene's text and what to say there.
    pub labels: Vec<(Range<usize>, String)>,
    pub help: Option<String>,
    /// The key that was probably meant instead of the one at the first label.
    pub meant: Option<String>,
    /// The error of another reader or of the solver that this one tells.
    cause: Option<Cause>,
    raised: &'static Location<'static>,
}

impl Fault {
    #[track_caller]
    pub fn new(message: impl Into<String>) -> Fault {
        Fault {
            message: message.into(),
            labels: Vec::new(),
            help: None,
            meant: None,
            cause: None,
            raised: Location::caller(),
        }
    }

    pub fn at(mut self, span: Range<usize>, label: impl Into<String>) -> Fault {
        self.labels.push((span, label.into()));
        self
    }

    pub fn help(mut self, help: impl Into<String>) -> Fault {
        self.help = Some(help.into());
        self
    }

    pub fn caused_by(mut self, cause: impl Error + Send + Sync + 'static) -> Fault {
        self.cause = Some(Box::new(cause));
        self
    }

    /// With the text its labels point into, called `name`.
    pub fn in_file(self, name: &str, text: &str) -> SceneError {
        let labels = self
            .labels
            .into_iter()
            .map(|(span, label)| LabeledSpan::new_with_span(Some(label), first_line(span, text)))
            .collect();
        SceneError(Box::new(Content {
            message: shortened(self.message),
            source: Some(NamedSource::new(name, text.to_owned())),
            labels,
            help: self.help,
            cause: self.cause,
            raised: self.raised,
        }))
    }

    /// Without a text: the file cannot be read.
    pub fn without_file(self) -> SceneError {
        SceneError(Box::new(Content {
            message: shortened(self.message),
            source: None,
            labels: Vec::new(),
            help: self.help,
            cause: self.cause,
            raised: self.raised,
        }))
    }
}

/// A word that is longer than any name or path is cut: it would bury the message.
fn shortened(message: String) -> String {
    const MOST: usize = 300;
    if message.split(' ').all(|word| word.chars().count() <= MOST) {
        return message;
    }
    let cut = |word: &str| match word.char_indices().nth(MOST) {
        None => word.to_owned(),
        Some(_) => {
            let begin: String = word.chars().take(80).collect();
            let quote = if begin.starts_with('`') { "`" } else { "" };
            format!("{begin}…{quote}")
        }
    };
    let words: Vec<String> = message.split(' ').map(cut).collect();
    words.join(" ")
}

/// Underlines no more than a line: whole tables make poor labels.
fn first_line(span: Range<usize>, text: &str) -> Range<usize> {
    let start = span.start.min(text.len());
    let end = span.end.clamp(start, text.len());
    let line = text.get(start..end).and_then(|s| s.find('\n'));
    start..line.map_or(end, |n| start + n)
}

impl SceneError {
    /// The error of a mesh file, of a generator or of the solver that this one tells in the scene's
    /// words, to be asked for its type. It is no [`source`](Error::source): the message already says
    /// all that it does.
    pub fn cause(&self) -> Option<&(dyn Error + Send + Sync + 'static)> {
        self.0.cause.as_deref()
    }

    /// Where in the reader's code the message is worded, by which the tests know that each message
    /// has its example.
    #[doc(hidden)]
    pub fn raised(&self) -> &'static Location<'static> {
        self.0.raised
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0.message)
    }
}

impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("SceneError")
            .field("message", &self.0.message)
            .field("labels", &self.0.labels)
            .field("help", &self.0.help)
            .finish()
    }
}

impl Error for SceneError {}

impl Diagnostic for SceneError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let help = self.0.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        let source = self.0.source.as_ref()?;
        Some(source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.0.labels.iter().cloned()))
    }
}
